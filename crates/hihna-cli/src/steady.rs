//! `hihna steady`: what a drive settles to, by the extensible string with inertia.

use std::f64::consts::PI;
use std::fmt::Write;
use std::path::PathBuf;

use clap::{Args, ValueEnum};
use hihna::drive::{Drive, Friction};
use hihna::input::{self, FieldPath, InputError, InputErrors, Problem};
use hihna::record::Folder;
use hihna::steady::drive_string::{DriveString, PulleySummary, SpanSummary, SteadyError};
use hihna::steady::string::{
    Answer, Capacity, Closure, GrossSlip, Model, Role, Running, Tightness,
};
use hihna::summary::Named;
use serde::Serialize;

use crate::diagnostics::{Failure, print_warning};
use crate::drive_source::DriveSource;
use crate::quantities::{percent, plain, with_prefix};
use crate::standard_output;
use crate::tables::columns;

/// Rows of `profile.csv`, about.
const PROFILE_ROWS: usize = 500;
/// Radians per second of one turn per minute.
const RPM: f64 = PI / 30.0;

/// Find what a drive settles to, by the theory of the extensible string, and print speeds, torques,
/// tensions, slip and efficiency.
///
/// Speeds and torques are those that the profiles of the drive file end with. Bending, contact
/// stiffness and gravity play no part, and of the friction law only the coefficient. A drive that
/// slips as a whole or goes slack is an answer, too: the exit status is 0.
#[derive(Debug, Args)]
pub struct Arguments {
    #[command(flatten)]
    source: DriveSource,

    /// Which inertia of the belt counts
    #[arg(long, value_enum, default_value_t = ModelName::Full)]
    model: ModelName,

    /// What stays as it is when the belt starts to run
    #[arg(long, value_enum, default_value_t = ClosureName::Length)]
    closure: ClosureName,

    /// Folder for drive.toml, summary.json and, of a drive that runs, profile.csv [default: no files]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,

    /// Overwrite an existing result folder
    #[arg(long, requires = "out")]
    force: bool,

    /// Print one JSON object, as in `summary.json`, to standard output
    #[arg(long)]
    pub json: bool,
}

/// Models by the names that users give.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum, Serialize)]
#[serde(rename_all = "kebab-case")]
enum ModelName {
    /// Centrifugal force and acceleration by stretching
    Full,
    /// Centrifugal force only
    Centrifugal,
    /// None: the classical capstan equation with a creeping belt
    Capstan,
    /// Steady running of the finite elements, not there yet.
    #[value(hide = true)]
    Fe,
}

/// Closures by the names that users give.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum, Serialize)]
#[serde(rename_all = "kebab-case")]
enum ClosureName {
    /// The unstretched length of the belt
    Length,
    /// The mean of the spans' tensions
    TensionSum,
}

/// What `--json` prints and `summary.json` holds; SI units, angles in radians.
#[derive(Debug, Serialize)]
struct Summary {
    #[serde(skip_serializing_if = "Option::is_none")]
    folder: Option<String>,
    title: String,
    /// `running`, `gross-slip` or `slack`.
    answer: &'static str,
    /// The answer in a sentence.
    message: String,
    model: ModelSummary,
    #[serde(skip_serializing_if = "Option::is_none")]
    steady: Option<Steady>,
    #[serde(skip_serializing_if = "Option::is_none")]
    gross_slip: Option<GrossSlipSummary>,
    #[serde(skip_serializing_if = "Option::is_none")]
    slack: Option<SlackSummary>,
    /// Null where no torque is transmitted or the belt is slack.
    capacity: Option<CapacitySummary>,
    /// Of a drive without torque: the largest torque that may brake each pulley as the only load.
    #[serde(skip_serializing_if = "Option::is_none")]
    largest_load: Option<Named<f64>>,
    warnings: Vec<String>,
}

#[derive(Debug, Serialize)]
struct ModelSummary {
    theory: &'static str,
    inertia: ModelName,
    closure: ClosureName,
    friction_coefficient: f64,
    axial_stiffness: f64,
    line_density: f64,
    path_length: f64,
    belt_length: f64,
    rest_tension: f64,
}

