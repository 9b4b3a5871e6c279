//! Loads on a strip of plates: dead forces, pressure, and a moment on its end.
//!
//! Pressure p follows the surface: it acts along the normal of the deformed plate on its deformed area,
//!
//! ```text
//! Q_k = p ∫ N_k (r_x x r_y) dA        -dQ_k/dr_l = -p ∫ N_k (N_l,y [r_x] - N_l,x [r_y]) dA     [a] b = a x b
//! ```
//!
//! integrated exactly by five points a side. A moment m per width turns the strip's end about y:
//! `theta = atan2(r_x,z, r_x,x)` there, its power is `∫ m theta' dy`.

use std::num::NonZeroUsize;

use crate::element::SurfaceElement;
use crate::linear::BorderedMatrix;
use crate::mesh::Mesh;
use crate::quadrature::Rule;
use crate::system::{ForceLaw, State};

/// Points a side for the pressure: shape functions are cubic in x and in y, and their product with the
/// normal is of degree nine at most.
const POINTS: usize = 5;
/// Vector coordinates of an element with four nodes of three.
const VECTORS: usize = 12;

/// Loads that grow together by a factor.
#[derive(Clone, Debug)]
pub struct SurfaceLoads {
    /// Part of the loads that is applied.
    pub factor: f64,
    /// Constant generalised forces.
    pub dead: Vec<f64>,
    /// Pressure [N/m²] along the normal `r_x x r_y`.
    pub pressure: f64,
    /// Moment per width [N m/m] on the end x = length, from x towards z.
    pub end_moment: f64,
    surface: Vec<Point>,
    end: Vec<Point>,
    /// First coordinate of each vector, by element.
    coordinates: Vec<[usize; VECTORS]>,
    /// First of the elements at the end.
    first_at_end: usize,
}

/// A quadrature point.
#[derive(Clone, Debug)]
struct Point {
    /// Weight times area [m²] or length [m].
    weight: f64,
    shape: [f64; VECTORS],
    by_x: [f64; VECTORS],
    by_y: [f64; VECTORS],
}

impl Point {
    fn new<E: SurfaceElement>(element: &E, place: [f64; 2], weight: f64) -> Self {
        let mut point = Self {
            weight,
            shape: [0.0; VECTORS],
            by_x: [0.0; VECTORS],
            by_y: [0.0; VECTORS],
        };
        element.surface(place, &mut point.shape);
        element.surface_slopes(place, &mut point.by_x, &mut point.by_y);
        point
    }
}

impl SurfaceLoads {
    /// No loads on the strip of `mesh`, all of whose `across` elements in a row are like its first.
    #[must_use]
    pub fn new<E: SurfaceElement>(mesh: &Mesh<E>, across: usize) -> Self {
        const {
            assert!(E::NODES * E::NODE_VECTORS == VECTORS && E::DIMENSION == 3);
        }
        let element = &mesh.elements()[0];
        let rule = Rule::gauss(NonZeroUsize::new(POINTS).unwrap_or(NonZeroUsize::MIN));
        let (length, width) = (element.length(), element.width());
        let mut surface = Vec::with_capacity(POINTS * POINTS);
        let mut end = Vec::with_capacity(POINTS);
        for (eta, b) in rule.points.iter().zip(&rule.weights) {
            end.push(Point::new(element, [1.0, *eta], b * width));
            for (xi, a) in rule.points.iter().zip(&rule.weights) {
                surface.push(Point::new(element, [*xi, *eta], a * b * length * width));
            }
        }
        let count = mesh.elements().len();
        let coordinates = (0..count)
            .map(|element| {
                std::array::from_fn(|vector| {
                    let node = mesh.node(element, vector / E::NODE_VECTORS);
                    node * E::NODE_DOF + E::DIMENSION * (vector % E::NODE_VECTORS)
                })
            })
            .collect();
        Self {
            factor: 1.0,
            dead: vec![0.0; mesh.dof()],
            pressure: 0.0,
            end_moment: 0.0,
            surface,
            end,
            coordinates,
            first_at_end: count - across,
        }
    }

