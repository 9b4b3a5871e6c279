//! The planar cubic beam of Omar & Shabana (2001): 12 coordinates, straight or curved reference.
//!
//! As used by Kerkkänen (2006, 2.13-2.17, 3.11). Coordinates `e = [r1, r1_x, r1_y, r2, r2_x, r2_y]`,
//! `xi = x / l`:
//!
//! ```text
//! r = r_c + y [(1 - xi) r1_y + xi r2_y],   r_c cubic Hermite in (r, r_x)             (3.11)
//! D = J J0^-1,  J = dr/d(x, y)             eps = (D^T D - 1) / 2                      (2.13, 2.14)
//! U = 1/2 ∫ (lambda + 2 mu) (exx² + eyy²) + 2 lambda exx eyy + mu (2 exy)² dV         (2.16, 2.17)
//! M = ∫ rho S^T S dV
//! ```
//!
//! Plane strain, no shear correction: the published element, with its locking by Poisson's ratio.
//!
//! # As coded
//! Straight reference (J0 = 1 in the element's axes): `U = ∫ W(c, w, d) dx` with `c = r_c,x`,
//! `w = (r2_y - r1_y) / l`, `d = (1 - xi) r1_y + xi r2_y` and the closed section integrals of
//! `plane_section.rs`; four Gauss points along x.
//!
//! Curved reference (nodal coordinates `E`, `J0 = dR/d(x, y)` from the same shape functions): J0^-1 is
//! rational in y, so the section is a rule of three points `y = 0, ±sqrt(I4 / I2)` with the weights
//! `A - I2²/I4, I2²/(2 I4)` that has the section's moments up to y⁵: exact for the straight element,
//! Gauss-Legendre for a rectangle. `D = sum_k e_k g_k^T` with the constant gradients
//! `g_k = J0^-T (S_k,x, S_k,y)`. The law is isotropic, so the axes of J0 do not matter.

use std::num::NonZeroUsize;

use thiserror::Error;

use super::hermite;
use super::plane_section::{PlaneSection, Vectors};
use super::{Element, LineElement};
use crate::material::Isotropic;
use crate::quadrature::Rule;
use crate::scalar::Scalar;
use crate::section::PlanarSection;

/// Gauss points along the element, as published.
const POINTS: usize = 4;

/// Points of the section of a curved element.
const SECTION_POINTS: usize = 3;

const CURVED_POINTS: usize = POINTS * SECTION_POINTS;

/// Gauss points of the mass of a curved element: exact to the degree 11 of S^T S det J0.
const MASS_POINTS: usize = 6;

const DOF: usize = 12;

/// A planar cubic beam, free of stress in its straight or curved reference.
#[derive(Clone, Debug, PartialEq)]
pub struct CubicBeam2 {
    length: f64,
    per_length: f64,
    axial_stiffness: f64,
    reference: [f64; DOF],
    vector_mass: [f64; 36],
    integration: Integration,
}

/// The reference coordinates of a curved beam turn its material inside out somewhere.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[error(
    "the reference of a cubic beam is folded at xi = {xi}, y = {y} m (det J0 = {jacobian}); \
     r_y must lie to the left of r_x, and the radius of curvature must exceed half the height"
)]
pub struct FoldedReference {
    /// Place along the element.
    pub xi: f64,
    /// Place in the section [m].
    pub y: f64,
    /// Determinant of J0 there.
    pub jacobian: f64,
}

#[derive(Clone, Debug, PartialEq)]
enum Integration {
    Straight(PlaneSection, [Point; POINTS]),
    Curved(Moduli, PlanarSection, Box<[CurvedPoint; CURVED_POINTS]>),
}

/// A point of the centre line.
#[derive(Clone, Debug, PartialEq)]
struct Point {
    /// Weight times length [m].
    weight: f64,
    xi: f64,
    slope: [f64; 4],
}

/// lambda + 2 mu, lambda and mu [Pa].
#[derive(Clone, Debug, PartialEq)]
struct Moduli {
    normal: f64,
    coupling: f64,
    shear: f64,
}

/// A material point of a curved element.
#[derive(Clone, Debug, PartialEq)]
struct CurvedPoint {
    /// Weight times volume [m³].
    weight: f64,
    /// Gradients of the six shape functions by the reference place.
    gradients: [[f64; 2]; 6],
}

impl Moduli {
    fn new(material: &Isotropic) -> Self {
        let shear = material.shear_modulus();
        let coupling = material.lame_lambda();
        Self {
            normal: coupling + 2.0 * shear,
            coupling,
            shear,
        }
    }

