//! The belts of plates, Models 1 and 2 of Table 4.1: Figs 4.10-4.18.

use ancf::strain::Fibre;
use rayon::prelude::*;

use super::time_run::TimeRun;
use super::{CaseError, Quantities};
use crate::input;
use crate::observe::ProfileRow;
use crate::steady::drive_string::DriveString;
use crate::steady::string::{Answer, Closure, Model, Running};

const MODEL_1: &str = include_str!("../../../../examples/plate_model_1.toml");
const MODEL_2: &str = include_str!("../../../../examples/plate_model_2.toml");
const STRING: &str = include_str!("../../../../examples/string_model_2.toml");

/// The driver of Model 1 has come up to speed.
const AFTER_THE_RAMP: f64 = 0.65;
/// The ramp of Model 1 after its first swing [s].
const LATE_RAMP: [f64; 2] = [0.2, 0.6];
/// The end of Model 1.
const FOLLOWING: [f64; 2] = [0.8, 1.0];

fn all(text: &str, variants: &[&[&str]]) -> Result<Vec<TimeRun>, CaseError> {
    (variants.par_iter())
        .map(|changes| TimeRun::new(text, changes))
        .collect()
}

/// Largest difference of the driven speeds from a time on [rad/s].
fn difference(a: &TimeRun, b: &TimeRun, from: f64) -> Result<f64, CaseError> {
    let window = [from, f64::INFINITY];
    let (a, b) = (
        a.window("driven.speed", window)?,
        b.window("driven.speed", window)?,
    );
    let apart = a.iter().zip(&b).map(|(a, b)| (a - b).abs());
    Ok(apart.fold(0.0, f64::max))
}

/// Where the first node of 16 elements starts, by quarters of an element: path length from mid-wrap of the driver [m].
const STARTS: [&str; 3] = [
    "belt.first_node=0.01963495",
    "belt.first_node=0.03926991",
    "belt.first_node=0.05890486",
];

/// Model 1 with 16, 32 and 48 elements.
pub(super) fn figure_4_10() -> Result<Quantities, CaseError> {
    let runs = all(
        MODEL_1,
        &[
            &[],
            &["belt.elements=32"],
            &["belt.elements=48"],
            &[STARTS[0]],
            &[STARTS[1]],
            &[STARTS[2]],
        ],
    )?;
    let fine = runs[2].column("driven.speed")?;
    let mut sum = runs[0].column("driven.speed")?;
    for run in &runs[3..] {
        for (sum, speed) in sum.iter_mut().zip(run.column("driven.speed")?) {
            *sum += speed;
        }
    }
    let starts = 4.0;
    let apart = sum
        .iter()
        .zip(&fine)
        .map(|(sum, b)| (sum / starts - b).abs());
    let of_starts = apart.fold(0.0, f64::max);
    let lag = runs[0].mean("driver.speed", LATE_RAMP)? - runs[0].mean("driven.speed", LATE_RAMP)?;
    Ok(vec![
        ("driven behind driver in the ramp".to_owned(), lag),
        (
            "driven less driver, mean from 0.8 to 1.0 s".to_owned(),
            runs[0].mean("driven.speed", FOLLOWING)? - runs[0].mean("driver.speed", FOLLOWING)?,
        ),
        (
            "32 from 48 elements, whole run".to_owned(),
            difference(&runs[1], &runs[2], 0.0)?,
        ),
        (
            "16 from 48 elements after the ramp".to_owned(),
            difference(&runs[0], &runs[2], AFTER_THE_RAMP)?,
        ),
        (
            "16 from 48 elements, whole run".to_owned(),
            difference(&runs[0], &runs[2], 0.0)?,
        ),
        (
            "16 from 48 elements, whole run, mean of four starts".to_owned(),
            of_starts,
        ),
    ])
}

/// The drive of plates `text` as one of belt beams: the same but for what only plates have.
fn planar(text: &str) -> String {
    const OF_PLATES: [&str; 3] = ["elements_across", "bending", "profile_line"];
    let lines = text.lines();
    let shared = lines.filter(|line| !OF_PLATES.iter().any(|field| line.starts_with(field)));
    shared.flat_map(|line| [line, "\n"]).collect()
}

