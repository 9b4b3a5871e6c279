//! Steady running on friction that remembers: bristles transported along the arcs.

use ancf::element::BeltBeam2;
use hihna::drive::Drive;
use hihna::steady::running::{Answer, Most, Running, RunningBelt};

const BASE: &str = include_str!("../../../examples/two_pulley.toml");
const RADIUS: f64 = 0.08125;
/// E A [N] of the belt of Table 3.1.
const AXIAL_STIFFNESS: f64 = 1.0e4;

fn belt(changes: &[&str]) -> RunningBelt<BeltBeam2> {
    let overrides: Vec<_> = (["belt.elements=60"].iter().chain(changes))
        .map(|change| change.parse().expect("an override"))
        .collect();
    let drive: Drive = hihna::input::parse("drive.toml", BASE, &overrides).expect("a valid drive");
    RunningBelt::new(&drive).expect("a drive that may be asked")
}

fn running(changes: &[&str]) -> Running {
    match belt(changes).solve() {
        Ok(Answer::Running(running)) => *running,
        other => panic!("{changes:?}: {other:?}"),
    }
}

fn bristles(coefficient: f64, stiffness: f64) -> String {
    format!(
        "contact.friction={{law=\"elastic-plastic\", coefficient={coefficient}, stiffness={stiffness}}}"
    )
}

fn slip(running: &Running) -> f64 {
    1.0 - running.pulleys[1].speed / running.pulleys[0].speed
}

const LOAD: &str = "pulley.driven.torque=-1";

/// Stretch over the distance from the pulley's centre, by the radius: the angle about the centre that a length of belt under the tension T
/// covers, with the stretch f of `T = E A (f² - 1) f / 2` and the penetration `d = T/(k_p R)`, `seat` being `k_p` [N/m²].
fn turn(tension: f64, seat: f64) -> f64 {
    let mut f = 1.0;
    for _ in 0..20 {
        f -= (0.5 * AXIAL_STIFFNESS * (f * f - 1.0) * f - tension)
            / (0.5 * AXIAL_STIFFNESS * (3.0 * f * f - 1.0));
    }
    f / (1.0 - tension / (seat * RADIUS * RADIUS))
}

/// Bar on bristles (theory manual, S13), below the limit of friction, as long as the belt touches. Where it sinks in and bends, over
/// `sqrt(2 R d)` = 2.3 mm and `sqrt(E I/T)` = 5 mm of 255 mm at each end, it is no bar on a circle: of the slip that tension makes,
/// `(d_t - d_s)/R` and more of a part of 1 % of the arc, 2e-3 of the slip on a soft seat; on a seat a hundred times as hard a quarter of it.
#[test]
fn bar_on_bristles() {
    for (seat, tolerance) in [(1.0e7, 4.0e-3), (1.0e9, 1.0e-3)] {
        for stiffness in [1.0e5, 1.0e6] {
            let hard = format!("contact.stiffness={seat:e}");
            let changes = ["belt.elements=120", LOAD, &hard, &bristles(1.2, stiffness)];
            let found = running(&changes);
            let [slack, tight] = [0, 1].map(|s| found.spans[s].tension);
            let middle = 0.5 * (slack + tight);
            let compliance = (turn(middle + 1.0e-3, seat) - turn(middle - 1.0e-3, seat)) / 2.0e-3;
            let angle = 0.5 * (found.pulleys[0].contact_angle + found.pulleys[1].contact_angle);
            let length = angle * RADIUS / turn(middle, seat);
            let decay = (stiffness * compliance).sqrt() * length;
            let first = (tight - slack) * compliance / (decay.cosh() - 1.0);
            let theory = 1.0 - (turn(slack, seat) - first) / (turn(tight, seat) + first);
            let error = slip(&found) / theory - 1.0;
            assert!(
                error.abs() < tolerance,
                "{seat:e}, {stiffness:e}: {} {theory}",
                slip(&found)
            );
            if seat < 1.0e8 {
                assert!(found.iterations <= 8, "{}", found.iterations);
            }
        }
    }
}

