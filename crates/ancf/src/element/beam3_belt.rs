//! The spatial belt beam: 24 coordinates, cubic centre line, shear as nodal angles.
//!
//! After Dufva, Sopanen & Mikkola (2005), generalised to space by Kerkkänen (2006, 4.23-4.42). Coordinates
//! `e = [r1, r1_x, r1_y, r1_z, r2, r2_x, r2_y, r2_z]`. The centre line `r_c` is the cubic Hermite curve of
//! `(r, r_x)`, `c = r_c,x`, `t = c / |c|`; r_y and r_z are linear along the element. The fibres are
//!
//! ```text
//! r = r_c + y s_y + z s_z                                                            (4.37)
//! s_y = n_y + tau_y t     n_y = (r_y - (t.r_y) t) / |.|                              (4.28, 4.38)
//! s_z = n_z + tau_z t     n_z = (r_z - (t.r_z) t) / |.|                              (4.29, 4.39)
//! tau linear between the nodal values t.r_y / |r_y| and t.r_z / |r_z|                (4.32, 4.33)
//! ```
//!
//! The frames of the text, `b_y = t x r_y / |.|`, `n_y = b_y x t` and the like, are these projections;
//! each fibre shears towards the tangent in its own frame, which keeps the strains objective. With the
//! Green strains of that position, `ks = 5/6`,
//!
//! ```text
//! U = 1/2 ∫ E exx² + 4 ks G (exy² + exz²) dV                                         (4.34, 4.40-4.42)
//!   + 1/2 ∫ E A (eyy² + ezz²) + 4 G A eyz² dx
//! ```
//!
//! alpha1 on the squared axial term, alpha2 on all else of the first line (the section's integral is in
//! `space_section.rs`); `eyy = |r_y| - 1`, `ezz = |r_z| - 1` and `eyz = r_y.r_z / 2` at the nodes, linear
//! between. A beam that stays in the plane of x and y is the planar belt beam.
//!
//! Its torsion stiffness is `ks G (∫ y² dA + ∫ z² dA)`: see [`BeltBeam3::with_torsion_factor`]. A root is
//! clamped by r, r_y and r_z; to clamp r_x as well forbids the shear there and costs an order of
//! accuracy.

mod fibre;
mod kinematics;
mod lines;
mod node;

use std::num::NonZeroUsize;

use self::kinematics::{DIRECTIONS, Gradient, Nodal, SHEARS, Section, VARIABLES};
use self::lines::Shape;
use self::node::Node;
use super::space_section::{Factors, SpaceSection};
use super::vector::dot;
use super::{Element, LineElement, hermite};
use crate::material::Isotropic;
use crate::quadrature::Rule;
use crate::scalar::{Scalar, Series};
use crate::section::SpatialSection;

/// Gauss points along the element, as in the planar belt beam.
const POINTS: usize = 5;

const DOF: usize = 24;
/// First coordinate of r_y in a node; r_z follows.
const ACROSS: usize = 6;
/// Coordinates of a node.
const NODE: usize = 12;

/// A spatial belt beam, straight and free of stress in its reference.
#[derive(Clone, Debug, PartialEq)]
pub struct BeltBeam3 {
    length: f64,
    material: Isotropic,
    section: SpatialSection,
    axial_factor: f64,
    bending_factor: f64,
    law: SpaceSection,
    points: [Point; POINTS],
}

/// A quadrature point.
#[derive(Clone, Debug, PartialEq)]
struct Point {
    /// Weight times length [m].
    weight: f64,
    /// Linear interpolation from the nodes and its derivative by x [1/m].
    at: [f64; 2],
    per_length: [f64; 2],
    shape: Shape,
}

impl Point {
    /// A linear function of x by its nodal values.
    #[inline(always)]
    fn interpolate<S: Scalar>(&self, first: S, second: S) -> Series<S> {
        Series::new(
            first * self.at[0] + second * self.at[1],
            (second - first) * self.per_length[1],
        )
    }

    /// What a derivative by that function is by a nodal value.
    #[inline(always)]
    fn share<S: Scalar>(&self, by: Series<S>, node: usize) -> S {
        by.slope * self.at[node] + by.value * self.per_length[node]
    }
}