/// What contact takes per area of plates, per length of beams 80 mm and 40 mm wide.
const PER_LENGTH_1: [&str; 4] = [
    "belt.element=belt-beam",
    "contact.stiffness=8e5",
    "contact.damping=160",
    "contact.friction.slope=8e3",
];
const PER_LENGTH_2: [&str; 4] = [
    "belt.element=belt-beam",
    "contact.stiffness=3.2e6",
    "contact.damping=80",
    "contact.friction.slope=8e3",
];
/// Models of nu = 0; Model 1 as it is and half as thick with the same E A and mass; Model 2 a membrane, its beams next
/// to one.
const THICK: [&str; 2] = ["belt.poisson_ratio=0", "belt.elements=48"];
const THIN: [&str; 5] = [
    "belt.poisson_ratio=0",
    "belt.elements=48",
    "belt.thickness=5 mm",
    "belt.youngs_modulus=20 MPa",
    "belt.density=2072",
];
const MEMBRANE: [&str; 1] = ["belt.bending_factor=1e-3"];

/// Belts of plates and of belt beams where they are the same belt.
pub(super) fn planar_drives() -> Result<Quantities, CaseError> {
    let as_beams = [planar(MODEL_1), planar(MODEL_2)];
    let coarse = ["belt.poisson_ratio=0", END, COARSER];
    let changes = [
        (MODEL_1, THICK.to_vec()),
        (&as_beams[0], [&THICK[..], &PER_LENGTH_1].concat()),
        (MODEL_1, THIN.to_vec()),
        (&as_beams[0], [&THIN[..], &PER_LENGTH_1].concat()),
        (MODEL_2, coarse.to_vec()),
        (
            &as_beams[1],
            [&coarse[..], &MEMBRANE, &PER_LENGTH_2].concat(),
        ),
    ];
    let runs = (changes.par_iter())
        .map(|(text, changes)| TimeRun::new(text, changes))
        .collect::<Result<Vec<TimeRun>, CaseError>>()?;
    let [
        plates_1,
        beams_1,
        thin_plates,
        thin_beams,
        plates_2,
        beams_2,
    ] = runs.as_slice()
    else {
        return Err(CaseError::DoesNotRun);
    };
    let tighter = |plates: &TimeRun, beams: &TimeRun| {
        let belt = &plates.drive.belt;
        let rigidity = belt.youngs_modulus * belt.width * belt.thickness.powi(3) / 12.0;
        let coupling = rigidity / plates.drive.pulley[0].radius.powi(2);
        (plates.outcome.start.tension - beams.outcome.start.tension) / coupling
    };
    let model_2 = plates_2.mean("driven.speed", STEADY)? - beams_2.mean("driven.speed", STEADY)?;
    Ok(vec![
        (
            "Model 1, driven speed, whole run".to_owned(),
            difference(plates_1, beams_1, 0.0)? / 12.0 * 100.0,
        ),
        (
            "Model 1, tension at rest, over E I / R2".to_owned(),
            tighter(plates_1, beams_1),
        ),
        (
            "Model 1 half as thick, driven speed, whole run".to_owned(),
            difference(thin_plates, thin_beams, 0.0)? / 12.0 * 100.0,
        ),
        (
            "Model 1 half as thick, tension at rest, over E I / R2".to_owned(),
            tighter(thin_plates, thin_beams),
        ),
        (
            "Model 2, driven speed, mean".to_owned(),
            model_2.abs() / 500.0 * 100.0,
        ),
    ])
}

/// What "50 N" may mean: E A times Green's strain, E A times the engineering strain, the true force.
const READINGS: [(&str, &str); 3] = [
    ("E A Green's strain", "belt.strain=0.22474487139158905"),
    ("E A engineering strain", "belt.strain=0.25"),
    ("true force", "belt.strain=0.19148788395311866"),
];
/// Model 2 runs steadily.
const STEADY: [f64; 2] = [1.15, 1.3];
const END: &str = "run.end_time=1.3";
/// Steps twice as long as by default move the speed loss by 0.02 points.
const COARSER: &str = "run.accuracy=4e-3";
/// Belts seen in the steady window, not in step with the passage of elements.
const PROFILES: u32 = 30;
/// Parts of an arc over which forces are averaged.
const SECTIONS: usize = 24;
/// Rows along the string, about: 3e-3 rad apart.
const STRING_ROWS: usize = 4000;

