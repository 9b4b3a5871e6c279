//! The planar linear beam: 8 coordinates, one integration point, no locking.
//!
//! Kerkkänen (2006, 2.10-2.20, 2.26). Coordinates `e = [r1, r1_y, r2, r2_y]`, `xi = x / l`:
//!
//! ```text
//! r = (1 - xi) r1 + xi r2 + y [(1 - xi) r1_y + xi r2_y]                             (2.10-2.12)
//! U = 1/2 ∫ E exx² + E eyy² + 4 ks G exy² dV                                        (2.18)
//! M = rho l { A [1/3 1/6; 1/6 1/3] on r,  I2 [1/3 1/6; 1/6 1/3] on r_y }             (2.26)
//! ```
//!
//! # As coded
//! With `c = (r2 - r1) / l`, `w = (r2_y - r1_y) / l` and `d = (r1_y + r2_y) / 2` the energy is
//! `l W(c, w, d)` of the section at mid-length (see `plane_section.rs`; P = E, Q = 0, G -> ks G): one
//! Gauss point for every term. Two points would lock in shear and thickness. The section's I2 shear
//! term stops the motion `r1_y = -r2_y` that one point does not see otherwise.

use super::plane_section::{PlaneSection, Vectors};
use super::{Element, LineElement};
use crate::material::Isotropic;
use crate::scalar::Scalar;
use crate::section::{PlanarSection, SHEAR_CORRECTION};
use crate::unsound::{Unsound, positive};

const DOF: usize = 8;

/// Signs of the two nodes in a difference along the element.
const SIGNS: [f64; 2] = [-1.0, 1.0];

/// A planar linear beam, straight and free of stress in its reference.
#[derive(Clone, Debug, PartialEq)]
pub struct LinearBeam2 {
    length: f64,
    per_length: f64,
    line_density: f64,
    rotary_density: f64,
    axial_stiffness: f64,
    section: PlaneSection,
    sound: Result<(), Unsound>,
}

impl LinearBeam2 {
    /// A linear beam of undeformed length `length` [m].
    #[must_use]
    pub fn new(length: f64, section: &PlanarSection, material: &Isotropic) -> Self {
        let youngs = material.youngs_modulus;
        let shear = SHEAR_CORRECTION * material.shear_modulus();
        Self {
            length,
            per_length: 1.0 / length,
            line_density: material.density * section.area,
            rotary_density: material.density * section.second_moment,
            axial_stiffness: youngs * section.area,
            section: PlaneSection::new(section, youngs, 0.0, shear),
            sound: positive("the length of an element [m]", length)
                .and_then(|()| section.check())
                .and_then(|()| material.check()),
        }
    }

    /// The section at mid-length.
    #[inline(always)]
    fn middle<S: Scalar>(&self, e: &[S; DOF]) -> Vectors<S> {
        Vectors {
            c: [
                (e[4] - e[0]) * self.per_length,
                (e[5] - e[1]) * self.per_length,
            ],
            w: [
                (e[6] - e[2]) * self.per_length,
                (e[7] - e[3]) * self.per_length,
            ],
            d: [(e[2] + e[6]) * 0.5, (e[3] + e[7]) * 0.5],
        }
    }
}

#[inline(always)]
fn coordinates<S: Scalar>(e: &[S]) -> &[S; DOF] {
    // A caller with a shorter slice breaks the contract of `Element`; no input of a user reaches this.
    let Some(e) = e.first_chunk::<DOF>() else {
        panic!("a linear beam has {DOF} coordinates, not {}", e.len());
    };
    e
}

crate::body_kernels!(LinearBeam2);

impl Element for LinearBeam2 {
    const DIMENSION: usize = 2;
    const NODES: usize = 2;
    const NODE_VECTORS: usize = 2;

    #[inline(always)]
    fn energy<S: Scalar>(&self, e: &[S]) -> S {
        self.section.energy(self.middle(coordinates(e))) * self.length
    }

