//! Contact between belt and pulleys, and the friction laws.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::field::{count, is_default};
use crate::units;

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
    /// Where on the pulley slip is measured.
    #[serde(default, skip_serializing_if = "is_default")]
    pub slip_at: SlipAt,
    /// Whether the normal force is kept from pulling (c_p d' < -k_p d near the exit).
    #[serde(default)]
    pub clamp_normal_force: bool,
}

impl Contact {
    /// Points across where a drive file names none.
    pub(crate) const POINTS_ACROSS: usize = 3;
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

/// Where on a pulley slip is measured. On the walls of grooves it is at the depth.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum SlipAt {
    /// Against the speed omega R of the surface, as published, whatever the penetration d. Friction acts at R - d, so that between
    /// pulleys into which the belt sinks differently deep it may give power.
    #[default]
    Surface,
    /// Against the speed omega (R - d) where friction acts: friction takes power only.
    Depth,
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

fn default_points() -> usize {
    7
}

fn default_points_across() -> usize {
    Contact::POINTS_ACROSS
}

#[allow(clippy::trivially_copy_pass_by_ref)]
fn is_default_across(count: &usize) -> bool {
    *count == Contact::POINTS_ACROSS
}