    /// Second Piola-Kirchhoff stress (xx, yy, xy) of the gradient `[D e_x, D e_y]`.
    #[inline(always)]
    fn stress<S: Scalar>(&self, [f, g]: [[S; 2]; 2]) -> [S; 3] {
        let exx = (f[0] * f[0] + f[1] * f[1] - 1.0) * 0.5;
        let eyy = (g[0] * g[0] + g[1] * g[1] - 1.0) * 0.5;
        [
            exx * self.normal + eyy * self.coupling,
            eyy * self.normal + exx * self.coupling,
            (f[0] * g[0] + f[1] * g[1]) * self.shear,
        ]
    }

    /// First Piola-Kirchhoff stress, column by column.
    #[inline(always)]
    fn nominal_stress<S: Scalar>(&self, [f, g]: [[S; 2]; 2]) -> [[S; 2]; 2] {
        let [xx, yy, xy] = self.stress([f, g]);
        [
            [f[0] * xx + g[0] * xy, f[1] * xx + g[1] * xy],
            [f[0] * xy + g[0] * yy, f[1] * xy + g[1] * yy],
        ]
    }
}

/// `(y, area)` of the three points that have the section's moments up to y⁵.
fn section_rule(section: &PlanarSection) -> [(f64, f64); SECTION_POINTS] {
    let y = (section.fourth_moment / section.second_moment).sqrt();
    let outer = section.second_moment.powi(2) / (2.0 * section.fourth_moment);
    [(-y, outer), (0.0, section.area - 2.0 * outer), (y, outer)]
}

/// Derivatives of the six shape functions by the parameters x and y.
fn shape_derivatives(xi: f64, y: f64, l: f64) -> [[f64; 2]; 6] {
    let mut derivatives = [[0.0; 2]; 6];
    for (slope, vector) in hermite::slope(xi, l).into_iter().zip(hermite::VECTORS) {
        derivatives[vector][0] = slope;
    }
    derivatives[2] = [-y / l, 1.0 - xi];
    derivatives[5] = [y / l, xi];
    derivatives
}

/// `sum_k e_k s_k^T`, column by column.
#[inline(always)]
fn gradient<S: Scalar>(e: &[S; DOF], shapes: &[[f64; 2]; 6]) -> [[S; 2]; 2] {
    let mut columns = [[S::zero(); 2]; 2];
    for (k, shape) in shapes.iter().enumerate() {
        for column in 0..2 {
            for axis in 0..2 {
                columns[column][axis] += e[2 * k + axis] * shape[column];
            }
        }
    }
    columns
}

/// Rows of the inverse of the matrix with the given columns, and its determinant.
fn inverse([f, g]: [[f64; 2]; 2]) -> ([[f64; 2]; 2], f64) {
    let determinant = f[0] * g[1] - f[1] * g[0];
    (
        [
            [g[1] / determinant, -g[0] / determinant],
            [-f[1] / determinant, f[0] / determinant],
        ],
        determinant,
    )
}

fn gauss(count: usize) -> Rule {
    Rule::gauss(NonZeroUsize::new(count).unwrap_or(NonZeroUsize::MIN))
}

/// rho ∫ S^T S det J0 dV between the six vectors, row-major.
fn mass(reference: &[f64; DOF], length: f64, section: &PlanarSection, density: f64) -> [f64; 36] {
    let rule = gauss(MASS_POINTS);
    let mut mass = [0.0; 36];
    for (xi, weight) in rule.points.iter().zip(&rule.weights) {
        let hermite = hermite::value(*xi, length);
        for (y, area) in section_rule(section) {
            let (_, jacobian) = inverse(gradient(reference, &shape_derivatives(*xi, y, length)));
            let weight = weight * length * area * density * jacobian;
            let [a, b, c, d] = hermite;
            let shapes = [a, b, y * (1.0 - xi), c, d, y * xi];
            for (row, left) in shapes.into_iter().enumerate() {
                for (column, right) in shapes.into_iter().enumerate() {
                    mass[6 * row + column] += left * right * weight;
                }
            }
        }
    }
    mass
}

