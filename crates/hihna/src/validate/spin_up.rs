//! Section 2.4, dynamics: the beam that is spun up, (2.35)-(2.37), Figs 2.9-2.11.

use std::ops::ControlFlow;
use std::sync::Arc;

use ancf::constraint::SpinUp;
use ancf::dynamics::{Control, Method, integrate};
use ancf::element::LinearBeam2;
use ancf::material::Isotropic;
use ancf::section::PlanarSection;
use ancf::structure::PlanarStructure;
use ancf::system::Motion;

use super::{CaseError, Quantities};

const LENGTH: f64 = 8.0;
const ELEMENTS: usize = 3;
/// Final speed [rad/s].
const SPEED: f64 = 4.0;
/// Time to reach it, and end of the run [s].
const RISE_TIME: f64 = 15.0;
const END: f64 = 20.0;
/// Step [s]: a 200th of the period of the first bending.
const STEP: f64 = 2.0e-3;
const ALUMINIUM: Isotropic = Isotropic {
    youngs_modulus: 6.895e10,
    poisson_ratio: 0.0,
    density: 2766.67,
};

fn element() -> LinearBeam2 {
    let section = PlanarSection::rectangle(1.986e-3, 3.675e-2);
    LinearBeam2::new(LENGTH / ELEMENTS as f64, &section, &ALUMINIUM)
}

/// Extension by theory and by finite elements at constant speed, then the transient.
pub(super) fn spin_up() -> Result<Quantities, CaseError> {
    let slenderness = SPEED * (ALUMINIUM.density / ALUMINIUM.youngs_modulus).sqrt() * LENGTH;
    let by_theory = LENGTH * (slenderness.tan() / slenderness - 1.0);
    let mut quantities = vec![
        ("axial extension by (2.36)".to_owned(), by_theory),
        (
            "axial extension in relative equilibrium".to_owned(),
            relative_extension()?,
        ),
    ];
    quantities.extend(transient()?);
    Ok(quantities)
}

fn relative_extension() -> Result<f64, CaseError> {
    let mut beam = PlanarStructure::straight(element(), ELEMENTS, [0.0; 2], 0.0);
    beam.clamp(0).rotating_frame(SPEED);
    let stretched = beam.equilibrium()?;
    Ok(beam.position(&stretched.q, ELEMENTS)[0] - LENGTH)
}

fn transient() -> Result<Quantities, CaseError> {
    let rotation = Arc::new(SpinUp {
        speed: SPEED,
        rise_time: RISE_TIME,
    });
    let mut beam = PlanarStructure::straight(element(), ELEMENTS, [0.0; 2], 0.0);
    beam.turn(0, rotation.clone());
    let mut system = beam.build()?;
    let mut motion = beam.at_rest(&system);
    let mut lag = (f64::NEG_INFINITY, f64::NAN);
    let (mut least, mut greatest) = (f64::INFINITY, f64::NEG_INFINITY);
    let mut extensions = Vec::new();
    let control = Control::fixed(Method::Auto, STEP);
    integrate(&mut system, &mut motion, END, &control, |_, window| {
        let state = window.to;
        let (sine, cosine) = rotation.at(state.time)[0].sin_cos();
        let [x, y] = beam.position(&state.q, ELEMENTS);
        let across = sine * x - cosine * y;
        if across > lag.0 {
            lag = (across, state.time);
        }
        let difference = y - LENGTH * sine;
        (least, greatest) = (least.min(difference), greatest.max(difference));
        if state.time >= RISE_TIME {
            extensions.push(cosine * x + sine * y - LENGTH);
        }
        ControlFlow::Continue(())
    })?;
    let mean = extensions.iter().sum::<f64>() / extensions.len() as f64;
    let most = extensions.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let named = |name: &str, value| (name.to_owned(), value);
    Ok(vec![
        named("largest lag across the shadow beam", lag.0),
        named("time of the largest lag", lag.1),
        named("least global Y difference to the shadow beam", least),
        named("greatest global Y difference to the shadow beam", greatest),
        named("mean extension after 15 s", mean),
        named("greatest extension after 15 s", most),
    ])
}