#[derive(Debug, Serialize)]
struct Steady {
    pulley: Named<PulleySummary>,
    span: Named<SpanSummary>,
    power_in: f64,
    power_out: f64,
    power_lost: f64,
    /// Null where no power is fed in.
    efficiency: Option<f64>,
    /// The largest of the pulleys.
    speed_loss: f64,
}

#[derive(Debug, Serialize)]
struct CapacitySummary {
    /// Safety against gross slip: factor on all torques that brings it about.
    factor: f64,
    /// The pulley that slips first.
    pulley: String,
    /// Largest torque on that pulley, without sign.
    largest_torque: f64,
    /// External torques then on the pulleys that have one.
    torque: Named<f64>,
}

#[derive(Debug, Serialize)]
struct GrossSlipSummary {
    pulley: String,
    /// Null where no tension would do.
    slip_angle: Option<f64>,
    wrap_angle: f64,
    /// By how much the needed slip angle is beyond the wrap.
    excess_angle: Option<f64>,
    slack_span: Option<String>,
}

#[derive(Debug, Serialize)]
struct SlackSummary {
    tension: f64,
    needed_tension: f64,
}

/// Solves, records and tells.
pub fn steady(arguments: &Arguments) -> Result<(), Failure> {
    let model = arguments.model.model()?;
    let closure = match arguments.closure {
        ClosureName::Length => Closure::UnstretchedLength,
        ClosureName::TensionSum => Closure::TensionSum,
    };
    let drive = arguments.source.load()?;
    let folder = arguments
        .out
        .as_deref()
        .map(|place| Folder::new(place, arguments.force))
        .transpose()
        .map_err(Failure::Folder)?;

    let string = DriveString::new(&drive, model, closure).map_err(|e| failure(&e, &drive))?;
    let answer = string.solve().map_err(|e| failure(&e, &drive))?;
    let mut summary =
        Summary::new(arguments, &drive, &string, &answer).map_err(|e| failure(&e, &drive))?;

    if let Some(folder) = folder {
        write(folder, &drive, &string, &answer, &summary).map_err(Failure::Record)?;
    }
    summary.folder = arguments
        .out
        .as_ref()
        .map(|place| place.display().to_string());
    if arguments.json {
        standard_output::print_json(&summary)?;
    } else {
        standard_output::print(&summary.in_words(&drive))?;
    }
    for warning in &summary.warnings {
        print_warning(warning);
    }
    Ok(())
}

fn write(
    folder: Folder,
    drive: &Drive,
    string: &DriveString,
    answer: &Answer,
    summary: &Summary,
) -> Result<(), hihna::record::RecordError> {
    folder.text("drive.toml", &input::to_toml(drive))?;
    folder.json("summary.json", summary)?;
    if let Answer::Running(running) = answer {
        folder.rows("profile.csv", &string.profile(running, PROFILE_ROWS))?;
    }
    folder.finish()
}

impl ModelName {
    fn model(self) -> Result<Model, Failure> {
        match self {
            Self::Full => Ok(Model::Full),
            Self::Centrifugal => Ok(Model::Centrifugal),
            Self::Capstan => Ok(Model::Capstan),
            Self::Fe => Err(Failure::Argument {
                message: "the model `fe`, steady running of the finite elements, is not available in this version".into(),
                help: "the models of this version are `full`, `centrifugal` and `capstan`; `hihna run` steps the finite elements through time until they run steadily".into(),
            }),
        }
    }

    fn in_words(self) -> &'static str {
        match self {
            Self::Full => "full inertia",
            Self::Centrifugal => "centrifugal force only",
            Self::Capstan => "no inertia (capstan)",
            Self::Fe => "finite elements",
        }
    }
}

