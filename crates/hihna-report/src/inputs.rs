//! The drive as the user stated it, with units.

use std::fmt::Write;

use hihna::drive::{
    AutoStep, BeltElement, Drive, Friction, FrictionDirections, Integration, PlateBending, Pulley,
    SlipAt, Start, Step, Surface, Until, Wrap,
};
use hihna::load::Load;
use hihna::profile::{Profile, Varying};
use hihna::quantities;
use hihna::record::Results;

use crate::tables::Table;

/// Belt, contact, pulleys, how they stand in space, and run.
pub fn inputs(results: &Results) -> Vec<Table> {
    let drive = &results.drive;
    let mut tables = vec![belt(results), contact(drive), pulleys(drive)];
    tables.extend(mountings(drive));
    tables.push(run(results));
    tables
}

fn belt(results: &Results) -> Table {
    let (drive, belt) = (&results.drive, &results.drive.belt);
    let mut table = Table::new("Belt", &["Quantity", "Value"]);
    let mut row = |name: &str, value: String| table.row([name.to_owned(), value]);
    let model = |what: &str| results.number(&["model", what]);
    row("Elements", elements(drive));
    row(
        "Path around the rigid pulleys",
        with_prefix(model("path_length"), "m"),
    );
    row("Unstretched length", with_prefix(model("belt_length"), "m"));
    if let Some(tension) = belt.tension {
        row("Tension as mounted", with_prefix(tension, "N"));
    }
    if let Some(strain) = belt.strain {
        row("Strain as mounted", significant(strain));
    }
    row(
        "Width × thickness",
        format!(
            "{} × {}",
            with_prefix(belt.width, "m"),
            with_prefix(belt.thickness, "m")
        ),
    );
    if let Some(angle) = drive.flank_angle() {
        row("Angle between its flanks", degrees(angle));
    }
    row("Density", plain(belt.density, "kg/m³"));
    row("Young's modulus", with_prefix(belt.youngs_modulus, "Pa"));
    row("Poisson's ratio", significant(belt.poisson_ratio));
    match belt.element {
        BeltElement::Plate => row(
            "Bending stiffness",
            match belt.bending {
                PlateBending::Standard => "E h³ / (12 (1 - ν²))",
                PlateBending::Printed => "E h³ / 12",
                PlateBending::None => "none: a membrane",
            }
            .to_owned(),
        ),
        element => {
            if matches!(element, BeltElement::BeltBeam | BeltElement::BeltBeam3d) {
                row("Factor on axial stiffness", significant(belt.axial_factor));
            }
            row(
                "Factor on bending and shear stiffness",
                significant(belt.bending_factor),
            );
            if element.is_beam_in_space() {
                row(
                    "Factor on torsion stiffness",
                    significant(belt.torsion_factor),
                );
            }
        }
    }
    let area = drive.area();
    row(
        "Axial stiffness EA",
        with_prefix(belt.axial_factor * belt.youngs_modulus * area, "N"),
    );
    row("Mass per length", plain(belt.density * area, "kg/m"));
    if !belt.element.is_spatial() {
        row("Damping time", with_prefix(belt.damping_time, "s"));
    }
    table
}

fn elements(drive: &Drive) -> String {
    let belt = &drive.belt;
    let kind = match belt.element {
        BeltElement::BeltBeam => "belt beams",
        BeltElement::CubicBeam => "cubic beams",
        BeltElement::LinearBeam => "linear beams",
        BeltElement::Plate => {
            return format!("{} × {} thin plates", belt.elements, belt.elements_across);
        }
        BeltElement::BeltBeam3d => "belt beams in space",
        BeltElement::LinearBeam3d => "linear beams in space",
    };
    format!("{} {kind}", belt.elements)
}

/// Units of what acts by length of a belt in the plane and by area of a belt in space.
struct Units {
    stiffness: &'static str,
    damping: &'static str,
}

impl Units {
    fn of(drive: &Drive) -> Self {
        if drive.belt.element.is_spatial() {
            Self {
                stiffness: "N/m³",
                damping: "N s/m³",
            }
        } else {
            Self {
                stiffness: "N/m²",
                damping: "N s/m²",
            }
        }
    }
}

