//! The numbers of a drive file that the string theory reads, in any number type, and what they make.
//!
//! ```text
//! k = axial_factor E w h,   m = rho w h,   T_init = tension or k strain,
//! R = radius + p h,   mu = coefficient, or coefficient / sin(groove_angle/2) in a groove,
//! ```
//! with p = 1/2 where the belt's face touches the pulleys, else 0, and the back's own coefficient where it
//! has one (S13); wrap angles and spans by the common tangents of the layout. With dual numbers all of it carries
//! its derivatives by the fields of the drive file.

use crate::drive::{Drive, Friction, Surface, Wrap};
use crate::layout::{Circle, Layout, Tangent, sweep, turn};
use crate::number::Number;
use crate::steady::string::{Closure, Model, Role, StringDrive, StringPulley, Tightness};

use super::{SteadyError, final_value, speed_controlled};

/// The fields that count.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct DriveNumbers<D = f64> {
    /// Index of the speed-controlled pulley.
    pub driver: usize,
    width: D,
    thickness: D,
    density: D,
    youngs_modulus: D,
    axial_factor: D,
    tightness: Given<D>,
    friction: D,
    friction_field: &'static str,
    back_friction: Option<(D, &'static str)>,
    /// Distance of the centre line from the pulleys' surfaces, in thicknesses.
    pitch: f64,
    pulleys: Vec<PulleyNumbers<D>>,
}

/// The field that says how tight the belt is.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Given<D> {
    Length(D),
    Tension(D),
    Strain(D),
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct PulleyNumbers<D> {
    center: [D; 2],
    radius: D,
    /// Whether the belt's back touches it.
    back: bool,
    groove_angle: Option<D>,
    /// Final speed of the speed-controlled pulley [rad/s], final torque of another [N m], both
    /// counter-clockwise.
    motion: D,
}

/// The belt's path, in the drive's order.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Path<D> {
    /// `tangents[i]` leads from pulley `i` to pulley `i + 1`.
    pub tangents: Vec<Tangent<D>>,
    /// Wrap angles, positive [rad].
    pub wraps: Vec<D>,
}

impl DriveNumbers {
    /// Reads a drive.
    pub fn new(drive: &Drive) -> Result<Self, SteadyError> {
        let (driver, speed) = speed_controlled(&drive.pulley)?;
        let belt = &drive.belt;
        let contact = &drive.contact;
        let pulleys = drive
            .pulley
            .iter()
            .enumerate()
            .map(|(i, pulley)| PulleyNumbers {
                center: pulley.center,
                radius: pulley.radius,
                back: contact.back_friction.is_some() && pulley.wrap == Wrap::Outside,
                groove_angle: pulley.groove_angle,
                motion: if i == driver {
                    speed
                } else {
                    final_value(&pulley.torque)
                },
            });
        Ok(Self {
            driver,
            width: belt.width,
            thickness: belt.thickness,
            density: belt.density,
            youngs_modulus: belt.youngs_modulus,
            axial_factor: belt.axial_factor,
            tightness: match (belt.length, belt.tension, belt.strain) {
                (Some(length), ..) => Given::Length(length),
                (_, Some(tension), _) => Given::Tension(tension),
                (.., Some(strain)) => Given::Strain(strain),
                _ => return Err(SteadyError::NoTightness),
            },
            friction: contact.friction.coefficient(),
            friction_field: coefficient_field(&contact.friction),
            back_friction: contact
                .back_friction
                .as_ref()
                .map(|law| (law.coefficient(), coefficient_field(law))),
            pitch: match contact.surface {
                Surface::CentreLine => 0.0,
                Surface::Face => 0.5,
            },
            pulleys: pulleys.collect(),
        })
    }

    /// Final speed of the speed-controlled pulley, counter-clockwise [rad/s].
    pub fn driving_speed(&self) -> f64 {
        self.pulleys[self.driver].motion
    }
}

impl<D: Number> DriveNumbers<D> {
    /// Distance of the belt's centre line from the pulley's axis.
    fn pitch_radius(&self, pulley: &PulleyNumbers<D>) -> D {
        pulley.radius + self.thickness * self.pitch
    }

    /// Coefficient of friction on a pulley, its groove taken in.
    fn coefficient(&self, pulley: &PulleyNumbers<D>) -> D {
        let flat = match self.back_friction {
            Some((back, _)) if pulley.back => back,
            _ => self.friction,
        };
        match pulley.groove_angle {
            Some(angle) => flat / (angle * 0.5).sin(),
            None => flat,
        }
    }

    /// The path, on the sides of the pulleys where `layout` has it.
    pub fn path(&self, layout: &Layout) -> Path<D> {
        let count = self.pulleys.len();
        let circle = |(pulley, arc): (&PulleyNumbers<D>, &crate::layout::Arc)| Circle {
            center: pulley.center,
            radius: self.pitch_radius(pulley),
            side: arc.sweep.signum(),
        };
        let circles: Vec<_> = self.pulleys.iter().zip(&layout.arcs).map(circle).collect();
        let tangents: Vec<_> = (0..count)
            .map(|i| Tangent::between(&circles[i], &circles[(i + 1) % count]))
            .collect();
        let wraps = (0..count).map(|i| {
            let incoming = tangents[(i + count - 1) % count].direction;
            let side = circles[i].side;
            sweep(turn(incoming, tangents[i].direction), side) * side
        });
        Path {
            wraps: wraps.collect(),
            tangents,
        }
    }

