//! Rules of belts in space, and of what only they have.

use crate::drive::{
    Drive, Friction, FrictionDirections, Integrator, Joint, PlateBending, Pulley, Surface,
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
    let (belt, contact) = (
        FieldPath::default().field("belt"),
        FieldPath::default().field("contact"),
    );
    let needless = [
        (
            drive.belt.elements_across != 1,
            belt.field("elements_across"),
        ),
        (
            drive.belt.bending != PlateBending::default(),
            belt.field("bending"),
        ),
        (
            drive.contact.friction_directions != FrictionDirections::default(),
            contact.field("friction_directions"),
        ),
    ];
    for (given, path) in needless {
        if given {
            problems.push(refuse(
                &path,
                "is for belts of plates",
                "nothing, or `element = \"plate\"` in `[belt]`",
            ));
        }
    }
}

fn in_space(drive: &Drive, problems: &mut Vec<Problem>) {
    let (belt, contact) = (
        FieldPath::default().field("belt"),
        FieldPath::default().field("contact"),
    );
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
    if drive.belt.joint != Joint::Shared {
        problems.push(refuse(
            &belt.field("joint"),
            "is for beams",
            "`\"shared\"`, or nothing, for plates",
        ));
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
    let laws = [
        ("friction", Some(&drive.contact.friction)),
        ("back_friction", drive.contact.back_friction.as_ref()),
    ];
    for (field, law) in laws {
        if let Some(Friction::ElasticPlastic { .. }) = law {
            problems.push(refuse(
                &contact.field(field),
                "has a law with memory, which the contact of plates does not keep",
                "one of \"creep-rate\", \"coulomb\" and \"stribeck\"",
            ));
        }
    }
    if drive.run.integrator == Integrator::RungeKutta {
        problems.push(refuse(
            &FieldPath::default().field("run").field("integrator"),
            "is for beams: of plates no stable step is known beforehand",
            "an implicit integrator",
        ));
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
                "leaves the plane in which the belt of beams lies",
                "nothing, or `element = \"plate\"` in `[belt]`",
            ));
        }
    }
}

fn pulley_in_space(drive: &Drive, pulley: &Pulley, path: &FieldPath, problems: &mut Vec<Problem>) {
    if pulley.groove_angle.is_some() {
        problems.push(refuse(
            &path.field("groove_angle"),
            "is for beams: plates run on flat faces",
            "nothing",
        ));
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
