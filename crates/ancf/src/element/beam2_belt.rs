//! The planar belt beam: 12 coordinates, cubic centre line, shear as a nodal angle.
//!
//! After Dufva, Sopanen & Mikkola (2005) as used by Kerkkänen (2006, 3.8-3.19). Coordinates
//! `e = [r1, r1_x, r1_y, r2, r2_x, r2_y]`. The centre line `r_c` is the cubic Hermite curve of
//! `(r, r_x)`. With `c = r_c,x`, `f = |c|`, `t = c / f`, `n = I~ t` and `I~ = [[0, -1], [1, 0]]`:
//!
//! ```text
//! r = r_c + y s                     (3.8)     s = n - sin(gamma) t        (3.10)
//! sin(gamma) linear between the nodal values  -t . r_y / |r_y|            (3.12)
//! U = ∫ alpha1 E A / 8 (c.c - 1)²
//!     + alpha2 { E I2 / 2 [(c.s')² + (c.c - 1) s'.s' / 2] + E I4 / 8 (s'.s')² }   (3.18)
//!     + alpha2 ks G / 2 { A (c.s)² + I2 (s'.s)² }                                 (3.19)
//!     + E A / 2 e_yy²  dx,          e_yy linear between the nodal values |r_y| - 1
//! ```
//!
//! # As coded
//! Let `a = c.c`, `kappa = (c x c') / a` (turning of the tangent per reference length),
//! `p = sin(gamma)`, `q = p'` and `k = kappa + q`. Then `s' = -k t - p kappa n`, so
//!
//! ```text
//! c.s = -p f      c.s' = -f k      s'.s' = k² + p² kappa² =: b      s'.s = p q
//! W = EA/8 (a - 1)² + EI2/2 [a k² + (a - 1) b / 2] + EI4/8 b² + ksG/2 [A p² a + I2 p² q²]
//! ```
//!
//! (alphas absorbed). Derivatives go through `(a, kappa, p, q)` to `(c, c', p, q)` (`density.rs`), which
//! are linear in the chord and the slopes (`lines.rs`) and in the two nodal shear values; those depend
//! on four coordinates of a node each (`node.rs`).

mod damping;
mod density;
mod lines;
mod node;

use std::num::NonZeroUsize;

use self::density::{Kinematics, Stiffness};
use self::lines::{Lines, Shape, Sum};
use self::node::Node;
use super::{Element, LineElement, hermite};
use crate::material::Isotropic;
use crate::quadrature::Rule;
use crate::scalar::{Scalar, unroll};
use crate::section::{PlanarSection, SHEAR_CORRECTION};
use crate::unsound::{Unsound, positive, within};

/// Gauss points along the element; more change no published result.
const POINTS: usize = 5;

const DOF: usize = 12;

/// A planar belt beam, straight and free of stress in its reference.
#[derive(Clone, Debug, PartialEq)]
pub struct BeltBeam2 {
    length: f64,
    line_density: f64,
    rotary_density: f64,
    /// E A without alpha1 [N].
    transverse_stiffness: f64,
    /// alpha1 E A [N].
    axial_stiffness: f64,
    /// Kelvin-Voigt time of axial strain and curvature [s].
    damping_time: f64,
    points: [Point; POINTS],
    sound: Result<(), Unsound>,
}

#[derive(Clone, Debug, PartialEq)]
struct Point {
    xi: f64,
    stiffness: Stiffness,
    shape: Shape,
}