fn contact(drive: &Drive) -> Table {
    let (contact, units) = (&drive.contact, Units::of(drive));
    let in_space = drive.belt.element.is_spatial();
    let mut table = Table::new("Contact", &["Quantity", "Value"]);
    let mut row = |name: &str, value: String| table.row([name.to_owned(), value]);
    row(
        "Penalty stiffness",
        with_prefix(contact.stiffness, units.stiffness),
    );
    row("Penalty damping", plain(contact.damping, units.damping));
    row("Friction", friction(&contact.friction, &units));
    if let Some(back) = &contact.back_friction {
        row("Friction of the back", friction(back, &units));
    }
    if in_space {
        let directions = match contact.friction_directions {
            FrictionDirections::Circumferential => "around the pulleys only",
            FrictionDirections::Both => "against the slip, along the axes too",
        };
        row("Friction acts", directions.to_owned());
    }
    let surface = match contact.surface {
        Surface::CentreLine => "the centre line",
        Surface::Face => "the face",
    };
    row("What touches the pulleys", surface.to_owned());
    let across = match drive.belt.element {
        BeltElement::Plate => format!(" × {}", contact.points),
        element if element.is_beam_in_space() => format!(" × {}", contact.points_across),
        _ => String::new(),
    };
    let slip = match contact.slip_at {
        SlipAt::Surface => "at the surface of the pulley",
        SlipAt::Depth => "at the depth of the belt",
    };
    row("Slip is measured", slip.to_owned());
    let rule = match contact.integration {
        Integration::Gauss => "Gauss",
        Integration::Trapezoidal => "trapezoidal",
    };
    row(
        "Integration points per element",
        format!("{}{across}, {rule}", contact.points),
    );
    if contact.clamp_normal_force {
        row("Normal force", "kept from pulling".to_owned());
    }
    table
}

fn friction(friction: &Friction, units: &Units) -> String {
    match *friction {
        Friction::CreepRate { coefficient, slope } => format!(
            "creep-rate, coefficient {}, slope {}",
            significant(coefficient),
            plain(slope, units.damping)
        ),
        Friction::Coulomb {
            coefficient,
            velocity,
        } => format!(
            "Coulomb, coefficient {}, full at {}",
            significant(coefficient),
            with_prefix(velocity, "m/s")
        ),
        Friction::Stribeck {
            static_coefficient,
            sliding_coefficient,
            stribeck_velocity,
            velocity,
        } => format!(
            "Stribeck, coefficient {} falling to {} around {}, full at {}",
            significant(static_coefficient),
            significant(sliding_coefficient),
            with_prefix(stribeck_velocity, "m/s"),
            with_prefix(velocity, "m/s")
        ),
        Friction::ElasticPlastic {
            coefficient,
            stiffness,
            damping,
        } => format!(
            "elastic-plastic, coefficient {}, bristles of {} and {}",
            significant(coefficient),
            with_prefix(stiffness, units.stiffness),
            plain(damping, units.damping)
        ),
    }
}

fn pulleys(drive: &Drive) -> Table {
    let mut table = Table::new(
        "Pulleys, in the order in which the belt meets them",
        &[
            "Pulley",
            "Centre (x, y)",
            "Radius",
            "Belt around its",
            "Motion",
            "Inertia",
            "External torque",
        ],
    );
    for pulley in &drive.pulley {
        let [x, y] = pulley.center;
        let side = match pulley.wrap {
            Wrap::Inside => "inside",
            Wrap::Outside => "back",
        };
        let groove = pulley
            .groove_angle
            .map(|angle| format!(", groove {}", degrees(angle)));
        let by_motion = || "as its motion needs".to_owned();
        table.row([
            pulley.name.clone(),
            format!("({}, {})", with_prefix(x, "m"), with_prefix(y, "m")),
            with_prefix(pulley.radius, "m"),
            format!("{side}{}", groove.unwrap_or_default()),
            motion(pulley),
            plain(pulley.inertia, "kg m²"),
            if pulley.is_driver() {
                by_motion()
            } else {
                torque(pulley)
            },
        ]);
    }
    table
}

