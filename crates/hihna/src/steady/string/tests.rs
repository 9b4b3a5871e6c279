//! Published numbers, limits, balances and derivatives of the string theory.

use std::f64::consts::PI;

use proptest::prelude::*;

use super::sensitivity::{inputs_of, visit_results};
use super::*;

/// The closure is solved to a relative step of 1e-12 and balances hold by construction: round-off
/// of a few dozen operations.
const ROUND_OFF: f64 = 1.0e-11;

/// Model 2 of Kerkkänen (2006), Table 4.1 and section 4.6: R = 0.05 m, spans pi R, 50 N at rest, mu
/// = 0.6, 500 rad/s, m = 0.02 kg/m; `torque` brakes the driven pulley.
fn model_2(axial_stiffness: f64, torque: f64) -> StringDrive {
    let radius = 0.05;
    let pulley = |role| StringPulley {
        radius,
        wrap_angle: PI,
        friction: 0.6,
        role,
        span: PI * radius,
    };
    StringDrive {
        axial_stiffness,
        line_density: 0.02,
        tightness: Tightness::InitialTension(50.0),
        pulleys: vec![
            pulley(Role::SpeedControlled(500.0)),
            pulley(Role::Torque(-torque)),
        ],
        model: Model::Full,
        closure: Closure::UnstretchedLength,
    }
}

/// Four pulleys of all kinds: tight and loose idler, two loads, unequal radii and coefficients.
fn serpentine() -> StringDrive {
    let pulley = |radius, wrap_angle, friction, role, span| StringPulley {
        radius,
        wrap_angle,
        friction,
        role,
        span,
    };
    StringDrive {
        axial_stiffness: 4.0e4,
        line_density: 0.11,
        tightness: Tightness::InitialTension(420.0),
        pulleys: vec![
            pulley(0.03, 2.1, 0.9, Role::Torque(-3.0), 0.21),
            pulley(0.08, 2.9, 0.8, Role::SpeedControlled(150.0), 0.17),
            pulley(0.04, 1.2, 0.7, Role::Torque(0.0), 0.12),
            pulley(0.06, 2.4, 0.6, Role::Torque(-5.0), 0.33),
        ],
        model: Model::Full,
        closure: Closure::UnstretchedLength,
    }
}

fn runs(drive: &StringDrive) -> Running {
    match drive.solve().unwrap() {
        Answer::Running(running) => running,
        other => panic!("does not run: {other:?}"),
    }
}

fn close(a: f64, b: f64, tolerance: f64) -> bool {
    (a - b).abs() <= tolerance * a.abs().max(b.abs()).max(1.0)
}

/// Kerkkänen (2006), Figs 4.11, 4.14 and (4.48); the printed digits of an independent calculation,
/// so half of the last one.
#[test]
fn published_speed_losses() {
    let loss = |drive: &StringDrive| runs(drive).pulleys[1].speed_loss;
    let soft = model_2(200.0, 2.0);
    assert!((loss(&soft) - 0.1516).abs() < 0.5e-4);
    let capstan = StringDrive {
        model: Model::Capstan,
        ..soft.clone()
    };
    assert!((loss(&capstan) - 0.1471).abs() < 0.5e-4);
    assert!((loss(&model_2(25.0e3, 2.0)) - 0.001_596).abs() < 0.5e-6);
    // (4.48): the pulleys' surface speeds are those of the spans that arrive.
    let running = runs(&soft);
    assert!(close(running.spans[1].speed, 0.05 * 500.0, ROUND_OFF));
    assert!(close(
        running.spans[0].speed,
        0.05 * running.pulleys[1].speed,
        ROUND_OFF
    ));
}