impl BeltBeam2 {
    /// A belt beam of undeformed length `length` [m].
    ///
    /// `axial_factor` (alpha1) scales the axial stiffness, `bending_factor` (alpha2) bending and
    /// shear; the thickness stretch keeps its full stiffness. `damping_time` [s] is the Kelvin-Voigt
    /// ratio of viscosity to stiffness for axial strain and curvature, zero for none.
    #[must_use]
    pub fn new(
        length: f64,
        section: &PlanarSection,
        material: &Isotropic,
        axial_factor: f64,
        bending_factor: f64,
        damping_time: f64,
    ) -> Self {
        let youngs = material.youngs_modulus;
        let shear = SHEAR_CORRECTION * material.shear_modulus();
        let rule = Rule::gauss(NonZeroUsize::new(POINTS).unwrap_or(NonZeroUsize::MIN));
        let points = std::array::from_fn(|i| {
            let (xi, weight) = (rule.points[i], rule.weights[i] * length);
            let bending = weight * bending_factor;
            Point {
                xi,
                stiffness: Stiffness {
                    axial: weight * axial_factor * youngs * section.area / 4.0,
                    bending: bending * youngs * section.second_moment,
                    fourth: bending * youngs * section.fourth_moment / 4.0,
                    shear: bending * shear * section.area,
                    shear_gradient: bending * shear * section.second_moment,
                },
                shape: Shape::new(xi, length),
            }
        });
        Self {
            length,
            line_density: material.density * section.area,
            rotary_density: material.density * section.second_moment,
            transverse_stiffness: youngs * section.area,
            axial_stiffness: axial_factor * youngs * section.area,
            damping_time,
            points,
            sound: positive("the length of an element [m]", length)
                .and_then(|()| section.check())
                .and_then(|()| material.check())
                .and_then(|()| positive("the axial factor", axial_factor))
                .and_then(|()| positive("the bending factor", bending_factor))
                .and_then(|()| {
                    let fits = damping_time >= 0.0 && damping_time.is_finite();
                    within(
                        "the damping time [s]",
                        damping_time,
                        fits,
                        "finite and not negative",
                    )
                }),
        }
    }

    /// What the energy depends on at a point.
    #[inline(always)]
    fn kinematics<S: Scalar>(
        &self,
        point: &Point,
        lines: &Lines<S>,
        shear: [S; 2],
    ) -> Kinematics<S> {
        let (c, curve) = point.shape.apply(lines);
        let p = shear[0] * (1.0 - point.xi) + shear[1] * point.xi;
        let q = (shear[1] - shear[0]) * (1.0 / self.length);
        Kinematics::new(c, curve, p, q)
    }

    /// Writes the elastic force in the configuration `e` and, where rates are given, that of the damping.
    #[inline(always)]
    fn write_force<S: Scalar>(&self, e: &[S; DOF], rate: Option<&[S; DOF]>, force: &mut [S; DOF]) {
        let nodes = [Node::new(e, 0), Node::new(e, 1)];
        let shear = [nodes[0].shear, nodes[1].shear];
        let lines = lines::lines(e);
        let velocity = rate.map(lines::lines);
        let mut by_lines = [[S::zero(); 2]; 3];
        let (mut by_left, mut by_right, mut by_q) = (S::zero(), S::zero(), S::zero());
        for point in &self.points {
            let at = self.kinematics(point, &lines, shear);
            let mut by = at.gradient(&point.stiffness);
            if let Some(velocity) = &velocity {
                let ([c0, c1], [curve0, curve1]) = self.damping_gradient(point, &at, velocity);
                by.c = [by.c[0] + c0, by.c[1] + c1];
                by.curve = [by.curve[0] + curve0, by.curve[1] + curve1];
            }
            point.shape.add(by.c, by.curve, &mut by_lines);
            by_left += by.p * (1.0 - point.xi);
            by_right += by.p * point.xi;
            by_q += by.q;
        }
        let by_q = by_q * (1.0 / self.length);
        let by_shear = [by_left - by_q, by_right + by_q];
        *force = [S::zero(); DOF];
        lines::subtract(&by_lines, force);
        let by_thickness = self.thickness_gradient([nodes[0].thickness, nodes[1].thickness]);
        unroll!(for k in 0..2 {
            let gradient = nodes[k].shear_gradient();
            unroll!(for i in 0..4 {
                force[6 * k + 2 + i] -= by_shear[k] * gradient[i];
            });
            unroll!(for axis in 0..2 {
                force[6 * k + 4 + axis] -= by_thickness[k] * nodes[k].u[axis];
            });
        });
    }

    /// Integrated thickness stretch: energy and its derivatives by the two nodal strains.
    #[inline(always)]
    fn thickness_gradient<S: Scalar>(&self, strain: [S; 2]) -> [S; 2] {
        let factor = self.transverse_stiffness * self.length / 6.0;
        [
            (strain[0] * 2.0 + strain[1]) * factor,
            (strain[0] + strain[1] * 2.0) * factor,
        ]
    }
}

#[inline(always)]
fn coordinates<S: Scalar>(e: &[S]) -> &[S; DOF] {
    // A caller with a shorter slice breaks the contract of `Element`; no input of a user reaches this.
    let Some(e) = e.first_chunk::<DOF>() else {
        panic!("a belt beam has {DOF} coordinates, not {}", e.len());
    };
    e
}

