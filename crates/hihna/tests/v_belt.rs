//! V-belts in grooves: the sink under tension, the wedge in the tension ratio, balances, offset and tilted pulleys.

use hihna::drive::Drive;
use hihna::observe::ProfileRow;
use hihna::simulate::{Flow, Outcome, simulate};

const EXAMPLE: &str = include_str!("../../../examples/v_belt.toml");

fn run(text: &str, changes: &[&str]) -> (Drive, Outcome) {
    let changes: Vec<_> = changes
        .iter()
        .map(|change| change.parse().expect("an override"))
        .collect();
    let drive = match hihna::input::parse("a test", text, &changes) {
        Ok(drive) => drive,
        Err(errors) => panic!("{errors}"),
    };
    let outcome = simulate(&drive, &mut |_| Flow::Continue).expect("the drive runs");
    assert!(outcome.audit.passed(), "{:?}", outcome.audit);
    (drive, outcome)
}

/// The example without its load, for a driven pulley whose speed is given.
fn unloaded() -> String {
    let lines = EXAMPLE.lines().filter(|line| !line.starts_with("load ="));
    lines.flat_map(|line| [line, "\n"]).collect()
}

/// The belt stays at rest in the grooves, without friction.
const AT_REST: [&str; 6] = [
    "pulley.driver.speed=0.0",
    "contact.friction.coefficient=0.0",
    "run.end_time=1e-3",
    "run.output_interval=1e-3",
    "belt.elements=120",
    "belt.bending_factor=1e-3",
];

/// Rows of the profile on a pulley, in the inner half of its arc.
fn inner_rows<'a>(drive: &Drive, outcome: &'a Outcome, pulley: usize) -> Vec<&'a ProfileRow> {
    let arc = &outcome.layout.arcs[pulley];
    let name = &drive.pulley[pulley].name;
    (outcome.profile.iter())
        .filter(|row| {
            let angle = (row.y - arc.center[1]).atan2(row.x - arc.center[0]) - arc.start_angle;
            let part = angle.rem_euclid(std::f64::consts::TAU) / arc.sweep;
            row.pulley == *name && (0.25..0.75).contains(&part)
        })
        .collect()
}

fn mean(rows: &[&ProfileRow], value: impl Fn(&ProfileRow) -> f64) -> f64 {
    rows.iter().map(|row| value(row)).sum::<f64>() / rows.len() as f64
}

/// The sink of the centre line under tension, without friction: per undeformed length both flanks of the height
/// `h_f` carry `2 sin(g) k h_f d = T lambda / rho`, g half of the groove's angle, d their depth. Across, the same
/// pressure narrows the section by `ezz = -k h_f d cos(g) b_m / E A`, b_m the width at mid-height, so that the centre
/// line sinks by `u = (d + b_m/2 |ezz| cos g) / sin g`. Left out are bending, which carries `E I/rho²` of T, 5e-4 of it
/// with alpha2 = 1e-3; that the narrowing varies over the height, by a seventh of the part of it that moves the
/// pressure's centre, 3e-3 of the sink where the section is soft; and the ripple of the elements, which turn by 0.2 rad:
/// of fourth order, 3e-4 R/u = 1e-3. Held to 1 % together.
#[test]
fn the_belt_sinks_by_the_closed_form() {
    for (stiffness, youngs) in [("1e10", "4e8"), ("4e9", "4e8"), ("1e10", "1e8")] {
        let changes = [
            format!("contact.stiffness={stiffness}"),
            format!("belt.youngs_modulus={youngs}"),
        ];
        let changes: Vec<&str> = (changes.iter().map(String::as_str))
            .chain(AT_REST)
            .collect();
        let (drive, outcome) = run(EXAMPLE, &changes);
        let section = drive.trapezoid().expect("a V-belt");
        let (sine, cosine) = (0.5 * drive.pulley[0].groove_angle.expect("a groove")).sin_cos();
        for p in 0..2 {
            let rows = inner_rows(&drive, &outcome, p);
            assert!(rows.len() > 10);
            let arc = &outcome.layout.arcs[p];
            let place = mean(&rows, |row| {
                (row.x - arc.center[0]).hypot(row.y - arc.center[1])
            });
            let tension = mean(&rows, |row| row.tension);
            let stretch = mean(&rows, |row| 1.0 + row.strain_engineering);
            let on_a_flank = tension * stretch / (2.0 * place * sine);
            let depth = on_a_flank / (drive.contact.stiffness * section.flank());
            let half = 0.5 * section.width_at(section.middle);
            let narrowing =
                on_a_flank * cosine * 2.0 * half / (drive.belt.youngs_modulus * section.area());
            let expected = (depth + half * narrowing * cosine) / sine;
            let sink = arc.radius - place;
            assert!(
                (sink / expected - 1.0).abs() < 0.01,
                "k {stiffness}, E {youngs}: sink {sink} m, expected {expected} m"
            );
            assert!(depth / sine < 0.97 * expected, "the section yields too");
        }
    }
}