impl CubicBeam2 {
    /// A straight cubic beam of undeformed length `length` [m].
    #[must_use]
    pub fn new(length: f64, section: &PlanarSection, material: &Isotropic) -> Self {
        let Moduli {
            normal,
            coupling,
            shear,
        } = Moduli::new(material);
        let rule = gauss(POINTS);
        let points = std::array::from_fn(|i| Point {
            weight: rule.weights[i] * length,
            xi: rule.points[i],
            slope: hermite::slope(rule.points[i], length),
        });
        let law = PlaneSection::new(section, normal, coupling, shear);
        let reference = [
            0.0, 0.0, 1.0, 0.0, 0.0, 1.0, length, 0.0, 1.0, 0.0, 0.0, 1.0,
        ];
        let integration = Integration::Straight(law, points);
        Self::assemble(length, reference, section, material, integration)
    }

    /// A cubic beam whose undeformed nodal coordinates are `reference`, on the parameter
    /// `0 <= x <= length` [m] (r_x is the derivative by that x; |r_x| = 1 makes x the arc length).
    ///
    /// # Errors
    /// [`FoldedReference`] where `det J0 <= 0` at an integration point.
    pub fn curved(
        reference: &[f64; DOF],
        length: f64,
        section: &PlanarSection,
        material: &Isotropic,
    ) -> Result<Self, FoldedReference> {
        let rule = gauss(POINTS);
        let across = section_rule(section);
        let place = |i: usize| {
            (
                rule.points[i / SECTION_POINTS],
                across[i % SECTION_POINTS].0,
            )
        };
        let frame = |i: usize| {
            let (xi, y) = place(i);
            let shapes = shape_derivatives(xi, y, length);
            let (rows, jacobian) = inverse(gradient(reference, &shapes));
            (shapes, rows, jacobian)
        };
        for i in 0..CURVED_POINTS {
            let (_, _, jacobian) = frame(i);
            // NaN is no element either.
            if jacobian <= 0.0 || jacobian.is_nan() {
                let (xi, y) = place(i);
                return Err(FoldedReference { xi, y, jacobian });
            }
        }
        let points = Box::new(std::array::from_fn(|i| {
            let (shapes, rows, jacobian) = frame(i);
            let volume = length * across[i % SECTION_POINTS].1 * jacobian;
            CurvedPoint {
                weight: rule.weights[i / SECTION_POINTS] * volume,
                gradients: shapes.map(|[by_x, by_y]| {
                    std::array::from_fn(|j| by_x * rows[0][j] + by_y * rows[1][j])
                }),
            }
        }));
        let integration = Integration::Curved(Moduli::new(material), *section, points);
        let mut centred = *reference;
        for node in [0, 6] {
            centred[node] -= reference[0];
            centred[node + 1] -= reference[1];
        }
        Ok(Self::assemble(
            length,
            centred,
            section,
            material,
            integration,
        ))
    }

    fn assemble(
        length: f64,
        reference: [f64; DOF],
        section: &PlanarSection,
        material: &Isotropic,
        integration: Integration,
    ) -> Self {
        Self {
            length,
            per_length: 1.0 / length,
            axial_stiffness: material.youngs_modulus * section.area,
            reference,
            vector_mass: mass(&reference, length, section, material.density),
            integration,
        }
    }

    /// The section vectors at a point of the centre line.
    #[inline(always)]
    fn section<S: Scalar>(&self, e: &[S; DOF], xi: f64, slope: &[f64; 4]) -> Vectors<S> {
        let at = |axis: usize| {
            let mut c = e[axis] * slope[0];
            c += e[2 + axis] * slope[1];
            c += e[6 + axis] * slope[2];
            c + e[8 + axis] * slope[3]
        };
        let between = |axis: usize| e[4 + axis] * (1.0 - xi) + e[10 + axis] * xi;
        Vectors {
            c: [at(0), at(1)],
            w: [
                (e[10] - e[4]) * self.per_length,
                (e[11] - e[5]) * self.per_length,
            ],
            d: [between(0), between(1)],
        }
    }

    #[inline(always)]
    fn straight_force<S: Scalar>(
        &self,
        law: &PlaneSection,
        points: &[Point; POINTS],
        e: &[S; DOF],
    ) -> [S; DOF] {
        let mut out = [S::zero(); DOF];
        let mut by_w = [S::zero(); 2];
        for point in points {
            let by = law.gradient(self.section(e, point.xi, &point.slope));
            for axis in 0..2 {
                let by_c = by.c[axis] * point.weight;
                let by_d = by.d[axis] * point.weight;
                by_w[axis] += by.w[axis] * point.weight;
                for (slope, vector) in point.slope.iter().zip(hermite::VECTORS) {
                    out[2 * vector + axis] -= by_c * *slope;
                }
                out[4 + axis] -= by_d * (1.0 - point.xi);
                out[10 + axis] -= by_d * point.xi;
            }
        }
        for axis in 0..2 {
            let by_w = by_w[axis] * self.per_length;
            out[4 + axis] += by_w;
            out[10 + axis] -= by_w;
        }
        out
    }

