//! The summary of a run (`summary.json`).

mod averaged;
mod warnings;

use serde::{Serialize, Serializer};

use crate::assemble::Warning;
use crate::drive::{BeltElement, Drive};
use crate::history::History;
use crate::layout::Arc;
use crate::simulate::Outcome;
use crate::user_laws::FRICTION;

pub use averaged::Averaged;

/// Values by name, in order.
#[derive(Clone, Debug, PartialEq)]
pub struct Named<T>(pub Vec<(String, T)>);

impl<T: Serialize> Serialize for Named<T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.0.iter().map(|(name, value)| (name, value)))
    }
}

/// All of `summary.json`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Summary {
    /// The drive's title.
    pub title: String,
    /// Size of the model.
    pub model: Model,
    /// What the solution cost.
    pub solver: Solver,
    /// The equilibrium at rest.
    pub start: Start,
    /// The last state.
    pub end: Report,
    /// Of a run until its means settle: whether they have.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub settling: Option<SettlingSummary>,
    /// Means over the times `averaged`.
    pub steady: Report,
    /// The last tenth of the run, whole periods of an irregularity, or the two windows in which the means have settled.
    pub averaged: Averaged,
    /// Standard deviations over the same time: how steady the means are.
    pub scatter: Scatter,
    /// The balances.
    pub audit: Audit,
    /// Things to know.
    pub warnings: Vec<String>,
    /// Pulleys whose friction the program that ran the drive stated itself (`hihna::user_laws`).
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub stated_friction: Vec<String>,
}

/// Size of the model.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Model {
    /// Element type.
    pub element: BeltElement,
    /// Number of elements along the belt.
    pub elements: usize,
    /// Number of elements across a belt of plates.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub elements_across: Option<usize>,
    /// Number of coordinates.
    pub dofs: usize,
    /// Contact integration points around the belt.
    pub contact_points: usize,
    /// Length of the belt's path around the pulleys [m].
    pub path_length: f64,
    /// Unstretched length of the belt [m].
    pub belt_length: f64,
}

/// What the solution cost.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[expect(missing_docs, reason = "counters named as in the contract")]
pub struct Solver {
    pub integrator: &'static str,
    pub steps: usize,
    pub halved_steps: usize,
    pub fallback_steps: usize,
    pub force_evaluations: usize,
    pub tangent_evaluations: usize,
    pub factorizations: usize,
    /// Stepping alone [s].
    pub cpu_seconds: f64,
    /// The whole run [s].
    pub wall_seconds: f64,
}

/// The equilibrium at rest on the pulleys.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Start {
    /// Mean true axial force [N].
    pub tension: f64,
    /// Largest penetration into a pulley [m].
    pub penetration: f64,
    /// Newton iterations.
    pub iterations: usize,
    /// Axial force by the formula of the belt stretched on its rigid path [N].
    pub path_tension: f64,
}

/// The drive at one time, or on average.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Report {
    /// Time, or the middle of the times averaged [s].
    pub time: f64,
    /// By pulley.
    pub pulley: Named<PulleyReport>,
    /// By span, named `from-to`.
    pub span: Named<SpanReport>,
    /// Power put in [W]: by the torques that act with the motion of their pulleys, drivers or not, and by what moves hubs against
    /// the belt.
    pub power_in: f64,
    /// Power taken out [W]: by the torques against the motion, and where hubs give way to the belt.
    pub power_out: f64,
    /// Power lost to friction and damping [W].
    pub power_lost: f64,
}

