//! A drive as the string theory sees it, and the theory's answer in the drive's own terms: names,
//! signs, order.
//!
//! Speeds and torques are those that the drive's profiles end with. The belt moves as the surface
//! of the speed-controlled pulley does; the string theory counts pulleys in that direction, the
//! drive in the order of its list. Axial stiffness `k = axial_factor E A`, line density `rho A`;
//! tension at rest and unstretched length are tied by the string's law `T = k (L/L0 - 1)` on the
//! path of rigid pulleys. Bending, shear, penetration and the creep slope of the friction law have
//! no place in this theory.

use crate::drive::{Drive, Pulley};
use crate::layout::Layout;
use crate::profile::{Profile, Varying};
use crate::steady::string::{
    Answer, Capacity, Closure, GrossSlip, Model, Role, Slack, StringDrive, StringError,
};

mod error;
mod numbers;
mod sensitivity;
mod summary;

pub use error::SteadyError;
pub use sensitivity::{DriveSensitivity, Input, Output, UnknownInput};
pub use summary::{PulleySummary, SpanSummary};

use numbers::{DriveNumbers, span_behind};

/// A drive made ready for the string theory.
#[derive(Clone, Debug, PartialEq)]
pub struct DriveString {
    /// What the theory solves: pulleys in the order of the belt's motion.
    pub string: StringDrive,
    /// The belt's path on the rigid pulleys.
    pub layout: Layout,
    /// Names of the pulleys, in the drive's order.
    pub names: Vec<String>,
    /// `order[j]`: index in the drive of the string's pulley `j`.
    pub order: Vec<usize>,
    /// `+1`: the belt moves in the order of the drive's list; `-1`: against it.
    pub direction: f64,
    numbers: DriveNumbers,
}

impl DriveString {
    /// Makes a drive ready.
    pub fn new(drive: &Drive, model: Model, closure: Closure) -> Result<Self, SteadyError> {
        let layout = Layout::of(drive)?;
        let numbers = DriveNumbers::new(drive)?;
        let direction =
            numbers.driving_speed().signum() * layout.arcs[numbers.driver].sweep.signum();
        let count = drive.pulley.len();
        let order: Vec<usize> = (0..count)
            .map(|j| {
                if direction > 0.0 {
                    j
                } else {
                    (count - j) % count
                }
            })
            .collect();
        let path = numbers.path(&layout);
        Ok(Self {
            string: numbers.string(&path, &layout, &order, direction, (model, closure)),
            names: drive
                .pulley
                .iter()
                .map(|pulley| pulley.name.clone())
                .collect(),
            layout,
            order,
            direction,
            numbers,
        })
    }

    /// Solves the drive; see [`StringDrive::solve`].
    pub fn solve(&self) -> Result<Answer, SteadyError> {
        self.string.solve().map_err(|error| self.named(error))
    }

    /// An error of the theory in the drive's terms.
    fn named(&self, error: StringError) -> SteadyError {
        match error {
            StringError::OutOfRange {
                quantity,
                pulley: Some(j),
                value,
                wanted,
            } => {
                let pulley = self.names[self.order[j]].clone();
                SteadyError::OutOfRange {
                    quantity,
                    pulley,
                    value,
                    wanted,
                }
            }
            other => SteadyError::String(other),
        }
    }

    /// The largest torque that may brake the pulley of index `pulley` in the drive if it is the only
    /// load [N m]; none for the speed-controlled pulley or where the belt is slack.
    pub fn largest_load(&self, pulley: usize) -> Result<Option<f64>, SteadyError> {
        let loaded = self.string_pulley(pulley);
        let mut alone = self.clone();
        for (j, other) in alone.string.pulleys.iter_mut().enumerate() {
            match &mut other.role {
                Role::SpeedControlled(_) if j == loaded => return Ok(None),
                Role::SpeedControlled(_) => {}
                // The capacity does not depend on how large the torque is.
                Role::Torque(torque) => *torque = if j == loaded { -1.0 } else { 0.0 },
            }
        }
        Ok(match alone.solve()? {
            // A factor on 1 N m.
            Answer::Running(running) => running.capacity.map(|capacity| capacity.factor),
            Answer::GrossSlip(slip) => Some(slip.capacity.factor),
            Answer::Slack(_) => None,
        })
    }