    #[inline(always)]
    fn straight_stiffness<S: Scalar>(
        &self,
        law: &PlaneSection,
        points: &[Point; POINTS],
        e: &[S; DOF],
    ) -> [[S; DOF]; DOF] {
        let mut out = [[S::zero(); DOF]; DOF];
        for point in points {
            let h = law.hessian(self.section(e, point.xi, &point.slope), point.weight);
            // d = left r1_y + right r2_y,  w = (r2_y - r1_y) per_length
            let fibre = [1.0 - point.xi, point.xi];
            let turn = [-self.per_length, self.per_length];
            for i in 0..2 {
                for j in 0..2 {
                    for (a, row) in hermite::VECTORS.into_iter().enumerate() {
                        let scaled = h.cc[i][j] * point.slope[a];
                        for (b, column) in hermite::VECTORS.into_iter().enumerate() {
                            out[2 * row + i][2 * column + j] += scaled * point.slope[b];
                        }
                    }
                    for m in 0..2 {
                        let mixed = h.cw[i][j] * turn[m] + h.cd[i][j] * fibre[m];
                        for (a, row) in hermite::VECTORS.into_iter().enumerate() {
                            out[2 * row + i][6 * m + 4 + j] += mixed * point.slope[a];
                        }
                        for k in 0..2 {
                            out[6 * k + 4 + i][6 * m + 4 + j] += h.ww[i][j] * (turn[k] * turn[m])
                                + h.wd[i][j] * (turn[k] * fibre[m])
                                + h.wd[j][i] * (fibre[k] * turn[m])
                                + h.dd[i][j] * (fibre[k] * fibre[m]);
                        }
                    }
                }
            }
        }
        for fibre in [4, 5, 10, 11] {
            for vector in hermite::VECTORS {
                for axis in 0..2 {
                    out[fibre][2 * vector + axis] = out[2 * vector + axis][fibre];
                }
            }
        }
        out
    }
}

#[inline(always)]
fn curved_force<S: Scalar>(moduli: &Moduli, points: &[CurvedPoint], e: &[S; DOF]) -> [S; DOF] {
    let mut out = [S::zero(); DOF];
    for point in points {
        let stress = moduli.nominal_stress(gradient(e, &point.gradients));
        for (k, shape) in point.gradients.iter().enumerate() {
            for axis in 0..2 {
                out[2 * k + axis] -= stress[0][axis] * (shape[0] * point.weight)
                    + stress[1][axis] * (shape[1] * point.weight);
            }
        }
    }
    out
}

#[inline(always)]
fn curved_stiffness<S: Scalar>(
    moduli: &Moduli,
    points: &[CurvedPoint],
    e: &[S; DOF],
) -> [[S; DOF]; DOF] {
    let mut out = [[S::zero(); DOF]; DOF];
    for point in points {
        let [f, g] = gradient(e, &point.gradients);
        let [xx, yy, xy] = moduli.stress([f, g]);
        for i in 0..2 {
            for j in 0..2 {
                let unit = if i == j { 1.0 } else { 0.0 };
                let f_f = f[i] * f[j] * moduli.normal + g[i] * g[j] * moduli.shear + xx * unit;
                let f_g = f[i] * g[j] * moduli.coupling + g[i] * f[j] * moduli.shear + xy * unit;
                let g_f = g[i] * f[j] * moduli.coupling + f[i] * g[j] * moduli.shear + xy * unit;
                let g_g = g[i] * g[j] * moduli.normal + f[i] * f[j] * moduli.shear + yy * unit;
                for (k, [x, y]) in point.gradients.iter().enumerate() {
                    let (x, y) = (x * point.weight, y * point.weight);
                    let (by_f, by_g) = (f_f * x + g_f * y, f_g * x + g_g * y);
                    for (m, [x, y]) in point.gradients.iter().enumerate() {
                        out[2 * k + i][2 * m + j] += by_f * *x + by_g * *y;
                    }
                }
            }
        }
    }
    out
}

#[inline(always)]
fn coordinates<S: Scalar>(e: &[S]) -> &[S; DOF] {
    let Some(e) = e.first_chunk::<DOF>() else {
        panic!("a cubic beam has {DOF} coordinates, not {}", e.len());
    };
    e
}

