//! Whole structures: statics of a cantilever, runs of the pendulum.
//!
//! `cargo bench -p ancf --bench structures`. The pendulum is that of Kerkkänen (2006, Figs 2.5-2.8); its step
//! leaves the tip within 1e-4 m of the time-converged motion over 1 s, as the first lines printed show.

use std::ops::ControlFlow;

use ancf::dynamics::{Control, Method, integrate};
use ancf::element::{CubicBeam2, LineElement, LinearBeam2};
use ancf::material::Isotropic;
use ancf::section::PlanarSection;
use ancf::structure::PlanarStructure;
use criterion::{Criterion, criterion_group, criterion_main};

const LENGTH: f64 = 2.0;

fn material(youngs_modulus: f64) -> Isotropic {
    Isotropic {
        youngs_modulus,
        poisson_ratio: 0.0,
        density: 7850.0,
    }
}

/// The tip after one second.
fn fall<E: LineElement>(pendulum: &PlanarStructure<E>, control: &Control) -> [f64; 2] {
    let mut system = pendulum.build().expect("it is sound");
    let mut motion = pendulum.at_rest(&system);
    integrate(&mut system, &mut motion, 1.0, control, |_, _| {
        ControlFlow::Continue(())
    })
    .expect("it falls");
    pendulum.position(&motion.q, pendulum.last())
}

fn pendulum<E: LineElement>(element: E, count: usize) -> PlanarStructure<E> {
    let mut pendulum = PlanarStructure::straight(element, count, [0.0; 2], 0.0);
    pendulum.pin(0).gravity([0.0, -9.81]);
    pendulum
}

fn benches(criterion: &mut Criterion) {
    let section = PlanarSection::rectangle(0.1, 0.1);
    let steel = material(2.07e11);
    let element = LinearBeam2::new(LENGTH / 64.0, &section, &steel);
    let mut cantilever = PlanarStructure::straight(element, 64, [0.0; 2], 0.0);
    cantilever.clamp(0).force(64, [0.0, -5.0e5]);
    criterion.bench_function("cantilever of 64 linear elements", |bencher| {
        bencher.iter(|| cantilever.equilibrium().expect("it is clamped"));
    });

    let rubber = material(2.07e7);
    for count in [4, 8] {
        let length = LENGTH / count as f64;
        let linear = pendulum(LinearBeam2::new(length, &section, &rubber), count);
        let cubic = pendulum(CubicBeam2::new(length, &section, &rubber), count);
        bench_fall(criterion, &format!("pendulum, {count} linear"), &linear);
        bench_fall(criterion, &format!("pendulum, {count} cubic"), &cubic);
    }
}

/// One second with the explicit scheme and with generalized-alpha, each with the largest step of 1 ms, 0.5 ms,
/// ... that leaves the tip within 1e-4 m of the time-converged one.
fn bench_fall<E: LineElement>(
    criterion: &mut Criterion,
    name: &str,
    pendulum: &PlanarStructure<E>,
) {
    let exact = fall(pendulum, &Control::fixed(Method::RungeKutta, 2.0e-5));
    for (method, label) in [
        (Method::RungeKutta, "Runge-Kutta"),
        (Method::GeneralizedAlpha, "generalized-alpha"),
    ] {
        let mut step = 1.0e-3;
        let control = loop {
            let control = Control {
                newton_tolerance: 1.0e-5,
                ..Control::fixed(method, step)
            };
            let [x, y] = fall(pendulum, &control);
            let error = (x - exact[0]).hypot(y - exact[1]);
            if error < 1.0e-4 || step < 3.0e-5 {
                println!("{name}, {label}: step {step:.2e} s, tip error {error:.1e} m");
                break control;
            }
            step *= 0.5;
        };
        criterion.bench_function(&format!("{name}, {label}"), |bencher| {
            bencher.iter(|| fall(pendulum, &control));
        });
    }
}

criterion_group!(structures, benches);
criterion_main!(structures);
