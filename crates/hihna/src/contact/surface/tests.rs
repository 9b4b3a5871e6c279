//! The contact at one point of a surface: derivatives against dual numbers, on a tilted, tapered and crowned
//! pulley and on the walls of its groove.

use num_dual::Dual64;
use proptest::prelude::*;

use super::meridian::Flank;
use super::*;
use crate::friction::{Coulomb, CreepRate, Stribeck};
use crate::profile::Profile;
use ancf::scalar::Scalar;

const LAWS: [Law; 3] = [
    Law::CreepRate(CreepRate {
        coefficient: 0.6,
        slope: 2.0e4,
    }),
    Law::Coulomb(Coulomb {
        coefficient: 0.4,
        velocity: 0.3,
    }),
    Law::Stribeck(Stribeck {
        static_coefficient: 0.9,
        sliding_coefficient: 0.3,
        stribeck_velocity: 0.5,
        velocity: 0.2,
    }),
];

fn pulley(friction: Law, tilt: [f64; 2], slope: f64, curvature: f64) -> SurfacePulley {
    let [(sx, cx), (sy, cy)] = tilt.map(f64::sin_cos);
    SurfacePulley {
        center: [0.0; 3],
        displacement: None,
        axis: [sy * cx, -sx, cy * cx],
        radius: 0.1,
        slope,
        curvature,
        groove: Some(Groove::new(0.02, 0.3)),
        friction,
        external: Profile::Constant(0.0).into(),
    }
}

const SIDES: [Side; 3] = [
    Side::Face,
    Side::Flank(Flank::Lower),
    Side::Flank(Flank::Upper),
];

/// The point `x` moved along the axis to the wall of the groove, if that is its side: up to 0.8 mm beside the pitch
/// line, 2.6 mm of radius.
fn beside(side: Side, mut x: [f64; 7]) -> [f64; 7] {
    if let Side::Flank(flank) = side {
        x[2] = flank.sign() * 0.01 + 0.02 * x[2];
    }
    x
}

/// Force (3) and torque of the point whose position, velocity and pulley speed are `x`.
fn answer<S: Scalar>(
    (pulley, side): (&SurfacePulley, Side),
    directions: FrictionDirections,
    clamp: bool,
    x: [S; 7],
) -> [S; 4] {
    let penalty = Penalty {
        stiffness: 1.0e7,
        damping: 3.0e4,
        clamp,
        // Both places of slip, one with each.
        slip_lever_part: if clamp { 0.0 } else { 1.0 },
    };
    let meeting = Meeting {
        arm: [x[0], x[1], x[2]],
        v: [x[3], x[4], x[5]],
        speed: x[6],
    };
    let at = SurfacePoint::new(
        &penalty,
        (pulley, pulley.meridian(side, penalty.slip_lever_part)),
        directions,
        &meeting,
    );
    let [fx, fy, fz] = at.force(pulley);
    [fx, fy, fz, at.torque()]
}

/// Force and torque by all seven arguments, as `SurfacePoint::tangent` gives them.
fn analytic(
    (pulley, side): (&SurfacePulley, Side),
    directions: FrictionDirections,
    clamp: bool,
    x: [f64; 7],
) -> [[f64; 7]; 4] {
    let penalty = Penalty {
        stiffness: 1.0e7,
        damping: 3.0e4,
        clamp,
        // Both places of slip, one with each.
        slip_lever_part: if clamp { 0.0 } else { 1.0 },
    };
    let meeting = Meeting {
        arm: [x[0], x[1], x[2]],
        v: [x[3], x[4], x[5]],
        speed: x[6],
    };
    let at = SurfacePoint::new(
        &penalty,
        (pulley, pulley.meridian(side, penalty.slip_lever_part)),
        directions,
        &meeting,
    );
    let mut out = [[0.0; 7]; 4];
    for (first, gq, gv) in [(0, 1.0, 0.0), (3, 0.0, 1.0)] {
        let tangent = at.tangent(pulley, gq, gv);
        for j in 0..3 {
            for i in 0..3 {
                out[i][first + j] = -tangent.force[3 * i + j];
            }
            out[3][first + j] = -tangent.torque[j];
        }
        for i in 0..3 {
            out[i][6] -= tangent.force_by_pulley[i];
        }
        out[3][6] -= tangent.torque_by_pulley;
    }
    out
}

