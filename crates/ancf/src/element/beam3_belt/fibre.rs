//! A fibre of the section, sheared off the normal plane of the centre line, and its derivatives.
//!
//! ```text
//! t = c / |c|,   n = (d - h t) / g,   h = t.d,   g = |d - h t|,   m = t x n
//! s(c, d, tau) = n + tau t
//! ```
//!
//! With `f = |c|`, `k = h / g` and the turns `phi = t.dc / f`, `alpha = n.dc / f`, `beta = m.dc / f`,
//! `delta = m.dd / g`, `gamma = delta - k beta` of the frame,
//!
//! ```text
//! dt = alpha n + beta m      dn = -alpha t + gamma m      dm = -beta t - gamma n
//! ds = dn + tau dt + t dtau
//! ```
//!
//! and differentiating once more (`w` fixed, `w_t = w.t`, ..., `psi_t = t.dd / g`, `psi_n = n.dd / g`)
//!
//! ```text
//! d²(w.s) = 2 (w_t - tau w_n) phi alpha + 2 (k - tau) w_m phi beta - (w_n + tau w_t) alpha²
//!         - 2 (1 + k²) w_m alpha beta + (2 k w_t - k² w_n - tau w_t) beta² + 2 k w_m alpha delta
//!         + 2 (k w_n - w_t) beta delta - w_n delta² - 2 w_m beta psi_t + 2 k w_m beta psi_n
//!         - 2 w_m delta psi_n + 2 (w_n alpha + w_m beta) dtau
//! ```
//!
//! All quantities are [`Series`]: they carry their derivatives by x, so s' and the derivatives of
//! `p.s + q.s'` come from the same formulas.

use crate::element::vector::dot;
use crate::scalar::{Scalar, Series};

type Number<S> = Series<S>;
type Vector<S> = [Number<S>; 3];

/// The frame of a fibre.
pub(super) struct Fibre<S> {
    /// Tangent of the centre line, dS/dtau.
    pub t: Vector<S>,
    n: Vector<S>,
    /// Binormal of tangent and fibre: the direction that s takes with delta.
    pub m: Vector<S>,
    /// 1 / f.
    per_f: Number<S>,
    /// 1 / g.
    per_g: Number<S>,
    k: Number<S>,
    tau: Number<S>,
}

/// First derivatives of `w.s`.
pub(super) struct Gradient<S> {
    pub c: Vector<S>,
    pub delta: Number<S>,
    pub tau: Number<S>,
}

/// Second derivatives of `w.s`; `cd` has the row of c. None by d and tau, nor by tau twice.
pub(super) struct Curvature<S> {
    pub cc: [Vector<S>; 3],
    pub cd: [Vector<S>; 3],
    pub dd: [Vector<S>; 3],
    pub c_tau: Vector<S>,
}

impl<S: Scalar> Fibre<S> {
    #[inline(always)]
    pub fn new(c: Vector<S>, d: Vector<S>, tau: Number<S>) -> Self {
        let per_f = dot(c, c).sqrt().recip();
        let t = [c[0] * per_f, c[1] * per_f, c[2] * per_f];
        let h = dot(t, d);
        let u = [d[0] - h * t[0], d[1] - h * t[1], d[2] - h * t[2]];
        let per_g = dot(u, u).sqrt().recip();
        let n = [u[0] * per_g, u[1] * per_g, u[2] * per_g];
        let m = [
            t[1] * n[2] - t[2] * n[1],
            t[2] * n[0] - t[0] * n[2],
            t[0] * n[1] - t[1] * n[0],
        ];
        Self {
            t,
            n,
            m,
            per_f,
            per_g,
            k: h * per_g,
            tau,
        }
    }

    /// s.
    #[inline(always)]
    pub fn vector(&self) -> Vector<S> {
        let (n, t, tau) = (self.n, self.t, self.tau);
        [n[0] + tau * t[0], n[1] + tau * t[1], n[2] + tau * t[2]]
    }

    /// Derivative of delta by d: m / g.
    #[inline(always)]
    pub fn turn(&self) -> Vector<S> {
        let (m, per_g) = (self.m, self.per_g);
        [m[0] * per_g, m[1] * per_g, m[2] * per_g]
    }

