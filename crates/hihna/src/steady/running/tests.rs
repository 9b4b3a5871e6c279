//! The tangent against differences, and the pieces of contact.

use ancf::element::BeltBeam2;
use ancf::linear::BorderedMatrix;

use super::equations::Control;
use super::{Answer, RunningBelt};

const BASE: &str = include_str!("../../../../../examples/two_pulley.toml");

/// Step of the differences [m].
const STEP: f64 = 5.0e-9;

fn belt(changes: &[&str]) -> RunningBelt<BeltBeam2> {
    let overrides: Vec<_> = (changes.iter())
        .map(|change| change.parse().unwrap())
        .collect();
    let drive = crate::input::parse("two_pulley.toml", BASE, &overrides).unwrap();
    RunningBelt::new(&drive).unwrap()
}

fn solved(belt: &mut RunningBelt<BeltBeam2>) -> Vec<f64> {
    match belt.solve().unwrap() {
        Answer::Running(running) => running.state,
        other => panic!("{other:?}"),
    }
}

/// Largest difference between the tangent and central differences of fourth order of the residual, relative to the largest entry
/// of its column's field.
fn tangent_error(belt: &mut RunningBelt<BeltBeam2>, z: &[f64], step: f64) -> f64 {
    let equations = &mut belt.equations;
    let structure = equations.structure();
    let mut matrix = BorderedMatrix::new(structure);
    equations.tangent(z, &mut matrix);
    let size = structure.size();
    let mut dense = vec![0.0; size * size];
    for (row, column, value) in matrix.triplets() {
        dense[row * size + column] += value;
    }
    let scales = equations.scales.clone();
    let (mut moved_residual, mut difference) = (vec![0.0; size], vec![0.0; size]);
    let mut worst = 0.0_f64;
    // Rows and columns in common units: work per scaled metre.
    let entry = |row: usize, column: usize, value: f64| value / (scales[row] * scales[column]);
    let largest = (0..size * size).fold(0.0, |m: f64, k| {
        m.max(entry(k / size, k % size, dense[k]).abs())
    });
    for column in 0..size {
        let h = step / scales[column];
        difference.fill(0.0);
        for (steps, weight) in [(-2.0, -1.0), (-1.0, 8.0), (1.0, -8.0), (2.0, 1.0)] {
            let mut moved = z.to_vec();
            moved[column] = z[column] + steps * h;
            equations.residual(&moved, &mut moved_residual);
            for (sum, residual) in difference.iter_mut().zip(&moved_residual) {
                *sum += weight / (12.0 * h) * residual;
            }
        }
        for row in 0..size {
            let error = entry(row, column, difference[row] - dense[row * size + column]).abs();
            worst = worst.max(error / largest);
        }
    }
    worst
}

/// Central differences of fourth order with the step h = 5e-9 m. Rounding leaves some 1e-17 of the largest entry over h: 4e-8 at 2e-10 m,
/// 6e-9 at 1e-9 m, 7e-10 at 1e-8 m in all of these cases. Truncation would grow as h⁴ and does not show yet; of second order
/// it did (8e-7 at 1e-8 m on 30 elements, where a corner is about to vanish), hence the higher one. Together below 1e-8 of the largest
/// entry. Pieces whose ends move are differentiated as integrals: Coulomb's law, a product of normal force and slip,
/// needs more than seven points for that (1.4e-6 is left with seven).
#[test]
fn tangent() {
    let load = "pulley.driven.torque=-1";
    for changes in [
        &[load][..],
        &[load, "contact.damping=1000"],
        &[
            load,
            "contact.damping=1000",
            "contact.clamp_normal_force=true",
        ],
        &[load, "contact.surface=face"],
        &[
            load,
            "belt.element=belt-beam",
            "steady.mesh=uniform",
            "gravity=[0, -9.81]",
        ],
        &[
            load,
            "contact.friction={law=\"coulomb\", coefficient=0.6, velocity=0.005}",
            "contact.points=11",
        ],
        &["pulley.driven.load={law=\"fan\", torque=1, speed=12}"],
    ] {
        let mut belt = belt(&[changes, &["belt.elements=40"]].concat());
        let z = solved(&mut belt);
        let error = tangent_error(&mut belt, &z, STEP);
        assert!(error < 1.0e-8, "{changes:?}: {error:.1e}");
        let chain = belt.equations.chain();
        belt.equations.slip_weights[1] = -0.08;
        belt.equations.control = Control::Slip(belt.equations.slip(&z));
        assert!(z[chain + 1] > 0.0);
        let error = tangent_error(&mut belt, &z, STEP);
        assert!(error < 1.0e-8, "{changes:?}, slip given: {error:.1e}");
    }
}

/// The same at 120 rad/s, where the belt pulls on the pulleys before it leaves them.
#[test]
fn tangent_at_high_speed() {
    let text = include_str!("../../../../../examples/figures_3_10_to_3_20.toml");
    for changes in [
        ["belt.elements=40", "contact.friction.slope=1e4"],
        ["belt.elements=40", "contact.friction.slope=1e5"],
    ] {
        let overrides: Vec<_> = changes
            .iter()
            .map(|change| change.parse().unwrap())
            .collect();
        let drive = crate::input::parse("drive.toml", text, &overrides).unwrap();
        let mut belt: RunningBelt<BeltBeam2> = RunningBelt::new(&drive).unwrap();
        let z = solved(&mut belt);
        let error = tangent_error(&mut belt, &z, STEP);
        assert!(error < 1.0e-8, "{changes:?}: {error:.1e}");
    }
}