/// How pulleys stand in space and move, if any is not plain and fixed.
fn mountings(drive: &Drive) -> Option<Table> {
    let is_plain = |pulley: &Pulley| {
        pulley.displacement.is_none()
            && pulley.offset == 0.0
            && pulley.tilt.iter().all(|angle| *angle == 0.0)
            && pulley.taper == 0.0
            && pulley.crown.is_none()
    };
    if drive.pulley.iter().all(is_plain) {
        return None;
    }
    let mut table = Table::new(
        "How the pulleys stand",
        &[
            "Pulley",
            "Offset along z",
            "Tilt about x, y",
            "Cone angle",
            "Crown",
            "Motion of the centre",
        ],
    );
    for pulley in &drive.pulley {
        let [about_x, about_y] = pulley.tilt;
        let crown = pulley.crown.as_ref().map_or_else(
            || "none".to_owned(),
            |crown| {
                format!(
                    "{} over {}",
                    with_prefix(crown.height, "m"),
                    with_prefix(crown.width, "m")
                )
            },
        );
        let moves = pulley.displacement.as_ref().map_or_else(
            || "fixed".to_owned(),
            |way| {
                let axes = [("x", &way.x), ("y", &way.y), ("z", &way.z)];
                let moving = axes
                    .iter()
                    .filter(|(_, way)| **way != Profile::Constant(0.0));
                let words = moving.map(|(axis, way)| format!("{axis}: {}", profile(way, "m")));
                words.collect::<Vec<_>>().join("; ")
            },
        );
        table.row([
            pulley.name.clone(),
            with_prefix(pulley.offset, "m"),
            format!("{}, {}", degrees(about_x), degrees(about_y)),
            degrees(pulley.taper),
            crown,
            moves,
        ]);
    }
    Some(table)
}

fn motion(pulley: &Pulley) -> String {
    let mut text = match (&pulley.speed, &pulley.angle) {
        (Some(speed), _) => format!("speed {}", profile(speed, "rad/s")),
        (_, Some(angle)) => format!("angle {}", profile(angle, "rad")),
        _ => "free".to_owned(),
    };
    for harmonic in &pulley.irregularity {
        // Writing to a string cannot fail.
        let _ = write!(
            text,
            ", irregularity {} of order {}{}",
            percent(harmonic.amplitude),
            harmonic.order,
            if harmonic.phase == 0.0 {
                String::new()
            } else {
                format!(" at {}", degrees(harmonic.phase))
            }
        );
    }
    text
}

fn torque(pulley: &Pulley) -> String {
    let by_time = profile(&pulley.torque, "N m");
    match &pulley.load {
        None => by_time,
        Some(load) if pulley.torque == Profile::Constant(0.0) => load_in_words(load),
        Some(load) => format!("{by_time} and {}", load_in_words(load)),
    }
}

fn load_in_words(load: &Load) -> String {
    let at = |torque: f64, speed: f64| {
        format!(
            "{} at {}",
            with_prefix(torque, "N m"),
            plain(speed, "rad/s")
        )
    };
    match load {
        Load::Viscous { torque, speed } => format!("a viscous load, {}", at(*torque, *speed)),
        Load::Fan { torque, speed } => format!("a fan's load, {}", at(*torque, *speed)),
        Load::Table { speed, torque } => match (speed.last(), torque.last()) {
            (Some(speed_there), Some(torque)) => format!(
                "a load by a table of {} points, the last {}",
                speed.len(),
                at(*torque, *speed_there)
            ),
            _ => "a load by an empty table".to_owned(),
        },
    }
}

fn profile(profile: &Profile, unit: &str) -> String {
    match profile {
        Profile::Constant(value) => plain(*value, unit),
        Profile::Varying(
            varying @ (Varying::Ramp {
                from,
                to,
                start,
                end,
            }
            | Varying::HalfCosine {
                from,
                to,
                start,
                end,
            }),
        ) => format!(
            "{} {} to {} from {} to {}",
            if matches!(varying, Varying::Ramp { .. }) {
                "ramp"
            } else {
                "half-cosine"
            },
            significant(*from),
            plain(*to, unit),
            with_prefix(*start, "s"),
            with_prefix(*end, "s")
        ),
        Profile::Varying(Varying::Table { time, .. }) => {
            format!("by a table of {} points", time.len())
        }
    }
}

