//! The theory's answer in the drive's terms: names, signs counter-clockwise, vectors in its axes.

use serde::Serialize;

use super::DriveString;
use super::numbers::Path;
use crate::number::Number;
use crate::steady::string::Running;

/// The state of a pulley, signs counter-clockwise, vectors in the drive's axes.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PulleySummary<D = f64> {
    /// Name.
    #[serde(skip)]
    pub name: String,
    /// Angular speed [rad/s].
    pub speed: D,
    /// Torque of the belt on the pulley [N m].
    pub torque: D,
    /// External torque [N m].
    pub external_torque: D,
    /// Power that the belt gives to the pulley, negative on a driver [W].
    pub power: D,
    /// Force of the belt on the pulley [N]; with model `centrifugal` without the stretching
    /// acceleration's small share.
    pub hub_force: [D; 2],
    /// Speed of the belt at the exit less that of the surface [m/s].
    pub slip_speed: D,
    /// Wrap angle [rad].
    pub wrap_angle: D,
    /// Angle of the slip zone [rad].
    pub slip_angle: D,
    /// Angle of the stick zone [rad].
    pub stick_angle: D,
    /// How much slower the surface is than that of the speed-controlled pulley, relative [-].
    pub speed_loss: D,
    /// Power lost in the slip zone [W].
    pub friction_loss: D,
}

/// The state of a span.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SpanSummary<D = f64> {
    /// `<from>-<to>`, in the drive's order.
    #[serde(skip)]
    pub name: String,
    /// Axial force [N].
    pub tension: D,
    /// Axial force less momentum flow [N].
    pub pressing_tension: D,
    /// Engineering strain [-].
    pub strain: D,
    /// Speed of the belt, positive in the order of the pulleys [m/s].
    pub speed: D,
    /// Length [m].
    pub length: D,
}

impl DriveString {
    /// The pulleys of a running drive, in the drive's order.
    pub fn pulleys(&self, running: &Running) -> Vec<PulleySummary> {
        let path = self.numbers.path(&self.layout);
        (0..self.names.len())
            .map(|i| self.pulley(running, &path, i))
            .collect()
    }

    /// The spans of a running drive, in the drive's order: from each pulley to the next.
    pub fn spans(&self, running: &Running) -> Vec<SpanSummary> {
        let path = self.numbers.path(&self.layout);
        (0..self.names.len())
            .map(|i| self.span(running, &path, i))
            .collect()
    }

    pub(super) fn pulley<D: Number>(
        &self,
        running: &Running<D>,
        path: &Path<D>,
        i: usize,
    ) -> PulleySummary<D> {
        let count = self.names.len();
        let state = &running.pulleys[self.string_pulley(i)];
        let rotation = self.rotation(i);
        let before = (i + count - 1) % count;
        let pull = |span: usize, axis: usize| {
            let force = running.spans[self.string_span(span)].pressing_tension;
            force * path.tangents[span].direction[axis]
        };
        PulleySummary {
            name: self.names[i].clone(),
            speed: state.speed * rotation,
            torque: -state.torque * rotation,
            external_torque: state.torque * rotation,
            power: -state.power,
            hub_force: [0, 1].map(|axis| pull(i, axis) - pull(before, axis)),
            slip_speed: state.slip_speed * rotation,
            wrap_angle: path.wraps[i],
            slip_angle: state.slip_angle,
            stick_angle: state.stick_angle,
            speed_loss: state.speed_loss,
            friction_loss: state.friction_loss,
        }
    }

    pub(super) fn span<D: Number>(
        &self,
        running: &Running<D>,
        path: &Path<D>,
        i: usize,
    ) -> SpanSummary<D> {
        let state = &running.spans[self.string_span(i)];
        SpanSummary {
            name: self.span_name(i),
            tension: state.tension,
            pressing_tension: state.pressing_tension,
            strain: state.strain,
            speed: state.speed * self.direction,
            length: path.tangents[i].length,
        }
    }
}