    #[inline(always)]
    fn force<S: Scalar>(&self, e: &[S], force: &mut [S]) {
        let by = self.section.gradient(self.middle(coordinates(e)));
        let half = -0.5 * self.length;
        for axis in 0..2 {
            let fibre = by.d[axis] * half;
            force[axis] = by.c[axis];
            force[2 + axis] = fibre + by.w[axis];
            force[4 + axis] = -by.c[axis];
            force[6 + axis] = fibre - by.w[axis];
        }
    }

    #[inline(always)]
    fn stiffness<S: Scalar>(&self, e: &[S], stiffness: &mut [S]) {
        let h = self.section.hessian(self.middle(coordinates(e)), 1.0);
        let per_length = self.per_length;
        for i in 0..2 {
            for j in 0..2 {
                let (rr, rd) = (h.cc[i][j] * per_length, h.cw[i][j] * per_length);
                let (dr, dd) = (h.cw[j][i] * per_length, h.ww[i][j] * per_length);
                let (half_rd, half_dr) = (h.cd[i][j] * 0.5, h.cd[j][i] * 0.5);
                let (wd, dw) = (h.wd[i][j] * 0.5, h.wd[j][i] * 0.5);
                let quarter = h.dd[i][j] * (0.25 * self.length);
                for (k, row_sign) in SIGNS.into_iter().enumerate() {
                    for (m, column_sign) in SIGNS.into_iter().enumerate() {
                        let sign = row_sign * column_sign;
                        let (row, column) = (4 * k + i, 4 * m + j);
                        stiffness[row * DOF + column] = rr * sign;
                        stiffness[row * DOF + column + 2] = rd * sign + half_rd * row_sign;
                        stiffness[(row + 2) * DOF + column] = dr * sign + half_dr * column_sign;
                        stiffness[(row + 2) * DOF + column + 2] =
                            dd * sign + wd * row_sign + dw * column_sign + quarter;
                    }
                }
            }
        }
    }

    fn vector_mass(&self, mass: &mut [f64]) {
        mass.fill(0.0);
        let line = self.line_density * self.length / 6.0;
        let rotary = self.rotary_density * self.length / 6.0;
        for k in 0..2 {
            for m in 0..2 {
                let factor = if k == m { 2.0 } else { 1.0 };
                mass[4 * (2 * k) + 2 * m] = line * factor;
                mass[4 * (2 * k + 1) + 2 * m + 1] = rotary * factor;
            }
        }
    }

    fn reference(&self, e: &mut [f64]) {
        e[..DOF].copy_from_slice(&[0.0, 0.0, 0.0, 1.0, self.length, 0.0, 0.0, 1.0]);
    }

    fn energy_scale(&self) -> f64 {
        self.axial_stiffness * self.length
    }

    fn check(&self) -> Result<(), Unsound> {
        self.sound
    }
}

impl LineElement for LinearBeam2 {
    const CENTRE_VECTORS: &'static [usize] = &[0, 2];
    const SECTION_VECTORS: [usize; 2] = [1, 3];

    fn length(&self) -> f64 {
        self.length
    }

    fn centre_line(&self, xi: f64, weights: &mut [f64]) {
        weights[..4].copy_from_slice(&[1.0 - xi, 0.0, xi, 0.0]);
    }

    fn centre_line_slope(&self, _xi: f64, weights: &mut [f64]) {
        weights[..4].copy_from_slice(&[-self.per_length, 0.0, self.per_length, 0.0]);
    }

    fn jacobian(&self, e: &[f64], xi: f64) -> f64 {
        let c = self.middle(coordinates(e)).c;
        let fibre = |axis: usize| (1.0 - xi) * e[2 + axis] + xi * e[6 + axis];
        c[0] * fibre(1) - c[1] * fibre(0)
    }

    /// The section force along the centre line, `dW/dc . c / |c|`: one value for the whole element,
    /// that of its only integration point.
    fn axial_force(&self, e: &[f64], _xi: f64) -> f64 {
        let middle = self.middle(coordinates(e));
        let by_c = self.section.gradient(middle).c;
        (by_c[0] * middle.c[0] + by_c[1] * middle.c[1]) / middle.c[0].hypot(middle.c[1])
    }
}
