//! The contact of belts of spatial beams against its derivatives and balances: flanks in a groove, the back on a
//! flat idler.
//!
//! The state is a wobbling loop of six beams around a tilted grooved pulley that moves, pushed by a tapered idler from
//! outside, so that points of both flanks and of the back lie in and out of contact, stick and slip.

use std::f64::consts::TAU;
use std::num::NonZeroUsize;

use ancf::element::{BeltBeam3, Element, LineElement, LinearBeam3};
use ancf::linear::{BorderedMatrix, Structure};
use ancf::material::Isotropic;
use ancf::mesh::Mesh;
use ancf::quadrature::Rule;
use ancf::section::Trapezoid;
use ancf::system::{ForceLaw, State};
use hihna::contact::surface::{Face, Groove, SurfaceContact, SurfacePulley};
use hihna::contact::{Penalty, PulleyContact};
use hihna::drive::{Displacement, FrictionDirections};
use hihna::friction::{CreepRate, Law};
use hihna::profile::{Profile, Varying};

const ALONG: usize = 6;
const PULLEYS: usize = 2;
const RADIUS: f64 = 0.08;
const HALF_ANGLE: f64 = 0.32;
const TIME: f64 = 0.3;

fn section() -> Trapezoid {
    Trapezoid::new(0.012, 0.009, HALF_ANGLE).expect("a section")
}

const RUBBER: Isotropic = Isotropic {
    youngs_modulus: 1.0e8,
    poisson_ratio: 0.3,
    density: 1000.0,
};

fn length() -> f64 {
    TAU * RADIUS / ALONG as f64
}

fn belt() -> BeltBeam3 {
    BeltBeam3::new(length(), &section().section(), &RUBBER, 1.0, 0.5)
}

fn linear() -> LinearBeam3 {
    LinearBeam3::new(length(), &section().section(), &RUBBER)
}

fn contact<E: LineElement>(
    element: &E,
    directions: FrictionDirections,
    clamp: bool,
) -> SurfaceContact {
    let ramp = |to: f64| {
        Profile::Varying(Varying::Ramp {
            from: 0.0,
            to,
            start: 0.0,
            end: 1.0,
        })
    };
    let friction = Law::CreepRate(CreepRate {
        coefficient: 0.7,
        slope: 2.0e6,
    });
    let (s, c) = 0.01_f64.sin_cos();
    let grooved = SurfacePulley {
        center: [0.0; 3],
        displacement: Some(Displacement {
            x: ramp(4.0e-4),
            y: ramp(-2.0e-4),
            z: ramp(8.0e-4),
        }),
        axis: [0.0, -s, c],
        radius: RADIUS,
        slope: 0.0,
        curvature: 0.0,
        groove: Some(Groove::new(0.012, HALF_ANGLE)),
        friction: friction.clone(),
        external: Profile::Constant(0.0).into(),
    };
    let idler = SurfacePulley {
        center: [RADIUS + 0.0505, 0.01, 0.002],
        displacement: None,
        axis: [s, 0.0, c],
        radius: 0.05,
        slope: -0.05,
        curvature: 0.5,
        groove: None,
        friction,
        external: Profile::Constant(-0.7).into(),
    };
    let across = Rule::gauss(NonZeroUsize::new(3).expect("three"));
    // The loop turns about the first counter-clockwise: its narrow side and +y point inwards.
    let trapezoid = section();
    let back = trapezoid.wide();
    SurfaceContact::of_beams(
        &Mesh::closed(vec![element.clone(); ALONG]),
        vec![
            (grooved, Face::flanks(&trapezoid, 1.0, &across)),
            (idler, Face::flat(back, trapezoid.width_at(back), &across)),
        ],
        Penalty {
            stiffness: 1.0e9,
            damping: 2.0e5,
            clamp,
            // Both places of slip, one with each.
            slip_lever_part: if clamp { 0.0 } else { 1.0 },
        },
        directions,
        Rule::gauss(NonZeroUsize::new(5).expect("five")),
    )
}

