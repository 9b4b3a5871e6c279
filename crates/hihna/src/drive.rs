//! What the user states: belt, contact, pulleys, run. Plain data in SI units.

mod belt;
mod contact;
mod field;
mod hub;
mod pulley;
mod run;
mod section;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::units;

pub use belt::{Belt, BeltElement, Joint, PlateBending};
pub use contact::{Contact, Friction, FrictionDirections, Integration, SlipAt, Surface};
pub use hub::{Crown, Displacement};
pub use pulley::{Harmonic, Pulley, Wrap};
pub use run::{AutoStep, Integrator, Run, Start, Step, Until};

/// A belt drive and how to run it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Drive {
    /// A name for the drive.
    #[serde(default)]
    pub title: String,
    /// Acceleration of gravity [m/s²], off by default.
    #[serde(default)]
    #[schemars(schema_with = "units::acceleration_vector")]
    pub gravity: [f64; 2],
    /// The belt.
    pub belt: Belt,
    /// Contact between belt and pulleys.
    pub contact: Contact,
    /// The pulleys in the order in which the belt meets them.
    #[schemars(extend("minItems" = 2))]
    pub pulley: Vec<Pulley>,
    /// The time run.
    #[serde(default)]
    pub run: Run,
    /// Steady running of the finite elements.
    #[serde(default)]
    pub steady: Steady,
}

impl Drive {
    /// The friction that the belt's side on `pulley` has, before the pulley's groove.
    pub fn friction_on(&self, pulley: &Pulley) -> &Friction {
        match (&self.contact.back_friction, pulley.wrap) {
            (Some(back), Wrap::Outside) => back,
            _ => &self.contact.friction,
        }
    }

    /// Mass of the belt by what contact is integrated over: line density [kg/m], of plates mass per area
    /// [kg/m²].
    pub fn contact_mass(&self) -> f64 {
        let Belt {
            element,
            density,
            width,
            thickness,
            ..
        } = self.belt;
        if element.is_spatial() {
            density * thickness
        } else {
            density * width * thickness
        }
    }

    /// Contact integration points around the belt.
    pub fn contact_points(&self) -> usize {
        let points = self.contact.points;
        let each = match self.belt.element {
            BeltElement::Plate => self.belt.elements_across * points * points,
            element if element.is_beam_in_space() => {
                let sides = if self.flank_angle().is_some() { 2 } else { 1 };
                sides * points * self.contact.points_across
            }
            _ => points,
        };
        self.belt.elements * each
    }

    /// Coefficient of friction [-] on `pulley`, its groove taken in.
    pub fn coefficient_on(&self, pulley: &Pulley) -> f64 {
        self.friction_on(pulley).coefficient() * pulley.grip()
    }
}

/// How the finite elements of a steadily running belt are laid out.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Steady {
    /// How the elements share the belt.
    pub mesh: SteadyMesh,
}

/// How elements that stay in their places share the belt that runs through them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum SteadyMesh {
    /// Denser on the pulleys than in the spans, up to five times where the belt runs on and off.
    #[default]
    Graded,
    /// All of one length.
    Uniform,
}
