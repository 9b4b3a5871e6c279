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
//! (alphas absorbed). Derivatives go through `(a, kappa, p, q)` to `(c, c', p, q)`, which are linear
//! in the slopes and in the two nodal shear values; those depend on four coordinates of a node each.

use std::num::NonZeroUsize;

use super::{Element, LineElement};
use crate::material::Isotropic;
use crate::quadrature::Rule;
use crate::scalar::Scalar;
use crate::section::PlanarSection;

/// Shear correction factor of the rectangle, as published.
const SHEAR_CORRECTION: f64 = 5.0 / 6.0;

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
    /// alpha2 E I2 [N m²].
    bending_stiffness: f64,
    /// alpha2 E I4 [N m⁴].
    fourth_stiffness: f64,
    /// alpha2 ks G A [N].
    shear_stiffness: f64,
    /// alpha2 ks G I2 [N m²].
    shear_gradient_stiffness: f64,
    /// Kelvin-Voigt time of axial strain and curvature [s].
    damping_time: f64,
    points: [Point; POINTS],
}

/// Shape functions at one quadrature point.
#[derive(Clone, Debug, PartialEq)]
struct Point {
    /// Weight times length [m].
    weight: f64,
    /// xi.
    xi: f64,
    /// Derivative by x of the four Hermite functions.
    slope: [f64; 4],
    /// Second derivative by x.
    curve: [f64; 4],
}

/// Cubic Hermite functions of (r1, r1_x, r2, r2_x) at `xi` on an element of length `l`.
fn hermite(xi: f64, l: f64) -> [f64; 4] {
    let (x2, x3) = (xi * xi, xi * xi * xi);
    [
        1.0 - 3.0 * x2 + 2.0 * x3,
        l * (xi - 2.0 * x2 + x3),
        3.0 * x2 - 2.0 * x3,
        l * (x3 - x2),
    ]
}

/// First derivatives by x of [`hermite`].
fn hermite_slope(xi: f64, l: f64) -> [f64; 4] {
    let x2 = xi * xi;
    [
        6.0 * (x2 - xi) / l,
        1.0 - 4.0 * xi + 3.0 * x2,
        6.0 * (xi - x2) / l,
        3.0 * x2 - 2.0 * xi,
    ]
}

/// Second derivatives by x of [`hermite`].
fn hermite_curve(xi: f64, l: f64) -> [f64; 4] {
    [
        (12.0 * xi - 6.0) / (l * l),
        (6.0 * xi - 4.0) / l,
        (6.0 - 12.0 * xi) / (l * l),
        (6.0 * xi - 2.0) / l,
    ]
}

