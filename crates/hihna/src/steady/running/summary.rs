//! What was found of a steadily running drive, as `summary.json` holds it.

use serde::Serialize;

use super::{Answer, Capacity, Found, LEAST_POWER, Most, Outcome, POWER_TOLERANCE, Running};
use crate::drive::{BeltElement, Drive, SlipAt, SteadyMesh};
use crate::layout::Arc;
use crate::quantities::with_prefix;
use crate::summary::{Named, PulleyReport, SpanReport, Start};

/// All of `summary.json`; SI units, angles in radians.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RunningSummary {
    /// The drive's title.
    pub title: String,
    /// `running`, `gross-slip` or `slack`.
    pub answer: &'static str,
    /// The answer in a sentence.
    pub message: String,
    /// Size of the model.
    pub model: Model,
    /// The equilibrium at rest.
    pub start: Start,
    /// What the solution took, of a drive that runs.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub solver: Option<Solver>,
    /// The running drive.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub steady: Option<Steady>,
    /// Of a drive that slips as a whole.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub gross_slip: Option<GrossSlipSummary>,
    /// Of a drive with a slack span.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub slack: Option<SlackSummary>,
    /// The most that the drive carries; null where no torque acts, a span is slack or it was not found.
    pub capacity: Option<CapacitySummary>,
    /// Where it was not found: factor on all torques up to which the drive runs.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub runs_up_to: Option<f64>,
    /// The balance of powers, of a drive that runs.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub audit: Option<Audit>,
    /// Things to know.
    pub warnings: Vec<String>,
}

/// Size of the model.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Model {
    /// `finite-elements`.
    pub theory: &'static str,
    /// Element type.
    pub element: BeltElement,
    /// Number of elements.
    pub elements: usize,
    /// How they share the belt.
    pub mesh: SteadyMesh,
    /// Number of unknowns.
    pub dofs: usize,
    /// Length of the belt's path around the pulleys [m].
    pub path_length: f64,
    /// Unstretched length of the belt [m].
    pub belt_length: f64,
}

/// What the solution took.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Solver {
    /// How it was found.
    pub found: Found,
    /// Newton iterations of the last solution.
    pub iterations: usize,
    /// Tangents factored on the way.
    pub factorizations: usize,
}

/// The running drive.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Steady {
    /// By pulley.
    pub pulley: Named<PulleySummary>,
    /// By span, named `from-to`.
    pub span: Named<SpanReport>,
    /// Unstretched length of belt that passes any place per time, positive in the order of the pulleys [m/s].
    pub circulation_speed: f64,
    /// Power put in, by whatever torques act with the motion [W].
    pub power_in: f64,
    /// Power taken out, by torques against it [W].
    pub power_out: f64,
    /// Power lost to friction and the damping of the contact [W].
    pub power_lost: f64,
    /// Power out over power in; null where none is put in.
    pub efficiency: Option<f64>,
    /// The largest speed loss of the pulleys [-].
    pub speed_loss: f64,
}

/// A pulley of the running drive.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PulleySummary {
    /// As a time run reports it.
    #[serde(flatten)]
    pub report: PulleyReport,
    /// Angle in contact where friction is not exhausted [rad].
    pub stick_angle: f64,
}

/// The most that a drive carries.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CapacitySummary {
    /// Safety against gross slip: factor on all torques that brings it about.
    pub factor: f64,
    /// The pulley that slips first.
    pub pulley: String,
    /// Largest torque on that pulley, without sign [N m].
    pub largest_torque: f64,
    /// External torques then on the pulleys that have one [N m].
    pub torque: Named<f64>,
}

/// Gross slip.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct GrossSlipSummary {
    /// The pulley that slips.
    pub pulley: String,
    /// The torques over the most that the drive carries [-].
    pub overload: f64,
}

/// A slack span.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SlackSummary {
    /// Its name.
    pub span: String,
    /// Its axial force [N].
    pub tension: f64,
}

