//! The thin plate: a rectangle of four nodes, 36 coordinates.
//!
//! Dufva & Shabana (2005) as used by Kerkkänen (2006, 4.14-4.19). Nodes A (0, 0), B (l, 0), C (l, w), D (0, w), each
//! with r, r_x, r_y; every component of r(x, y) is the polynomial of 12 terms of `shape.rs`. With
//! `a = r_x`, `b = r_y`, N the unit normal of `a x b`, h the thickness,
//!
//! ```text
//! U = E h / (2 (1 - nu²)) ∫ (exx + eyy)² - 2 (1 - nu) (exx eyy - exy²) dA             (4.16)
//!   + D / 2 ∫ (kxx + kyy)² - 2 (1 - nu) (kxx kyy - kxy²) dA                           (4.17)
//! exx = (a.a - 1)/2,  eyy = (b.b - 1)/2,  exy = a.b/2
//! kxx = r_xx.N / a.a,  kyy = r_yy.N / b.b,  kxy = r_xy.N / (|a| |b|)                  (4.18)
//! M = ∫ rho h S^T S dA                                                                (4.19)
//! ```
//!
//! `D = E h³ / (12 (1 - nu²))` (Kirchhoff) or without `1 - nu²`, as (4.17) is printed. The derivatives are in
//! `membrane.rs` and `bending.rs`.

mod bending;
mod membrane;
mod shape;

use std::num::NonZeroUsize;
use std::sync::Arc;

use self::bending::Bending;
use self::membrane::Membrane;
use self::shape::{FUNCTIONS, Shape};
use super::{Element, SurfaceElement};
use crate::material::Isotropic;
use crate::quadrature::Rule;
use crate::scalar::{Scalar, unroll};
use crate::strain::SurfaceGradient;

const DOF: usize = 36;

/// Gauss points along each side of the element.
const POINTS: PlateQuadrature = PlateQuadrature {
    membrane: 5,
    bending: 4,
};

/// The bending stiffness D of a plate.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum BendingRigidity {
    /// Kirchhoff's `E h³ / (12 (1 - nu²))`.
    #[default]
    Kirchhoff,
    /// `E h³ / 12`, as printed in Kerkkänen (2006, 4.17).
    Printed,
    /// No bending stiffness: a membrane. It holds its shape only where it is stretched.
    None,
}

/// Gauss points along each side of a plate element; zero counts as one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PlateQuadrature {
    /// For the membrane energy.
    pub membrane: usize,
    /// For the bending energy.
    pub bending: usize,
}

impl Default for PlateQuadrature {
    fn default() -> Self {
        POINTS
    }
}

/// A thin plate, flat and free of stress in its reference.
#[derive(Clone, Debug, PartialEq)]
pub struct ThinPlate {
    length: f64,
    width: f64,
    thickness: f64,
    material: Isotropic,
    membrane: Membrane,
    bending: Bending,
    /// Equal elements share them.
    points: Arc<Points>,
}

/// Quadrature points with the shape functions' derivatives.
#[derive(Clone, Debug, PartialEq)]
struct Points {
    /// r_x, r_y.
    membrane: Vec<Point<2>>,
    /// r_x, r_y, r_xx, r_yy, r_xy; none without bending stiffness.
    bending: Vec<Point<5>>,
}

/// Orders of the derivatives by x and y.
const ORDERS: [[i32; 2]; 5] = [[1, 0], [0, 1], [2, 0], [0, 2], [1, 1]];

#[derive(Clone, Debug, PartialEq)]
struct Point<const V: usize> {
    /// Weight times area [m²].
    weight: f64,
    shape: [[f64; FUNCTIONS]; V],
}

impl ThinPlate {
    /// A plate of undeformed length and width (along x and y) and thickness [m].
    #[must_use]
    pub fn new(
        length: f64,
        width: f64,
        thickness: f64,
        material: &Isotropic,
        rigidity: BendingRigidity,
    ) -> Self {
        let nu = material.poisson_ratio;
        let youngs = material.youngs_modulus;
        let plane = youngs / (1.0 - nu * nu);
        let cubed = thickness.powi(3) / 12.0;
        let rigidity = match rigidity {
            BendingRigidity::Kirchhoff => plane * cubed,
            BendingRigidity::Printed => youngs * cubed,
            BendingRigidity::None => 0.0,
        };
        let plate = Self {
            length,
            width,
            thickness,
            material: *material,
            membrane: Membrane::new(plane * thickness, nu),
            bending: Bending::new(rigidity, nu),
            points: Arc::new(Points {
                membrane: Vec::new(),
                bending: Vec::new(),
            }),
        };
        plate.with_quadrature(PlateQuadrature::default())
    }

    /// The same plate integrated by other Gauss points.
    #[must_use]
    pub fn with_quadrature(self, quadrature: PlateQuadrature) -> Self {
        let bending = if self.bending.is_none() {
            Vec::new()
        } else {
            self.quadrature_points(quadrature.bending)
        };
        let points = Arc::new(Points {
            membrane: self.quadrature_points(quadrature.membrane),
            bending,
        });
        Self { points, ..self }
    }

