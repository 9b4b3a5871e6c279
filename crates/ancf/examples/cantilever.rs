//! A cantilever of steel, 2 m long, bent by a dead load at its tip (Kerkkänen 2006, Table 2.3).
//!
//! `cargo run --release --example cantilever`

use ancf::element::LinearBeam2;
use ancf::material::Isotropic;
use ancf::section::PlanarSection;
use ancf::structure::{PlanarStructure, StructureError};

fn main() -> Result<(), StructureError> {
    let section = PlanarSection::rectangle(0.1, 0.1);
    let steel = Isotropic {
        youngs_modulus: 2.07e11,
        poisson_ratio: 0.3,
        density: 7850.0,
    };
    println!("elements   tip x [m]   tip y [m]   reaction [N]   iterations");
    for count in [2, 4, 8, 16, 32, 64] {
        let element = LinearBeam2::new(2.0 / count as f64, &section, &steel);
        let mut beam = PlanarStructure::straight(element, count, [0.0, 0.0], 0.0);
        beam.clamp(0);
        beam.force(beam.last(), [0.0, -5.0e5]);
        let bent = beam.equilibrium()?;
        let [x, y] = beam.position(&bent.q, beam.last());
        let [_, lift] = beam.reaction(&bent, 0);
        println!(
            "{count:8}   {x:9.5}   {y:9.5}   {lift:12.1}   {:10}",
            bent.iterations()
        );
    }
    Ok(())
}
