//! Shear and thickness of a belt beam at its nodes, functions of the two slopes there.

use super::DOF;
use crate::scalar::{Scalar, unroll};

/// Nodal shear `-t . u` with `t = r_x / |r_x|`, `u = r_y / |r_y|`, the thickness strain `|r_y| - 1`,
/// and what their derivatives need.
pub(super) struct Node<S> {
    t: [S; 2],
    pub u: [S; 2],
    per_slope: S,
    pub per_thickness: S,
    pub shear: S,
    pub thickness: S,
}

impl<S: Scalar> Node<S> {
    #[inline(always)]
    pub fn new(e: &[S; DOF], node: usize) -> Self {
        let (c, d) = (
            [e[6 * node + 2], e[6 * node + 3]],
            [e[6 * node + 4], e[6 * node + 5]],
        );
        let thickness = (d[0] * d[0] + d[1] * d[1]).sqrt();
        let per_slope = (c[0] * c[0] + c[1] * c[1]).sqrt().recip();
        let per_thickness = thickness.recip();
        let t = [c[0] * per_slope, c[1] * per_slope];
        let u = [d[0] * per_thickness, d[1] * per_thickness];
        Self {
            t,
            u,
            per_slope,
            per_thickness,
            shear: -(t[0] * u[0] + t[1] * u[1]),
            thickness: thickness - 1.0,
        }
    }

    /// Gradient of the shear by (r_x, r_y) of the node.
    #[inline(always)]
    pub fn shear_gradient(&self) -> [S; 4] {
        let (t, u, shear) = (self.t, self.u, self.shear);
        [
            -(u[0] + shear * t[0]) * self.per_slope,
            -(u[1] + shear * t[1]) * self.per_slope,
            -(t[0] + shear * u[0]) * self.per_thickness,
            -(t[1] + shear * u[1]) * self.per_thickness,
        ]
    }

    /// Hessian of the shear by (r_x, r_y) of the node, times `factor`.
    #[inline(always)]
    pub fn shear_hessian(&self, factor: S) -> [[S; 4]; 4] {
        let (t, u, cosine) = (self.t, self.u, -self.shear);
        let by_slope = self.per_slope * factor;
        let (ss, st, tt) = (
            by_slope * self.per_slope,
            by_slope * self.per_thickness,
            self.per_thickness * self.per_thickness * factor,
        );
        let mut h = [[S::zero(); 4]; 4];
        unroll!(for i in 0..2 {
            unroll!(for j in 0..2 {
                let unit = if i == j { 1.0 } else { 0.0 };
                let mixed = t[i] * u[j] + u[i] * t[j];
                h[i][j] = (mixed + cosine * unit - cosine * t[i] * t[j] * 3.0) * ss;
                h[2 + i][2 + j] = (mixed + cosine * unit - cosine * u[i] * u[j] * 3.0) * tt;
                // -(1 - t t)(1 - u u)
                h[i][2 + j] = (t[i] * t[j] + u[i] * u[j] - cosine * t[i] * u[j] - unit) * st;
                h[2 + j][i] = h[i][2 + j];
            });
        });
        h
    }
}
