//! Steady running of a belt of finite elements, solved directly.
//!
//! In steady running every material point follows the same path. With X the reference arc length along the loop and the
//! mesh coordinate `xi = X + c t` the belt is `r(X, t) = R(xi)`, `r_y(X, t) = D(xi)`: the mesh stays, the belt runs
//! through it with the circulation speed c (positive in the order of the nodes). Velocities are `c R'`, `c D'`,
//! accelerations `c² R''`, `c² D''`. Mass flow `rho A c` and unstretched length are kept by construction.
//! For the unknowns `[nodal coordinates e, omega of every pulley, c, lambda]`
//!
//! ```text
//! -dU/de + int rho A c² N'^T N' e dxi + int rho I2 c² H'^T H' e dxi + sum over pulleys int N^T (f_n n + f_t t) dxi + gravity = 0
//! -int (R - d) f_t dxi + lambda T_p(omega_p) = 0      or   omega_p = prescribed      for every pulley
//! (r_k - r_k0) . t_k0 = 0                              the phase: the mesh does not slide along the belt's path
//! lambda = 1                                           or   the slip is given and lambda is found
//! ```
//!
//! with elements, contact and friction of the time run. The problem does not change when the mesh slides along
//! itself, so `R'` is a null vector of the tangent; the matching left one is the balance of the tangential forces along
//! the whole belt, and that fixes c. Bordered with column c and the phase the matrix is regular, cyclic
//! block-tridiagonal, and not symmetric.

/// Runs `$body` with `$element` the type of the drive's belt elements.
macro_rules! with_belt_element {
    ($drive:expr, $element:ident => $body:expr) => {
        match $drive.belt.element {
            // Belts in space are refused before an element is made.
            $crate::drive::BeltElement::BeltBeam
            | $crate::drive::BeltElement::Plate
            | $crate::drive::BeltElement::BeltBeam3d
            | $crate::drive::BeltElement::LinearBeam3d => {
                type $element = ancf::element::BeltBeam2;
                $body
            }
            $crate::drive::BeltElement::CubicBeam => {
                type $element = ancf::element::CubicBeam2;
                $body
            }
            $crate::drive::BeltElement::LinearBeam => {
                type $element = ancf::element::LinearBeam2;
                $body
            }
        }
    };
}

mod bristles;
pub mod campbell;
mod contact;
mod continuation;
mod equations;
mod inertia;
mod line;
pub mod map;
mod material;
mod mesh;
pub mod modes;
mod motion;
mod newton;
mod prepare;
pub mod sensitivity;
mod split;
pub mod summary;

use ancf::dynamics::Motion;
use thiserror::Error;

use crate::assemble::{Assembly, AssemblyError, BeltElementType, Mounting, Warning};
use crate::drive::Drive;
use crate::friction::Law;
use crate::input::{NumberField, NumberRefused};
use crate::layout::Layout;
use crate::observe::{Observer, Powers, ProfileRow, PulleyState, SpanState};
use crate::simulate::{RunError, StartState};
use crate::steady::drive_string::{DriveSensitivity, SteadyError};

use continuation::Way;
use equations::Equations;
use modes::{Mode, NoModes};
use newton::Newton;

/// Part of the tension at rest beyond which centrifugal forces may be what lifts a belt off its pulleys.
const LIFT_OFF: f64 = 0.9;
/// Relative power residual beyond which a solution deserves a warning.
pub const POWER_TOLERANCE: f64 = 1.0e-3;
/// A drive that turns hardly any power over is judged by this part of the power that its tension on the rigid path would
/// carry.
const LEAST_POWER: f64 = 0.01;

