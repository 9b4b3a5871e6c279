//! Charts over time.

use hihna::drive::Drive;
use hihna::history::History;
use hihna::quantities::significant;
use plotly::common::{DashType, Line, Mode, Orientation};
use plotly::layout::{Axis, HoverMode, Legend, Margin};
use plotly::{Layout, Plot, Scatter};

use crate::drawing::{escaped, letter};
use crate::series::thinned;

/// Distinguishes curves without colour, in print and for the colour-blind.
const DASHES: [DashType; 4] = [
    DashType::Solid,
    DashType::Dash,
    DashType::Dot,
    DashType::DashDot,
];

/// A chart of the page.
pub struct Chart {
    /// What it shows.
    pub title: String,
    /// Its data and layout, as plotly.js takes them.
    pub plot: Plot,
    /// The least and the greatest value of its curves, in words for those who do not see them.
    pub ranges: String,
}

/// A curve of a chart over time.
struct Curve {
    name: String,
    values: Vec<f64>,
}

/// Charts of a chapter of the page.
pub struct OverTime {
    pub speeds: Vec<Chart>,
    pub tensions: Vec<Chart>,
    pub torques: Vec<Chart>,
    pub power: Vec<Chart>,
    pub slip: Vec<Chart>,
    pub hubs: Vec<Chart>,
    pub energies: Vec<Chart>,
}

impl OverTime {
    pub fn new(drive: &Drive, history: &History) -> Self {
        let names: Vec<&str> = drive.pulley.iter().map(|p| p.name.as_str()).collect();
        let spans: Vec<(String, String)> = (0..names.len())
            .map(|i| {
                let name = format!("{}-{}", names[i], names[(i + 1) % names.len()]);
                (format!("{} {name}", letter(i)), name)
            })
            .collect();
        let column = |name: &str| history.column(name).unwrap_or_default();
        let by_pulley = |what: &str, factor: f64| -> Vec<Curve> {
            let curve = |name: &&str| Curve {
                name: (*name).to_owned(),
                values: scaled(&column(&format!("{name}.{what}")), factor),
            };
            names.iter().map(curve).collect()
        };
        let by_span = |what: &str| -> Vec<Curve> {
            let curve = |(label, name): &(String, String)| Curve {
                name: label.clone(),
                values: column(&format!("{name}.{what}")),
            };
            spans.iter().map(curve).collect()
        };
        let time = column("time");
        let chart =
            |title: &str, axis: &str, curves: Vec<Curve>| over_time(&time, title, axis, curves);
        let degrees = 1.0_f64.to_degrees();
        Self {
            speeds: vec![
                chart(
                    "Speed of the pulleys",
                    "Speed [rad/s]",
                    by_pulley("speed", 1.0),
                ),
                chart(
                    "Speed of the belt in the spans",
                    "Belt speed [m/s]",
                    by_span("speed"),
                ),
            ],
            tensions: vec![
                chart("Tension of the spans", "Tension [N]", by_span("tension")),
                chart(
                    "Deflection at mid-span",
                    "Deflection [m]",
                    by_span("deflection"),
                ),
            ],
            torques: vec![
                chart(
                    "Torque of the belt on the pulleys",
                    "Torque [N m]",
                    by_pulley("torque", 1.0),
                ),
                chart(
                    "External torque on the pulleys",
                    "External torque [N m]",
                    by_pulley("external_torque", 1.0),
                ),
            ],
            power: vec![chart("Power", "Power [W]", powers(drive, history))],
            slip: vec![
                chart(
                    "Slip arc of the pulleys",
                    "Slip arc [°]",
                    by_pulley("slip_angle", degrees),
                ),
                chart(
                    "Mean slip velocity",
                    "Slip velocity [m/s]",
                    by_pulley("slip_speed", 1.0),
                ),
            ],
            hubs: vec![chart(
                "Hub load, magnitude",
                "Hub load [N]",
                hub_loads(&names, history),
            )],
            energies: vec![
                chart(
                    "Energy put in, stored and lost",
                    "Energy [J]",
                    energies(history),
                ),
                chart(
                    "What the energy balance leaves over",
                    "Residual [J]",
                    vec![Curve {
                        name: "residual".into(),
                        values: column("energy.residual"),
                    }],
                ),
            ],
        }
    }
}

fn scaled(values: &[f64], factor: f64) -> Vec<f64> {
    values.iter().map(|value| factor * value).collect()
}

