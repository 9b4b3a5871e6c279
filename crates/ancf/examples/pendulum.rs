//! A very flexible beam falls from the horizontal, pinned at one end (Kerkkänen 2006, Figs 2.5-2.8).
//!
//! `cargo run --release --example pendulum`

use std::error::Error;
use std::ops::ControlFlow;

use ancf::dynamics::{Control, Method, integrate};
use ancf::element::LinearBeam2;
use ancf::material::Isotropic;
use ancf::section::PlanarSection;
use ancf::structure::PlanarStructure;

fn main() -> Result<(), Box<dyn Error>> {
    let section = PlanarSection::rectangle(0.1, 0.1);
    let rubber = Isotropic {
        youngs_modulus: 2.07e7,
        poisson_ratio: 0.0,
        density: 7850.0,
    };
    let element = LinearBeam2::new(2.0 / 8.0, &section, &rubber);
    let mut pendulum = PlanarStructure::straight(element, 8, [0.0, 0.0], 0.0);
    pendulum.pin(0).gravity([0.0, -9.81]);

    let mut system = pendulum.build()?;
    let mut motion = pendulum.at_rest(&system);
    let control = Control::fixed(Method::RungeKutta, 2.0e-4);
    let mut worst: f64 = 0.0;
    let mut next_row = 0.1;
    println!(" time [s]   tip x [m]   tip y [m]   energy [J]");
    integrate(&mut system, &mut motion, 2.0, &control, |system, window| {
        let state = window.to;
        // Zero at the start: at rest, free of stress, horizontal.
        let energy = system.energy(&state.q, &state.v);
        worst = worst.max(energy.abs());
        if state.time > next_row - 1.0e-9 {
            let [x, y] = pendulum.position(&state.q, pendulum.last());
            println!("{:9.2}   {x:9.5}   {y:9.5}   {energy:10.2e}", state.time);
            next_row += 0.1;
        }
        ControlFlow::Continue(())
    })?;
    println!("largest deviation of the energy: {worst:.2e} J");
    Ok(())
}
