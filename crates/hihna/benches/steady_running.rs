//! Steady running of the finite elements: one solution from the drive, a map of 400 points on one core, 20 modes; 60
//! elements.

use std::hint::black_box;

use ancf::element::BeltBeam2;
use criterion::{Criterion, criterion_group, criterion_main};
use hihna::drive::Drive;
use hihna::input::NumberField;
use hihna::steady::running::map::{Axis, map};
use hihna::steady::running::{Answer, RunningBelt};

fn drive(text: &str, changes: &[&str]) -> Drive {
    let overrides: Vec<_> = (changes.iter())
        .map(|change| change.parse().expect("an override"))
        .collect();
    hihna::input::parse("drive.toml", text, &overrides).expect("a valid drive")
}

fn steady_running(criterion: &mut Criterion) {
    let elements = "belt.elements=60";
    let base = drive(
        include_str!("../../../examples/two_pulley.toml"),
        &[elements, "pulley.driven.torque=-1"],
    );
    let loaded = drive(
        include_str!("../../../examples/figures_3_10_to_3_20.toml"),
        &[elements],
    );
    for (name, drive) in [("base", &base), ("loaded", &loaded)] {
        criterion.bench_function(&format!("steady/solution, {name}"), |bencher| {
            bencher.iter(|| {
                let mut belt = RunningBelt::<BeltBeam2>::new(black_box(drive)).expect("a drive");
                belt.solve()
            });
        });
    }
    let mut group = criterion.benchmark_group("steady");
    group.sample_size(10);
    for (name, drive) in [("base", &base), ("loaded", &loaded)] {
        let mut belt = RunningBelt::<BeltBeam2>::new(drive).expect("a drive");
        let Ok(Answer::Running(running)) = belt.solve() else {
            panic!("{name} must run");
        };
        group.bench_function(format!("20 modes, {name}"), |bencher| {
            bencher.iter(|| belt.modes(black_box(&running), 20));
        });
        group.bench_function(format!("capacity, {name}"), |bencher| {
            bencher.iter(|| belt.capacity(black_box(&running)));
        });
    }
    let axis = |key: &str, from: f64, to: f64| Axis {
        field: NumberField::find(&base, key).expect("a field"),
        values: (0..20)
            .map(|i| from + (to - from) * f64::from(i) / 19.0)
            .collect(),
    };
    let axes = [
        axis("pulley.driven.torque", -0.2, -4.0),
        axis("pulley.driver.speed", 6.0, 120.0),
    ];
    let one = rayon::ThreadPoolBuilder::new()
        .num_threads(1)
        .build()
        .expect("a thread");
    group.bench_function("map of 400 points on one core", |bencher| {
        bencher.iter(|| one.install(|| map(black_box(&base), &axes, || ())));
    });
    group.finish();
}

criterion_group!(benches, steady_running);
criterion_main!(benches);
