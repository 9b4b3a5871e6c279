//! V-belts: the sink under tension and the transmissible torque against closed forms.

use rayon::prelude::*;

use super::time_run::TimeRun;
use super::{CaseError, Quantities};
use crate::observe::ProfileRow;

const EXAMPLE: &str = include_str!("../../../../examples/v_belt.toml");

/// The belt rests in the grooves, without friction.
const AT_REST: [&str; 6] = [
    "pulley.driver.speed=0.0",
    "contact.friction.coefficient=0.0",
    "run.end_time=1e-3",
    "run.output_interval=1e-3",
    "belt.elements=120",
    "belt.bending_factor=1e-3",
];

/// Sinks on both pulleys over (V6), with flanks and belts of three stiffnesses.
pub(super) fn sink() -> Result<Quantities, CaseError> {
    let mut quantities = Quantities::new();
    for (name, change) in [
        ("as in the example", "belt.youngs_modulus=4e8"),
        ("softer flanks", "contact.stiffness=4e9"),
        ("softer belt", "belt.youngs_modulus=1e8"),
    ] {
        let run = TimeRun::new(EXAMPLE, &[&AT_REST[..], &[change]].concat())?;
        for (p, pulley) in ["45 mm", "60 mm"].into_iter().enumerate() {
            quantities.push((
                format!("{name}, radius {pulley}"),
                sink_over_theory(&run, p)?,
            ));
        }
    }
    Ok(quantities)
}

fn sink_over_theory(run: &TimeRun, p: usize) -> Result<f64, CaseError> {
    let (drive, arc) = (&run.drive, &run.outcome.layout.arcs[p]);
    let (Some(section), Some(angle)) = (drive.trapezoid(), drive.pulley[p].groove_angle) else {
        return Err(CaseError::DoesNotRun);
    };
    let (sine, cosine) = (0.5 * angle).sin_cos();
    // The inner half of the arc.
    let rows: Vec<&ProfileRow> = (run.outcome.profile.iter())
        .filter(|row| {
            let angle = (row.y - arc.center[1]).atan2(row.x - arc.center[0]) - arc.start_angle;
            let part = angle.rem_euclid(std::f64::consts::TAU) / arc.sweep;
            row.pulley == drive.pulley[p].name && (0.25..0.75).contains(&part)
        })
        .collect();
    let mean = |value: &dyn Fn(&ProfileRow) -> f64| {
        rows.iter().map(|row| value(row)).sum::<f64>() / rows.len() as f64
    };
    let place = mean(&|row| (row.x - arc.center[0]).hypot(row.y - arc.center[1]));
    let (tension, stretch) = (
        mean(&|row| row.tension),
        mean(&|row| 1.0 + row.strain_engineering),
    );
    let on_a_flank = tension * stretch / (2.0 * place * sine);
    let depth = on_a_flank / (drive.contact.stiffness * section.flank());
    let width = section.width_at(section.middle);
    let narrowing = on_a_flank * cosine * width / (drive.belt.youngs_modulus * section.area());
    Ok((arc.radius - place) / ((depth + 0.5 * width * narrowing * cosine) / sine))
}

/// A larger drive, loaded until it slips.
const OVERLOADED: [&str; 9] = [
    "belt.elements=60",
    "pulley.driver.radius=0.1",
    "pulley.driven.radius=0.12",
    "pulley.driver.center=[-0.25, 0.0]",
    "pulley.driven.center=[0.25, 0.0]",
    "pulley.driven.inertia=0.05",
    "pulley.driver.speed={ kind = \"half-cosine\", from = 0.0, to = 60.0, start = 0.0, end = 0.1 }",
    "run.end_time=0.4",
    "run.output_interval=0.5e-3",
];

/// Passage of two elements after the onset of slip [s].
const PASSAGE: f64 = 0.01;
/// Part of the contact that slips where all does: one of its 36 to 54 points along the belt is two hundredths of it.
const WHOLE: f64 = 0.99;

