//! Where a pulley's hub is and how its surface is shaped: tilt, taper, crown, motion of the centre.

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Serialize};

use crate::profile::{self, Profile};
use crate::units;

/// Steepest tilt or taper [rad].
pub(super) const STEEPEST: f64 = 0.5;

/// Motion of a pulley's centre: where it is, less where it starts.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Displacement {
    /// Along x [m].
    #[serde(default = "still")]
    #[schemars(schema_with = "profile::length")]
    pub x: Profile,
    /// Along y [m].
    #[serde(default = "still")]
    #[schemars(schema_with = "profile::length")]
    pub y: Profile,
    /// Along z [m]: of belts in space.
    #[serde(default = "still")]
    #[schemars(schema_with = "profile::length")]
    pub z: Profile,
}

impl Displacement {
    /// Displacement [m] and velocity [m/s] at `time` [s]; right-hand values at kinks.
    pub fn at(&self, time: f64) -> [[f64; 3]; 2] {
        let axes = [&self.x, &self.y, &self.z];
        [
            axes.map(|axis| axis.value(time)),
            axes.map(|axis| axis.derivative(time)),
        ]
    }
}

/// The crown of a pulley: its radius is `radius` in the middle and `height` less at half of `width` from it,
/// by a parabola.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Crown {
    /// Height over the edges [m]; negative for a hollow pulley, which a belt runs off.
    #[schemars(schema_with = "units::length")]
    pub height: f64,
    /// Width of the pulley [m].
    #[schemars(schema_with = "units::length", extend("exclusiveMinimum" = 0.0))]
    pub width: f64,
}

/// Schema of the tilt of an axis about x and y [rad].
pub(super) fn tilt(generator: &mut SchemaGenerator) -> Schema {
    let mut angle = units::angle(generator);
    angle.insert("minimum".to_owned(), (-STEEPEST).into());
    angle.insert("maximum".to_owned(), STEEPEST.into());
    json_schema!({ "type": "array", "items": angle, "minItems": 2, "maxItems": 2 })
}

fn still() -> Profile {
    Profile::Constant(0.0)
}