    /// ds/dc.
    #[inline(always)]
    pub fn by_centre(&self) -> [Vector<S>; 3] {
        let Self { t, n, m, tau, .. } = *self;
        let per_f = self.per_f;
        let along = [n[0] * per_f, n[1] * per_f, n[2] * per_f];
        let across = (tau - self.k) * self.per_f;
        let mut by_centre = [[Series::zero(); 3]; 3];
        for i in 0..3 {
            let (by_n, by_m) = (tau * n[i] - t[i], across * m[i]);
            for j in 0..3 {
                by_centre[i][j] = by_n * along[j] + by_m * m[j];
            }
        }
        by_centre
    }

    /// First derivatives of `w.s`.
    #[inline(always)]
    pub fn gradient(&self, w: Vector<S>) -> Gradient<S> {
        let Self { t, n, m, tau, .. } = *self;
        let (w_t, w_n, w_m) = (dot(w, t), dot(w, n), dot(w, m));
        let alpha = (tau * w_n - w_t) * self.per_f;
        let beta = (tau - self.k) * w_m * self.per_f;
        Gradient {
            c: [
                n[0] * alpha + m[0] * beta,
                n[1] * alpha + m[1] * beta,
                n[2] * alpha + m[2] * beta,
            ],
            delta: w_m,
            tau: w_t,
        }
    }

    /// Second derivatives of `w.s`.
    #[inline(always)]
    pub fn curvature(&self, w: Vector<S>) -> Curvature<S> {
        let Self {
            t,
            n,
            m,
            tau,
            k,
            per_f,
            per_g,
        } = *self;
        let (w_t, w_n, w_m) = (dot(w, t), dot(w, n), dot(w, m));
        let (k_m, k_n, tau_t) = (k * w_m, k * w_n, tau * w_t);
        let (ff, fg, gg) = (per_f * per_f, per_f * per_g, per_g * per_g);
        let phi_alpha = (w_t - tau * w_n) * ff;
        let phi_beta = (k - tau) * w_m * ff;
        let half_alpha = (w_n + tau_t) * ff * -0.5;
        let alpha_beta = -(w_m + k * k_m) * ff;
        let half_beta = (k * (w_t * 2.0 - k_n) - tau_t) * ff * 0.5;
        let alpha_delta = k_m * fg;
        let beta_delta = (k_n - w_t) * fg;
        let (beta_t, beta_n) = (-(w_m * fg), k_m * fg);
        let half_delta = w_n * gg * -0.5;
        let delta_n = -(w_m * gg);
        let mut curvature = Curvature {
            cc: [[Series::zero(); 3]; 3],
            cd: [[Series::zero(); 3]; 3],
            dd: [[Series::zero(); 3]; 3],
            c_tau: [Series::zero(); 3],
        };
        let (mut with_n, mut with_m) = ([Series::zero(); 3], [Series::zero(); 3]);
        let (mut of_beta, mut of_delta) = ([Series::zero(); 3], [Series::zero(); 3]);
        for i in 0..3 {
            with_n[i] = phi_alpha * t[i] + half_alpha * n[i] + alpha_beta * m[i];
            with_m[i] = phi_beta * t[i] + half_beta * m[i];
            of_beta[i] = beta_t * t[i] + beta_n * n[i] + beta_delta * m[i];
            of_delta[i] = half_delta * m[i] + delta_n * n[i];
            curvature.c_tau[i] = (n[i] * w_n + m[i] * w_m) * per_f;
        }
        for i in 0..3 {
            for j in i..3 {
                let cc = n[i] * with_n[j] + with_n[i] * n[j] + m[i] * with_m[j] + with_m[i] * m[j];
                let dd = m[i] * of_delta[j] + of_delta[i] * m[j];
                curvature.cc[i][j] = cc;
                curvature.cc[j][i] = cc;
                curvature.dd[i][j] = dd;
                curvature.dd[j][i] = dd;
            }
            let by_n = alpha_delta * n[i];
            for j in 0..3 {
                curvature.cd[i][j] = by_n * m[j] + m[i] * of_beta[j];
            }
        }
        curvature
    }
}
