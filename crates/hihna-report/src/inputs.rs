//! The drive as the user stated it, with units.

use std::fmt::Write;

use hihna::drive::{Drive, Friction, Pulley, Surface, Wrap};
use hihna::load::Load;
use hihna::profile::{Profile, Varying};
use hihna::quantities::{degrees, plain, significant, with_prefix};
use hihna::record::Results;

use crate::tables::Table;

/// Belt, contact, pulleys and run.
pub fn inputs(results: &Results) -> Vec<Table> {
    let drive = &results.drive;
    vec![belt(results), contact(drive), pulleys(drive), run(drive)]
}

fn belt(results: &Results) -> Table {
    let belt = &results.drive.belt;
    let mut table = Table::new("Belt", &["Quantity", "Value"]);
    let mut row = |name: &str, value: String| table.row([name.to_owned(), value]);
    let model = |what: &str| results.number(&["model", what]);
    row(
        "Path around the rigid pulleys",
        with_prefix(model("path_length"), "m"),
    );
    row("Unstretched length", with_prefix(model("belt_length"), "m"));
    row(
        "Width × thickness",
        format!(
            "{} × {}",
            with_prefix(belt.width, "m"),
            with_prefix(belt.thickness, "m")
        ),
    );
    row("Density", plain(belt.density, "kg/m³"));
    row("Young's modulus", with_prefix(belt.youngs_modulus, "Pa"));
    row("Poisson's ratio", significant(belt.poisson_ratio));
    row("Factor on axial stiffness", significant(belt.axial_factor));
    row(
        "Factor on bending and shear stiffness",
        significant(belt.bending_factor),
    );
    let area = belt.width * belt.thickness;
    row(
        "Axial stiffness EA",
        with_prefix(belt.axial_factor * belt.youngs_modulus * area, "N"),
    );
    row("Mass per length", plain(belt.density * area, "kg/m"));
    row("Damping time", with_prefix(belt.damping_time, "s"));
    table
}

fn contact(drive: &Drive) -> Table {
    let contact = &drive.contact;
    let mut table = Table::new("Contact", &["Quantity", "Value"]);
    let mut row = |name: &str, value: String| table.row([name.to_owned(), value]);
    row("Penalty stiffness", with_prefix(contact.stiffness, "N/m²"));
    row("Penalty damping", plain(contact.damping, "N s/m²"));
    row("Friction", friction(&contact.friction));
    if let Some(back) = &contact.back_friction {
        row("Friction of the back", friction(back));
    }
    let surface = match contact.surface {
        Surface::CentreLine => "the centre line",
        Surface::Face => "the face",
    };
    row("What touches the pulleys", surface.to_owned());
    row("Integration points per element", contact.points.to_string());
    table
}

fn friction(friction: &Friction) -> String {
    match *friction {
        Friction::CreepRate { coefficient, slope } => format!(
            "creep-rate, coefficient {}, slope {}",
            significant(coefficient),
            plain(slope, "N s/m²")
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
            ..
        } => format!(
            "Stribeck, coefficient {} falling to {} around {}",
            significant(static_coefficient),
            significant(sliding_coefficient),
            with_prefix(stribeck_velocity, "m/s")
        ),
        Friction::ElasticPlastic {
            coefficient,
            stiffness,
            ..
        } => format!(
            "elastic-plastic, coefficient {}, stiffness {}",
            significant(coefficient),
            with_prefix(stiffness, "N/m²")
        ),
    }
}

fn pulleys(drive: &Drive) -> Table {
    let mut table = Table::new(
        "Pulleys, in the order in which the belt meets them",
        &[
            "Pulley",
            "Centre",
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
        table.row([
            pulley.name.clone(),
            format!("({}, {})", with_prefix(x, "m"), with_prefix(y, "m")),
            with_prefix(pulley.radius, "m"),
            format!("{side}{}", groove.unwrap_or_default()),
            motion(pulley),
            plain(pulley.inertia, "kg m²"),
            torque(pulley),
        ]);
    }
    table
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
            ", irregularity {} % of order {}",
            significant(100.0 * harmonic.amplitude),
            significant(harmonic.order)
        );
    }
    text
}

fn torque(pulley: &Pulley) -> String {
    let by_time = profile(&pulley.torque, "N m");
    match &pulley.load {
        None => by_time,
        Some(load) => format!("{by_time} and {}", load_in_words(load)),
    }
}

fn load_in_words(load: &Load) -> &'static str {
    match load {
        Load::Viscous { .. } => "a viscous load",
        Load::Fan { .. } => "a fan's load",
        Load::Table { .. } => "a load by table",
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

fn run(drive: &Drive) -> Table {
    let run = &drive.run;
    let mut table = Table::new("Run", &["Quantity", "Value"]);
    let mut row = |name: &str, value: String| table.row([name.to_owned(), value]);
    row("End", with_prefix(run.end_time, "s"));
    row(
        "Between rows of the history",
        with_prefix(run.output_interval, "s"),
    );
    row(
        "Gravity",
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