/// A drive for which steady running cannot be asked or was not found.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum RunningError {
    /// The drive has no steady running to ask for.
    #[error(transparent)]
    Drive(#[from] SteadyError),
    /// The drive cannot be put together.
    #[error(transparent)]
    Assembly(#[from] AssemblyError),
    /// The belt does not settle on its pulleys.
    #[error(transparent)]
    Start(#[from] RunError),
    /// The modes were not found.
    #[error(transparent)]
    Modes(#[from] NoModes),
    /// A field cannot have this value.
    #[error("{0}")]
    Field(String),
    /// The state is on the verge of what can be solved.
    #[error(
        "the running state is singular: more slip carries no more, or hardly any friction holds the belt"
    )]
    Singular,
    /// Derivatives did not converge.
    #[error(
        "the derivatives by `{field}` were not found: the last correction is {left:.0e} m per unit of it"
    )]
    Derivatives {
        /// The field.
        field: String,
        /// Last correction [m per unit of the field].
        left: f64,
    },
    /// Solutions were lost on the way from the drive without torques.
    #[error(
        "no steady running was found: raising the torques from none, solutions were followed to {factor:.4} times those of the drive"
    )]
    Lost {
        /// Factor on the torques that was reached.
        factor: f64,
    },
    /// Not even the drive without its torques was found to run.
    #[error("no steady running was found, not even without torques{0}")]
    NotFound(Obstacle),
}

/// What stands in the way of steady running, as far as it can be told.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum Obstacle {
    /// The belt lifts off its pulleys.
    #[error(
        ": at {speed:.4} m/s centrifugal forces take {centrifugal:.4} N of what holds the belt on its pulleys, {tension:.4} N at rest"
    )]
    LiftOff {
        /// Speed of the belt [m/s].
        speed: f64,
        /// Its centrifugal tension `rho A v²` [N].
        centrifugal: f64,
        /// Its tension at rest [N].
        tension: f64,
    },
    /// Sections that turn in bending pass their waves on behind the belt: `rho v² > alpha2 E`.
    #[error(
        ": at {speed:.4} m/s the belt runs faster than waves of its bending do in it, {waves:.4} m/s, and no shape stands still"
    )]
    BendingWaves {
        /// Speed of the belt [m/s].
        speed: f64,
        /// `sqrt(alpha2 E / rho)` [m/s].
        waves: f64,
    },
    /// Pulleys that are driven at different speeds drag the belt along.
    #[error(": the surfaces of driven pulleys run at {slowest:.6} to {fastest:.6} m/s")]
    Drivers {
        /// Least surface speed of a driver [m/s], in the order of the pulleys.
        slowest: f64,
        /// Largest one [m/s].
        fastest: f64,
    },
    /// Nothing is known.
    #[error("")]
    Unknown,
}

impl RunningError {
    fn refused(error: &NumberRefused) -> Self {
        Self::Field(error.to_string())
    }
}

/// What a drive does in the end.
#[derive(Clone, Debug, PartialEq)]
pub enum Answer {
    /// It runs.
    Running(Box<Running>),
    /// It slips as a whole: the torques are beyond what friction carries.
    GrossSlip(GrossSlip),
    /// A span has gone slack: this is no belt drive any more.
    Slack(Slack),
}

/// A drive that runs steadily.
#[derive(Clone, Debug, PartialEq)]
pub struct Running {
    /// Circulation speed c [m/s]: unstretched length of belt that passes any place per time, positive in the order
    /// of the pulleys.
    pub circulation: f64,
    /// The pulleys.
    pub pulleys: Vec<PulleyState>,
    /// The free spans.
    pub spans: Vec<SpanState>,
    /// Powers.
    pub powers: Powers,
    /// Power that is neither put in nor taken out nor lost, relative to `power_scale` [-]: what the elements do not resolve.
    pub power_residual: f64,
    /// The power put in [W], or a hundredth of tension on rigid pulleys times speed of the belt, if that is more.
    pub power_scale: f64,
    /// The belt point by point.
    pub profile: Vec<ProfileRow>,
    /// Newton iterations of the last solution.
    pub iterations: usize,
    /// Tangents factored on the way.
    pub factorizations: usize,
    /// How the solution was found.
    pub found: Found,
    /// All unknowns: nodal coordinates, speeds of the pulleys, c, load factor.
    pub state: Vec<f64>,
}

/// How a solution was found.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Found {
    /// By Newton's method from a belt that does not slip.
    Directly,
    /// Through easier friction.
    EasierFriction,
    /// With the slip given in place of the torques.
    GivenSlip,
}

