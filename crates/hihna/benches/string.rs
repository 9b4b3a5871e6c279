//! Time of one solution of the string theory: two pulleys (aim 5 us), ten pulleys (aim 100 us),
//! with all derivatives.
//!
//! `cargo bench -p hihna --bench string`

use std::f64::consts::PI;
use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use hihna::steady::string::{Answer, Closure, Model, Role, StringDrive, StringPulley, Tightness};

/// Kerkkänen (2006), Model 2: k = 0.2 kN, 2 N m.
fn two_pulleys() -> StringDrive {
    let radius = 0.05;
    let pulley = |role| StringPulley {
        radius,
        wrap_angle: PI,
        friction: 0.6,
        role,
        span: PI * radius,
    };
    StringDrive {
        axial_stiffness: 200.0,
        line_density: 0.02,
        tightness: Tightness::InitialTension(50.0),
        pulleys: vec![
            pulley(Role::SpeedControlled(500.0)),
            pulley(Role::Torque(-2.0)),
        ],
        model: Model::Full,
        closure: Closure::UnstretchedLength,
    }
}

/// A serpentine drive: crank, four loads, five idlers.
fn ten_pulleys() -> StringDrive {
    let pulley = |i: u32| StringPulley {
        radius: 0.03 + 0.005 * f64::from(i % 4),
        wrap_angle: if i.is_multiple_of(2) { 2.6 } else { 0.9 },
        friction: 0.8,
        role: match i {
            0 => Role::SpeedControlled(200.0),
            i if i.is_multiple_of(2) => Role::Torque(-1.5 - 0.5 * f64::from(i % 3)),
            _ => Role::Torque(0.0),
        },
        span: 0.1 + 0.02 * f64::from(i % 5),
    };
    StringDrive {
        axial_stiffness: 1.2e5,
        line_density: 0.1,
        tightness: Tightness::InitialTension(400.0),
        pulleys: (0..10).map(pulley).collect(),
        model: Model::Full,
        closure: Closure::UnstretchedLength,
    }
}

fn string(criterion: &mut Criterion) {
    for (name, drive) in [
        ("two pulleys", two_pulleys()),
        ("ten pulleys", ten_pulleys()),
    ] {
        assert!(
            matches!(drive.solve(), Ok(Answer::Running(_))),
            "{name} must run"
        );
        criterion.bench_function(&format!("string/{name}"), |bencher| {
            bencher.iter(|| black_box(&drive).solve());
        });
        criterion.bench_function(&format!("string/{name}, all derivatives"), |bencher| {
            bencher.iter(|| black_box(&drive).sensitivity());
        });
    }
}

criterion_group!(benches, string);
criterion_main!(benches);