/// Mean of a column over the last part of a run.
fn late(outcome: &Outcome, name: &str, from: f64) -> f64 {
    let mean = outcome.history.mean(name, from, f64::INFINITY);
    mean.expect("a column of that name")
}

/// Tight over slack span of the small pulley when it slips all around, both less the momentum flux `m v²` (per
/// undeformed length m v² / lambda).
fn gross_ratio(drive: &Drive, outcome: &Outcome, from: f64) -> f64 {
    let line_density = drive.belt.density * drive.area();
    let effective = |span: &str| {
        let of = |what: &str| late(outcome, &format!("{span}.{what}"), from);
        of("tension") - line_density * of("speed").powi(2) / (1.0 + of("strain"))
    };
    let (a, b) = (effective("driver-driven"), effective("driven-driver"));
    (a / b).max(b / a)
}

/// Both pulleys are driven, the larger one 3 % too slow: the belt slips all around the smaller. The tensions then stand
/// as `exp(mu phi / sin g)`, both less the momentum flux: 4.42 for mu = 0.15, although no groove multiplies any
/// coefficient. Within 3 %: the belt's bending stiffness keeps
/// `sqrt(E I/T)/R`, 0.02 rad, from the groove at each end of the arc, and it seats itself, slipping down the flank, on the
/// way that a sink of u takes, `sqrt(2 u/R)` = 0.05 rad; either moves the exponent by a part in a hundred.
#[test]
fn wedging_multiplies_friction_in_gross_slip() {
    let changes = [
        "contact.friction.coefficient=0.15",
        "belt.elements=60",
        "belt.tension=300",
        "pulley.driver.radius=0.1",
        "pulley.driven.radius=0.12",
        "pulley.driver.center=[-0.25, 0.0]",
        "pulley.driven.center=[0.25, 0.0]",
        "pulley.driver.speed={ kind = \"half-cosine\", from = 0.0, to = 60.0, start = 0.0, end = 0.05 }",
        "pulley.driven.speed={ kind = \"half-cosine\", from = 0.0, to = 48.5, start = 0.0, end = 0.05 }",
        "run.end_time=0.15",
        "run.output_interval=0.5e-3",
    ];
    let (drive, outcome) = run(&unloaded(), &changes);
    let wrap = outcome.layout.arcs[0].sweep;
    let sine = (0.5 * drive.pulley[0].groove_angle.expect("a groove")).sin();
    let expected = (0.15 * wrap / sine).exp();
    let ratio = gross_ratio(&drive, &outcome, 0.1);
    assert!(late(&outcome, "driver.slip_angle", 0.1) > 0.99 * wrap);
    assert!(
        (ratio / expected - 1.0).abs() < 0.03,
        "tensions stand as {ratio}, theory {expected}"
    );
}

