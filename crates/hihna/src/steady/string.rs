//! The extensible string with inertia: a belt drive's steady running in closed form but for one number.
//!
//! Source: Bechtel, Vohra, Jacob & Carlson (2000), as summarised in Kerkkänen (2006), section 4.1,
//! equations (4.1)-(4.4) and (4.48), there for two pulleys; here for any number of them. Equations
//! are numbered as in the theory manual.
//!
//! Steady running: the mass flow `G = m v0` is the same everywhere (`m` mass per unstretched
//! length, `v0` the speed the belt has where it is unstretched). With the stretch `lambda = 1 +
//! eps`, axial stiffness `k`, belt speed `v`, axial force `T`:
//! ```text
//! v = v0 lambda,   T = k eps                                                                      (S1)
//! c = m v0² / k                                                                                   (S2)
//! N = T - G v = k [(1 - c_n) lambda - 1],    P = k [(1 - c_p) lambda - 1]                         (S3)
//! ```
//! `N` presses the belt on a pulley, `P` balances friction: on a pulley of radius R with
//! coefficient `mu`, `theta` along the motion,
//! ```text
//! stick: dP = 0, v = R omega
//! slip:  dP = ±mu N dtheta  =>  N = N_in exp(±mu' theta),   mu' = mu (1 - c_n)/(1 - c_p)           (S4)
//! ```
//! | model | c_n | c_p | equation of the slip zone |
//! |---|---|---|---|
//! | full | c | c | d(T - G v) = ±mu (T - G v) dtheta |
//! | centrifugal (no stretching acceleration) | c | 0 | dT = ±mu (T - G v) dtheta |
//! | capstan (no inertia) | 0 | 0 | dT = ±mu T dtheta |
//!
//! The belt sticks to each pulley where it arrives and slips at the exit; so each pulley has the
//! speed of the span before it. In free spans `T` and `v` are constant. An external torque M (along
//! the pulley's rotation) is balanced by friction, and it spreads over the slip angle phi:
//! ```text
//! R (P_in - P_out) = M                                                                            (S5)
//! phi = |ln(N_out / N_in)| / mu' <= wrap angle                                                    (S6)
//! ```
//! The torques give all P up to one constant. It is the strain `eps` of the span that arrives at
//! the speed-controlled pulley (surface speed V), which also gives `c = (m V²/k) / (1 + eps)²`, and
//! it follows from the closure, one of
//! ```text
//! unstretched length:  ∮ eps/lambda ds = L - L0                                                   (S7)
//! tension sum:         mean of T over the spans = T_init   (two pulleys: T_t + T_s = 2 T_init)    (S8)
//! L - L0 = L T_init/(k + T_init),   T_init = k (L - L0)/L0   (belt at rest on the pulleys)        (S9)
//! ```
//! with, per pulley, `q = ln(lambda_out/lambda_in)` and `sigma` its sign,
//! ```text
//! ∫ eps/lambda ds = R [ (wrap - phi) eps_in/lambda_in + c_n phi + (1 - c_n) sigma q / mu' ].      (S10)
//! ```
//! Strains and their differences are carried, never differences of speeds, so stiff belts lose no
//! digits. All torques times a factor `s` bring a pulley to gross slip (phi = wrap) when, with
//! `N_t` before the speed-controlled pulley and `d = (P - P_t)/k` at the pulley's tighter and
//! slacker side,
//! ```text
//! s = (N_t/k)(1 - E) / [(E d_high - d_low)(1 - c_n)/(1 - c_p)],   E = exp(-mu' wrap);             (S11)
//! ```
//! the least over the pulleys, put into the closure, gives the largest torque that the drive can
//! carry, again from one equation.
//!
//! Everything is generic over [`Number`]: with dual numbers all results carry exact derivatives by
//! whatever inputs are seeded (the root by implicit differentiation, see [`sensitivity`]).

mod closure;
pub mod sensitivity;
mod state;

use crate::number::Number;

pub use state::{BeltState, Capacity, GrossSlip, PulleyState, Running, Slack, SpanState};

