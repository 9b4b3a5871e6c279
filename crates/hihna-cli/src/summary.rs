//! The summary of a run, in words and tables.

use std::fmt::Write;
use std::path::Path;

use comfy_table::Table;
use hihna::summary::{Report, Scatter, Summary};

use crate::quantities::{degrees, percent, plain, significant, with_prefix};
use crate::tables::columns;

/// What an engineer wants to know first.
pub fn in_words(summary: &Summary, folder: &Path) -> String {
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
        "At the start: tension {}, {} on rigid pulleys; the belt sinks {} into the pulleys\n",
        with_prefix(summary.start.tension, "N"),
        with_prefix(summary.start.path_tension, "N"),
        with_prefix(summary.start.penetration, "m"),
    );
    match &summary.settling {
        Some(settling) if settling.reached => {
            let _ = writeln!(
                text,
                "Settled; means over the last two windows of {}:\n",
                with_prefix(settling.window, "s")
            );
        }
        _ => {
            let _ = writeln!(
                text,
                "Means over the last {}:\n",
                summary.averaged.in_words()
            );
        }
    }
    let _ = writeln!(text, "{}\n", pulleys(&summary.steady).trim_fmt());
    let _ = writeln!(
        text,
        "{}\n",
        spans(&summary.steady, &summary.scatter).trim_fmt()
    );
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

/// What the solution took: counts and times.
pub fn solver_in_words(summary: &Summary) -> String {
    let solver = &summary.solver;
    let per_step = |count: usize| significant(count as f64 / solver.steps.max(1) as f64);
    let mut table = columns(&["solver", "in all", "per step"], &[1, 2]);
    let counts = [
        ("force evaluations", solver.force_evaluations),
        ("tangent evaluations", solver.tangent_evaluations),
        ("factorizations", solver.factorizations),
        ("halved steps", solver.halved_steps),
        ("steps by the fall-back", solver.fallback_steps),
    ];
    for (name, count) in counts {
        table.add_row([name.to_owned(), count.to_string(), per_step(count)]);
    }
    let cpu = solver.cpu_seconds;
    table.add_row([
        "processor, stepping alone".to_owned(),
        with_prefix(cpu, "s"),
        with_prefix(cpu / solver.steps.max(1) as f64, "s"),
    ]);
    table.add_row([
        "clock, the whole run".to_owned(),
        with_prefix(solver.wall_seconds, "s"),
        String::new(),
    ]);
    format!("\n{}\n", table.trim_fmt())
}

/// Speeds, torques, hub loads, tensions where the belt runs on and off, slip and creep.
fn pulleys(report: &Report) -> Table {
    let header = [
        "pulley",
        "speed",
        "torque by belt",
        "external",
        "hub load",
        "tension on",
        "off",
        "contact",
        "slip arc",
        "slip",
        "speed loss",
    ];
    let mut table = columns(&header, &[1, 2, 3, 4, 5, 6, 7, 8, 9, 10]);
    for (name, pulley) in &report.pulley.0 {
        table.add_row([
            name.clone(),
            plain(pulley.speed, "rad/s"),
            with_prefix(pulley.torque, "N m"),
            with_prefix(pulley.external_torque, "N m"),
            with_prefix(pulley.hub_force[0].hypot(pulley.hub_force[1]), "N"),
            with_prefix(pulley.tension_in, "N"),
            with_prefix(pulley.tension_out, "N"),
            degrees(pulley.contact_angle),
            degrees(pulley.slip_angle),
            with_prefix(pulley.slip_speed, "m/s"),
            percent(pulley.speed_loss),
        ]);
    }
    table
}

fn spans(report: &Report, scatter: &Scatter) -> Table {
    let header = [
        "span",
        "tension",
        "scatter",
        "strain",
        "belt speed",
        "deflection",
    ];
    let mut table = columns(&header, &[1, 2, 3, 4, 5]);
    for ((name, span), (_, scatter)) in report.span.0.iter().zip(&scatter.span.0) {
        table.add_row([
            name.clone(),
            with_prefix(span.tension, "N"),
            with_prefix(scatter.tension, "N"),
            percent(span.strain),
            with_prefix(span.speed, "m/s"),
            with_prefix(span.deflection, "m"),
        ]);
    }
    table
}