/// A pulley at one time, or on average.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PulleyReport {
    /// Speed [rad/s].
    pub speed: f64,
    /// Torque of the belt on the pulley [N m].
    pub torque: f64,
    /// External torque [N m].
    pub external_torque: f64,
    /// Force of the belt on the pulley [N].
    pub hub_force: [f64; 2],
    /// What a belt in space does out of the plane.
    #[serde(flatten)]
    pub lateral: Option<LateralReport>,
    /// Mean velocity of the belt against the surface [m/s].
    pub slip_speed: f64,
    /// Loss of the belt's speed on it against the first driver [-], by the radii of the centre line.
    pub speed_loss: f64,
    /// Wrap angle of the path on the rigid pulleys [rad].
    pub wrap_angle: f64,
    /// Angle in contact [rad].
    pub contact_angle: f64,
    /// Angle of it where friction is exhausted [rad].
    pub slip_angle: f64,
    /// True axial force where the belt runs on [N].
    pub tension_in: f64,
    /// True axial force where the belt runs off [N].
    pub tension_out: f64,
    /// Power that the belt gives to the pulley [W].
    pub power: f64,
    /// Power that friction takes on the pulley [W].
    pub friction_loss: f64,
}

/// What a belt in space does to a pulley out of the plane.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LateralReport {
    /// Force of the belt on the pulley along z [N].
    pub hub_force_z: f64,
    /// Moment of the belt on the pulley about its centre [N m].
    pub hub_moment: [f64; 3],
    /// Mean place of the belt along the pulley's axis, from its middle [m].
    pub belt_offset: f64,
}

/// A span at one time, or on average.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SpanReport {
    /// True axial force [N].
    pub tension: f64,
    /// Engineering strain [-].
    pub strain: f64,
    /// Speed along the belt, in the order of the pulleys [m/s].
    pub speed: f64,
    /// Deflection at mid-span [m].
    pub deflection: f64,
}

/// Standard deviations in time.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Scatter {
    /// By pulley.
    pub pulley: Named<PulleyScatter>,
    /// By span.
    pub span: Named<SpanScatter>,
}

/// Standard deviations of a pulley.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PulleyScatter {
    /// Speed [rad/s].
    pub speed: f64,
    /// Torque of the belt on the pulley [N m].
    pub torque: f64,
    /// Force of the belt on the pulley [N].
    pub hub_force: [f64; 2],
    /// Mean velocity of the belt against the surface [m/s].
    pub slip_speed: f64,
}

/// Standard deviations of a span.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SpanScatter {
    /// True axial force [N].
    pub tension: f64,
    /// Engineering strain [-].
    pub strain: f64,
    /// Deflection at mid-span [m].
    pub deflection: f64,
}

/// Whether the means of a run have settled.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SettlingSummary {
    /// Whether they have before `run.end_time`.
    pub reached: bool,
    /// When the run ended [s].
    pub time: f64,
    /// Length of the windows over which means were taken [s].
    pub window: f64,
    /// Change between the last two windows, relative to its nominal value [-], of the mean that has most left to come against what
    /// is allowed; null before there are three.
    pub change: Option<f64>,
    /// What its changes let expect to come [-]; null before there are three windows.
    pub left: Option<f64>,
    /// What is allowed of it [-]: the accuracy of the run, or the standard error of a mean.
    pub tolerance: f64,
}

/// The balances.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Audit {
    /// Work of the drivers [J].
    pub energy_input: f64,
    /// Largest energy residual in the rows of the history, relative to the work turned over [-].
    pub energy_residual: f64,
    /// Largest residual of a pulley's torque balance, relative [-].
    pub torque_residual: f64,
    /// Largest residual allowed [-].
    pub tolerance: f64,
    /// Whether both close.
    pub passed: bool,
}

/// Pulleys whose friction is not the drive's.
fn stated_friction(warnings: &[Warning]) -> Vec<String> {
    let pulley = |warning: &Warning| match warning {
        Warning::StatedLaw { law, pulley } if *law == FRICTION => Some(pulley.clone()),
        _ => None,
    };
    warnings.iter().filter_map(pulley).collect()
}

