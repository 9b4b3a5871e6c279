//! What belts of plates alone have, and what they have not.

use super::*;

const PLATE: &str = include_str!("../../../../examples/plate_model_1.toml");

fn plate(old: &str, new: &str) -> String {
    assert!(PLATE.contains(old), "{old}");
    PLATE.replacen(old, new, 1)
}

#[test]
fn plates_are_read_in_si() {
    let text = plate("stiffness = 1.0e7", "stiffness = \"0.01 N/mm3\"")
        .replacen("damping = 2000.0", "damping = \"2 kN s/m3\"", 1)
        .replacen("to = -0.0025", "to = \"-2.5 mm\"", 1)
        .replacen(
            "inertia = 0.25",
            "inertia = 0.25\ntilt = [\"1 deg\", 0]\ncrown = { height = \"0.5 mm\", width = \"80 mm\" }",
            1,
        )
        .replacen(
            "points = 9",
            "friction_directions = \"both\"\npoints = 9",
            1,
        );
    let drive: Drive = text.parse().unwrap();
    assert_eq!(drive.contact.stiffness, 1.0e7);
    assert_eq!(drive.contact.damping, 2000.0);
    let [moved, velocity] = drive.pulley[0].displacement.as_ref().unwrap().at(0.02);
    assert!((moved[0] + 0.001).abs() < 1.0e-15 && moved[1..] == [0.0; 2]);
    assert!((velocity[0] + 0.05).abs() < 1.0e-15);
    let [_, y, z] = drive.pulley[1].axis();
    assert!((y.atan2(z).to_degrees() + 1.0).abs() < 1.0e-12);
    // The radius falls by half a millimetre over 40 mm.
    let [slope, curvature] = drive.pulley[1].shape();
    assert!(slope == 0.0 && (0.5 * curvature * 0.04 * 0.04 - 5.0e-4).abs() < 1.0e-15);
    assert!(drive.validate().is_empty());
}

/// Contact is per area of a plate and per length of a beam; text with the other's unit is told apart.
#[test]
fn units_of_contact_follow_the_element() {
    fails(
        &plate("stiffness = 1.0e7", "stiffness = \"1e7 N/m2\""),
        "1e7 N/m2",
        "contact.stiffness",
        &["stiffness per area", "N/m3"],
    );
    fails(
        &with("stiffness = 1.0e7", "stiffness = \"1e7 N/m3\""),
        "1e7 N/m3",
        "contact.stiffness",
        &["stiffness per length", "N/m2"],
    );
}

#[test]
fn plates_refuse_what_beams_have() {
    for (old, new, field, part) in [
        (
            "elements = 16",
            "bending_factor = 0.5\nelements = 16",
            "belt.bending_factor",
            "bending = \"none\"",
        ),
        (
            "elements = 16",
            "joint = \"multipliers\"\nelements = 16",
            "belt.joint",
            "shared",
        ),
        (
            "points = 9",
            "surface = \"face\"\npoints = 9",
            "contact.surface",
            "mid-surface",
        ),
        (
            "inertia = 0.25",
            "groove_angle = 0.6\ninertia = 0.25",
            "pulley.driven.groove_angle",
            "flat faces",
        ),
        (
            "end_time = 1.0",
            "integrator = \"runge-kutta\"\nend_time = 1.0",
            "run.integrator",
            "implicit",
        ),
        (
            "law = \"creep-rate\", coefficient = 1.2, slope = 1.0e5",
            "law = \"elastic-plastic\", coefficient = 1.2, stiffness = 1.0e8",
            "contact.friction",
            "memory",
        ),
    ] {
        let marker = new.lines().next().unwrap();
        fails(&plate(old, new), marker, field, &[part]);
    }
}

#[test]
fn beams_refuse_what_plates_have() {
    for (old, new, field) in [
        (
            "elements = 20",
            "elements_across = 2\nelements = 20",
            "belt.elements_across",
        ),
        (
            "elements = 20",
            "bending = \"none\"\nelements = 20",
            "belt.bending",
        ),
        (
            "points = 7",
            "friction_directions = \"both\"\npoints = 7",
            "contact.friction_directions",
        ),
        (
            "inertia = 0.1",
            "tilt = [0.01, 0.0]\ninertia = 0.1",
            "pulley.driven.tilt",
        ),
        (
            "inertia = 0.1",
            "offset = 0.01\ninertia = 0.1",
            "pulley.driven.offset",
        ),
        (
            "inertia = 0.1",
            "taper = 0.01\ninertia = 0.1",
            "pulley.driven.taper",
        ),
        (
            "inertia = 0.1",
            "crown = { height = 1e-3, width = 0.01 }\ninertia = 0.1",
            "pulley.driven.crown",
        ),
    ] {
        let marker = new.lines().next().unwrap();
        fails(&with(old, new), marker, field, &["element = \"plate\""]);
    }
}

#[test]
fn misaligned_pulleys_need_friction_along_their_axes() {
    fails(
        &plate("inertia = 0.25", "tilt = [0.01, 0.0]\ninertia = 0.25"),
        "tilt =",
        "pulley.driven.tilt",
        &["sideways", "friction_directions = \"both\""],
    );
    let both = plate("points = 9", "friction_directions = \"both\"\npoints = 9");
    fails(
        &both.replacen("inertia = 0.25", "tilt = [0.6, 0.0]\ninertia = 0.25", 1),
        "tilt =",
        "pulley.driven.tilt.0",
        &["at most 0.5"],
    );
}

