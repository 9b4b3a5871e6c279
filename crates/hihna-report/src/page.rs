//! The page: chapters put into the template.

use askama::Template;
use hihna::drive::Drive;
use hihna::layout::Layout;
use hihna::observe::ProfileRow;
use hihna::record::Results;
use plotly::Plot;

use crate::ReportError;
use crate::animation::{Animation, animation};
use crate::charts::{Chart, OverTime};
use crate::distribution::along_the_belt;
use crate::drawing::drawing;
use crate::headline::Headline;
use crate::inputs::inputs;
use crate::tables::{Table, audit, computation, means, result_tables};

#[derive(Template)]
#[template(path = "report.html")]
struct Page<'a> {
    title: &'a str,
    headline: Headline,
    means: String,
    drawing: String,
    chapters: Vec<Chapter>,
    has_frames: bool,
    /// Whether the animation can be turned.
    in_space: bool,
    frames_note: String,
    inputs: Vec<Table>,
    computation: Table,
    style: &'static str,
    script: &'static str,
    plotly: &'static str,
    data: String,
}

/// The page's own script.
pub const SCRIPT: &str = concat!(
    include_str!("../templates/space.js"),
    include_str!("../templates/report.js")
);

/// A part of the page with tables and charts.
struct Chapter {
    id: &'static str,
    title: &'static str,
    text: &'static str,
    tables: Vec<Table>,
    charts: Vec<Figure>,
}

/// A chart whose data stand in the page's data.
struct Figure {
    title: String,
    ranges: String,
    number: usize,
}

/// The page of `results` on the path `layout`.
pub fn render(results: &Results, layout: &Layout) -> Result<String, ReportError> {
    let drive = &results.drive;
    let animation = animation(
        drive,
        layout,
        &results.history,
        &results.frames,
        &results.edges,
    );
    let frames_note = match &animation {
        Some(_) => String::new(),
        None => "The folder holds no frames of the moving belt. `hihna run --report` keeps them, and so does `--set run.frame_interval=0.005`.".to_owned(),
    };
    let mut plots = Vec::new();
    let chapters = chapters(results, layout, &mut plots);
    let page = Page {
        title: titled(drive),
        headline: Headline::new(results),
        means: means(results),
        drawing: drawing(drive, layout, last_profile(results), &speeds(results)),
        chapters,
        has_frames: animation.is_some(),
        frames_note,
        inputs: inputs(results),
        computation: computation(results),
        style: include_str!("../templates/report.css"),
        in_space: animation.as_ref().is_some_and(Animation::is_in_space),
        script: SCRIPT,
        plotly: plotly_script(),
        // A closing tag within the data would end it.
        data: serde_json::to_string(
            &serde_json::json!({ "plots": plots, "animation": animation }),
        )?
        .replace('<', "\\u003c"),
    };
    Ok(page.render()?)
}

/// The drive's title, or what it is.
pub fn titled(drive: &Drive) -> &str {
    if drive.title.is_empty() {
        "Belt drive"
    } else {
        &drive.title
    }
}

/// The belt at the last profile time, for its slip; nothing where the drive does not know its friction.
pub fn last_profile(results: &Results) -> &[ProfileRow] {
    if results.summary.get("stated_friction").is_some() {
        return &[];
    }
    results
        .profile
        .chunk_by(|a, b| a.time.to_bits() == b.time.to_bits())
        .last()
        .unwrap_or_default()
}

/// Mean speed of every pulley [rad/s].
pub fn speeds(results: &Results) -> Vec<f64> {
    let speed = |name: &str| results.number(&["steady", "pulley", name, "speed"]);
    let pulleys = results.drive.pulley.iter();
    pulleys.map(|pulley| speed(&pulley.name)).collect()
}

fn chapters(results: &Results, layout: &Layout, plots: &mut Vec<Plot>) -> Vec<Chapter> {
    let over_time = OverTime::new(&results.drive, &results.history);
    let [pulleys, hubs, spans] = result_tables(results);
    let mut chapter = |id, title, text, tables, charts: Vec<Chart>| Chapter {
        id,
        title,
        text,
        tables,
        charts: charts
            .into_iter()
            .map(|chart| {
                plots.push(chart.plot);
                Figure {
                    title: chart.title,
                    ranges: chart.ranges,
                    number: plots.len() - 1,
                }
            })
            .collect(),
    };
    let along = along_the_belt(&results.drive, layout, &results.profile);
    vec![
        chapter(
            "speeds",
            "Speeds",
            "Counter-clockwise is positive.",
            vec![pulleys],
            over_time.speeds,
        ),
        chapter(
            "tensions",
            "Span tensions",
            "",
            vec![spans],
            over_time.tensions,
        ),
        chapter(
            "torques",
            "Torques",
            "Counter-clockwise is positive.",
            Vec::new(),
            over_time.torques,
        ),
        chapter("power", "Power", "", Vec::new(), over_time.power),
        chapter(
            "slip",
            "Slip",
            "The slip arc is the part of a contact where friction is exhausted; the slip velocity is that of the belt against the pulley's surface, averaged over the contact.",
            Vec::new(),
            over_time.slip,
        ),
        chapter(
            "along",
            "Along the belt",
            "From the middle of the span before the first pulley, in the order of the pulleys; grey where the rigid path lies on one. Tension is the mean of each element.",
            Vec::new(),
            along,
        ),
        chapter("hubs", "Hub loads", "", vec![hubs], over_time.hubs),
        chapter(
            "audit",
            "Audits",
            "Every run checks that energy put in is stored or lost, and that torques explain how free pulleys speed up.",
            vec![audit(results)],
            over_time.energies,
        ),
    ]
}

/// plotly.js alone: the crate's sources hold MathJax behind it, of which no chart makes use.
pub fn plotly_script() -> &'static str {
    static SOURCES: std::sync::LazyLock<String> =
        std::sync::LazyLock::new(Plot::offline_js_sources);
    const END: &str = "</script>";
    SOURCES
        .find(END)
        .map_or(SOURCES.as_str(), |at| &SOURCES[..at + END.len()])
}
