//! Derivatives by drive-file fields against differences of whole solutions, through `--set`.

use crate::drive::Drive;
use crate::input::{self, Override};
use crate::steady::drive_string::DriveString;
use crate::steady::string::{Closure, Model};

const HEAD: &str = r#"
[belt]
elements = 40
TIGHTNESS
width = 0.02
thickness = 0.004
density = 1100.0
youngs_modulus = 3.0e8
axial_factor = 0.9
[contact]
stiffness = 1.0e8
friction = { law = "creep-rate", coefficient = 0.8, slope = 1.0e5 }
"#;

/// A drive from lines `name x y radius wrap motion`.
fn drive(tightness: &str, pulleys: &[&str]) -> String {
    let mut text = HEAD.replace("TIGHTNESS", tightness);
    for line in pulleys {
        let words: Vec<_> = line.splitn(6, ' ').collect();
        let [name, x, y, radius, wrap, motion] = words[..] else {
            panic!("{line}")
        };
        let table = format!(
            "[[pulley]]\nname = \"{name}\"\ncenter = [{x}, {y}]\nradius = {radius}\nwrap = \"{wrap}\"\n\
             inertia = 0.01\n{motion}\n"
        );
        text.push_str(&table);
    }
    text
}

/// A ring of ten, four of them on the belt's back, two of them idlers, one that drives along.
fn ten(tightness: &str, speed: f64) -> String {
    let driver = format!("crank 0.0 0.01 0.06 inside speed = {speed}");
    let sign = if speed > 0.0 { -1.0 } else { 1.0 };
    let load = |torque: f64| format!("torque = {}", sign * torque);
    let lines = [
        driver,
        "back1 0.25 -0.07 0.03 outside torque = 0.0".to_owned(),
        format!("pump 0.5 -0.02 0.05 inside {}", load(2.0)),
        format!("fan 0.8 0.0 0.05 inside {}", load(1.5)),
        format!("back2 0.87 0.3 0.04 outside {}", load(-1.0)),
        format!("alternator 0.82 0.6 0.06 inside {}", load(3.0)),
        "back3 0.55 0.67 0.03 outside torque = 0.0".to_owned(),
        format!("steering 0.3 0.62 0.05 inside {}", load(-0.5)),
        format!("compressor 0.0 0.61 0.05 inside {}", load(2.5)),
        format!("back4 -0.06 0.3 0.03 outside {}", load(-0.2)),
    ];
    drive(tightness, &lines.each_ref().map(String::as_str))
}

fn read(text: &str, changes: &[String]) -> Drive {
    let changes: Vec<Override> = changes
        .iter()
        .map(|change| change.parse().unwrap())
        .collect();
    input::parse("test.toml", text, &changes).unwrap()
}

