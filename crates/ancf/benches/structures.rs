//! Whole structures: statics of a cantilever, runs of the pendulum.
//!
//! `cargo bench -p ancf --bench structures`. The pendulum is that of Kerkkänen (2006, Figs 2.5-2.8); its step
//! leaves the tip within 1e-4 m of the time-converged motion over 1 s. Besides times the ratios of Table 2.5 are
//! printed: CPU time of the run with linear elements over that with cubic ones, each with the largest step of that
//! accuracy, and both with the smaller of the two.

use std::ops::ControlFlow;

use ancf::dynamics::{Control, Method, integrate};
use ancf::element::{CubicBeam2, LineElement, LinearBeam2};
use ancf::material::Isotropic;
use ancf::section::PlanarSection;
use ancf::structure::PlanarStructure;
use cpu_time::ThreadTime;
use criterion::{Criterion, criterion_group, criterion_main};

/// Runs of which the quickest counts.
const RUNS: usize = 200;
const LENGTH: f64 = 2.0;

fn material(youngs_modulus: f64) -> Isotropic {
    Isotropic {
        youngs_modulus,
        poisson_ratio: 0.0,
        density: 7850.0,
    }
}

/// The tip after one second; nothing if a step fails for good.
fn fall<E: LineElement>(pendulum: &PlanarStructure<E>, control: &Control) -> Option<[f64; 2]> {
    let mut system = pendulum.build().expect("it is sound");
    let mut motion = pendulum.at_rest(&system);
    let done = integrate(&mut system, &mut motion, 1.0, control, |_, _| {
        ControlFlow::Continue(())
    });
    done.ok()
        .map(|_| pendulum.position(&motion.q, pendulum.last()))
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
        for (method, label) in [
            (Method::RungeKutta, "Runge-Kutta"),
            (Method::GeneralizedAlpha, "generalized-alpha"),
        ] {
            let name = |element: &str| format!("pendulum, {count} {element}, {label}");
            let linear_control = bench_fall(criterion, &name("linear"), &linear, method);
            let cubic_control = bench_fall(criterion, &name("cubic"), &cubic, method);
            let equal = linear_control.step.min(cubic_control.step);
            for (steps, linear_step, cubic_step) in [
                ("largest steps", linear_control.step, cubic_control.step),
                ("equal steps", equal, equal),
            ] {
                let ratio = quickest(&linear, &control(method, linear_step))
                    / quickest(&cubic, &control(method, cubic_step));
                println!(
                    "pendulum, {count} elements, {label}, {steps}: linear/cubic CPU {ratio:.3}"
                );
            }
        }
    }
}

/// CPU seconds of the quickest of many runs: what disturbs a run makes it longer.
fn quickest<E: LineElement>(pendulum: &PlanarStructure<E>, control: &Control) -> f64 {
    (0..RUNS)
        .map(|_| {
            let clock = ThreadTime::now();
            fall(pendulum, control);
            clock.elapsed().as_secs_f64()
        })
        .fold(f64::INFINITY, f64::min)
}

fn control(method: Method, step: f64) -> Control {
    Control {
        newton_tolerance: 1.0e-5,
        ..Control::fixed(method, step)
    }
}

/// One second with the largest step of 8 ms, a fourth root of two less, ... from which on the tip stays within 1e-4 m of
/// the time-converged one.
fn bench_fall<E: LineElement>(
    criterion: &mut Criterion,
    name: &str,
    pendulum: &PlanarStructure<E>,
    method: Method,
) -> Control {
    let exact = fall(pendulum, &control(Method::RungeKutta, 2.0e-5)).expect("it falls");
    let mut step = 8.0e-3;
    let control = loop {
        let control = control(method, step);
        // An explicit step beyond its limit of stability fails.
        let error = fall(pendulum, &control)
            .map_or(f64::INFINITY, |[x, y]| (x - exact[0]).hypot(y - exact[1]));
        if error < 1.0e-4 {
            println!("{name}: step {step:.2e} s, tip error {error:.1e} m");
            break control;
        }
        step *= 0.5_f64.powf(0.25);
    };
    criterion.bench_function(name, |bencher| {
        bencher.iter(|| fall(pendulum, &control));
    });
    control
}

criterion_group!(structures, benches);
criterion_main!(structures);
