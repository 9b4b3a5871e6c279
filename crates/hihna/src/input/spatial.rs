//! Rules of belts in space, and of what only they have.

use crate::assemble::is_guided;
use crate::drive::{
    BeltElement, Contact, Drive, Friction, FrictionDirections, Integrator, Joint, PlateBending,
    Pulley, Run, Surface, Wrap,
};
use crate::input::check::own_name;
use crate::input::problem::{FieldPath, Problem};

/// What a belt of the kind that `drive` has must not be asked for.
pub(super) fn problems(drive: &Drive, problems: &mut Vec<Problem>) {
    if drive.belt.element.is_spatial() {
        in_space(drive, problems);
    } else {
        in_the_plane(drive, problems);
    }
    let names: Vec<_> = (drive.pulley.iter())
        .map(|pulley| Some(pulley.name.as_str()))
        .collect();
    for (i, pulley) in drive.pulley.iter().enumerate() {
        let path = FieldPath::default()
            .field("pulley")
            .item(i, own_name(&names, i));
        moved_from_the_start(pulley, &path, problems);
        if drive.belt.element.is_spatial() {
            pulley_in_space(drive, pulley, &path, problems);
        } else {
            pulley_in_the_plane(pulley, &path, problems);
        }
    }
}

fn refuse(path: &FieldPath, what: &str, expected: &str) -> Problem {
    Problem::new(path.clone(), format!("`{path}` {what}")).expected(expected)
}

fn in_the_plane(drive: &Drive, problems: &mut Vec<Problem>) {
    let contact = FieldPath::default().field("contact");
    only_of_plates(drive, problems);
    only_of_beams_in_space(drive, problems);
    if drive.contact.friction_directions != FrictionDirections::default() {
        problems.push(refuse(
            &contact.field("friction_directions"),
            "is for belts in space",
            OF_SPACE,
        ));
    }
    if drive.run.profile_line.to_bits() != Run::default().profile_line.to_bits() {
        let line = FieldPath::default().field("run").field("profile_line");
        problems.push(refuse(&line, "is for belts in space", OF_SPACE));
    }
}

/// What to do about a field that only belts in space have.
const OF_SPACE: &str = "nothing, or `element = \"plate\"` or `\"belt-beam-3d\"` in `[belt]`";

fn only_of_plates(drive: &Drive, problems: &mut Vec<Problem>) {
    let belt = FieldPath::default().field("belt");
    let needless = [
        (drive.belt.elements_across != 1, "elements_across"),
        (drive.belt.bending != PlateBending::default(), "bending"),
    ];
    for (given, field) in needless {
        if given {
            problems.push(refuse(
                &belt.field(field),
                "is for belts of plates",
                "nothing, or `element = \"plate\"` in `[belt]`",
            ));
        }
    }
}

fn only_of_beams_in_space(drive: &Drive, problems: &mut Vec<Problem>) {
    let (belt, contact) = (
        FieldPath::default().field("belt"),
        FieldPath::default().field("contact"),
    );
    let needless = [
        (
            drive.belt.torsion_factor.to_bits() != 1.0_f64.to_bits(),
            belt.field("torsion_factor"),
        ),
        (drive.belt.flank_angle.is_some(), belt.field("flank_angle")),
        (
            drive.contact.points_across != Contact::POINTS_ACROSS,
            contact.field("points_across"),
        ),
    ];
    for (given, path) in needless {
        if given {
            problems.push(refuse(
                &path,
                "is for belts of beams in space",
                "nothing, or `element = \"belt-beam-3d\"` in `[belt]`",
            ));
        }
    }
}

fn in_space(drive: &Drive, problems: &mut Vec<Problem>) {
    let (belt, contact) = (
        FieldPath::default().field("belt"),
        FieldPath::default().field("contact"),
    );
    if drive.belt.element == BeltElement::Plate {
        plates(drive, problems);
    } else {
        only_of_plates(drive, problems);
        section(drive, problems);
    }
    if drive.belt.joint != Joint::Shared {
        problems.push(refuse(
            &belt.field("joint"),
            "is for beams in the plane",
            "`\"shared\"`, or nothing, for belts in space",
        ));
    }
    let laws = [
        ("friction", Some(&drive.contact.friction)),
        ("back_friction", drive.contact.back_friction.as_ref()),
    ];
    for (field, law) in laws {
        if let Some(Friction::ElasticPlastic { .. }) = law {
            problems.push(refuse(
                &contact.field(field),
                "has a law with memory, which the contact of belts in space does not keep",
                "one of \"creep-rate\", \"coulomb\" and \"stribeck\"",
            ));
        }
    }
    if drive.run.integrator == Integrator::RungeKutta {
        problems.push(refuse(
            &FieldPath::default().field("run").field("integrator"),
            "is for beams in the plane: of belts in space no stable step is known beforehand",
            "an implicit integrator",
        ));
    }
}