/// A belt drive as the string theory sees it: pulleys in the order in which a belt particle meets them.
///
/// Radii, wrap angles and span lengths are independent inputs here; geometry ties them together before.
#[derive(Clone, Debug, PartialEq)]
pub struct StringDrive<D = f64> {
    /// Axial stiffness k: axial force per strain [N].
    pub axial_stiffness: D,
    /// Mass per unstretched length [kg/m].
    pub line_density: D,
    /// How tight the belt is.
    pub tightness: Tightness<D>,
    /// The pulleys in the order of the belt's motion; exactly one is speed-controlled.
    pub pulleys: Vec<StringPulley<D>>,
    /// Which inertia terms are kept.
    pub model: Model,
    /// What running leaves unchanged.
    pub closure: Closure,
}

/// A pulley and the free span behind it.
#[derive(Clone, Debug, PartialEq)]
pub struct StringPulley<D = f64> {
    /// Radius of the belt's centre line [m].
    pub radius: D,
    /// Wrap angle, positive [rad].
    pub wrap_angle: D,
    /// Coefficient of friction [-].
    pub friction: D,
    /// What is prescribed.
    pub role: Role<D>,
    /// Length of the free span to the next pulley [m].
    pub span: D,
}

/// What is prescribed on a pulley.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Role<D = f64> {
    /// Angular speed, positive along the belt's motion [rad/s]; its torque is found.
    SpeedControlled(D),
    /// External torque [N m], positive along the pulley's rotation: negative brakes, zero is an
    /// idler; its speed is found.
    Torque(D),
}

/// How tight the belt is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Tightness<D = f64> {
    /// Unstretched length of the whole belt [m].
    UnstretchedLength(D),
    /// Axial force of the belt at rest on the pulleys [N].
    InitialTension(D),
}

/// Which inertia terms are kept (Kerkkänen 2006, section 4.6).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Model {
    /// All of them.
    #[default]
    Full,
    /// Centrifugal force only, no acceleration by stretching.
    Centrifugal,
    /// None: the classical capstan equation with a creeping belt.
    Capstan,
}

/// What running leaves unchanged.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Closure {
    /// The belt's unstretched length: the elastic belt on fixed centres.
    #[default]
    UnstretchedLength,
    /// The mean of the spans' tensions, each span counted once: for two pulleys the classical `T_t
    /// + T_s = 2 T_init`.
    TensionSum,
}

/// What a drive does.
#[derive(Clone, Debug, PartialEq)]
pub enum Answer<D = f64> {
    /// It runs: every pulley sticks somewhere.
    Running(Running<D>),
    /// A pulley would have to slip over more than its wrap.
    GrossSlip(GrossSlip<D>),
    /// The belt is too slack to press on the pulleys, even without torque.
    Slack(Slack<D>),
}

/// Why a drive is no well-posed problem. Pulleys are counted from zero.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum StringError {
    /// Fewer than two pulleys.
    #[error("a belt needs at least two pulleys, there are {count}")]
    TooFewPulleys {
        /// Number of pulleys.
        count: usize,
    },
    /// A quantity out of its range.
    #[error("the {quantity}{} is {value}: it must be {wanted}", of_pulley(*.pulley))]
    OutOfRange {
        /// The quantity with its unit.
        quantity: &'static str,
        /// The pulley that it belongs to.
        pulley: Option<usize>,
        /// Its value, SI.
        value: f64,
        /// What it must be.
        wanted: &'static str,
    },
    /// No pulley or several have a prescribed speed.
    #[error(
        "{count} pulleys have a prescribed speed: exactly one must, the torque of the others decides their speed"
    )]
    SpeedControlledPulleys {
        /// How many.
        count: usize,
    },
    /// The equation for the tension was not solved; not known to happen.
    #[error("no tension was found that keeps the belt's length: last strain tried {strain}")]
    NotConverged {
        /// The last strain of the span before the speed-controlled pulley [-].
        strain: f64,
    },
}

impl<D: Number> StringDrive<D> {
    /// Finds the steady running of the drive, or says why there is none.
    pub fn solve(&self) -> Result<Answer<D>, StringError> {
        let driver = self.check()?;
        let belt = closure::Loop::new(self, driver);
        Ok(match belt.roots()? {
            closure::Roots::Running { running, capacity } => {
                Answer::Running(state::running(self, &belt, running, capacity))
            }
            closure::Roots::GrossSlip { formal, capacity } => {
                Answer::GrossSlip(state::gross_slip(self, &belt, formal, capacity))
            }
            closure::Roots::Slack => Answer::Slack(state::slack(self, &belt)),
        })
    }

