//! What is left of a belt's tension where it sinks into its pulleys.
//!
//! On the arc theta of a pulley a belt under the tension T presses with T/R per length and sinks in until the contact bears
//! that. With the contact's stiffness k per length of belt its path is shorter then,
//!
//! ```text
//! d = T / (k R)          depth on a pulley
//! D = sum d theta        path lost on all of them
//! T = T_0 - F' D / L     F' = alpha1 E A (3 f² - 1)/2, T_0 and the stretch f on rigid pulleys, L the belt's length
//!   = T_0 / (1 + s),     s = F' sum (theta/R) / (k L)
//! ```
//!
//! Walls of grooves that a belt in space wedges into are not in this.

use super::{Assembly, Mounting, Warning, is_guided};
use crate::drive::Drive;
use crate::layout::Layout;

/// Part of the tension on rigid pulleys below which a belt at rest is another one than was asked for.
const LEAST_TENSION: f64 = 0.5;
/// Part of the smallest radius that a belt may sink in.
const DEEPEST: f64 = 0.1;
/// Part of the tension that a contact may lose which a warning proposes.
const SMALL_LOSS: f64 = 0.1;
/// Strain of a belt that is mounted with a tension to lose: of a belt as long as its path rounding leaves less.
const MOUNTED: f64 = 1.0e-9;

/// Tension and depth of a belt at rest on its pulleys.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rest {
    /// Mean true axial force [N].
    pub tension: f64,
    /// Largest penetration into a pulley [m].
    pub penetration: f64,
}

impl Rest {
    /// An estimate by the formulas above; none for a belt in space in grooves.
    pub fn estimate(drive: &Drive, layout: &Layout, mounting: &Mounting) -> Option<Self> {
        let tension = mounting.tension / (1.0 + softness(drive, layout, mounting)?);
        Some(Self {
            tension,
            penetration: tension / (stiffness_per_length(drive) * smallest_radius(layout)),
        })
    }

    /// Warns of a contact so soft that little is left of the tension, or that the pulleys are smaller than they should be.
    pub fn soft_contact(
        self,
        drive: &Drive,
        layout: &Layout,
        mounting: &Mounting,
    ) -> Option<Warning> {
        let softness = softness(drive, layout, mounting);
        let most = SMALL_LOSS / (1.0 - SMALL_LOSS);
        // A stiff belt with hardly any tension loses it by its bending, too.
        let loses = mounting.stretch - 1.0 > MOUNTED
            && self.tension < LEAST_TENSION * mounting.tension
            && softness.is_none_or(|softness| softness > most);
        let radius = smallest_radius(layout);
        (loses || self.penetration > DEEPEST * radius).then(|| Warning::SoftContact {
            tension: self.tension,
            path_tension: mounting.tension,
            penetration: self.penetration,
            radius,
            enough: (softness.filter(|softness| *softness > most)).map(|softness| Stiffness {
                value: softness / most * drive.contact.stiffness,
                per_area: drive.belt.element.is_spatial(),
            }),
        })
    }
}

impl<E, L> Assembly<E, L> {
    /// Adds to the warnings what there is to say of the belt at rest.
    pub(crate) fn judge(&mut self, drive: &Drive, rest: Rest) {
        let soft = rest.soft_contact(drive, &self.layout, &self.mounting);
        self.warnings.extend(soft);
    }
}

/// A stiffness of the contact that would do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stiffness {
    /// Its value [N/m² or N/m³].
    pub value: f64,
    /// Whether it is one per area of belt.
    pub per_area: bool,
}

impl Stiffness {
    /// What to do, in words.
    pub(super) fn remedy(enough: Option<Self>) -> String {
        let remedy = "raise `contact.stiffness`";
        enough.map_or_else(
            || remedy.to_owned(),
            |Self { value, per_area }| {
                let unit = if per_area { "N/m3" } else { "N/m2" };
                format!("{remedy}: {value:.1e} {unit} keeps nine tenths of it")
            },
        )
    }
}

/// `s` above [-]: what the tension loses over what is left.
fn softness(drive: &Drive, layout: &Layout, mounting: &Mounting) -> Option<f64> {
    if drive.belt.element.is_beam_in_space() && is_guided(drive) {
        return None;
    }
    let belt = &drive.belt;
    let slope = 0.5 * (3.0 * mounting.stretch * mounting.stretch - 1.0);
    let stiffness = belt.axial_factor * belt.youngs_modulus * drive.area() * slope;
    let bent: f64 = (layout.arcs.iter())
        .map(|arc| arc.sweep.abs() / arc.radius)
        .sum();
    Some(stiffness * bent / (stiffness_per_length(drive) * mounting.length))
}

/// Stiffness of the contact per length of belt [N/m²].
fn stiffness_per_length(drive: &Drive) -> f64 {
    let stiffness = drive.contact.stiffness;
    if drive.belt.element.is_spatial() {
        stiffness * drive.belt.width
    } else {
        stiffness
    }
}

fn smallest_radius(layout: &Layout) -> f64 {
    (layout.arcs.iter()).fold(f64::INFINITY, |least, arc| least.min(arc.radius))
}