    fn quadrature_points<const V: usize>(&self, count: usize) -> Vec<Point<V>> {
        let rule = Rule::gauss(NonZeroUsize::new(count).unwrap_or(NonZeroUsize::MIN));
        let functions = Shape::new(self.length, self.width);
        let mut points = Vec::new();
        for (xi, a) in rule.points.iter().zip(&rule.weights) {
            for (eta, b) in rule.points.iter().zip(&rule.weights) {
                points.push(Point {
                    weight: a * b * self.length * self.width,
                    shape: std::array::from_fn(|v| functions.derivatives(ORDERS[v], [*xi, *eta])),
                });
            }
        }
        points
    }

    /// Thickness [m].
    pub fn thickness(&self) -> f64 {
        self.thickness
    }

    /// Membrane forces per undeformed width [N/m] of the second Piola-Kirchhoff stress,
    /// `[xx, yy, xy]`, where the surface has this gradient. The true force per undeformed width along a fibre
    /// is this times its stretch.
    pub fn membrane_forces(&self, gradient: &SurfaceGradient) -> [f64; 3] {
        let [xx, yy, xy] = gradient.green();
        self.membrane.forces([xx, yy, 2.0 * xy])
    }
}

impl<const V: usize> Point<V> {
    /// The vectors at the point.
    #[inline(always)]
    fn vectors<S: Scalar>(&self, e: &[S; DOF]) -> [[S; 3]; V] {
        let mut vectors = [[S::zero(); 3]; V];
        for v in 0..V {
            for k in 0..FUNCTIONS {
                for i in 0..3 {
                    vectors[v][i] += e[3 * k + i] * self.shape[v][k];
                }
            }
        }
        vectors
    }

    /// Subtracts what derivatives by the vectors are by the coordinates.
    #[inline(always)]
    fn subtract<S: Scalar>(&self, by: &[[S; 3]; V], force: &mut [S; DOF]) {
        for k in 0..FUNCTIONS {
            for i in 0..3 {
                let mut sum = by[0][i] * self.shape[0][k];
                for v in 1..V {
                    sum += by[v][i] * self.shape[v][k];
                }
                force[3 * k + i] -= sum;
            }
        }
    }

    /// Adds what second derivatives by the vectors are by the coordinates.
    #[inline(always)]
    fn add<S: Scalar>(&self, hessian: &[[[[S; 3]; 3]; V]; V], sum: &mut Sum<S>) {
        for (block, [row, column]) in AXES.into_iter().enumerate() {
            let mut half = [[S::zero(); FUNCTIONS]; V];
            for v in 0..V {
                for u in 0..V {
                    let value = hessian[v][u][row][column];
                    for k in 0..FUNCTIONS {
                        half[v][k] += value * self.shape[u][k];
                    }
                }
            }
            let sum = &mut sum[block];
            if row == column {
                // The upper part alone, in steps of four rows: constant bounds keep whole registers.
                unroll!(for step in 0..3 {
                    self.add_rows::<S, 4>(&half, 4 * step, 4 * step, sum);
                });
            } else {
                self.add_rows::<S, FUNCTIONS>(&half, 0, 0, sum);
            }
        }
    }

    /// Adds `ROWS` rows from `first`, from column `start` on, of shape functions times `half`.
    #[inline(always)]
    fn add_rows<S: Scalar, const ROWS: usize>(
        &self,
        half: &[[S; FUNCTIONS]; V],
        first: usize,
        start: usize,
        sum: &mut [[S; FUNCTIONS]; FUNCTIONS],
    ) {
        for k in first..first + ROWS {
            for v in 0..V {
                let factor = self.shape[v][k];
                for m in start..FUNCTIONS {
                    sum[k][m] += half[v][m] * factor;
                }
            }
        }
    }
}

/// Pairs of axes of a symmetric tangent.
const AXES: [[usize; 2]; 6] = [[0, 0], [0, 1], [0, 2], [1, 1], [1, 2], [2, 2]];

/// Blocks of the tangent: pair of axes, row function, column function. Of the symmetric blocks (equal
/// axes) the part from the diagonal on is used.
type Sum<S> = [[[S; FUNCTIONS]; FUNCTIONS]; 6];

#[inline(always)]
fn coordinates<S: Scalar>(e: &[S]) -> &[S; DOF] {
    // A caller with a shorter slice breaks the contract of `Element`; no input of a user reaches this.
    let Some(e) = e.first_chunk::<DOF>() else {
        panic!("a thin plate has {DOF} coordinates, not {}", e.len());
    };
    e
}

crate::body_kernels!(ThinPlate);

