//! The summary of a run, in words and tables.

use std::fmt::Write;
use std::path::Path;

use comfy_table::Table;
use hihna::layout::Layout;
use hihna::summary::{Report, Summary};

use crate::quantities::{percent, plain, with_prefix};
use crate::tables::columns;

/// What an engineer wants to know first.
pub fn in_words(summary: &Summary, layout: &Layout, folder: &Path) -> String {
    let mut text = String::new();
    // Writing to a string cannot fail.
    let _ = writeln!(
        text,
        "{}",
        if summary.title.is_empty() {
            "Belt drive"
        } else {
            &summary.title
        }
    );
    let solver = &summary.solver;
    let _ = writeln!(
        text,
        "{} simulated in {}, {} elements, {} steps ({} halved, {} by the fall-back)\n",
        with_prefix(summary.end.time, "s"),
        with_prefix(solver.wall_seconds, "s"),
        summary.model.elements,
        solver.steps,
        solver.halved_steps,
        solver.fallback_steps,
    );
    let _ = writeln!(
        text,
        "At rest: tension {}, {} on rigid pulleys; the belt sinks {} into the pulleys\n",
        with_prefix(summary.start.tension, "N"),
        with_prefix(summary.start.path_tension, "N"),
        with_prefix(summary.start.penetration, "m"),
    );
    let _ = writeln!(text, "Means over the last tenth of the run:\n");
    let _ = writeln!(text, "{}\n", pulleys(&summary.steady, layout).trim_fmt());
    let _ = writeln!(text, "{}\n", spans(&summary.steady).trim_fmt());
    let steady = &summary.steady;
    let _ = writeln!(
        text,
        "Power: {} in, {} out, {} lost",
        with_prefix(steady.power_in, "W"),
        with_prefix(steady.power_out, "W"),
        with_prefix(steady.power_lost, "W"),
    );
    let audit = &summary.audit;
    let _ = writeln!(
        text,
        "Audit: energy residual {:.1e}, torque residual {:.1e}, allowed {:.1e}: {}",
        audit.energy_residual,
        audit.torque_residual,
        audit.tolerance,
        if audit.passed { "passed" } else { "FAILED" },
    );
    let _ = writeln!(text, "Results: {}", folder.display());
    text
}

/// Speeds, torques, hub loads, span tensions before and after each pulley, slip and creep.
fn pulleys(report: &Report, layout: &Layout) -> Table {
    let header = [
        "pulley",
        "speed",
        "torque by belt",
        "external",
        "hub load",
        "tension before",
        "after",
        "slip",
        "speed loss",
    ];
    let mut table = columns(&header, &[1, 2, 3, 4, 5, 6, 7, 8]);
    let spans = &report.span.0;
    let tension = |span: usize| spans.get(span).map_or(f64::NAN, |(_, span)| span.tension);
    for (i, (name, pulley)) in report.pulley.0.iter().enumerate() {
        let mut tensions = [
            tension((i + spans.len()).saturating_sub(1) % spans.len().max(1)),
            tension(i),
        ];
        if runs_backwards(report, layout) {
            tensions.reverse();
        }
        table.add_row([
            name.clone(),
            plain(pulley.speed, "rad/s"),
            with_prefix(pulley.torque, "N m"),
            with_prefix(pulley.external_torque, "N m"),
            with_prefix(pulley.hub_force[0].hypot(pulley.hub_force[1]), "N"),
            with_prefix(tensions[0], "N"),
            with_prefix(tensions[1], "N"),
            with_prefix(pulley.slip_speed, "m/s"),
            percent(pulley.speed_loss),
        ]);
    }
    table
}

/// Whether the belt runs against the order of the pulleys in the file: then a span before a pulley in
/// the file is the span after it on the way of the belt.
fn runs_backwards(report: &Report, layout: &Layout) -> bool {
    let along = layout
        .arcs
        .iter()
        .zip(&report.pulley.0)
        .map(|(arc, (_, pulley))| pulley.speed * arc.sweep);
    along.sum::<f64>() < 0.0
}

fn spans(report: &Report) -> Table {
    let mut table = columns(&["span", "tension", "strain"], &[1, 2]);
    for (name, span) in &report.span.0 {
        table.add_row([
            name.clone(),
            with_prefix(span.tension, "N"),
            percent(span.strain),
        ]);
    }
    table
}
