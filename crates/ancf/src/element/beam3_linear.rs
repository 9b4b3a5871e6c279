//! The spatial linear beam: 18 coordinates, one integration point along it, no locking.
//!
//! Kerkkänen (2006, 4.20-4.22). Coordinates `e = [r1, r1_y, r1_z, r2, r2_y, r2_z]`, `xi = x / l`:
//!
//! ```text
//! r = (1 - xi) (r1 + y r1_y + z r1_z) + xi (r2 + y r2_y + z r2_z)                    (4.20-4.22)
//! U = 1/2 ∫ E (exx² + eyy² + ezz²) + 4 G (ks exy² + ks exz² + eyz²) dV
//! M = rho l { A [1/3 1/6; 1/6 1/3] on r,  the same with Iy on r_y and with Iz on r_z }
//! ```
//!
//! # As coded
//! `U = l W(c, u, v, u', v')` of the section at mid-length (see `space_section.rs`), with
//! `c = (r2 - r1)/l`, `u = (r1_y + r2_y)/2`, `u' = (r2_y - r1_y)/l` and `v` likewise: one Gauss point for
//! every term. In the plane of x and y it is the planar linear beam.
//!
//! Linearised, a cantilever of n such beams under a tip load has the deflection of Timoshenko's beam
//! with its bending part short of `1/(4 n²)`.

use super::space_section::{CENTRE, FIBRE_SLOPES, FIBRES, Factors, SpaceSection, VECTORS, Vectors};
use super::vector::dot;
use super::{Element, LineElement};
use crate::material::Isotropic;
use crate::scalar::Scalar;
use crate::section::SpatialSection;

const DOF: usize = 18;
/// Vectors of a node: r, r_y, r_z.
const NODE_VECTORS: usize = 3;

/// A spatial linear beam, straight and free of stress in its reference.
#[derive(Clone, Debug, PartialEq)]
pub struct LinearBeam3 {
    length: f64,
    per_length: f64,
    youngs_modulus: f64,
    shear_modulus: f64,
    density: f64,
    section: SpatialSection,
    law: SpaceSection,
}

impl LinearBeam3 {
    /// A linear beam of undeformed length `length` [m]. Its torsion stiffness is
    /// `ks G (∫ y² dA + ∫ z² dA)`, ks = 5/6: see [`LinearBeam3::with_torsion_factor`].
    #[must_use]
    pub fn new(length: f64, section: &SpatialSection, material: &Isotropic) -> Self {
        let (youngs_modulus, shear_modulus) = (material.youngs_modulus, material.shear_modulus());
        Self {
            length,
            per_length: 1.0 / length,
            youngs_modulus,
            shear_modulus,
            density: material.density,
            section: *section,
            law: SpaceSection::new(section, youngs_modulus, shear_modulus, factors(1.0)),
        }
    }

    /// The same beam with its torsion stiffness multiplied by `factor`;
    /// [`SpatialSection::saint_venant_torsion_factor`] makes it Saint-Venant's.
    #[must_use]
    pub fn with_torsion_factor(self, factor: f64) -> Self {
        let law = SpaceSection::new(
            &self.section,
            self.youngs_modulus,
            self.shear_modulus,
            factors(factor),
        );
        Self { law, ..self }
    }

    /// The section at mid-length.
    #[inline(always)]
    fn middle<S: Scalar>(&self, e: &[S; DOF]) -> Vectors<S> {
        let mut vectors = [[S::zero(); 3]; VECTORS];
        for i in 0..3 {
            vectors[CENTRE][i] = (e[9 + i] - e[i]) * self.per_length;
            for k in 0..2 {
                let (first, second) = (e[3 + 3 * k + i], e[12 + 3 * k + i]);
                vectors[FIBRES[k]][i] = (first + second) * 0.5;
                vectors[FIBRE_SLOPES[k]][i] = (second - first) * self.per_length;
            }
        }
        vectors
    }

    /// Vectors of the middle section that read the nodal vector `vector` (r, r_y, r_z of the first node,
    /// then of the second), and how much of it. A position has one; its share of another is nothing.
    #[inline(always)]
    fn shares(&self, vector: usize) -> [(usize, f64); 2] {
        let slope = if vector < NODE_VECTORS {
            -self.per_length
        } else {
            self.per_length
        };
        match vector % NODE_VECTORS {
            0 => [(CENTRE, slope), (CENTRE, 0.0)],
            k => [(FIBRES[k - 1], 0.5), (FIBRE_SLOPES[k - 1], slope)],
        }
    }
}

fn factors(torsion: f64) -> Factors {
    Factors {
        axial: 1.0,
        bending: 1.0,
        torsion,
        transverse: 1.0,
    }
}

