//! Charts of a map: lines over one field, contours over two.

use plotly::color::NamedColor;
use plotly::common::{
    ColorBar, ColorScale, ColorScaleElement, Line, Marker, MarkerSymbol, Mode, Position,
};
use plotly::contour::Contours;
use plotly::layout::HoverMode;
use plotly::{Contour, Plot, Scatter};

use super::{Axis, Map, Row};
use crate::charts::{Chart, layout};
use crate::drawing::{escaped, letter};

/// Marks up to which the overload is written beside each; of more it is told when pointed at.
const MOST_WORDS: usize = 60;

/// A result of a map: what it is, its unit, and its value at a point.
struct Quantity {
    title: String,
    unit: &'static str,
    value: Box<dyn Fn(&Row) -> f64>,
    /// Whether points that do not run have it, too.
    everywhere: bool,
}

/// All results that the map has anywhere.
pub fn charts(map: &Map) -> Vec<Chart> {
    let quantities = quantities(map).into_iter();
    let chart = |quantity: Quantity| {
        let values: Vec<f64> = map
            .rows
            .iter()
            .map(|row| {
                let there = quantity.everywhere || row.answer == "running";
                if there {
                    (quantity.value)(row)
                } else {
                    f64::NAN
                }
            })
            .collect();
        let found = values.iter().any(|value| value.is_finite());
        let plot = match &map.axes[..] {
            [x] => lines(map, x, &quantity, &values),
            [x, y] => contours(map, [x, y], &quantity, &values),
            _ => return None,
        };
        found.then(|| Chart {
            title: format!("{} [{}]", quantity.title, quantity.unit),
            plot,
            ranges: String::new(),
        })
    };
    quantities.filter_map(chart).collect()
}

fn quantities(map: &Map) -> Vec<Quantity> {
    let mut all = Vec::new();
    let mut add = |title: String, unit: &'static str, column: String, factor: f64| {
        if let Some(column) = map.column(&column) {
            all.push(Quantity {
                title,
                unit,
                value: Box::new(move |row| factor * row.values[column]),
                everywhere: false,
            });
        }
    };
    let degrees = 1.0_f64.to_degrees();
    add("Speed lost to slip".into(), "%", "speed_loss".into(), 100.0);
    add("Efficiency".into(), "%", "efficiency".into(), 100.0);
    add("Power out".into(), "W", "power_out".into(), 1.0);
    add("Power lost".into(), "W", "power_lost".into(), 1.0);
    let pulleys = &map.drive.pulley;
    for (i, pulley) in pulleys.iter().enumerate() {
        let (from, to) = (&pulley.name, &pulleys[(i + 1) % pulleys.len()].name);
        let span = format!("{from}-{to}");
        let title = format!("Tension of span {} {span}", letter(i));
        add(title, "N", format!("{span}.tension"), 1.0);
    }
    for pulley in pulleys {
        let name = &pulley.name;
        add(
            format!("Hub load of {name}"),
            "N",
            format!("{name}.hub_force"),
            1.0,
        );
        add(
            format!("Slip arc on {name}"),
            "°",
            format!("{name}.slip_angle"),
            degrees,
        );
    }
    if let (Some(margin), Some(overload)) = (map.column("margin"), map.column("overload")) {
        let value = move |row: &Row| match row.answer.as_str() {
            "running" => row.values[margin].recip(),
            _ => row.values[overload],
        };
        all.insert(
            0,
            Quantity {
                title: "Load over what friction carries".into(),
                unit: "–",
                value: Box::new(value),
                everywhere: true,
            },
        );
    }
    all
}

/// What is not a number is a gap.
fn gap(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}