/// Model 2: a run and what its records say.
struct Model2 {
    run: TimeRun,
    /// Surface speeds times radii are equal, so that of the driver is that of both.
    radius: f64,
    /// E A [N].
    stiffness: f64,
}

impl Model2 {
    fn new(run: TimeRun) -> Self {
        let belt = &run.drive.belt;
        Self {
            radius: run.drive.pulley[0].radius,
            stiffness: belt.youngs_modulus * belt.width * belt.thickness,
            run,
        }
    }

    /// Loss of the driven pulley's speed [%].
    fn loss(&self) -> Result<f64, CaseError> {
        let driven = self.run.mean("driven.speed", STEADY)?;
        Ok(100.0 * (1.0 - driven / self.run.mean("driver.speed", STEADY)?))
    }

    fn friction_torque(&self) -> Result<f64, CaseError> {
        self.run.mean("driven.torque", STEADY)
    }

    /// Rows of the profiles in the middle halves of the span from one pulley to the next.
    fn span(&self, p: usize) -> impl Iterator<Item = &ProfileRow> {
        let span = &self.run.outcome.layout.spans[p];
        let (start, end, length) = (span.start, span.end, span.length);
        self.run.outcome.profile.iter().filter(move |row| {
            let along =
                (row.x - start[0]) * (end[0] - start[0]) + (row.y - start[1]) * (end[1] - start[1]);
            let part = along / (length * length);
            let beside =
                (row.x - start[0]) * (end[1] - start[1]) - (row.y - start[1]) * (end[0] - start[0]);
            row.pulley.is_empty()
                && (0.25..=0.75).contains(&part)
                && beside.abs() < 0.1 * length * length
        })
    }

    fn mean(&self, p: usize, value: impl Fn(&ProfileRow) -> f64) -> f64 {
        let (sum, count) = (self.span(p)).fold((0.0, 0_u32), |(sum, count), row| {
            (sum + value(row), count + 1)
        });
        sum / f64::from(count)
    }

    /// Tight less slack span, times the radius [N m], of a measure of tension.
    fn torque(&self, tension: impl Fn(&ProfileRow) -> f64) -> f64 {
        let (slack, tight) = (self.mean(0, &tension), self.mean(1, &tension));
        (tight - slack) * self.radius
    }

    /// That of E A times a measure of strain.
    fn torque_of(&self, strain: impl Fn(Fibre) -> f64) -> f64 {
        self.torque(|row| {
            let fibre = Fibre {
                green: row.strain_green,
            };
            self.stiffness * strain(fibre)
        })
    }
}