struct Overload {
    name: &'static str,
    coefficient: f64,
    /// Load at the end of the ramp, a third above what the drive transmits [N m].
    load: &'static str,
    changes: &'static [&'static str],
}

const OVERLOADS: [Overload; 4] = [
    // A fifth of the tension turns the belt around the pulleys.
    Overload {
        name: "36 degrees, mu 0.15, 25 m/s",
        coefficient: 0.15,
        load: "-50",
        changes: &[
            "belt.tension=300",
            "belt.elements=40",
            "pulley.driven.inertia=0.005",
            "pulley.driver.speed.to=250",
        ],
    },
    Overload {
        name: "36 degrees, mu 0.15",
        coefficient: 0.15,
        load: "-60",
        changes: &["belt.tension=300"],
    },
    Overload {
        name: "36 degrees, mu 0.15, stiffer flanks",
        coefficient: 0.15,
        load: "-100",
        changes: &[
            "belt.tension=600",
            "belt.youngs_modulus=4e9",
            "belt.bending_factor=2e-3",
            "contact.stiffness=3e10",
        ],
    },
    Overload {
        name: "60 degrees, mu 0.2",
        coefficient: 0.2,
        load: "-50",
        changes: &[
            "belt.tension=300",
            "pulley.driver.groove_angle=\"60 deg\"",
            "pulley.driven.groove_angle=\"60 deg\"",
        ],
    },
];

/// Drives loaded until the belt slips all around the smaller pulley: tensions and torque then.
pub(super) fn transmissible_torque() -> Result<Quantities, CaseError> {
    let found: Result<Vec<Quantities>, CaseError> = OVERLOADS.par_iter().map(onset).collect();
    Ok(found?.concat())
}

fn onset(overload: &Overload) -> Result<Quantities, CaseError> {
    let load = format!(
        "pulley.driven.torque={{ kind = \"ramp\", from = 0.0, to = {}, start = 0.1, end = 0.4 }}",
        overload.load
    );
    let coefficient = format!("contact.friction.coefficient={}", overload.coefficient);
    let changes = [&OVERLOADED[..], overload.changes, &[&load, &coefficient]].concat();
    let unloaded: String = (EXAMPLE.lines())
        .filter(|line| !line.starts_with("load ="))
        .flat_map(|line| [line, "\n"])
        .collect();
    let run = TimeRun::new(&unloaded, &changes)?;
    // All of the contact slips, and goes on to.
    let (times, slips) = (run.column("time")?, run.column("driver.slip_angle")?);
    let contacts = run.column("driver.contact_angle")?;
    let wrap = run.outcome.layout.arcs[0].sweep;
    let lasting = |first: usize| {
        let until = times[first] + PASSAGE;
        let mut rows = (first..times.len()).take_while(|row| times[*row] <= until);
        until < times[times.len() - 1] && rows.all(|row| slips[row] > WHOLE * contacts[row])
    };
    let start = (0..times.len())
        .find(|first| times[*first] > 0.12 && lasting(*first))
        .map(|first| times[first])
        .ok_or(CaseError::DoesNotRun)?;
    let window = [start, start + PASSAGE];
    let slack = run.pressing_tension("driver-driven", window)?;
    let tight = run.pressing_tension("driven-driver", window)?;
    let angle = run.drive.pulley[0]
        .groove_angle
        .ok_or(CaseError::DoesNotRun)?;
    let law = (overload.coefficient * wrap / (0.5 * angle).sin()).exp();
    let torque = run.drive.pulley[1].radius * (tight + slack) * (law - 1.0) / (law + 1.0);
    let name = overload.name;
    Ok(vec![
        (
            format!("{name}: tension ratio at the onset of gross slip over theory"),
            tight / slack / law,
        ),
        (
            format!("{name}: torque on the driven pulley then over theory"),
            run.mean("driven.torque", window)?.abs() / torque,
        ),
    ])
}
