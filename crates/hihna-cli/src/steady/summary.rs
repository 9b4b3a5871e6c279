//! What `hihna steady` found, as `--json` prints it and `summary.json` holds it.

use hihna::drive::Drive;
use hihna::steady::drive_string::{DriveString, PulleySummary, SpanSummary, SteadyError};
use hihna::steady::running::summary::CapacitySummary;
use hihna::steady::string::{Answer, Capacity, GrossSlip, Role, Running, Tightness};
use hihna::summary::Named;
use serde::Serialize;

use super::sensitivity::SensitivitySummary;
use super::{Arguments, ClosureName, ModelName};

/// What `--json` prints and `summary.json` holds; SI units, angles in radians.
#[derive(Debug, Serialize)]
pub struct Summary {
    #[serde(skip_serializing_if = "Option::is_none")]
    pub folder: Option<String>,
    pub title: String,
    /// `running`, `gross-slip` or `slack`.
    pub answer: &'static str,
    /// The answer in a sentence.
    pub message: String,
    pub model: ModelSummary,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub steady: Option<Steady>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub gross_slip: Option<GrossSlipSummary>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub slack: Option<SlackSummary>,
    /// Null where no torque is transmitted or the belt is slack.
    pub capacity: Option<CapacitySummary>,
    /// Of a drive without torque: the largest torque that may brake each pulley as the only load.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub largest_load: Option<Named<f64>>,
    /// By the fields of `--sensitivity`; left out without it and for a drive that does not run.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sensitivity: Option<SensitivitySummary>,
    pub warnings: Vec<String>,
}

#[derive(Debug, Serialize)]
pub struct ModelSummary {
    pub theory: &'static str,
    pub inertia: ModelName,
    pub closure: ClosureName,
    pub friction_coefficient: f64,
    pub axial_stiffness: f64,
    pub line_density: f64,
    pub path_length: f64,
    pub belt_length: f64,
    pub rest_tension: f64,
}

#[derive(Debug, Serialize)]
pub struct Steady {
    pub pulley: Named<PulleySummary>,
    pub span: Named<SpanSummary>,
    pub power_in: f64,
    pub power_out: f64,
    pub power_lost: f64,
    /// Null where no power is fed in.
    pub efficiency: Option<f64>,
    /// The largest of the pulleys.
    pub speed_loss: f64,
}

#[derive(Debug, Serialize)]
pub struct GrossSlipSummary {
    pub pulley: String,
    /// Null where no tension would do.
    pub slip_angle: Option<f64>,
    pub wrap_angle: f64,
    /// By how much the needed slip angle is beyond the wrap.
    pub excess_angle: Option<f64>,
    pub slack_span: Option<String>,
}

#[derive(Debug, Serialize)]
pub struct SlackSummary {
    pub tension: f64,
    pub needed_tension: f64,
}

impl Summary {
    pub fn new(
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
            sensitivity: None,
            warnings: Vec::new(),
        };
        if drive.gravity.iter().any(|g| g.abs() > 0.0) {
            summary.warnings.push(
                "gravity plays no part in this theory; `hihna run` takes it into account".into(),
            );
        }
        if drive.pulley.iter().any(|p| !p.irregularity.is_empty()) {
            summary.warnings.push(
                "the irregularity of speeds plays no part in steady running; `hihna run` takes it into account".into(),
            );
        }
        match answer {
            Answer::Running(running) => {
                "the drive runs: every pulley sticks somewhere".clone_into(&mut summary.message);
                summary.steady = Some(Steady::new(string, running));
                summary.capacity = running
                    .capacity
                    .as_ref()
                    .map(|capacity| capacity_summary(string, capacity));
                if running.capacity.is_none() {
                    summary.largest_load = Some(largest_loads(string)?);
                }
            }
            Answer::GrossSlip(slip) => {
                summary.answer = "gross-slip";
                summary.message = string.explain_gross_slip(slip);
                summary.capacity = Some(capacity_summary(string, &slip.capacity));
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
}

fn capacity_summary(string: &DriveString, capacity: &Capacity) -> CapacitySummary {
    let torques = string.names.iter().enumerate().map(|(i, name)| {
        let torque = match string.string.pulleys[string.string_pulley(i)].role {
            Role::SpeedControlled(_) => capacity.driver_torque,
            Role::Torque(torque) => capacity.factor * torque,
        };
        (name.clone(), string.rotation(i) * torque)
    });
    CapacitySummary {
        factor: capacity.factor,
        pulley: string.names[string.order[capacity.pulley]].clone(),
        largest_torque: capacity.torque.abs(),
        torque: Named(torques.filter(|(_, torque)| *torque != 0.0).collect()),
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