/// What is wrong with the drive, at its field.
fn failure(error: &SteadyError, drive: &Drive) -> Failure {
    let of_pulley = |name: &str| {
        let index = drive.pulley.iter().position(|pulley| pulley.name == *name);
        let pulleys = FieldPath::default().field("pulley");
        index.map_or(pulleys.clone(), |i| pulleys.item(i, Some(name)))
    };
    let (path, help) = match error {
        SteadyError::String(error @ hihna::steady::string::StringError::NotConverged { .. }) => {
            return Failure::Steady(error.clone());
        }
        SteadyError::Layout(_) => (
            FieldPath::default().field("pulley"),
            "`hihna check` prints the path of the belt once it closes",
        ),
        SteadyError::NoSpeed => (
            FieldPath::default().field("pulley"),
            "add `speed = \"720 rpm\"` to one pulley",
        ),
        SteadyError::SeveralSpeeds { second, .. } => (
            of_pulley(second).field("speed"),
            "how much each of them pulls is not decided by speeds alone",
        ),
        SteadyError::SpeedAndTorque { pulley, .. } => (
            of_pulley(pulley).field("torque"),
            "the torque that keeps the speed is a result",
        ),
        SteadyError::AngleDriven { pulley } => (
            of_pulley(pulley).field("angle"),
            "replace `angle` by `speed`, such as `speed = \"720 rpm\"`",
        ),
        SteadyError::AtRest { pulley, .. } => (
            of_pulley(pulley).field("speed"),
            "the last value of a profile counts; give a speed, such as `speed = \"720 rpm\"`",
        ),
        SteadyError::NoTightness => (
            FieldPath::default().field("belt"),
            "give the unstretched `length`, or `tension = \"50 N\"`, or `strain = 0.01`",
        ),
        SteadyError::OutOfRange { pulley, .. } => {
            (of_pulley(pulley), "`hihna check` prints wraps and spans")
        }
        SteadyError::String(_) => (
            FieldPath::default(),
            "`hihna check` prints the layout of the drive",
        ),
    };
    let problem = Problem::new(path, error.to_string()).help(help);
    Failure::Input(InputErrors::from(InputError {
        problem,
        place: None,
    }))
}

impl Summary {
    fn new(
        arguments: &Arguments,
        drive: &Drive,
        string: &DriveString,
        answer: &Answer,
    ) -> Result<Self, SteadyError> {
        let mut summary = Self {
            folder: None,
            title: drive.title.clone(),
            answer: "running",
            message: String::new(),
            model: ModelSummary::new(arguments, drive, string),
            steady: None,
            gross_slip: None,
            slack: None,
            capacity: None,
            largest_load: None,
            warnings: Vec::new(),
        };
        if drive.gravity.iter().any(|g| g.abs() > 0.0) {
            summary.warnings.push(
                "gravity plays no part in this theory; `hihna run` takes it into account".into(),
            );
        }
        match answer {
            Answer::Running(running) => {
                "the drive runs: every pulley sticks somewhere".clone_into(&mut summary.message);
                summary.steady = Some(Steady::new(string, running));
                summary.capacity = running
                    .capacity
                    .as_ref()
                    .map(|capacity| CapacitySummary::new(string, capacity));
                if running.capacity.is_none() {
                    summary.largest_load = Some(largest_loads(string)?);
                }
            }
            Answer::GrossSlip(slip) => {
                summary.answer = "gross-slip";
                summary.message = string.explain_gross_slip(slip);
                summary.capacity = Some(CapacitySummary::new(string, &slip.capacity));
                summary.gross_slip = Some(GrossSlipSummary::new(string, slip));
            }
            Answer::Slack(slack) => {
                summary.answer = "slack";
                summary.message = string.explain_slack(slack);
                summary.slack = Some(SlackSummary {
                    tension: slack.tension,
                    needed_tension: slack.needed_tension,
                });
            }
        }
        Ok(summary)
    }

