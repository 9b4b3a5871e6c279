//! Charts along the belt.

use hihna::drive::Drive;
use hihna::layout::Layout as Path;
use hihna::observe::ProfileRow;
use plotly::common::{Anchor, Line, Mode};
use plotly::layout::{Annotation, Shape, ShapeLayer, ShapeLine, ShapeType};
use plotly::{Layout, Plot, Scatter};

use crate::charts::{Chart, dash, layout};
use crate::drawing::escaped;
use crate::path::feet;
use crate::series::short;

/// Most times shown: more curves than this hide each other. The last ones are.
const MOST_TIMES: usize = 6;

/// A quantity along the belt: title, axis, and its value.
type Quantity = (&'static str, &'static str, fn(&ProfileRow) -> f64);

const QUANTITIES: [Quantity; 4] = [
    ("Tension along the belt", "Tension [N]", |row| {
        row.element_tension
    }),
    ("Normal force along the belt", "Normal force [N/m]", |row| {
        row.normal_force
    }),
    (
        "Friction force on the belt",
        "Friction force [N/m]",
        |row| row.friction_force,
    ),
    (
        "Slip velocity along the belt",
        "Slip velocity [m/s]",
        |row| row.slip_speed,
    ),
];

/// Charts of the belt's profiles over the path, with the pulleys marked.
pub fn along_the_belt(drive: &Drive, path: &Path, profile: &[ProfileRow]) -> Vec<Chart> {
    let mut times: Vec<&[ProfileRow]> = profile
        .chunk_by(|a, b| a.time.to_bits() == b.time.to_bits())
        .collect();
    times.drain(..times.len().saturating_sub(MOST_TIMES));
    // The charts begin in the middle of a span: no pulley is cut in two.
    let origin = match (path.arcs.first(), path.spans.last()) {
        (Some(arc), Some(span)) => arc.start - 0.5 * span.length,
        _ => 0.0,
    };
    let sorted: Vec<(f64, Vec<(f64, &ProfileRow)>)> = times
        .iter()
        .map(|belt| {
            let mut points: Vec<(f64, &ProfileRow)> = feet(path, belt)
                .iter()
                .zip(*belt)
                .map(|(foot, row)| ((foot.along - origin).rem_euclid(path.length), row))
                .collect();
            points.sort_by(|a, b| a.0.total_cmp(&b.0));
            (belt[0].time, points)
        })
        .collect();
    QUANTITIES
        .iter()
        .map(|(title, axis, value)| {
            let mut plot = Plot::new();
            for (i, (time, points)) in sorted.iter().enumerate() {
                let (x, y): (Vec<f32>, Vec<f32>) = points
                    .iter()
                    .map(|(along, row)| (short(*along), short(value(row))))
                    .unzip();
                plot.add_trace(
                    Scatter::new(x, y)
                        .name(format!("t = {} s", short(*time)))
                        .mode(Mode::Lines)
                        .line(Line::new().width(1.6).dash(dash(i))),
                );
            }
            let (shapes, names) = marks(drive, path, origin);
            let layout: Layout = layout("Position along the path [m]", axis, sorted.len() > 1)
                .shapes(shapes)
                .annotations(names);
            plot.set_layout(layout);
            Chart {
                title: (*title).to_owned(),
                plot,
                ranges: String::new(),
            }
        })
        .collect()
}

/// A grey band and a name for each pulley.
fn marks(drive: &Drive, path: &Path, origin: f64) -> (Vec<Shape>, Vec<Annotation>) {
    path.arcs
        .iter()
        .map(|arc| {
            let start = arc.start - origin;
            let band = Shape::new()
                .shape_type(ShapeType::Rect)
                .x_ref("x")
                .y_ref("paper")
                .x0(start)
                .x1(start + arc.length)
                .y0(0)
                .y1(1)
                .fill_color("rgba(128,128,128,0.16)")
                .line(ShapeLine::new().width(0.0))
                .layer(ShapeLayer::Below);
            let name = Annotation::new()
                .text(escaped(&drive.pulley[arc.pulley].name))
                .x_ref("x")
                .y_ref("paper")
                .x(start + 0.5 * arc.length)
                .y(1.0)
                .y_anchor(Anchor::Top)
                .show_arrow(false);
            (band, name)
        })
        .unzip()
}
