//! Rules that involve several fields of a drive. Ranges of single fields are attributes of `Drive`.

use crate::assemble::{AssemblyError, Mounting, closable, contraction};
use crate::drive::{Belt, BeltElement, Drive, Pulley, Run, Step, Surface};
use crate::input::check::own_name;
use crate::input::problem::{FieldPath, Problem, quoted};
use crate::input::spatial;
use crate::layout::{Layout, LayoutError};
use crate::load::Load;
use crate::profile::{Profile, Varying};
use crate::simulate::MOST_STEPS;

/// More rows than this fill a disk before they tell anything.
const MOST_ROWS: f64 = 1e7;

/// More frames than this fill memory before anybody has looked at them.
const MOST_FRAMES: f64 = 1e4;

/// Everything that breaks a rule, in the order of the file.
pub(crate) fn problems(drive: &Drive) -> Vec<Problem> {
    let mut problems = Vec::new();
    element(&drive.belt, &mut problems);
    tightness(&drive.belt, &mut problems);
    number_of_pulleys(&drive.pulley, &mut problems);
    let names: Vec<_> = drive
        .pulley
        .iter()
        .map(|pulley| Some(pulley.name.as_str()))
        .collect();
    for (i, pulley) in drive.pulley.iter().enumerate() {
        let path = FieldPath::default()
            .field("pulley")
            .item(i, own_name(&names, i));
        name(pulley, &drive.pulley[..i], &path, &mut problems);
        overlap(pulley, &drive.pulley[..i], &path, &mut problems);
        motion(pulley, &path, &mut problems);
        thickness(drive, pulley, &path, &mut problems);
    }
    spatial::problems(drive, &mut problems);
    span_names(&drive.pulley, &mut problems);
    run(&drive.run, &mut problems);
    problems
}

/// Whether the pulleys carry a belt and the belt fits on them. Makes sense only for a drive without
/// other problems.
pub(crate) fn mounting(drive: &Drive) -> Option<Problem> {
    let tightness = match &drive.belt {
        Belt {
            length: Some(_), ..
        } => "length",
        Belt {
            tension: Some(_), ..
        } => "tension",
        _ => "strain",
    };
    let fit = Layout::of(drive)
        .map_err(AssemblyError::Layout)
        .and_then(|layout| Mounting::new(drive, &layout))
        .and_then(|mounting| {
            if drive.belt.element == BeltElement::Plate {
                contraction(&drive.belt, &mounting)?;
            }
            closable(drive, &mounting)
        });
    let error = fit.err()?;
    let pulleys = FieldPath::default().field("pulley");
    let path = match &error {
        AssemblyError::TooLong { .. }
        | AssemblyError::TooShort { .. }
        | AssemblyError::NoWidth { .. } => FieldPath::default().field("belt").field(tightness),
        AssemblyError::Layout(
            LayoutError::NoContact { pulley, .. }
            | LayoutError::SpanBlocked { pulley, .. }
            | LayoutError::BadPulley { pulley, .. }
            | LayoutError::Overlap { second: pulley, .. },
        ) => match drive.pulley.iter().position(|known| known.name == *pulley) {
            Some(i) => pulleys.item(i, Some(pulley)),
            None => pulleys,
        },
        AssemblyError::Layout(_) => pulleys,
        AssemblyError::NoSection { .. } => FieldPath::default().field("belt").field("thickness"),
        AssemblyError::Joint(_) => FieldPath::default().field("belt").field("joint"),
        AssemblyError::TooFewElements { .. } => {
            FieldPath::default().field("belt").field("elements")
        }
    };
    let problem = Problem::new(path, error.to_string());
    Some(match error {
        AssemblyError::TooLong { path, .. } => {
            problem.expected(format!("an unstretched length below {path:.6} m"))
        }
        AssemblyError::TooShort { shortest, path, .. } => problem.expected(match tightness {
            "length" => format!("an unstretched length between {shortest:.6} m and {path:.6} m"),
            "strain" => format!("a strain below {}", path / shortest - 1.0),
            _ => "a tension that stretches the belt less, or a stiffer belt".to_owned(),
        }),
        AssemblyError::TooFewElements { elements, .. } => {
            problem.expected(format!("at least {elements} elements"))
        }
        AssemblyError::NoWidth { .. } => {
            problem.expected("a belt that is stretched less, or a smaller Poisson's ratio")
        }
        AssemblyError::Joint(_) | AssemblyError::NoSection { .. } => problem,
        AssemblyError::Layout(_) => {
            problem.help("`hihna check` prints the path of the belt once it closes")
        }
    })
}