/// Every field by central differences at two steps, 1e-5 and 2e-5 of the field, extrapolated: the
/// truncation is of the fourth order, the solutions carry 1e-12 of round-off, 1e-7 of the
/// derivative's scale by the step; a decade to spare.
#[test]
fn derivatives_match_differences_of_whole_drives() {
    let crossed = [
        "a -0.2 0.05 0.06 inside speed = 90.0",
        "b 0.25 -0.03 0.09 outside torque = 5.0",
    ];
    // Grooves, another friction on the belt's back, the centre line half a thickness out.
    let grooved = ten("tension = 600.0", 80.0)
        .replace(
            "[contact]",
            "[contact]\nsurface = \"face\"\nback_friction = { law = \"stribeck\", static_coefficient = 0.6, \
             sliding_coefficient = 0.5, stribeck_velocity = 0.1, velocity = 0.01 }",
        )
        .replace("wrap = \"inside\"", "wrap = \"inside\"\ngroove_angle = 1.2");
    let cases = [
        (grooved, Closure::UnstretchedLength),
        (ten("tension = 600.0", 80.0), Closure::UnstretchedLength),
        (ten("strain = 0.02", -80.0), Closure::UnstretchedLength),
        (ten("length = 2.72", 80.0), Closure::TensionSum),
        (drive("strain = 0.01", &crossed), Closure::UnstretchedLength),
    ];
    for (text, closure) in cases {
        for model in [Model::Full, Model::Centrifugal, Model::Capstan] {
            let prepared = DriveString::new(&read(&text, &[]), model, closure).unwrap();
            let all: Vec<_> = (0..prepared.inputs().len()).collect();
            let exact = prepared.sensitivity(&all).unwrap().expect("runs");
            assert!(exact.inputs.len() == all.len());
            for input in &exact.inputs {
                // Centres on an axis have no size of their own.
                let size = if input.value == 0.0 {
                    0.1
                } else {
                    input.value.abs()
                };
                let step = 1.0e-5 * size;
                let at = |shift: f64| {
                    let change = format!("{}={:?}", input.key, input.value + shift);
                    let moved = DriveString::new(&read(&text, &[change]), model, closure).unwrap();
                    let sensitivity = moved.sensitivity(&[]).unwrap().expect("runs");
                    sensitivity.outputs
                };
                let moved = [-2.0, -1.0, 1.0, 2.0].map(|factor| at(factor * step));
                for (r, output) in exact.outputs.iter().enumerate() {
                    let value = |i: usize| moved[i][r].value;
                    let narrow = (value(2) - value(1)) / (2.0 * step);
                    let wide = (value(3) - value(0)) / (4.0 * step);
                    let mut difference = (4.0 * narrow - wide) / 3.0;
                    if input.value == 0.0 && input.unit == "N m" {
                        // An idler's slip has a kink: the derivative is that towards braking.
                        let speed = input.key.replace("torque", "speed");
                        let speed = exact.outputs.iter().find(|o| o.name == speed).unwrap();
                        let rise = if speed.value < 0.0 {
                            4.0 * value(2) - value(3) - 3.0 * output.value
                        } else {
                            value(0) - 4.0 * value(1) + 3.0 * output.value
                        };
                        difference = rise / (2.0 * step);
                    }
                    let derivative = input.derivatives[r];
                    let scale = derivative.abs().max(output.value.abs() / size);
                    // What is zero on idlers carries the round-off of its kind: 1e-16 by the step.
                    let kind = exact.outputs.iter().filter(|o| o.unit == output.unit);
                    let largest = kind.map(|o| o.value.abs()).fold(0.0, f64::max);
                    let allowed = 1.0e-6 * scale + 1.0e-10 * largest / size;
                    assert!(
                        (difference - derivative).abs() <= allowed,
                        "{model:?} {} by {}: {derivative} {difference}",
                        output.name,
                        input.key
                    );
                }
            }
        }
    }
}

/// A steady drive of any size is the same drive: all lengths times s, forces times s², torques times s³
/// at equal surface speeds. So, by Euler's theorem, the elasticities of a speed loss by lengths (1, the
/// belt's too), tension (2), torques (3) and the driver's speed (-1) sum to zero.
#[test]
fn elasticities_obey_the_scaling_of_size() {
    let text = ten("tension = 600.0", 80.0);
    let prepared =
        DriveString::new(&read(&text, &[]), Model::Full, Closure::UnstretchedLength).unwrap();
    let all: Vec<_> = (0..prepared.inputs().len()).collect();
    let found = prepared.sensitivity(&all).unwrap().expect("runs");
    let degree = |unit: &str| match unit {
        "m" => 1.0,
        "N" => 2.0,
        "N m" => 3.0,
        "rad/s" => -1.0,
        _ => 0.0,
    };
    for (r, output) in found.outputs.iter().enumerate() {
        let terms: Vec<f64> = found
            .inputs
            .iter()
            .map(|input| degree(input.unit) * input.derivatives[r] * input.value)
            .collect();
        let sum: f64 = terms.iter().sum();
        // Power is force by speed; a result of zero has no scale but that of its terms.
        let own = match output.unit {
            "W" => 2.0,
            unit => degree(unit),
        };
        let scale = terms
            .iter()
            .fold(output.value.abs(), |most, term| most.max(term.abs()));
        assert!(
            (sum - own * output.value).abs() <= 1.0e-9 * scale,
            "{}: {sum} {}",
            output.name,
            own * output.value
        );
    }
}

#[test]
fn unknown_keys_are_named_with_the_nearest() {
    let prepared = DriveString::new(
        &read(&ten("tension = 600.0", 80.0), &[]),
        Model::Full,
        Closure::UnstretchedLength,
    )
    .unwrap();
    let find = |key: &str| prepared.find_inputs(&[key.to_owned()]);
    assert_eq!(find("pulley.crank.radius"), find("pulley.0.radius"));
    assert!(find("pulley.pump.torque").is_ok() && find("pulley.crank.speed").is_ok());
    let error = find("pulley.pump.radios").unwrap_err();
    assert_eq!(error.nearest.as_deref(), Some("pulley.pump.radius"));
    assert!(error.to_string().contains("pulley.pump.radios"));
    assert!(find("belt.bending_factor").is_err());
    assert!(find("belt.length").is_err(), "the file gives the tension");
}
