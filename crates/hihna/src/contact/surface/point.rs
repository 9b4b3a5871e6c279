//! Contact at one point of a surface in space: forces, torque, losses and their derivatives.
//!
//! In the base `n, t, p` at the point, with `m = c (n - R' p)` and `a = c (p + R' n)`, a gradient by the point's
//! position and velocity is a row of three numbers. The base turns with the point; c is constant, and with the part
//! b of the depth in the lever `L = rho + b (R - rho)` of the slip
//!
//! ```text
//! dn = t (t.dr)/rho      dt = -n (t.dr)/rho      dR = R' p.dr      dR' = R'' p.dr
//! d(d)  = -m.dr          d(d') = c (-(v_t/rho) t.dr + R'' v_p p.dr) - m.dv
//! d(v_t - omega L) = -(v_n/rho) t.dr - omega ((1 - b) n + b R' p).dr + t.dv - L d(omega)
//! d(a.v) = c (R' (v_t/rho) t.dr + R'' v_n p.dr) + a.dv
//! dm = c (t t^T/rho - R'' p p^T) dr      da = c (R'' n p^T + (R'/rho) t t^T) dr
//! ```

use ancf::scalar::Scalar;

use super::SurfacePulley;
use super::meridian::Meridian;
use crate::contact::Penalty;
use crate::drive::FrictionDirections;
use crate::friction::{FrictionLaw, Slip};

/// Added to the square of a slip velocity [m²/s²], so that its direction has a derivative at rest: 1e-12 m/s,
/// far below any slip that matters.
const REST: f64 = 1.0e-24;

/// A point of the belt seen from the pulley's centre.
#[derive(Clone, Copy, Debug)]
pub(super) struct Meeting<S> {
    /// Position from the centre [m].
    pub arm: [S; 3],
    /// Velocity against the centre [m/s].
    pub v: [S; 3],
    /// Speed of the pulley [rad/s].
    pub speed: S,
}

/// What happens at one point of a belt's surface in contact (forces are zero outside).
#[derive(Clone, Copy, Debug)]
pub(super) struct SurfacePoint<S> {
    /// Penetration d [m], negative outside.
    pub penetration: S,
    /// Its rate d' [m/s].
    pub rate: S,
    /// Place along the axis, from the pulley's middle [m].
    pub along: S,
    /// Distance rho from the axis [m].
    pub distance: S,
    /// Unit vector n from the axis to the point.
    pub normal: [S; 3],
    /// Unit vector t around the pulley.
    pub around: [S; 3],
    /// f_n [N/m²].
    pub normal_force: S,
    /// Friction per area around the pulley and along it [N/m²].
    pub friction: [S; 2],
    /// Slip velocities around the pulley and along it [m/s].
    pub slip: [S; 2],
    /// Rise of friction with the magnitude of slip [N s/m³]: zero where it is exhausted.
    pub rise: S,
    /// Velocity in the base `n, t, p` [m/s].
    v: [S; 3],
    speed: S,
    /// L.
    lever: S,
    /// R'.
    slope: S,
    meridian: Meridian,
    // For the derivatives.
    by_penetration: S,
    by_rate: S,
    friction_by_slip: [[S; 2]; 2],
    friction_by_normal: [S; 2],
}

/// Derivatives of [`SurfacePoint`], signs and factors as the effective matrix wants them.
pub(super) struct SurfaceTangent<S> {
    /// Row-major 3 x 3.
    pub force: [S; 9],
    pub force_by_pulley: [S; 3],
    pub torque: [S; 3],
    pub torque_by_pulley: S,
}