    /// What the theory solves: pulley `j` is pulley `order[j]` of the drive, `direction` the belt's
    /// along the drive's list.
    pub fn string(
        &self,
        path: &Path<D>,
        layout: &Layout,
        order: &[usize],
        direction: f64,
        (model, closure): (Model, Closure),
    ) -> StringDrive<D> {
        let area = self.width * self.thickness;
        let axial_stiffness = self.axial_factor * self.youngs_modulus * area;
        let pulley = |&i: &usize| {
            let rotation = direction * layout.arcs[i].sweep.signum();
            let motion = self.pulleys[i].motion * rotation;
            StringPulley {
                radius: self.pitch_radius(&self.pulleys[i]),
                wrap_angle: path.wraps[i],
                friction: self.coefficient(&self.pulleys[i]),
                role: if i == self.driver {
                    Role::SpeedControlled(motion)
                } else {
                    Role::Torque(motion)
                },
                span: path.tangents[span_behind(order.len(), direction, i)].length,
            }
        };
        StringDrive {
            axial_stiffness,
            line_density: self.density * area,
            tightness: match self.tightness {
                Given::Length(length) => Tightness::UnstretchedLength(length),
                Given::Tension(tension) => Tightness::InitialTension(tension),
                Given::Strain(strain) => Tightness::InitialTension(axial_stiffness * strain),
            },
            pulleys: order.iter().map(pulley).collect(),
            model,
            closure,
        }
    }

    /// The same numbers in another type.
    pub fn map<E>(&self, convert: impl Fn(D) -> E) -> DriveNumbers<E> {
        DriveNumbers {
            driver: self.driver,
            width: convert(self.width),
            thickness: convert(self.thickness),
            density: convert(self.density),
            youngs_modulus: convert(self.youngs_modulus),
            axial_factor: convert(self.axial_factor),
            tightness: match self.tightness {
                Given::Length(length) => Given::Length(convert(length)),
                Given::Tension(tension) => Given::Tension(convert(tension)),
                Given::Strain(strain) => Given::Strain(convert(strain)),
            },
            friction: convert(self.friction),
            friction_field: self.friction_field,
            back_friction: self
                .back_friction
                .map(|(value, field)| (convert(value), field)),
            pitch: self.pitch,
            pulleys: self
                .pulleys
                .iter()
                .map(|pulley| PulleyNumbers {
                    center: pulley.center.map(&convert),
                    radius: convert(pulley.radius),
                    back: pulley.back,
                    groove_angle: pulley.groove_angle.map(&convert),
                    motion: convert(pulley.motion),
                })
                .collect(),
        }
    }

    /// Every number with its field below `belt`, `contact` or a pulley and its unit, always in the
    /// same order.
    pub fn fields(&mut self) -> Vec<(Field, &'static str, &mut D)> {
        let (tightness, unit, value) = match &mut self.tightness {
            Given::Length(value) => ("length", "m", value),
            Given::Tension(value) => ("tension", "N", value),
            Given::Strain(value) => ("strain", "-", value),
        };
        let mut fields = vec![
            (Field::Whole("belt", tightness), unit, value),
            (Field::Whole("belt", "width"), "m", &mut self.width),
            (Field::Whole("belt", "thickness"), "m", &mut self.thickness),
            (Field::Whole("belt", "density"), "kg/m³", &mut self.density),
            (
                Field::Whole("belt", "youngs_modulus"),
                "Pa",
                &mut self.youngs_modulus,
            ),
            (
                Field::Whole("belt", "axial_factor"),
                "-",
                &mut self.axial_factor,
            ),
            (
                Field::Whole("contact.friction", self.friction_field),
                "-",
                &mut self.friction,
            ),
        ];
        if let Some((value, field)) = &mut self.back_friction {
            fields.push((Field::Whole("contact.back_friction", field), "-", value));
        }
        for (i, pulley) in self.pulleys.iter_mut().enumerate() {
            if let Some(angle) = &mut pulley.groove_angle {
                fields.push((Field::Pulley(i, "groove_angle"), "rad", angle));
            }
            let [x, y] = &mut pulley.center;
            let (motion, unit) = if i == self.driver {
                ("speed", "rad/s")
            } else {
                ("torque", "N m")
            };
            fields.extend([
                (Field::Pulley(i, "radius"), "m", &mut pulley.radius),
                (Field::Pulley(i, "center.0"), "m", x),
                (Field::Pulley(i, "center.1"), "m", y),
                (Field::Pulley(i, motion), unit, &mut pulley.motion),
            ]);
        }
        fields
    }
}

/// The field of a friction law that the string theory reads.
fn coefficient_field(friction: &Friction) -> &'static str {
    match friction {
        Friction::Stribeck { .. } => "sliding_coefficient",
        _ => "coefficient",
    }
}

/// Where a number stands in a drive file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Field {
    Whole(&'static str, &'static str),
    Pulley(usize, &'static str),
}

/// Index in the layout of the span behind pulley `pulley` of the drive on the way of the belt.
pub(super) fn span_behind(count: usize, direction: f64, pulley: usize) -> usize {
    if direction > 0.0 {
        pulley
    } else {
        (pulley + count - 1) % count
    }
}
