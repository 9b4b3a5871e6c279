//! What the user states: belt, contact, pulleys, run. Plain data in SI units.

mod hub;
mod section;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize, Serializer};

use crate::load::{ExternalTorque, Load};
use crate::profile::{self, Profile};
use crate::units;

pub(crate) use hub::STEEPEST;
pub use hub::{Crown, Displacement};

/// A belt drive and how to run it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Drive {
    /// A name for the drive.
    #[serde(default)]
    pub title: String,
    /// Acceleration of gravity [m/s²], off by default.
    #[serde(default)]
    #[schemars(schema_with = "units::acceleration_vector")]
    pub gravity: [f64; 2],
    /// The belt.
    pub belt: Belt,
    /// Contact between belt and pulleys.
    pub contact: Contact,
    /// The pulleys in the order in which the belt meets them.
    #[schemars(extend("minItems" = 2))]
    pub pulley: Vec<Pulley>,
    /// The time run.
    #[serde(default)]
    pub run: Run,
    /// Steady running of the finite elements.
    #[serde(default)]
    pub steady: Steady,
}

/// How the finite elements of a steadily running belt are laid out.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Steady {
    /// How the elements share the belt.
    pub mesh: SteadyMesh,
}

/// How elements that stay in their places share the belt that runs through them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum SteadyMesh {
    /// Denser on the pulleys than in the spans, up to five times where the belt runs on and off.
    #[default]
    Graded,
    /// All of one length.
    Uniform,
}

/// Kinds of belt elements.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum BeltElement {
    /// Planar shear-deformable belt beam with cubic centre line, 12 coordinates.
    #[default]
    BeltBeam,
    /// Planar fully parametrised cubic beam (Omar & Shabana 2001), 12 coordinates.
    CubicBeam,
    /// Planar linear beam with one integration point, 8 coordinates.
    LinearBeam,
    /// Thin plate in space, 36 coordinates: a belt with a width.
    Plate,
    /// Belt beam in space, 24 coordinates: flat belts and V-belts.
    #[serde(rename = "belt-beam-3d")]
    BeltBeam3d,
    /// Linear beam in space with one integration point, 18 coordinates.
    #[serde(rename = "linear-beam-3d")]
    LinearBeam3d,
}

impl BeltElement {
    /// Whether the belt moves in space; otherwise in the plane.
    pub fn is_spatial(self) -> bool {
        self == Self::Plate || self.is_beam_in_space()
    }

    /// Whether the belt is a chain of beams that move in space.
    pub fn is_beam_in_space(self) -> bool {
        matches!(self, Self::BeltBeam3d | Self::LinearBeam3d)
    }
}

