//! A slender beam is spun up to 4 rad/s in 15 s about its root (Wu & Haug; Kerkkänen 2006, Figs 2.9-2.11).
//!
//! `cargo run --release --example spin_up`

use std::error::Error;
use std::ops::ControlFlow;
use std::sync::Arc;

use ancf::constraint::SpinUp;
use ancf::dynamics::{Control, Method, integrate};
use ancf::element::LinearBeam2;
use ancf::material::Isotropic;
use ancf::section::PlanarSection;
use ancf::structure::PlanarStructure;
use ancf::system::Motion;

const LENGTH: f64 = 8.0;

fn main() -> Result<(), Box<dyn Error>> {
    let section = PlanarSection::rectangle(1.986e-3, 3.675e-2);
    let aluminium = Isotropic {
        youngs_modulus: 6.895e10,
        poisson_ratio: 0.0,
        density: 2766.67,
    };
    let spin_up = Arc::new(SpinUp {
        speed: 4.0,
        rise_time: 15.0,
    });
    let element = LinearBeam2::new(LENGTH / 3.0, &section, &aluminium);
    let mut beam = PlanarStructure::straight(element.clone(), 3, [0.0, 0.0], 0.0);
    beam.turn(0, spin_up.clone());

    let mut system = beam.build()?;
    let mut motion = beam.at_rest(&system);
    let control = Control::fixed(Method::Auto, 2.0e-3);
    let mut next_row = 1.0;
    println!(" time [s]   lag [m]   shortening [m]");
    integrate(&mut system, &mut motion, 20.0, &control, |_, window| {
        let state = window.to;
        if state.time > next_row - 1.0e-9 {
            let (sine, cosine) = spin_up.at(state.time)[0].sin_cos();
            let [x, y] = beam.position(&state.q, beam.last());
            let along = cosine * x + sine * y - LENGTH;
            let lag = sine * x - cosine * y;
            println!("{:9.2}   {lag:7.4}   {:14.3e}", state.time, -along);
            next_row += 1.0;
        }
        ControlFlow::Continue(())
    })?;

    let mut steady = PlanarStructure::straight(element, 3, [0.0, 0.0], 0.0);
    steady.clamp(0).rotating_frame(4.0);
    let stretched = steady.equilibrium()?;
    let [x, _] = steady.position(&stretched.q, steady.last());
    println!("extension in steady rotation: {:.6e} m", x - LENGTH);
    Ok(())
}