/// What only the belt beam has must not be asked of other elements.
fn element(belt: &Belt, problems: &mut Vec<Problem>) {
    let path = FieldPath::default().field("belt");
    let planar = [BeltElement::BeltBeam];
    let both = [BeltElement::BeltBeam, BeltElement::BeltBeam3d];
    let needless = [
        (
            "axial_factor",
            belt.axial_factor,
            1.0,
            &both[..],
            "`belt-beam` and `belt-beam-3d`",
        ),
        (
            "damping_time",
            belt.damping_time,
            0.0,
            &planar[..],
            "`belt-beam`",
        ),
    ];
    for (field, value, neutral, owners, named) in needless {
        if !owners.contains(&belt.element) && (value - neutral).abs() > 0.0 {
            problems.push(
                Problem::new(
                    path.field(field),
                    format!("only {named} elements have the `{field}`, which is {value}"),
                )
                .expected(format!("{neutral}, or nothing, for other elements")),
            );
        }
    }
}

/// Exactly one of length, tension and strain says how tight the belt is.
fn tightness(belt: &Belt, problems: &mut Vec<Problem>) {
    let path = FieldPath::default().field("belt");
    let given: Vec<_> = [
        ("length", belt.length),
        ("tension", belt.tension),
        ("strain", belt.strain),
    ]
    .into_iter()
    .filter_map(|(name, value)| value.map(|_| name))
    .collect();
    let expected = "exactly one of `length`, `tension` and `strain` in `[belt]`";
    match given.as_slice() {
        [_] => {}
        [] => problems.push(
            Problem::new(path, "the drive does not say how tight the belt is")
                .expected(expected)
                .help("give the unstretched `length`, or `tension = \"50 N\"`, or `strain = 0.01`"),
        ),
        [.., last] => problems.push(
            Problem::new(
                path.field(last),
                format!("{} are all given", quoted(given.iter().copied(), '`')),
            )
            .expected(expected)
            .help("keep the one that you know best; `hihna check` prints the others"),
        ),
    }
}

fn number_of_pulleys(pulleys: &[Pulley], problems: &mut Vec<Problem>) {
    let path = FieldPath::default().field("pulley");
    match pulleys {
        [] => problems.push(
            Problem::new(path, "the drive has no pulley")
                .expected("at least two `[[pulley]]` tables"),
        ),
        [pulley] => problems.push(
            Problem::new(
                path.item(0, None),
                format!("`{}` is the only pulley", pulley.name),
            )
            .expected("at least two `[[pulley]]` tables")
            .help("add a second pulley, in the order in which the belt meets them"),
        ),
        pulleys => {
            if !pulleys.iter().any(Pulley::is_driver) {
                problems.push(
                    Problem::new(path, "no pulley drives the belt")
                        .expected("a pulley with a `speed` or an `angle`")
                        .help("add `speed = { kind = \"ramp\", from = 0.0, to = \"720 rpm\", start = 0.0, end = 0.5 }` to the driver"),
                );
            }
        }
    }
}

/// Names head columns: `driven.speed`, `driver-driven.tension`.
fn name(pulley: &Pulley, before: &[Pulley], path: &FieldPath, problems: &mut Vec<Problem>) {
    let place = path.field("name");
    let fits = |c: char| c.is_alphanumeric() || matches!(c, '_' | '-');
    if pulley.name.is_empty() || !pulley.name.chars().all(fits) {
        problems.push(
            Problem::new(
                place,
                format!("{:?} cannot be the name of a pulley", pulley.name),
            )
            .expected("letters, digits, `_` and `-`")
            .help("names head the columns of `history.csv`"),
        );
    } else if pulley.name == "energy" || pulley.name == "time" {
        problems.push(
            Problem::new(
                place,
                format!("{:?} cannot be the name of a pulley", pulley.name),
            )
            .help("columns of `history.csv` have this name; choose another"),
        );
    } else if before.iter().any(|other| other.name == pulley.name) {
        problems.push(
            Problem::new(
                place,
                format!("two pulleys have the name {:?}", pulley.name),
            )
            .help("give each pulley its own name"),
        );
    }
}

/// Spans are named after the pulleys that they join, which a hyphen in a name can make ambiguous.
fn span_names(pulleys: &[Pulley], problems: &mut Vec<Problem>) {
    let next = pulleys.iter().cycle().skip(1);
    let spans: Vec<_> = pulleys
        .iter()
        .zip(next)
        .map(|(from, to)| format!("{}-{}", from.name, to.name))
        .collect();
    let hyphen = pulleys.iter().any(|pulley| pulley.name.contains('-'));
    for (i, span) in spans.iter().enumerate().filter(|_| hyphen) {
        if let Some(named) = pulleys.iter().position(|pulley| pulley.name == *span) {
            let path = FieldPath::default()
                .field("pulley")
                .item(named, None)
                .field("name");
            problems.push(
                Problem::new(path, format!("{span:?} is also the name of a span of the belt"))
                    .help("a span is named after its two pulleys, joined by a hyphen; use `_` within names"),
            );
        }
        if spans[..i].contains(span) {
            let path = FieldPath::default()
                .field("pulley")
                .item(i, None)
                .field("name");
            problems.push(
                Problem::new(path, format!("two spans of the belt would have the name {span:?}"))
                    .help("a span is named after its two pulleys, joined by a hyphen; use `_` within names"),
            );
        }
    }
}

