//! Section 2.4, statics: Tables 2.1-2.4 with linear and cubic beams.

use ancf::element::{CubicBeam2, LineElement, LinearBeam2};
use ancf::material::Isotropic;
use ancf::section::PlanarSection;
use ancf::structure::{PlanarStructure, StructureError};

use super::{CaseError, Quantities};

/// Length of every beam [m].
const LENGTH: f64 = 2.0;
const YOUNGS_MODULUS: f64 = 2.07e11;
/// Side of the square section of Tables 2.1 and 2.2, and width of all sections [m].
const SIDE: f64 = 0.1;
/// Load of Tables 2.1 and 2.2 [N].
const LOAD: f64 = 1000.0;
/// Shear correction factor.
const SHEAR_FACTOR: f64 = 5.0 / 6.0;
/// The meshes of the tables.
const MESHES: [usize; 6] = [2, 4, 8, 16, 32, 64];
/// Decimals of Tables 2.1 and 2.2, in millimetres.
const DECIMALS: f64 = 1.0e6;

/// Table 2.1, nu = 0.
pub(super) fn table_2_1() -> Result<Quantities, CaseError> {
    deflections(0.0, -0.097_198)
}

/// Table 2.2, nu = 0.3.
pub(super) fn table_2_2() -> Result<Quantities, CaseError> {
    deflections(0.3, -0.097_285)
}

/// Table 2.3: Model 1.
pub(super) fn table_2_3() -> Result<Quantities, CaseError> {
    tips(0.1, 0.3)
}

/// Table 2.4: Model 2.
pub(super) fn table_2_4() -> Result<Quantities, CaseError> {
    tips(0.5, 0.0)
}

fn steel(poisson_ratio: f64) -> Isotropic {
    Isotropic {
        youngs_modulus: YOUNGS_MODULUS,
        poisson_ratio,
        density: 7850.0,
    }
}

/// Mid-point deflections [mm], and how far the linear beam's are from the printed analytical one, both
/// as the table prints them [%].
fn deflections(poisson_ratio: f64, printed_analytical: f64) -> Result<Quantities, CaseError> {
    let (section, material) = (PlanarSection::rectangle(SIDE, SIDE), steel(poisson_ratio));
    let bending = LOAD * LENGTH.powi(3) / (48.0 * YOUNGS_MODULUS * section.second_moment);
    let shear = LOAD * LENGTH / (4.0 * SHEAR_FACTOR * material.shear_modulus() * section.area);
    let mut quantities = vec![("analytical".to_owned(), -1.0e3 * (bending + shear))];
    for count in MESHES {
        let length = LENGTH / count as f64;
        let linear = mid_deflection(LinearBeam2::new(length, &section, &material), count)?;
        let cubic = mid_deflection(CubicBeam2::new(length, &section, &material), count)?;
        let printed = (linear * DECIMALS).round() / DECIMALS;
        let less = 100.0 * (1.0 - printed / printed_analytical).abs();
        quantities.extend([
            (format!("linear, {count} elements"), linear),
            (format!("cubic, {count} elements"), cubic),
            (format!("linear less analytical, {count} elements"), less),
        ]);
    }
    Ok(quantities)
}

/// [mm]; X and Y of the first node and Y of the last fixed, slopes free.
fn mid_deflection<E: LineElement>(element: E, count: usize) -> Result<f64, StructureError> {
    let mut beam = PlanarStructure::straight(element, count, [0.0; 2], 0.0);
    beam.pin(0)
        .roller(count, [0.0, 1.0])
        .force(count / 2, [0.0, -LOAD]);
    let bent = beam.equilibrium()?;
    Ok(1.0e3 * beam.position(&bent.q, count / 2)[1])
}

/// Tips of cantilevers under 5e8 h³ N [m].
fn tips(height: f64, poisson_ratio: f64) -> Result<Quantities, CaseError> {
    let (section, material) = (PlanarSection::rectangle(SIDE, height), steel(poisson_ratio));
    let load = 5.0e8 * height.powi(3);
    let mut quantities = Quantities::new();
    for count in MESHES {
        let length = LENGTH / count as f64;
        let linear = tip(LinearBeam2::new(length, &section, &material), count, load)?;
        let cubic = tip(CubicBeam2::new(length, &section, &material), count, load)?;
        for (element, [x, y]) in [("linear", linear), ("cubic", cubic)] {
            quantities.push((format!("{element}, {count} elements, x"), x));
            quantities.push((format!("{element}, {count} elements, y"), y));
        }
    }
    Ok(quantities)
}

/// The whole root fixed, a dead load at the tip.
fn tip<E: LineElement>(element: E, count: usize, load: f64) -> Result<[f64; 2], StructureError> {
    let mut beam = PlanarStructure::straight(element, count, [0.0; 2], 0.0);
    beam.clamp(0).force(count, [0.0, -load]);
    let bent = beam.equilibrium()?;
    Ok(beam.position(&bent.q, count))
}
