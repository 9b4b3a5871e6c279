//! What the string theory answers: speeds, tensions, slip, power, and how far gross slip is.

use super::closure::{Level, Loop, Root, Station};
use super::{Number, Role, StringDrive};

/// A drive that runs. Pulleys and spans in the order of [`StringDrive::pulleys`]; span `i` follows
/// pulley `i`.
#[derive(Clone, Debug, PartialEq)]
pub struct Running<D = f64> {
    /// Pulley by pulley.
    pub pulleys: Vec<PulleyState<D>>,
    /// Span by span.
    pub spans: Vec<SpanState<D>>,
    /// Speed v0 that the belt has where it is unstretched [m/s].
    pub unstretched_speed: D,
    /// Mass flow G [kg/s].
    pub mass_flow: D,
    /// Unstretched length of the belt [m].
    pub unstretched_length: D,
    /// Power that pulleys feed in [W].
    pub power_in: D,
    /// Power that pulleys take out [W].
    pub power_out: D,
    /// Power lost in the slip zones [W]: the difference.
    pub friction_loss: D,
    /// Power out over power in [-]; nothing where no power is fed in.
    pub efficiency: Option<D>,
    /// Where gross slip begins if all torques grow in proportion; nothing where no torque is
    /// transmitted. Its `factor` is the safety against gross slip.
    pub capacity: Option<Capacity<D>>,
    zones: Zones<D>,
}

/// A pulley in steady running.
#[derive(Clone, Debug, PartialEq)]
pub struct PulleyState<D = f64> {
    /// Angular speed along the belt's motion [rad/s].
    pub speed: D,
    /// External torque along the rotation [N m].
    pub torque: D,
    /// Power fed in, negative if taken out [W].
    pub power: D,
    /// Angle of the slip zone, at the exit [rad].
    pub slip_angle: D,
    /// Angle of the stick zone, at the inlet [rad].
    pub stick_angle: D,
    /// Speed of the belt at the exit less that of the surface [m/s].
    pub slip_speed: D,
    /// By how much the surface is slower than that of the speed-controlled pulley, relative [-].
    pub speed_loss: D,
    /// Power lost in the slip zone [W].
    pub friction_loss: D,
    /// d ln(T - G v)/d theta in the slip zone: ±mu' [-].
    pub growth: D,
    radius: D,
    friction: D,
    strain_in: D,
}

/// A free span in steady running.
#[derive(Clone, Debug, PartialEq)]
pub struct SpanState<D = f64> {
    /// Axial force T [N].
    pub tension: D,
    /// Axial force less momentum flow, T - G v (model capstan: T): it presses the belt on the
    /// pulleys and loads their hubs [N].
    pub pressing_tension: D,
    /// Belt speed [m/s].
    pub speed: D,
    /// Engineering strain [-].
    pub strain: D,
}

/// Gross slip under all torques grown in proportion.
#[derive(Clone, Debug, PartialEq)]
pub struct Capacity<D = f64> {
    /// Factor on all torques: safety against gross slip [-].
    pub factor: D,
    /// The pulley that slips first; of several at once, the first in belt order from the
    /// speed-controlled one.
    pub pulley: usize,
    /// Torque on that pulley when it slips: the largest that it transmits [N m].
    pub torque: D,
    /// Torque on the speed-controlled pulley then [N m].
    pub driver_torque: D,
}

/// The torques are too large: a pulley cannot stick anywhere.
#[derive(Clone, Debug, PartialEq)]
pub struct GrossSlip<D = f64> {
    /// Slip angle that the torques need on pulley `capacity.pulley`, more than its wrap; infinite
    /// where no tension would do [rad].
    pub slip_angle: D,
    /// Wrap angle of that pulley [rad].
    pub wrap_angle: D,
    /// Where no tension would do: the span (behind the pulley of this index) that would go slack.
    pub slack_span: Option<usize>,
    /// What the drive can carry; `factor` is below one.
    pub capacity: Capacity<D>,
}

/// The belt is too slack to press on the pulleys, even without torque.
#[derive(Clone, Debug, PartialEq)]
pub struct Slack<D = f64> {
    /// Axial force all around without torque [N]; negative would be a push.
    pub tension: D,
    /// The axial force above which the belt presses at this speed, m v0 v [N].
    pub needed_tension: D,
}