/// All closures and models stay within the range that the readings of the text allow (14.2 to 15.3 %).
#[test]
fn every_closure_and_model_is_near() {
    for model in [Model::Full, Model::Centrifugal, Model::Capstan] {
        for closure in [Closure::UnstretchedLength, Closure::TensionSum] {
            let running = runs(&StringDrive {
                model,
                closure,
                ..model_2(200.0, 2.0)
            });
            let loss = running.pulleys[1].speed_loss;
            println!("{model:?} {closure:?} {loss}");
            assert!(loss > 0.142 && loss < 0.153);
            if closure == Closure::TensionSum {
                let sum = running.spans[0].tension + running.spans[1].tension;
                assert!(close(sum, 100.0, ROUND_OFF));
            } else {
                // L0 = L/(1 + T_init/k).
                assert!(close(
                    running.unstretched_length,
                    4.0 * PI * 0.05 / 1.25,
                    ROUND_OFF
                ));
            }
        }
    }
}

/// The integral of friction times radius is the torque (all models), that of normal force and
/// friction the hub load of the pressing tensions (full, capstan). Simpson's rule over the smooth
/// slip zone, 200 panels: error (mu phi/200)^4 < 1e-9.
#[test]
fn friction_balances_torque() {
    for model in [Model::Full, Model::Centrifugal, Model::Capstan] {
        for drive in [model_2(200.0, 2.0), model_2(25.0e3, 2.0), serpentine()] {
            let drive = StringDrive { model, ..drive };
            let running = runs(&drive);
            for (i, pulley) in running.pulleys.iter().enumerate() {
                let radius = drive.pulleys[i].radius;
                let panels = 200;
                let width = pulley.slip_angle / f64::from(panels);
                let mut torque = 0.0;
                for panel in 0..panels {
                    for (share, weight) in [(1.0e-9, 1.0), (0.5, 4.0), (1.0, 1.0)] {
                        let angle = pulley.stick_angle + (f64::from(panel) + share) * width;
                        let state = running.on_pulley(i, angle);
                        torque += weight / 6.0 * width * radius * radius * state.friction_force;
                    }
                }
                assert!(
                    close(torque, pulley.torque, 1.0e-6),
                    "{model:?} {i} {torque} {}",
                    pulley.torque
                );
                // Belt and pulley meet the spans at both ends.
                let (inlet, exit) = (
                    running.on_pulley(i, 0.0),
                    running.on_pulley(i, drive.pulleys[i].wrap_angle),
                );
                let before = &running.spans[(i + drive.pulleys.len() - 1) % drive.pulleys.len()];
                assert!(close(inlet.tension, before.tension, ROUND_OFF));
                assert!(close(exit.tension, running.spans[i].tension, ROUND_OFF));
                assert!(close(exit.slip_speed, pulley.slip_speed, ROUND_OFF));
            }
        }
    }
}

/// Power in less power out is what the slip zones lose; the unstretched lengths of all parts make
/// the belt.
#[test]
fn power_and_length_balance() {
    for model in [Model::Full, Model::Centrifugal, Model::Capstan] {
        for drive in [model_2(200.0, 2.0), serpentine()] {
            let drive = StringDrive { model, ..drive };
            let running = runs(&drive);
            assert!(close(
                running.power_in - running.power_out,
                running.friction_loss,
                ROUND_OFF
            ));
            let length: f64 = (0..drive.pulleys.len())
                .map(|i| {
                    let arc = running
                        .on_pulley(i, drive.pulleys[i].wrap_angle)
                        .unstretched_length;
                    arc + drive.pulleys[i].span / (1.0 + running.spans[i].strain)
                })
                .sum();
            assert!(close(length, running.unstretched_length, ROUND_OFF));
        }
    }
}

