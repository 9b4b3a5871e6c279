//! Where a pulley's hub is and how its surface is shaped: tilt, taper, crown, motion of the centre.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::Pulley;
use crate::profile::{self, Profile};
use crate::units;

/// Steepest tilt or taper [rad].
pub(crate) const STEEPEST: f64 = 0.5;

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
    /// Height over the edges [m]; negative for a hollow pulley.
    #[schemars(schema_with = "units::length")]
    pub height: f64,
    /// Width of the pulley [m].
    #[schemars(schema_with = "units::length", extend("exclusiveMinimum" = 0.0))]
    pub width: f64,
}

fn still() -> Profile {
    Profile::Constant(0.0)
}

impl Pulley {
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
