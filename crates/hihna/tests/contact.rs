//! The distributed contact and the friction laws (Kerkkänen 2006, 3.20-3.27) against their
//! derivatives and balances.
//!
//! The states are a wobbling loop of eight elements around one pulley, pushed by a second one from
//! outside, so that points lie in and out of contact, stick, slip and pull (`c_p d' < -k_p d`), and
//! one element touches both pulleys. Each test first makes sure that all of these occur and that no
//! point lies within reach of a kink of the laws.

use std::f64::consts::TAU;
use std::num::NonZeroUsize;

use ancf::element::BeltBeam2;
use ancf::linear::{BorderedMatrix, Structure};
use ancf::material::Isotropic;
use ancf::mesh::Mesh;
use ancf::quadrature::Rule;
use ancf::section::PlanarSection;
use ancf::system::{ForceLaw, State};
use hihna::contact::{BeltContact, ContactPulley, Penalty, PulleyContact};
use hihna::friction::{
    Coulomb, CreepRate, ElasticPlastic, FrictionLaw, Frictionless, Law, Slip, Stribeck,
};
use hihna::profile::Profile;

const ELEMENTS: usize = 8;
const NODE: usize = 6;
const CHAIN: usize = ELEMENTS * NODE;
const PULLEYS: usize = 2;
const SIZE: usize = CHAIN + PULLEYS;
const RADIUS: f64 = 0.08;
/// Half a thickness, such that no contact point lies close to a kink.
const FACE: f64 = 0.0014;
const CREEP: Law = Law::CreepRate(CreepRate {
    coefficient: 1.2,
    slope: 1.0e5,
});
const COULOMB: Law = Law::Coulomb(Coulomb {
    coefficient: 0.6,
    velocity: 0.1,
});
const STRIBECK: Law = Law::Stribeck(Stribeck {
    static_coefficient: 0.9,
    sliding_coefficient: 0.25,
    stribeck_velocity: 0.2,
    velocity: 0.1,
});
const BRISTLES: Law = Law::ElasticPlastic(ElasticPlastic {
    coefficient: 0.3,
    stiffness: 4.0e6,
    damping: 2.0e3,
});

/// Contact of the loop on its two pulleys, on its centre line or (`height`) on its faces.
fn contact(friction: &Law, clamp: bool, height: f64) -> BeltContact {
    let element = BeltBeam2::new(
        TAU * RADIUS / ELEMENTS as f64,
        &PlanarSection::rectangle(0.01, 0.01),
        &Isotropic {
            youngs_modulus: 1.0e8,
            poisson_ratio: 0.3,
            density: 1036.0,
        },
        1.0,
        0.01,
        0.0,
    );
    let pulley = |center, radius, height, torque| ContactPulley {
        center,
        displacement: None,
        radius,
        friction: friction.clone(),
        height,
        external: Profile::Constant(torque).into(),
    };
    let mut contact = BeltContact::new(
        &Mesh::closed(vec![element; ELEMENTS]),
        vec![
            pulley([0.0, 0.0], RADIUS - height, height, 0.0),
            pulley([RADIUS + 0.048, 0.01], 0.05 - height, -height, -0.7),
        ],
        Penalty {
            stiffness: 1.0e7,
            damping: 1.0e5,
            clamp,
            // Both places of slip, one with each.
            slip_lever_part: if clamp { 0.0 } else { 1.0 },
        },
        Rule::gauss(NonZeroUsize::new(7).expect("seven")),
    );
    // Bristles stand where the belt was with the pulleys a little turned back and forth.
    let (mut q, v) = wobbling_loop();
    q[CHAIN] -= 8.0e-3;
    q[CHAIN + 1] += 6.0e-3;
    contact.accept(State {
        time: 0.0,
        q: &q,
        v: &v,
    });
    contact
}