/// Pulleys must leave room for each other.
fn overlap(pulley: &Pulley, before: &[Pulley], path: &FieldPath, problems: &mut Vec<Problem>) {
    for other in before {
        let distance =
            (pulley.center[0] - other.center[0]).hypot(pulley.center[1] - other.center[1]);
        let needed = pulley.radius + other.radius;
        if distance <= needed {
            problems.push(
                Problem::new(path.field("center"), format!("the pulleys `{}` and `{}` overlap", other.name, pulley.name))
                    .expected(format!("centres more than {needed} m apart, the sum of the radii; they are {distance} m apart"))
                    .help("move one of the pulleys or make it smaller"),
            );
        }
    }
}

/// A belt that touches with its centre line is bent about the pulley's radius: half of its thickness must
/// find room there.
fn thickness(drive: &Drive, pulley: &Pulley, path: &FieldPath, problems: &mut Vec<Problem>) {
    let section = drive.trapezoid();
    let half = section.map_or(0.5 * drive.belt.thickness, |section| section.narrow());
    let to_centre_line =
        drive.contact.surface == Surface::CentreLine || drive.is_grooved_in_space(pulley);
    if to_centre_line && half >= pulley.radius {
        problems.push(
            Problem::new(
                path.field("radius"),
                format!(
                    "the belt is too thick for `{path}`: its thickness inside of the centre line, {half} m, is not less than the radius, {} m",
                    pulley.radius
                ),
            )
            .expected(format!("a radius above {half} m"))
            .help("the radius reaches to the belt's centre line; with `contact.surface = \"face\"` it is that of the pulley itself"),
        );
    }
}

/// A driver has a prescribed motion; any other pulley turns by its inertia and torque.
fn motion(pulley: &Pulley, path: &FieldPath, problems: &mut Vec<Problem>) {
    if pulley.speed.is_some() && pulley.angle.is_some() {
        problems.push(
            Problem::new(
                path.field("angle"),
                format!("`{path}` has both a speed and an angle"),
            )
            .expected("one of `speed` and `angle`")
            .help("the other follows from it"),
        );
    }
    if pulley.is_driver() && !pulley.torque.is_zero() {
        problems.push(
            Problem::new(
                path.field("torque"),
                format!("`{path}` has a prescribed motion and a torque"),
            )
            .expected("no `torque` on a driver: the torque that it needs is a result")
            .help(
                "remove `torque`, or remove `speed` or `angle` to let the torque drive the pulley",
            ),
        );
    }
    if pulley.is_driver() && pulley.load.is_some() {
        problems.push(
            Problem::new(
                path.field("load"),
                format!("`{path}` has a prescribed motion and a load"),
            )
            .expected("no `load` on a driver: the torque that it needs is a result"),
        );
    }
    if !pulley.irregularity.is_empty() && pulley.speed.is_none() {
        problems.push(
            Problem::new(
                path.field("irregularity"),
                format!("`{path}` has an irregularity but no speed"),
            )
            .expected("`irregularity` beside a `speed`, of which it is a part"),
        );
    }
    if let Some(Load::Table { speed, torque }) = &pulley.load {
        points(
            ("speed", "rad/s", speed),
            ("torque", torque),
            &path.field("load"),
            problems,
        );
    }
    if !pulley.is_driver() && pulley.inertia == 0.0 {
        problems.push(
            Problem::new(
                path.field("inertia"),
                format!("`{path}` turns freely but has no inertia"),
            )
            .expected("a positive moment of inertia, such as `inertia = \"0.01 kg m2\"`")
            .help("a solid disc has half of its mass times the square of its radius"),
        );
    }
    let profiles = [
        ("speed", pulley.speed.as_ref()),
        ("angle", pulley.angle.as_ref()),
        ("torque", Some(&pulley.torque)),
    ];
    for (field, given) in profiles {
        if let Some(given) = given {
            profile(given, &path.field(field), problems);
        }
    }
    if let Some(moved) = &pulley.displacement {
        for (axis, given) in [("x", &moved.x), ("y", &moved.y), ("z", &moved.z)] {
            profile(given, &path.field("displacement").field(axis), problems);
        }
    }
}

