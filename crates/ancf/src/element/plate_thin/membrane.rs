//! Energy of the middle surface: Green strains of `a = r_x`, `b = r_y`.
//!
//! ```text
//! exx = (a.a - 1)/2     eyy = (b.b - 1)/2     exy = a.b/2
//! W = C/2 [(exx + eyy)² - 2 (1 - nu) (exx eyy - exy²)]          C = E h / (1 - nu²)
//! ```

use crate::element::vector::dot;
use crate::scalar::Scalar;

/// Stiffnesses [N/m]: C, C nu and C (1 - nu)/2.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Membrane {
    normal: f64,
    coupling: f64,
    shear: f64,
}

/// `(r_x, r_y)`, or derivatives by them.
pub(super) type Slopes<S> = [[S; 3]; 2];

impl Membrane {
    pub fn new(normal: f64, poisson_ratio: f64) -> Self {
        Self {
            normal,
            coupling: normal * poisson_ratio,
            shear: 0.5 * normal * (1.0 - poisson_ratio),
        }
    }

    /// `[exx, eyy, 2 exy]`.
    #[inline(always)]
    fn strain<S: Scalar>([a, b]: &Slopes<S>) -> [S; 3] {
        [
            (dot(*a, *a) - 1.0) * 0.5,
            (dot(*b, *b) - 1.0) * 0.5,
            dot(*a, *b),
        ]
    }

    /// Forces per width [N/m] of the second Piola-Kirchhoff stress, `[xx, yy, xy]`, by `[exx, eyy, 2 exy]`.
    #[inline(always)]
    pub fn forces<S: Scalar>(&self, [xx, yy, angle]: [S; 3]) -> [S; 3] {
        [
            xx * self.normal + yy * self.coupling,
            xx * self.coupling + yy * self.normal,
            angle * self.shear,
        ]
    }

    /// W [J/m²].
    #[inline(always)]
    pub fn energy<S: Scalar>(&self, slopes: &Slopes<S>) -> S {
        let strain = Self::strain(slopes);
        dot(strain, self.forces(strain)) * 0.5
    }

    /// Derivatives of W by a and b, times `weight`.
    #[inline(always)]
    pub fn gradient<S: Scalar>(&self, slopes: &Slopes<S>, weight: f64) -> Slopes<S> {
        let [xx, yy, xy] = self
            .forces(Self::strain(slopes))
            .map(|force| force * weight);
        let [a, b] = slopes;
        let mut by = [[S::zero(); 3]; 2];
        for i in 0..3 {
            by[0][i] = a[i] * xx + b[i] * xy;
            by[1][i] = a[i] * xy + b[i] * yy;
        }
        by
    }

    /// Second derivatives of W, times `weight`: `[row vector][column vector][row][column]`.
    #[inline(always)]
    pub fn hessian<S: Scalar>(&self, slopes: &Slopes<S>, weight: f64) -> [[[[S; 3]; 3]; 2]; 2] {
        let forces = self
            .forces(Self::strain(slopes))
            .map(|force| force * weight);
        let [normal, coupling, shear] =
            [self.normal, self.coupling, self.shear].map(|stiffness| stiffness * weight);
        let [a, b] = slopes;
        let mut h = [[[[S::zero(); 3]; 3]; 2]; 2];
        for i in 0..3 {
            for j in 0..3 {
                let (aa, bb) = (a[i] * a[j], b[i] * b[j]);
                h[0][0][i][j] = aa * normal + bb * shear;
                h[1][1][i][j] = bb * normal + aa * shear;
                let ab = a[i] * b[j] * coupling + b[i] * a[j] * shear;
                h[0][1][i][j] = ab;
                h[1][0][j][i] = ab;
            }
        }
        for i in 0..3 {
            h[0][0][i][i] += forces[0];
            h[1][1][i][i] += forces[1];
            h[0][1][i][i] += forces[2];
            h[1][0][i][i] += forces[2];
        }
        h
    }
}