/// Model 2 in three readings of the initial 50 N, and with twice as many elements.
pub(super) fn figures_4_12_to_4_18() -> Result<Quantities, CaseError> {
    let span = STEADY[1] - STEADY[0];
    let times: Vec<String> = (0..PROFILES)
        .map(|i| {
            let part = (f64::from(i) + 0.37 * f64::from(i % 3)) / f64::from(PROFILES);
            format!("{:.6}", STEADY[0] + 0.99 * part * span)
        })
        .collect();
    let profiles = format!("run.profile_times=[{}]", times.join(", "));
    let [green, engineering, force] = READINGS.map(|(_, strain)| strain);
    let runs = all(
        MODEL_2,
        &[
            &[END, COARSER, &profiles, green, "belt.elements=40"],
            &[END, COARSER, &profiles, green],
            &[END, COARSER, &profiles, engineering],
            &[END, COARSER, &profiles, force],
        ],
    )?;
    let models: Vec<Model2> = runs.into_iter().map(Model2::new).collect();
    let [fine, recommended, ..] = models.as_slice() else {
        return Err(CaseError::DoesNotRun);
    };
    let full = Analytical::new(Model::Full)?;
    let capstan = Analytical::new(Model::Capstan)?;
    let mut quantities = Quantities::new();
    for (model, (reading, _)) in models[1..].iter().zip(READINGS) {
        quantities.extend([
            (format!("speed loss, 50 N as {reading}"), model.loss()?),
            (
                format!("torque of E A Green's strain, 50 N as {reading}"),
                model.torque_of(|fibre| fibre.green),
            ),
            (
                format!("torque of E A engineering strain, 50 N as {reading}"),
                model.torque_of(|fibre| fibre.engineering()),
            ),
            (
                format!("torque of E A true strain, 50 N as {reading}"),
                model.torque_of(|fibre| fibre.by_deformed_length()),
            ),
            (
                format!("torque of E A Almansi's strain, 50 N as {reading}"),
                model.torque_of(|fibre| fibre.almansi()),
            ),
            (
                format!("torque of the true axial force, 50 N as {reading}"),
                model.torque(|row| row.tension),
            ),
            (
                format!("friction torque on the driven pulley, 50 N as {reading}"),
                model.friction_torque()?,
            ),
        ]);
    }
    let slack_speed = recommended.mean(0, |row| row.speed);
    let pressing = recommended.run.rows_on(1).map(|row| row.normal_force);
    quantities.extend([
        (
            "speed loss, 40 less 20 elements".to_owned(),
            fine.loss()? - recommended.loss()?,
        ),
        (
            "det J, tight span".to_owned(),
            recommended.mean(1, |row| row.jacobian),
        ),
        (
            "det J, slack span".to_owned(),
            recommended.mean(0, |row| row.jacobian),
        ),
        (
            "slack span over the analytical one, speed".to_owned(),
            slack_speed / full.slack_speed(),
        ),
        (
            "least normal force on the driven pulley".to_owned(),
            pressing.fold(f64::INFINITY, f64::min),
        ),
    ]);
    let [from_full, from_capstan] = [&full, &capstan].map(|string| string.distances(recommended));
    for (i, force) in ["normal", "friction"].into_iter().enumerate() {
        quantities.extend([
            (
                format!("{force} force, distance from the full model"),
                from_full[i],
            ),
            (
                format!("{force} force, distance from the capstan model over that"),
                from_capstan[i] / from_full[i],
            ),
        ]);
    }
    Ok(quantities)
}

/// The extensible string with inertia.
struct Analytical {
    string: DriveString,
    running: Running,
}

impl Analytical {
    fn new(model: Model) -> Result<Self, CaseError> {
        let drive = input::parse("string_model_2.toml", STRING, &[])?;
        let string = DriveString::new(&drive, model, Closure::UnstretchedLength)?;
        let Answer::Running(running) = string.solve()? else {
            return Err(CaseError::DoesNotRun);
        };
        Ok(Self { string, running })
    }

    /// Speed of the slack span [m/s].
    fn slack_speed(&self) -> f64 {
        let spans = self.string.spans(&self.running);
        spans
            .iter()
            .fold(f64::INFINITY, |v, span| v.min(span.speed))
    }

    /// Root mean square, over both pulleys, of what normal and friction force of `model` lie beside those of the
    /// string [N/m].
    fn distances(&self, model: &Model2) -> [f64; 2] {
        let rows = self.string.profile(&self.running, STRING_ROWS);
        let run = &model.run;
        let (mut squares, mut count) = ([0.0; 2], 0_u32);
        for (p, pulley) in run.drive.pulley.iter().enumerate() {
            let on_pulley: Vec<(f64, &ProfileRow)> = (rows.iter())
                .filter(|row| row.pulley == pulley.name)
                .map(|row| (run.angle(p, row), row))
                .collect();
            for section in run.sections(p, SECTIONS, 0.0) {
                let beside = |angle: f64| (angle - section.angle).abs();
                let nearest = on_pulley
                    .iter()
                    .min_by(|a, b| beside(a.0).total_cmp(&beside(b.0)));
                if let Some((_, row)) = nearest {
                    squares[0] += (section.normal_force - row.normal_force).powi(2);
                    squares[1] += (section.friction_force - row.friction_force).powi(2);
                    count += 1;
                }
            }
        }
        squares.map(|square| (square / f64::from(count)).sqrt())
    }
}
