//! Energy of a spatial cross-section whose two fibres stay straight, integrated in closed form.
//!
//! The section at x holds the points `r = r_c(x) + y u(x) + z v(x)`. With the five vectors
//! `V = (c, u, v, u', v')`, `c = r_c,x`, and their dot products the Green strains are
//!
//! ```text
//! exx   = (c.c - 1)/2 + y c.u' + z c.v' + y² u'.u'/2 + y z u'.v' + z² v'.v'/2
//! 2 exy = c.u + y u'.u + z v'.u          2 exz = c.v + y u'.v + z v'.v
//! eyy   = (u.u - 1)/2,  ezz = (v.v - 1)/2,  2 eyz = u.v
//! ```
//!
//! and `1/2 ∫ E (exx² + eyy² + ezz²) + 4 G (ks exy² + ks exz² + eyz²) dA` of a doubly symmetric section
//! (Kerkkänen 2006, 4.34) is a quadratic form of the dot products: with `e_a = (V_a.V_a - V0_a.V0_a)/2`,
//!
//! ```text
//! W = 1/2 sum_ab own_ab e_a e_b + 1/2 sum_(a<b) mutual_ab (V_a.V_b)²
//! own    cc: E A   cu': E Iy   cv': E Iz   u'u': E Iyyyy   v'v': E Izzzz   u'v': E Iyyzz   uu, vv: E A
//! mutual cu': E Iy   cv': E Iz   u'v': E Iyyzz   cu, cv: ks G A   uu': ks G Iy   vv': ks G Iz
//!        vu': k ks G Iy   uv': k ks G Iz   uv: G A
//! ```
//!
//! with `Iy = ∫ y² dA` and so on. The terms `vu'` and `uv'` are those of twist, `u'.v = -v'.u` being its
//! rate: a section that stays plane twists with `ks G (Iy + Iz)`; the torsion factor `k` corrects that.

use super::vector::dot;
use crate::scalar::Scalar;
use crate::section::{SHEAR_CORRECTION, SpatialSection};

/// Vectors of a section.
pub(super) const VECTORS: usize = 5;
/// The slope of the centre line among the vectors.
pub(super) const CENTRE: usize = 0;
/// The fibres along y and z among the vectors.
pub(super) const FIBRES: [usize; 2] = [1, 2];
/// Their derivatives by x.
pub(super) const FIBRE_SLOPES: [usize; 2] = [3, 4];

/// The five vectors `(c, u, v, u', v')`, or derivatives by them.
pub(super) type Vectors<S> = [[S; 3]; VECTORS];

/// Second derivatives by the vectors, component by component.
pub(super) type Hessian<S> = [[S; 3 * VECTORS]; 3 * VECTORS];

/// Half the squares of the vectors in the reference.
const REST: [f64; VECTORS] = [0.5, 0.5, 0.5, 0.0, 0.0];

/// Moduli times the moments of the section, symmetric tables over the five vectors.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct SpaceSection {
    own: [[f64; VECTORS]; VECTORS],
    mutual: [[f64; VECTORS]; VECTORS],
}

/// What multiplies parts of the energy.
#[derive(Clone, Copy, Debug)]
pub(super) struct Factors {
    /// On the squared axial term.
    pub axial: f64,
    /// On all other terms of exx, exy and exz.
    pub bending: f64,
    /// On the terms of twist, beside `bending`.
    pub torsion: f64,
    /// On eyy, ezz and eyz.
    pub transverse: f64,
}

impl SpaceSection {
    pub(super) fn new(section: &SpatialSection, youngs: f64, shear: f64, factors: Factors) -> Self {
        let axial = factors.axial * youngs * section.area;
        let bending = factors.bending * youngs;
        let transverse = factors.transverse * youngs * section.area;
        let sheared = factors.bending * SHEAR_CORRECTION * shear;
        let twisted = factors.torsion * sheared;
        let (y, z) = (section.second_moment_y, section.second_moment_z);
        let mut own = [[0.0; VECTORS]; VECTORS];
        let mut mutual = own;
        let put = |table: &mut [[f64; VECTORS]; VECTORS], a: usize, b: usize, value: f64| {
            table[a][b] = value;
            table[b][a] = value;
        };
        for (a, b, value) in [
            (0, 0, axial),
            (0, 3, bending * y),
            (0, 4, bending * z),
            (3, 3, bending * section.fourth_moment_y),
            (4, 4, bending * section.fourth_moment_z),
            (3, 4, bending * section.mixed_fourth_moment),
            (1, 1, transverse),
            (2, 2, transverse),
        ] {
            put(&mut own, a, b, value);
        }
        for (a, b, value) in [
            (0, 3, bending * y),
            (0, 4, bending * z),
            (3, 4, bending * section.mixed_fourth_moment),
            (0, 1, sheared * section.area),
            (0, 2, sheared * section.area),
            (1, 3, sheared * y),
            (2, 4, sheared * z),
            (2, 3, twisted * y),
            (1, 4, twisted * z),
            (1, 2, factors.transverse * shear * section.area),
        ] {
            put(&mut mutual, a, b, value);
        }
        Self { own, mutual }
    }