fn profile(profile: &Profile, path: &FieldPath, problems: &mut Vec<Problem>) {
    match profile {
        Profile::Constant(_) => {}
        Profile::Varying(
            Varying::Ramp { start, end, .. } | Varying::HalfCosine { start, end, .. },
        ) => {
            if end <= start {
                problems.push(
                    Problem::new(
                        path.field("end"),
                        format!("`{path}` ends at {end} s but starts at {start} s"),
                    )
                    .expected("an `end` after the `start`")
                    .help("a change takes time: a jump would need an infinite force"),
                );
            }
        }
        Profile::Varying(Varying::Table { time, value }) => {
            points(("time", "s", time), ("value", value), path, problems);
        }
    }
}

/// Points of a table: `x` named `x_name` in `unit` must increase, with a value named `y_name` for each.
fn points(
    (x_name, unit, x): (&str, &str, &[f64]),
    (y_name, y): (&str, &[f64]),
    path: &FieldPath,
    problems: &mut Vec<Problem>,
) {
    if x.is_empty() {
        problems.push(
            Problem::new(path.field(x_name), format!("the table `{path}` is empty"))
                .expected(format!("at least one {x_name} and {y_name}")),
        );
    }
    if x.len() != y.len() {
        problems.push(
            Problem::new(
                path.field(y_name),
                format!(
                    "`{path}` has {} {x_name}s but {} {y_name}s",
                    x.len(),
                    y.len()
                ),
            )
            .expected(format!("as many {y_name}s as {x_name}s")),
        );
    }
    let unsorted = x.windows(2).position(|pair| pair[1] <= pair[0]);
    if let Some(i) = unsorted {
        let (before, after) = (x[i], x[i + 1]);
        let help = if after >= before {
            if x_name == "time" {
                "a change takes time: give the second value a later time".to_owned()
            } else {
                format!("keep one {y_name} for each {x_name}")
            }
        } else {
            format!("sort the table by {x_name}, {y_name}s with it")
        };
        problems.push(
            Problem::new(
                path.field(x_name).item(i + 1, None),
                format!("`{path}` has the {x_name} {after} {unit} after {before} {unit}"),
            )
            .expected(format!("{x_name}s that increase"))
            .help(help),
        );
    }
}

fn run(run: &Run, problems: &mut Vec<Problem>) {
    let path = FieldPath::default().field("run");
    let end = run.end_time;
    if run.output_interval > end {
        problems.push(
            Problem::new(
                path.field("output_interval"),
                format!(
                    "the output interval {} s is longer than the run",
                    run.output_interval
                ),
            )
            .expected(format!("at most the end time, {end} s")),
        );
    }
    if run.output_interval > 0.0 && end / run.output_interval > MOST_ROWS {
        problems.push(
            Problem::new(
                path.field("output_interval"),
                format!(
                    "the history would have {:.1e} rows",
                    end / run.output_interval
                ),
            )
            .expected(format!("at most {MOST_ROWS:e} rows"))
            .help("make the output interval longer; it has no influence on the accuracy"),
        );
    }
    if let Step::Fixed(step) = run.step
        && step > end
    {
        problems.push(
            Problem::new(
                path.field("step"),
                format!("the step {step} s is longer than the run"),
            )
            .expected(format!("\"auto\", or much less than the end time, {end} s")),
        );
    }
    if run.frame_start > end {
        problems.push(
            Problem::new(
                path.field("frame_start"),
                format!("the first frame at {} s is after the run", run.frame_start),
            )
            .expected(format!("a time from 0 s to the end time, {end} s")),
        );
    }
    if let Some(interval) = run.frame_interval
        && interval > 0.0
        && (end - run.frame_start) / interval > MOST_FRAMES
    {
        problems.push(
            Problem::new(
                path.field("frame_interval"),
                format!(
                    "there would be {:.1e} frames",
                    (end - run.frame_start) / interval
                ),
            )
            .expected(format!("at most {MOST_FRAMES:e} frames"))
            .help("make the interval longer, or let the frames start later by `run.frame_start`"),
        );
    }
    if let Step::Fixed(step) = run.step
        && end / step > MOST_STEPS
    {
        problems.push(
            Problem::new(
                path.field("step"),
                format!("the run would take {:.1e} steps of {step:e} s", end / step),
            )
            .expected(format!("\"auto\", or at least {:.1e} s", end / MOST_STEPS)),
        );
    }
    let mut outside =
        (run.profile_times.iter().enumerate()).filter(|(_, time)| !(0.0..=end).contains(*time));
    if let Some((first, time)) = outside.next() {
        let others = outside.count();
        let told = if others == 0 {
            format!("the profile time {time} s is outside the run")
        } else {
            format!(
                "{} profile times are outside the run, the first of them {time} s",
                others + 1
            )
        };
        problems.push(
            Problem::new(path.field("profile_times").item(first, None), told)
                .expected(format!("times from 0 s to the end time, {end} s")),
        );
    }
}
