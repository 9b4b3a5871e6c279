//! Shear at a node: the cosine between the slope along the belt and one across it.

use crate::scalar::Scalar;

/// Shear `tau = t . u` with `t = r_x / |r_x|`, `u = d / |d|`, d one of r_y and r_z, the stretch `|d| - 1`,
/// and what their derivatives need.
pub(super) struct Node<S> {
    t: [S; 3],
    pub u: [S; 3],
    per_slope: S,
    pub per_length: S,
    pub shear: S,
    pub stretch: S,
}

impl<S: Scalar> Node<S> {
    #[inline(always)]
    pub fn new(c: [S; 3], d: [S; 3]) -> Self {
        let length = (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]).sqrt();
        let per_slope = (c[0] * c[0] + c[1] * c[1] + c[2] * c[2]).sqrt().recip();
        let per_length = length.recip();
        let t = [c[0] * per_slope, c[1] * per_slope, c[2] * per_slope];
        let u = [d[0] * per_length, d[1] * per_length, d[2] * per_length];
        Self {
            t,
            u,
            per_slope,
            per_length,
            shear: t[0] * u[0] + t[1] * u[1] + t[2] * u[2],
            stretch: length - 1.0,
        }
    }

    /// Gradient of the shear by r_x, then by d.
    #[inline(always)]
    pub fn shear_gradient(&self) -> [S; 6] {
        let (t, u, shear) = (self.t, self.u, self.shear);
        let mut gradient = [S::zero(); 6];
        for i in 0..3 {
            gradient[i] = (u[i] - shear * t[i]) * self.per_slope;
            gradient[3 + i] = (t[i] - shear * u[i]) * self.per_length;
        }
        gradient
    }

    /// Hessian of the shear by (r_x, d), times `factor`.
    #[inline(always)]
    pub fn shear_hessian(&self, factor: S) -> [[S; 6]; 6] {
        let (t, u, cosine) = (self.t, self.u, self.shear);
        let by_slope = self.per_slope * factor;
        let (ss, sd, dd) = (
            by_slope * self.per_slope,
            by_slope * self.per_length,
            self.per_length * self.per_length * factor,
        );
        let mut h = [[S::zero(); 6]; 6];
        for i in 0..3 {
            for j in 0..3 {
                let unit = if i == j { 1.0 } else { 0.0 };
                let mixed = t[i] * u[j] + u[i] * t[j];
                h[i][j] = (cosine * t[i] * t[j] * 3.0 - mixed - cosine * unit) * ss;
                h[3 + i][3 + j] = (cosine * u[i] * u[j] * 3.0 - mixed - cosine * unit) * dd;
                // (1 - t t)(1 - u u)
                h[i][3 + j] = (cosine * t[i] * u[j] - t[i] * t[j] - u[i] * u[j] + unit) * sd;
                h[3 + j][i] = h[i][3 + j];
            }
        }
        h
    }
}
