//! Contact at one point of the belt: forces, torque, losses and their derivatives.

use ancf::scalar::Scalar;

use super::{ContactPulley, Penalty};
use crate::friction::{FrictionLaw, Slip};

/// Motion of a point of the belt and of the pulley it faces.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Meeting<S> {
    /// Position r of the belt's point [m].
    pub r: [S; 2],
    /// Its velocity r' against the pulley's centre [m/s].
    pub v: [S; 2],
    /// The pulley's centre O [m].
    pub center: [f64; 2],
    /// Speed of the pulley [rad/s].
    pub speed: f64,
    /// Outward unit vector to the place on the pulley where the point's bristle stands, turned with the
    /// pulley; zero for a point without one, `None` for laws without memory.
    pub anchor: Option<[S; 2]>,
}

/// What happens at one point of the belt in contact (all zero outside).
#[derive(Clone, Copy, Debug)]
pub struct PointContact<S> {
    /// Penetration d [m], negative outside.
    pub penetration: S,
    /// Its rate d' [m/s].
    pub rate: S,
    /// Outward unit normal n.
    pub normal: [S; 2],
    /// Normal force per length f_n [N/m], positive pushes outwards.
    pub normal_force: S,
    /// Friction force per length f_t [N/m] on the belt, positive counter-clockwise.
    pub friction_force: S,
    /// Slip velocity v_t [m/s].
    pub slip: S,
    /// Belt velocity in the direction t [m/s].
    pub tangential_velocity: S,
    /// Elastic displacement z [m] of laws with memory.
    pub displacement: S,
    // For the derivatives.
    by_penetration: S,
    by_rate: S,
    friction_by_slip: S,
    friction_by_normal: S,
    /// df_t/dz times dz per angle of the point about the pulley [N/m].
    friction_by_turn: S,
    inverse_distance: S,
    /// Lever of the pulley's speed in the slip [m], and how fast the slip grows with the penetration [1/s].
    slip_lever: S,
    slip_by_penetration: f64,
}

impl<S: Scalar> PointContact<S> {
    /// The contact of a point with a pulley.
    #[inline(always)]
    pub(crate) fn new(penalty: &Penalty, pulley: &ContactPulley, meeting: &Meeting<S>) -> Self {
        let Meeting {
            r,
            v,
            center,
            speed,
            anchor,
        } = *meeting;
        let arm = [r[0] - center[0], r[1] - center[1]];
        let distance = (arm[0] * arm[0] + arm[1] * arm[1]).sqrt();
        let inverse_distance = distance.recip();
        let n = [arm[0] * inverse_distance, arm[1] * inverse_distance];
        let penetration = -distance + pulley.radius;
        let rate = -(n[0] * v[0] + n[1] * v[1]);
        let tangential_velocity = n[0] * v[1] - n[1] * v[0];
        let slip_lever = penetration * (penalty.slip_lever_part - 1.0) + pulley.radius;
        let slip = tangential_velocity - slip_lever * speed;
        let zero = S::zero();
        // z = R sin(angle from the anchor to n), dz/d angle = R cos
        let (displacement, per_angle) = match anchor {
            None => (zero, zero),
            Some(a) => (
                (a[0] * n[1] - a[1] * n[0]) * pulley.radius,
                (a[0] * n[0] + a[1] * n[1]) * pulley.radius,
            ),
        };
        let force = penetration * penalty.stiffness + rate * penalty.damping;
        // One where the point touches, one where its normal force acts; zero elsewhere.
        let touching = penetration.select_positive(S::constant(1.0), zero);
        let pushing = if penalty.clamp {
            force.select_positive(touching, zero)
        } else {
            touching
        };
        let normal_force = pushing * force;
        let developed = pulley.friction.develop(
            Slip {
                velocity: slip,
                displacement,
            },
            normal_force.abs(),
        );
        let sign = normal_force.select_positive(S::constant(1.0), S::constant(-1.0));
        Self {
            penetration,
            rate,
            normal: n,
            normal_force,
            friction_force: -(touching * developed.force),
            slip,
            tangential_velocity,
            displacement,
            by_penetration: pushing * penalty.stiffness,
            by_rate: pushing * penalty.damping,
            friction_by_slip: -(touching * developed.by_velocity),
            friction_by_normal: -(touching * developed.by_normal) * sign,
            friction_by_turn: -(touching * developed.by_displacement) * per_angle,
            inverse_distance,
            slip_lever,
            slip_by_penetration: speed * (1.0 - penalty.slip_lever_part),
        }
    }