fn lines(map: &Map, x: &Axis, quantity: &Quantity, values: &[f64]) -> Plot {
    let mut y = vec![None; x.values.len()];
    for (row, value) in map.rows.iter().zip(values) {
        if let Some(i) = x.place(row) {
            y[i] = gap(*value);
        }
    }
    let least = values.iter().copied().fold(f64::INFINITY, f64::min);
    let mut plot = Plot::new();
    plot.add_trace(
        Scatter::new(x.values.clone(), y)
            .name(escaped(&quantity.title))
            .mode(Mode::LinesMarkers)
            .line(Line::new().width(1.6))
            .show_legend(false),
    );
    let marked = !quantity.everywhere
        && add_marks(&mut plot, map, |row| Some((row.values[x.column], least)));
    let unit = format!("{} [{}]", quantity.title, quantity.unit);
    plot.set_layout(
        layout(&escaped(&x.title()), &escaped(&unit), marked).hover_mode(HoverMode::Closest),
    );
    plot
}

fn contours(map: &Map, [x, y]: [&Axis; 2], quantity: &Quantity, values: &[f64]) -> Plot {
    let mut z = vec![vec![None; x.values.len()]; y.values.len()];
    for (row, value) in map.rows.iter().zip(values) {
        if let (Some(i), Some(j)) = (x.place(row), y.place(row)) {
            z[j][i] = gap(*value);
        }
    }
    let mut plot = Plot::new();
    plot.add_trace(
        Contour::new(x.values.clone(), y.values.clone(), z)
            .color_scale(bright())
            .contours(Contours::new().show_labels(true))
            .color_bar(ColorBar::new().title(quantity.unit).thickness(12))
            .name(&escaped(&quantity.title))
            .show_legend(false),
    );
    let marked = add_marks(&mut plot, map, |row| {
        Some((row.values[x.column], row.values[y.column]))
    });
    plot.set_layout(
        layout(&escaped(&x.title()), &escaped(&y.title()), marked).hover_mode(HoverMode::Closest),
    );
    plot
}

/// The brighter part of Viridis (Smith and van der Walt): black labels of the contours stay legible on all of it.
fn bright() -> ColorScale {
    let shades = [
        "#2a788e", "#22a884", "#44bf70", "#7ad151", "#bddf26", "#fde725",
    ];
    let last = (shades.len() - 1) as f64;
    let places = shades.iter().enumerate();
    ColorScale::Vector(
        places
            .map(|(i, shade)| ColorScaleElement(i as f64 / last, (*shade).to_owned()))
            .collect(),
    )
}

/// Marks the points that do not run; tells whether there are any.
fn add_marks(plot: &mut Plot, map: &Map, place: impl Fn(&Row) -> Option<(f64, f64)>) -> bool {
    let overload = map.column("overload");
    let mut any = false;
    for (answer, name, symbol) in [
        ("gross-slip", "gross slip", MarkerSymbol::X),
        ("slack", "slack", MarkerSymbol::CircleOpen),
        ("none", "no answer", MarkerSymbol::DiamondOpen),
    ] {
        let rows: Vec<&Row> = map.rows.iter().filter(|row| row.answer == answer).collect();
        if rows.is_empty() {
            continue;
        }
        any = true;
        let (x, y): (Vec<f64>, Vec<f64>) = rows.iter().filter_map(|row| place(row)).unzip();
        let load = |row: &Row| overload.map_or(f64::NAN, |column| row.values[column]);
        let short = |row: &&Row| match load(row) {
            value if value.is_finite() => format!("{value:.2}"),
            _ => String::new(),
        };
        let long = |row: &&Row| match load(row) {
            value if value.is_finite() => {
                format!("{name}: {value:.3} times what friction carries")
            }
            _ => name.to_owned(),
        };
        let trace = Scatter::new(x, y)
            .name(name)
            .hover_text_array(rows.iter().map(long).collect())
            .marker(Marker::new().symbol(symbol).size(7).color(NamedColor::Gray));
        plot.add_trace(if rows.len() <= MOST_WORDS {
            trace
                .mode(Mode::MarkersText)
                .text_array(rows.iter().map(short).collect())
                .text_position(Position::TopCenter)
                .clip_on_axis(false)
        } else {
            trace.mode(Mode::Markers)
        });
    }
    any
}