/// Without mass all models are the capstan one; without torque all tensions are equal and nothing
/// slips.
#[test]
fn limits() {
    for drive in [model_2(200.0, 2.0), serpentine()] {
        let massless = StringDrive {
            line_density: 0.0,
            ..drive.clone()
        };
        let capstan = runs(&StringDrive {
            model: Model::Capstan,
            ..drive.clone()
        });
        for model in [Model::Full, Model::Centrifugal] {
            let light = runs(&StringDrive {
                model,
                ..massless.clone()
            });
            for (a, b) in light.spans.iter().zip(&capstan.spans) {
                assert!(close(a.tension, b.tension, ROUND_OFF));
            }
            for (a, b) in light.pulleys.iter().zip(&capstan.pulleys) {
                assert!(
                    close(a.speed, b.speed, ROUND_OFF)
                        && close(a.slip_angle, b.slip_angle, ROUND_OFF)
                );
            }
        }
        let mut idle = drive.clone();
        for pulley in &mut idle.pulleys {
            if let Role::Torque(torque) = &mut pulley.role {
                *torque = 0.0;
            }
        }
        let running = runs(&idle);
        assert!(running.capacity.is_none() && running.efficiency.is_none());
        let Tightness::InitialTension(rest) = idle.tightness else {
            unreachable!()
        };
        assert!(
            running
                .spans
                .iter()
                .all(|span| close(span.tension, rest, ROUND_OFF))
        );
        assert!(
            running
                .pulleys
                .iter()
                .all(|pulley| pulley.slip_angle == 0.0 && pulley.slip_speed == 0.0)
        );
    }
}

/// At the largest torque the ratio of T - G v is exp(mu wrap) on the limiting pulley; just above it
/// the answer is gross slip, and the slip angle found passes the wrap there.
#[test]
fn gross_slip_torque() {
    for drive in [model_2(200.0, 2.0), model_2(25.0e3, 2.0), serpentine()] {
        for closure in [Closure::UnstretchedLength, Closure::TensionSum] {
            let drive = StringDrive {
                closure,
                ..drive.clone()
            };
            let capacity = runs(&drive).capacity.unwrap();
            assert!(capacity.factor > 1.0);
            let scaled = |factor: f64| {
                let mut drive = drive.clone();
                for pulley in &mut drive.pulleys {
                    if let Role::Torque(torque) = &mut pulley.role {
                        *torque *= factor;
                    }
                }
                drive
            };
            let below = scaled(capacity.factor * (1.0 - 1.0e-9));
            let running = runs(&below);
            let limiting = capacity.pulley;
            let count = drive.pulleys.len();
            let (a, b) = (
                &running.spans[limiting],
                &running.spans[(limiting + count - 1) % count],
            );
            let ratio = a.pressing_tension.max(b.pressing_tension)
                / a.pressing_tension.min(b.pressing_tension);
            let pulley = &drive.pulleys[limiting];
            // The factor is short of the limit by 1e-9, which the steep ratio multiplies by some ten.
            assert!(close(
                ratio,
                (pulley.friction * pulley.wrap_angle).exp(),
                1.0e-7
            ));
            assert!(close(
                running.pulleys[limiting].torque,
                capacity.torque,
                1.0e-8
            ));
            for excess in [1.0e-6, 0.1, 10.0] {
                match scaled(capacity.factor * (1.0 + excess)).solve().unwrap() {
                    Answer::GrossSlip(slip) => {
                        assert!(slip.slip_angle > slip.wrap_angle);
                        assert!(close(slip.capacity.factor, 1.0 / (1.0 + excess), 1.0e-9));
                        assert_eq!(slip.capacity.pulley, limiting);
                    }
                    other => panic!("beyond its capacity: {other:?}"),
                }
            }
        }
    }
}