    /// Whether friction is exhausted: more slip does not raise it.
    pub fn slides(&self) -> bool
    where
        S: PartialEq,
    {
        let zero = S::zero();
        self.friction_force != zero
            && self.friction_by_slip == zero
            && self.friction_by_turn == zero
    }

    /// Force per length on the belt.
    #[inline(always)]
    pub fn force(&self) -> [S; 2] {
        let ([n0, n1], fn_, ft) = (self.normal, self.normal_force, self.friction_force);
        [fn_ * n0 - ft * n1, fn_ * n1 + ft * n0]
    }

    /// Torque per length on the pulley of the given radius.
    #[inline(always)]
    pub fn torque(&self, radius: f64) -> S {
        -((-self.penetration + radius) * self.friction_force)
    }

    /// Power per length that friction takes [W/m]; what bristles store counts until they let go.
    #[inline(always)]
    pub fn friction_loss(&self, radius: f64, speed: f64) -> S {
        -(self.friction_force * (self.tangential_velocity - (-self.penetration + radius) * speed))
    }

    /// `-(gq d/dr + gv d/dv)` of force and torque, and the same by angle and speed of the pulley.
    #[inline(always)]
    pub(crate) fn tangent(&self, radius: f64, gq: f64, gv: f64) -> PointTangent<S> {
        let n = self.normal;
        let t = [-n[1], n[0]];
        let (fn_, ft) = (self.normal_force, self.friction_force);
        let per = self.inverse_distance;
        let radial_velocity = -self.rate;
        // gradients by (r, v) combined: gq d/dr + gv d/dv, split into parts along n and t
        let d_n = S::constant(-gq);
        let rate_n = S::constant(-gv);
        let rate_t = -(self.tangential_velocity * per) * gq;
        let slip_t = -(radial_velocity * per) * gq + gv;
        let turn = per * gq;
        let fn_n = self.by_penetration * d_n + self.by_rate * rate_n;
        let fn_t = self.by_rate * rate_t;
        let slip_n = d_n * self.slip_by_penetration;
        let ft_n = self.friction_by_normal * fn_n + self.friction_by_slip * slip_n;
        let ft_t = self.friction_by_normal * fn_t
            + self.friction_by_slip * slip_t
            + self.friction_by_turn * turn;
        // f = fn n + ft t; dn = t (t.dr)/rho, dt = -n (t.dr)/rho
        let nn = fn_n;
        let nt = fn_t - ft * turn;
        let tn = ft_n;
        let tt = ft_t + fn_ * turn;
        // sum over a, b in {n, t} of coefficient(a, b) a_i b_j
        let by_n = [nn * n[0] + nt * t[0], nn * n[1] + nt * t[1]];
        let by_t = [tn * n[0] + tt * t[0], tn * n[1] + tt * t[1]];
        let lever = -self.penetration + radius;
        // torque = -(R - d) ft
        let torque_n = ft * d_n - lever * ft_n;
        let torque_t = -(lever * ft_t);
        let ft_by_pulley =
            -(self.friction_by_slip * self.slip_lever * gv) - self.friction_by_turn * gq;
        PointTangent {
            force: [
                -(n[0] * by_n[0] + t[0] * by_t[0]),
                -(n[0] * by_n[1] + t[0] * by_t[1]),
                -(n[1] * by_n[0] + t[1] * by_t[0]),
                -(n[1] * by_n[1] + t[1] * by_t[1]),
            ],
            force_by_pulley: [-(t[0] * ft_by_pulley), -(t[1] * ft_by_pulley)],
            torque: [
                -(torque_n * n[0] + torque_t * t[0]),
                -(torque_n * n[1] + torque_t * t[1]),
            ],
            torque_by_pulley: lever * ft_by_pulley,
        }
    }
}

/// Derivatives of [`PointContact`], signs and factors as the effective matrix wants them.
pub(crate) struct PointTangent<S> {
    /// By the position (times `gq`) and velocity (times `gv`) of the point, row-major 2 x 2.
    pub force: [S; 4],
    /// By angle and speed of the pulley.
    pub force_by_pulley: [S; 2],
    /// Of the torque on the pulley, by position and velocity.
    pub torque: [S; 2],
    /// The same by angle and speed of the pulley.
    pub torque_by_pulley: S,
}
