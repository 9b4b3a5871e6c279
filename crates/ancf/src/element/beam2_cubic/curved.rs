//! The cubic beam by points of its material: any reference, strains from the gradient D.

use super::{DOF, gauss, hermite};
use crate::material::Isotropic;
use crate::scalar::{Scalar, unroll};
use crate::section::PlanarSection;

/// Points of the section.
pub(super) const SECTION_POINTS: usize = 3;

/// Gauss points of the mass: exact to the degree 11 of S^T S det J0 along x.
const MASS_POINTS: usize = 6;

/// lambda + 2 mu, lambda and mu [Pa].
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Moduli {
    pub normal: f64,
    pub coupling: f64,
    pub shear: f64,
}

/// A material point of a curved element.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct CurvedPoint {
    /// Weight times volume [m³].
    pub weight: f64,
    /// Gradients of the six shape functions by the reference place.
    gradients: [[f64; 2]; 6],
}

impl Moduli {
    pub fn new(material: &Isotropic) -> Self {
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

    /// Energy density [J/m³] of the gradient.
    #[inline(always)]
    pub fn energy<S: Scalar>(&self, [f, g]: [[S; 2]; 2]) -> S {
        let [xx, yy, xy] = self.stress([f, g]);
        let exx = (f[0] * f[0] + f[1] * f[1] - 1.0) * 0.5;
        let eyy = (g[0] * g[0] + g[1] * g[1] - 1.0) * 0.5;
        (xx * exx + yy * eyy + xy * (f[0] * g[0] + f[1] * g[1])) * 0.5
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
pub(super) fn section_rule(section: &PlanarSection) -> [(f64, f64); SECTION_POINTS] {
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

impl CurvedPoint {
    /// The place (xi, y), with `det J0` alone as its weight.
    pub fn new(reference: &[f64; DOF], xi: f64, y: f64, length: f64) -> Self {
        let shapes = shape_derivatives(xi, y, length);
        let (rows, jacobian) = inverse(gradient(reference, &shapes));
        let gradients = shapes
            .map(|[by_x, by_y]| std::array::from_fn(|j| by_x * rows[0][j] + by_y * rows[1][j]));
        Self {
            weight: jacobian,
            gradients,
        }
    }

    /// `D`, column by column.
    #[inline(always)]
    pub fn gradient<S: Scalar>(&self, e: &[S; DOF]) -> [[S; 2]; 2] {
        gradient(e, &self.gradients)
    }
}

impl Moduli {
    /// Force on the coordinates.
    #[inline(always)]
    pub fn force<S: Scalar>(&self, points: &[CurvedPoint], e: &[S; DOF]) -> [S; DOF] {
        let mut out = [S::zero(); DOF];
        for point in points {
            let stress = self.nominal_stress(point.gradient(e));
            for (k, shape) in point.gradients.iter().enumerate() {
                for axis in 0..2 {
                    out[2 * k + axis] -= stress[0][axis] * (shape[0] * point.weight)
                        + stress[1][axis] * (shape[1] * point.weight);
                }
            }
        }
        out
    }

    /// Tangent by the coordinates.
    #[inline(always)]
    pub fn stiffness<S: Scalar>(&self, points: &[CurvedPoint], e: &[S; DOF]) -> [[S; DOF]; DOF] {
        let mut out = [[S::zero(); DOF]; DOF];
        for point in points {
            let [f, g] = point.gradient(e);
            let [xx, yy, xy] = self.stress([f, g]);
            unroll!(for i in 0..2 {
                unroll!(for j in 0..2 {
                    let unit = if i == j { 1.0 } else { 0.0 };
                    let f_f = f[i] * f[j] * self.normal + g[i] * g[j] * self.shear + xx * unit;
                    let f_g = f[i] * g[j] * self.coupling + g[i] * f[j] * self.shear + xy * unit;
                    let g_f = g[i] * f[j] * self.coupling + f[i] * g[j] * self.shear + xy * unit;
                    let g_g = g[i] * g[j] * self.normal + f[i] * f[j] * self.shear + yy * unit;
                    unroll!(for k in 0..6 {
                        let [x, y] = point.gradients[k].map(|shape| shape * point.weight);
                        let (by_f, by_g) = (f_f * x + g_f * y, f_g * x + g_g * y);
                        unroll!(for m in 0..6 {
                            let [x, y] = point.gradients[m];
                            out[2 * k + i][2 * m + j] += by_f * x + by_g * y;
                        });
                    });
                });
            });
        }
        out
    }

    /// Derivative of the energy by c, per length and area of the section.
    pub fn section_force(
        &self,
        reference: &[f64; DOF],
        e: &[f64; DOF],
        xi: f64,
        y: f64,
        length: f64,
    ) -> [f64; 2] {
        let (rows, jacobian) = inverse(gradient(reference, &shape_derivatives(xi, y, length)));
        let point = CurvedPoint::new(reference, xi, y, length);
        let stress = self.nominal_stress(point.gradient(e));
        std::array::from_fn(|axis| {
            (stress[0][axis] * rows[0][0] + stress[1][axis] * rows[0][1]) * jacobian
        })
    }
}

/// rho ∫ S^T S det J0 dV between the six vectors, row-major.
pub(super) fn mass(
    reference: &[f64; DOF],
    length: f64,
    section: &PlanarSection,
    density: f64,
) -> [f64; 36] {
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