#[inline(always)]
fn coordinates_mut<S: Scalar>(force: &mut [S]) -> &mut [S; DOF] {
    // A caller with a shorter slice breaks the contract of `Element`; no input of a user reaches this.
    let length = force.len();
    let Some(force) = force.first_chunk_mut::<DOF>() else {
        panic!("a belt beam has {DOF} coordinates, not {length}");
    };
    force
}

#[inline(always)]
fn matrix_mut<S: Scalar>(matrix: &mut [S]) -> &mut [S; DOF * DOF] {
    // A caller with a shorter slice breaks the contract of `Element`; no input of a user reaches this.
    let length = matrix.len();
    let Some(matrix) = matrix.first_chunk_mut::<{ DOF * DOF }>() else {
        panic!("a belt beam's matrix has {DOF}² entries, not {length}");
    };
    matrix
}

crate::body_kernels!(BeltBeam2);

impl Element for BeltBeam2 {
    const DIMENSION: usize = 2;
    const NODES: usize = 2;
    const NODE_VECTORS: usize = 3;

    #[inline(always)]
    fn energy<S: Scalar>(&self, e: &[S]) -> S {
        let e = coordinates(e);
        let nodes = [Node::new(e, 0), Node::new(e, 1)];
        let (y0, y1) = (nodes[0].thickness, nodes[1].thickness);
        let mut energy =
            (y0 * y0 + y0 * y1 + y1 * y1) * (self.transverse_stiffness * self.length / 6.0);
        let lines = lines::lines(e);
        for point in &self.points {
            let at = self.kinematics(point, &lines, [nodes[0].shear, nodes[1].shear]);
            energy += at.energy(&point.stiffness);
        }
        energy
    }

    #[inline(always)]
    fn force<S: Scalar>(&self, e: &[S], force: &mut [S]) {
        self.write_force(coordinates(e), None, coordinates_mut(force));
    }

    #[inline(always)]
    fn stiffness<S: Scalar>(&self, e: &[S], stiffness: &mut [S]) {
        let (e, out) = (coordinates(e), matrix_mut(stiffness));
        let nodes = [Node::new(e, 0), Node::new(e, 1)];
        let shear = [nodes[0].shear, nodes[1].shear];
        let lines = lines::lines(e);
        // Hessian by the line vectors and the two nodal shears.
        let mut by_lines = Sum::zero();
        let mut mixed = [[[S::zero(); 2]; 3]; 2];
        let [mut left, mut both, mut right] = [S::zero(); 3];
        let mut by_shear = [S::zero(); 2];
        let per_length = 1.0 / self.length;
        for point in &self.points {
            let at = self.kinematics(point, &lines, shear);
            let (h, [by_p, by_q]) = at.hessian(&point.stiffness);
            by_lines.add(&point.shape, h.cc, h.ck, h.kk);
            // (p, q) = [[1 - xi, xi], [-1 / l, 1 / l]] (shear 1, shear 2)
            let (low, high) = (1.0 - point.xi, point.xi);
            by_shear[0] += by_p * low - by_q * per_length;
            by_shear[1] += by_p * high + by_q * per_length;
            let (pq, qq) = (h.pq * per_length, h.qq * (per_length * per_length));
            left += h.pp * (low * low) - pq * (2.0 * low) + qq;
            both += h.pp * (low * high) + pq * (low - high) - qq;
            right += h.pp * (high * high) + pq * (2.0 * high) + qq;
            let cq = [h.cq[0] * per_length, h.cq[1] * per_length];
            let kq = [h.kq[0] * per_length, h.kq[1] * per_length];
            point.shape.add(
                [h.cp[0] * low - cq[0], h.cp[1] * low - cq[1]],
                [h.kp[0] * low - kq[0], h.kp[1] * low - kq[1]],
                &mut mixed[0],
            );
            point.shape.add(
                [h.cp[0] * high + cq[0], h.cp[1] * high + cq[1]],
                [h.kp[0] * high + kq[0], h.kp[1] * high + kq[1]],
                &mut mixed[1],
            );
        }

        *out = [S::zero(); DOF * DOF];
        by_lines.add_to(out);
        let gradients = [nodes[0].shear_gradient(), nodes[1].shear_gradient()];
        lines::add_mixed(&mixed[0], &gradients[0], 0, out);
        lines::add_mixed(&mixed[1], &gradients[1], 1, out);
        let by_thickness = self.thickness_gradient([nodes[0].thickness, nodes[1].thickness]);
        let thickness = self.transverse_stiffness * self.length / 6.0;
        unroll!(for k in 0..2 {
            let (own, first) = ([left, right][k], 6 * k + 2);
            let hessian = nodes[k].shear_hessian(by_shear[k]);
            let (u, other) = (nodes[k].u, nodes[1 - k].u);
            unroll!(for i in 0..4 {
                let row = (first + i) * DOF;
                let (by_own, by_other) = (gradients[k][i] * own, gradients[k][i] * both);
                unroll!(for j in 0..4 {
                    out[row + first + j] += by_own * gradients[k][j] + hessian[i][j];
                    out[row + 8 - 6 * k + j] += by_other * gradients[1 - k][j];
                });
            });
            let curved = by_thickness[k] * nodes[k].per_thickness;
            let along = -curved + 2.0 * thickness;
            unroll!(for i in 0..2 {
                let row = (first + 2 + i) * DOF;
                unroll!(for j in 0..2 {
                    out[row + first + 2 + j] += u[i] * along * u[j];
                    out[row + 10 - 6 * k + j] += u[i] * other[j] * thickness;
                });
                out[row + first + 2 + i] += curved;
            });
        });
    }