/// What is known of the most that a drive carries.
#[derive(Clone, Debug, PartialEq)]
pub enum Most {
    /// More slip carries no more.
    Known(Capacity),
    /// Up to this factor on all external torques it runs [-]; the solutions beyond were not found, though more slip still carried
    /// more.
    AtLeast(f64),
}

impl Most {
    /// The most itself, if it is known.
    pub fn known(&self) -> Option<&Capacity> {
        match self {
            Self::Known(capacity) => Some(capacity),
            Self::AtLeast(_) => None,
        }
    }
}

/// The most that a drive carries.
#[derive(Clone, Debug, PartialEq)]
pub struct Capacity {
    /// Factor on all external torques [-].
    pub factor: f64,
    /// Index of the pulley that slips first.
    pub pulley: usize,
    /// External torques then, by pulley [N m]; of driven pulleys what they take.
    pub torques: Vec<f64>,
    /// Smallest tension of a span then [N].
    pub slack_tension: f64,
}

/// Gross slip.
#[derive(Clone, Debug, PartialEq)]
pub struct GrossSlip {
    /// The most that the drive carries: less than the torques.
    pub capacity: Capacity,
}

impl GrossSlip {
    /// The torques over the most that the drive carries [-].
    pub fn overload(&self) -> f64 {
        1.0 / self.capacity.factor
    }
}

/// A slack span.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slack {
    /// Its index in the order of the pulleys.
    pub span: usize,
    /// Its axial force in the solution [N], not positive.
    pub tension: f64,
}

/// A drive made ready to be solved: the belt on its pulleys and the equations of its steady running.
#[derive(Debug)]
pub struct RunningBelt<E> {
    /// Names of the pulleys.
    pub names: Vec<String>,
    /// The equilibrium at rest from which the guess is made.
    pub start: StartState,
    /// Where the elements begin, as parts of the belt.
    pub starts: Vec<f64>,
    assembly: Assembly<E>,
    observer: Observer,
    laws: Vec<Law>,
    /// Of the pulleys [kg m²].
    inertias: Vec<f64>,
    /// Mass per unstretched length [kg/m].
    line_density: f64,
    /// Speed of waves of bending in the belt, `sqrt(alpha2 E / rho)` [m/s].
    bending_waves: f64,
    equations: Equations<E>,
    newton: Newton,
    guess: Vec<f64>,
}

impl<E: BeltElementType> RunningBelt<E> {
    /// The belt's path.
    pub fn layout(&self) -> &Layout {
        &self.assembly.layout
    }

    /// How tight the belt is.
    pub fn mounting(&self) -> &Mounting {
        &self.assembly.mounting
    }

    /// Things to tell the user.
    pub fn warnings(&self) -> &[Warning] {
        &self.assembly.warnings
    }

    /// Number of unknowns.
    pub fn dofs(&self) -> usize {
        self.guess.len()
    }

    /// What the drive does.
    pub fn solve(&mut self) -> Result<Answer, RunningError> {
        self.newton.factorizations = 0;
        let mut z = self.guess.clone();
        if let Ok(found) = self.newton(&mut z) {
            return Ok(self.unless_sliding(z, found.iterations, Found::Directly));
        }
        if let Ok(found) = self.by_easier_friction(&mut z) {
            return Ok(self.unless_sliding(z, found.iterations, Found::EasierFriction));
        }
        match self.raise_from_idling() {
            Some(Way::Reached(z)) => Ok(self.answer(z, 0, Found::GivenSlip)),
            Some(Way::Exhausted(capacity)) => Ok(Answer::GrossSlip(GrossSlip { capacity })),
            Some(Way::Lost(factor)) => Err(RunningError::Lost { factor }),
            None => Err(self.not_found()),
        }
    }