    /// e_a.
    #[inline(always)]
    fn stretches<S: Scalar>(vectors: &Vectors<S>) -> [S; VECTORS] {
        let mut stretches = [S::zero(); VECTORS];
        for a in 0..VECTORS {
            stretches[a] = dot(vectors[a], vectors[a]) * 0.5 - REST[a];
        }
        stretches
    }

    /// dW/de_a on the diagonal, dW/d(V_a.V_b) beside it.
    #[inline(always)]
    fn stress<S: Scalar>(&self, vectors: &Vectors<S>) -> [[S; VECTORS]; VECTORS] {
        let stretches = Self::stretches(vectors);
        let mut stress = [[S::zero(); VECTORS]; VECTORS];
        for a in 0..VECTORS {
            for b in 0..VECTORS {
                stress[a][a] += stretches[b] * self.own[a][b];
            }
            for b in a + 1..VECTORS {
                let value = dot(vectors[a], vectors[b]) * self.mutual[a][b];
                stress[a][b] = value;
                stress[b][a] = value;
            }
        }
        stress
    }

    /// W [J/m].
    #[inline(always)]
    pub(super) fn energy<S: Scalar>(&self, vectors: &Vectors<S>) -> S {
        let stretches = Self::stretches(vectors);
        let mut twice = S::zero();
        for a in 0..VECTORS {
            for b in 0..VECTORS {
                twice += stretches[a] * stretches[b] * self.own[a][b];
            }
            for b in a + 1..VECTORS {
                let product = dot(vectors[a], vectors[b]);
                twice += product * product * self.mutual[a][b];
            }
        }
        twice * 0.5
    }

    /// Derivatives of W by the vectors, times `weight`.
    #[inline(always)]
    pub(super) fn gradient<S: Scalar>(&self, vectors: &Vectors<S>, weight: f64) -> Vectors<S> {
        let stress = self.stress(vectors);
        let mut gradient = [[S::zero(); 3]; VECTORS];
        for a in 0..VECTORS {
            for b in 0..VECTORS {
                let value = stress[a][b] * weight;
                for i in 0..3 {
                    gradient[a][i] += vectors[b][i] * value;
                }
            }
        }
        gradient
    }

    /// Second derivatives of W, times `weight`.
    #[inline(always)]
    pub(super) fn hessian<S: Scalar>(&self, vectors: &Vectors<S>, weight: f64) -> Hessian<S> {
        let stress = self.stress(vectors);
        let mut hessian = [[S::zero(); 3 * VECTORS]; 3 * VECTORS];
        for a in 0..VECTORS {
            for b in a..VECTORS {
                let (own, mutual) = (self.own[a][b] * weight, self.mutual[a][b] * weight);
                for i in 0..3 {
                    let (by_own, by_mutual) = (vectors[a][i] * own, vectors[b][i] * mutual);
                    for j in 0..3 {
                        let mut value = by_own * vectors[b][j] + by_mutual * vectors[a][j];
                        if i == j {
                            value += stress[a][b] * weight;
                        }
                        hessian[3 * a + i][3 * b + j] = value;
                    }
                }
            }
            for b in 0..VECTORS {
                let mutual = self.mutual[a][b] * weight;
                for i in 0..3 {
                    let by_mutual = vectors[b][i] * mutual;
                    for j in 0..3 {
                        hessian[3 * a + i][3 * a + j] += by_mutual * vectors[b][j];
                    }
                }
            }
        }
        for row in 3..3 * VECTORS {
            for column in 0..row - row % 3 {
                hessian[row][column] = hessian[column][row];
            }
        }
        hessian
    }
}
