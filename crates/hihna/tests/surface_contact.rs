//! The contact of a belt of plates (Kerkkänen 2006, 4.43-4.45) against its derivatives and balances.
//!
//! The state is a wobbling loop of six plates, two across, around a tilted and crowned pulley that moves, pushed
//! by a second, tapered one from outside, so that points lie in and out of contact, stick, slip and pull.

use std::f64::consts::TAU;
use std::num::NonZeroUsize;

use ancf::element::{BendingRigidity, Element, ThinPlate};
use ancf::linear::{BorderedMatrix, Structure};
use ancf::material::Isotropic;
use ancf::mesh::Mesh;
use ancf::quadrature::Rule;
use ancf::system::{ForceLaw, State};
use hihna::contact::surface::{SurfaceContact, SurfacePulley};
use hihna::contact::{Penalty, PulleyContact};
use hihna::drive::{Displacement, FrictionDirections};
use hihna::friction::{CreepRate, Law};
use hihna::profile::{Profile, Varying};

const ALONG: usize = 6;
const ACROSS: usize = 2;
const BLOCK: usize = (ACROSS + 1) * ThinPlate::NODE_DOF;
const CHAIN: usize = ALONG * BLOCK;
const PULLEYS: usize = 2;
const SIZE: usize = CHAIN + PULLEYS;
const RADIUS: f64 = 0.08;
const WIDTH: f64 = 0.04;
const TIME: f64 = 0.3;

fn contact(directions: FrictionDirections, clamp: bool) -> SurfaceContact {
    let plate = ThinPlate::new(
        TAU * RADIUS / ALONG as f64,
        WIDTH / ACROSS as f64,
        0.003,
        &Isotropic {
            youngs_modulus: 1.0e7,
            poisson_ratio: 0.3,
            density: 1000.0,
        },
        BendingRigidity::None,
    );
    let ramp = |to: f64| {
        Profile::Varying(Varying::Ramp {
            from: 0.0,
            to,
            start: 0.0,
            end: 1.0,
        })
    };
    let pulley = |center, radius, axis, slope, curvature, torque, displacement| SurfacePulley {
        center,
        displacement,
        axis,
        radius,
        slope,
        curvature,
        groove: None,
        friction: Law::CreepRate(CreepRate {
            coefficient: 0.7,
            slope: 2.0e5,
        }),
        external: Profile::Constant(torque).into(),
    };
    let (s, c) = 0.05_f64.sin_cos();
    let moving = Displacement {
        x: ramp(2.0e-3),
        y: ramp(-1.0e-3),
        z: ramp(4.0e-3),
    };
    let pulleys = vec![
        pulley([0.0; 3], RADIUS, [0.0, -s, c], 0.01, 0.8, 0.0, Some(moving)),
        pulley(
            [RADIUS + 0.047, 0.01, 0.002],
            0.05,
            [s, 0.0, c],
            -0.05,
            0.0,
            -0.7,
            None,
        ),
    ];
    SurfaceContact::new(
        &Mesh::closed_strip(vec![plate; ALONG * ACROSS], ACROSS),
        pulleys,
        Penalty {
            stiffness: 1.0e9,
            damping: 1.0e6,
            clamp,
            // Both places of slip, one with each.
            slip_lever_part: if clamp { 0.0 } else { 1.0 },
        },
        directions,
        Rule::trapezoidal(NonZeroUsize::new(5).expect("five")),
    )
}

/// Coordinates and velocities: a wobbling tube whose slip and radial velocity change sign.
fn wobbling_loop() -> (Vec<f64>, Vec<f64>) {
    let (mut q, mut v) = (vec![0.0; SIZE], vec![0.0; SIZE]);
    for i in 0..ALONG {
        for j in 0..=ACROSS {
            let angle = TAU * i as f64 / ALONG as f64;
            let (s, c) = angle.sin_cos();
            let z = WIDTH * (j as f64 / ACROSS as f64 - 0.5);
            let radius = RADIUS * (1.0 - 0.004 - 0.008 * (3.0 * angle + 3.3 + 20.0 * z).cos());
            let tangential = 0.8 + 0.3 * (2.0 * angle + 0.3 + 30.0 * z).sin();
            let radial = 0.5 * (3.0 * angle + 1.0 + 10.0 * z).cos();
            let at = i * BLOCK + j * ThinPlate::NODE_DOF;
            q[at..at + 9].copy_from_slice(&[
                radius * c,
                radius * s,
                z + 0.001 * (angle + z).sin(),
                -1.02 * s + 0.01 * c,
                1.02 * c + 0.01 * s,
                0.02,
                0.01 * c,
                0.01 * s,
                0.99,
            ]);
            v[at..at + 9].copy_from_slice(&[
                radial * c - tangential * s,
                radial * s + tangential * c,
                0.25 * (2.0 * angle + 1.0).sin(),
                -10.0 * c + 0.5 * s,
                -10.0 * s - 0.3 * c,
                0.4,
                0.2 * s,
                -0.2 * c,
                0.1,
            ]);
        }
    }
    q[CHAIN..].copy_from_slice(&[0.3, -0.2]);
    v[CHAIN..].copy_from_slice(&[10.0, -14.0]);
    (q, v)
}