    fn slopes(&self, element: usize, q: &[f64], point: &Point) -> [[f64; 3]; 2] {
        let mut slopes = [[0.0; 3]; 2];
        for (vector, at) in self.coordinates[element].iter().enumerate() {
            for axis in 0..3 {
                slopes[0][axis] += point.by_x[vector] * q[at + axis];
                slopes[1][axis] += point.by_y[vector] * q[at + axis];
            }
        }
        slopes
    }

    fn add_pressure(&self, q: &[f64], force: &mut [f64]) {
        for (element, places) in self.coordinates.iter().enumerate() {
            for point in &self.surface {
                let [a, b] = self.slopes(element, q, point);
                let load = self.factor * self.pressure * point.weight;
                let normal = cross(a, b);
                for (vector, at) in places.iter().enumerate() {
                    for axis in 0..3 {
                        force[at + axis] += load * point.shape[vector] * normal[axis];
                    }
                }
            }
        }
    }

    fn add_pressure_tangent(&self, q: &[f64], factor: f64, matrix: &mut BorderedMatrix) {
        for (element, places) in self.coordinates.iter().enumerate() {
            for point in &self.surface {
                let [a, b] = self.slopes(element, q, point);
                let load = -factor * self.factor * self.pressure * point.weight;
                let (along, across) = (skew(a), skew(b));
                for (k, row) in places.iter().enumerate() {
                    for (l, column) in places.iter().enumerate() {
                        for i in 0..3 {
                            for j in 0..3 {
                                let slope =
                                    point.by_y[l] * along[i][j] - point.by_x[l] * across[i][j];
                                matrix.add(row + i, column + j, load * point.shape[k] * slope);
                            }
                        }
                    }
                }
            }
        }
    }

    fn add_end_moment(&self, q: &[f64], force: &mut [f64]) {
        for (element, places) in self.coordinates.iter().enumerate().skip(self.first_at_end) {
            for point in &self.end {
                let [[x, _, z], _] = self.slopes(element, q, point);
                let load = self.factor * self.end_moment * point.weight / (x * x + z * z);
                for (vector, at) in places.iter().enumerate() {
                    force[*at] -= point.by_x[vector] * load * z;
                    force[at + 2] += point.by_x[vector] * load * x;
                }
            }
        }
    }

    fn add_end_moment_tangent(&self, q: &[f64], factor: f64, matrix: &mut BorderedMatrix) {
        for (element, places) in self.coordinates.iter().enumerate().skip(self.first_at_end) {
            for point in &self.end {
                let [[x, _, z], _] = self.slopes(element, q, point);
                let square = x * x + z * z;
                let load =
                    factor * self.factor * self.end_moment * point.weight / (square * square);
                let (mixed, difference) = (2.0 * x * z * load, (x * x - z * z) * load);
                for (k, row) in places.iter().enumerate() {
                    for (l, column) in places.iter().enumerate() {
                        let share = point.by_x[k] * point.by_x[l];
                        matrix.add(*row, *column, -share * mixed);
                        matrix.add(*row, column + 2, share * difference);
                        matrix.add(row + 2, *column, share * difference);
                        matrix.add(row + 2, column + 2, share * mixed);
                    }
                }
            }
        }
    }
}

impl ForceLaw for SurfaceLoads {
    fn add_force(&mut self, state: State<'_>, force: &mut [f64]) {
        for (sum, value) in force.iter_mut().zip(&self.dead) {
            *sum += self.factor * value;
        }
        if self.pressure != 0.0 {
            self.add_pressure(state.q, force);
        }
        if self.end_moment != 0.0 {
            self.add_end_moment(state.q, force);
        }
    }

    fn add_tangent(
        &mut self,
        state: State<'_>,
        position_factor: f64,
        _: f64,
        matrix: &mut BorderedMatrix,
    ) {
        if self.pressure != 0.0 {
            self.add_pressure_tangent(state.q, position_factor, matrix);
        }
        if self.end_moment != 0.0 {
            self.add_end_moment_tangent(state.q, position_factor, matrix);
        }
    }
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// `[a]`, `[a] b = a x b`.
fn skew(a: [f64; 3]) -> [[f64; 3]; 3] {
    [[0.0, -a[2], a[1]], [a[2], 0.0, -a[0]], [-a[1], a[0], 0.0]]
}
