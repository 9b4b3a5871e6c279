//! Forces and tangents of the base drive (30 elements, half of them in contact), whole system and by element.
//!
//! `cargo bench -p hihna --bench contact`. Divide by 30 for the share of one element.

use std::hint::black_box;

use ancf::element::BeltBeam2;
use ancf::linear::BorderedMatrix;
use ancf::system::{Mechanics, State};
use criterion::{Criterion, criterion_group, criterion_main};
use hihna::assemble::Assembly;

const ELEMENTS: usize = 30;

fn contact(criterion: &mut Criterion) {
    let text = include_str!("../../../examples/two_pulley.toml");
    let elements = format!("belt.elements={ELEMENTS}");
    let overrides = [elements.parse().expect("an override")];
    let drive = hihna::input::parse("two_pulley.toml", text, &overrides).expect("a valid drive");
    let mut assembly = Assembly::<BeltBeam2>::new(&drive).expect("a drive");
    assembly.release(&drive);
    // Sunk in a little, so that all of both arcs is in contact, and running at 12 rad/s.
    let chain = ELEMENTS * 6;
    let q = assembly.motion.q.clone();
    let mut v = vec![0.0; q.len()];
    for node in 0..ELEMENTS {
        for vector in 0..2 {
            let at = 6 * node + 2 * vector;
            v[at..at + 2].copy_from_slice(&q[6 * node + 2..6 * node + 4]);
        }
    }
    v[chain..].fill(12.0);
    for pulley in &mut assembly.system.law.pulleys {
        pulley.radius += 1.0e-4;
    }
    let state = State {
        time: 0.0,
        q: &q,
        v: &v,
    };
    let system = &mut assembly.system;
    let mut force = vec![0.0; q.len()];
    let mut matrix = BorderedMatrix::new(system.structure());
    let mut group = criterion.benchmark_group("base drive, 30 elements");
    group.bench_function("force", |b| {
        b.iter(|| system.force(black_box(state), &mut force));
    });
    group.bench_function("force and tangent", |b| {
        b.iter(|| {
            system.force(black_box(state), &mut force);
            matrix.clear();
            system.add_tangent(black_box(state), 1.0e-7, 2.5e-4, &mut matrix);
        });
    });
    group.finish();
}

criterion_group!(benches, contact);
criterion_main!(benches);