/// The belt. Exactly one of `length`, `tension`, `strain` says how tight it is.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("allOf" = [{ "oneOf": [
    { "required": ["length"] },
    { "required": ["tension"] },
    { "required": ["strain"] },
] }]))]
pub struct Belt {
    /// Element type.
    #[serde(default)]
    pub element: BeltElement,
    /// Number of elements around the belt.
    #[schemars(extend("minimum" = 3, "maximum" = 100_000))]
    #[serde(serialize_with = "count")]
    pub elements: usize,
    /// Number of elements side by side across the belt: of plates.
    #[serde(
        default = "one_across",
        serialize_with = "count",
        skip_serializing_if = "is_one"
    )]
    #[schemars(extend("minimum" = 1, "maximum" = 100))]
    pub elements_across: usize,
    /// The bending stiffness of plates.
    #[serde(default, skip_serializing_if = "is_default")]
    pub bending: PlateBending,
    /// Unstretched length [m].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(schema_with = "units::length", extend("exclusiveMinimum" = 0.0))]
    pub length: Option<f64>,
    /// Axial force of the belt mounted on the rigid pulleys' path [N].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(schema_with = "units::force", extend("exclusiveMinimum" = 0.0))]
    pub tension: Option<f64>,
    /// Engineering strain of the belt mounted on the rigid pulleys' path [-].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(schema_with = "units::ratio", extend("exclusiveMinimum" = 0.0))]
    pub strain: Option<f64>,
    /// Width, along the pulley axis [m]; of a V-belt that at its centre line.
    #[schemars(schema_with = "units::length", extend("exclusiveMinimum" = 0.0))]
    pub width: f64,
    /// Thickness, in the plane of the drive [m]; of a V-belt its height.
    #[schemars(schema_with = "units::length", extend("exclusiveMinimum" = 0.0))]
    pub thickness: f64,
    /// Density [kg/m³].
    #[schemars(schema_with = "units::density", extend("exclusiveMinimum" = 0.0))]
    pub density: f64,
    /// Young's modulus [Pa].
    #[schemars(schema_with = "units::pressure", extend("exclusiveMinimum" = 0.0))]
    pub youngs_modulus: f64,
    /// Poisson's ratio [-].
    #[serde(default)]
    #[schemars(schema_with = "units::ratio", extend("exclusiveMinimum" = -1.0, "exclusiveMaximum" = 0.5))]
    pub poisson_ratio: f64,
    /// Factor alpha1 on the axial stiffness [-].
    #[serde(default = "one")]
    #[schemars(schema_with = "units::ratio", extend("exclusiveMinimum" = 0.0))]
    pub axial_factor: f64,
    /// Factor alpha2 on bending and shear stiffness [-].
    #[serde(default = "one")]
    #[schemars(schema_with = "units::ratio", extend("exclusiveMinimum" = 0.0))]
    pub bending_factor: f64,
    /// Factor on the torsion stiffness [-]: of beams in space.
    #[serde(default = "one", skip_serializing_if = "is_whole")]
    #[schemars(schema_with = "units::ratio", extend("exclusiveMinimum" = 0.0))]
    pub torsion_factor: f64,
    /// Angle between the flanks of a V-belt [rad]: of beams in space. Absent: that of the first groove, if any pulley
    /// has one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(schema_with = "units::angle", extend("exclusiveMinimum" = 0.0, "exclusiveMaximum" = std::f64::consts::PI))]
    pub flank_angle: Option<f64>,
    /// Kelvin-Voigt damping time of axial strain and curvature [s].
    #[serde(default)]
    #[schemars(schema_with = "units::time", extend("minimum" = 0.0))]
    pub damping_time: f64,
    /// How the belt's ends are joined.
    #[serde(default)]
    pub joint: Joint,
    /// Where the first node starts: path length from mid-wrap of the first pulley [m].
    #[serde(default)]
    #[schemars(schema_with = "units::length")]
    pub first_node: f64,
}

/// Bending stiffness D of a plate.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum PlateBending {
    /// Kirchhoff's `E h³ / (12 (1 - nu²))`.
    #[default]
    Standard,
    /// `E h³ / 12`, as printed in Kerkkänen (2006, 4.17).
    Printed,
    /// None: a membrane.
    None,
}

/// How the belt's ends are joined to a loop. Both give the same motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Joint {
    /// The last element ends in the first node.
    #[default]
    Shared,
    /// The last element has an end of its own, tied to the first node by Lagrange multipliers.
    Multipliers,
}

/// Contact along the belt.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Contact {
    /// Penalty stiffness k_p per length of belt [N/m²]; of belts in space per area [N/m³].
    #[schemars(schema_with = "units::stiffness_per_length", extend("exclusiveMinimum" = 0.0))]
    pub stiffness: f64,
    /// Penalty damping c_p per length of belt [N s/m²]; of belts in space per area [N s/m³].
    #[serde(default)]
    #[schemars(schema_with = "units::damping_per_length", extend("minimum" = 0.0))]
    pub damping: f64,
    /// The friction law of the belt's inner face, and of its back where `back_friction` is absent.
    pub friction: Friction,
    /// The friction law of the belt's back, on pulleys with `wrap = "outside"`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub back_friction: Option<Friction>,
    /// Which line of the belt touches the pulleys.
    #[serde(default)]
    pub surface: Surface,
    /// Integration points along an element; of a plate, along and across it.
    #[serde(default = "default_points", serialize_with = "count")]
    #[schemars(extend("minimum" = 1, "maximum" = 64))]
    pub points: usize,
    /// Integration points across the belt's face, and over the height of a V-belt's flank: of beams in space.
    #[serde(
        default = "default_points_across",
        serialize_with = "count",
        skip_serializing_if = "is_default_across"
    )]
    #[schemars(extend("minimum" = 1, "maximum" = 64))]
    pub points_across: usize,
    /// The rule that these points belong to; steady running of the finite elements takes Gauss points on pieces between the
    /// corners of the contact law whatever it is.
    #[serde(default, skip_serializing_if = "is_default")]
    pub integration: Integration,
    /// The directions in which friction acts on the surface of a belt in space.
    #[serde(default, skip_serializing_if = "is_default")]
    pub friction_directions: FrictionDirections,
    /// Whether the normal force is kept from pulling (c_p d' < -k_p d near the exit).
    #[serde(default)]
    pub clamp_normal_force: bool,
}

