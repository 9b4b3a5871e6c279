//! Tables of the page: what the run found, pulley by pulley and span by span.

use hihna::drive::Start;
use hihna::quantities::{degrees, percent, plain, significant, with_prefix};
use hihna::record::Results;

use crate::drawing::letter;

/// A table of text.
#[derive(Clone, Debug, Default)]
pub struct Table {
    /// What it holds.
    pub caption: String,
    /// Heads of the columns.
    pub header: Vec<String>,
    /// The first cell of a row names it.
    pub rows: Vec<Vec<String>>,
}

impl Table {
    pub(crate) fn new(caption: &str, header: &[&str]) -> Self {
        Self {
            caption: caption.to_owned(),
            header: header.iter().map(ToString::to_string).collect(),
            rows: Vec::new(),
        }
    }

    pub(crate) fn row(&mut self, cells: impl IntoIterator<Item = impl Into<String>>) {
        self.rows.push(cells.into_iter().map(Into::into).collect());
    }
}

/// Over what the means are taken, in words.
pub fn means(results: &Results) -> String {
    let settling = &results.summary["settling"];
    if settling["reached"].as_bool() == Some(true) {
        let window = results.number(&["settling", "window"]);
        format!(
            "means over the last two windows of {}",
            with_prefix(window, "s")
        )
    } else if let Some(periods) = results.summary["averaged"]["periods"].as_u64() {
        let of = |end: &str| results.number(&["averaged", end]);
        let periods = match periods {
            1 => "period".to_owned(),
            _ => format!("{periods} periods"),
        };
        let duration = with_prefix(of("to") - of("from"), "s");
        format!("means over the last {periods} of the irregularity, {duration}")
    } else {
        "means over the last tenth of the run".to_owned()
    }
}

/// Means of pulleys, hubs and spans.
pub fn result_tables(results: &Results) -> [Table; 3] {
    [pulleys(results), hubs(results), spans(results)]
}

fn pulleys(results: &Results) -> Table {
    let mut table = Table::new(
        &format!("Pulleys, {}", means(results)),
        &[
            "Pulley",
            "Speed",
            "Speed loss",
            "Torque by belt",
            "External torque",
            "Power from belt",
            "Wrap",
            "Contact",
            "Slip arc",
            "Slip velocity",
        ],
    );
    for pulley in &results.drive.pulley {
        let of = |what: &str| results.number(&["steady", "pulley", &pulley.name, what]);
        table.row([
            pulley.name.clone(),
            plain(of("speed"), "rad/s"),
            percent(of("speed_loss")),
            with_prefix(of("torque"), "N m"),
            with_prefix(of("external_torque"), "N m"),
            with_prefix(of("power"), "W"),
            degrees(of("wrap_angle")),
            degrees(of("contact_angle")),
            degrees(of("slip_angle")),
            with_prefix(of("slip_speed"), "m/s"),
        ]);
    }
    table
}

fn hubs(results: &Results) -> Table {
    let in_space = results.drive.belt.element.is_spatial();
    let mut header = vec!["Pulley", "Magnitude", "Along x", "Along y"];
    if in_space {
        header.push("Along z");
    }
    header.extend([
        "Direction",
        "Largest in the run",
        "Tension on",
        "Tension off",
    ]);
    if in_space {
        header.extend(["Moment about x", "Moment about y", "Belt off its middle"]);
    }
    let caption = format!(
        "Hub loads: force of the belt on the pulley, {}",
        means(results)
    );
    let mut table = Table::new(&caption, &header);
    for pulley in &results.drive.pulley {
        let of = |what: &str| results.number(&["steady", "pulley", &pulley.name, what]);
        let moment =
            |axis: &str| results.number(&["steady", "pulley", &pulley.name, "hub_moment", axis]);
        let [x, y] = ["0", "1"]
            .map(|axis| results.number(&["steady", "pulley", &pulley.name, "hub_force", axis]));
        let z = if in_space { of("hub_force_z") } else { 0.0 };
        let mut row = vec![
            pulley.name.clone(),
            with_prefix(x.hypot(y).hypot(z), "N"),
            with_prefix(x, "N"),
            with_prefix(y, "N"),
        ];
        if in_space {
            row.push(with_prefix(z, "N"));
        }
        row.extend([
            degrees(y.atan2(x)),
            with_prefix(largest_hub_load(results, &pulley.name), "N"),
            with_prefix(of("tension_in"), "N"),
            with_prefix(of("tension_out"), "N"),
        ]);
        if in_space {
            row.extend([
                with_prefix(moment("0"), "N m"),
                with_prefix(moment("1"), "N m"),
                with_prefix(of("belt_offset"), "m"),
            ]);
        }
        table.row(row);
    }
    table
}