    fn in_words(&self, drive: &Drive) -> String {
        let mut text = String::new();
        // Writing to a string cannot fail.
        let _ = writeln!(
            text,
            "{}",
            if self.title.is_empty() {
                "Belt drive"
            } else {
                &self.title
            }
        );
        let _ = writeln!(text, "{}", self.model.in_words(drive));
        match &self.steady {
            Some(steady) => text.push_str(&steady.in_words()),
            None => {
                let _ = writeln!(text, "{}\n", capitalised(&self.message));
            }
        }
        if let Some(capacity) = &self.capacity {
            let torques = capacity.torque.0.iter();
            let torques: Vec<_> = torques
                .map(|(pulley, torque)| format!("{} on `{pulley}`", with_prefix(*torque, "N m")))
                .collect();
            let _ = writeln!(
                text,
                "Safety against gross slip: {}, then `{}` slips first\nLargest torque: {}",
                plain(capacity.factor, "times the torques"),
                capacity.pulley,
                torques.join(", "),
            );
        }
        if let Some(loads) = &self.largest_load {
            let _ = writeln!(
                text,
                "Safety against gross slip: without bound, no torque is transmitted"
            );
            for (pulley, torque) in &loads.0 {
                let _ = writeln!(
                    text,
                    "Largest torque: {} on `{pulley}` as the only load",
                    with_prefix(*torque, "N m")
                );
            }
        }
        if let Some(folder) = &self.folder {
            let _ = writeln!(text, "Results: {folder}");
        }
        text
    }
}

/// The largest torque that may brake each pulley as the only load.
fn largest_loads(string: &DriveString) -> Result<Named<f64>, SteadyError> {
    let mut loads = Vec::new();
    for (i, name) in string.names.iter().enumerate() {
        if let Some(torque) = string.largest_load(i)? {
            loads.push((name.clone(), torque));
        }
    }
    Ok(Named(loads))
}

fn capitalised(sentence: &str) -> String {
    let mut letters = sentence.chars();
    letters.next().map_or_else(String::new, |first| {
        first.to_uppercase().chain(letters).collect()
    })
}

impl ModelSummary {
    fn new(arguments: &Arguments, drive: &Drive, string: &DriveString) -> Self {
        let path = string.layout.length;
        let stiffness = string.string.axial_stiffness;
        let (belt_length, rest_tension) = match string.string.tightness {
            Tightness::UnstretchedLength(length) => (length, stiffness * (path / length - 1.0)),
            Tightness::InitialTension(tension) => (path / (1.0 + tension / stiffness), tension),
        };
        Self {
            theory: "string",
            inertia: arguments.model,
            closure: arguments.closure,
            friction_coefficient: drive.contact.friction.coefficient(),
            axial_stiffness: stiffness,
            line_density: string.string.line_density,
            path_length: path,
            belt_length,
            rest_tension,
        }
    }

    fn in_words(&self, drive: &Drive) -> String {
        let closure = match self.closure {
            ClosureName::Length => "the unstretched length",
            ClosureName::TensionSum => "the mean tension",
        };
        let unused = match drive.contact.friction {
            Friction::CreepRate { .. } => "the slope of law `creep-rate`",
            Friction::Coulomb { .. } => "the velocity of law `coulomb`",
            Friction::Stribeck { .. } => "the static coefficient and velocities of law `stribeck`",
            Friction::ElasticPlastic { .. } => "the bristles of law `elastic-plastic`",
        };
        let mut text = String::new();
        // Writing to a string cannot fail.
        let _ = writeln!(
            text,
            "Steady running of an extensible string, {}, {closure} kept",
            self.inertia.in_words()
        );
        let _ = writeln!(
            text,
            "Friction coefficient {}; {unused} plays no part",
            self.friction_coefficient
        );
        let _ = writeln!(
            text,
            "Axial stiffness {}, {} per unstretched length, {} at rest",
            with_prefix(self.axial_stiffness, "N"),
            plain(self.line_density, "kg/m"),
            with_prefix(self.rest_tension, "N"),
        );
        text
    }
}