/// Coordinates and velocities: a wobbling, twisting loop whose slip and radial velocity change sign.
fn wobbling_loop<E: Element>() -> (Vec<f64>, Vec<f64>) {
    let chain = ALONG * E::NODE_DOF;
    let (mut q, mut v) = (vec![0.0; chain + PULLEYS], vec![0.0; chain + PULLEYS]);
    for i in 0..ALONG {
        let angle = TAU * i as f64 / ALONG as f64;
        let (s, c) = angle.sin_cos();
        let radius = RADIUS * (1.0 - 0.002 - 0.006 * (3.0 * angle + 3.3).cos());
        let tangential = 0.8 + 0.3 * (2.0 * angle + 0.3).sin();
        let radial = 0.3 * (3.0 * angle + 1.0).cos();
        let position = [radius * c, radius * s, 3.0e-4 * (angle + 0.4).sin()];
        let along = [-1.02 * s + 0.01 * c, 1.02 * c + 0.01 * s, 0.005];
        let height = [-c, -s, 0.02 * (2.0 * angle).cos()];
        let width = [0.02 * s, -0.015 * c, 0.99];
        let moving = [
            radial * c - tangential * s,
            radial * s + tangential * c,
            0.15 * (2.0 * angle + 1.0).sin(),
        ];
        let turning = [-10.0 * c + 0.5 * s, -10.0 * s - 0.3 * c, 0.4];
        let rolling = [10.0 * s + 0.2, -10.0 * c, 1.5];
        let swaying = [-0.4 * s, 2.0 * c, 0.1];
        let (places, rates) = if E::NODE_VECTORS == 4 {
            (
                vec![position, along, height, width],
                vec![moving, turning, rolling, swaying],
            )
        } else {
            (
                vec![position, height, width],
                vec![moving, rolling, swaying],
            )
        };
        let at = i * E::NODE_DOF;
        q[at..at + E::NODE_DOF].copy_from_slice(places.as_flattened());
        v[at..at + E::NODE_DOF].copy_from_slice(rates.as_flattened());
    }
    q[chain..].copy_from_slice(&[0.3, -0.2]);
    v[chain..].copy_from_slice(&[10.0, -14.0]);
    (q, v)
}

fn at<'a>(q: &'a [f64], v: &'a [f64]) -> State<'a> {
    State { time: TIME, q, v }
}

fn force(law: &mut SurfaceContact, q: &[f64], v: &[f64]) -> Vec<f64> {
    let mut force = vec![0.0; q.len()];
    law.add_force(at(q, v), &mut force);
    force
}

/// Points that touch by pulley, how many of them stick, and whether both flanks are among them.
fn regimes(law: &SurfaceContact, q: &[f64], v: &[f64]) -> ([usize; PULLEYS], usize, [bool; 2]) {
    let (mut touched, mut stick, mut flanks) = ([0; PULLEYS], 0, [false; 2]);
    for element in 0..ALONG {
        for p in 0..PULLEYS {
            for i in 0..law.rule().points.len() {
                for j in 0..law.across(p, element) {
                    let Some(touch) = law.touch_on(p, at(q, v), element, [i, j]) else {
                        continue;
                    };
                    assert!(touch.penetration > 2.0e-7, "not at the edge of contact");
                    touched[p] += 1;
                    stick += usize::from(!touch.slides);
                    if p == 0 {
                        flanks[usize::from(touch.along > 0.0)] = true;
                    }
                }
            }
        }
    }
    (touched, stick, flanks)
}

/// Kind of a coordinate: position, slope, angle of a pulley.
fn kind<E: Element>(coordinate: usize) -> usize {
    if coordinate >= ALONG * E::NODE_DOF {
        2
    } else {
        usize::from(coordinate % E::NODE_DOF >= 3)
    }
}

