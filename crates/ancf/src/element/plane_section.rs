//! Energy of a planar cross-section that stays a straight line, integrated in closed form.
//!
//! The section at x holds the points `r = r_c(x) + y d(x)`, so with `c = r_c,x` and `w = d,x`
//!
//! ```text
//! exx = e0 + y b + y² g     e0 = (c.c - 1) / 2,  b = c.w,  g = w.w / 2
//! eyy = (d.d - 1) / 2       2 exy = c.d + y w.d                                  (Green-Lagrange)
//! W = 1/2 ∫ P (exx² + eyy²) + 2 Q exx eyy + G (2 exy)² dA
//!   = P/2 [A e0² + I2 (b² + 2 e0 g) + I4 g² + A eyy²] + Q eyy (A e0 + I2 g)
//!     + G/2 [A (c.d)² + I2 (w.d)²]
//! ```
//!
//! for any doubly symmetric section. All terms are kept: without the I2 part of the shear a motion
//! without energy appears. Only dot products enter, so W belongs to the axes of a straight element
//! however it is drawn and moved.

use crate::scalar::Scalar;
use crate::section::PlanarSection;

/// Moduli P, Q, G times the moments of the section.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct PlaneSection {
    /// P A, P I2, P I4.
    normal: [f64; 3],
    /// Q A, Q I2.
    coupling: [f64; 2],
    /// G A, G I2.
    shear: [f64; 2],
}

/// The vectors of a section.
#[derive(Clone, Copy)]
pub(super) struct Vectors<S> {
    /// Slope of the centre line.
    pub c: [S; 2],
    /// Derivative by x of the fibre.
    pub w: [S; 2],
    /// The fibre.
    pub d: [S; 2],
}

/// Second derivatives of W; `cw` has the row of c and the column of w.
pub(super) struct Hessian<S> {
    pub cc: [[S; 2]; 2],
    pub cw: [[S; 2]; 2],
    pub cd: [[S; 2]; 2],
    pub ww: [[S; 2]; 2],
    pub wd: [[S; 2]; 2],
    pub dd: [[S; 2]; 2],
}

/// Derivatives of W by e0, b, g, eyy and by the shears `c.d` and `w.d`.
struct Stress<S> {
    axial: S,
    bending: S,
    spread: S,
    thickness: S,
    shear: S,
    shear_gradient: S,
}

#[inline(always)]
fn dot<S: Scalar>(a: [S; 2], b: [S; 2]) -> S {
    a[0] * b[0] + a[1] * b[1]
}

impl PlaneSection {
    pub(super) fn new(section: &PlanarSection, normal: f64, coupling: f64, shear: f64) -> Self {
        let (area, second) = (section.area, section.second_moment);
        Self {
            normal: [
                normal * area,
                normal * second,
                normal * section.fourth_moment,
            ],
            coupling: [coupling * area, coupling * second],
            shear: [shear * area, shear * second],
        }
    }

    /// W [J/m].
    #[inline(always)]
    pub(super) fn energy<S: Scalar>(&self, Vectors { c, w, d }: Vectors<S>) -> S {
        let e0 = (dot(c, c) - 1.0) * 0.5;
        let b = dot(c, w);
        let g = dot(w, w) * 0.5;
        let eyy = (dot(d, d) - 1.0) * 0.5;
        let (shear, shear_gradient) = (dot(c, d), dot(w, d));
        let [a, i2, i4] = self.normal;
        (e0 * e0 + eyy * eyy) * (0.5 * a)
            + (b * b * 0.5 + e0 * g) * i2
            + g * g * (0.5 * i4)
            + eyy * (e0 * self.coupling[0] + g * self.coupling[1])
            + shear * shear * (0.5 * self.shear[0])
            + shear_gradient * shear_gradient * (0.5 * self.shear[1])
    }

    #[inline(always)]
    fn stress<S: Scalar>(&self, Vectors { c, w, d }: Vectors<S>) -> Stress<S> {
        let e0 = (dot(c, c) - 1.0) * 0.5;
        let g = dot(w, w) * 0.5;
        let eyy = (dot(d, d) - 1.0) * 0.5;
        let [a, i2, i4] = self.normal;
        let [qa, q2] = self.coupling;
        Stress {
            axial: e0 * a + g * i2 + eyy * qa,
            bending: dot(c, w) * i2,
            spread: e0 * i2 + g * i4 + eyy * q2,
            thickness: eyy * a + e0 * qa + g * q2,
            shear: dot(c, d) * self.shear[0],
            shear_gradient: dot(w, d) * self.shear[1],
        }
    }

    /// Derivatives of W by c, w and d.
    #[inline(always)]
    pub(super) fn gradient<S: Scalar>(&self, at: Vectors<S>) -> Vectors<S> {
        let s = self.stress(at);
        let Vectors { c, w, d } = at;
        let combine = |f: [S; 3], i: usize| f[0] * c[i] + f[1] * w[i] + f[2] * d[i];
        let by_c = [s.axial, s.bending, s.shear];
        let by_w = [s.bending, s.spread, s.shear_gradient];
        let by_d = [s.shear, s.shear_gradient, s.thickness];
        Vectors {
            c: [combine(by_c, 0), combine(by_c, 1)],
            w: [combine(by_w, 0), combine(by_w, 1)],
            d: [combine(by_d, 0), combine(by_d, 1)],
        }
    }

    /// Second derivatives of W, times `weight`.
    #[inline(always)]
    pub(super) fn hessian<S: Scalar>(&self, at: Vectors<S>, weight: f64) -> Hessian<S> {
        let s = self.stress(at);
        let Vectors { c, w, d } = at;
        let [a, i2, i4] = self.normal.map(|stiffness| stiffness * weight);
        let [qa, q2] = self.coupling.map(|stiffness| stiffness * weight);
        let [ga, g2] = self.shear.map(|stiffness| stiffness * weight);
        let [mut cc, mut cw, mut cd] = [[[S::zero(); 2]; 2]; 3];
        let [mut ww, mut wd, mut dd] = [[[S::zero(); 2]; 2]; 3];
        for i in 0..2 {
            for j in 0..2 {
                let (c_c, w_w, d_d) = (c[i] * c[j], w[i] * w[j], d[i] * d[j]);
                cc[i][j] = c_c * a + w_w * i2 + d_d * ga;
                cw[i][j] = (c[i] * w[j] + w[i] * c[j]) * i2;
                cd[i][j] = c[i] * d[j] * qa + d[i] * c[j] * ga;
                ww[i][j] = c_c * i2 + w_w * i4 + d_d * g2;
                wd[i][j] = w[i] * d[j] * q2 + d[i] * w[j] * g2;
                dd[i][j] = c_c * ga + w_w * g2 + d_d * a;
            }
            cc[i][i] += s.axial * weight;
            cw[i][i] += s.bending * weight;
            cd[i][i] += s.shear * weight;
            ww[i][i] += s.spread * weight;
            wd[i][i] += s.shear_gradient * weight;
            dd[i][i] += s.thickness * weight;
        }
        Hessian {
            cc,
            cw,
            cd,
            ww,
            wd,
            dd,
        }
    }
}