/// Coordinates and velocities: a wobbling circle whose slip and radial velocity change sign.
fn wobbling_loop() -> (Vec<f64>, Vec<f64>) {
    let (mut q, mut v) = (vec![0.0; SIZE], vec![0.0; SIZE]);
    for i in 0..ELEMENTS {
        let angle = TAU * i as f64 / ELEMENTS as f64;
        let (s, c) = angle.sin_cos();
        let radius = RADIUS * (1.0 - 0.004 - 0.008 * (3.0 * angle + 0.4).cos());
        let tangential = 0.8 + 0.25 * (2.0 * angle + 0.3).sin();
        let radial = 0.3 * (3.0 * angle + 1.0).cos();
        q[NODE * i..NODE * i + 6].copy_from_slice(&[
            radius * c,
            radius * s,
            -1.02 * s + 0.01 * c,
            1.02 * c + 0.01 * s,
            -c,
            -s,
        ]);
        v[NODE * i..NODE * i + 6].copy_from_slice(&[
            radial * c - tangential * s,
            radial * s + tangential * c,
            -10.0 * c + 0.5 * s,
            -10.0 * s - 0.3 * c,
            2.0 * s,
            -2.0 * c,
        ]);
    }
    q[CHAIN..].copy_from_slice(&[0.3, -0.2]);
    v[CHAIN..].copy_from_slice(&[10.0, -14.0]);
    (q, v)
}

/// Counts points that stick, slip and pull; no kink may be within the reach of a difference.
fn regimes(law: &BeltContact, q: &[f64], v: &[f64]) -> [usize; 3] {
    let [mut stick, mut slip, mut pull] = [0; 3];
    let mut points = Vec::new();
    law.points(State { time: 0.0, q, v }, &mut points);
    for point in points {
        let Some((touched, at)) = point.contact else {
            continue;
        };
        assert!(
            at.penetration > 1.0e-6,
            "a point within reach of the surface"
        );
        let elastic = 1.0e7 * at.penetration + 1.0e5 * at.rate;
        assert!(elastic.abs() > 50.0, "a point within reach of f_n = 0");
        pull += usize::from(elastic < 0.0);
        if at.normal_force == 0.0 {
            continue;
        }
        for factor in [0.98, 1.02] {
            let beside = law.pulleys[touched].friction.develop(
                Slip {
                    velocity: at.slip * factor,
                    displacement: at.displacement * factor,
                },
                at.normal_force.abs(),
            );
            let same = at.slides() == (beside.by_velocity == 0.0 && beside.by_displacement == 0.0);
            let stribeck = matches!(law.pulleys[touched].friction, Law::Stribeck(_));
            assert!(
                same || stribeck,
                "a point within reach of the friction limit"
            );
        }
        slip += usize::from(at.slides());
        stick += usize::from(!at.slides());
    }
    [stick, slip, pull]
}

fn force(law: &mut BeltContact, q: &[f64], v: &[f64]) -> Vec<f64> {
    let mut force = vec![0.0; SIZE];
    law.add_force(State { time: 0.0, q, v }, &mut force);
    force
}

/// Kind of a coordinate: position, slope along, slope across, angle of a pulley.
fn kind(coordinate: usize) -> usize {
    if coordinate < CHAIN {
        coordinate % NODE / 2
    } else {
        3
    }
}

