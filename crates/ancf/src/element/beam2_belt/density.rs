//! Energy of a belt beam at a quadrature point, and its derivatives.
//!
//! With `a = c.c`, `X = c x c'`, `kappa = X / a`, `k = kappa + q`, `tau = p kappa`, `b = k² + tau²` (see
//! the element's head), times the point's weight:
//!
//! ```text
//! W = EA/8 (a - 1)² + EI2/2 [a k² + (a - 1) b / 2] + EI4/8 b² + ksG/2 [A p² a + I2 p² q²]
//! ```
//!
//! W is differentiated by (a, kappa, p, q), then `kappa = X / a` is put in, and at last
//! `da = 2 c.dc`, `dX = (c'_y, -c'_x).dc + (-c_y, c_x).dc'`.

use crate::scalar::{Scalar, unroll};

/// Stiffnesses times the weight of a point.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Stiffness {
    /// alpha1 E A / 4.
    pub axial: f64,
    /// alpha2 E I2.
    pub bending: f64,
    /// alpha2 E I4 / 4.
    pub fourth: f64,
    /// alpha2 ks G A.
    pub shear: f64,
    /// alpha2 ks G I2.
    pub shear_gradient: f64,
}

/// What W depends on at a point: `c`, `c'`, `p`, `q` and what follows from them.
pub(super) struct Kinematics<S> {
    pub c: [S; 2],
    pub curve: [S; 2],
    p: S,
    q: S,
    a: S,
    pub per_a: S,
    pub kappa: S,
    /// `k = kappa + q`.
    bend: S,
    /// `tau = p kappa`.
    twist: S,
    b: S,
}

/// First derivatives of W.
pub(super) struct Gradient<S> {
    pub c: [S; 2],
    pub curve: [S; 2],
    pub p: S,
    pub q: S,
}

/// Second derivatives of W; `c` and `k` stand for c and c', symmetric blocks as (xx, xy, yy).
pub(super) struct Hessian<S> {
    pub cc: [S; 3],
    pub ck: [[S; 2]; 2],
    pub kk: [S; 3],
    pub cp: [S; 2],
    pub cq: [S; 2],
    pub kp: [S; 2],
    pub kq: [S; 2],
    pub pp: S,
    pub pq: S,
    pub qq: S,
}

/// First derivatives of W by a, kappa, p and q, and twice that by b.
struct Inner<S> {
    twice_b: S,
    a: S,
    kappa: S,
    p: S,
    q: S,
}

impl<S: Scalar> Kinematics<S> {
    #[inline(always)]
    pub fn new(c: [S; 2], curve: [S; 2], p: S, q: S) -> Self {
        let a = c[0] * c[0] + c[1] * c[1];
        let per_a = a.recip();
        let kappa = (c[0] * curve[1] - c[1] * curve[0]) * per_a;
        let bend = kappa + q;
        let twist = p * kappa;
        Self {
            c,
            curve,
            p,
            q,
            a,
            per_a,
            kappa,
            bend,
            twist,
            b: bend * bend + twist * twist,
        }
    }

    /// W.
    #[inline(always)]
    pub fn energy(&self, stiffness: &Stiffness) -> S {
        let Self {
            a, b, p, q, bend, ..
        } = *self;
        let stretch = a - 1.0;
        stretch * stretch * (stiffness.axial / 2.0)
            + (a * bend * bend + stretch * b * 0.5) * (stiffness.bending / 2.0)
            + b * b * (stiffness.fourth / 2.0)
            + p * p * (a * (stiffness.shear / 2.0) + q * q * (stiffness.shear_gradient / 2.0))
    }

    #[inline(always)]
    fn inner(&self, stiffness: &Stiffness) -> Inner<S> {
        let Self {
            a,
            b,
            p,
            q,
            bend,
            twist,
            ..
        } = *self;
        let stretch = a - 1.0;
        let twice_b = stretch * (0.5 * stiffness.bending) + b * (2.0 * stiffness.fourth);
        let by_bend = bend * (a * stiffness.bending + twice_b);
        let sheared = p * q * stiffness.shear_gradient;
        let p_shear = p * stiffness.shear;
        Inner {
            twice_b,
            a: stretch * stiffness.axial
                + (bend * bend + b * 0.5) * (0.5 * stiffness.bending)
                + p * p_shear * 0.5,
            kappa: by_bend + twice_b * p * twist,
            p: twice_b * twist * self.kappa + a * p_shear + sheared * q,
            q: by_bend + sheared * p,
        }
    }

