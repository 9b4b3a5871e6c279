//! Figs 3.4 and 3.5: a belt off its pulleys becomes a circle.

use std::f64::consts::TAU;

use super::{CaseError, Quantities};
use crate::free_belt::{FreeBelt, spring_free};
use crate::input::{self, Override};

const FIGURE_3_5: &str = include_str!("../../../../examples/figure_3_5.toml");

/// A relaxed belt and the circle that it should be.
struct Ring {
    free: FreeBelt,
    /// L/(2 pi) [m].
    radius: f64,
    /// alpha2 E I/(2 R²) L [J].
    energy: f64,
}

impl Ring {
    fn new(elements: &str) -> Result<Self, CaseError> {
        let change: Override = elements.parse()?;
        let drive = input::parse("figure_3_5.toml", FIGURE_3_5, &[change])?;
        let free = spring_free(&drive)?;
        let belt = &drive.belt;
        let length = belt.length.ok_or(CaseError::DoesNotRun)?;
        let radius = length / TAU;
        let second_moment = belt.width * belt.thickness.powi(3) / 12.0;
        let bending = belt.bending_factor * belt.youngs_modulus * second_moment;
        Ok(Self {
            free,
            radius,
            energy: 0.5 * bending / (radius * radius) * length,
        })
    }

    fn energy_ratio(&self) -> f64 {
        self.free.energy / self.energy
    }

    /// Largest distance of the centre line from the circle about its centroid, relative to the radius.
    fn distance(&self) -> f64 {
        let Some(points) = self.free.shapes.last() else {
            return f64::NAN;
        };
        let count = points.len() as f64;
        let centre = [0, 1].map(|axis| points.iter().map(|p| p[axis]).sum::<f64>() / count);
        let distances = points
            .iter()
            .map(|p| (p[0] - centre[0]).hypot(p[1] - centre[1]) / self.radius - 1.0);
        distances.map(f64::abs).fold(0.0, f64::max)
    }
}

/// Ten elements and twenty.
pub(super) fn figures_3_4_3_5() -> Result<Quantities, CaseError> {
    let ten = Ring::new("belt.elements=10")?;
    let twenty = Ring::new("belt.elements=20")?;
    Ok(vec![
        (
            "largest distance from the circle, 10 elements".to_owned(),
            ten.distance(),
        ),
        (
            "order of the distance in the element's length".to_owned(),
            (ten.distance() / twenty.distance()).log2(),
        ),
        (
            "iterations, 10 elements".to_owned(),
            (ten.free.shapes.len() - 1) as f64,
        ),
        (
            "strain energy over that of a bent ring, 10 elements".to_owned(),
            ten.energy_ratio(),
        ),
        (
            "order of the strain energy's error in the element's length".to_owned(),
            ((ten.energy_ratio() - 1.0) / (twenty.energy_ratio() - 1.0)).log2(),
        ),
    ])
}
