//! What the animation of a belt with a width needs beside that of a line: its edges, and pulleys in space.

use hihna::drive::Drive;
use hihna::observe::EdgeRow;
use serde::Serialize;

use crate::packed::text;
use crate::series::short;

/// A belt between two edges, in space.
#[derive(Serialize)]
pub struct Strip {
    /// Half of its width [m].
    half_width: f64,
    /// For each frame and point the way `x, y, z` to both edges [m], from the places that they have on the rigid path
    /// of cylinders in their plane. 32-bit floats, little-endian, as base64.
    sides: String,
    pulleys: Vec<Drum>,
}

/// A pulley in space.
#[derive(Serialize)]
struct Drum {
    /// Unit vector.
    axis: [f64; 3],
    /// Slope of its radius along the axis [-], and the decrease of that [1/m].
    shape: [f64; 2],
    /// Place of its middle at each frame [m].
    places: Vec<[f32; 3]>,
}

/// The edges of all frames in the making.
pub struct Sides {
    half_width: f64,
    values: Vec<f32>,
}

impl Sides {
    pub fn of_width(width: f64) -> Self {
        Self {
            half_width: 0.5 * width,
            values: Vec::new(),
        }
    }

    /// Adds the edges of a section whose middle belongs to the place `[x, y]` of the path.
    pub fn add(&mut self, [x, y]: [f64; 2], edge: &EdgeRow) {
        let half = self.half_width;
        let ways = [
            [edge.x0 - x, edge.y0 - y, edge.z0 + half],
            [edge.x1 - x, edge.y1 - y, edge.z1 - half],
        ];
        self.values
            .extend(ways.as_flattened().iter().map(|way| short(*way)));
    }
}

impl Strip {
    /// The belt of `drive` with these edges at these times.
    pub fn new(drive: &Drive, sides: &Sides, times: &[f64]) -> Self {
        let drum = |pulley: &hihna::drive::Pulley| Drum {
            axis: pulley.axis(),
            shape: pulley.shape(),
            places: (times.iter())
                .map(|time| pulley.middle(*time).map(short))
                .collect(),
        };
        Self {
            half_width: sides.half_width,
            sides: text(&sides.values),
            pulleys: drive.pulley.iter().map(drum).collect(),
        }
    }
}