impl BeltBeam3 {
    /// A belt beam of undeformed length `length` [m].
    ///
    /// `axial_factor` (alpha1) scales the axial stiffness, `bending_factor` (alpha2) bending, shear and
    /// torsion; the stiffness of the section itself (eyy, ezz, eyz) stays whole.
    #[must_use]
    pub fn new(
        length: f64,
        section: &SpatialSection,
        material: &Isotropic,
        axial_factor: f64,
        bending_factor: f64,
    ) -> Self {
        let rule = Rule::gauss(NonZeroUsize::new(POINTS).unwrap_or(NonZeroUsize::MIN));
        Self {
            length,
            material: *material,
            section: *section,
            axial_factor,
            bending_factor,
            law: law(section, material, [axial_factor, bending_factor, 1.0]),
            points: std::array::from_fn(|i| {
                let xi = rule.points[i];
                Point {
                    weight: rule.weights[i] * length,
                    at: [1.0 - xi, xi],
                    per_length: [-1.0 / length, 1.0 / length],
                    shape: Shape::new(xi, length),
                }
            }),
        }
    }

    /// The same beam with its torsion stiffness multiplied by `factor`;
    /// [`SpatialSection::saint_venant_torsion_factor`] makes it Saint-Venant's (times alpha2).
    #[must_use]
    pub fn with_torsion_factor(self, factor: f64) -> Self {
        let factors = [self.axial_factor, self.bending_factor, factor];
        let law = law(&self.section, &self.material, factors);
        Self { law, ..self }
    }

    fn axial_stiffness(&self) -> f64 {
        self.material.youngs_modulus * self.section.area
    }

    /// Integrated stiffness of a strain linear between nodes, `E A l / 6`, and of the angle
    /// `r_y.r_z = 2 eyz`, `G A l / 6`.
    fn transverse_stiffness(&self) -> [f64; 2] {
        let volume = self.section.area * self.length / 6.0;
        [
            self.material.youngs_modulus * volume,
            self.material.shear_modulus() * volume,
        ]
    }
}

/// The energy of a section by alpha1, alpha2 and the torsion factor.
fn law(section: &SpatialSection, material: &Isotropic, factors: [f64; 3]) -> SpaceSection {
    let [axial, bending, torsion] = factors;
    SpaceSection::new(
        section,
        material.youngs_modulus,
        material.shear_modulus(),
        Factors {
            axial,
            bending,
            torsion,
            transverse: 0.0,
        },
    )
}

#[inline(always)]
fn coordinates<S: Scalar>(e: &[S]) -> &[S; DOF] {
    // A caller with a shorter slice breaks the contract of `Element`; no input of a user reaches this.
    let Some(e) = e.first_chunk::<DOF>() else {
        panic!("a spatial belt beam has {DOF} coordinates, not {}", e.len());
    };
    e
}

/// The vector of coordinates from `first`.
#[inline(always)]
fn vector<S: Scalar>(e: &[S; DOF], first: usize) -> [S; 3] {
    [e[first], e[first + 1], e[first + 2]]
}

/// Both fibres at both nodes: `[fibre][node]`.
#[inline(always)]
fn nodes<S: Scalar>(e: &[S; DOF]) -> [[Node<S>; 2]; 2] {
    [
        [node_of(e, 0, 0), node_of(e, 0, 1)],
        [node_of(e, 1, 0), node_of(e, 1, 1)],
    ]
}

#[inline(always)]
fn node_of<S: Scalar>(e: &[S; DOF], k: usize, node: usize) -> Node<S> {
    Node::new(vector(e, NODE * node + 3), direction(e, k, node))
}

/// r_y (`k` 0) or r_z (1) of a node.
#[inline(always)]
fn direction<S: Scalar>(e: &[S; DOF], k: usize, node: usize) -> [S; 3] {
    vector(e, NODE * node + ACROSS + 3 * k)
}

