//! What the user states: belt, contact, pulleys, run. Plain data in SI units.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::profile::Profile;

/// A belt drive and how to run it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Drive {
    /// A name for the drive.
    #[serde(default)]
    pub title: String,
    /// The belt.
    pub belt: Belt,
    /// Contact between belt and pulleys.
    pub contact: Contact,
    /// The pulleys in the order in which the belt meets them.
    pub pulley: Vec<Pulley>,
    /// Acceleration of gravity [m/s²], off by default.
    #[serde(default)]
    pub gravity: [f64; 2],
    /// The time run.
    #[serde(default)]
    pub run: Run,
}

/// Kinds of belt elements.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum BeltElement {
    /// Planar shear-deformable belt beam with cubic centre line, 12 coordinates.
    #[default]
    BeltBeam,
}

/// The belt. Exactly one of `length`, `tension`, `strain` says how tight it is.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Belt {
    /// Element type.
    #[serde(default)]
    pub element: BeltElement,
    /// Number of elements around the belt.
    pub elements: usize,
    /// Unstretched length [m].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub length: Option<f64>,
    /// Axial force of the belt mounted on the rigid pulleys' path [N].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tension: Option<f64>,
    /// Engineering strain of the belt mounted on the rigid pulleys' path [-].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub strain: Option<f64>,
    /// Width, along the pulley axis [m].
    pub width: f64,
    /// Thickness, in the plane of the drive [m].
    pub thickness: f64,
    /// Density [kg/m³].
    pub density: f64,
    /// Young's modulus [Pa].
    pub youngs_modulus: f64,
    /// Poisson's ratio [-].
    #[serde(default)]
    pub poisson_ratio: f64,
    /// Factor alpha1 on the axial stiffness [-].
    #[serde(default = "one")]
    pub axial_factor: f64,
    /// Factor alpha2 on bending and shear stiffness [-].
    #[serde(default = "one")]
    pub bending_factor: f64,
    /// Kelvin-Voigt damping time of axial strain and curvature [s].
    #[serde(default)]
    pub damping_time: f64,
    /// Where the first node starts: path length from mid-wrap of the first pulley [m].
    #[serde(default)]
    pub first_node: f64,
}

/// Contact along the belt.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Contact {
    /// Penalty stiffness k_p per length of belt [N/m²].
    pub stiffness: f64,
    /// Penalty damping c_p per length of belt [N s/m²].
    #[serde(default)]
    pub damping: f64,
    /// The friction law.
    pub friction: Friction,
    /// Gauss points per element.
    #[serde(default = "default_points")]
    pub points: usize,
    /// Whether the normal force is kept from pulling (c_p d' < -k_p d near the exit).
    #[serde(default)]
    pub clamp_normal_force: bool,
}

/// Friction laws.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "law", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Friction {
    /// Tri-linear creep-rate law: force per length `min(slope |v|, coefficient |f_n|)`.
    CreepRate {
        /// Coefficient of friction mu [-].
        coefficient: f64,
        /// Creep slope v_s [N s/m²].
        slope: f64,
    },
    /// Coulomb friction regularised by a velocity: `coefficient |f_n| min(|v| / velocity, 1)`.
    Coulomb {
        /// Coefficient of friction mu [-].
        coefficient: f64,
        /// Slip velocity at which friction is fully developed [m/s].
        velocity: f64,
    },
}

/// On which side of the belt a pulley lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Wrap {
    /// The pulley lies inside the loop; the belt's inner face touches it.
    #[default]
    Inside,
    /// The pulley lies outside the loop; the belt's back touches it (or the belt crosses).
    Outside,
}

/// A pulley. With `speed` or `angle` it is a driver; otherwise it turns by its inertia and torques.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Pulley {
    /// Name, unique within the drive.
    pub name: String,
    /// Centre [m].
    pub center: [f64; 2],
    /// Radius [m].
    pub radius: f64,
    /// Side of the belt.
    #[serde(default)]
    pub wrap: Wrap,
    /// Prescribed speed [rad/s], positive counter-clockwise.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub speed: Option<Profile>,
    /// Prescribed angle [rad].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub angle: Option<Profile>,
    /// Moment of inertia about the axis [kg m²].
    #[serde(default)]
    pub inertia: f64,
    /// External torque [N m], positive counter-clockwise.
    #[serde(default = "zero_profile")]
    pub torque: Profile,
}

/// The time run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Run {
    /// End of the run [s].
    pub end_time: f64,
    /// Time between rows of the history [s].
    pub output_interval: f64,
    /// Aimed-at relative accuracy of speeds and tensions [-].
    pub accuracy: f64,
    /// Time step.
    pub step: Step,
    /// Time integrator.
    pub integrator: Integrator,
    /// State at time zero.
    pub start: Start,
    /// Times at which the belt's profile is recorded [s]; empty: the end.
    pub profile_times: Vec<f64>,
}

/// The time step: chosen by the program, or fixed.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum Step {
    /// Fixed [s].
    Fixed(f64),
    /// Chosen from `accuracy`.
    Named(AutoStep),
}

/// The one named step.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum AutoStep {
    /// Chosen from `accuracy`.
    Auto,
}

/// Time integrators.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Integrator {
    /// Generalized-alpha with TR-BDF2 as fall-back.
    #[default]
    Auto,
    /// Generalized-alpha alone.
    GeneralizedAlpha,
    /// TR-BDF2 alone.
    TrBdf2,
    /// Explicit Runge-Kutta of fourth order.
    RungeKutta,
}

/// State at time zero.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Start {
    /// Equilibrium at rest on the pulleys, without friction.
    #[default]
    Rest,
}

impl Default for Run {
    fn default() -> Self {
        Self {
            end_time: 1.5,
            output_interval: 1.0e-3,
            accuracy: 1.0e-3,
            step: Step::Named(AutoStep::Auto),
            integrator: Integrator::Auto,
            start: Start::Rest,
            profile_times: Vec::new(),
        }
    }
}

fn one() -> f64 {
    1.0
}

fn default_points() -> usize {
    7
}

fn zero_profile() -> Profile {
    Profile::Constant(0.0)
}
