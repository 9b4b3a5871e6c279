//! Where the section of a spatial beam touches: a flat face, or the flanks of a V-belt.

use ancf::quadrature::Rule;
use ancf::section::Trapezoid;

use super::meridian::{Flank, Side};

/// Points of contact across the section of a spatial beam, whose fibres are `y` (height) and `z` (width): a point
/// lies at `r_c + y r_y + z r_z`.
#[derive(Clone, Debug, PartialEq)]
pub struct Face {
    /// The parts of the section, each with as many points.
    pub(super) sides: Vec<Side>,
    /// Part by part.
    pub(super) points: Vec<FacePoint>,
}

/// A point across a section.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct FacePoint {
    pub y: f64,
    pub z: f64,
    /// Weight times the width of the face, or the height of the flank along itself [m].
    pub width: f64,
}

impl Face {
    /// The flat face of this `width` [m] at the height `y` [m], by `rule` across.
    #[must_use]
    pub fn flat(y: f64, width: f64, rule: &Rule) -> Self {
        let points = (rule.points.iter().zip(&rule.weights)).map(|(at, weight)| FacePoint {
            y,
            z: width * (at - 0.5),
            width: weight * width,
        });
        Self {
            sides: vec![Side::Face],
            points: points.collect(),
        }
    }

    /// Both flanks of `section`, whose narrow side lies towards `inwards` y (1 or -1), by `rule` over the height.
    #[must_use]
    pub fn flanks(section: &Trapezoid, inwards: f64, rule: &Rule) -> Self {
        let on = |flank: Flank| {
            (rule.points.iter().zip(&rule.weights)).map(move |(at, weight)| {
                let y = section.wide() + at * section.height;
                FacePoint {
                    y: inwards * y,
                    z: 0.5 * flank.sign() * section.width_at(y),
                    width: weight * section.flank(),
                }
            })
        };
        Self {
            sides: Flank::BOTH.map(Side::Flank).to_vec(),
            points: Flank::BOTH.into_iter().flat_map(on).collect(),
        }
    }
}
