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

mod curved;

use std::num::NonZeroUsize;

use thiserror::Error;

use self::curved::{CurvedPoint, Moduli, SECTION_POINTS};
use super::hermite;
use super::plane_section::{PlaneSection, Vectors};
use super::{Element, LineElement};
use crate::material::Isotropic;
use crate::quadrature::Rule;
use crate::scalar::{Scalar, unroll};
use crate::section::PlanarSection;
use crate::unsound::{Unsound, positive};

/// Gauss points along the element, as published.
const POINTS: usize = 4;

const CURVED_POINTS: usize = POINTS * SECTION_POINTS;

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
    sound: Result<(), Unsound>,
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

fn gauss(count: usize) -> Rule {
    Rule::gauss(NonZeroUsize::new(count).unwrap_or(NonZeroUsize::MIN))
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
        let point = |i: usize| {
            let (along, across) = (i / SECTION_POINTS, i % SECTION_POINTS);
            let (y, area) = curved::section_rule(section)[across];
            let mut point = CurvedPoint::new(reference, rule.points[along], y, length);
            let jacobian = point.weight;
            point.weight *= rule.weights[along] * length * area;
            (point, y, jacobian)
        };
        for i in 0..CURVED_POINTS {
            let (_, y, jacobian) = point(i);
            // NaN is no element either.
            if jacobian <= 0.0 || jacobian.is_nan() {
                let xi = rule.points[i / SECTION_POINTS];
                return Err(FoldedReference { xi, y, jacobian });
            }
        }
        let points = Box::new(std::array::from_fn(|i| point(i).0));
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
            vector_mass: curved::mass(&reference, length, section, material.density),
            integration,
            sound: positive("the length of an element [m]", length)
                .and_then(|()| section.check())
                .and_then(|()| material.check_compressible()),
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
            let slope = &point.slope;
            unroll!(for i in 0..2 {
                unroll!(for j in 0..2 {
                    unroll!(for a in 0..4 {
                        let row = 2 * hermite::VECTORS[a] + i;
                        let scaled = h.cc[i][j] * slope[a];
                        unroll!(for b in 0..4 {
                            out[row][2 * hermite::VECTORS[b] + j] += scaled * slope[b];
                        });
                    });
                    unroll!(for m in 0..2 {
                        let mixed = h.cw[i][j] * turn[m] + h.cd[i][j] * fibre[m];
                        unroll!(for a in 0..4 {
                            out[2 * hermite::VECTORS[a] + i][6 * m + 4 + j] += mixed * slope[a];
                        });
                        unroll!(for k in 0..2 {
                            out[6 * k + 4 + i][6 * m + 4 + j] += h.ww[i][j] * (turn[k] * turn[m])
                                + h.wd[i][j] * (turn[k] * fibre[m])
                                + h.wd[j][i] * (fibre[k] * turn[m])
                                + h.dd[i][j] * (fibre[k] * fibre[m]);
                        });
                    });
                });
            });
        }
        unroll!(for k in 0..4 {
            let fibre = [4, 5, 10, 11][k];
            unroll!(for a in 0..4 {
                let vector = 2 * hermite::VECTORS[a];
                out[fibre][vector] = out[vector][fibre];
                out[fibre][vector + 1] = out[vector + 1][fibre];
            });
        });
        out
    }
}

#[inline(always)]
fn coordinates<S: Scalar>(e: &[S]) -> &[S; DOF] {
    // A caller with a shorter slice breaks the contract of `Element`; no input of a user reaches this.
    let Some(e) = e.first_chunk::<DOF>() else {
        panic!("a cubic beam has {DOF} coordinates, not {}", e.len());
    };
    e
}

crate::body_kernels!(CubicBeam2);

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
                    energy += moduli.energy(point.gradient(e)) * point.weight;
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
            Integration::Curved(moduli, _, points) => moduli.force(&points[..], e),
        };
        force[..DOF].copy_from_slice(&out);
    }

    #[inline(always)]
    fn stiffness<S: Scalar>(&self, e: &[S], stiffness: &mut [S]) {
        let e = coordinates(e);
        let out = match &self.integration {
            Integration::Straight(law, points) => self.straight_stiffness(law, points, e),
            Integration::Curved(moduli, _, points) => moduli.stiffness(&points[..], e),
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

    fn check(&self) -> Result<(), Unsound> {
        self.sound
    }
}

impl LineElement for CubicBeam2 {
    const CENTRE_VECTORS: &'static [usize] = &hermite::VECTORS;
    const SECTION_VECTORS: [usize; 2] = [2, 5];

    /// The range of the parameter x: the length of a straight beam.
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
        let place = CurvedPoint::new(&self.reference, xi, 0.0, self.length);
        let [f, g] = place.gradient(coordinates(e));
        f[0] * g[1] - f[1] * g[0]
    }

    /// The section force along the centre line, `dW/dc . c / |c|`.
    fn axial_force(&self, e: &[f64], xi: f64) -> f64 {
        let e = coordinates(e);
        let at = self.section(e, xi, &hermite::slope(xi, self.length));
        let by_c = match &self.integration {
            Integration::Straight(law, _) => law.gradient(at).c,
            Integration::Curved(moduli, section, _) => {
                let mut by_c = [0.0; 2];
                for (y, area) in curved::section_rule(section) {
                    let by_c_here = moduli.section_force(&self.reference, e, xi, y, self.length);
                    for axis in 0..2 {
                        by_c[axis] += by_c_here[axis] * area;
                    }
                }
                by_c
            }
        };
        (by_c[0] * at.c[0] + by_c[1] * at.c[1]) / at.c[0].hypot(at.c[1])
    }
}