    /// Length of the belt's path: arcs and spans [m].
    pub fn path_length(&self) -> D {
        self.pulleys
            .iter()
            .fold(D::zero(), |sum, p| sum + p.radius * p.wrap_angle + p.span)
    }

    /// The same drive in another number type.
    pub fn map<E: Number>(&self, convert: impl Fn(D) -> E) -> StringDrive<E> {
        StringDrive {
            axial_stiffness: convert(self.axial_stiffness),
            line_density: convert(self.line_density),
            tightness: match self.tightness {
                Tightness::UnstretchedLength(length) => {
                    Tightness::UnstretchedLength(convert(length))
                }
                Tightness::InitialTension(force) => Tightness::InitialTension(convert(force)),
            },
            pulleys: self
                .pulleys
                .iter()
                .map(|p| StringPulley {
                    radius: convert(p.radius),
                    wrap_angle: convert(p.wrap_angle),
                    friction: convert(p.friction),
                    role: match p.role {
                        Role::SpeedControlled(speed) => Role::SpeedControlled(convert(speed)),
                        Role::Torque(torque) => Role::Torque(convert(torque)),
                    },
                    span: convert(p.span),
                })
                .collect(),
            model: self.model,
            closure: self.closure,
        }
    }

    /// Checks ranges and roles; returns the speed-controlled pulley.
    fn check(&self) -> Result<usize, StringError> {
        if self.pulleys.len() < 2 {
            return Err(StringError::TooFewPulleys {
                count: self.pulleys.len(),
            });
        }
        above_zero(self.axial_stiffness, "axial stiffness [N]", None)?;
        not_negative(self.line_density, "line density [kg/m]", None)?;
        match self.tightness {
            Tightness::UnstretchedLength(length) => {
                above_zero(length, "unstretched length [m]", None)?;
            }
            Tightness::InitialTension(force) => finite(force, "initial tension [N]", None)?,
        }
        let mut controlled = None;
        let mut count = 0;
        for (i, p) in self.pulleys.iter().enumerate() {
            above_zero(p.radius, "radius [m]", Some(i))?;
            above_zero(p.wrap_angle, "wrap angle [rad]", Some(i))?;
            not_negative(p.friction, "friction coefficient", Some(i))?;
            not_negative(p.span, "length of the span behind [m]", Some(i))?;
            match p.role {
                Role::SpeedControlled(speed) => {
                    above_zero(speed, "speed along the belt's motion [rad/s]", Some(i))?;
                    controlled = Some(i);
                    count += 1;
                }
                Role::Torque(torque) => finite(torque, "torque [N m]", Some(i))?,
            }
        }
        controlled
            .filter(|_| count == 1)
            .ok_or(StringError::SpeedControlledPulleys { count })
    }
}

fn of_pulley(pulley: Option<usize>) -> String {
    pulley.map_or_else(String::new, |i| format!(" of pulley {i}"))
}

type Checked = Result<(), StringError>;

fn above_zero<D: Number>(value: D, quantity: &'static str, pulley: Option<usize>) -> Checked {
    let fine = value.re().is_finite() && value.re() > 0.0;
    require(fine, value.re(), quantity, pulley, "finite and above zero")
}

fn not_negative<D: Number>(value: D, quantity: &'static str, pulley: Option<usize>) -> Checked {
    let fine = value.re().is_finite() && value.re() >= 0.0;
    require(
        fine,
        value.re(),
        quantity,
        pulley,
        "finite and not negative",
    )
}

fn finite<D: Number>(value: D, quantity: &'static str, pulley: Option<usize>) -> Checked {
    require(
        value.re().is_finite(),
        value.re(),
        quantity,
        pulley,
        "finite",
    )
}

fn require(
    fine: bool,
    value: f64,
    quantity: &'static str,
    pulley: Option<usize>,
    wanted: &'static str,
) -> Checked {
    if fine {
        Ok(())
    } else {
        Err(StringError::OutOfRange {
            quantity,
            pulley,
            value,
            wanted,
        })
    }
}

#[cfg(test)]
mod tests;