/// Every entry of `gq K + gv C` against the central difference along `(gq, gv)`.
///
/// Positions step by 1e-6 m, 1e-5 of the smallest radius: truncation is of the order of its square,
/// 1e-10. In the velocities most laws are at most quadratic between kinks; the Stribeck curve changes
/// over 0.2 m/s, of which 1e-5 m/s has a truncation of 1e-8 and leaves a rounding of a few 1e-8. Entries are held to 1e-7 of the largest of their kind (force or torque by position, slope
/// or angle), a little above both.
fn check_every_entry(friction: &Law, clamp: bool, height: f64) {
    let mut law = contact(friction, clamp, height);
    let (q, v) = wobbling_loop();
    let structure = Structure {
        sections: ELEMENTS,
        block: NODE,
        closed: true,
        border: PULLEYS,
    };
    for (gq, gv, h) in [(1.0, 0.0, 1.0e-6), (0.0, 1.0, 1.0e-5), (0.02, 1.0, 1.0e-5)] {
        let mut matrix = BorderedMatrix::new(structure);
        law.add_tangent(
            State {
                time: 0.0,
                q: &q,
                v: &v,
            },
            gq,
            gv,
            &mut matrix,
        );
        let mut analytic = vec![vec![0.0; SIZE]; SIZE];
        for (row, column, value) in matrix.triplets() {
            analytic[row][column] += value;
        }
        let mut numeric = vec![vec![0.0; SIZE]; SIZE];
        for column in 0..SIZE {
            let shifted = |sign: f64| {
                let (mut q, mut v) = (q.clone(), v.clone());
                q[column] += sign * h * gq;
                v[column] += sign * h * gv;
                (q, v)
            };
            let ((qp, vp), (qm, vm)) = (shifted(1.0), shifted(-1.0));
            let (plus, minus) = (force(&mut law, &qp, &vp), force(&mut law, &qm, &vm));
            for row in 0..SIZE {
                numeric[row][column] = -(plus[row] - minus[row]) / (2.0 * h);
            }
        }
        let mut scale = [[0.0_f64; 4]; 4];
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
                    (a - n).abs() <= 1.0e-7 * scale,
                    "({gq}, {gv}), clamp {clamp}: entry ({row}, {column}) is {a}, difference {n}, \
                     scale {scale}"
                );
            }
        }
        // The border is not checked by zeros: force and torque by speed, torque by position.
        if gv > 0.0 {
            assert!(scale[0][3] > 0.0 && scale[3][3] > 0.0 && scale[3][0] > 0.0);
        }
    }
}

/// On the centre line and on the faces.
fn check_with(friction: &Law) {
    let (q, v) = wobbling_loop();
    for (clamp, height) in [(false, 0.0), (true, 0.0), (false, FACE), (true, FACE)] {
        let [stick, slip, pull] = regimes(&contact(friction, clamp, height), &q, &v);
        let slips = slip > 1 || matches!(friction, Law::Stribeck(_));
        assert!(
            stick > 2 && slips && (pull > 2 || clamp),
            "the state has {stick} points in stick, {slip} in slip, {pull} that pull"
        );
        check_every_entry(friction, clamp, height);
    }
}

#[test]
fn every_entry_of_the_tangent_under_creep_rate_friction() {
    check_with(&CREEP);
}

#[test]
fn every_entry_of_the_tangent_under_coulomb_friction() {
    check_with(&COULOMB);
}

#[test]
fn every_entry_of_the_tangent_under_stribeck_friction() {
    check_with(&STRIBECK);
}

#[test]
fn every_entry_of_the_tangent_under_elastic_plastic_friction() {
    check_with(&BRISTLES);
}

#[test]
fn every_entry_of_the_tangent_without_friction() {
    check_every_entry_frictionless();
}

/// Without friction nothing depends on the pulleys' speeds, so the border must be zero.
fn check_every_entry_frictionless() {
    let mut law = contact(&Law::Frictionless(Frictionless), false, 0.0);
    let (q, v) = wobbling_loop();
    let mut matrix = BorderedMatrix::new(Structure {
        sections: ELEMENTS,
        block: NODE,
        closed: true,
        border: PULLEYS,
    });
    law.add_tangent(
        State {
            time: 0.0,
            q: &q,
            v: &v,
        },
        0.02,
        1.0,
        &mut matrix,
    );
    for (row, column, value) in matrix.triplets() {
        if row >= CHAIN || column >= CHAIN {
            assert!(value == 0.0, "entry ({row}, {column}) is {value}");
        }
    }
    let forces = force(&mut law, &q, &v);
    assert!(forces[CHAIN] == 0.0, "no torque of the belt");
    assert!(
        (forces[CHAIN + 1] + 0.7).abs() < 1.0e-15,
        "the external torque alone"
    );
}