fn run(results: &Results) -> Table {
    let (drive, run) = (&results.drive, &results.drive.run);
    let mut table = Table::new("Run", &["Quantity", "Value"]);
    let mut row = |name: &str, value: String| table.row([name.to_owned(), value]);
    let start = match run.start {
        Start::Rest => "equilibrium at rest on the pulleys",
        Start::Steady => "steady running",
    };
    row("Start", start.to_owned());
    row(
        "End",
        match run.until {
            Until::End => with_prefix(run.end_time, "s"),
            Until::Steady => format!(
                "when the means have settled, at {} at the latest",
                with_prefix(run.end_time, "s")
            ),
        },
    );
    row(
        "Between rows of the history",
        with_prefix(run.output_interval, "s"),
    );
    row("Accuracy aimed at", significant(run.accuracy));
    row(
        "Time step",
        match run.step {
            Step::Fixed(step) => with_prefix(step, "s"),
            Step::Named(AutoStep::Auto) => "chosen by the accuracy".to_owned(),
        },
    );
    row(
        "Gravity (x, y)",
        format!(
            "({}, {}) m/s²",
            significant(drive.gravity[0]),
            significant(drive.gravity[1])
        ),
    );
    row(
        "Frames of the moving belt",
        run.frame_interval.map_or_else(
            || "none".to_owned(),
            |interval| {
                format!(
                    "every {} from {}",
                    with_prefix(interval, "s"),
                    with_prefix(run.frame_start, "s")
                )
            },
        ),
    );
    table
}

/// `0.3`, not `0.3000`: what was stated has no more digits than it was stated with.
fn brief(text: &str) -> String {
    let (number, unit) = text.split_once(' ').unwrap_or((text, ""));
    let short = if number.contains('.') && !number.contains('e') {
        number.trim_end_matches('0').trim_end_matches('.')
    } else {
        number
    };
    format!("{short} {unit}").trim_end().to_owned()
}

fn with_prefix(value: f64, unit: &str) -> String {
    brief(&quantities::with_prefix(value, unit))
}

fn plain(value: f64, unit: &str) -> String {
    brief(&quantities::plain(value, unit))
}

fn significant(value: f64) -> String {
    brief(&quantities::significant(value))
}

fn percent(value: f64) -> String {
    brief(&quantities::percent(value))
}

fn degrees(angle: f64) -> String {
    let text = quantities::degrees(angle);
    format!("{}°", brief(text.trim_end_matches('°')))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stated_numbers_are_brief() {
        assert_eq!(with_prefix(0.01, "m"), "10 mm");
        assert_eq!(with_prefix(0.08125, "m"), "81.25 mm");
        assert_eq!(significant(0.01), "0.01");
        assert_eq!(significant(100.0), "100");
        assert_eq!(plain(1.0e5, "N s/m²"), "100000 N s/m²");
        assert_eq!(significant(1.25e-12), "1.250e-12");
        assert_eq!(degrees(std::f64::consts::FRAC_PI_4), "45°");
        assert_eq!(percent(0.02), "2 %");
    }

    /// Everything that a drive file states of a belt in space is told, in its units.
    #[test]
    fn belts_in_space_have_their_own_fields() {
        let text = include_str!("../../../examples/crowned_pulleys.toml");
        let drive = hihna::input::parse("drive", text, &[]).unwrap();
        let all = |table: Table| format!("{:?}", table.rows);
        let told = all(contact(&drive));
        assert!(told.contains("N/m³") && !told.contains("N/m²"), "{told}");
        assert!(elements(&drive).contains("thin plates"));
        let told = all(mountings(&drive).unwrap());
        assert!(told.contains(" over "), "{told}");
        let text = include_str!("../../../examples/two_pulley.toml");
        let drive = hihna::input::parse("drive", text, &[]).unwrap();
        assert!(mountings(&drive).is_none());
        assert!(all(contact(&drive)).contains("N/m²"));
    }
}