/// The belt starts at z = 0, 40 mm to each side: its middle must be on every pulley, as wide as its crown says or as the belt. Half a
/// metre beside it the drive would run all the same, as surfaces have no end.
#[test]
fn pulleys_beside_the_belt_are_refused() {
    let both = plate("points = 9", "friction_directions = \"both\"\npoints = 9");
    let beside =
        |lines: &str| both.replacen("inertia = 0.25", &format!("{lines}\ninertia = 0.25"), 1);
    let parts = [
        "0.5 m beside the plane z = 0",
        "0.04 m to each side",
        "at most 0.04 m",
        "have in common",
    ];
    fails(
        &beside("offset = 0.5"),
        "offset = 0.5",
        "pulley.driven.offset",
        &parts,
    );
    let crown = "crown = { height = 0.0005, width = 0.03 }";
    fails(
        &beside(&format!("offset = -0.02\n{crown}")),
        "offset = -0.02",
        "pulley.driven.offset",
        &["0.02 m beside", "at most 0.015 m", "crown"],
    );
    for fits in [
        "offset = -0.04".to_owned(),
        format!("offset = 0.01\n{crown}"),
    ] {
        assert!(
            input::parse("good.toml", &beside(&fits), &[]).is_ok(),
            "{fits}"
        );
    }
}

#[test]
fn displacements_start_at_zero() {
    fails(
        &plate("from = 0.0, to = -0.0025", "from = 0.001, to = -0.0025"),
        "displacement",
        "pulley.driver.displacement.x",
        &["0.001 m at time zero", "`center` says"],
    );
}

/// Free edges contract by the square root of 1 - nu (lambda² - 1): at lambda = 1.8 and nu = 0.4 to a fifth.
#[test]
fn belts_too_narrow_to_hold_are_refused() {
    let text = plate("length = 1.2566370614359172", "strain = 0.8").replacen(
        "poisson_ratio = 0.3",
        "poisson_ratio = 0.4",
        1,
    );
    fails(&text, "strain = 0.8", "belt.strain", &["50 % of its width"]);
}

const V_BELT: &str = include_str!("../../../../examples/v_belt.toml");

fn v_belt(old: &str, new: &str) -> String {
    assert!(V_BELT.contains(old), "{old}");
    V_BELT.replacen(old, new, 1)
}

/// A V-belt has the trapezoid of its groove's angle, or its own, wide as stated at the centre line; in grooves its centre
/// line runs at the radius, on an idler its back does.
#[test]
fn v_belts_are_read() {
    let drive: Drive = V_BELT.parse().unwrap();
    let angle = 36.0_f64.to_radians();
    assert!((drive.flank_angle().unwrap() - angle).abs() < 1e-15);
    let section = drive.trapezoid().unwrap();
    assert!(section.width == 0.011 && section.height == 0.008);
    assert!(drive.area() < 0.011 * 0.008 && drive.area() > 0.97 * 0.011 * 0.008);
    let text = v_belt(
        "radius = \"60 mm\"\ngroove_angle = \"36 deg\"",
        "radius = \"60 mm\"",
    )
    .replacen("points = 5", "points = 5\nsurface = \"face\"", 1)
    .replacen(
        "bending_factor",
        "flank_angle = \"34 deg\"\nbending_factor",
        1,
    );
    let drive: Drive = text.parse().unwrap();
    assert!((drive.flank_angle().unwrap().to_degrees() - 34.0).abs() < 1e-12);
    let section = drive.trapezoid().unwrap();
    assert_eq!(drive.pitch_offset_on(&drive.pulley[0]), 0.0);
    assert_eq!(drive.pitch_offset_on(&drive.pulley[1]), section.narrow());
    assert!(drive.validate().is_empty());
    // In the plane the groove stays a factor on friction.
    let planar: Drive = with("inertia = 0.1", "inertia = 0.1\ngroove_angle = 0.6")
        .parse()
        .unwrap();
    assert!(planar.flank_angle().is_none() && planar.trapezoid().is_none());
}

#[test]
fn v_belts_refuse_what_they_cannot_be() {
    for (old, new, field, part) in [
        ("8 mm", "26 mm", "belt.thickness", "flanks of the belt meet"),
        (
            "points = 5",
            "joint = \"multipliers\"",
            "belt.joint",
            "belts in space",
        ),
        (
            "bending_factor = 0.02",
            "damping_time = 1e-4",
            "belt.damping_time",
            "`belt-beam`",
        ),
        (
            "bending_factor = 0.02",
            "elements_across = 2",
            "belt.elements_across",
            "belts of plates",
        ),
        (
            "groove_angle = \"36 deg\"",
            "groove_angle = \"5 deg\"",
            "pulley.driver.groove_angle",
            "10 to 150 degrees",
        ),
        (
            "inertia = 0.004",
            "taper = 0.01\ninertia = 0.004",
            "pulley.driven.taper",
            "groove",
        ),
        (
            "inertia = 0.004",
            "offset = \"12 mm\"\ninertia = 0.004",
            "pulley.driven.offset",
            "beyond its wall",
        ),
    ] {
        let text = if new.starts_with("joint") {
            v_belt("bending_factor", "joint = \"multipliers\"\nbending_factor")
        } else {
            v_belt(old, new)
        };
        let marker = new.lines().next().unwrap();
        fails(&text, marker, field, &[part]);
    }
}

#[test]
fn planar_belts_refuse_what_beams_in_space_have() {
    for (old, new, field) in [
        (
            "elements = 20",
            "torsion_factor = 0.5\nelements = 20",
            "belt.torsion_factor",
        ),
        (
            "elements = 20",
            "flank_angle = 0.6\nelements = 20",
            "belt.flank_angle",
        ),
        (
            "points = 7",
            "points_across = 2\npoints = 7",
            "contact.points_across",
        ),
    ] {
        let marker = new.lines().next().unwrap();
        fails(
            &with(old, new),
            marker,
            field,
            &["element = \"belt-beam-3d\""],
        );
    }
}