    /// What gross slip means, in a sentence.
    pub fn explain_gross_slip(&self, slip: &GrossSlip) -> String {
        let Capacity {
            factor,
            pulley,
            torque,
            ..
        } = slip.capacity;
        let name = &self.names[self.order[pulley]];
        let need = slip.slack_span.map_or_else(
            || {
                if slip.slip_angle.is_infinite() {
                    return "it has no friction".to_owned();
                }
                let (angle, wrap) = (slip.slip_angle.to_degrees(), slip.wrap_angle.to_degrees());
                format!(
                    "the torques need {angle:.1} degrees of slip, it is wrapped by {wrap:.1}, {:.3} degrees too few",
                    angle - wrap
                )
            },
            |span| {
                format!(
                    "before that, span \"{}\" would go slack",
                    self.span_name(self.span_behind(span))
                )
            },
        );
        format!(
            "gross slip on pulley \"{name}\": {need}; the drive carries {factor:.4} of the given torques, {:.6} N m on \
             \"{name}\"",
            torque.abs()
        )
    }

    /// What a slack belt means, in a sentence.
    pub fn explain_slack(&self, slack: &Slack) -> String {
        format!(
            "the belt is slack: it would hold {:.6} N without torque and needs more than {:.6} N to stay on the pulleys at \
             this speed; make it shorter or run slower",
            slack.tension, slack.needed_tension
        )
    }

    /// `+1` where a pulley turns counter-clockwise with the belt, `-1` where clockwise; by its
    /// index in the drive.
    pub fn rotation(&self, pulley: usize) -> f64 {
        self.direction * self.layout.arcs[pulley].sweep.signum()
    }

    /// Index in the string of the pulley of index `pulley` in the drive: the order is its own inverse.
    pub fn string_pulley(&self, pulley: usize) -> usize {
        self.order[pulley]
    }

    /// Index in the string of the span of index `span` in the drive's layout.
    pub fn string_span(&self, span: usize) -> usize {
        let count = self.names.len();
        self.order[if self.direction > 0.0 {
            span
        } else {
            (span + 1) % count
        }]
    }

    /// Index in the layout of the span that the string counts as behind its pulley `j`.
    pub fn span_behind(&self, j: usize) -> usize {
        span_behind(self.names.len(), self.direction, self.order[j])
    }

    /// Name of the span of index `span` in the drive's layout.
    pub fn span_name(&self, span: usize) -> String {
        format!(
            "{}-{}",
            self.names[span],
            self.names[(span + 1) % self.names.len()]
        )
    }
}

/// The one pulley of given speed and the speed it ends with.
fn speed_controlled(pulleys: &[Pulley]) -> Result<(usize, f64), SteadyError> {
    if let Some(pulley) = pulleys.iter().find(|pulley| pulley.angle.is_some()) {
        return Err(SteadyError::AngleDriven {
            pulley: pulley.name.clone(),
        });
    }
    if let Some(pulley) = pulleys.iter().find(|pulley| pulley.load.is_some()) {
        return Err(SteadyError::SpeedDependent {
            pulley: pulley.name.clone(),
        });
    }
    let mut driven = pulleys
        .iter()
        .enumerate()
        .filter_map(|(i, p)| Some((i, p, p.speed.as_ref()?)));
    let (index, pulley, speed) = driven.next().ok_or(SteadyError::NoSpeed)?;
    if let Some((_, second, _)) = driven.next() {
        let (first, second) = (pulley.name.clone(), second.name.clone());
        return Err(SteadyError::SeveralSpeeds { first, second });
    }
    let torque = final_value(&pulley.torque);
    if torque != 0.0 {
        return Err(SteadyError::SpeedAndTorque {
            pulley: pulley.name.clone(),
            torque,
        });
    }
    let speed = final_value(speed);
    if speed == 0.0 || !speed.is_finite() {
        return Err(SteadyError::AtRest {
            pulley: pulley.name.clone(),
            speed,
        });
    }
    Ok((index, speed))
}

/// What a profile ends with.
pub(super) fn final_value(profile: &Profile) -> f64 {
    match profile {
        Profile::Constant(value) => *value,
        Profile::Varying(Varying::Ramp { to, .. } | Varying::HalfCosine { to, .. }) => *to,
        Profile::Varying(Varying::Table { value, .. }) => value.last().copied().unwrap_or(0.0),
    }
}

#[cfg(test)]
mod tests;
