//! Internal damping of a belt beam: Kelvin-Voigt in axial strain and curvature.
//!
//! With the axial Green strain `e = (c.c - 1) / 2` and the turning `kappa = (c x c') / c.c`, both blind to
//! rigid motion:
//!
//! ```text
//! Q = -tau ∫ alpha1 E A  de/dt  de/dq + alpha2 E I2  dkappa/dt  dkappa/dq  dx
//! ```

use super::density::Kinematics;
use super::lines::{self, Lines, Shape};
use super::{BeltBeam2, DOF, Point};
use crate::scalar::{Scalar, unroll};

/// Strain, turning and their rates at a point; derivatives are by (c, c').
struct Rates<S> {
    c: [S; 2],
    kappa_gradient: [S; 4],
    kappa_hessian: [[S; 4]; 4],
    /// Rates of c and c'.
    change: [S; 4],
    strain_rate: S,
    kappa_rate: S,
}

impl<S: Scalar> Rates<S> {
    #[inline(always)]
    fn new(shape: &Shape, position: &Lines<S>, velocity: &Lines<S>) -> Self {
        let (c, curve) = shape.apply(position);
        let at = Kinematics::new(c, curve, S::zero(), S::zero());
        let (by_c, by_curve) = at.kappa_gradient();
        let (dc, dcurve) = shape.apply(velocity);
        Self {
            c,
            kappa_gradient: [by_c[0], by_c[1], by_curve[0], by_curve[1]],
            kappa_hessian: at.kappa_hessian(),
            change: [dc[0], dc[1], dcurve[0], dcurve[1]],
            strain_rate: c[0] * dc[0] + c[1] * dc[1],
            kappa_rate: by_c[0] * dc[0]
                + by_c[1] * dc[1]
                + by_curve[0] * dcurve[0]
                + by_curve[1] * dcurve[1],
        }
    }
}

impl<S: Scalar> Kinematics<S> {
    /// dkappa/dc and dkappa/dc'.
    #[inline(always)]
    fn kappa_gradient(&self) -> ([S; 2], [S; 2]) {
        let (x, y) = self.cross_gradient();
        let twice = self.kappa * 2.0;
        (
            [
                (x[0] - twice * self.c[0]) * self.per_a,
                (x[1] - twice * self.c[1]) * self.per_a,
            ],
            [y[0] * self.per_a, y[1] * self.per_a],
        )
    }

    /// Hessian of kappa by (c, c'): from `a kappa = c x c'` differentiated twice.
    #[inline(always)]
    fn kappa_hessian(&self) -> [[S; 4]; 4] {
        let (by_c, by_curve) = self.kappa_gradient();
        let mut h = [[S::zero(); 4]; 4];
        unroll!(for i in 0..2 {
            unroll!(for j in 0..2 {
                let unit = if i == j { 1.0 } else { 0.0 };
                let mixed = self.c[i] * by_c[j] + by_c[i] * self.c[j];
                h[i][j] = -(self.kappa * unit + mixed) * self.per_a * 2.0;
                let cross = [[0.0, 1.0], [-1.0, 0.0]][i][j];
                h[i][2 + j] = (-(self.c[i] * by_curve[j]) * 2.0 + cross) * self.per_a;
                h[2 + j][i] = h[i][2 + j];
            });
        });
        h
    }
}

impl BeltBeam2 {
    /// Viscosity times weight of a point: axial and bending.
    #[inline(always)]
    fn viscosity(&self, point: &Point) -> (f64, f64) {
        (
            4.0 * self.damping_time * point.stiffness.axial,
            self.damping_time * point.stiffness.bending,
        )
    }

    /// What opposes the damping force at a point, by c and c': viscosity times rates.
    #[inline(always)]
    pub(super) fn damping_gradient<S: Scalar>(
        &self,
        point: &Point,
        at: &Kinematics<S>,
        velocity: &Lines<S>,
    ) -> ([S; 2], [S; 2]) {
        let (axial, bending) = self.viscosity(point);
        let (dc, dcurve) = point.shape.apply(velocity);
        let (by_c, by_curve) = at.kappa_gradient();
        let kappa_rate =
            by_c[0] * dc[0] + by_c[1] * dc[1] + by_curve[0] * dcurve[0] + by_curve[1] * dcurve[1];
        let axial = (at.c[0] * dc[0] + at.c[1] * dc[1]) * axial;
        let bending = kappa_rate * bending;
        (
            [
                axial * at.c[0] + bending * by_c[0],
                axial * at.c[1] + bending * by_c[1],
            ],
            [bending * by_curve[0], bending * by_curve[1]],
        )
    }

    #[inline(always)]
    pub(super) fn subtract_damping<S: Scalar>(
        &self,
        e: &[S; DOF],
        rate: &[S; DOF],
        force: &mut [S; DOF],
    ) {
        let (position, velocity) = (lines::lines(e), lines::lines(rate));
        let mut sum = [[S::zero(); 2]; 3];
        for point in &self.points {
            let (c, curve) = point.shape.apply(&position);
            let at = Kinematics::new(c, curve, S::zero(), S::zero());
            let (by_c, by_curve) = self.damping_gradient(point, &at, &velocity);
            point.shape.add(by_c, by_curve, &mut sum);
        }
        lines::subtract(&sum, force);
    }

    #[inline(always)]
    pub(super) fn add_damping_matrix<S: Scalar>(
        &self,
        e: &[S; DOF],
        rate: &[S; DOF],
        [position_factor, rate_factor]: [f64; 2],
        tangent: &mut [S; DOF * DOF],
    ) {
        let (position, velocity) = (lines::lines(e), lines::lines(rate));
        let mut sum = [[[[S::zero(); 3]; 3]; 2]; 2];
        for point in &self.points {
            let at = Rates::new(&point.shape, &position, &velocity);
            let (axial, bending) = self.viscosity(point);
            let (by, hessian, change) = (at.kappa_gradient, at.kappa_hessian, at.change);
            let mut local = [[S::zero(); 4]; 4];
            unroll!(for i in 0..4 {
                // d(dkappa/dt)/d(c, c') at fixed rates, and what the rate adds.
                let turned = hessian[i][0] * change[0]
                    + hessian[i][1] * change[1]
                    + hessian[i][2] * change[2]
                    + hessian[i][3] * change[3];
                let moved = turned * (bending * position_factor) + by[i] * (bending * rate_factor);
                unroll!(for j in 0..4 {
                    local[j][i] =
                        by[j] * moved + at.kappa_rate * hessian[j][i] * (bending * position_factor);
                });
            });
            unroll!(for i in 0..2 {
                let moved = change[i] * (axial * position_factor) + at.c[i] * (axial * rate_factor);
                unroll!(for j in 0..2 {
                    local[j][i] += at.c[j] * moved;
                });
                local[i][i] += at.strain_rate * (axial * position_factor);
            });
            let (slope, curve) = (&point.shape.slope, &point.shape.curve);
            unroll!(for m in 0..2 {
                unroll!(for n in 0..2 {
                    unroll!(for j in 0..3 {
                        let by_c = local[m][n] * slope[j] + local[m][2 + n] * curve[j];
                        let by_curve = local[2 + m][n] * slope[j] + local[2 + m][2 + n] * curve[j];
                        unroll!(for i in 0..3 {
                            sum[m][n][i][j] += by_c * slope[i] + by_curve * curve[i];
                        });
                    });
                });
            });
        }
        lines::place(|m, n, i, j| sum[m][n][i][j], tangent);
    }
}