fn directions() -> impl Strategy<Value = FrictionDirections> {
    prop_oneof![
        Just(FrictionDirections::Circumferential),
        Just(FrictionDirections::Both)
    ]
}

prop_compose! {
    /// Points up to 5 mm inside to 1 mm outside of the surface, slipping up to 1 m/s in any direction.
    fn points()(
        angle in 0.0..6.3, along in -0.04..0.04, depth in -1.0e-3..5.0e-3,
        v in prop::array::uniform3(-0.6..0.6_f64), speed in -12.0..12.0_f64,
    ) -> [f64; 7] {
        let radius = 0.1 - depth;
        let around = 0.1 * speed;
        let (s, c) = f64::sin_cos(angle);
        [
            radius * c, radius * s, along,
            v[0] - around * s, v[1] + around * c, v[2], speed,
        ]
    }
}

proptest! {
    /// Exact derivatives of the formulas as coded: round-off of some hundred operations whose terms are up to a
    /// thousand times their sum, so 1e-10 of the largest entry of a row.
    #[test]
    fn tangent_is_the_derivative(
        x in points(), law in 0..3_usize, side in 0..3_usize, directions in directions(), clamp in any::<bool>(),
        tilt in prop::array::uniform2(-0.3..0.3_f64), slope in -0.2..0.2_f64, curvature in -2.0..2.0_f64,
    ) {
        let pulley = pulley(LAWS[law].clone(), tilt, slope, curvature);
        let (side, x) = (SIDES[side], beside(SIDES[side], x));
        let found = analytic((&pulley, side), directions, clamp, x);
        let mut expected = [[0.0; 7]; 4];
        for column in 0..7 {
            let seeded = std::array::from_fn(|i| {
                Dual64::new(x[i], f64::from(u8::from(i == column)))
            });
            let values = answer((&pulley, side), directions, clamp, seeded);
            for row in 0..4 {
                expected[row][column] = values[row].eps;
            }
        }
        for row in 0..4 {
            for (first, count) in [(0, 3), (3, 3), (6, 1)] {
                let range = first..first + count;
                let scale = expected[row][range.clone()].iter().fold(1.0, |m: f64, d| m.max(d.abs()));
                for column in range {
                    let difference = found[row][column] - expected[row][column];
                    prop_assert!(
                        difference.abs() <= 1.0e-10 * scale,
                        "entry ({row}, {column}): {} and {}", found[row][column], expected[row][column]
                    );
                }
            }
        }
    }

    /// Turning belt and pulley together turns the force and leaves the torque.
    #[test]
    fn rigid_rotation_changes_nothing(
        x in points(), law in 0..3_usize, side in 0..3_usize, directions in directions(),
        tilt in prop::array::uniform2(-0.3..0.3_f64), slope in -0.2..0.2_f64, curvature in -2.0..2.0_f64,
    ) {
        let (side, x) = (SIDES[side], beside(SIDES[side], x));
        let aligned = pulley(LAWS[law].clone(), [0.0; 2], slope, curvature);
        let tilted = pulley(LAWS[law].clone(), tilt, slope, curvature);
        let [(sx, cx), (sy, cy)] = tilt.map(f64::sin_cos);
        // About x, then about y.
        let turn = |a: [f64; 3]| {
            let [x, y, z] = [a[0], cx * a[1] - sx * a[2], sx * a[1] + cx * a[2]];
            [cy * x + sy * z, y, cy * z - sy * x]
        };
        let (r, v) = (turn([x[0], x[1], x[2]]), turn([x[3], x[4], x[5]]));
        let turned = [r[0], r[1], r[2], v[0], v[1], v[2], x[6]];
        let [fx, fy, fz, torque] = answer((&aligned, side), directions, false, x);
        let expected = turn([fx, fy, fz]);
        let found = answer((&tilted, side), directions, false, turned);
        let scale = 1.0e-10 * (fx.abs() + fy.abs() + fz.abs()).max(1.0);
        for axis in 0..3 {
            prop_assert!((found[axis] - expected[axis]).abs() <= scale);
        }
        prop_assert!((found[3] - torque).abs() <= scale);
    }

    /// Friction of both directions opposes the slip and never exceeds what the law gives for its magnitude:
    /// Coulomb's disc.
    #[test]
    fn friction_stays_in_the_disc(x in points(), speed in -12.0..12.0_f64) {
        let pulley = pulley(LAWS[0].clone(), [0.0; 2], 0.0, 0.0);
        let penalty = Penalty { stiffness: 1.0e7, damping: 0.0, clamp: false, slip_lever_part: 1.0 };
        let meeting = Meeting { arm: [x[0], x[1], x[2]], v: [x[3], x[4], x[5]], speed };
        let at = {
            let surface = (&pulley, pulley.meridian(Side::Face, 1.0));
            SurfacePoint::new(&penalty, surface, FrictionDirections::Both, &meeting)
        };
        let [ft, fa] = at.friction;
        let magnitude = ft.hypot(fa);
        prop_assert!(magnitude <= 0.6 * at.normal_force.abs() * (1.0 + 1.0e-12));
        let along = ft * at.slip[0] + fa * at.slip[1];
        let slip = at.slip[0].hypot(at.slip[1]);
        prop_assert!((along + magnitude * slip).abs() <= 1.0e-12 * magnitude.max(1.0) * slip.max(1.0));
    }

    /// On a wall the depth is that at right angles to it, the normal force its potential's, and friction takes power
    /// at every slip: it acts between points in one place. Written out in the plane through the axis, with the wall's
    /// outward normal `(sine, -sign cosine)` in (n, p); rounding of some ten operations.
    #[test]
    fn walls_of_a_groove(
        radial in -2.0e-3..2.0e-3_f64, along in -1.0e-3..1.0e-3_f64, upper in any::<bool>(),
        v in prop::array::uniform3(-0.6..0.6_f64), speed in -12.0..12.0_f64,
    ) {
        let pulley = pulley(LAWS[0].clone(), [0.0; 2], 0.05, 0.3);
        let flank = if upper { Flank::Upper } else { Flank::Lower };
        let penalty = Penalty { stiffness: 1.0e7, damping: 0.0, clamp: false, slip_lever_part: 1.0 };
        let s = flank.sign() * 0.01 + along;
        let meeting = Meeting { arm: [0.1 + radial, 0.0, s], v, speed };
        let surface = (&pulley, pulley.meridian(Side::Flank(flank), 1.0));
        let at = SurfacePoint::new(&penalty, surface, FrictionDirections::Both, &meeting);
        let (sine, cosine) = 0.3_f64.sin_cos();
        let depth = flank.sign() * along * cosine - radial * sine;
        prop_assert!((at.penetration - depth).abs() < 1.0e-15);
        let frictionless = SurfacePulley {
            friction: Law::Frictionless(crate::friction::Frictionless),
            ..pulley.clone()
        };
        let surface = (&frictionless, frictionless.meridian(Side::Flank(flank), 1.0));
        let [fx, fy, fz] =
            SurfacePoint::new(&penalty, surface, FrictionDirections::Both, &meeting).force(&frictionless);
        let pressure = 1.0e7 * depth.max(0.0);
        prop_assert!((fx - pressure * sine).abs() < 1.0e-8 && fy == 0.0);
        prop_assert!((fz + flank.sign() * pressure * cosine).abs() < 1.0e-8);
        prop_assert!(at.friction_loss() >= 0.0);
    }
}