/// Where the four Hermite functions find their vectors among the element's six.
const HERMITE_VECTORS: [usize; 4] = [0, 1, 3, 4];

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
            let xi = rule.points[i];
            Point {
                weight: rule.weights[i] * length,
                xi,
                slope: hermite_slope(xi, length),
                curve: hermite_curve(xi, length),
            }
        });
        Self {
            length,
            line_density: material.density * section.area,
            rotary_density: material.density * section.second_moment,
            transverse_stiffness: youngs * section.area,
            axial_stiffness: axial_factor * youngs * section.area,
            bending_stiffness: bending_factor * youngs * section.second_moment,
            fourth_stiffness: bending_factor * youngs * section.fourth_moment,
            shear_stiffness: bending_factor * shear * section.area,
            shear_gradient_stiffness: bending_factor * shear * section.second_moment,
            damping_time,
            points,
        }
    }

    /// Slope, its derivative and the shear at a point.
    #[inline(always)]
    fn kinematics<S: Scalar>(&self, point: &Point, e: &[S; DOF], shear: [S; 2]) -> Kinematics<S> {
        let combine = |weights: &[f64; 4], axis: usize| {
            let mut sum = S::zero();
            for (weight, vector) in weights.iter().zip(HERMITE_VECTORS) {
                sum += e[2 * vector + axis] * *weight;
            }
            sum
        };
        let c = [combine(&point.slope, 0), combine(&point.slope, 1)];
        let k = [combine(&point.curve, 0), combine(&point.curve, 1)];
        let a = c[0] * c[0] + c[1] * c[1];
        let per_a = a.recip();
        let kappa = (c[0] * k[1] - c[1] * k[0]) * per_a;
        let p = shear[0] * (1.0 - point.xi) + shear[1] * point.xi;
        let q = (shear[1] - shear[0]) * (1.0 / self.length);
        Kinematics {
            c,
            k,
            a,
            per_a,
            kappa,
            p,
            q,
            bend: kappa + q,
        }
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

/// The quantities of the module's head at one point.
struct Kinematics<S> {
    c: [S; 2],
    k: [S; 2],
    a: S,
    per_a: S,
    kappa: S,
    p: S,
    q: S,
    bend: S,
}

impl<S: Scalar> Kinematics<S> {
    /// `d kappa / dc` and `d kappa / dc'`.
    #[inline(always)]
    fn kappa_gradient(&self) -> ([S; 2], [S; 2]) {
        let Self {
            c, k, per_a, kappa, ..
        } = self;
        (
            [
                (k[1] - *kappa * c[0] * 2.0) * *per_a,
                (-k[0] - *kappa * c[1] * 2.0) * *per_a,
            ],
            [-c[1] * *per_a, c[0] * *per_a],
        )
    }
}

/// Nodal shear `-t . u`, `u = r_y / |r_y|`, thickness strain, and what their derivatives need.
struct Node<S> {
    t: [S; 2],
    u: [S; 2],
    per_slope: S,
    per_thickness: S,
    shear: S,
    thickness: S,
}

impl<S: Scalar> Node<S> {
    #[inline(always)]
    fn new(e: &[S; DOF], node: usize) -> Self {
        let [c0, c1, d0, d1] = std::array::from_fn(|i| e[6 * node + 2 + i]);
        let thickness = (d0 * d0 + d1 * d1).sqrt();
        let per_slope = (c0 * c0 + c1 * c1).sqrt().recip();
        let per_thickness = thickness.recip();
        let t = [c0 * per_slope, c1 * per_slope];
        let u = [d0 * per_thickness, d1 * per_thickness];
        Self {
            t,
            u,
            per_slope,
            per_thickness,
            shear: -(t[0] * u[0] + t[1] * u[1]),
            thickness: thickness - 1.0,
        }
    }

    /// Gradient of the shear by (r_x, r_y) of the node.
    #[inline(always)]
    fn shear_gradient(&self) -> [S; 4] {
        let Self {
            t,
            u,
            per_slope,
            per_thickness,
            shear,
            ..
        } = self;
        [
            -(u[0] + *shear * t[0]) * *per_slope,
            -(u[1] + *shear * t[1]) * *per_slope,
            -(t[0] + *shear * u[0]) * *per_thickness,
            -(t[1] + *shear * u[1]) * *per_thickness,
        ]
    }

    /// Hessian of the shear by (r_x, r_y) of the node.
    #[inline(always)]
    fn shear_hessian(&self) -> [[S; 4]; 4] {
        let (t, u, cosine) = (self.t, self.u, -self.shear);
        let (ss, st, tt) = (
            self.per_slope * self.per_slope,
            self.per_slope * self.per_thickness,
            self.per_thickness * self.per_thickness,
        );
        let mut h = [[S::zero(); 4]; 4];
        for i in 0..2 {
            for j in 0..2 {
                let unit = if i == j { 1.0 } else { 0.0 };
                let mixed = t[i] * u[j] + u[i] * t[j];
                h[i][j] = (mixed + cosine * unit - cosine * t[i] * t[j] * 3.0) * ss;
                h[2 + i][2 + j] = (mixed + cosine * unit - cosine * u[i] * u[j] * 3.0) * tt;
                // -(1 - t t)(1 - u u)
                h[i][2 + j] = (t[i] * t[j] + u[i] * u[j] - cosine * t[i] * u[j] - unit) * st;
                h[2 + j][i] = h[i][2 + j];
            }
        }
        h
    }
}

#[inline(always)]
fn coordinates<S: Scalar>(e: &[S]) -> &[S; DOF] {
    let Some(e) = e.first_chunk::<DOF>() else {
        panic!("a belt beam has {DOF} coordinates, not {}", e.len());
    };
    e
}

impl Element for BeltBeam2 {
    const DIMENSION: usize = 2;
    const NODES: usize = 2;
    const NODE_VECTORS: usize = 3;

    fn energy<S: Scalar>(&self, e: &[S]) -> S {
        let e = coordinates(e);
        let nodes = [Node::new(e, 0), Node::new(e, 1)];
        let (y0, y1) = (nodes[0].thickness, nodes[1].thickness);
        let mut energy =
            (y0 * y0 + y0 * y1 + y1 * y1) * (self.transverse_stiffness * self.length / 6.0);
        for point in &self.points {
            let at = self.kinematics(point, e, [nodes[0].shear, nodes[1].shear]);
            let stretch = at.a - 1.0;
            let b = at.bend * at.bend + at.p * at.p * at.kappa * at.kappa;
            let density = stretch * stretch * (self.axial_stiffness / 8.0)
                + (at.a * at.bend * at.bend + stretch * b * 0.5) * (self.bending_stiffness / 2.0)
                + b * b * (self.fourth_stiffness / 8.0)
                + at.p * at.p * at.a * (self.shear_stiffness / 2.0)
                + at.p * at.p * at.q * at.q * (self.shear_gradient_stiffness / 2.0);
            energy += density * point.weight;
        }
        energy
    }

    #[inline(always)]
    fn force<S: Scalar>(&self, e: &[S], force: &mut [S]) {
        let e = coordinates(e);
        let nodes = [Node::new(e, 0), Node::new(e, 1)];
        let shear = [nodes[0].shear, nodes[1].shear];
        let mut out = [S::zero(); DOF];
        let mut by_shear = [S::zero(); 2];
        for point in &self.points {
            let at = self.kinematics(point, e, shear);
            let stretch = at.a - 1.0;
            let twist = at.p * at.kappa;
            let b = at.bend * at.bend + twist * twist;
            let by_b = (stretch * (self.bending_stiffness / 4.0)
                + b * (self.fourth_stiffness / 4.0))
                * point.weight;
            let by_a = (stretch * (self.axial_stiffness / 4.0)
                + (at.bend * at.bend + b * 0.5) * (self.bending_stiffness / 2.0)
                + at.p * at.p * (self.shear_stiffness / 2.0))
                * point.weight;
            let by_bend =
                at.a * at.bend * (self.bending_stiffness * point.weight) + by_b * at.bend * 2.0;
            let by_kappa = by_bend + by_b * at.p * twist * 2.0;
            let shear_gradient = at.p * at.q * (self.shear_gradient_stiffness * point.weight);
            let by_p = by_b * twist * at.kappa * 2.0
                + at.a * at.p * (self.shear_stiffness * point.weight)
                + shear_gradient * at.q;
            let (kappa_c, kappa_k) = at.kappa_gradient();
            for axis in 0..2 {
                let by_c = by_a * at.c[axis] * 2.0 + by_kappa * kappa_c[axis];
                let by_k = by_kappa * kappa_k[axis];
                for (i, vector) in HERMITE_VECTORS.into_iter().enumerate() {
                    out[2 * vector + axis] -= by_c * point.slope[i] + by_k * point.curve[i];
                }
            }
            let by_q = (by_bend + shear_gradient * at.p) * (1.0 / self.length);
            by_shear[0] += by_p * (1.0 - point.xi) - by_q;
            by_shear[1] += by_p * point.xi + by_q;
        }
        let by_thickness = self.thickness_gradient([nodes[0].thickness, nodes[1].thickness]);
        for (k, node) in nodes.iter().enumerate() {
            let gradient = node.shear_gradient();
            for i in 0..4 {
                out[6 * k + 2 + i] -= by_shear[k] * gradient[i];
            }
            for axis in 0..2 {
                out[6 * k + 4 + axis] -= by_thickness[k] * node.u[axis];
            }
        }
        force[..DOF].copy_from_slice(&out);
    }

    #[inline(always)]
    fn stiffness<S: Scalar>(&self, e: &[S], stiffness: &mut [S]) {
        let e = coordinates(e);
        let nodes = [Node::new(e, 0), Node::new(e, 1)];
        let shear = [nodes[0].shear, nodes[1].shear];
        // Hessian over the eight Hermite coordinates (row-major, axis by axis) and two shears.
        let mut rr = [[[[S::zero(); 4]; 4]; 2]; 2];
        let mut rs = [[[S::zero(); 2]; 4]; 2];
        let mut ss = [[S::zero(); 2]; 2];
        let mut by_shear = [S::zero(); 2];
        let per_length = 1.0 / self.length;
        for point in &self.points {
            let at = self.kinematics(point, e, shear);
            let h = self.hessian(&at, point.weight);
            let (left, right) = (1.0 - point.xi, point.xi);
            by_shear[0] += h.by_p * left - h.by_q * per_length;
            by_shear[1] += h.by_p * right + h.by_q * per_length;
            // (p, q) = B (shear 1, shear 2)
            let (pp, pq, qq) = (h.pp, h.pq * per_length, h.qq * (per_length * per_length));
            ss[0][0] += pp * (left * left) - pq * (2.0 * left) + qq;
            ss[0][1] += pp * (left * right) + pq * (left - right) - qq;
            ss[1][1] += pp * (right * right) + pq * (2.0 * right) + qq;
            for axis in 0..2 {
                let cq = h.cq[axis] * per_length;
                let kq = h.kq[axis] * per_length;
                let c_shear = [h.cp[axis] * left - cq, h.cp[axis] * right + cq];
                let k_shear = [h.kp[axis] * left - kq, h.kp[axis] * right + kq];
                for i in 0..4 {
                    for s in 0..2 {
                        rs[axis][i][s] += c_shear[s] * point.slope[i] + k_shear[s] * point.curve[i];
                    }
                }
            }
            for (m, n) in [(0, 0), (0, 1), (1, 1)] {
                for i in 0..4 {
                    let to_c = h.cc[m][n] * point.slope[i] + h.ck[n][m] * point.curve[i];
                    let to_k = h.ck[m][n] * point.slope[i] + h.kk[m][n] * point.curve[i];
                    for j in 0..4 {
                        rr[m][n][i][j] += to_c * point.slope[j] + to_k * point.curve[j];
                    }
                }
            }
        }
        ss[1][0] = ss[0][1];

        let mut out = [[S::zero(); DOF]; DOF];
        for i in 0..4 {
            for j in 0..4 {
                let (row, column) = (2 * HERMITE_VECTORS[i], 2 * HERMITE_VECTORS[j]);
                out[row][column] = rr[0][0][i][j];
                out[row][column + 1] = rr[0][1][i][j];
                out[row + 1][column] = rr[0][1][j][i];
                out[row + 1][column + 1] = rr[1][1][i][j];
            }
        }
        let gradients = [nodes[0].shear_gradient(), nodes[1].shear_gradient()];
        for k in 0..2 {
            let first = 6 * k + 2;
            for i in 0..4 {
                let row = 2 * HERMITE_VECTORS[i];
                for axis in 0..2 {
                    for j in 0..4 {
                        let value = rs[axis][i][k] * gradients[k][j];
                        out[row + axis][first + j] += value;
                        out[first + j][row + axis] += value;
                    }
                }
            }
            for m in 0..2 {
                for i in 0..4 {
                    let scaled = ss[k][m] * gradients[k][i];
                    for j in 0..4 {
                        out[first + i][6 * m + 2 + j] += scaled * gradients[m][j];
                    }
                }
            }
            let hessian = nodes[k].shear_hessian();
            for i in 0..4 {
                for j in 0..4 {
                    out[first + i][first + j] += by_shear[k] * hessian[i][j];
                }
            }
        }
        let by_thickness = self.thickness_gradient([nodes[0].thickness, nodes[1].thickness]);
        let factor = self.transverse_stiffness * self.length / 6.0;
        for k in 0..2 {
            let (u, other) = (nodes[k].u, nodes[1 - k].u);
            let curved = by_thickness[k] * nodes[k].per_thickness;
            for i in 0..2 {
                for j in 0..2 {
                    let unit = if i == j { 1.0 } else { 0.0 };
                    out[6 * k + 4 + i][6 * k + 4 + j] +=
                        u[i] * u[j] * (2.0 * factor) + curved * (-(u[i] * u[j]) + unit);
                    out[6 * k + 4 + i][6 * (1 - k) + 4 + j] += u[i] * other[j] * factor;
                }
            }
        }
        for (row, values) in stiffness.chunks_exact_mut(DOF).zip(&out) {
            row.copy_from_slice(values);
        }
    }

    fn is_damped(&self) -> bool {
        self.damping_time > 0.0
    }

    /// Kelvin-Voigt forces `-tau (EA e' de/dq + EI2 kappa' dkappa/dq)` of the axial Green strain
    /// `e = (a - 1) / 2` and the turning `kappa`: both are zero in rigid motion.
    fn add_damping_force<S: Scalar>(&self, e: &[S], rate: &[S], force: &mut [S]) {
        let (e, rate) = (coordinates(e), coordinates(rate));
        let none = [S::zero(); 2];
        for point in &self.points {
            let at = self.kinematics(point, e, none);
            let moving = self.kinematics(point, rate, none);
            let (kappa_c, kappa_k) = at.kappa_gradient();
            let (dc, dk) = (moving.c, moving.k);
            let strain_rate = at.c[0] * dc[0] + at.c[1] * dc[1];
            let kappa_rate =
                kappa_c[0] * dc[0] + kappa_c[1] * dc[1] + kappa_k[0] * dk[0] + kappa_k[1] * dk[1];
            let time = self.damping_time * point.weight;
            let axial = strain_rate * (time * self.axial_stiffness);
            let bending = kappa_rate * (time * self.bending_stiffness);
            for axis in 0..2 {
                let by_c = axial * at.c[axis] + bending * kappa_c[axis];
                let by_k = bending * kappa_k[axis];
                for (i, vector) in HERMITE_VECTORS.into_iter().enumerate() {
                    force[2 * vector + axis] -= by_c * point.slope[i] + by_k * point.curve[i];
                }
            }
        }
    }

    fn add_damping_tangent<S: Scalar>(
        &self,
        e: &[S],
        rate: &[S],
        position_factor: f64,
        rate_factor: f64,
        tangent: &mut [S],
    ) {
        let (e, rate) = (coordinates(e), coordinates(rate));
        let none = [S::zero(); 2];
        for point in &self.points {
            let at = self.kinematics(point, e, none);
            let moving = self.kinematics(point, rate, none);
            let (kappa_c, kappa_k) = at.kappa_gradient();
            let gradient = [kappa_c[0], kappa_c[1], kappa_k[0], kappa_k[1]];
            let hessian = kappa_hessian(&at);
            let change = [moving.c[0], moving.c[1], moving.k[0], moving.k[1]];
            // d(rate of kappa)/d(c, c') at fixed rates
            let mut turned = [S::zero(); 4];
            let mut kappa_rate = S::zero();
            for i in 0..4 {
                kappa_rate += gradient[i] * change[i];
                for j in 0..4 {
                    turned[i] += hessian[i][j] * change[j];
                }
            }
            let strain_rate = at.c[0] * change[0] + at.c[1] * change[1];
            let time = self.damping_time * point.weight;
            let (axial, bending) = (time * self.axial_stiffness, time * self.bending_stiffness);
            let mut local = [[S::zero(); 4]; 4];
            for i in 0..4 {
                for j in 0..4 {
                    local[i][j] = (gradient[i] * turned[j] + kappa_rate * hessian[i][j])
                        * (bending * position_factor)
                        + gradient[i] * gradient[j] * (bending * rate_factor);
                }
            }
            for i in 0..2 {
                for j in 0..2 {
                    local[i][j] += at.c[i] * change[j] * (axial * position_factor)
                        + at.c[i] * at.c[j] * (axial * rate_factor);
                }
                local[i][i] += strain_rate * (axial * position_factor);
            }
            for (i, row_vector) in HERMITE_VECTORS.into_iter().enumerate() {
                for m in 0..2 {
                    let row = (2 * row_vector + m) * DOF;
                    for (j, column_vector) in HERMITE_VECTORS.into_iter().enumerate() {
                        for n in 0..2 {
                            tangent[row + 2 * column_vector + n] += local[m][n]
                                * (point.slope[i] * point.slope[j])
                                + local[m][2 + n] * (point.slope[i] * point.curve[j])
                                + local[2 + m][n] * (point.curve[i] * point.slope[j])
                                + local[2 + m][2 + n] * (point.curve[i] * point.curve[j]);
                        }
                    }
                }
            }
        }
    }

    fn vector_mass(&self, mass: &mut [f64]) {
        let l = self.length;
        mass.fill(0.0);
        let line = self.line_density * l / 420.0;
        let hermite = [
            [156.0, 22.0 * l, 54.0, -13.0 * l],
            [22.0 * l, 4.0 * l * l, 13.0 * l, -3.0 * l * l],
            [54.0, 13.0 * l, 156.0, -22.0 * l],
            [-13.0 * l, -3.0 * l * l, -22.0 * l, 4.0 * l * l],
        ];
        for (i, row) in HERMITE_VECTORS.into_iter().enumerate() {
            for (j, column) in HERMITE_VECTORS.into_iter().enumerate() {
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
}

/// First and second derivatives of the energy at a point, by (c, c', p, q), times the weight.
struct Hessian<S> {
    by_p: S,
    by_q: S,
    cc: [[S; 2]; 2],
    ck: [[S; 2]; 2],
    kk: [[S; 2]; 2],
    cp: [S; 2],
    cq: [S; 2],
    kp: [S; 2],
    kq: [S; 2],
    pp: S,
    pq: S,
    qq: S,
}

/// Hessian of kappa by (c, c'): from `a kappa = c x c'` differentiated twice.
#[inline(always)]
fn kappa_hessian<S: Scalar>(at: &Kinematics<S>) -> [[S; 4]; 4] {
    let (kappa_c, kappa_k) = at.kappa_gradient();
    let mut h = [[S::zero(); 4]; 4];
    for i in 0..2 {
        for j in 0..2 {
            let unit = if i == j { 1.0 } else { 0.0 };
            h[i][j] =
                -(at.kappa * unit + at.c[i] * kappa_c[j] + kappa_c[i] * at.c[j]) * at.per_a * 2.0;
            let cross = [[0.0, 1.0], [-1.0, 0.0]][i][j];
            h[i][2 + j] = (-(at.c[i] * kappa_k[j]) * 2.0 + cross) * at.per_a;
            h[2 + j][i] = h[i][2 + j];
        }
    }
    h
}

impl BeltBeam2 {
    #[inline(always)]
    fn hessian<S: Scalar>(&self, at: &Kinematics<S>, weight: f64) -> Hessian<S> {
        let (ei2, ei4) = (
            self.bending_stiffness * weight,
            self.fourth_stiffness * weight,
        );
        let (shear, shear_gradient) = (
            self.shear_stiffness * weight,
            self.shear_gradient_stiffness * weight,
        );
        let (a, kappa, p, q, bend) = (at.a, at.kappa, at.p, at.q, at.bend);
        let stretch = a - 1.0;
        let twist = p * kappa;
        let b = bend * bend + twist * twist;
        let b_kappa = (bend + p * twist) * 2.0;
        let b_p = twist * kappa * 2.0;
        let b_q = bend * 2.0;

        let by_b = stretch * (ei2 / 4.0) + b * (ei4 / 4.0);
        let by_a = stretch * (self.axial_stiffness * weight / 4.0)
            + (bend * bend + b * 0.5) * (ei2 / 2.0)
            + p * p * (shear / 2.0);
        let by_bend = a * bend * ei2;
        let by_kappa = by_bend + by_b * b_kappa;
        let bb = ei4 / 4.0;
        let aa = self.axial_stiffness * weight / 4.0;
        let a_kappa = bend * ei2 + b_kappa * (ei2 / 4.0);
        let a_p = b_p * (ei2 / 4.0) + p * shear;
        let a_q = bend * ei2 + b_q * (ei2 / 4.0);
        let kappa_kappa = a * ei2 + b_kappa * b_kappa * bb + by_b * (p * p + 1.0) * 2.0;
        let kappa_p = b_kappa * b_p * bb + by_b * twist * 4.0;
        let kappa_q = a * ei2 + b_kappa * b_q * bb + by_b * 2.0;

        let (kappa_c, kappa_k) = at.kappa_gradient();
        let curved = kappa_hessian(at);
        let mut cc = [[S::zero(); 2]; 2];
        let mut ck = [[S::zero(); 2]; 2];
        let mut kk = [[S::zero(); 2]; 2];
        for i in 0..2 {
            for j in 0..2 {
                let unit = if i == j { 2.0 } else { 0.0 };
                cc[i][j] = at.c[i] * at.c[j] * (4.0 * aa)
                    + by_a * unit
                    + a_kappa * (at.c[i] * kappa_c[j] + kappa_c[i] * at.c[j]) * 2.0
                    + kappa_kappa * kappa_c[i] * kappa_c[j]
                    + by_kappa * curved[i][j];
                ck[i][j] = a_kappa * at.c[i] * kappa_k[j] * 2.0
                    + kappa_kappa * kappa_c[i] * kappa_k[j]
                    + by_kappa * curved[i][2 + j];
                kk[i][j] = kappa_kappa * kappa_k[i] * kappa_k[j];
            }
        }
        Hessian {
            by_p: by_b * b_p + a * p * shear + p * q * q * shear_gradient,
            by_q: by_bend + by_b * b_q + p * p * q * shear_gradient,
            cc,
            ck,
            kk,
            cp: std::array::from_fn(|i| a_p * at.c[i] * 2.0 + kappa_p * kappa_c[i]),
            cq: std::array::from_fn(|i| a_q * at.c[i] * 2.0 + kappa_q * kappa_c[i]),
            kp: std::array::from_fn(|i| kappa_p * kappa_k[i]),
            kq: std::array::from_fn(|i| kappa_q * kappa_k[i]),
            pp: b_p * b_p * bb + by_b * kappa * kappa * 2.0 + a * shear + q * q * shear_gradient,
            pq: b_p * b_q * bb + p * q * (2.0 * shear_gradient),
            qq: a * ei2 + b_q * b_q * bb + by_b * 2.0 + p * p * shear_gradient,
        }
    }
}

impl LineElement for BeltBeam2 {
    const CENTRE_VECTORS: &'static [usize] = &HERMITE_VECTORS;

    fn length(&self) -> f64 {
        self.length
    }

    fn centre_line(&self, xi: f64, weights: &mut [f64]) {
        spread(hermite(xi, self.length), weights);
    }

    fn centre_line_slope(&self, xi: f64, weights: &mut [f64]) {
        spread(hermite_slope(xi, self.length), weights);
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

fn spread(hermite: [f64; 4], weights: &mut [f64]) {
    weights[..6].fill(0.0);
    for (value, vector) in hermite.into_iter().zip(HERMITE_VECTORS) {
        weights[vector] = value;
    }
}