/// Power of each driver and load, and what friction takes on all pulleys.
fn powers(drive: &Drive, history: &History) -> Vec<Curve> {
    let column = |name: String| history.column(&name).unwrap_or_default();
    let mut curves = Vec::new();
    let mut friction = vec![0.0; history.len()];
    for pulley in &drive.pulley {
        let name = &pulley.name;
        let torque = column(format!("{name}.external_torque"));
        let speed = column(format!("{name}.speed"));
        let values: Vec<f64> = torque.iter().zip(&speed).map(|(t, w)| t * w).collect();
        if values.iter().any(|value| *value != 0.0) {
            let name = if pulley.is_driver() {
                format!("{name}, put in")
            } else {
                format!("{name}, put in by its load")
            };
            curves.push(Curve { name, values });
        }
        for (sum, loss) in friction
            .iter_mut()
            .zip(column(format!("{name}.friction_loss")))
        {
            *sum += loss;
        }
    }
    curves.push(Curve {
        name: "lost to friction".into(),
        values: friction,
    });
    curves
}

fn hub_loads(names: &[&str], history: &History) -> Vec<Curve> {
    let magnitude = |name: &&str| {
        let part = |axis: &str| {
            history
                .column(&format!("{name}.hub_force_{axis}"))
                .unwrap_or_default()
        };
        Curve {
            name: (*name).to_owned(),
            values: part("x")
                .iter()
                .zip(&part("y"))
                .zip(part("z").iter().chain(std::iter::repeat(&0.0)))
                .map(|((x, y), z)| x.hypot(*y).hypot(*z))
                .collect(),
        }
    };
    names.iter().map(magnitude).collect()
}

fn energies(history: &History) -> Vec<Curve> {
    let columns = [
        ("put in by drivers", "energy.input"),
        ("put in by loads", "energy.load_work"),
        ("kinetic", "energy.kinetic"),
        ("strain", "energy.strain"),
        ("lost to friction", "energy.friction_loss"),
        ("lost in the contact's damping", "energy.contact_loss"),
        ("lost in the belt's damping", "energy.damping_loss"),
    ];
    columns
        .into_iter()
        .map(|(name, column)| Curve {
            name: name.into(),
            values: history.column(column).unwrap_or_default(),
        })
        .filter(|curve| curve.values.iter().any(|value| *value != 0.0))
        .collect()
}

fn over_time(time: &[f64], title: &str, axis: &str, curves: Vec<Curve>) -> Chart {
    let mut plot = Plot::new();
    let several = curves.len() > 1;
    let ranges = ranges(&curves, axis);
    for (i, curve) in curves.into_iter().enumerate() {
        let (x, y) = thinned(time, &curve.values);
        plot.add_trace(
            Scatter::new(x, y)
                .name(escaped(&curve.name))
                .mode(Mode::Lines)
                .line(Line::new().width(1.6).dash(dash(i))),
        );
    }
    plot.set_layout(layout("Time [s]", axis, several));
    Chart {
        title: title.to_owned(),
        plot,
        ranges,
    }
}

/// ` over time; driver from 0 to 12.00, driven from 0 to 12.43 rad/s`.
fn ranges(curves: &[Curve], axis: &str) -> String {
    let unit = (axis.split_once('[')).map_or("", |(_, unit)| unit.trim_end_matches(']'));
    let range = |curve: &Curve| {
        let finite = || {
            curve
                .values
                .iter()
                .copied()
                .filter(|value| value.is_finite())
        };
        let [least, most] = [finite().reduce(f64::min)?, finite().reduce(f64::max)?];
        let (least, most) = (significant(least), significant(most));
        Some(format!("{} from {least} to {most}", curve.name))
    };
    let ranges: Vec<String> = curves.iter().filter_map(range).collect();
    if ranges.is_empty() {
        return String::new();
    }
    format!(" over time; {} {unit}", ranges.join(", "))
}

/// How the curve of a number is drawn.
pub fn dash(i: usize) -> DashType {
    DASHES[i % DASHES.len()].clone()
}

/// What all charts have in common; colours come with the page's theme.
pub fn layout(x: &str, y: &str, legend: bool) -> Layout {
    Layout::new()
        .x_axis(Axis::new().title(x).auto_margin(true))
        .y_axis(Axis::new().title(y).auto_margin(true))
        .height(320)
        .margin(Margin::new().left(64).right(16).top(18).bottom(48))
        .hover_mode(HoverMode::XUnified)
        .show_legend(legend)
        .legend(
            Legend::new()
                .orientation(Orientation::Horizontal)
                .x(0.0)
                .y(1.02)
                .y_anchor(plotly::common::Anchor::Bottom),
        )
}
