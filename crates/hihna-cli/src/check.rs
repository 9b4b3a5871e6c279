//! `hihna check`: the layout of a drive, without running it.

use std::fmt::Write;

use clap::Args;
use hihna::assemble::{self, AssemblyError, Mounting, Rest};
use hihna::drive::{Drive, Pulley};
use hihna::layout::Layout;
use hihna::simulate::RunError;
use serde_json::{Value, json};

use crate::diagnostics::{Failure, print_warning};
use crate::drive_source::DriveSource;
use crate::quantities::{percent, with_prefix};
use crate::standard_output;
use crate::tables::columns;

/// Check a drive file and print its layout: path, wrap angles, spans, strain and tension at rest.
#[derive(Debug, Args)]
pub struct Arguments {
    #[command(flatten)]
    source: DriveSource,

    /// Print one JSON object
    #[arg(long)]
    pub json: bool,
}

/// Prints the layout, and warnings to standard error.
pub fn check(arguments: &Arguments) -> Result<(), Failure> {
    let drive = arguments.source.load()?;
    let (layout, mounting) = mount(&drive).map_err(RunError::Assembly)?;
    let soft = Rest::estimate(&drive, &layout, &mounting)
        .and_then(|rest| rest.soft_contact(&drive, &layout, &mounting));
    let warnings: Vec<_> = assemble::coarse_elements(&drive, &layout, &mounting)
        .into_iter()
        .chain(soft)
        .map(|warning| warning.to_string())
        .collect();
    if arguments.json {
        return standard_output::print_json(&in_json(&drive, &layout, &mounting, &warnings));
    }
    standard_output::print(&in_words(&drive, &layout, &mounting))?;
    for warning in &warnings {
        print_warning(warning);
    }
    Ok(())
}

fn mount(drive: &Drive) -> Result<(Layout, Mounting), AssemblyError> {
    let layout = Layout::of(drive)?;
    let mounting = Mounting::new(drive, &layout)?;
    Ok((layout, mounting))
}

fn in_json(drive: &Drive, layout: &Layout, mounting: &Mounting, warnings: &[String]) -> Value {
    let name = |pulley: usize| drive.pulley[pulley].name.as_str();
    let pulleys = layout.arcs.iter().map(|arc| {
        let entry = json!({ "wrap_angle": arc.sweep, "start_angle": arc.start_angle, "arc_length": arc.length });
        (name(arc.pulley).to_owned(), entry)
    });
    let spans = layout.spans.iter().map(|span| {
        let entry = json!({ "length": span.length, "start": span.start, "end": span.end });
        (format!("{}-{}", name(span.from), name(span.to)), entry)
    });
    json!({
        "title": drive.title,
        "path_length": mounting.path,
        "belt_length": mounting.length,
        "strain": mounting.stretch - 1.0,
        "tension": mounting.tension,
        "pulley": pulleys.collect::<serde_json::Map<_, _>>(),
        "span": spans.collect::<serde_json::Map<_, _>>(),
        "warnings": warnings,
    })
}

fn in_words(drive: &Drive, layout: &Layout, mounting: &Mounting) -> String {
    let mut text = String::new();
    // Writing to a string cannot fail.
    let _ = writeln!(
        text,
        "{}\n",
        if drive.title.is_empty() {
            "Belt drive"
        } else {
            &drive.title
        }
    );
    let _ = writeln!(text, "path of the belt  {:.6} m", mounting.path);
    let _ = writeln!(text, "unstretched belt  {:.6} m", mounting.length);
    let _ = writeln!(
        text,
        "strain at rest    {}",
        percent(mounting.stretch - 1.0)
    );
    let _ = writeln!(
        text,
        "tension at rest   {}, on rigid pulleys",
        with_prefix(mounting.tension, "N")
    );
    let _ = writeln!(
        text,
        "elements          {} of {}\n",
        drive.belt.elements,
        with_prefix(mounting.length / drive.belt.elements as f64, "m")
    );
    let mut pulleys = columns(
        &["pulley", "radius", "wrap angle", "arc", "motion"],
        &[1, 2, 3],
    );
    for arc in &layout.arcs {
        let pulley = &drive.pulley[arc.pulley];
        pulleys.add_row([
            pulley.name.clone(),
            with_prefix(pulley.radius, "m"),
            format!("{:.2}°", arc.sweep.to_degrees()),
            with_prefix(arc.length, "m"),
            motion(pulley).to_owned(),
        ]);
    }
    let _ = writeln!(text, "{}\n", pulleys.trim_fmt());
    let mut spans = columns(&["span", "length"], &[1]);
    for span in &layout.spans {
        let (from, to) = (&drive.pulley[span.from].name, &drive.pulley[span.to].name);
        spans.add_row([format!("{from}-{to}"), with_prefix(span.length, "m")]);
    }
    let _ = writeln!(text, "{}", spans.trim_fmt());
    text
}

fn motion(pulley: &Pulley) -> &'static str {
    match (&pulley.speed, &pulley.angle) {
        (Some(_), _) => "prescribed speed",
        (_, Some(_)) => "prescribed angle",
        _ if pulley.torque.is_zero() && pulley.load.is_none() => "free",
        _ => "free, with torque",
    }
}
