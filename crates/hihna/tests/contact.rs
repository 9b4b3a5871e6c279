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
use ancf::quadrature::Rule;
use ancf::scalar::Scalar;
use ancf::section::PlanarSection;
use ancf::system::{ForceLaw, State};
use hihna::contact::{BeltContact, ContactPulley, Penalty, PulleyContact};
use hihna::friction::{Coulomb, CreepRate, FrictionLaw, Frictionless};
use hihna::profile::Profile;
use num_dual::Dual64;

const ELEMENTS: usize = 8;
const NODE: usize = 6;
const CHAIN: usize = ELEMENTS * NODE;
const PULLEYS: usize = 2;
const SIZE: usize = CHAIN + PULLEYS;
const RADIUS: f64 = 0.08;
const CREEP: CreepRate = CreepRate {
    coefficient: 1.2,
    slope: 1.0e5,
};
const COULOMB: Coulomb = Coulomb {
    coefficient: 0.6,
    velocity: 0.1,
};

fn contact<F: FrictionLaw>(friction: F, clamp: bool) -> BeltContact<BeltBeam2, F> {
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
    let pulley = |center, radius, torque| ContactPulley {
        center,
        radius,
        torque: Profile::Constant(torque),
    };
    BeltContact::new(
        &vec![element; ELEMENTS],
        vec![
            pulley([0.0, 0.0], RADIUS, 0.0),
            pulley([RADIUS + 0.048, 0.01], 0.05, -0.7),
        ],
        Penalty {
            stiffness: 1.0e7,
            damping: 1.0e5,
            clamp,
        },
        friction,
        Rule::gauss(NonZeroUsize::new(7).expect("seven")),
    )
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
fn regimes<F: FrictionLaw>(law: &BeltContact<BeltBeam2, F>, q: &[f64], v: &[f64]) -> [usize; 3] {
    let [mut stick, mut slip, mut pull] = [0; 3];
    for (p, pulley) in law.pulleys.iter().enumerate() {
        for point in law.points(State { time: 0.0, q, v }) {
            let (x, y) = (
                point.position[0] - pulley.center[0],
                point.position[1] - pulley.center[1],
            );
            let depth = pulley.radius - x.hypot(y);
            assert!(depth.abs() > 1.0e-6, "a point within reach of the surface");
            let Some((touched, at)) = point.contact else {
                continue;
            };
            if touched != p {
                continue;
            }
            let elastic = 1.0e7 * at.penetration + 1.0e5 * at.rate;
            assert!(elastic.abs() > 50.0, "a point within reach of f_n = 0");
            pull += usize::from(elastic < 0.0);
            let developed = law.friction.develop(at.slip, at.normal_force.abs());
            let slips = developed.by_slip == 0.0;
            for factor in [0.98, 1.02] {
                let beside = law
                    .friction
                    .develop(at.slip * factor, at.normal_force.abs());
                let same = (beside.by_slip == 0.0) == slips;
                assert!(same, "a point within reach of the friction limit");
            }
            slip += usize::from(slips);
            stick += usize::from(!slips);
        }
    }
    [stick, slip, pull]
}

fn force<F: FrictionLaw>(law: &mut BeltContact<BeltBeam2, F>, q: &[f64], v: &[f64]) -> Vec<f64> {
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
/// 1e-10. In the velocities the force is at most quadratic between kinks, so their central difference
/// is exact up to rounding for any step; 1e-4 m/s keeps rounding (1e-16 of the velocities) below
/// 1e-11. Entries are held to 1e-8 of the largest of their kind (force or torque by position, slope
/// or angle), two decades above both.
fn check_every_entry<F: FrictionLaw>(friction: F, clamp: bool) {
    let mut law = contact(friction, clamp);
    let (q, v) = wobbling_loop();
    let structure = Structure {
        sections: ELEMENTS,
        block: NODE,
        closed: true,
        border: PULLEYS,
    };
    for (gq, gv, h) in [(1.0, 0.0, 1.0e-6), (0.0, 1.0, 1.0e-4), (0.02, 1.0, 5.0e-5)] {
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
                    (a - n).abs() <= 1.0e-8 * scale,
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

fn check_with<F: FrictionLaw>(friction: &F) {
    let (q, v) = wobbling_loop();
    for clamp in [false, true] {
        let [stick, slip, pull] = regimes(&contact(friction.clone(), clamp), &q, &v);
        assert!(
            stick > 2 && slip > 2 && pull > 2,
            "the state has {stick} points in stick, {slip} in slip, {pull} that pull"
        );
        check_every_entry(friction.clone(), clamp);
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
fn every_entry_of_the_tangent_without_friction() {
    check_every_entry_frictionless();
}

/// Without friction nothing depends on the pulleys' speeds, so the border must be zero.
fn check_every_entry_frictionless() {
    let mut law = contact(Frictionless, false);
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
    let mut law = contact(CREEP, false);
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
        let external = law.pulleys[p].torque.value(0.0);
        assert!((forces[CHAIN + p] - external - total.torque).abs() <= 1.0e-12 * scale);
    }
}

/// Power of the contact forces on belt and pulleys = -(friction + damping losses) - rate of the
/// stored energy. The rate is a central difference along the motion over 1e-6 s, in which a point
/// moves 1e-6 m: truncation 1e-10, rounding 1e-10, held to 1e-8.
#[test]
fn power_of_the_contact_is_accounted_for() {
    for clamp in [false, true] {
        let mut law = contact(CREEP, clamp);
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

/// The laws' own derivatives against dual numbers: the same few products, so to round-off.
fn check_law_against_dual_numbers<F: FrictionLaw>(law: &F) {
    for slip in [-0.9, -0.1001, -0.05, -1.0e-4, 3.0e-5, 0.02, 0.0999, 0.4] {
        for normal in [0.3, 25.0, 4.0e3, 9.0e4] {
            let plain = law.develop(slip, normal);
            let by_slip = law.develop(Dual64::new(slip, 1.0), Dual64::constant(normal));
            let by_normal = law.develop(Dual64::constant(slip), Dual64::new(normal, 1.0));
            let close = |a: f64, b: f64| (a - b).abs() <= 1.0e-14 * a.abs().max(b.abs());
            assert!(
                close(plain.by_slip, by_slip.force.eps)
                    && close(plain.by_normal, by_normal.force.eps)
                    && close(plain.force, by_slip.force.re),
                "{law:?} at slip {slip}, normal {normal}: {plain:?}"
            );
        }
    }
}

#[test]
fn derivatives_of_the_laws_are_those_of_dual_numbers() {
    check_law_against_dual_numbers(&CREEP);
    check_law_against_dual_numbers(&COULOMB);
    check_law_against_dual_numbers(&Frictionless);
}

/// Closed forms: creep up to the limit, the limit beyond, odd in the slip, nothing without normal
/// force. Products of two or three numbers, so to round-off.
#[test]
fn closed_forms_of_the_laws() {
    let near = |a: f64, b: f64| (a - b).abs() <= 1.0e-14 * b.abs();
    let normal = 500.0;
    // limit 600 N/m, reached at a slip of 6 mm/s
    assert!(near(CREEP.develop(0.003, normal).force, 300.0));
    assert!(near(CREEP.develop(0.006, normal).force, 600.0));
    assert!(near(CREEP.develop(0.05, normal).force, 600.0));
    // limit 300 N/m, reached at 0.1 m/s
    assert!(near(COULOMB.develop(0.025, normal).force, 75.0));
    assert!(near(COULOMB.develop(0.1, normal).force, 300.0));
    assert!(near(COULOMB.develop(2.0, normal).force, 300.0));
    for slip in [1.0e-9, 0.004, 0.006, 0.07, 0.1, 3.0] {
        let pairs = [
            (CREEP.develop(slip, normal), CREEP.develop(-slip, normal)),
            (
                COULOMB.develop(slip, normal),
                COULOMB.develop(-slip, normal),
            ),
        ];
        for (ahead, back) in pairs {
            assert!(near(ahead.force, -back.force));
            assert!(near(ahead.by_slip, back.by_slip));
            assert!(near(ahead.by_normal, -back.by_normal));
        }
        assert!(CREEP.develop(slip, 0.0).force == 0.0);
        assert!(COULOMB.develop(slip, 0.0).force == 0.0);
    }
    assert!(CREEP.develop(0.0, normal).force == 0.0);
    assert!(COULOMB.develop(0.0, normal).force == 0.0);
}