fn at<'a>(q: &'a [f64], v: &'a [f64]) -> State<'a> {
    State { time: TIME, q, v }
}

fn force(law: &mut SurfaceContact, q: &[f64], v: &[f64]) -> Vec<f64> {
    let mut force = vec![0.0; SIZE];
    law.add_force(at(q, v), &mut force);
    force
}

/// Points that stick, slip and pull on the first pulley they touch, and the area on each pulley.
fn regimes(law: &SurfaceContact, q: &[f64], v: &[f64]) -> ([usize; 3], [f64; PULLEYS]) {
    let [mut stick, mut slip, mut pull] = [0; 3];
    for element in 0..ALONG * ACROSS {
        for k in 0..25 {
            let Some(touch) = law.touch(at(q, v), element, [k / 5, k % 5]) else {
                continue;
            };
            assert!(
                touch.penetration > 1.0e-7,
                "a point within reach of the surface"
            );
            pull += usize::from(touch.normal_force < 0.0);
            slip += usize::from(touch.slides);
            stick += usize::from(!touch.slides);
        }
    }
    let mut totals = [PulleyContact::default(); PULLEYS];
    law.resultants(at(q, v), &mut totals);
    ([stick, slip, pull], totals.map(|total| total.length))
}

/// Kind of a coordinate: position, slope, angle of a pulley.
fn kind(coordinate: usize) -> usize {
    if coordinate >= CHAIN {
        2
    } else {
        usize::from(coordinate % ThinPlate::NODE_DOF >= 3)
    }
}

/// Every entry of `gq K + gv C` against the central difference along `(gq, gv)`. Positions step by 1e-8 m, far
/// less than the depth of any point: truncation is 1e-12 of the curvature of the surface, rounding
/// 1e-16 of a coordinate over the step, 1e-8 of the stiffness; in the velocities disc friction bends over slips of
/// 0.1 m/s, of which the step is 1e-5. Entries are held to 1e-6 of the largest of their kind.
#[test]
fn every_entry_of_the_tangent() {
    for directions in [
        FrictionDirections::Circumferential,
        FrictionDirections::Both,
    ] {
        for clamp in [false, true] {
            check_every_entry(directions, clamp);
        }
    }
}

fn check_every_entry(directions: FrictionDirections, clamp: bool) {
    let mut law = contact(directions, clamp);
    let (q, v) = wobbling_loop();
    let ([stick, slip, pull], touched) = regimes(&law, &q, &v);
    assert!(
        stick > 5 && slip > 5 && (pull > 5 || clamp) && touched.iter().all(|area| *area > 1.0e-4),
        "{stick} points stick, {slip} slip, {pull} pull; {touched:?} m2 on the pulleys"
    );
    let structure = Structure {
        sections: ALONG,
        block: BLOCK,
        closed: true,
        border: PULLEYS,
    };
    for (gq, gv, h) in [(1.0, 0.0, 1.0e-8), (0.0, 1.0, 1.0e-6), (0.01, 1.0, 1.0e-6)] {
        let mut matrix = BorderedMatrix::new(structure);
        law.add_tangent(at(&q, &v), gq, gv, &mut matrix);
        let mut analytic = vec![vec![0.0; SIZE]; SIZE];
        for (row, column, value) in matrix.triplets() {
            analytic[row][column] += value;
        }
        let mut numeric = vec![vec![0.0; SIZE]; SIZE];
        for column in 0..SIZE {
            let mut shifted = |sign: f64| {
                let (mut q, mut v) = (q.clone(), v.clone());
                q[column] += sign * h * gq;
                v[column] += sign * h * gv;
                force(&mut law, &q, &v)
            };
            let (plus, minus) = (shifted(1.0), shifted(-1.0));
            for row in 0..SIZE {
                numeric[row][column] = -(plus[row] - minus[row]) / (2.0 * h);
            }
        }
        let mut scale = [[0.0_f64; 3]; 3];
        for row in 0..SIZE {
            for column in 0..SIZE {
                let largest = &mut scale[kind(row)][kind(column)];
                *largest = largest.max(numeric[row][column].abs());
            }
        }
        for row in 0..SIZE {
            for column in 0..SIZE {
                let (a, n) = (analytic[row][column], numeric[row][column]);
                let scale = scale[kind(row)][kind(column)];
                assert!(
                    (a - n).abs() <= 1.0e-6 * scale,
                    "({gq}, {gv}), {directions:?}, clamp {clamp}: entry ({row}, {column}) is {a}, \
                     difference {n}, scale {scale}"
                );
            }
        }
        // The border is not checked by zeros: force and torque by speed, torque by position.
        if gv > 0.0 {
            assert!(scale[0][2] > 0.0 && scale[2][2] > 0.0 && scale[2][0] > 0.0);
        }
    }
}