/// The largest force of the belt on a pulley at any output time [N].
pub fn largest_hub_load(results: &Results, pulley: &str) -> f64 {
    let column = |axis: &str| {
        let name = format!("{pulley}.hub_force_{axis}");
        results.history.column(&name).unwrap_or_default()
    };
    let sideways = column("z").into_iter().chain(std::iter::repeat(0.0));
    let magnitudes = column("x").into_iter().zip(column("y")).zip(sideways);
    magnitudes
        .map(|((x, y), z)| x.hypot(y).hypot(z))
        .fold(f64::NAN, f64::max)
}

/// Names of the spans in order, `from-to`.
pub fn span_names(results: &Results) -> Vec<String> {
    let pulleys = &results.drive.pulley;
    let next = pulleys.iter().cycle().skip(1);
    let names = pulleys.iter().zip(next);
    names
        .map(|(from, to)| format!("{}-{}", from.name, to.name))
        .collect()
}

fn spans(results: &Results) -> Table {
    let mut table = Table::new(
        &format!("Spans, {}", means(results)),
        &[
            "Span",
            "Tension",
            "± (std. dev.)",
            "Least in the run",
            "Largest in the run",
            "Strain",
            "Belt speed",
            "Deflection",
        ],
    );
    for (i, name) in span_names(results).iter().enumerate() {
        let of = |what: &str| results.number(&["steady", "span", name, what]);
        let tension = results
            .history
            .column(&format!("{name}.tension"))
            .unwrap_or_default();
        let least = tension.iter().copied().fold(f64::NAN, f64::min);
        let largest = tension.iter().copied().fold(f64::NAN, f64::max);
        table.row([
            format!("{} {name}", letter(i)),
            with_prefix(of("tension"), "N"),
            with_prefix(results.number(&["scatter", "span", name, "tension"]), "N"),
            with_prefix(least, "N"),
            with_prefix(largest, "N"),
            percent(of("strain")),
            with_prefix(of("speed"), "m/s"),
            with_prefix(of("deflection"), "m"),
        ]);
    }
    table
}

/// Energy and torque balance.
pub fn audit(results: &Results) -> Table {
    let of = |what: &str| results.number(&["audit", what]);
    let mut table = Table::new(
        "Balances",
        &["Balance", "Largest residual", "Allowed", "Verdict"],
    );
    let verdict = |residual: f64| {
        if residual <= of("tolerance") {
            "closes"
        } else {
            "FAILS"
        }
    };
    for (name, key) in [
        (
            "Energy, relative to the work turned over",
            "energy_residual",
        ),
        (
            "Torque on the free pulleys, relative to what their torques moved",
            "torque_residual",
        ),
    ] {
        let residual = of(key);
        table.row([
            name.to_owned(),
            format!("{residual:.1e}"),
            format!("{:.1e}", of("tolerance")),
            verdict(residual).to_owned(),
        ]);
    }
    table
}

/// Mesh, solver and cost.
pub fn computation(results: &Results) -> Table {
    let model = |what: &str| results.number(&["model", what]);
    let solver = |what: &str| results.number(&["solver", what]);
    let word = |object: &str, key: &str| {
        results.summary[object][key]
            .as_str()
            .unwrap_or("–")
            .to_owned()
    };
    let mut table = Table::new("", &["Quantity", "Value"]);
    let mut row = |name: &str, value: String| table.row([name.to_owned(), value]);
    row("Program", format!("Hihna {}", env!("CARGO_PKG_VERSION")));
    row(
        "Mesh",
        format!(
            "{}{} elements of kind {}, {} coordinates, {} contact points",
            model("elements"),
            match model("elements_across") {
                across if across > 1.0 => format!(" × {across}"),
                _ => String::new(),
            },
            word("model", "element"),
            model("dofs"),
            model("contact_points")
        ),
    );
    let start = match results.drive.run.start {
        Start::Rest => "equilibrium at rest",
        Start::Steady => "steady running",
    };
    row(
        "Start",
        format!(
            "{start} in {} iterations: tension {}, the belt sinks {} into the pulleys",
            results.number(&["start", "iterations"]),
            with_prefix(results.number(&["start", "tension"]), "N"),
            with_prefix(results.number(&["start", "penetration"]), "m")
        ),
    );
    row("Integrator", word("solver", "integrator"));
    row(
        "Accuracy aimed at",
        format!(
            "{}; the balances may leave {:.0e}",
            significant(results.drive.run.accuracy),
            results.number(&["audit", "tolerance"])
        ),
    );
    row(
        "Steps",
        format!(
            "{}, {} tried again at half the length, {} by the fall-back; {} on average",
            solver("steps"),
            solver("halved_steps"),
            solver("fallback_steps"),
            with_prefix(results.number(&["end", "time"]) / solver("steps"), "s"),
        ),
    );
    row(
        "Evaluations",
        format!(
            "{} of the forces, {} of the tangent, {} factorizations",
            solver("force_evaluations"),
            solver("tangent_evaluations"),
            solver("factorizations")
        ),
    );
    row(
        "Time spent",
        format!(
            "{} of the processor in steps, {} by the clock in all",
            with_prefix(solver("cpu_seconds"), "s"),
            with_prefix(solver("wall_seconds"), "s")
        ),
    );
    table
}