#[inline(always)]
fn dot<S: Scalar>(a: [S; 3], b: [S; 3]) -> S {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// `x u + y v + z w` with the axis `w` of a pulley.
#[inline(always)]
fn combine<S: Scalar>([x, y, z]: [S; 3], u: [S; 3], v: [S; 3], w: [f64; 3]) -> [S; 3] {
    [
        x * u[0] + y * v[0] + z * w[0],
        x * u[1] + y * v[1] + z * w[1],
        x * u[2] + y * v[2] + z * w[2],
    ]
}

/// Place along the axis and vector from the axis to a point.
#[inline(always)]
pub(super) fn across<S: Scalar>(arm: [S; 3], p: [f64; 3]) -> (S, [S; 3]) {
    let along = arm[0] * p[0] + arm[1] * p[1] + arm[2] * p[2];
    (
        along,
        [
            arm[0] - along * p[0],
            arm[1] - along * p[1],
            arm[2] - along * p[2],
        ],
    )
}

impl<S: Scalar> SurfacePoint<S> {
    /// The contact of a point with the part `meridian` of `pulley`.
    #[inline(always)]
    pub fn new(
        penalty: &Penalty,
        (pulley, meridian): (&SurfacePulley, Meridian),
        directions: FrictionDirections,
        meeting: &Meeting<S>,
    ) -> Self {
        let zero = S::zero();
        let one = S::constant(1.0);
        let p = pulley.axis;
        let (along, radial) = across(meeting.arm, p);
        let distance = dot(radial, radial).sqrt();
        let per = distance.recip();
        let n = [radial[0] * per, radial[1] * per, radial[2] * per];
        // t = p x n
        let t = [
            n[2] * p[1] - n[1] * p[2],
            n[0] * p[2] - n[2] * p[0],
            n[1] * p[0] - n[0] * p[1],
        ];
        let velocity = meeting.v;
        let v = [
            dot(n, velocity),
            dot(t, velocity),
            velocity[0] * p[0] + velocity[1] * p[1] + velocity[2] * p[2],
        ];
        let depth = meridian.radius_at(along) - distance;
        let slope = meridian.slope_at(along);
        let unit = meridian.unit;
        let penetration = depth * unit;
        let rate = (slope * v[2] - v[0]) * unit;
        let lever = distance + depth * meridian.lever_part;
        let slip = [v[1] - meeting.speed * lever, (v[2] + slope * v[0]) * unit];
        let force = penetration * penalty.stiffness + rate * penalty.damping;
        // One where the point touches, one where its normal force acts; zero elsewhere.
        let touching = penetration.select_positive(one, zero);
        let pushing = if penalty.clamp {
            force.select_positive(touching, zero)
        } else {
            touching
        };
        let normal_force = pushing * force;
        let sign = normal_force.select_positive(one, -one);
        let both = directions == FrictionDirections::Both;
        let speed = if both {
            (slip[0] * slip[0] + slip[1] * slip[1] + REST).sqrt()
        } else {
            slip[0]
        };
        let developed = pulley.friction.develop(
            Slip {
                velocity: speed,
                displacement: zero,
            },
            normal_force.abs(),
        );
        let [f, rise, by_normal] = [
            touching * developed.force,
            touching * developed.by_velocity,
            touching * developed.by_normal * sign,
        ];
        let (friction, friction_by_slip, friction_by_normal) = if both {
            let per_speed = speed.recip();
            let u = [slip[0] * per_speed, slip[1] * per_speed];
            let secant = f * per_speed;
            let excess = rise - secant;
            (
                [-(f * u[0]), -(f * u[1])],
                [
                    [-(secant + excess * u[0] * u[0]), -(excess * u[0] * u[1])],
                    [-(excess * u[0] * u[1]), -(secant + excess * u[1] * u[1])],
                ],
                [-(by_normal * u[0]), -(by_normal * u[1])],
            )
        } else {
            (
                [-f, zero],
                [[-rise, zero], [zero, zero]],
                [-by_normal, zero],
            )
        };
        Self {
            penetration,
            rate,
            along,
            distance,
            normal: n,
            around: t,
            normal_force,
            friction,
            slip,
            rise,
            v,
            speed: meeting.speed,
            lever,
            slope,
            meridian,
            by_penetration: pushing * penalty.stiffness,
            by_rate: pushing * penalty.damping,
            friction_by_slip,
            friction_by_normal,
        }
    }

    /// Force per area on the belt, in the base `n, t, p`.
    #[inline(always)]
    fn local_force(&self) -> [S; 3] {
        let [ft, fa] = self.friction;
        let unit = self.meridian.unit;
        [
            (self.normal_force + self.slope * fa) * unit,
            ft,
            (fa - self.slope * self.normal_force) * unit,
        ]
    }

    /// Force per area on the belt.
    #[inline(always)]
    pub fn force(&self, pulley: &SurfacePulley) -> [S; 3] {
        combine(self.local_force(), self.normal, self.around, pulley.axis)
    }

    /// Torque per area on the pulley about its axis.
    #[inline(always)]
    pub fn torque(&self) -> S {
        -(self.distance * self.friction[0])
    }

    /// Power per area that friction takes [W/m²].
    #[inline(always)]
    pub fn friction_loss(&self) -> S {
        let [ft, fa] = self.friction;
        -(ft * (self.v[1] - self.distance * self.speed) + fa * self.slip[1])
    }

    /// `-(gq d/dr + gv d/dv)` of force and torque, and the same by the speed of the pulley.
    #[inline(always)]
    pub fn tangent(&self, pulley: &SurfacePulley, gq: f64, gv: f64) -> SurfaceTangent<S> {
        let zero = S::zero();
        let [vn, vt, vp] = self.v;
        let Meridian {
            curvature,
            unit,
            lever_part,
            ..
        } = self.meridian;
        let slope = self.slope * unit;
        let bend = -curvature * unit;
        let turn = self.distance.recip() * gq;
        let m = [S::constant(unit), zero, -slope];
        let a = [slope, zero, S::constant(unit)];
        let (fn_, [ft, fa]) = (self.normal_force, self.friction);
        // Gradients by position and velocity, combined.
        let normal_by = [
            -(m[0] * (self.by_penetration * gq + self.by_rate * gv)),
            -(self.by_rate * vt * turn * unit),
            -(m[2] * (self.by_penetration * gq + self.by_rate * gv))
                + self.by_rate * vp * (bend * gq),
        ];
        let slip_by = [
            [
                -(self.speed * ((1.0 - lever_part) * gq)),
                -(vn * turn) + gv,
                -(self.speed * self.slope * (lever_part * gq)),
            ],
            [a[0] * gv, slope * vt * turn, a[2] * gv + vn * (bend * gq)],
        ];
        let mut friction_by = [[zero; 3]; 2];
        for direction in 0..2 {
            for k in 0..3 {
                friction_by[direction][k] = self.friction_by_normal[direction] * normal_by[k]
                    + self.friction_by_slip[direction][0] * slip_by[0][k]
                    + self.friction_by_slip[direction][1] * slip_by[1][k];
            }
        }
        // Rows n, t, p of the derivative of the force.
        let mut rows = [[zero; 3]; 3];
        for k in 0..3 {
            rows[0][k] = normal_by[k] * unit + slope * friction_by[1][k];
            rows[1][k] = friction_by[0][k];
            rows[2][k] = friction_by[1][k] * unit - slope * normal_by[k];
        }
        rows[1][1] += (fn_ * unit + fa * slope) * turn;
        rows[2][2] -= fn_ * (bend * gq);
        rows[0][1] -= ft * turn;
        rows[0][2] += fa * (bend * gq);
        let (n, t, p) = (self.normal, self.around, pulley.axis);
        let columns = [
            combine(rows[0], n, t, p),
            combine(rows[1], n, t, p),
            combine(rows[2], n, t, p),
        ];
        let mut force = [zero; 9];
        for i in 0..3 {
            for j in 0..3 {
                force[3 * i + j] =
                    -(n[i] * columns[0][j] + t[i] * columns[1][j] + columns[2][j] * p[i]);
            }
        }
        // torque = -rho f_t
        let torque = [
            ft * gq + self.distance * friction_by[0][0],
            self.distance * friction_by[0][1],
            self.distance * friction_by[0][2],
        ];
        let by_speed = -(self.lever * gv);
        let by_pulley = [
            self.friction_by_slip[0][0] * by_speed,
            self.friction_by_slip[1][0] * by_speed,
        ];
        SurfaceTangent {
            force,
            force_by_pulley: combine(
                [
                    -(slope * by_pulley[1]),
                    -by_pulley[0],
                    -(by_pulley[1] * unit),
                ],
                n,
                t,
                p,
            ),
            torque: combine(torque, n, t, p),
            torque_by_pulley: self.distance * by_pulley[0],
        }
    }
}