/// Rules of integration along an element.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Integration {
    /// Gauss points, inside the element.
    #[default]
    Gauss,
    /// Equally spaced points with the element's ends among them, trapezoidal weights.
    Trapezoidal,
}

/// Directions of friction on the surface of a pulley.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum FrictionDirections {
    /// Around the pulley only.
    #[default]
    Circumferential,
    /// Against the slip velocity, along the pulley's axis too: a belt can track sideways.
    Both,
}

/// Friction laws.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "law", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Friction {
    /// Tri-linear creep-rate law: force per length `min(slope |v|, coefficient |f_n|)`.
    CreepRate {
        /// Coefficient of friction mu [-].
        #[schemars(schema_with = "units::ratio", extend("minimum" = 0.0))]
        coefficient: f64,
        /// Creep slope v_s [N s/m²]; of belts in space [N s/m³].
        #[schemars(schema_with = "units::damping_per_length", extend("exclusiveMinimum" = 0.0))]
        slope: f64,
    },
    /// Coulomb friction regularised by a velocity: `coefficient |f_n| min(|v| / velocity, 1)`.
    Coulomb {
        /// Coefficient of friction mu [-].
        #[schemars(schema_with = "units::ratio", extend("minimum" = 0.0))]
        coefficient: f64,
        /// Slip velocity at which friction is fully developed [m/s].
        #[schemars(schema_with = "units::velocity", extend("exclusiveMinimum" = 0.0))]
        velocity: f64,
    },
    /// Coulomb friction whose coefficient falls with the slip velocity:
    /// `sliding + (static - sliding) / (1 + (v / stribeck_velocity)²)`.
    Stribeck {
        /// Coefficient of friction at the onset of slip [-].
        #[schemars(schema_with = "units::ratio", extend("minimum" = 0.0))]
        static_coefficient: f64,
        /// Coefficient of friction of fast slip [-].
        #[schemars(schema_with = "units::ratio", extend("minimum" = 0.0))]
        sliding_coefficient: f64,
        /// Slip velocity at which half of the difference is gone [m/s].
        #[schemars(schema_with = "units::velocity", extend("exclusiveMinimum" = 0.0))]
        stribeck_velocity: f64,
        /// Slip velocity at which friction is fully developed [m/s].
        #[schemars(schema_with = "units::velocity", extend("exclusiveMinimum" = 0.0))]
        velocity: f64,
    },
    /// Bristles that stick, bend and slide: `stiffness` times displacement within
    /// `coefficient |f_n|`.
    ElasticPlastic {
        /// Coefficient of friction mu [-].
        #[schemars(schema_with = "units::ratio", extend("minimum" = 0.0))]
        coefficient: f64,
        /// Stiffness of the bristles per length of belt [N/m²].
        #[schemars(schema_with = "units::stiffness_per_length", extend("exclusiveMinimum" = 0.0))]
        stiffness: f64,
        /// Damping of the bristles per length of belt [N s/m²].
        #[serde(default)]
        #[schemars(schema_with = "units::damping_per_length", extend("minimum" = 0.0))]
        damping: f64,
    },
}

impl Friction {
    /// Coefficient of friction of steady slip mu [-].
    pub fn coefficient(&self) -> f64 {
        match *self {
            Self::CreepRate { coefficient, .. }
            | Self::Coulomb { coefficient, .. }
            | Self::ElasticPlastic { coefficient, .. }
            | Self::Stribeck {
                sliding_coefficient: coefficient,
                ..
            } => coefficient,
        }
    }
}