/// A belt longer than its path, and one that centrifugal force lifts off: T_init < m v² at 25 m/s
/// and 0.02 kg/m is 12.5 N (of the unstretched density: m v0 v = 12.5 N/lambda).
#[test]
fn slack_belts() {
    let mut drive = model_2(25.0e3, 0.5);
    drive.tightness = Tightness::UnstretchedLength(drive.path_length() * 1.001);
    let Answer::Slack(slack) = drive.solve().unwrap() else {
        panic!("runs")
    };
    assert!(slack.tension < 0.0 && slack.needed_tension > 12.0);
    drive.tightness = Tightness::InitialTension(12.49);
    let Answer::Slack(slack) = drive.solve().unwrap() else {
        panic!("runs")
    };
    assert!(close(slack.tension, 12.49, ROUND_OFF));
    assert!(close(
        slack.needed_tension,
        12.5 / (1.0 + 12.49 / 25.0e3),
        ROUND_OFF
    ));
    drive.model = Model::Capstan;
    drive.pulleys[1].role = Role::Torque(-0.1);
    runs(&drive);
    // Without friction any torque is too much.
    drive.pulleys[1].friction = 0.0;
    let Answer::GrossSlip(slip) = drive.solve().unwrap() else {
        panic!("runs")
    };
    assert!(
        slip.capacity.factor == 0.0 && slip.capacity.pulley == 1 && slip.slip_angle.is_infinite()
    );
}

/// A belt particle does not care which pulley is listed first, nor the drive how its tightness is
/// given.
#[test]
fn order_and_tightness() {
    let drive = serpentine();
    let running = runs(&drive);
    let mut turned = drive.clone();
    turned.pulleys.rotate_left(2);
    let image = runs(&turned);
    for i in 0..4 {
        assert!(close(
            image.spans[i].tension,
            running.spans[(i + 2) % 4].tension,
            ROUND_OFF
        ));
        assert!(close(
            image.pulleys[i].speed,
            running.pulleys[(i + 2) % 4].speed,
            ROUND_OFF
        ));
    }
    let unstretched = drive.path_length() / (1.0 + 420.0 / drive.axial_stiffness);
    let by_length = StringDrive {
        tightness: Tightness::UnstretchedLength(unstretched),
        ..drive
    };
    let image = runs(&by_length);
    // L - L0 of L0 given loses two digits to cancellation at 1 % strain.
    assert!(close(
        image.spans[0].tension,
        running.spans[0].tension,
        100.0 * ROUND_OFF
    ));
}

#[test]
fn bad_input_is_named() {
    let refuse = |change: fn(&mut StringDrive)| {
        let mut drive = model_2(200.0, 2.0);
        change(&mut drive);
        drive.solve().unwrap_err().to_string()
    };
    assert!(refuse(|d| d.pulleys.truncate(1)).contains("two pulleys"));
    assert!(refuse(|d| d.axial_stiffness = 0.0).contains("axial stiffness"));
    assert!(refuse(|d| d.line_density = f64::NAN).contains("line density"));
    assert!(refuse(|d| d.pulleys[1].radius = -1.0).contains("radius [m] of pulley 1"));
    assert!(refuse(|d| d.pulleys[0].wrap_angle = 0.0).contains("wrap angle [rad] of pulley 0"));
    assert!(refuse(|d| d.pulleys[0].friction = -0.1).contains("friction coefficient of pulley 0"));
    assert!(
        refuse(|d| d.pulleys[0].role = Role::SpeedControlled(0.0)).contains("[rad/s] of pulley 0")
    );
    assert!(
        refuse(|d| d.pulleys[1].role = Role::Torque(f64::INFINITY))
            .contains("torque [N m] of pulley 1")
    );
    assert!(refuse(|d| d.pulleys[0].role = Role::Torque(1.0)).contains("0 pulleys"));
    assert!(refuse(|d| d.pulleys[1].role = Role::SpeedControlled(1.0)).contains("2 pulleys"));
    assert!(
        refuse(|d| d.tightness = Tightness::UnstretchedLength(0.0)).contains("unstretched length")
    );
}

