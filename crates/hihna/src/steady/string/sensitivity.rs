//! Derivatives of all results by all inputs, exact to round-off.
//!
//! The root x of the closure F(x, p) = 0 is differentiated implicitly, dx/dp = -F_p/F_x: one Newton
//! step in dual numbers from the real root. Everything behind the root is explicit in x and p and
//! carries the dual part along.
//!
//! Results have kinks where a slip zone changes its end: at zero torque the slip angle is |M| times
//! something, and power goes in or out (the derivatives for a torque that begins to brake are given);
//! where two pulleys reach gross slip together the capacity follows the first.

use std::fmt;

use num_dual::Dual64;

use super::closure::{Loop, Roots};
use super::{Number, Role, Running, StringDrive, StringError, Tightness, state};

/// Results of a running drive and their derivatives by its inputs.
#[derive(Clone, Debug, PartialEq)]
pub struct Sensitivity {
    /// Names of the inputs: `axial_stiffness`, `line_density`, `unstretched_length` or
    /// `initial_tension`, then `pulley.<i>.radius`, `.wrap_angle`, `.friction`, `.torque` or
    /// `.speed`, `.span`.
    pub inputs: Vec<String>,
    /// Names of the results: those of [`Running`] and its parts.
    pub results: Vec<String>,
    /// The results, SI.
    pub values: Vec<f64>,
    /// `derivatives[r][i]`: of result `r` by input `i`, SI.
    pub derivatives: Vec<Vec<f64>>,
}

impl StringDrive {
    /// Derivatives of all results by all inputs; nothing where the drive does not run (see
    /// [`StringDrive::solve`]).
    pub fn sensitivity(&self) -> Result<Option<Sensitivity>, StringError> {
        let driver = self.check()?;
        let belt = Loop::new(self, driver);
        let Roots::Running {
            running: root,
            capacity,
        } = belt.roots()?
        else {
            return Ok(None);
        };
        let running = state::running(self, &belt, root, capacity);
        let (mut results, mut values) = (Vec::new(), Vec::new());
        visit_results(&running, |name, value| {
            results.push(name.to_string());
            values.push(value);
        });
        let inputs = input_names(self);
        let mut derivatives = vec![vec![0.0; inputs.len()]; results.len()];
        let mut seeded = self.map(Dual64::from_re);
        for input in 0..inputs.len() {
            inputs_of(&mut seeded)[input].eps = 1.0;
            let running = state::running(&seeded, &Loop::new(&seeded, driver), root, capacity);
            inputs_of(&mut seeded)[input].eps = 0.0;
            let mut rows = derivatives.iter_mut();
            visit_results(&running, |_, value| {
                if let Some(row) = rows.next() {
                    row[input] = value.eps;
                }
            });
        }
        Ok(Some(Sensitivity {
            inputs,
            results,
            values,
            derivatives,
        }))
    }
}

/// The inputs of a drive, in the order of [`input_names`].
pub(super) fn inputs_of<D>(drive: &mut StringDrive<D>) -> Vec<&mut D> {
    let mut inputs = vec![&mut drive.axial_stiffness, &mut drive.line_density];
    inputs.push(match &mut drive.tightness {
        Tightness::UnstretchedLength(value) | Tightness::InitialTension(value) => value,
    });
    for pulley in &mut drive.pulleys {
        inputs.extend([
            &mut pulley.radius,
            &mut pulley.wrap_angle,
            &mut pulley.friction,
        ]);
        inputs.push(match &mut pulley.role {
            Role::SpeedControlled(value) | Role::Torque(value) => value,
        });
        inputs.push(&mut pulley.span);
    }
    inputs
}

fn input_names(drive: &StringDrive) -> Vec<String> {
    let tightness = match drive.tightness {
        Tightness::UnstretchedLength(_) => "unstretched_length",
        Tightness::InitialTension(_) => "initial_tension",
    };
    let mut names: Vec<String> = ["axial_stiffness", "line_density", tightness]
        .map(String::from)
        .into();
    for (i, pulley) in drive.pulleys.iter().enumerate() {
        let role = match pulley.role {
            Role::SpeedControlled(_) => "speed",
            Role::Torque(_) => "torque",
        };
        let parts = ["radius", "wrap_angle", "friction", role, "span"];
        names.extend(parts.map(|part| format!("pulley.{i}.{part}")));
    }
    names
}

/// Where a result stands in [`Running`].
#[derive(Clone, Copy)]
pub(super) enum ResultName {
    Pulley(usize, &'static str),
    Span(usize, &'static str),
    Whole(&'static str),
    Capacity(&'static str),
}

impl fmt::Display for ResultName {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Pulley(i, name) => write!(f, "pulley.{i}.{name}"),
            Self::Span(i, name) => write!(f, "span.{i}.{name}"),
            Self::Whole(name) => write!(f, "{name}"),
            Self::Capacity(name) => write!(f, "capacity.{name}"),
        }
    }
}

/// Every number of a running drive with its name, always in the same order.
pub(super) fn visit_results<D: Number>(running: &Running<D>, mut visit: impl FnMut(ResultName, D)) {
    for (i, p) in running.pulleys.iter().enumerate() {
        let mut part = |name, value| visit(ResultName::Pulley(i, name), value);
        part("speed", p.speed);
        part("torque", p.torque);
        part("power", p.power);
        part("slip_angle", p.slip_angle);
        part("stick_angle", p.stick_angle);
        part("slip_speed", p.slip_speed);
        part("speed_loss", p.speed_loss);
        part("friction_loss", p.friction_loss);
    }
    for (i, s) in running.spans.iter().enumerate() {
        let mut part = |name, value| visit(ResultName::Span(i, name), value);
        part("tension", s.tension);
        part("pressing_tension", s.pressing_tension);
        part("speed", s.speed);
        part("strain", s.strain);
    }
    let mut whole = |name, value| visit(ResultName::Whole(name), value);
    whole("unstretched_speed", running.unstretched_speed);
    whole("mass_flow", running.mass_flow);
    whole("unstretched_length", running.unstretched_length);
    whole("power_in", running.power_in);
    whole("power_out", running.power_out);
    whole("friction_loss", running.friction_loss);
    if let Some(efficiency) = running.efficiency {
        whole("efficiency", efficiency);
    }
    if let Some(capacity) = &running.capacity {
        let mut part = |name, value| visit(ResultName::Capacity(name), value);
        part("factor", capacity.factor);
        part("torque", capacity.torque);
        part("driver_torque", capacity.driver_torque);
    }
}