impl Steady {
    fn new(string: &DriveString, running: &Running) -> Self {
        let named = |pulley: PulleySummary| (pulley.name.clone(), pulley);
        let pulleys: Vec<_> = string.pulleys(running).into_iter().map(named).collect();
        let speed_loss = pulleys.iter().fold(0.0, |most: f64, (_, pulley)| {
            if pulley.speed_loss.abs() > most.abs() {
                pulley.speed_loss
            } else {
                most
            }
        });
        let spans = string.spans(running).into_iter();
        Self {
            pulley: Named(pulleys),
            span: Named(spans.map(|span| (span.name.clone(), span)).collect()),
            power_in: running.power_in,
            power_out: running.power_out,
            power_lost: running.friction_loss,
            efficiency: running.efficiency,
            speed_loss,
        }
    }

    fn in_words(&self) -> String {
        let header = [
            "pulley",
            "speed",
            "",
            "external torque",
            "slip",
            "stick",
            "wrap",
            "hub force",
            "power",
            "speed loss",
        ];
        let mut pulleys = columns(&header, &[1, 2, 3, 4, 5, 6, 7, 8, 9]);
        for (name, pulley) in &self.pulley.0 {
            pulleys.add_row([
                name.clone(),
                plain(pulley.speed, "rad/s"),
                plain(pulley.speed / RPM, "rpm"),
                with_prefix(pulley.external_torque, "N m"),
                degrees(pulley.slip_angle),
                degrees(pulley.stick_angle),
                degrees(pulley.wrap_angle),
                with_prefix(pulley.hub_force[0].hypot(pulley.hub_force[1]), "N"),
                with_prefix(pulley.power, "W"),
                percent(pulley.speed_loss),
            ]);
        }
        let mut spans = columns(&["span", "tension", "belt speed", "strain"], &[1, 2, 3]);
        for (name, span) in &self.span.0 {
            spans.add_row([
                name.clone(),
                with_prefix(span.tension, "N"),
                plain(span.speed, "m/s"),
                percent(span.strain),
            ]);
        }
        let efficiency = self
            .efficiency
            .map_or_else(|| "none, no power is fed in".to_owned(), percent);
        let mut text = String::new();
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{}\n", pulleys.trim_fmt());
        let _ = writeln!(text, "{}\n", spans.trim_fmt());
        let _ = writeln!(text, "Speed loss: {}", percent(self.speed_loss));
        let _ = writeln!(
            text,
            "Power: {} in, {} out, {} lost",
            with_prefix(self.power_in, "W"),
            with_prefix(self.power_out, "W"),
            with_prefix(self.power_lost, "W"),
        );
        let _ = writeln!(text, "Efficiency: {efficiency}");
        text
    }
}

impl CapacitySummary {
    fn new(string: &DriveString, capacity: &Capacity) -> Self {
        let torques = string.names.iter().enumerate().map(|(i, name)| {
            let torque = match string.string.pulleys[string.string_pulley(i)].role {
                Role::SpeedControlled(_) => capacity.driver_torque,
                Role::Torque(torque) => capacity.factor * torque,
            };
            (name.clone(), string.rotation(i) * torque)
        });
        Self {
            factor: capacity.factor,
            pulley: string.names[string.order[capacity.pulley]].clone(),
            largest_torque: capacity.torque.abs(),
            torque: Named(torques.filter(|(_, torque)| *torque != 0.0).collect()),
        }
    }
}

impl GrossSlipSummary {
    fn new(string: &DriveString, slip: &GrossSlip) -> Self {
        let slip_angle = slip.slip_angle.is_finite().then_some(slip.slip_angle);
        Self {
            pulley: string.names[string.order[slip.capacity.pulley]].clone(),
            slip_angle,
            wrap_angle: slip.wrap_angle,
            excess_angle: slip_angle.map(|angle| angle - slip.wrap_angle),
            slack_span: slip
                .slack_span
                .map(|j| string.span_name(string.span_behind(j))),
        }
    }
}

/// `93.94°` of 1.6396 rad.
fn degrees(angle: f64) -> String {
    // Without the sign of a negative zero.
    format!("{:.2}°", (100.0 * angle.to_degrees()).round() / 100.0 + 0.0)
}