/// Dual numbers against central differences with steps of 1e-5 of each input: truncation 1e-10
/// times third derivatives (taken as 100 times the value over the input cubed), round-off
/// 1e-12/1e-5 of the value.
#[test]
fn derivatives_match_central_differences() {
    let mut two = model_2(200.0, 2.0);
    // Unequal wraps: at equal ones both pulleys reach gross slip together and the capacity has a kink.
    two.pulleys[0].wrap_angle = 3.0;
    for drive in [two, serpentine()] {
        for model in [Model::Full, Model::Centrifugal, Model::Capstan] {
            for closure in [Closure::UnstretchedLength, Closure::TensionSum] {
                let drive = StringDrive {
                    model,
                    closure,
                    ..drive.clone()
                };
                let sensitivity = drive.sensitivity().unwrap().unwrap();
                for (i, input) in sensitivity.inputs.iter().enumerate() {
                    let value = *inputs_of(&mut drive.clone())[i];
                    let step = 1.0e-5 * value.abs();
                    if step == 0.0 {
                        continue;
                    }
                    let at = |shift: f64| {
                        let mut moved = drive.clone();
                        *inputs_of(&mut moved)[i] = value + shift;
                        let mut results = Vec::new();
                        visit_results(&runs(&moved), |name, value| {
                            results.push((name.to_string(), value));
                        });
                        results
                    };
                    for (r, (plus, minus)) in at(step).iter().zip(at(-step)).enumerate() {
                        let difference = (plus.1 - minus.1) / (2.0 * step);
                        let exact = sensitivity.derivatives[r][i];
                        let scale = sensitivity.values[r].abs() / value.abs();
                        let error = (difference - exact).abs();
                        assert!(
                            error <= 1.0e-6 * scale.max(exact.abs()),
                            "{input} {} {exact} {difference}",
                            plus.0
                        );
                    }
                }
            }
        }
    }
}

proptest! {
    /// Any drive gets an answer, and one that runs balances torque, power and length.
    #[test]
    fn every_drive_gets_an_answer(
        draws in proptest::collection::vec((0.01..0.5_f64, 0.05..6.0_f64, 0.0..3.0_f64, -50.0..50.0_f64, 0.0..2.0_f64), 2..12),
        stiffness in 2.0..7.0_f64, density in -4.0..0.5_f64, strain in -4.0..0.3_f64, speed in -1.0..3.0_f64,
        driver in 0_usize..12, model in 0_usize..3, closure in any::<bool>(), load in -3.0..2.0_f64,
    ) {
        let k = 10.0_f64.powf(stiffness);
        let count = draws.len();
        let tension = k * 10.0_f64.powf(strain);
        let drive = StringDrive {
            axial_stiffness: k,
            line_density: 10.0_f64.powf(density),
            tightness: Tightness::InitialTension(tension),
            pulleys: draws.iter().enumerate().map(|(i, draw)| StringPulley {
                radius: draw.0,
                wrap_angle: draw.1,
                friction: draw.2,
                role: if i == driver % count {
                    Role::SpeedControlled(10.0_f64.powf(speed))
                } else {
                    Role::Torque(0.02 * draw.3 * tension * draw.0 * 10.0_f64.powf(load))
                },
                span: draw.4,
            }).collect(),
            model: [Model::Full, Model::Centrifugal, Model::Capstan][model],
            closure: if closure { Closure::UnstretchedLength } else { Closure::TensionSum },
        };
        match drive.solve().unwrap() {
            Answer::Running(running) => {
                let work: f64 = running.pulleys.iter().map(|p| p.power).sum();
                let scale = running.power_in + running.power_out;
                prop_assert!((work - running.friction_loss).abs() <= 1.0e-9 * scale.max(1.0e-9));
                prop_assert!(running.pulleys.iter().all(|p| p.slip_angle >= 0.0 && p.stick_angle >= -1.0e-9));
                prop_assert!(running.spans.iter().all(|s| s.pressing_tension > 0.0));
                if drive.closure == Closure::UnstretchedLength {
                    let rest = drive.path_length() / (1.0 + tension / k);
                    prop_assert!(close(running.unstretched_length / rest, 1.0, ROUND_OFF));
                }
            }
            Answer::GrossSlip(slip) => prop_assert!(slip.capacity.factor < 1.0 && slip.slip_angle > slip.wrap_angle),
            Answer::Slack(slack) => prop_assert!(slack.tension <= slack.needed_tension),
        }
    }
}