fn plates(drive: &Drive, problems: &mut Vec<Problem>) {
    let (belt, contact) = (
        FieldPath::default().field("belt"),
        FieldPath::default().field("contact"),
    );
    only_of_beams_in_space(drive, problems);
    if (drive.belt.bending_factor - 1.0).abs() > 0.0 {
        problems.push(
            refuse(
                &belt.field("bending_factor"),
                "is for beams",
                "nothing for plates",
            )
            .help("`bending = \"none\"` takes the bending stiffness of plates away"),
        );
    }
    if drive.contact.surface != Surface::CentreLine {
        problems.push(
            refuse(
                &contact.field("surface"),
                "is for beams",
                "`\"centre-line\"`, or nothing, for plates",
            )
            .help("plates touch with their mid-surface: give radii that reach to it"),
        );
    }
}

/// The section of a V-belt has two sides, and somewhere to lie.
fn section(drive: &Drive, problems: &mut Vec<Problem>) {
    let belt = FieldPath::default().field("belt");
    if let Some(angle) = drive.flank_angle()
        && drive.trapezoid().is_none()
    {
        let widest = drive.belt.width / (0.5 * angle).tan();
        problems.push(
            Problem::new(
                belt.field("thickness"),
                format!(
                    "the flanks of the belt meet: with {:.1} degrees between them a belt {} m wide cannot be {} m high",
                    angle.to_degrees(),
                    drive.belt.width,
                    drive.belt.thickness
                ),
            )
            .expected(format!("a height well below {widest:.6} m"))
            .help("`width` is that at the centre line, `thickness` the height of the section"),
        );
    }
}

/// A displacement starts at zero: where the centre is at first, `center` says.
fn moved_from_the_start(pulley: &Pulley, path: &FieldPath, problems: &mut Vec<Problem>) {
    let Some(displacement) = &pulley.displacement else {
        return;
    };
    let path = path.field("displacement");
    let axes = [
        ("x", &displacement.x),
        ("y", &displacement.y),
        ("z", &displacement.z),
    ];
    for (axis, profile) in axes {
        let start = profile.value(0.0);
        if start != 0.0 {
            problems.push(
                Problem::new(
                    path.field(axis),
                    format!("`{}` is {start} m at time zero", path.field(axis)),
                )
                .expected("a displacement that starts at zero")
                .help("`center` says where the pulley is at first"),
            );
        }
    }
}

fn pulley_in_the_plane(pulley: &Pulley, path: &FieldPath, problems: &mut Vec<Problem>) {
    let displaced = pulley.displacement.as_ref();
    let needless = [
        (pulley.offset != 0.0, path.field("offset")),
        (pulley.tilt != [0.0, 0.0], path.field("tilt")),
        (pulley.taper != 0.0, path.field("taper")),
        (pulley.crown.is_some(), path.field("crown")),
        (
            displaced.is_some_and(|displacement| !displacement.z.is_zero()),
            path.field("displacement").field("z"),
        ),
    ];
    for (given, path) in needless {
        if given {
            problems.push(refuse(
                &path,
                "leaves the plane in which the belt lies",
                OF_SPACE,
            ));
        }
    }
}