#[inline(always)]
fn nodal<S: Scalar>(e: &[S; DOF], nodes: &[[Node<S>; 2]; 2]) -> Nodal<S> {
    Nodal {
        lines: lines::lines(e),
        directions: [
            [direction(e, 0, 0), direction(e, 0, 1)],
            [direction(e, 1, 0), direction(e, 1, 1)],
        ],
        shears: [
            [nodes[0][0].shear, nodes[0][1].shear],
            [nodes[1][0].shear, nodes[1][1].shear],
        ],
    }
}

/// `r_y.r_z` at both nodes.
#[inline(always)]
fn angles<S: Scalar>(e: &[S; DOF]) -> [S; 2] {
    [
        dot(direction(e, 0, 0), direction(e, 1, 0)),
        dot(direction(e, 0, 1), direction(e, 1, 1)),
    ]
}

/// `∫ f² dx / (l / 6) / 2` of a linear f by its nodal values.
#[inline(always)]
fn half_square<S: Scalar>([first, second]: [S; 2]) -> S {
    first * first + first * second + second * second
}

/// Derivatives of [`half_square`].
#[inline(always)]
fn half_square_gradient<S: Scalar>([first, second]: [S; 2]) -> [S; 2] {
    [first * 2.0 + second, first + second * 2.0]
}

/// Coordinates that shear of fibre `k` at `node` depends on: r_x, then r_y or r_z.
const fn shear_coordinates(k: usize, node: usize) -> [usize; 6] {
    let (c, d) = (NODE * node + 3, NODE * node + ACROSS + 3 * k);
    [c, c + 1, c + 2, d, d + 1, d + 2]
}

/// Coordinate of an element variable that is one, the second node's for the chord.
const fn coordinate(variable: usize) -> usize {
    let axis = variable % 3;
    axis + match variable / 3 {
        0 => NODE,
        1 => 3,
        2 => NODE + 3,
        3 => ACROSS,
        4 => NODE + ACROSS,
        5 => ACROSS + 3,
        _ => NODE + ACROSS + 3,
    }
}

crate::body_kernels!(BeltBeam3);

impl Element for BeltBeam3 {
    const DIMENSION: usize = 3;
    const NODES: usize = 2;
    const NODE_VECTORS: usize = 4;

    #[inline(always)]
    fn energy<S: Scalar>(&self, e: &[S]) -> S {
        let e = coordinates(e);
        let nodes = nodes(e);
        let [normal, shear] = self.transverse_stiffness();
        let mut energy = half_square(angles(e)) * shear;
        for [first, second] in &nodes {
            energy += half_square([first.stretch, second.stretch]) * normal;
        }
        let nodal = nodal(e, &nodes);
        for point in &self.points {
            energy += self.law.energy(&Section::new(point, &nodal).vectors) * point.weight;
        }
        energy
    }

    #[inline(always)]
    fn force<S: Scalar>(&self, e: &[S], force: &mut [S]) {
        let e = coordinates(e);
        let nodes = nodes(e);
        let nodal = nodal(e, &nodes);
        let mut gradient = Gradient {
            lines: [[S::zero(); 3]; 3],
            directions: [[[S::zero(); 3]; 2]; 2],
            shears: [[S::zero(); 2]; 2],
        };
        for point in &self.points {
            let section = Section::new(point, &nodal);
            let by = self.law.gradient(&section.vectors, point.weight);
            section.add_gradient(point, &by, &mut gradient);
        }
        force[..DOF].fill(S::zero());
        let [chord, left, right] = gradient.lines;
        for i in 0..3 {
            force[i] = chord[i];
            force[3 + i] = -left[i];
            force[NODE + i] = -chord[i];
            force[NODE + 3 + i] = -right[i];
        }
        let [normal, shear] = self.transverse_stiffness();
        let by_angle = half_square_gradient(angles(e));
        for k in 0..2 {
            let stretch = half_square_gradient([nodes[k][0].stretch, nodes[k][1].stretch]);
            for node in 0..2 {
                let own = NODE * node + ACROSS + 3 * k;
                let other = NODE * node + ACROSS + 3 * (1 - k);
                for i in 0..3 {
                    force[own + i] -= gradient.directions[k][node][i]
                        + nodes[k][node].u[i] * stretch[node] * normal
                        + e[other + i] * by_angle[node] * shear;
                }
                let by_shear = nodes[k][node].shear_gradient();
                for (i, coordinate) in shear_coordinates(k, node).into_iter().enumerate() {
                    force[coordinate] -= by_shear[i] * gradient.shears[k][node];
                }
            }
        }
    }

