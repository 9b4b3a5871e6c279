//! A drive as the string theory sees it, and the theory's answer in the drive's own terms: names,
//! signs, order.
//!
//! Speeds and torques are those that the drive's profiles end with. The belt moves as the surface
//! of the speed-controlled pulley does; the string theory counts pulleys in that direction, the
//! drive in the order of its list. Axial stiffness `k = axial_factor E A`, line density `rho A`;
//! tension at rest and unstretched length are tied by the string's law `T = k (L/L0 - 1)` on the
//! path of rigid pulleys. Bending, shear, penetration and the creep slope of the friction law have
//! no place in this theory.

use serde::Serialize;

use crate::drive::{Belt, Drive, Pulley};
use crate::layout::{Layout, LayoutError};
use crate::profile::{Profile, Varying};
use crate::steady::string::{
    Answer, Capacity, Closure, GrossSlip, Model, Role, Running, Slack, StringDrive, StringError,
    StringPulley, Tightness,
};

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
}

/// The state of a pulley, signs counter-clockwise, vectors in the drive's axes.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PulleySummary {
    /// Name.
    #[serde(skip)]
    pub name: String,
    /// Angular speed [rad/s].
    pub speed: f64,
    /// Torque of the belt on the pulley [N m].
    pub torque: f64,
    /// External torque [N m].
    pub external_torque: f64,
    /// Power of the external torque, negative where power is taken out [W].
    pub power: f64,
    /// Force of the belt on the pulley [N]; with model `centrifugal` without the stretching
    /// acceleration's small share.
    pub hub_force: [f64; 2],
    /// Speed of the belt at the exit less that of the surface [m/s].
    pub slip_speed: f64,
    /// Wrap angle [rad].
    pub wrap_angle: f64,
    /// Angle of the slip zone [rad].
    pub slip_angle: f64,
    /// Angle of the stick zone [rad].
    pub stick_angle: f64,
    /// How much slower the surface is than that of the speed-controlled pulley, relative [-].
    pub speed_loss: f64,
    /// Power lost in the slip zone [W].
    pub friction_loss: f64,
}

/// The state of a span.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SpanSummary {
    /// `<from>-<to>`, in the drive's order.
    #[serde(skip)]
    pub name: String,
    /// Axial force [N].
    pub tension: f64,
    /// Axial force less momentum flow [N].
    pub pressing_tension: f64,
    /// Engineering strain [-].
    pub strain: f64,
    /// Speed of the belt, positive along its motion [m/s].
    pub speed: f64,
    /// Length [m].
    pub length: f64,
}

/// Why a drive has no steady running to ask for.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SteadyError {
    /// The pulleys cannot carry the belt.
    #[error(transparent)]
    Layout(#[from] LayoutError),
    /// No pulley is driven.
    #[error(
        "no pulley has a `speed`: exactly one must, the others turn by the belt and their `torque`"
    )]
    NoSpeed,
    /// Several pulleys are driven.
    #[error(
        "pulleys \"{first}\" and \"{second}\" both have a `speed`: steady running needs exactly one; give the other its `torque`"
    )]
    SeveralSpeeds {
        /// Name of the one.
        first: String,
        /// Name of another.
        second: String,
    },
    /// A pulley has both speed and torque.
    #[error(
        "pulley \"{pulley}\" has a `speed` and a `torque` of {torque} N m: drop one, the torque of a pulley of given speed is found"
    )]
    SpeedAndTorque {
        /// Name of the pulley.
        pulley: String,
        /// Its torque [N m].
        torque: f64,
    },
    /// A pulley is driven by its angle.
    #[error("pulley \"{pulley}\" is driven by its `angle`: give its `speed` for steady running")]
    AngleDriven {
        /// Name of the pulley.
        pulley: String,
    },
    /// The driven pulley ends at rest.
    #[error(
        "the speed of pulley \"{pulley}\" ends with {speed} rad/s: steady running needs one that turns"
    )]
    AtRest {
        /// Name of the pulley.
        pulley: String,
        /// The final value [rad/s].
        speed: f64,
    },
    /// The belt's length is not given.
    #[error("the belt has none of `length`, `tension`, `strain`: give one")]
    NoTightness,
    /// A quantity of a pulley is out of its range.
    #[error("the {quantity} of pulley \"{pulley}\" is {value}: it must be {wanted}")]
    OutOfRange {
        /// The quantity with its unit.
        quantity: &'static str,
        /// Name of the pulley.
        pulley: String,
        /// Its value, SI.
        value: f64,
        /// What it must be.
        wanted: &'static str,
    },
    /// Anything else that the theory refuses.
    #[error(transparent)]
    String(StringError),
}