#[inline(always)]
fn coordinates<S: Scalar>(e: &[S]) -> &[S; DOF] {
    // A caller with a shorter slice breaks the contract of `Element`; no input of a user reaches this.
    let Some(e) = e.first_chunk::<DOF>() else {
        panic!(
            "a spatial linear beam has {DOF} coordinates, not {}",
            e.len()
        );
    };
    e
}

crate::body_kernels!(LinearBeam3);

impl Element for LinearBeam3 {
    const DIMENSION: usize = 3;
    const NODES: usize = 2;
    const NODE_VECTORS: usize = NODE_VECTORS;

    #[inline(always)]
    fn energy<S: Scalar>(&self, e: &[S]) -> S {
        self.law.energy(&self.middle(coordinates(e))) * self.length
    }

    #[inline(always)]
    fn force<S: Scalar>(&self, e: &[S], force: &mut [S]) {
        let by = self.law.gradient(&self.middle(coordinates(e)), self.length);
        let per_length = self.per_length;
        for i in 0..3 {
            force[i] = by[CENTRE][i] * per_length;
            force[9 + i] = -force[i];
            for k in 0..2 {
                let mean = by[FIBRES[k]][i] * -0.5;
                let turn = by[FIBRE_SLOPES[k]][i] * per_length;
                force[3 + 3 * k + i] = mean + turn;
                force[12 + 3 * k + i] = mean - turn;
            }
        }
    }

    #[inline(always)]
    fn stiffness<S: Scalar>(&self, e: &[S], stiffness: &mut [S]) {
        let hessian = self.law.hessian(&self.middle(coordinates(e)), self.length);
        for row in 0..2 * NODE_VECTORS {
            for column in row..2 * NODE_VECTORS {
                let mut block = [[S::zero(); 3]; 3];
                for (a, by_row) in self.shares(row) {
                    for (b, by_column) in self.shares(column) {
                        let factor = by_row * by_column;
                        for i in 0..3 {
                            for j in 0..3 {
                                block[i][j] += hessian[3 * a + i][3 * b + j] * factor;
                            }
                        }
                    }
                }
                for i in 0..3 {
                    for j in 0..3 {
                        stiffness[(3 * row + i) * DOF + 3 * column + j] = block[i][j];
                        stiffness[(3 * column + j) * DOF + 3 * row + i] = block[i][j];
                    }
                }
            }
        }
    }

    fn vector_mass(&self, mass: &mut [f64]) {
        let size = 2 * NODE_VECTORS;
        mass[..size * size].fill(0.0);
        let scale = self.density * self.length / 6.0;
        let section = &self.section;
        let moments = [
            section.area,
            section.second_moment_y,
            section.second_moment_z,
        ];
        for (k, moment) in moments.into_iter().enumerate() {
            for (row, column, factor) in [(0, 0, 2.0), (0, 1, 1.0), (1, 0, 1.0), (1, 1, 2.0)] {
                let place = (NODE_VECTORS * row + k) * size + NODE_VECTORS * column + k;
                mass[place] = scale * moment * factor;
            }
        }
    }

    fn reference(&self, e: &mut [f64]) {
        e[..DOF].fill(0.0);
        e[9] = self.length;
        for place in [4, 8, 13, 17] {
            e[place] = 1.0;
        }
    }

    fn energy_scale(&self) -> f64 {
        self.youngs_modulus * self.section.area * self.length
    }
}

impl LineElement for LinearBeam3 {
    const CENTRE_VECTORS: &'static [usize] = &[0, NODE_VECTORS];
    const SECTION_VECTORS: [usize; 2] = [1, NODE_VECTORS + 1];

    fn length(&self) -> f64 {
        self.length
    }

    fn centre_line(&self, xi: f64, weights: &mut [f64]) {
        weights[..6].copy_from_slice(&[1.0 - xi, 0.0, 0.0, xi, 0.0, 0.0]);
    }

    fn centre_line_slope(&self, _xi: f64, weights: &mut [f64]) {
        let slope = self.per_length;
        weights[..6].copy_from_slice(&[-slope, 0.0, 0.0, slope, 0.0, 0.0]);
    }

    fn jacobian(&self, e: &[f64], xi: f64) -> f64 {
        let e = coordinates(e);
        let at = |k: usize| -> [f64; 3] {
            std::array::from_fn(|i| (1.0 - xi) * e[3 * k + i] + xi * e[9 + 3 * k + i])
        };
        super::determinant(self.middle(e)[CENTRE], at(1), at(2))
    }

    /// The section force along the centre line, `dW/dc . c / |c|`: one value for the whole element,
    /// that of its only integration point.
    fn axial_force(&self, e: &[f64], _xi: f64) -> f64 {
        let middle = self.middle(coordinates(e));
        let c = middle[CENTRE];
        dot(self.law.gradient(&middle, 1.0)[CENTRE], c) / dot(c, c).sqrt()
    }
}
