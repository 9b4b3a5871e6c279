//! The page of a map of steady running, or of a Campbell diagram.

use askama::Template;
use plotly::Plot;

use super::Map;
use super::charts::charts;
use crate::ReportError;
use crate::page::{SCRIPT, plotly_script, titled};

/// What such a page shows.
pub struct MapPage {
    pub title: String,
    /// What kind of page it is.
    pub kind: &'static str,
    /// What to know of the charts.
    pub text: &'static str,
    /// What varies, what stands, and how many points have which answer.
    pub facts: Vec<[String; 2]>,
    /// Titles of the charts.
    pub charts: Vec<String>,
    pub plots: Vec<Plot>,
}

#[derive(Template)]
#[template(path = "map.html")]
struct Whole {
    page: MapPage,
    style: &'static str,
    script: &'static str,
    plotly: &'static str,
    data: String,
}

/// The page of `map`, of one or two fields.
pub fn map_page(map: &Map) -> Result<String, ReportError> {
    if !(1..=2).contains(&map.axes.len()) {
        return Err(ReportError::Axes {
            count: map.axes.len(),
        });
    }
    let (charts, plots) = charts(map)
        .into_iter()
        .map(|chart| (chart.title, chart.plot))
        .unzip();
    render(MapPage {
        title: titled(&map.drive).to_owned(),
        kind: "Map of steady running",
        text: "Where the load is more than 1 of what friction carries the drive slips as a whole; such points are marked with their load, and have no other results.",
        facts: facts(map),
        charts,
        plots,
    })
}

/// The page as HTML.
pub fn render(page: MapPage) -> Result<String, ReportError> {
    let whole = Whole {
        style: include_str!("../../templates/report.css"),
        script: SCRIPT,
        plotly: plotly_script(),
        // A closing tag within the data would end it.
        data: serde_json::to_string(&serde_json::json!({ "plots": page.plots }))?
            .replace('<', "\\u003c"),
        page,
    };
    Ok(whole.render()?)
}

fn facts(map: &Map) -> Vec<[String; 2]> {
    let with_unit = |value: f64, unit: &str| format!("{value} {unit}").trim_end().to_owned();
    let ends = |values: &[f64]| (values[0], values[values.len() - 1]);
    let mut facts: Vec<_> = map
        .axes
        .iter()
        .map(|axis| {
            let ((from, to), unit) = (ends(&axis.values), axis.unit);
            let count = axis.values.len();
            let range = format!("{count} values from {from} to {}", with_unit(to, unit));
            [axis.key.clone(), range]
        })
        .collect();
    for (axis, value) in &map.fixed {
        facts.push([axis.key.clone(), with_unit(*value, axis.unit)]);
    }
    for (answer, words) in [
        ("running", "Points that run"),
        ("gross-slip", "Points that slip as a whole"),
        ("slack", "Points with a slack span"),
        ("none", "Points without an answer"),
    ] {
        let count = map.count(answer);
        if count > 0 {
            facts.push([words.to_owned(), count.to_string()]);
        }
    }
    facts
}