/// The balance of powers.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Audit {
    /// Power neither put in nor taken out nor lost, relative to `power_scale` [-].
    pub power_residual: f64,
    /// The power put in [W], or a hundredth of tension on rigid pulleys times speed of the belt, if that is more.
    pub power_scale: f64,
    /// Largest magnitude that passes.
    pub tolerance: f64,
    /// Whether it does.
    pub passed: bool,
}

impl Audit {
    /// The residual of a drive with the power `put_in` [W], in words.
    pub fn in_words(&self, put_in: f64) -> String {
        let residual = self.power_residual;
        if put_in < self.power_scale {
            format!(
                "{residual:.1e} of {} ({:.0} % of tension on rigid pulleys times belt speed, as hardly any power is put in)",
                with_prefix(self.power_scale, "W"),
                100.0 * LEAST_POWER
            )
        } else {
            format!("{residual:.1e} of the power put in")
        }
    }
}

impl RunningSummary {
    /// The summary of what was found of `drive`.
    pub fn new(drive: &Drive, outcome: &Outcome) -> Self {
        let names: Vec<&str> = drive.pulley.iter().map(|p| p.name.as_str()).collect();
        let mut summary = Self {
            title: drive.title.clone(),
            answer: "running",
            message: String::new(),
            model: Model {
                theory: "finite-elements",
                element: drive.belt.element,
                elements: drive.belt.elements,
                mesh: drive.steady.mesh,
                dofs: outcome.dofs,
                path_length: outcome.mounting.path,
                belt_length: outcome.mounting.length,
            },
            start: Start {
                tension: outcome.start.tension,
                penetration: outcome.start.penetration,
                iterations: outcome.start.iterations,
                path_tension: outcome.mounting.tension,
            },
            solver: None,
            steady: None,
            gross_slip: None,
            slack: None,
            capacity: (outcome.capacity.as_ref())
                .and_then(Most::known)
                .map(|c| capacity(&names, c)),
            runs_up_to: match outcome.capacity {
                Some(Most::AtLeast(factor)) => Some(factor),
                _ => None,
            },
            audit: None,
            warnings: outcome.warnings.iter().map(ToString::to_string).collect(),
        };
        match &outcome.answer {
            Answer::Running(running) => summary.run(drive, outcome, running),
            Answer::GrossSlip(slip) => {
                let most = capacity(&names, &slip.capacity);
                summary.answer = "gross-slip";
                summary.message = format!(
                    "gross slip on pulley \"{}\": the torques are {:.4} times the most that the drive carries, {:.6} N m on it",
                    most.pulley,
                    slip.overload(),
                    most.largest_torque
                );
                summary.gross_slip = Some(GrossSlipSummary {
                    pulley: most.pulley.clone(),
                    overload: slip.overload(),
                });
                summary.capacity = Some(most);
            }
            Answer::Slack(slack) => {
                let next = names[(slack.span + 1) % names.len()];
                let span = format!("{}-{next}", names[slack.span]);
                summary.answer = "slack";
                summary.message = format!(
                    "span \"{span}\" is slack: the solution has {:.6} N in it; shorten the belt or lower the torques",
                    slack.tension
                );
                summary.slack = Some(SlackSummary {
                    span,
                    tension: slack.tension,
                });
            }
        }
        summary
    }

    fn run(&mut self, drive: &Drive, outcome: &Outcome, running: &Running) {
        self.message = match self.capacity.as_ref() {
            Some(capacity) => format!(
                "the drive runs; it slips as a whole at {:.4} times its torques",
                capacity.factor
            ),
            None => "the drive runs".to_owned(),
        };
        if let Some(factor) = self.runs_up_to {
            self.warnings.push(format!(
                "the capacity was not found: the drive runs up to {factor:.4} times its torques, and where more slip carries no more is not known"
            ));
        }
        self.solver = Some(Solver {
            found: running.found,
            iterations: running.iterations,
            factorizations: running.factorizations,
        });
        let steady = steady(drive, outcome, running);
        let audit = Audit {
            power_residual: running.power_residual,
            power_scale: running.power_scale,
            tolerance: POWER_TOLERANCE,
            passed: running.power_residual.abs() <= POWER_TOLERANCE,
        };
        if !audit.passed {
            self.warnings.push(format!(
                "the powers do not balance: what is left is {}, more than {POWER_TOLERANCE:.0e}; use more `belt.elements`",
                audit.in_words(steady.power_in)
            ));
        }
        self.steady = Some(steady);
        self.audit = Some(audit);
        let powers = &running.powers;
        let lost = powers.friction + powers.contact;
        // Less than the residual may be the mesh's.
        let missed = running.power_residual.abs() * running.power_scale;
        if drive.contact.slip_at == SlipAt::Surface && lost < -missed {
            self.warnings.push(format!(
                "contact wins {:.2e} W: slip is measured at the surface of the pulleys, as published, but friction acts where the belt has sunk in; `contact.slip_at = \"depth\"` measures slip there, too",
                -lost
            ));
        }
    }
}

