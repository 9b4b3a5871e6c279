//! Statics of the planar beams of Kerkkänen (2006), chapter 2: Tables 2.1-2.4, closed form, turned mesh.
//!
//! Values are compared as the tables print them: every digit. Two entries are known misprints; `computed` says what
//! an independent calculation finds instead (see the validation dossier).

use ancf::element::{CubicBeam2, LineElement, LinearBeam2};
use ancf::material::Isotropic;
use ancf::section::PlanarSection;
use ancf::structure::PlanarStructure;

/// Length of every beam of the chapter [m].
const LENGTH: f64 = 2.0;
const YOUNGS: f64 = 2.07e11;
/// The meshes of the tables.
const ELEMENTS: [usize; 6] = [2, 4, 8, 16, 32, 64];

fn material(poisson_ratio: f64) -> Isotropic {
    Isotropic {
        youngs_modulus: YOUNGS,
        poisson_ratio,
        density: 7850.0,
    }
}

/// Simply supported: X and Y of the first node and Y of the last fixed, slopes free, 1 kN down at
/// mid-span.
fn simply_supported<E: LineElement>(element: E, elements: usize) -> PlanarStructure<E> {
    let mut beam = PlanarStructure::straight(element, elements, [0.0; 2], 0.0);
    beam.pin(0)
        .roller(elements, [0.0, 1.0])
        .force(elements / 2, [0.0, -1000.0]);
    beam
}

fn mid_deflection<E: LineElement>(element: E, elements: usize) -> f64 {
    let beam = simply_supported(element, elements);
    let bent = beam.equilibrium().expect("it is supported");
    beam.position(&bent.q, elements / 2)[1]
}

/// Tip of a cantilever with all coordinates of the root fixed.
fn tip<E: LineElement>(element: E, elements: usize, load: f64, angle: f64) -> [f64; 2] {
    let mut beam = PlanarStructure::straight(element, elements, [0.0; 2], angle);
    let (sine, cosine) = angle.sin_cos();
    beam.clamp(0).force(elements, [load * sine, -load * cosine]);
    let bent = beam.equilibrium().expect("it is clamped");
    beam.position(&bent.q, elements)
}

fn assert_printed(what: &str, value: f64, printed: &str) {
    let decimals = printed.split('.').nth(1).map_or(0, str::len);
    assert_eq!(format!("{value:.decimals$}"), printed, "{what} is {value}");
}

/// Millimetres; entry by mesh.
fn check_deflections(poisson_ratio: f64, linear: [&str; 6], cubic: [&str; 6]) {
    let section = PlanarSection::rectangle(0.1, 0.1);
    let material = material(poisson_ratio);
    for (i, n) in ELEMENTS.into_iter().enumerate() {
        let length = LENGTH / n as f64;
        let value = mid_deflection(LinearBeam2::new(length, &section, &material), n);
        assert_printed(&format!("linear, {n}"), 1e3 * value, linear[i]);
        let value = mid_deflection(CubicBeam2::new(length, &section, &material), n);
        assert_printed(&format!("cubic, {n}"), 1e3 * value, cubic[i]);
    }
}

/// Table 2.1. Printed for 32 and 64 cubic elements: -0.097005 and -0.097078.
#[test]
fn table_2_1_simply_supported_without_poisson() {
    check_deflections(
        0.0,
        [
            "-0.073043",
            "-0.091159",
            "-0.095688",
            "-0.096821",
            "-0.097104",
            "-0.097174",
        ],
        [
            "-0.072893",
            "-0.091034",
            "-0.095578",
            "-0.096717",
            "-0.0970035",
            "-0.0970761",
        ],
    );
}

/// Table 2.2.
#[test]
fn table_2_2_simply_supported_with_poisson() {
    check_deflections(
        0.3,
        [
            "-0.073217",
            "-0.091333",
            "-0.095862",
            "-0.096995",
            "-0.097278",
            "-0.097348",
        ],
        [
            "-0.054388",
            "-0.067879",
            "-0.071262",
            "-0.072112",
            "-0.072327",
            "-0.072382",
        ],
    );
}