    fn is_damped(&self) -> bool {
        self.damping_time > 0.0
    }

    #[inline(always)]
    fn damped_force<S: Scalar>(&self, e: &[S], rate: &[S], force: &mut [S]) {
        let (e, rate) = (coordinates(e), coordinates(rate));
        self.write_force(e, Some(rate), coordinates_mut(force));
    }

    #[inline(always)]
    fn add_damping_force<S: Scalar>(&self, e: &[S], rate: &[S], force: &mut [S]) {
        self.subtract_damping(coordinates(e), coordinates(rate), coordinates_mut(force));
    }

    #[inline(always)]
    fn add_damping_tangent<S: Scalar>(
        &self,
        e: &[S],
        rate: &[S],
        position_factor: f64,
        rate_factor: f64,
        tangent: &mut [S],
    ) {
        self.add_damping_matrix(
            coordinates(e),
            coordinates(rate),
            [position_factor, rate_factor],
            matrix_mut(tangent),
        );
    }

    fn vector_mass(&self, mass: &mut [f64]) {
        let l = self.length;
        mass.fill(0.0);
        let line = self.line_density * l / 420.0;
        let hermite = hermite::mass(l);
        for (i, row) in hermite::VECTORS.into_iter().enumerate() {
            for (j, column) in hermite::VECTORS.into_iter().enumerate() {
                mass[6 * row + column] = line * hermite[i][j];
            }
        }
        let rotary = self.rotary_density * l / 6.0;
        for (row, column, factor) in [(2, 2, 2.0), (2, 5, 1.0), (5, 2, 1.0), (5, 5, 2.0)] {
            mass[6 * row + column] = rotary * factor;
        }
    }

    fn reference(&self, e: &mut [f64]) {
        e[..DOF].copy_from_slice(&[
            0.0,
            0.0,
            1.0,
            0.0,
            0.0,
            1.0,
            self.length,
            0.0,
            1.0,
            0.0,
            0.0,
            1.0,
        ]);
    }

    fn energy_scale(&self) -> f64 {
        self.transverse_stiffness * self.length
    }

    fn check(&self) -> Result<(), Unsound> {
        self.sound
    }
}

impl LineElement for BeltBeam2 {
    const CENTRE_VECTORS: &'static [usize] = &hermite::VECTORS;
    const SECTION_VECTORS: [usize; 2] = [2, 5];

    fn length(&self) -> f64 {
        self.length
    }

    fn centre_line(&self, xi: f64, weights: &mut [f64]) {
        hermite::spread(hermite::value(xi, self.length), hermite::VECTORS, weights);
    }

    fn centre_line_slope(&self, xi: f64, weights: &mut [f64]) {
        hermite::spread(hermite::slope(xi, self.length), hermite::VECTORS, weights);
    }

    fn jacobian(&self, e: &[f64], xi: f64) -> f64 {
        let c = self.slope(e, xi);
        let thickness = |axis: usize| (1.0 - xi) * e[4 + axis] + xi * e[10 + axis];
        c[0] * thickness(1) - c[1] * thickness(0)
    }

    /// The true axial force `EA (f² - 1) / 2 f` of the stretch `f` of the centre line.
    fn axial_force(&self, e: &[f64], xi: f64) -> f64 {
        let c = self.slope(e, xi);
        let square = c[0] * c[0] + c[1] * c[1];
        self.axial_stiffness * 0.5 * (square - 1.0) * square.sqrt()
    }
}
