//! A pulley: where it is, what the belt touches, how it turns and what loads it.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::field::is_default;
use super::hub::{self, Crown, Displacement};
use crate::load::{ExternalTorque, Load};
use crate::profile::{self, Profile};
use crate::units;

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
    #[schemars(schema_with = "hub::tilt")]
    pub tilt: [f64; 2],
    /// Cone angle of the surface [rad]: the radius grows by its tangent along the axis. Of belts in space.
    #[serde(default, skip_serializing_if = "is_default")]
    #[schemars(schema_with = "units::angle", extend("minimum" = -hub::STEEPEST, "maximum" = hub::STEEPEST))]
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

/// A harmonic of a prescribed speed: with the mean speed `w(t)` and its angle `a(t)` the pulley turns at
/// `w (1 + sum amplitude cos(order a + phase))`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Harmonic {
    /// Periods per revolution [-]: 2 for a four-cylinder four-stroke engine.
    #[schemars(schema_with = "units::ratio", extend("exclusiveMinimum" = 0.0))]
    pub order: f64,
    /// Amplitude relative to the mean speed [-]; from 1 on the pulley would turn back within a revolution.
    #[schemars(schema_with = "units::ratio", extend("minimum" = 0.0, "exclusiveMaximum" = 1.0))]
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

    /// Its middle [m] at `time` [s], displacement and offset taken in.
    pub fn middle(&self, time: f64) -> [f64; 3] {
        let moved = self
            .displacement
            .as_ref()
            .map_or([0.0; 3], |displacement| displacement.at(time)[0]);
        let [x, y] = self.center;
        [x + moved[0], y + moved[1], self.offset + moved[2]]
    }

    /// Unit vector of its axis: z turned by the tilt about x, then about y.
    pub fn axis(&self) -> [f64; 3] {
        let [(sx, cx), (sy, cy)] = self.tilt.map(f64::sin_cos);
        [sy * cx, -sx, cy * cx]
    }

    /// Slope of the radius along the axis in the middle [-], and its decrease [1/m].
    pub fn shape(&self) -> [f64; 2] {
        let curvature = self.crown.map_or(0.0, |crown| {
            8.0 * crown.height / (crown.width * crown.width)
        });
        [self.taper.tan(), curvature]
    }

    /// Whether it is not a cylinder about z in the plane of the drive.
    pub fn is_misaligned(&self) -> bool {
        let straight = self.crown.is_none_or(|crown| crown.height == 0.0);
        !straight || self.offset != 0.0 || self.tilt != [0.0, 0.0] || self.taper != 0.0
    }
}

fn zero_profile() -> Profile {
    Profile::Constant(0.0)
}