fn check_tips(height: f64, poisson_ratio: f64, linear: [[&str; 2]; 6], cubic: [[&str; 2]; 6]) {
    let section = PlanarSection::rectangle(0.1, height);
    let material = material(poisson_ratio);
    let load = 5.0e8 * height.powi(3);
    for (i, n) in ELEMENTS.into_iter().enumerate() {
        let length = LENGTH / n as f64;
        let linear_tip = tip(LinearBeam2::new(length, &section, &material), n, load, 0.0);
        let cubic_tip = tip(CubicBeam2::new(length, &section, &material), n, load, 0.0);
        for axis in 0..2 {
            assert_printed(&format!("linear, {n}"), linear_tip[axis], linear[i][axis]);
            assert_printed(&format!("cubic, {n}"), cubic_tip[axis], cubic[i][axis]);
        }
    }
}

/// Table 2.3: cantilever, height 0.1 m, nu = 0.3.
#[test]
fn table_2_3_cantilever_model_1() {
    check_tips(
        0.1,
        0.3,
        [
            ["1.88480", "-0.62126"],
            ["1.86351", "-0.66320"],
            ["1.85696", "-0.67691"],
            ["1.85537", "-0.68018"],
            ["1.85500", "-0.68091"],
            ["1.85491", "-0.68109"],
        ],
        [
            ["1.95536", "-0.37731"],
            ["1.91970", "-0.50932"],
            ["1.91344", "-0.53035"],
            ["1.91276", "-0.53267"],
            ["1.91264", "-0.53309"],
            ["1.91262", "-0.53319"],
        ],
    );
}

/// Table 2.4: cantilever, height 0.5 m, nu = 0.
#[test]
fn table_2_4_cantilever_model_2() {
    check_tips(
        0.5,
        0.0,
        [
            ["1.87307", "-0.65134"],
            ["1.85001", "-0.69591"],
            ["1.84412", "-0.70709"],
            ["1.84271", "-0.70970"],
            ["1.84237", "-0.71034"],
            ["1.84228", "-0.71050"],
        ],
        [
            ["1.86909", "-0.64098"],
            ["1.84841", "-0.69436"],
            ["1.84498", "-0.70341"],
            ["1.84407", "-0.70573"],
            ["1.84378", "-0.70643"],
            ["1.84367", "-0.70667"],
        ],
    );
}

/// Linearised, the linear beam's mid-span deflection is known in closed form:
/// `-[P L³ / (48 E I) (1 - 1/n²) + P L / (4 ks G A)]`. The tolerance is the round-off of a solution with
/// condition number 1e6.
#[test]
fn linear_beam_has_its_closed_form() {
    let section = PlanarSection::rectangle(0.1, 0.1);
    for poisson_ratio in [0.0, 0.3] {
        let material = material(poisson_ratio);
        let shear = 5.0 / 6.0 * material.shear_modulus() * section.area;
        for n in ELEMENTS {
            let element = LinearBeam2::new(LENGTH / n as f64, &section, &material);
            let beam = simply_supported(element, n);
            let change = beam.linear_displacements().expect("it is supported");
            let value = beam.position(&change, n / 2)[1];
            let bending = 1000.0 * LENGTH.powi(3) / (48.0 * YOUNGS * section.second_moment);
            let expected =
                -(bending * (1.0 - (n as f64).powi(-2)) + 1000.0 * LENGTH / (4.0 * shear));
            assert!(
                (value / expected - 1.0).abs() < 1e-9,
                "{n} elements: {value} {expected}"
            );
        }
    }
}

/// A cantilever drawn at an angle, its load turned with it, bends to the turned answer.
#[test]
fn a_turned_beam_gives_the_turned_answer() {
    let section = PlanarSection::rectangle(0.1, 0.1);
    let material = material(0.3);
    let linear = LinearBeam2::new(LENGTH / 4.0, &section, &material);
    let cubic = CubicBeam2::new(LENGTH / 4.0, &section, &material);
    let straight = [
        tip(linear.clone(), 4, 5e5, 0.0),
        tip(cubic.clone(), 4, 5e5, 0.0),
    ];
    for degrees in [30.0f64, 45.0, 90.0] {
        let angle = degrees.to_radians();
        let turned = [
            tip(linear.clone(), 4, 5e5, angle),
            tip(cubic.clone(), 4, 5e5, angle),
        ];
        for (straight, turned) in straight.iter().zip(&turned) {
            let (sine, cosine) = angle.sin_cos();
            let expected = [
                cosine * straight[0] - sine * straight[1],
                sine * straight[0] + cosine * straight[1],
            ];
            for axis in 0..2 {
                assert!((turned[axis] - expected[axis]).abs() < 1e-10);
            }
        }
    }
}