    #[inline(always)]
    fn stiffness<S: Scalar>(&self, e: &[S], stiffness: &mut [S]) {
        let e = coordinates(e);
        let nodes = nodes(e);
        let nodal = nodal(e, &nodes);
        let mut sum = [[S::zero(); VARIABLES]; VARIABLES];
        let mut shears = [[S::zero(); 2]; 2];
        for point in &self.points {
            Section::new(point, &nodal).add_hessian(point, &self.law, &mut sum, &mut shears);
        }
        self.add_transverse(e, &nodes, &mut sum);

        let mut tangent = [[S::zero(); DOF]; DOF];
        for row in 0..SHEARS[0] {
            for column in row..SHEARS[0] {
                tangent[coordinate(row)][coordinate(column)] = sum[row][column];
                tangent[coordinate(column)][coordinate(row)] = sum[row][column];
            }
        }
        // Shears as functions of their coordinates: gradient g, and h such that g h^T + h g^T is what
        // they give with each other and with the other variables.
        for k in 0..2 {
            for node in 0..2 {
                let shear = SHEARS[k] + node;
                let mut with = [S::zero(); DOF];
                for row in 0..SHEARS[0] {
                    with[coordinate(row)] = sum[row][shear];
                }
                for other_k in 0..2 {
                    for other_node in 0..2 {
                        let other = SHEARS[other_k] + other_node;
                        let half = sum[shear.min(other)][shear.max(other)] * 0.5;
                        let by = nodes[other_k][other_node].shear_gradient();
                        let places = shear_coordinates(other_k, other_node);
                        for (i, place) in places.into_iter().enumerate() {
                            with[place] += by[i] * half;
                        }
                    }
                }
                let gradient = nodes[k][node].shear_gradient();
                let hessian = nodes[k][node].shear_hessian(shears[k][node]);
                let places = shear_coordinates(k, node);
                for (i, row) in places.into_iter().enumerate() {
                    for column in 0..DOF {
                        let value = gradient[i] * with[column];
                        tangent[row][column] += value;
                        tangent[column][row] += value;
                    }
                    for (j, column) in places.into_iter().enumerate() {
                        tangent[row][column] += hessian[i][j];
                    }
                }
            }
        }
        spread_chord(&mut tangent);
        for (row, values) in tangent.iter().enumerate() {
            stiffness[DOF * row..DOF * (row + 1)].copy_from_slice(values);
        }
    }

    fn vector_mass(&self, mass: &mut [f64]) {
        let l = self.length;
        mass[..64].fill(0.0);
        let line = self.material.density * self.section.area * l / 420.0;
        for (i, row) in hermite::SPATIAL_VECTORS.into_iter().enumerate() {
            for (j, column) in hermite::SPATIAL_VECTORS.into_iter().enumerate() {
                mass[8 * row + column] = line * hermite::mass(l)[i][j];
            }
        }
        let moments = [self.section.second_moment_y, self.section.second_moment_z];
        for (k, moment) in moments.into_iter().enumerate() {
            let rotary = self.material.density * moment * l / 6.0;
            let (first, second) = (2 + k, 6 + k);
            for (row, column, factor) in [
                (first, first, 2.0),
                (first, second, 1.0),
                (second, first, 1.0),
                (second, second, 2.0),
            ] {
                mass[8 * row + column] = rotary * factor;
            }
        }
    }

    fn reference(&self, e: &mut [f64]) {
        e[..DOF].fill(0.0);
        e[NODE] = self.length;
        for node in [0, NODE] {
            for axis in 0..3 {
                e[node + 3 + 4 * axis] = 1.0;
            }
        }
    }

    fn energy_scale(&self) -> f64 {
        self.axial_stiffness() * self.length
    }
}