impl DriveString {
    /// Makes a drive ready.
    pub fn new(drive: &Drive, model: Model, closure: Closure) -> Result<Self, SteadyError> {
        let layout = Layout::of(drive)?;
        let (driver, speed) = speed_controlled(&drive.pulley)?;
        let direction = speed.signum() * layout.arcs[driver].sweep.signum();
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
        let area = drive.belt.width * drive.belt.thickness;
        let axial_stiffness = drive.belt.axial_factor * drive.belt.youngs_modulus * area;
        let mut prepared = Self {
            string: StringDrive {
                axial_stiffness,
                line_density: drive.belt.density * area,
                tightness: tightness(&drive.belt, axial_stiffness)?,
                pulleys: Vec::with_capacity(count),
                model,
                closure,
            },
            names: drive
                .pulley
                .iter()
                .map(|pulley| pulley.name.clone())
                .collect(),
            layout,
            order,
            direction,
        };
        for j in 0..count {
            let i = prepared.order[j];
            let arc = &prepared.layout.arcs[i];
            let role = if i == driver {
                Role::SpeedControlled(speed.abs())
            } else {
                Role::Torque(prepared.rotation(i) * final_value(&drive.pulley[i].torque))
            };
            let pulley = StringPulley {
                radius: arc.radius,
                wrap_angle: arc.sweep.abs(),
                friction: drive.coefficient_on(&drive.pulley[i]),
                role,
                span: prepared.layout.spans[prepared.span_behind(j)].length,
            };
            prepared.string.pulleys.push(pulley);
        }
        Ok(prepared)
    }

    /// Solves the drive; see [`StringDrive::solve`].
    pub fn solve(&self) -> Result<Answer, SteadyError> {
        self.string.solve().map_err(|error| match error {
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
        })
    }

    /// The pulleys of a running drive, in the drive's order.
    pub fn pulleys(&self, running: &Running) -> Vec<PulleySummary> {
        (0..self.names.len())
            .map(|i| self.pulley(running, i))
            .collect()
    }

    /// The spans of a running drive, in the drive's order: from each pulley to the next.
    pub fn spans(&self, running: &Running) -> Vec<SpanSummary> {
        (0..self.names.len())
            .map(|i| {
                let (span, state) = (&self.layout.spans[i], &running.spans[self.string_span(i)]);
                SpanSummary {
                    name: self.span_name(i),
                    tension: state.tension,
                    pressing_tension: state.pressing_tension,
                    strain: state.strain,
                    speed: state.speed,
                    length: span.length,
                }
            })
            .collect()
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
                let angles = (slip.slip_angle.to_degrees(), slip.wrap_angle.to_degrees());
                format!(
                    "the torques need {:.1} degrees of slip, it is wrapped by {:.1}",
                    angles.0, angles.1
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
        let count = self.names.len();
        let i = self.order[j];
        if self.direction > 0.0 {
            i
        } else {
            (i + count - 1) % count
        }
    }

    /// Name of the span of index `span` in the drive's layout.
    pub fn span_name(&self, span: usize) -> String {
        format!(
            "{}-{}",
            self.names[span],
            self.names[(span + 1) % self.names.len()]
        )
    }

    fn pulley(&self, running: &Running, i: usize) -> PulleySummary {
        let count = self.names.len();
        let state = &running.pulleys[self.string_pulley(i)];
        let rotation = self.rotation(i);
        let before = (i + count - 1) % count;
        let pull = |span: usize, sign: f64| {
            let force = sign * running.spans[self.string_span(span)].pressing_tension;
            let line = &self.layout.spans[span];
            [0, 1].map(|axis| force * (line.end[axis] - line.start[axis]) / line.length)
        };
        let (ahead, back) = (pull(i, 1.0), pull(before, -1.0));
        PulleySummary {
            name: self.names[i].clone(),
            speed: rotation * state.speed,
            torque: -rotation * state.torque,
            external_torque: rotation * state.torque,
            power: state.power,
            hub_force: [ahead[0] + back[0], ahead[1] + back[1]],
            slip_speed: rotation * state.slip_speed,
            wrap_angle: self.layout.arcs[i].sweep.abs(),
            slip_angle: state.slip_angle,
            stick_angle: state.stick_angle,
            speed_loss: state.speed_loss,
            friction_loss: state.friction_loss,
        }
    }
}

/// The one pulley of given speed and the speed it ends with.
fn speed_controlled(pulleys: &[Pulley]) -> Result<(usize, f64), SteadyError> {
    if let Some(pulley) = pulleys.iter().find(|pulley| pulley.angle.is_some()) {
        return Err(SteadyError::AngleDriven {
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

fn tightness(belt: &Belt, axial_stiffness: f64) -> Result<Tightness, SteadyError> {
    match (belt.length, belt.tension, belt.strain) {
        (Some(length), ..) => Ok(Tightness::UnstretchedLength(length)),
        (_, Some(tension), _) => Ok(Tightness::InitialTension(tension)),
        (.., Some(strain)) => Ok(Tightness::InitialTension(axial_stiffness * strain)),
        _ => Err(SteadyError::NoTightness),
    }
}

/// What a profile ends with.
fn final_value(profile: &Profile) -> f64 {
    match profile {
        Profile::Constant(value) => *value,
        Profile::Varying(Varying::Ramp { to, .. } | Varying::HalfCosine { to, .. }) => *to,
        Profile::Varying(Varying::Table { value, .. }) => value.last().copied().unwrap_or(0.0),
    }
}

#[cfg(test)]
mod tests;
