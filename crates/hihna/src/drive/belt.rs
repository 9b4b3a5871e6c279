//! The belt: its elements, how tight it is, its section and material.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::field::{count, is_default};
use crate::units;

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

#[allow(clippy::trivially_copy_pass_by_ref)]
fn is_whole(factor: &f64) -> bool {
    factor.to_bits() == one().to_bits()
}