/// Which line of the belt touches the pulleys.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Surface {
    /// The centre line: a pulley's radius reaches to it.
    #[default]
    CentreLine,
    /// The face that lies on the pulley, half the thickness from the centre line.
    Face,
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
    #[schemars(schema_with = "units::point")]
    pub center: [f64; 2],
    /// Radius [m].
    #[schemars(schema_with = "units::length", extend("exclusiveMinimum" = 0.0))]
    pub radius: f64,
    /// Motion of the centre from `center`, where it is at time zero.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub displacement: Option<Displacement>,
    /// Distance of the pulley's middle from the plane of the drive, along z [m]: of belts in space.
    #[serde(default, skip_serializing_if = "is_default")]
    #[schemars(schema_with = "units::length")]
    pub offset: f64,
    /// Tilt of the axis [rad], from z: about x, then about y. Of belts in space.
    #[serde(default, skip_serializing_if = "is_default")]
    #[schemars(schema_with = "units::tilt")]
    pub tilt: [f64; 2],
    /// Cone angle of the surface [rad]: the radius grows by its tangent along the axis. Of belts in space.
    #[serde(default, skip_serializing_if = "is_default")]
    #[schemars(schema_with = "units::angle", extend("minimum" = -STEEPEST, "maximum" = STEEPEST))]
    pub taper: f64,
    /// Crown of the surface; absent: straight. Of belts in space.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub crown: Option<Crown>,
    /// Side of the belt.
    #[serde(default)]
    pub wrap: Wrap,
    /// Angle of its groove [rad], both flanks together. A belt in the plane wedges in: friction acts
    /// `1 / sin(angle / 2)` times. A beam in space lies on the groove's flanks. Absent: a flat face.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(schema_with = "units::angle", extend("exclusiveMinimum" = 0.0, "maximum" = std::f64::consts::PI))]
    pub groove_angle: Option<f64>,
    /// Prescribed speed [rad/s], positive counter-clockwise.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(schema_with = "profile::angular_velocity")]
    pub speed: Option<Profile>,
    /// Prescribed angle [rad].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(schema_with = "profile::angle")]
    pub angle: Option<Profile>,
    /// Moment of inertia about the axis [kg m²].
    #[serde(default)]
    #[schemars(schema_with = "units::inertia", extend("minimum" = 0.0))]
    pub inertia: f64,
    /// External torque [N m], positive counter-clockwise.
    #[serde(default = "zero_profile")]
    #[schemars(schema_with = "profile::torque")]
    pub torque: Profile,
    /// External torque that depends on the speed, beside `torque`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub load: Option<Load>,
    /// Irregularity of the prescribed `speed`, order by order of the pulley's revolution.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub irregularity: Vec<Harmonic>,
}

/// A harmonic of a prescribed speed: with the mean speed `w(t)` and its angle `a(t)` the pulley turns at
/// `w (1 + sum amplitude cos(order a + phase))`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Harmonic {
    /// Periods per revolution [-]: 2 for a four-cylinder four-stroke engine.
    #[schemars(schema_with = "units::ratio", extend("exclusiveMinimum" = 0.0))]
    pub order: f64,
    /// Amplitude relative to the mean speed [-].
    #[schemars(schema_with = "units::ratio", extend("minimum" = 0.0))]
    pub amplitude: f64,
    /// Phase at angle zero [rad].
    #[serde(default)]
    #[schemars(schema_with = "units::angle")]
    pub phase: f64,
}

impl Pulley {
    /// Whether the pulley's motion is prescribed.
    pub fn is_driver(&self) -> bool {
        self.speed.is_some() || self.angle.is_some()
    }

    /// All that acts on it from outside of the drive.
    pub fn external_torque(&self) -> ExternalTorque {
        ExternalTorque {
            by_time: self.torque.clone(),
            by_speed: self.load.clone(),
            stated: None,
        }
    }

    /// How many times its surface multiplies friction: 1 on a flat face, more in a groove.
    pub fn grip(&self) -> f64 {
        self.groove_angle
            .map_or(1.0, |angle| (0.5 * angle).sin().recip())
    }
}

impl Drive {
    /// The friction that the belt's side on `pulley` has, before the pulley's groove.
    pub fn friction_on(&self, pulley: &Pulley) -> &Friction {
        match (&self.contact.back_friction, pulley.wrap) {
            (Some(back), Wrap::Outside) => back,
            _ => &self.contact.friction,
        }
    }

    /// Mass of the belt by what contact is integrated over: line density [kg/m], of plates mass per area
    /// [kg/m²].
    pub fn contact_mass(&self) -> f64 {
        let Belt {
            element,
            density,
            width,
            thickness,
            ..
        } = self.belt;
        if element.is_spatial() {
            density * thickness
        } else {
            density * width * thickness
        }
    }