/// The example runs, sped up, and its balances close; the records show what it does.
#[test]
fn the_example_runs() {
    let (drive, outcome) = run(
        EXAMPLE,
        &[
            "pulley.driver.speed={ kind = \"half-cosine\", from = 0.0, to = 150.0, start = 0.0, end = 0.1 }",
            "run.end_time=0.15",
        ],
    );
    let loaded = late(&outcome, "driven.external_torque", 0.14);
    let speed = late(&outcome, "driven.speed", 0.14);
    let asked = -12.0 * (speed / (1088.0 * std::f64::consts::TAU / 60.0)).powi(2);
    assert!((loaded / asked - 1.0).abs() < 0.01, "{loaded} {asked}");
    // The driver runs counter-clockwise: its tight side is the span that runs on to it.
    let (slack, tight) = (
        late(&outcome, "driver-driven.tension", 0.14),
        late(&outcome, "driven-driver.tension", 0.14),
    );
    assert!(tight > slack && slack > 0.0, "{tight} N, {slack} N");
    assert!(outcome.profile.iter().all(|row| row.z.abs() < 1.0e-6));
    assert_eq!(drive.contact_points(), 40 * 5 * 2 * 2);
}

/// A driven pulley tilted and set aside, one way and the other: the belt twists, runs off the middle within its groove and
/// loads the hubs across; all of it is mirrored. Steps are chosen alike, so what differs is rounding and what Newton's
/// method leaves.
#[test]
fn a_skewed_pulley_is_carried_by_the_groove() {
    let skewed = |tilt: &str, offset: &str| {
        let changes = [
            format!("pulley.driven.tilt=[{tilt}, 0.0]"),
            format!("pulley.driven.offset={offset}"),
            "pulley.driver.speed={ kind = \"half-cosine\", from = 0.0, to = 60.0, start = 0.0, end = 0.1 }"
                .to_owned(),
            "run.end_time=0.2".to_owned(),
            "belt.bending_factor=0.1".to_owned(),
        ];
        let changes: Vec<&str> = changes.iter().map(String::as_str).collect();
        run(EXAMPLE, &changes)
    };
    let (drive, one) = skewed("0.01", "0.001");
    let (_, other) = skewed("-0.01", "-0.001");
    for (name, sign) in [
        ("driven.speed", 1.0),
        ("driven-driver.tension", 1.0),
        ("driven.belt_offset", -1.0),
        ("driven.hub_force_z", -1.0),
        ("driven.hub_moment_x", -1.0),
        ("driver.hub_moment_y", -1.0),
    ] {
        let (a, b) = (late(&one, name, 0.15), sign * late(&other, name, 0.15));
        assert!(a.abs() > 1.0e-6, "{name} is zero");
        assert!((a - b).abs() < 1.0e-3 * a.abs(), "{name}: {a} and {b}");
    }
    // What the pulleys do to the belt balances, in the mean over a window at constant speed: forces, and moments about
    // the origin. Its momentum changes by what a passage of elements ripples it, a hundredth.
    let of = |pulley: &str, what: &str| late(&one, &format!("{pulley}.{what}"), 0.15);
    let (mut force, mut moment) = ([0.0; 3], [0.0; 3]);
    let (mut forces, mut moments) = (0.0_f64, 0.0_f64);
    for pulley in &drive.pulley {
        let name = &pulley.name;
        let f = ["hub_force_x", "hub_force_y", "hub_force_z"].map(|what| of(name, what));
        let m = ["hub_moment_x", "hub_moment_y", "hub_moment_z"].map(|what| of(name, what));
        let o = pulley.middle(0.0);
        for i in 0..3 {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            force[i] += f[i];
            moment[i] += m[i] + o[j] * f[k] - o[k] * f[j];
            forces = forces.max(f[i].abs());
            moments = moments.max(m[i].abs());
        }
    }
    for axis in 0..3 {
        assert!(force[axis].abs() < 0.01 * forces, "{force:?} of {forces}");
        assert!(
            moment[axis].abs() < 0.01 * moments,
            "{moment:?} of {moments}"
        );
    }
}