/// Reports of the pulleys: as a time run has them.
fn steady(drive: &Drive, outcome: &Outcome, running: &Running) -> Steady {
    let arcs = &outcome.layout.arcs;
    let reference = (drive.pulley.iter())
        .position(crate::drive::Pulley::is_driver)
        .map_or(0.0, |p| surface_speed(running.pulleys[p].speed, &arcs[p]));
    let pulleys = drive.pulley.iter().zip(arcs).zip(&running.pulleys);
    let pulley: Vec<_> = pulleys
        .map(|((pulley, arc), state)| {
            let report = PulleyReport {
                lateral: None,
                speed: state.speed,
                torque: state.torque,
                external_torque: state.external_torque,
                hub_force: state.hub_force,
                slip_speed: state.slip_speed,
                speed_loss: 1.0 - surface_speed(state.speed, arc) / reference,
                wrap_angle: arc.sweep.abs(),
                contact_angle: state.contact_angle,
                slip_angle: state.slip_angle,
                tension_in: state.tension_in,
                tension_out: state.tension_out,
                power: state.torque * state.speed,
                friction_loss: state.friction_loss,
            };
            let stick_angle = state.contact_angle - state.slip_angle;
            (
                pulley.name.clone(),
                PulleySummary {
                    report,
                    stick_angle,
                },
            )
        })
        .collect();
    let next = drive.pulley.iter().cycle().skip(1);
    let span = (drive.pulley.iter().zip(next).zip(&running.spans))
        .map(|((from, to), state)| {
            let report = SpanReport {
                tension: state.tension,
                strain: state.strain,
                speed: state.speed,
                deflection: state.deflection,
            };
            (format!("{}-{}", from.name, to.name), report)
        })
        .collect();
    let powers = &running.powers;
    let turned = (running.pulleys.iter()).map(|p| p.external_torque * p.speed);
    let power_in: f64 = turned.clone().map(|power| power.max(0.0)).sum();
    let power_out: f64 = turned.map(|power| (-power).max(0.0)).sum();
    let speed_loss =
        (pulley.iter().map(|(_, p)| p.report.speed_loss)).fold(0.0, |most: f64, loss| {
            if loss.abs() > most.abs() { loss } else { most }
        });
    Steady {
        pulley: Named(pulley),
        span: Named(span),
        circulation_speed: running.circulation,
        power_in,
        power_out,
        power_lost: powers.friction + powers.contact,
        efficiency: (power_in > 0.0 && power_out > 0.0).then(|| power_out / power_in),
        speed_loss,
    }
}

/// Speed of the surface in the order of the pulleys, positive where the belt runs that way [m/s].
fn surface_speed(speed: f64, arc: &Arc) -> f64 {
    speed * arc.radius * arc.sweep.signum()
}

fn capacity(names: &[&str], capacity: &Capacity) -> CapacitySummary {
    let torques = names.iter().zip(&capacity.torques);
    CapacitySummary {
        factor: capacity.factor,
        pulley: names[capacity.pulley].to_owned(),
        largest_torque: capacity.torques[capacity.pulley].abs(),
        torque: Named(
            torques
                .filter(|(_, torque)| **torque != 0.0)
                .map(|(name, torque)| ((*name).to_owned(), *torque))
                .collect(),
        ),
    }
}