/// Every entry of `gq K + gv C` against the central difference along `(gq, gv)`. Positions step by 1e-8 m, far
/// less than the depth of any point: truncation is 1e-12 of the curvature of the surface, rounding 1e-16 of a
/// coordinate over the step, 1e-8 of the stiffness; in the velocities disc friction bends over slips of 0.1 m/s,
/// of which the step is 1e-5. Entries are held to 1e-6 of the largest of their kind.
fn check_every_entry<E: LineElement>(element: &E, directions: FrictionDirections, clamp: bool) {
    let mut law = contact(element, directions, clamp);
    let (q, v) = wobbling_loop::<E>();
    let (touched, stick, flanks) = regimes(&law, &q, &v);
    let slip = touched.iter().sum::<usize>() - stick;
    assert!(
        touched.iter().all(|count| *count > 3) && stick > 3 && slip > 3 && flanks == [true; 2],
        "{touched:?} points on the pulleys, {stick} stick, flanks {flanks:?}"
    );
    let size = q.len();
    let structure = Structure {
        sections: ALONG,
        block: E::NODE_DOF,
        closed: true,
        border: PULLEYS,
    };
    for (gq, gv, h) in [(1.0, 0.0, 1.0e-8), (0.0, 1.0, 1.0e-6), (0.01, 1.0, 1.0e-6)] {
        let mut matrix = BorderedMatrix::new(structure);
        law.add_tangent(at(&q, &v), gq, gv, &mut matrix);
        let mut analytic = vec![vec![0.0; size]; size];
        for (row, column, value) in matrix.triplets() {
            analytic[row][column] += value;
        }
        let mut numeric = vec![vec![0.0; size]; size];
        for column in 0..size {
            let mut shifted = |sign: f64| {
                let (mut q, mut v) = (q.clone(), v.clone());
                q[column] += sign * h * gq;
                v[column] += sign * h * gv;
                force(&mut law, &q, &v)
            };
            let (plus, minus) = (shifted(1.0), shifted(-1.0));
            for row in 0..size {
                numeric[row][column] = -(plus[row] - minus[row]) / (2.0 * h);
            }
        }
        let mut scale = [[0.0_f64; 3]; 3];
        for row in 0..size {
            for column in 0..size {
                let largest = &mut scale[kind::<E>(row)][kind::<E>(column)];
                *largest = largest.max(numeric[row][column].abs());
            }
        }
        for row in 0..size {
            for column in 0..size {
                let (a, n) = (analytic[row][column], numeric[row][column]);
                let scale = scale[kind::<E>(row)][kind::<E>(column)];
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

#[test]
fn every_entry_of_the_tangent() {
    for directions in [
        FrictionDirections::Circumferential,
        FrictionDirections::Both,
    ] {
        for clamp in [false, true] {
            check_every_entry(&belt(), directions, clamp);
        }
        check_every_entry(&linear(), directions, false);
    }
}

/// Forces on belt and hubs cancel; so do their moments about the origin, where the pulleys' are those about their
/// centres and the part along the axis is the torque. Identities of sums of some hundred terms: 1e-12.
#[test]
fn forces_and_moments_of_belt_and_pulleys_cancel() {
    let mut law = contact(&belt(), FrictionDirections::Both, false);
    let (q, v) = wobbling_loop::<BeltBeam3>();
    let chain = ALONG * BeltBeam3::NODE_DOF;
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
    for (k, vector) in forces[..chain].chunks_exact(3).enumerate() {
        let moment = cross(&q[3 * k..3 * k + 3], vector);
        for axis in 0..3 {
            if k % BeltBeam3::NODE_VECTORS == 0 {
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
        assert!((forces[chain + p] - external - total.torque).abs() <= 1.0e-12 * scale);
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
        let mut law = contact(&belt(), directions, false);
        let (q, v) = wobbling_loop::<BeltBeam3>();
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
        assert!(hubs.abs() > 1.0e-4, "the moving hub does work: {hubs}");
        let external = -0.7 * v[ALONG * BeltBeam3::NODE_DOF + 1];
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