    /// The answer that the state `z` is; where a pulley slides as a whole in it, gross slip if less torque brings that about, too. A belt that
    /// sliding slows down may still find an equilibrium, with less centrifugal force or load.
    fn unless_sliding(&mut self, z: Vec<f64>, iterations: usize, found: Found) -> Answer {
        if self.slides(&z) {
            match self.raise_from_idling() {
                Some(Way::Exhausted(capacity)) if capacity.factor < 1.0 => {
                    return Answer::GrossSlip(GrossSlip { capacity });
                }
                Some(Way::Reached(z)) => return self.answer(z, 0, Found::GivenSlip),
                _ => {}
            }
        }
        self.answer(z, iterations, found)
    }

    /// The answer found by Newton's method from `z`, the state of a neighbour, if it finds one.
    fn solve_near(&mut self, z: &[f64]) -> Option<Answer> {
        self.newton.factorizations = 0;
        let mut z = z.to_vec();
        let (chain, load) = (self.equations.chain(), self.equations.load());
        z[load] = 1.0;
        // Another speed: all speeds in proportion.
        let driven = (self.equations.prescribed.iter().enumerate())
            .find_map(|(p, speed)| speed.map(|speed| speed / z[chain + p]));
        for value in &mut z[chain..load] {
            *value *= driven.unwrap_or(1.0);
        }
        let found = self.newton(&mut z).ok()?;
        Some(self.unless_sliding(z, found.iterations, Found::Directly))
    }

    fn not_found(&self) -> RunningError {
        let speed = self.guess[self.equations.circulation()].abs();
        let centrifugal = self.line_density * speed * speed;
        let tension = self.start.tension;
        let drivers = || {
            let surfaces = self
                .equations
                .prescribed
                .iter()
                .zip(&self.assembly.layout.arcs);
            surfaces.filter_map(|(speed, arc)| {
                speed.map(|speed| speed * arc.radius * arc.sweep.signum())
            })
        };
        let slowest = drivers().fold(f64::INFINITY, f64::min);
        let fastest = drivers().fold(f64::NEG_INFINITY, f64::max);
        RunningError::NotFound(if centrifugal > LIFT_OFF * tension {
            Obstacle::LiftOff {
                speed,
                centrifugal,
                tension,
            }
        } else if speed > self.bending_waves {
            Obstacle::BendingWaves {
                speed,
                waves: self.bending_waves,
            }
        } else if fastest - slowest > 1.0e-9 * fastest.abs() {
            Obstacle::Drivers { slowest, fastest }
        } else {
            Obstacle::Unknown
        })
    }

    /// The most that the drive carries, from the state in which it runs; nothing where no torque acts.
    pub fn capacity(&mut self, running: &Running) -> Option<Most> {
        let none = self.idle_slip();
        match self.by_slip(&running.state, none, None)? {
            Way::Exhausted(capacity) => Some(Most::Known(capacity)),
            Way::Lost(factor) => Some(Most::AtLeast(factor)),
            Way::Reached(_) => None,
        }
    }

    fn answer(&mut self, state: Vec<f64>, iterations: usize, found: Found) -> Answer {
        let mut running = self.observe(&state);
        running.state = state;
        running.iterations = iterations;
        running.found = found;
        running.factorizations = self.newton.factorizations;
        let slackest = (running.spans.iter().enumerate())
            .min_by(|a, b| a.1.tension.total_cmp(&b.1.tension))
            .map(|(span, state)| (span, state.tension));
        match slackest {
            Some((span, tension)) if tension <= 0.0 => Answer::Slack(Slack { span, tension }),
            _ => Answer::Running(Box::new(running)),
        }
    }