impl Element for ThinPlate {
    const DIMENSION: usize = 3;
    const NODES: usize = 4;
    const NODE_VECTORS: usize = 3;
    const NODE_PLACES: &'static [[usize; 2]] = &[[0, 0], [1, 0], [1, 1], [0, 1]];

    #[inline(always)]
    fn energy<S: Scalar>(&self, e: &[S]) -> S {
        let e = coordinates(e);
        let mut energy = S::zero();
        for point in &self.points.membrane {
            energy += self.membrane.energy(&point.vectors(e)) * point.weight;
        }
        for point in &self.points.bending {
            energy += self.bending.energy(&point.vectors(e)) * point.weight;
        }
        energy
    }

    #[inline(always)]
    fn force<S: Scalar>(&self, e: &[S], force: &mut [S]) {
        let e = coordinates(e);
        let mut sum = [S::zero(); DOF];
        for point in &self.points.membrane {
            let by = self.membrane.gradient(&point.vectors(e), point.weight);
            point.subtract(&by, &mut sum);
        }
        for point in &self.points.bending {
            let by = self.bending.gradient(&point.vectors(e), point.weight);
            point.subtract(&by, &mut sum);
        }
        force[..DOF].copy_from_slice(&sum);
    }

    #[inline(always)]
    fn stiffness<S: Scalar>(&self, e: &[S], stiffness: &mut [S]) {
        let e = coordinates(e);
        let mut sum = [[[S::zero(); FUNCTIONS]; FUNCTIONS]; 6];
        for point in &self.points.membrane {
            let hessian = self.membrane.hessian(&point.vectors(e), point.weight);
            point.add(&hessian, &mut sum);
        }
        for point in &self.points.bending {
            let hessian = self.bending.hessian(&point.vectors(e), point.weight);
            point.add(&hessian, &mut sum);
        }
        for (block, [i, j]) in sum.iter().zip(AXES) {
            for k in 0..FUNCTIONS {
                let first = if i == j { k } else { 0 };
                for m in first..FUNCTIONS {
                    stiffness[(3 * k + i) * DOF + 3 * m + j] = block[k][m];
                    stiffness[(3 * m + j) * DOF + 3 * k + i] = block[k][m];
                }
            }
        }
    }

    /// Four Gauss points a side integrate the products, of degree 6 in x and in y, exactly.
    fn vector_mass(&self, mass: &mut [f64]) {
        let rule = Rule::gauss(NonZeroUsize::new(4).unwrap_or(NonZeroUsize::MIN));
        let functions = Shape::new(self.length, self.width);
        let total = self.material.density * self.thickness * self.length * self.width;
        mass[..FUNCTIONS * FUNCTIONS].fill(0.0);
        for (xi, a) in rule.points.iter().zip(&rule.weights) {
            for (eta, b) in rule.points.iter().zip(&rule.weights) {
                let shape = functions.derivatives([0, 0], [*xi, *eta]);
                for k in 0..FUNCTIONS {
                    for m in 0..FUNCTIONS {
                        mass[k * FUNCTIONS + m] += total * a * b * (shape[k] * shape[m]);
                    }
                }
            }
        }
    }

    fn reference(&self, e: &mut [f64]) {
        e[..DOF].fill(0.0);
        for (node, place) in e.chunks_exact_mut(9).zip(Self::NODE_PLACES) {
            node[0] = self.length * place[0] as f64;
            node[1] = self.width * place[1] as f64;
            node[3] = 1.0;
            node[7] = 1.0;
        }
    }

    fn energy_scale(&self) -> f64 {
        self.material.youngs_modulus * self.thickness * self.length * self.width
    }
}

impl SurfaceElement for ThinPlate {
    fn length(&self) -> f64 {
        self.length
    }

    fn width(&self) -> f64 {
        self.width
    }

    fn surface(&self, place: [f64; 2], weights: &mut [f64]) {
        let shape = Shape::new(self.length, self.width);
        weights[..FUNCTIONS].copy_from_slice(&shape.derivatives([0, 0], place));
    }

    fn surface_slopes(&self, place: [f64; 2], by_x: &mut [f64], by_y: &mut [f64]) {
        let shape = Shape::new(self.length, self.width);
        by_x[..FUNCTIONS].copy_from_slice(&shape.derivatives([1, 0], place));
        by_y[..FUNCTIONS].copy_from_slice(&shape.derivatives([0, 1], place));
    }

    fn surface_gradient(&self, e: &[f64], place: [f64; 2]) -> SurfaceGradient {
        let e = coordinates(e);
        let (mut by_x, mut by_y) = ([0.0; FUNCTIONS], [0.0; FUNCTIONS]);
        self.surface_slopes(place, &mut by_x, &mut by_y);
        let combine = |weights: &[f64; FUNCTIONS]| -> [f64; 3] {
            std::array::from_fn(|i| (0..FUNCTIONS).map(|k| weights[k] * e[3 * k + i]).sum())
        };
        SurfaceGradient {
            x: combine(&by_x),
            y: combine(&by_y),
        }
    }
}