impl Summary {
    /// The summary of `outcome`.
    #[must_use]
    pub fn new(drive: &Drive, outcome: &Outcome) -> Self {
        let end = outcome.end_time;
        let statistics = outcome.statistics;
        let last = outcome.history.rows().next_back().map_or(end, |row| row[0]);
        let averaged = Averaged::new(drive, outcome);
        let Averaged { from, to, .. } = averaged;
        let steady = report(drive, outcome, from, to);
        let mut warnings: Vec<_> = outcome.warnings.iter().map(ToString::to_string).collect();
        warnings.extend(warnings::of_running(drive, &steady));
        warnings.extend(warnings::of_crowns(drive, &steady));
        warnings.extend(outcome.settling.as_ref().and_then(warnings::of_settling));
        Self {
            title: drive.title.clone(),
            model: Model {
                element: drive.belt.element,
                elements: drive.belt.elements,
                elements_across: (drive.belt.element == BeltElement::Plate)
                    .then_some(drive.belt.elements_across),
                dofs: outcome.dofs,
                contact_points: drive.contact_points(),
                path_length: outcome.mounting.path,
                belt_length: outcome.mounting.length,
            },
            solver: Solver {
                integrator: outcome.integrator,
                steps: statistics.steps,
                halved_steps: statistics.halved_steps,
                fallback_steps: statistics.fallback_steps,
                force_evaluations: statistics.force_evaluations,
                tangent_evaluations: statistics.tangent_evaluations,
                factorizations: statistics.factorizations,
                cpu_seconds: outcome.cpu_seconds,
                wall_seconds: outcome.wall_seconds,
            },
            start: Start {
                tension: outcome.start.tension,
                penetration: outcome.start.penetration,
                iterations: outcome.start.iterations,
                path_tension: outcome.mounting.tension,
            },
            end: report(drive, outcome, last, last),
            settling: outcome.settling.map(|settling| SettlingSummary {
                reached: settling.reached,
                time: end,
                window: settling.window,
                change: settling.change.is_finite().then_some(settling.change),
                left: settling.left.is_finite().then_some(settling.left),
                tolerance: settling.tolerance,
            }),
            steady,
            averaged,
            scatter: scatter(drive, &outcome.history, from, to),
            audit: Audit {
                energy_input: outcome.audit.energy_input,
                energy_residual: outcome.audit.energy_residual,
                torque_residual: outcome.audit.torque_residual,
                tolerance: outcome.audit.tolerance,
                passed: outcome.audit.passed(),
            },
            warnings,
            stated_friction: stated_friction(&outcome.warnings),
        }
    }
}

/// Radius, negative where the belt turns the pulley against the others.
fn surface(arc: &Arc) -> f64 {
    arc.radius * arc.sweep.signum()
}

/// Means over the rows with times in `[from, to]`; a single row if both are its time.
fn report(drive: &Drive, outcome: &Outcome, from: f64, to: f64) -> Report {
    let history = &outcome.history;
    let mean = |name: &str| {
        let column = history.columns().iter().position(|column| column == name);
        column
            .and_then(|column| history.average(from, to, |row| row[column]))
            .unwrap_or(f64::NAN)
    };
    let names: Vec<&str> = drive.pulley.iter().map(|p| p.name.as_str()).collect();
    let reference = drive
        .pulley
        .iter()
        .position(crate::drive::Pulley::is_driver)
        .map_or(0.0, |p| {
            mean(&format!("{}.speed", names[p])) * surface(&outcome.layout.arcs[p])
        });
    let pulley = drive
        .pulley
        .iter()
        .zip(&outcome.layout.arcs)
        .map(|(p, arc)| {
            let of = |what: &str| mean(&format!("{}.{what}", p.name));
            let speed = of("speed");
            let speed_loss = if reference == 0.0 {
                0.0
            } else {
                1.0 - speed * surface(arc) / reference
            };
            let report = PulleyReport {
                speed,
                torque: of("torque"),
                external_torque: of("external_torque"),
                hub_force: [of("hub_force_x"), of("hub_force_y")],
                lateral: drive.belt.element.is_spatial().then(|| LateralReport {
                    hub_force_z: of("hub_force_z"),
                    hub_moment: ["x", "y", "z"].map(|axis| of(&format!("hub_moment_{axis}"))),
                    belt_offset: of("belt_offset"),
                }),
                slip_speed: of("slip_speed"),
                speed_loss,
                wrap_angle: arc.sweep.abs(),
                contact_angle: of("contact_angle"),
                slip_angle: of("slip_angle"),
                tension_in: of("tension_in"),
                tension_out: of("tension_out"),
                power: of("power"),
                friction_loss: of("friction_loss"),
            };
            (p.name.clone(), report)
        })
        .collect();
    let span = span_names(drive)
        .map(|name| {
            let of = |what: &str| mean(&format!("{name}.{what}"));
            let report = SpanReport {
                tension: of("tension"),
                strain: of("strain"),
                speed: of("speed"),
                deflection: of("deflection"),
            };
            (name, report)
        })
        .collect();
    let (mut power_in, mut power_out) = (0.0, 0.0);
    for power in powers_from_outside(drive, history, from, to) {
        // Not a number shows.
        if power < 0.0 {
            power_out -= power;
        } else {
            power_in += power;
        }
    }
    let lost = ["friction_loss", "contact_loss", "damping_loss"]
        .iter()
        .map(|name| {
            history
                .mean_rate(&format!("energy.{name}"), from, to)
                .unwrap_or(0.0)
        })
        .sum();
    Report {
        time: 0.5 * (from + to),
        pulley: Named(pulley),
        span: Named(span),
        power_in,
        power_out,
        power_lost: lost,
    }
}

