//! `run.start = "steady"`: a run that begins in steady running.
//!
//! The drive with the values of its profiles at time zero is solved for steady running ([`crate::steady::running`]) on
//! the run's own equal elements; the belt gets its coordinates and the velocities of its material points, the
//! pulleys their speeds. Bristles of laws with memory are not known to the run's points, so these laws are refused.

use ancf::system::Mechanics;
use thiserror::Error;

use crate::assemble::{Assembly, BeltElementType};
use crate::drive::{Drive, Pulley};
use crate::friction::Law;
use crate::input::{FieldPath, Problem};
use crate::profile::Profile;
use crate::steady::running::{Answer, RunningBelt, RunningError};

/// A run that cannot begin in steady running.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum NoSteadyStart {
    /// A driver is at rest at time zero.
    #[error(
        "pulley `{pulley}` is at rest at time zero: `run.start = \"steady\"` needs the speed at which the drive runs"
    )]
    AtRest {
        /// Name of the pulley.
        pulley: String,
    },
    /// Friction remembers.
    #[error(
        "friction of law `elastic-plastic` on pulley `{pulley}` remembers displacements, which `run.start = \"steady\"` does not provide"
    )]
    Remembers {
        /// Name of the pulley.
        pulley: String,
    },
    /// The belt is one of plates or of beams in space.
    #[error("`run.start = \"steady\"` is there for planar elements only")]
    Spatial,
    /// No steady running is found, or the drive is none to ask for it.
    #[error("no steady running to start from, with the values of time zero: {0}")]
    Running(RunningError),
    /// The drive slips as a whole.
    #[error(
        "no steady running to start from: at time zero the torques are {overload:.4} times the most that the drive carries"
    )]
    GrossSlip {
        /// Torques over capacity.
        overload: f64,
    },
    /// A span would be slack.
    #[error(
        "no steady running to start from: with the values of time zero a span is slack, {tension:.4} N in it"
    )]
    Slack {
        /// Its axial force [N].
        tension: f64,
    },
}

impl NoSteadyStart {
    /// What is wrong with `drive` at which of its fields, and what to change.
    pub fn problem(&self, drive: &Drive) -> Problem {
        let start = FieldPath::default().field("run").field("start");
        let pulley = |name: &str, field: &str| {
            let index = drive.pulley.iter().position(|pulley| pulley.name == name);
            let pulleys = FieldPath::default().field("pulley");
            index.map_or(pulleys.clone(), |i| {
                pulleys.item(i, Some(name)).field(field)
            })
        };
        let help = "or start from `rest`";
        match self {
            Self::AtRest { pulley: name } => {
                let driver = drive.pulley.iter().find(|pulley| pulley.name == *name);
                let field = match driver {
                    Some(Pulley { speed: None, .. }) => "angle",
                    _ => "speed",
                };
                Problem::new(pulley(name, field), self.to_string())
                    .help("let its profile begin with the running speed, or start from `rest`")
            }
            Self::Running(RunningError::Drive(error)) => {
                let inner = error.problem(drive);
                Problem::new(inner.path, self.to_string()).help(help)
            }
            _ => Problem::new(start, self.to_string()).help("start from `rest`"),
        }
    }
}

/// Gives the settled belt of `drive`, and its pulleys, the motion of steady running.
pub(super) fn set_running<E: BeltElementType>(
    drive: &Drive,
    assembly: &mut Assembly<E>,
) -> Result<(), NoSteadyStart> {
    let now = at_time_zero(drive)?;
    let count = drive.belt.elements;
    let starts: Vec<f64> = (0..count).map(|i| i as f64 / count as f64).collect();
    let mut belt = RunningBelt::<E>::on_mesh(&now, &starts).map_err(NoSteadyStart::Running)?;
    let running = match belt.solve().map_err(NoSteadyStart::Running)? {
        Answer::Running(running) => running,
        Answer::GrossSlip(slip) => {
            let overload = slip.overload();
            return Err(NoSteadyStart::GrossSlip { overload });
        }
        Answer::Slack(slack) => {
            let tension = slack.tension;
            return Err(NoSteadyStart::Slack { tension });
        }
    };
    let (coordinates, velocities) = belt
        .material_motion(&running)
        .map_err(NoSteadyStart::Running)?;
    let rotors = assembly.system.structure().chain();
    let motion = &mut assembly.motion;
    for (to, from) in [(&mut motion.q, coordinates), (&mut motion.v, velocities)] {
        to[..from.len()].copy_from_slice(&from);
        // The end of an open belt lies on its first node.
        let end = rotors - from.len();
        to[from.len()..rotors].copy_from_slice(&from[..end]);
    }
    for (speed, pulley) in motion.v[rotors..].iter_mut().zip(&running.pulleys) {
        *speed = pulley.speed;
    }
    Ok(())
}

/// The drive with the values that its profiles have at time zero.
fn at_time_zero(drive: &Drive) -> Result<Drive, NoSteadyStart> {
    let mut now = drive.clone();
    for pulley in &mut now.pulley {
        let name = || pulley.name.clone();
        if Law::new(drive.friction_on(pulley), pulley.grip()).has_memory() {
            return Err(NoSteadyStart::Remembers { pulley: name() });
        }
        let speed = pulley.speed.as_ref().map(|speed| speed.value(0.0));
        let turning = pulley.angle.as_ref().map(|angle| angle.derivative(0.0));
        let speed = speed.or(turning);
        if speed == Some(0.0) {
            return Err(NoSteadyStart::AtRest { pulley: name() });
        }
        pulley.speed = speed.map(Profile::Constant);
        pulley.angle = None;
        pulley.torque = Profile::Constant(pulley.torque.value(0.0));
        // It begins at zero.
        pulley.displacement = None;
    }
    Ok(now)
}