/// The belt at one place of a pulley.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BeltState<D = f64> {
    /// Engineering strain [-].
    pub strain: D,
    /// Axial force [N].
    pub tension: D,
    /// Belt speed [m/s].
    pub speed: D,
    /// Force of the pulley on the belt away from the centre, per length of the running belt [N/m].
    pub normal_force: D,
    /// Force of the pulley on the belt along the motion, per length of the running belt [N/m].
    pub friction_force: D,
    /// Belt speed less surface speed [m/s].
    pub slip_speed: D,
    /// Unstretched length of the belt between the inlet and here [m].
    pub unstretched_length: D,
}

/// What the zones of all pulleys share.
#[derive(Clone, Debug, PartialEq)]
struct Zones<D> {
    axial_stiffness: D,
    unstretched_speed: D,
    inertia: D,
    pressing: D,
    inertial_pressure: bool,
}

impl<D: Number> Running<D> {
    /// The belt on pulley `pulley`, `angle` [rad] behind its inlet, at most the wrap angle.
    pub fn on_pulley(&self, pulley: usize, angle: D) -> BeltState<D> {
        let state = &self.pulleys[pulley];
        let slipped = angle - state.stick_angle;
        if slipped.re() <= 0.0 {
            let length = angle * state.radius / (state.strain_in + 1.0);
            return self.belt_state(state, state.strain_in, D::zero(), length);
        }
        self.in_slip_zone(pulley, slipped)
    }

    /// The belt in the slip zone of pulley `pulley`, `slipped` [rad] behind the zone's beginning.
    /// There, where friction jumps from zero to full, it is the side of the slip zone that is
    /// given.
    pub fn in_slip_zone(&self, pulley: usize, slipped: D) -> BeltState<D> {
        let (state, zones) = (&self.pulleys[pulley], &self.zones);
        let stretch_in = state.strain_in + 1.0;
        let growth = (slipped * state.growth).exp_m1();
        let strain = state.strain_in + zones.pressure(state.strain_in) * growth / zones.pressing;
        let rise = ((strain - state.strain_in) / stretch_in).ln_1p();
        let passed = (slipped - rise / state.growth) * zones.pressing;
        let length = (state.stick_angle / stretch_in + passed) * state.radius;
        let direction = if state.growth.re() < 0.0 { 1.0 } else { -1.0 };
        self.belt_state(state, strain, state.friction * direction, length)
    }

    /// `grip`: friction per normal force, positive along the motion.
    fn belt_state(&self, state: &PulleyState<D>, strain: D, grip: D, length: D) -> BeltState<D> {
        let zones = &self.zones;
        let normal_force = zones.pressure(strain) * zones.axial_stiffness / state.radius;
        BeltState {
            strain,
            tension: strain * zones.axial_stiffness,
            speed: (strain + 1.0) * zones.unstretched_speed,
            normal_force,
            friction_force: normal_force * grip,
            slip_speed: (strain - state.strain_in) * zones.unstretched_speed,
            unstretched_length: length,
        }
    }
}

impl<D: Number> Zones<D> {
    fn pressure(&self, strain: D) -> D {
        if self.inertial_pressure {
            strain - self.inertia * (strain + 1.0)
        } else {
            strain
        }
    }
}

