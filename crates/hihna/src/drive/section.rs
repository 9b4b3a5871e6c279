//! The belt's section: a rectangle, or the trapezoid of a V-belt.

use ancf::section::Trapezoid;

use super::{Belt, Drive, Pulley, Surface, Wrap};

impl Drive {
    /// Whether the flanks of a V-belt lie in a groove of `pulley`, its radius the pitch radius.
    pub fn is_grooved_in_space(&self, pulley: &Pulley) -> bool {
        self.belt.element.is_beam_in_space() && pulley.groove_angle.is_some()
    }

    /// Angle between the flanks of a V-belt of beams in space [rad]; `None` for other belts.
    pub fn flank_angle(&self) -> Option<f64> {
        let of_a_groove = || self.pulley.iter().find_map(|pulley| pulley.groove_angle);
        (self.belt.element.is_beam_in_space())
            .then(|| self.belt.flank_angle.or_else(of_a_groove))
            .flatten()
    }

    /// The section of a V-belt; `None` for other belts, and where the flanks would meet within it.
    pub fn trapezoid(&self) -> Option<Trapezoid> {
        let Belt {
            width, thickness, ..
        } = self.belt;
        Trapezoid::new(width, thickness, 0.5 * self.flank_angle()?)
    }

    /// Area of the belt's section [m²].
    pub fn area(&self) -> f64 {
        self.trapezoid()
            .map_or(self.belt.width * self.belt.thickness, |section| {
                section.area()
            })
    }

    /// How far the belt's centre line runs from where `radius` of `pulley` reaches [m]. In grooves that is the
    /// centre line of a V-belt itself.
    pub fn pitch_offset_on(&self, pulley: &Pulley) -> f64 {
        match (self.contact.surface, self.trapezoid()) {
            (Surface::CentreLine, _) => 0.0,
            (Surface::Face, None) => 0.5 * self.belt.thickness,
            (Surface::Face, Some(_)) if self.is_grooved_in_space(pulley) => 0.0,
            (Surface::Face, Some(section)) => match pulley.wrap {
                Wrap::Inside => section.narrow(),
                Wrap::Outside => -section.wide(),
            },
        }
    }
}