    /// Contact integration points around the belt.
    pub fn contact_points(&self) -> usize {
        let points = self.contact.points;
        let each = match self.belt.element {
            BeltElement::Plate => self.belt.elements_across * points * points,
            element if element.is_beam_in_space() => {
                let sides = if self.flank_angle().is_some() { 2 } else { 1 };
                sides * points * self.contact.points_across
            }
            _ => points,
        };
        self.belt.elements * each
    }

    /// Coefficient of friction [-] on `pulley`, its groove taken in.
    pub fn coefficient_on(&self, pulley: &Pulley) -> f64 {
        self.friction_on(pulley).coefficient() * pulley.grip()
    }
}

/// The time run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Run {
    /// End of the run [s].
    #[schemars(schema_with = "units::time", extend("exclusiveMinimum" = 0.0))]
    pub end_time: f64,
    /// Time between rows of the history [s].
    #[schemars(schema_with = "units::time", extend("exclusiveMinimum" = 0.0))]
    pub output_interval: f64,
    /// Aimed-at relative accuracy of speeds and tensions [-].
    #[schemars(schema_with = "units::ratio", extend("exclusiveMinimum" = 0.0, "maximum" = 0.1))]
    pub accuracy: f64,
    /// Time step.
    pub step: Step,
    /// Time integrator.
    pub integrator: Integrator,
    /// State at time zero.
    pub start: Start,
    /// When the run ends.
    pub until: Until,
    /// Times at which the belt's profile is recorded [s]; empty: the end.
    #[schemars(schema_with = "units::times")]
    pub profile_times: Vec<f64>,
    /// The line of a belt in space that the profile shows: 0 for one edge, 1 for the other [-].
    #[serde(skip_serializing_if = "is_the_middle")]
    #[schemars(schema_with = "units::ratio", extend("minimum" = 0.0, "maximum" = 1.0))]
    pub profile_line: f64,
    /// Time between the frames of the moving belt [s]; absent: no frames.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(schema_with = "units::time", extend("exclusiveMinimum" = 0.0))]
    pub frame_interval: Option<f64>,
    /// Time of the first frame [s].
    #[schemars(schema_with = "units::time", extend("minimum" = 0.0))]
    pub frame_start: f64,
}

/// The time step: chosen by the program, or fixed.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum Step {
    /// Fixed [s].
    Fixed(#[schemars(schema_with = "units::time", extend("exclusiveMinimum" = 0.0))] f64),
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
    /// Steady running with the values that all profiles have at time zero.
    Steady,
}

/// When a run ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Until {
    /// At `end_time`.
    #[default]
    End,
    /// When the means of speeds and tensions have settled, at `end_time` at the latest.
    Steady,
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
            until: Until::End,
            profile_times: Vec::new(),
            profile_line: MIDDLE,
            frame_interval: None,
            frame_start: 0.0,
        }
    }
}

fn one() -> f64 {
    1.0
}

fn one_across() -> usize {
    1
}

// References as serde's signatures have them.
#[allow(clippy::trivially_copy_pass_by_ref)]
fn is_one(count: &usize) -> bool {
    *count == 1
}

fn is_default<T: Default + PartialEq>(value: &T) -> bool {
    *value == T::default()
}

/// The line in the middle of the belt.
const MIDDLE: f64 = 0.5;

#[allow(clippy::trivially_copy_pass_by_ref)]
fn is_the_middle(line: &f64) -> bool {
    line.to_bits() == MIDDLE.to_bits()
}

fn default_points() -> usize {
    7
}

impl Contact {
    /// Points across where a drive file names none.
    pub(crate) const POINTS_ACROSS: usize = 3;
}

fn default_points_across() -> usize {
    Contact::POINTS_ACROSS
}

#[allow(clippy::trivially_copy_pass_by_ref)]
fn is_default_across(count: &usize) -> bool {
    *count == Contact::POINTS_ACROSS
}

#[allow(clippy::trivially_copy_pass_by_ref)]
fn is_whole(factor: &f64) -> bool {
    factor.to_bits() == one().to_bits()
}

fn zero_profile() -> Profile {
    Profile::Constant(0.0)
}

/// Writes a count; one beyond the range of TOML's integers, which no drive may have, is cut to it.
#[allow(clippy::trivially_copy_pass_by_ref)] // serde's signature
fn count<S: Serializer>(count: &usize, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_i64(i64::try_from(*count).unwrap_or(i64::MAX))
}