pub(super) fn running<D: Number>(
    drive: &StringDrive<D>,
    belt: &Loop<D>,
    root: Root,
    capacity: Option<Root>,
) -> Running<D> {
    let level = belt.running_level(root);
    let count = drive.pulleys.len();
    let v0 = surface_speed(drive) / (level.strain + 1.0);
    let first = (count - belt.driver) % count;
    let stations = (0..count).map(|i| &belt.stations[(first + i) % count]);
    let k = drive.axial_stiffness;
    let (pulleys, spans): (Vec<_>, Vec<_>) = stations
        .map(|station| passing(belt, &level, station, k, v0))
        .unzip();
    let sum =
        |part: fn(&PulleyState<D>) -> D| pulleys.iter().map(part).fold(D::zero(), |a, b| a + b);
    let power_in = sum(|p| {
        if p.power.re() > 0.0 {
            p.power
        } else {
            D::zero()
        }
    });
    // An idler counts as braked, so that its derivatives are those of a torque that begins to brake.
    let power_out = sum(|p| {
        if p.power.re() > 0.0 {
            D::zero()
        } else {
            -p.power
        }
    });
    Running {
        unstretched_speed: v0,
        mass_flow: drive.line_density * v0,
        unstretched_length: drive.path_length() - belt.lengthening(&level),
        power_in,
        power_out,
        friction_loss: sum(|p| p.friction_loss),
        efficiency: (power_in.re() > 0.0).then(|| power_out / power_in),
        capacity: capacity.map(|root| capacity_at(drive, belt, root)),
        zones: Zones {
            axial_stiffness: k,
            unstretched_speed: v0,
            inertia: level.inertia,
            pressing: level.pressing,
            inertial_pressure: drive.model != super::Model::Capstan,
        },
        pulleys,
        spans,
    }
}

/// One pulley and the span behind it.
fn passing<D: Number>(
    belt: &Loop<D>,
    level: &Level<D>,
    station: &Station<D>,
    k: D,
    v0: D,
) -> (PulleyState<D>, SpanState<D>) {
    let passage = belt.passage(level, station);
    let gain = -station.pull / level.pulling;
    let speed = v0 * (passage.strain_in + 1.0) / station.radius;
    let torque = station.pull * k * station.radius;
    let pulley = PulleyState {
        speed,
        torque,
        power: torque * speed,
        slip_angle: passage.slip_angle,
        stick_angle: station.wrap - passage.slip_angle,
        slip_speed: v0 * gain,
        speed_loss: -station.before / level.pulling / (level.strain + 1.0),
        friction_loss: -station.pull * gain * k * v0 * 0.5,
        growth: passage.growth,
        radius: station.radius,
        friction: station.friction,
        strain_in: passage.strain_in,
    };
    let strain = passage.strain_out;
    let span = SpanState {
        tension: strain * k,
        pressing_tension: belt.pressure(level, strain) * k,
        speed: v0 * (strain + 1.0),
        strain,
    };
    (pulley, span)
}

pub(super) fn gross_slip<D: Number>(
    drive: &StringDrive<D>,
    belt: &Loop<D>,
    formal: Option<Root>,
    capacity: Root,
) -> GrossSlip<D> {
    let capacity = capacity_at(drive, belt, capacity);
    let count = drive.pulleys.len();
    let station = &belt.stations[(capacity.pulley + count - belt.driver) % count];
    let slip_angle =
        formal
            .filter(|_| station.friction.re() > 0.0)
            .map_or(D::from(f64::INFINITY), |root| {
                let level = belt.running_level(root);
                belt.passage(&level, station).slip_angle
            });
    let slack_span = formal.is_none().then(|| belt.slackest_span());
    GrossSlip {
        slip_angle,
        wrap_angle: station.wrap,
        slack_span,
        capacity,
    }
}

pub(super) fn slack<D: Number>(drive: &StringDrive<D>, belt: &Loop<D>) -> Slack<D> {
    let k = drive.axial_stiffness;
    let level = belt.level(belt.rest_strain, D::one());
    let needed = level.strain - belt.pressure(&level, level.strain);
    Slack {
        tension: level.strain * k,
        needed_tension: needed * k,
    }
}

fn capacity_at<D: Number>(drive: &StringDrive<D>, belt: &Loop<D>, root: Root) -> Capacity<D> {
    let (level, limiting) = belt.capacity_level(root);
    let k = drive.axial_stiffness;
    let torque = |station: &Station<D>| station.pull * k * station.radius * level.torques;
    Capacity {
        factor: level.torques,
        pulley: (limiting + belt.driver) % drive.pulleys.len(),
        torque: torque(&belt.stations[limiting]),
        driver_torque: torque(&belt.stations[0]),
    }
}

/// Surface speed of the speed-controlled pulley.
fn surface_speed<D: Number>(drive: &StringDrive<D>) -> D {
    drive
        .pulleys
        .iter()
        .fold(D::zero(), |speed, pulley| match pulley.role {
            Role::SpeedControlled(angular) => angular * pulley.radius,
            Role::Torque(_) => speed,
        })
}