/// Forces on belt and hubs cancel; so do their moments about the origin, where the pulleys' are those about their
/// centres and the part along the axis is the torque. Identities of sums of some hundred terms: 1e-12.
#[test]
fn forces_and_moments_of_belt_and_pulleys_cancel() {
    let mut law = contact(FrictionDirections::Both, false);
    let (q, v) = wobbling_loop();
    let mut totals = [PulleyContact::default(); PULLEYS];
    law.resultants(at(&q, &v), &mut totals);
    let forces = force(&mut law, &q, &v);
    let cross = |a: &[f64], b: &[f64]| {
        [
            a[1] * b[2] - a[2] * b[1],
            a[2] * b[0] - a[0] * b[2],
            a[0] * b[1] - a[1] * b[0],
        ]
    };
    let (mut force_sum, mut moment_sum, mut scale) = ([0.0; 3], [0.0; 3], 0.0);
    for (k, vector) in forces[..CHAIN].chunks_exact(3).enumerate() {
        let moment = cross(&q[3 * k..3 * k + 3], vector);
        for axis in 0..3 {
            if k % 3 == 0 {
                force_sum[axis] += vector[axis];
                scale += vector[axis].abs();
            }
            moment_sum[axis] += moment[axis];
        }
    }
    for (p, (total, pulley)) in totals.iter().zip(&law.pulleys).enumerate() {
        let hub = [
            total.hub_force[0],
            total.hub_force[1],
            total.lateral.hub_force,
        ];
        let [center, _] = pulley.hub(TIME);
        let arm = cross(&center, &hub);
        for axis in 0..3 {
            force_sum[axis] += hub[axis];
            moment_sum[axis] += arm[axis] + total.lateral.hub_moment[axis];
        }
        let moment = total.lateral.hub_moment;
        let about_the_axis: f64 = (0..3).map(|i| moment[i] * pulley.axis[i]).sum();
        assert!((about_the_axis - total.torque).abs() <= 1.0e-12 * scale);
        let external = pulley.external.value(TIME, 0.0);
        assert!((forces[CHAIN + p] - external - total.torque).abs() <= 1.0e-12 * scale);
    }
    for axis in 0..3 {
        assert!(force_sum[axis].abs() <= 1.0e-12 * scale, "{force_sum:?}");
        assert!(moment_sum[axis].abs() <= 1.0e-12 * scale, "{moment_sum:?}");
    }
}

/// Power of the contact forces on belt, pulleys and moving hubs = -(friction + damping losses) - rate of the stored
/// energy; the rate by a central difference along the motion over 1e-7 s: truncation and rounding 1e-9,
/// held to 1e-7.
#[test]
fn power_of_the_contact_is_accounted_for() {
    for directions in [
        FrictionDirections::Circumferential,
        FrictionDirections::Both,
    ] {
        let mut law = contact(directions, false);
        let (q, v) = wobbling_loop();
        let mut totals = [PulleyContact::default(); PULLEYS];
        law.resultants(at(&q, &v), &mut totals);
        let losses: f64 = totals
            .iter()
            .map(|t| t.friction_loss + t.contact_loss)
            .sum();
        let hubs: f64 = totals
            .iter()
            .zip(&law.pulleys)
            .map(|(total, pulley)| {
                let [_, velocity] = pulley.hub(TIME);
                total.hub_force[0] * velocity[0]
                    + total.hub_force[1] * velocity[1]
                    + total.lateral.hub_force * velocity[2]
            })
            .sum();
        assert!(hubs.abs() > 0.1, "the moving hub does work");
        let external = -0.7 * v[CHAIN + 1];
        let forces = force(&mut law, &q, &v);
        let power: f64 = forces.iter().zip(&v).map(|(f, v)| f * v).sum::<f64>() - external + hubs;
        let h = 1.0e-7;
        let mut stored = |sign: f64| {
            let moved: Vec<f64> = q.iter().zip(&v).map(|(q, v)| q + sign * h * v).collect();
            let state = State {
                time: TIME + sign * h,
                q: &moved,
                v: &v,
            };
            law.resultants(state, &mut totals);
            totals.iter().map(|t| t.stored_energy).sum::<f64>()
        };
        let rate = (stored(1.0) - stored(-1.0)) / (2.0 * h);
        assert!(
            (power + losses + rate).abs() <= 1.0e-7 * (power.abs() + losses.abs() + rate.abs()),
            "{directions:?}: power {power}, losses {losses}, rate of storage {rate}"
        );
    }
}