/// Bristles know no time: a tenth of the speed leaves the slip, but for the belt's own inertia, `rho A v²` = 0.1 N of 27 N. The mirror
/// image runs the other way to the convergence of Newton's method.
#[test]
fn rate_independent_and_mirrored() {
    let law = bristles(1.2, 1.0e5);
    let fast = slip(&running(&[LOAD, &law]));
    let slow = slip(&running(&[LOAD, &law, "pulley.driver.speed=1.2"]));
    assert!((slow / fast - 1.0).abs() < 4.0e-3, "{slow} {fast}");
    let law = bristles(0.3, 1.0e7);
    let one = running(&[LOAD, &law]);
    let other = running(&["pulley.driven.torque=1", "pulley.driver.speed=-12", &law]);
    assert!((slip(&one) - slip(&other)).abs() < 1.0e-9);
    for (a, b) in [(0, 1), (1, 0)] {
        let (a, b) = (one.spans[a].tension, other.spans[b].tension);
        assert!((a - b).abs() < 1.0e-7 * a, "{a} {b}");
    }
}

/// With little friction the belt sticks where it runs on and slides before it runs off, sooner on stiffer bristles, which slip less. The
/// powers balance, and torques are what they are said to be.
#[test]
fn sticks_and_slides() {
    let found: Vec<_> = [1.0e6, 1.0e7]
        .map(|stiffness| running(&[LOAD, &bristles(0.3, stiffness)]))
        .into();
    for running in &found {
        assert!(running.power_residual.abs() < 1.0e-3);
        // Corrections of 1e-11 m are left, 2e-6 N m on 255 mm of the stiffer bristles.
        let torque = running.pulleys[1].torque;
        assert!((torque - 1.0).abs() < 1.0e-5, "{torque}");
        for pulley in &running.pulleys {
            let part = pulley.slip_angle / pulley.contact_angle;
            assert!(part > 0.05 && part < 0.5, "{part}");
        }
    }
    assert!(slip(&found[1]) < slip(&found[0]));
    assert!(found[1].pulleys[0].slip_angle > found[0].pulleys[0].slip_angle);
}

/// The capacity does not depend on how soft the bristles are: all slide then, and Euler's formula is that of every law (a few percent, as
/// in `gross_slip` of the laws without memory).
#[test]
fn capacity() {
    let factor = |stiffness| {
        let mut belt = belt(&[LOAD, &bristles(0.3, stiffness)]);
        match belt.solve() {
            Ok(Answer::Running(running)) => match belt.capacity(&running) {
                Some(Most::Known(capacity)) => capacity.factor,
                other => panic!("{other:?}"),
            },
            other => panic!("{other:?}"),
        }
    };
    let (soft, stiff) = (factor(1.0e6), factor(1.0e7));
    assert!((soft / stiff - 1.0).abs() < 1.0e-2, "{soft} {stiff}");
    assert!(soft > 1.9 && soft < 2.0, "{soft}");
}

/// Bristles that stick run at the lever of their penetration, so that unequal pulleys creep without a torque: the capacity is the same from
/// a light and from a heavy load, in both directions, and what is beyond it is told by it (1 %, the part of an arc that may stick).
#[test]
fn capacity_of_unequal_pulleys() {
    for radius in ["0.05", "0.12"] {
        for sign in [-1.0, 1.0] {
            let torque = |load: f64| {
                let changes = [
                    "belt.strain=0.005",
                    &bristles(0.3, 1.0e7),
                    &format!("pulley.driven.radius={radius}"),
                    &format!("pulley.driven.torque={}", sign * load),
                ]
                .map(str::to_owned);
                let mut belt = belt(&changes.each_ref().map(String::as_str));
                match belt.solve() {
                    Ok(Answer::Running(running)) => match belt.capacity(&running) {
                        Some(Most::Known(capacity)) => capacity.factor * load,
                        other => panic!("{radius} {sign} {load}: {other:?}"),
                    },
                    Ok(Answer::GrossSlip(slip)) => slip.capacity.factor * load,
                    other => panic!("{radius} {sign} {load}: {other:?}"),
                }
            };
            let most = torque(0.5);
            assert!(most > 1.0, "{radius} {sign}: {most}");
            for load in [0.02, 0.9 * most, 1.5 * most] {
                let found = torque(load);
                assert!(
                    (found / most - 1.0).abs() < 1.0e-2,
                    "{radius} {sign} {load}: {found} {most}"
                );
            }
        }
    }
}

/// Small motions of bristles are not known.
#[test]
fn no_modes() {
    let mut belt = belt(&[LOAD, &bristles(1.2, 1.0e6)]);
    let Ok(Answer::Running(running)) = belt.solve() else {
        panic!("it does not run");
    };
    let refused = belt.modes(&running, 3).expect_err("modes").to_string();
    assert!(refused.contains("remembers displacements"), "{refused}");
}