    /// dX/dc and dX/dc'.
    #[inline(always)]
    pub fn cross_gradient(&self) -> ([S; 2], [S; 2]) {
        ([self.curve[1], -self.curve[0]], [-self.c[1], self.c[0]])
    }

    /// First derivatives of W.
    #[inline(always)]
    pub fn gradient(&self, stiffness: &Stiffness) -> Gradient<S> {
        let inner = self.inner(stiffness);
        let by_cross = inner.kappa * self.per_a;
        let twice_by_a = (inner.a - by_cross * self.kappa) * 2.0;
        let ([x0, x1], [y0, y1]) = self.cross_gradient();
        Gradient {
            c: [
                twice_by_a * self.c[0] + by_cross * x0,
                twice_by_a * self.c[1] + by_cross * x1,
            ],
            curve: [by_cross * y0, by_cross * y1],
            p: inner.p,
            q: inner.q,
        }
    }

    /// Second derivatives of W; with them its first by p and q.
    #[inline(always)]
    pub fn hessian(&self, stiffness: &Stiffness) -> (Hessian<S>, [S; 2]) {
        let Self {
            c,
            a,
            p,
            q,
            per_a,
            kappa,
            bend,
            twist,
            ..
        } = *self;
        let inner = self.inner(stiffness);
        let twice_b = inner.twice_b;
        let fourth = 4.0 * stiffness.fourth;
        // Half of db/dkappa and of db/dp; that of db/dq is `bend`.
        let b_kappa = bend + p * twist;
        let b_p = twist * kappa;
        let curved = b_kappa * fourth;
        let bent = bend * fourth;
        let a_bending = a * stiffness.bending + twice_b;

        let a_kappa = (bend + b_kappa * 0.5) * stiffness.bending;
        let a_p = b_p * (0.5 * stiffness.bending) + p * stiffness.shear;
        let a_q = bend * (1.5 * stiffness.bending);
        let kappa_kappa = a_bending + curved * b_kappa + twice_b * (p * p);
        let kappa_p = curved * b_p + twice_b * twist * 2.0;
        let kappa_q = a_bending + curved * bend;

        // By (a, X) instead of (a, kappa).
        let ratio = kappa * per_a;
        let by_cross = inner.kappa * per_a;
        let twice_by_a = (inner.a - by_cross * kappa) * 2.0;
        let rest = a_kappa - kappa_kappa * ratio;
        let cross_cross = kappa_kappa * per_a * per_a;
        let twice_a_cross = (rest - by_cross) * per_a * 2.0;
        let four_a_a = (-(ratio * (a_kappa + rest - by_cross * 2.0)) + stiffness.axial) * 4.0;
        let (cross_p, cross_q) = (kappa_p * per_a, kappa_q * per_a);
        let twice_a_p = (a_p - kappa_p * ratio) * 2.0;
        let twice_a_q = (a_q - kappa_q * ratio) * 2.0;

        let (x, y) = self.cross_gradient();
        let along = |i: usize| c[i] * four_a_a + x[i] * twice_a_cross;
        let across = |i: usize| c[i] * twice_a_cross + x[i] * cross_cross;
        let (along, across) = ([along(0), along(1)], [across(0), across(1)]);
        let y_cross = [y[0] * cross_cross, y[1] * cross_cross];
        let mut h = Hessian {
            cc: [
                c[0] * along[0] + x[0] * across[0] + twice_by_a,
                c[0] * along[1] + x[0] * across[1],
                c[1] * along[1] + x[1] * across[1] + twice_by_a,
            ],
            ck: [
                [across[0] * y[0], across[0] * y[1] + by_cross],
                [across[1] * y[0] - by_cross, across[1] * y[1]],
            ],
            kk: [y[0] * y_cross[0], y[0] * y_cross[1], y[1] * y_cross[1]],
            cp: [S::zero(); 2],
            cq: [S::zero(); 2],
            kp: [S::zero(); 2],
            kq: [S::zero(); 2],
            pp: b_p * b_p * fourth
                + twice_b * (kappa * kappa)
                + a * stiffness.shear
                + q * q * stiffness.shear_gradient,
            pq: b_p * bent + p * q * (2.0 * stiffness.shear_gradient),
            qq: a_bending + bend * bent + p * p * stiffness.shear_gradient,
        };
        unroll!(for i in 0..2 {
            h.cp[i] = c[i] * twice_a_p + x[i] * cross_p;
            h.cq[i] = c[i] * twice_a_q + x[i] * cross_q;
            h.kp[i] = y[i] * cross_p;
            h.kq[i] = y[i] * cross_q;
        });
        (h, [inner.p, inner.q])
    }
}