/// Mean powers [W] over times in `[from, to]` by what acts from outside: on every pulley the external torque, and whoever moves
/// its hub and holds it against the belt.
fn powers_from_outside(
    drive: &Drive,
    history: &History,
    from: f64,
    to: f64,
) -> impl Iterator<Item = f64> {
    let column = |name: String| history.columns().iter().position(|column| *column == name);
    drive.pulley.iter().flat_map(move |pulley| {
        let of = |what: &str| column(format!("{}.{what}", pulley.name));
        let [torque, speed] = ["external_torque", "speed"].map(of);
        let turning = (torque.zip(speed))
            .and_then(|(torque, speed)| history.average(from, to, |row| row[torque] * row[speed]));
        let forces = ["hub_force_x", "hub_force_y", "hub_force_z"].map(of);
        let moving = pulley.displacement.as_ref().and_then(|hub| {
            history.average(from, to, |row| {
                let [_, velocity] = hub.at(row[0]);
                let force = forces.map(|force| force.map_or(0.0, |force| row[force]));
                -(force.iter().zip(velocity))
                    .map(|(f, v)| f * v)
                    .sum::<f64>()
            })
        });
        [Some(turning.unwrap_or(f64::NAN)), moving]
            .into_iter()
            .flatten()
    })
}

/// Standard deviations over the rows with times in `[from, to]`.
fn scatter(drive: &Drive, history: &History, from: f64, to: f64) -> Scatter {
    let of = |name: &str, what: &str| {
        history
            .deviation(&format!("{name}.{what}"), from, to)
            .unwrap_or(f64::NAN)
    };
    let pulley = drive
        .pulley
        .iter()
        .map(|p| {
            let of = |what: &str| of(&p.name, what);
            let scatter = PulleyScatter {
                speed: of("speed"),
                torque: of("torque"),
                hub_force: [of("hub_force_x"), of("hub_force_y")],
                slip_speed: of("slip_speed"),
            };
            (p.name.clone(), scatter)
        })
        .collect();
    let span = span_names(drive)
        .map(|name| {
            let scatter = SpanScatter {
                tension: of(&name, "tension"),
                strain: of(&name, "strain"),
                deflection: of(&name, "deflection"),
            };
            (name, scatter)
        })
        .collect();
    Scatter {
        pulley: Named(pulley),
        span: Named(span),
    }
}

/// Names of the spans, `from-to`, in the order of the pulleys.
fn span_names(drive: &Drive) -> impl Iterator<Item = String> {
    let next = drive.pulley.iter().cycle().skip(1);
    drive
        .pulley
        .iter()
        .zip(next)
        .map(|(from, to)| format!("{}-{}", from.name, to.name))
}