impl Element for CubicBeam2 {
    const DIMENSION: usize = 2;
    const NODES: usize = 2;
    const NODE_VECTORS: usize = 3;

    #[inline(always)]
    fn energy<S: Scalar>(&self, e: &[S]) -> S {
        let e = coordinates(e);
        let mut energy = S::zero();
        match &self.integration {
            Integration::Straight(law, points) => {
                for point in points {
                    energy += law.energy(self.section(e, point.xi, &point.slope)) * point.weight;
                }
            }
            Integration::Curved(moduli, _, points) => {
                for point in points.iter() {
                    let [f, g] = gradient(e, &point.gradients);
                    let [xx, yy, xy] = moduli.stress([f, g]);
                    let exx = (f[0] * f[0] + f[1] * f[1] - 1.0) * 0.5;
                    let eyy = (g[0] * g[0] + g[1] * g[1] - 1.0) * 0.5;
                    let shear = f[0] * g[0] + f[1] * g[1];
                    energy += (xx * exx + yy * eyy + xy * shear) * (0.5 * point.weight);
                }
            }
        }
        energy
    }

    #[inline(always)]
    fn force<S: Scalar>(&self, e: &[S], force: &mut [S]) {
        let e = coordinates(e);
        let out = match &self.integration {
            Integration::Straight(law, points) => self.straight_force(law, points, e),
            Integration::Curved(moduli, _, points) => curved_force(moduli, &points[..], e),
        };
        force[..DOF].copy_from_slice(&out);
    }

    #[inline(always)]
    fn stiffness<S: Scalar>(&self, e: &[S], stiffness: &mut [S]) {
        let e = coordinates(e);
        let out = match &self.integration {
            Integration::Straight(law, points) => self.straight_stiffness(law, points, e),
            Integration::Curved(moduli, _, points) => curved_stiffness(moduli, &points[..], e),
        };
        for (row, values) in stiffness.chunks_exact_mut(DOF).zip(&out) {
            row.copy_from_slice(values);
        }
    }

    fn vector_mass(&self, mass: &mut [f64]) {
        mass[..36].copy_from_slice(&self.vector_mass);
    }

    fn reference(&self, e: &mut [f64]) {
        e[..DOF].copy_from_slice(&self.reference);
    }

    fn energy_scale(&self) -> f64 {
        self.axial_stiffness * self.length
    }
}

impl LineElement for CubicBeam2 {
    const CENTRE_VECTORS: &'static [usize] = &hermite::VECTORS;

    /// The range of the parameter x: the length of a straight beam.
    fn length(&self) -> f64 {
        self.length
    }

    fn centre_line(&self, xi: f64, weights: &mut [f64]) {
        hermite::spread(hermite::value(xi, self.length), weights);
    }

    fn centre_line_slope(&self, xi: f64, weights: &mut [f64]) {
        hermite::spread(hermite::slope(xi, self.length), weights);
    }

    fn jacobian(&self, e: &[f64], xi: f64) -> f64 {
        let shapes = shape_derivatives(xi, 0.0, self.length);
        let (_, reference) = inverse(gradient(&self.reference, &shapes));
        inverse(gradient(coordinates(e), &shapes)).1 / reference
    }

    /// The section force along the centre line, `dW/dc . c / |c|`.
    fn axial_force(&self, e: &[f64], xi: f64) -> f64 {
        let e = coordinates(e);
        let at = self.section(e, xi, &hermite::slope(xi, self.length));
        let by_c = match &self.integration {
            Integration::Straight(law, _) => law.gradient(at).c,
            Integration::Curved(moduli, section, _) => {
                let mut by_c = [0.0; 2];
                for (y, area) in section_rule(section) {
                    let shapes = shape_derivatives(xi, y, self.length);
                    let (rows, jacobian) = inverse(gradient(&self.reference, &shapes));
                    let by_place = shapes.map(|[by_x, by_y]| {
                        std::array::from_fn(|j| by_x * rows[0][j] + by_y * rows[1][j])
                    });
                    let stress = moduli.nominal_stress(gradient(e, &by_place));
                    for axis in 0..2 {
                        by_c[axis] += (stress[0][axis] * rows[0][0] + stress[1][axis] * rows[0][1])
                            * (area * jacobian);
                    }
                }
                by_c
            }
        };
        (by_c[0] * at.c[0] + by_c[1] * at.c[1]) / at.c[0].hypot(at.c[1])
    }
}