/// What contact does to the belt and the pulleys balances (3.20-3.26, exact identities of the
/// formulas as coded; sums of some hundred terms, so 1e-12 of their magnitudes):
/// forces on belt and hubs cancel, and so do moments about the pulley's centre.
#[test]
fn forces_and_moments_of_belt_and_pulleys_cancel() {
    let mut law = contact(&CREEP, false, 0.0);
    let (q, v) = wobbling_loop();
    let mut totals = [PulleyContact::default(); PULLEYS];
    law.resultants(
        State {
            time: 0.0,
            q: &q,
            v: &v,
        },
        &mut totals,
    );
    let forces = force(&mut law, &q, &v);
    for axis in 0..2 {
        let on_belt: f64 = (0..ELEMENTS).map(|i| forces[NODE * i + axis]).sum();
        let on_hubs: f64 = totals.iter().map(|t| t.hub_force[axis]).sum();
        let scale: f64 = totals.iter().map(|t| t.hub_force[axis].abs()).sum();
        assert!((on_belt + on_hubs).abs() <= 1.0e-12 * scale.max(1000.0));
    }
    // generalised forces of a rotation of the belt about the origin
    let cross = |a: [f64; 2], b: [f64; 2]| a[0] * b[1] - a[1] * b[0];
    let on_belt: f64 = (0..CHAIN / 2)
        .map(|k| cross([q[2 * k], q[2 * k + 1]], [forces[2 * k], forces[2 * k + 1]]))
        .sum();
    let on_pulleys: f64 = totals
        .iter()
        .zip(&law.pulleys)
        .map(|(t, pulley)| t.torque + cross(pulley.center, t.hub_force))
        .sum();
    let scale = totals[0].torque.abs() + totals[1].torque.abs() + 100.0;
    assert!(
        (on_belt + on_pulleys).abs() <= 1.0e-12 * scale,
        "{on_belt} on the belt, {on_pulleys} on the pulleys"
    );
    for (p, total) in totals.iter().enumerate() {
        let external = law.pulleys[p].external.value(0.0, 0.0);
        assert!((forces[CHAIN + p] - external - total.torque).abs() <= 1.0e-12 * scale);
    }
}

/// Power of the contact forces on belt and pulleys = -(friction + damping losses) - rate of the
/// stored energy. The rate is a central difference along the motion over 1e-6 s, in which a point
/// moves 1e-6 m: truncation 1e-10, rounding 1e-10, held to 1e-8.
#[test]
fn power_of_the_contact_is_accounted_for() {
    for clamp in [false, true] {
        let mut law = contact(&CREEP, clamp, FACE);
        let (q, v) = wobbling_loop();
        let mut totals = [PulleyContact::default(); PULLEYS];
        law.resultants(
            State {
                time: 0.0,
                q: &q,
                v: &v,
            },
            &mut totals,
        );
        let losses: f64 = totals
            .iter()
            .map(|t| t.friction_loss + t.contact_loss)
            .sum();
        let external = -0.7 * v[CHAIN + 1];
        let forces = force(&mut law, &q, &v);
        let power: f64 = forces.iter().zip(&v).map(|(f, v)| f * v).sum::<f64>() - external;
        let h = 1.0e-6;
        let mut stored = |sign: f64| {
            let moved: Vec<f64> = q.iter().zip(&v).map(|(q, v)| q + sign * h * v).collect();
            law.resultants(
                State {
                    time: 0.0,
                    q: &moved,
                    v: &v,
                },
                &mut totals,
            );
            totals.iter().map(|t| t.stored_energy).sum::<f64>()
        };
        let rate = (stored(1.0) - stored(-1.0)) / (2.0 * h);
        assert!(
            (power + losses + rate).abs() <= 1.0e-8 * (power.abs() + losses.abs() + rate.abs()),
            "clamp {clamp}: power {power}, losses {losses}, rate of storage {rate}"
        );
    }
}
