//! Whole structures: statics of a cantilever, runs of the pendulum.
//!
//! `cargo bench -p ancf --bench structures`. The pendulum is that of Kerkkänen (2006, Figs 2.5-2.8); its step
//! leaves the tip within 1e-4 m of the time-converged motion after 1 s, with both elements. Besides times the ratios of
//! Table 2.5 are printed: CPU time of the run with linear elements over that with cubic ones.

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
        for (method, label) in [
            (Method::RungeKutta, "Runge-Kutta"),
            (Method::GeneralizedAlpha, "generalized-alpha"),
        ] {
            let name = format!("pendulum, {count} elements, {label}");
            let control = common_control(&name, method, &linear, &cubic);
            criterion.bench_function(&format!("{name}, linear"), |bencher| {
                bencher.iter(|| fall(&linear, &control));
            });
            criterion.bench_function(&format!("{name}, cubic"), |bencher| {
                bencher.iter(|| fall(&cubic, &control));
            });
            let ratio = quickest(&linear, &control) / quickest(&cubic, &control);
            println!("{name}: linear/cubic CPU {ratio:.3}");
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

/// The largest step of 1 ms, 0.5 ms, ... that leaves the tips of both pendulums within 1e-4 m of the time-converged
/// ones.
fn common_control(
    name: &str,
    method: Method,
    linear: &PlanarStructure<LinearBeam2>,
    cubic: &PlanarStructure<CubicBeam2>,
) -> Control {
    let mut step = 1.0e-3;
    loop {
        let control = Control {
            newton_tolerance: 1.0e-5,
            ..Control::fixed(method, step)
        };
        let errors = [error(linear, &control), error(cubic, &control)];
        if errors.iter().all(|error| *error < 1.0e-4) || step < 3.0e-5 {
            let [by_linear, by_cubic] = errors;
            println!("{name}: step {step:.2e} s, tip errors {by_linear:.1e} and {by_cubic:.1e} m");
            return control;
        }
        step *= 0.5;
    }
}

/// How far the tip lies from where small steps leave it [m].
fn error<E: LineElement>(pendulum: &PlanarStructure<E>, control: &Control) -> f64 {
    let exact = fall(pendulum, &Control::fixed(Method::RungeKutta, 2.0e-5));
    let [x, y] = fall(pendulum, control);
    (x - exact[0]).hypot(y - exact[1])
}

criterion_group!(structures, benches);
criterion_main!(structures);
