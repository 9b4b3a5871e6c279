//! Section 2.4, dynamics: the very flexible pendulum, Figs 2.5-2.8, and what it costs, Table 2.5.

use std::ops::ControlFlow;

use ancf::dynamics::{Control, Method, Statistics, integrate};
use ancf::element::{CubicBeam2, LineElement, LinearBeam2};
use ancf::material::Isotropic;
use ancf::section::PlanarSection;
use ancf::structure::PlanarStructure;
use cpu_time::ThreadTime;

use super::{CaseError, Quantities};

/// Length of the beam [m].
const LENGTH: f64 = 2.0;
/// Step of the explicit scheme [s]: an eighth of its limit of stability, 2.8 over the 1.8e3 rad/s of
/// the section's stretching.
const STEP: f64 = 2.0e-4;
/// End of the comparisons [s]: the first swing and most of the way back.
const COMPARED: f64 = 1.2;
/// Runs of which the quickest counts.
const REPETITIONS: usize = 5;

const SECTION_SIDE: f64 = 0.1;
const RUBBER: Isotropic = Isotropic {
    youngs_modulus: 2.07e7,
    poisson_ratio: 0.0,
    density: 7850.0,
};

fn linear(count: usize) -> LinearBeam2 {
    let section = PlanarSection::rectangle(SECTION_SIDE, SECTION_SIDE);
    LinearBeam2::new(LENGTH / count as f64, &section, &RUBBER)
}

fn cubic(count: usize) -> CubicBeam2 {
    let section = PlanarSection::rectangle(SECTION_SIDE, SECTION_SIDE);
    CubicBeam2::new(LENGTH / count as f64, &section, &RUBBER)
}

/// What a run shows.
struct Swing {
    /// Y of the tip after each step [m].
    tip: Vec<f64>,
    /// Largest deviation of the energy from its start [J].
    deviation: f64,
    statistics: Statistics,
    cpu_seconds: f64,
}

/// Pinned at one end, from rest in the horizontal.
fn swing<E: LineElement>(
    element: E,
    count: usize,
    end: f64,
    control: &Control,
) -> Result<Swing, CaseError> {
    let mut pendulum = PlanarStructure::straight(element, count, [0.0; 2], 0.0);
    pendulum.pin(0).gravity([0.0, -9.81]);
    let mut system = pendulum.build()?;
    let mut motion = pendulum.at_rest(&system);
    let start = system.energy(&motion.q, &motion.v);
    let mut tip = Vec::new();
    let mut deviation: f64 = 0.0;
    let clock = ThreadTime::now();
    let statistics = integrate(&mut system, &mut motion, end, control, |system, window| {
        let state = window.to;
        tip.push(pendulum.position(&state.q, count)[1]);
        deviation = deviation.max((system.energy(&state.q, &state.v) - start).abs());
        ControlFlow::Continue(())
    })?;
    Ok(Swing {
        tip,
        deviation,
        statistics,
        cpu_seconds: clock.elapsed().as_secs_f64(),
    })
}

/// Figs 2.6-2.8.
pub(super) fn pendulum() -> Result<Quantities, CaseError> {
    let control = Control::fixed(Method::RungeKutta, STEP);
    let energy = swing(linear(4), 4, 2.0, &control)?.deviation;
    let tip = |count| swing(linear(count), count, COMPARED, &control).map(|swing| swing.tip);
    let (two, four, eight, sixteen) = (tip(2)?, tip(4)?, tip(8)?, tip(16)?);
    let by_cubic = swing(cubic(8), 8, COMPARED, &control)?.tip;
    let [by_8, by_4, by_2] = [&eight, &four, &two].map(|tip| distance(tip, &sixteen));
    let elements = distance(&eight, &by_cubic);
    let named = |name: &str, value| (name.to_owned(), value);
    Ok(vec![
        named(
            "deviation of the energy over 2 s, 4 linear elements",
            energy,
        ),
        named("tip, 8 against 16 linear elements", by_8),
        named("tip, 4 against 16 linear elements", by_4),
        named("tip, 2 against 16 linear elements", by_2),
        named("tip, 8 linear against 8 cubic elements", elements),
        named("difference of 4 to 16 over that of 8 to 16", by_4 / by_8),
        named("difference of 2 to 16 over that of 4 to 16", by_2 / by_4),
        named(
            "difference of 8 linear to 8 cubic over that of 8 to 16 linear",
            elements / by_8,
        ),
    ])
}

/// Largest difference of two histories with equal steps; not a number where they have not.
fn distance(a: &[f64], b: &[f64]) -> f64 {
    if a.len() != b.len() {
        return f64::NAN;
    }
    let differences = a.iter().zip(b).map(|(a, b)| (a - b).abs());
    differences.fold(0.0, f64::max)
}

/// Table 2.5: linear over cubic, both by the default scheme with the same accuracy asked for.
pub(super) fn costs() -> Result<Quantities, CaseError> {
    let control = Control {
        error_tolerance: Some(1.0e-2),
        tightened: Vec::new(),
        ..Control::fixed(Method::Auto, 1.0e-2)
    };
    let mut quantities = Quantities::new();
    for count in [4, 8] {
        let (mut by_linear, mut by_cubic) = (f64::INFINITY, f64::INFINITY);
        let mut works = [(0.0, 0.0); 2];
        for _ in 0..REPETITIONS {
            let linear = swing(linear(count), count, COMPARED, &control)?;
            let cubic = swing(cubic(count), count, COMPARED, &control)?;
            by_linear = by_linear.min(linear.cpu_seconds);
            by_cubic = by_cubic.min(cubic.cpu_seconds);
            works = [linear, cubic].map(|swing| {
                let work = swing.statistics;
                (work.steps as f64, work.force_evaluations as f64)
            });
        }
        let [linear, cubic] = works;
        quantities.extend([
            (format!("CPU time, {count} elements"), by_linear / by_cubic),
            (format!("steps, {count} elements"), linear.0 / cubic.0),
            (
                format!("evaluations of the force, {count} elements"),
                linear.1 / cubic.1,
            ),
        ]);
    }
    Ok(quantities)
}