fn pulley_in_space(drive: &Drive, pulley: &Pulley, path: &FieldPath, problems: &mut Vec<Problem>) {
    groove(drive, pulley, path, problems);
    if let Some(beside) = beside(drive, pulley, path) {
        // What else is wrong with its surface follows from that.
        problems.push(beside);
        return;
    }
    let [slope, curvature] = pulley.shape();
    let half = 0.5 * drive.belt.width + pulley.offset.abs();
    let least = pulley.radius - slope.abs() * half - 0.5 * curvature.max(0.0) * half * half;
    if least <= 0.5 * pulley.radius {
        let field = if pulley.crown.is_some() {
            "crown"
        } else {
            "taper"
        };
        problems.push(refuse(
            &path.field(field),
            "takes more than half of the radius at the belt's edge",
            "a radius that changes less across the belt",
        ));
    }
    if pulley.is_misaligned()
        && !(drive.belt.element.is_beam_in_space() && is_guided(drive))
        && drive.contact.friction_directions == FrictionDirections::Circumferential
    {
        let field = if pulley.offset != 0.0 {
            "offset"
        } else if pulley.tilt != [0.0, 0.0] {
            "tilt"
        } else if pulley.taper != 0.0 {
            "taper"
        } else {
            "crown"
        };
        problems.push(
            refuse(
                &path.field(field),
                "pushes the belt sideways, against which nothing holds it",
                "`friction_directions = \"both\"` in `[contact]`",
            )
            .help("friction around the pulley alone is for pulleys in line"),
        );
    }
}

/// A belt that no groove guides starts in the plane z = 0: its middle must lie on every pulley. One of unstated width is as wide as the
/// belt, the narrowest that carries it.
fn beside(drive: &Drive, pulley: &Pulley, path: &FieldPath) -> Option<Problem> {
    let half = 0.5 * pulley.crown.map_or(drive.belt.width, |crown| crown.width);
    // A width that cannot be is told by itself.
    let lies_beside = half >= 0.0 && pulley.offset.abs() > half;
    if is_guided(drive) || !lies_beside {
        return None;
    }
    let pulley_width = if pulley.crown.is_some() {
        "the pulley's, by its crown"
    } else {
        "the belt's, as no crown says how wide the pulley is"
    };
    Some(
        Problem::new(
            path.field("offset"),
            format!(
                "the middle of `{path}` is {} m beside the plane z = 0, where the belt starts and reaches {} m to each side",
                pulley.offset.abs(),
                0.5 * drive.belt.width
            ),
        )
        .expected(format!("at most {half} m, half of the width: {pulley_width}"))
        .help("offsets count from the belt: take what all pulleys have in common off them"),
    )
}

/// Steepest wall of a groove that guides a belt: at less than ten degrees between the flanks a micrometre of belt is a
/// tenth of a millimetre of radius.
const NARROWEST: f64 = 0.17;
/// Flattest wall that is one, 150 degrees between the flanks.
const WIDEST: f64 = 2.62;

/// A groove takes the inner side of a V-belt, and has straight walls.
fn groove(drive: &Drive, pulley: &Pulley, path: &FieldPath, problems: &mut Vec<Problem>) {
    let Some(angle) = pulley.groove_angle else {
        return;
    };
    let field = path.field("groove_angle");
    if drive.belt.element == BeltElement::Plate {
        problems.push(refuse(
            &field,
            "is for beams: plates run on flat faces",
            "nothing",
        ));
        return;
    }
    if !(NARROWEST..=WIDEST).contains(&angle) {
        problems.push(refuse(
            &field,
            "makes no groove for the flanks of a belt in space",
            "an angle from 10 to 150 degrees",
        ));
    }
    if pulley.wrap == Wrap::Outside {
        problems.push(
            refuse(
                &field,
                "is on the back of the belt, which is flat",
                "nothing on a pulley with `wrap = \"outside\"`",
            )
            .help("a V-belt runs on idlers outside of the loop with its back"),
        );
    }
    for (given, name) in [
        (pulley.taper != 0.0, "taper"),
        (pulley.crown.is_some(), "crown"),
    ] {
        if given {
            problems.push(refuse(
                &path.field(name),
                "is for flat faces, and the pulley has a groove",
                "nothing beside `groove_angle`",
            ));
        }
    }
    // Where the belt would enter from beyond a wall, the groove holds nothing.
    let mut before = (drive.pulley.iter()).take_while(|other| !std::ptr::eq(*other, pulley));
    if let Some(far) = before.find(|other| (other.offset - pulley.offset).abs() > drive.belt.width)
    {
        problems.push(refuse(
            &path.field("offset"),
            &format!(
                "leads the belt into the groove from beyond its wall: `{}` is more than a belt's width beside",
                far.name
            ),
            "pulleys whose offsets differ by less than the width of the belt",
        ));
    }
}