/// A tangent whose rows and columns of r2 are those of the chord becomes that of the coordinates.
#[inline(always)]
fn spread_chord<S: Scalar>(tangent: &mut [[S; DOF]; DOF]) {
    for i in 0..3 {
        for j in 0..DOF {
            tangent[i][j] -= tangent[NODE + i][j];
        }
    }
    for j in 0..DOF {
        for i in 0..3 {
            let value = tangent[j][NODE + i];
            tangent[j][i] -= value;
        }
    }
}

impl BeltBeam3 {
    /// Adds the second derivatives of the energy of eyy, ezz and eyz.
    #[inline(always)]
    fn add_transverse<S: Scalar>(
        &self,
        e: &[S; DOF],
        nodes: &[[Node<S>; 2]; 2],
        sum: &mut [[S; VARIABLES]; VARIABLES],
    ) {
        let [normal, shear] = self.transverse_stiffness();
        let by_angle = half_square_gradient(angles(e));
        for k in 0..2 {
            let stretch = half_square_gradient([nodes[k][0].stretch, nodes[k][1].stretch]);
            let [first, second] = [DIRECTIONS[k], DIRECTIONS[k] + 3];
            let others = [direction(e, 1 - k, 0), direction(e, 1 - k, 1)];
            for node in 0..2 {
                let at = [first, second][node];
                let u = nodes[k][node].u;
                let curved = stretch[node] * nodes[k][node].per_length * normal;
                let along = -curved + 2.0 * normal;
                for i in 0..3 {
                    for j in 0..3 {
                        sum[at + i][at + j] +=
                            u[i] * u[j] * along + others[node][i] * others[node][j] * (2.0 * shear);
                    }
                    sum[at + i][at + i] += curved;
                }
            }
            for i in 0..3 {
                for j in 0..3 {
                    sum[first + i][second + j] += nodes[k][0].u[i] * nodes[k][1].u[j] * normal
                        + others[0][i] * others[1][j] * shear;
                }
            }
        }
        // r_y with r_z: d²/dr_y dr_z of half the square of the angle.
        let [y, z] = DIRECTIONS;
        for row_node in 0..2 {
            for column_node in 0..2 {
                let factor = if row_node == column_node { 2.0 } else { 1.0 };
                let of_row = direction(e, 1, row_node);
                let of_column = direction(e, 0, column_node);
                for i in 0..3 {
                    for j in 0..3 {
                        sum[y + 3 * row_node + i][z + 3 * column_node + j] +=
                            of_row[i] * of_column[j] * (factor * shear);
                    }
                }
            }
            for i in 0..3 {
                sum[y + 3 * row_node + i][z + 3 * row_node + i] += by_angle[row_node] * shear;
            }
        }
    }
}

impl LineElement for BeltBeam3 {
    const CENTRE_VECTORS: &'static [usize] = &hermite::SPATIAL_VECTORS;
    const SECTION_VECTORS: [usize; 2] = [2, 6];

    fn length(&self) -> f64 {
        self.length
    }

    fn centre_line(&self, xi: f64, weights: &mut [f64]) {
        let vectors = hermite::SPATIAL_VECTORS;
        hermite::spread(hermite::value(xi, self.length), vectors, weights);
    }

    fn centre_line_slope(&self, xi: f64, weights: &mut [f64]) {
        let vectors = hermite::SPATIAL_VECTORS;
        hermite::spread(hermite::slope(xi, self.length), vectors, weights);
    }

    fn jacobian(&self, e: &[f64], xi: f64) -> f64 {
        let across = |k: usize| -> [f64; 3] {
            std::array::from_fn(|i| {
                let at = ACROSS + 3 * k + i;
                (1.0 - xi) * e[at] + xi * e[NODE + at]
            })
        };
        super::determinant(self.slope(e, xi), across(0), across(1))
    }

    /// The true axial force `alpha1 EA (f² - 1) / 2 f` of the stretch `f` of the centre line.
    fn axial_force(&self, e: &[f64], xi: f64) -> f64 {
        let c = self.slope(e, xi);
        let square = dot(c, c);
        self.axial_factor * self.axial_stiffness() * 0.5 * (square - 1.0) * square.sqrt()
    }
}