    /// Everything that the unknowns `z` say, except how they were found.
    fn observe(&mut self, z: &[f64]) -> Running {
        let motion = self.equations.motion(z);
        let mesh = &self.equations.mesh;
        let points = self.equations.contact.belt_points(mesh, motion);
        let contacts = self.equations.contact.resultants(&points, motion.speeds);
        let circulation = motion.circulation;
        let system = &self.assembly.system;
        let chain = self.equations.chain();
        let pulleys = self.names.len();
        let mut seen = Motion::zero(chain + pulleys);
        seen.q[..chain].copy_from_slice(&z[..chain]);
        seen.v[chain..].copy_from_slice(&z[chain..chain + pulleys]);
        let laws = &self.equations.contact.pulleys;
        self.observer
            .take_points(mesh, laws, &z[..chain], &points, contacts);
        let mut states = vec![PulleyState::default(); pulleys];
        self.observer.pulleys(system, &seen, &mut states);
        let mut spans = vec![SpanState::default(); pulleys];
        self.observer.spans(&self.assembly.layout, &mut spans);
        for (p, state) in states.iter_mut().enumerate() {
            if self.equations.prescribed[p].is_none() {
                state.external_torque *= z[self.equations.load()];
            }
        }
        let powers = self.observer.powers(system, &seen);
        let put_in: f64 = (states.iter())
            .map(|p| (p.external_torque * p.speed).max(0.0))
            .sum();
        let idle = LEAST_POWER * self.assembly.mounting.tension * circulation.abs();
        let power_scale = put_in.max(idle);
        let left = powers.input + powers.load - powers.friction - powers.contact;
        Running {
            circulation,
            pulleys: states,
            spans,
            powers,
            power_residual: left / power_scale,
            power_scale,
            profile: self.observer.profile(0.0, &self.assembly.element_start),
            iterations: 0,
            factorizations: 0,
            found: Found::Directly,
            state: Vec::new(),
        }
    }
}

/// What was found of a drive, with the model that it was found on.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// What the drive does.
    pub answer: Answer,
    /// The most that it carries, if it runs and torques act.
    pub capacity: Option<Most>,
    /// The belt's path.
    pub layout: Layout,
    /// How tight the belt is on its path.
    pub mounting: Mounting,
    /// The equilibrium at rest.
    pub start: StartState,
    /// Number of unknowns.
    pub dofs: usize,
    /// Things to tell the user.
    pub warnings: Vec<Warning>,
}

/// Finds what `drive` settles to and how much it carries.
pub fn solve(drive: &Drive) -> Result<Outcome, RunningError> {
    study(drive, &[], 0).map(|study| study.outcome)
}

/// What was found of a drive, and what surrounds it.
#[derive(Clone, Debug)]
pub struct Study {
    /// The running drive.
    pub outcome: Outcome,
    /// Derivatives of the results, if fields were given and the drive runs.
    pub sensitivity: Option<DriveSensitivity>,
    /// Modes about the running state, if asked for and the drive runs.
    pub modes: Option<Vec<Mode>>,
}

/// [`solve`], with the derivatives of the results by `fields` and `modes` modes if the drive runs.
pub fn study(drive: &Drive, fields: &[NumberField], modes: usize) -> Result<Study, RunningError> {
    with_belt_element!(drive, Element => {
        let mut belt = RunningBelt::<Element>::new(drive)?;
        let answer = belt.solve()?;
        let capacity = match &answer {
            Answer::Running(running) => belt.capacity(running),
            _ => None,
        };
        let sensitivity = match &answer {
            Answer::Running(running) if !fields.is_empty() => {
                Some(belt.sensitivity(drive, running, fields)?)
            }
            _ => None,
        };
        let modes = match &answer {
            Answer::Running(running) if modes > 0 => Some(belt.modes(running, modes)?),
            _ => None,
        };
        let outcome = Outcome {
            answer,
            capacity,
            layout: belt.layout().clone(),
            mounting: *belt.mounting(),
            start: belt.start,
            dofs: belt.dofs(),
            warnings: belt.warnings().to_vec(),
        };
        Ok(Study {
            outcome,
            sensitivity,
            modes,
        })
    })
}

/// Sums of force and moment about the origin that the pulleys take from the belt, zero in steady running without gravity.
pub fn force_and_moment(running: &Running, centers: &[[f64; 2]]) -> ([f64; 2], f64) {
    let mut force = [0.0; 2];
    let mut moment = 0.0;
    for (pulley, center) in running.pulleys.iter().zip(centers) {
        let [fx, fy] = pulley.hub_force;
        force[0] += fx;
        force[1] += fy;
        moment += center[0] * fy - center[1] * fx + pulley.torque;
    }
    (force, moment)
}

#[cfg(test)]
mod tests;
