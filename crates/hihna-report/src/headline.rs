//! What an engineer wants to know first.

use hihna::quantities::{percent, plain, with_prefix};
use hihna::record::Results;

use crate::drawing::letter;
use crate::tables::{largest_hub_load, span_names};

/// Relative scatter of a span's tension above which the end of the run is not called steady.
const STEADY: f64 = 0.02;

/// A number in large print.
pub struct Card {
    pub label: &'static str,
    pub value: String,
    pub note: String,
    /// Whether it asks for attention.
    pub alarm: bool,
}

/// The headline: cards, and sentences on what to beware of.
pub struct Headline {
    pub cards: Vec<Card>,
    pub cautions: Vec<String>,
}

impl Headline {
    pub fn new(results: &Results) -> Self {
        let cards = vec![
            speed_loss(results),
            tension(results),
            hub_load(results),
            power(results),
            grip(results),
            audit(results),
        ];
        let mut cautions: Vec<String> = results.summary["warnings"]
            .as_array()
            .into_iter()
            .flatten()
            .filter_map(|warning| warning.as_str().map(str::to_owned))
            .collect();
        cautions.extend(unsteady(results));
        Self { cards, cautions }
    }
}

fn pulley(results: &Results, name: &str, what: &str) -> f64 {
    results.number(&["steady", "pulley", name, what])
}

/// The entry with the greatest finite number.
fn greatest<T>(entries: impl Iterator<Item = (T, f64)>) -> Option<(T, f64)> {
    entries
        .filter(|(_, value)| value.is_finite())
        .max_by(|a, b| a.1.total_cmp(&b.1))
}

fn none(label: &'static str) -> Card {
    Card {
        label,
        value: "–".into(),
        note: "nothing recorded".into(),
        alarm: false,
    }
}

fn speed_loss(results: &Results) -> Card {
    let label = "Speed lost to slip";
    let pulleys = &results.drive.pulley;
    let driver = pulleys.iter().find(|pulley| pulley.is_driver());
    let driven = pulleys.iter().filter(|pulley| !pulley.is_driver());
    let worst = greatest(driven.map(|p| (p, pulley(results, &p.name, "speed_loss"))));
    let (Some(driver), Some((driven, loss))) = (driver, worst) else {
        return none(label);
    };
    let speed = |name: &str| plain(pulley(results, name, "speed"), "rad/s");
    Card {
        label,
        value: percent(loss),
        note: format!(
            "{} {}, {} {}",
            driver.name,
            speed(&driver.name),
            driven.name,
            speed(&driven.name)
        ),
        alarm: false,
    }
}

fn tension(results: &Results) -> Card {
    let label = "Tension, tight and slack";
    let spans: Vec<(usize, f64)> = span_names(results)
        .iter()
        .enumerate()
        .map(|(i, name)| (i, results.number(&["steady", "span", name, "tension"])))
        .collect();
    let tight = greatest(spans.iter().copied());
    let slack = greatest(spans.iter().map(|(i, tension)| (*i, -tension)));
    let (Some((tight, most)), Some((slack, least))) = (tight, slack) else {
        return none(label);
    };
    let lowest = span_names(results)
        .iter()
        .filter_map(|name| results.history.column(&format!("{name}.tension")))
        .flatten()
        .fold(f64::NAN, f64::min);
    Card {
        label,
        value: format!("{} / {}", with_prefix(most, "N"), with_prefix(-least, "N")),
        note: format!(
            "spans {} and {}; {} at rest, at least {} in the run",
            letter(tight),
            letter(slack),
            with_prefix(results.number(&["start", "tension"]), "N"),
            with_prefix(lowest, "N")
        ),
        alarm: lowest <= 0.0,
    }
}

fn hub_load(results: &Results) -> Card {
    let label = "Largest hub load";
    let loads = results.drive.pulley.iter().map(|p| {
        let [x, y] = ["0", "1"]
            .map(|axis| results.number(&["steady", "pulley", &p.name, "hub_force", axis]));
        let sideways = results.number(&["steady", "pulley", &p.name, "hub_force_z"]);
        // Belts in the plane have none.
        let z = if sideways.is_finite() { sideways } else { 0.0 };
        (p, x.hypot(y).hypot(z))
    });
    let Some((pulley, load)) = greatest(loads) else {
        return none(label);
    };
    Card {
        label,
        value: with_prefix(load, "N"),
        note: format!(
            "on {}; {} at its peak in the run",
            pulley.name,
            with_prefix(largest_hub_load(results, &pulley.name), "N")
        ),
        alarm: false,
    }
}

fn power(results: &Results) -> Card {
    let of = |what: &str| results.number(&["steady", what]);
    let (put_in, out, lost) = (of("power_in"), of("power_out"), of("power_lost"));
    let note = format!(
        "{} out, {} lost{}",
        with_prefix(out, "W"),
        with_prefix(lost, "W"),
        rest_of_power(put_in, out, lost)
    );
    Card {
        label: "Power put in",
        value: with_prefix(put_in, "W"),
        note,
        alarm: false,
    }
}

/// What the power does that is neither taken out nor lost: it sets the drive in motion, or there is none of it and the
/// efficiency is that of steady running.
fn rest_of_power(put_in: f64, out: f64, lost: f64) -> String {
    let stored = put_in - out - lost;
    let turned_over = put_in.abs().max(out.abs()).max(lost.abs());
    if stored.abs() > STEADY * turned_over {
        let where_to = if stored > 0.0 { "into" } else { "out of" };
        format!(", {} {where_to} motion", with_prefix(stored.abs(), "W"))
    } else if put_in > 0.0 && out > 0.0 {
        format!(": efficiency {}", percent(out / put_in))
    } else {
        String::new()
    }
}

/// How much of a contact slides: all of it is gross slip.
fn grip(results: &Results) -> Card {
    let label = "Grip used";
    let parts = results.drive.pulley.iter().map(|p| {
        let of = |what: &str| pulley(results, &p.name, what);
        (p, of("slip_angle") / of("contact_angle"))
    });
    let Some((pulley, part)) = greatest(parts) else {
        return none(label);
    };
    Card {
        label,
        value: percent(part),
        note: format!(
            "of the contact on {} slides; 100 % is gross slip",
            pulley.name
        ),
        alarm: part > 0.9,
    }
}

fn audit(results: &Results) -> Card {
    let of = |what: &str| results.number(&["audit", what]);
    let passed = results.summary["audit"]["passed"].as_bool() == Some(true);
    Card {
        label: "Audit",
        value: if passed { "passed" } else { "FAILED" }.into(),
        note: format!(
            "energy closes to {:.0e}, torque to {:.0e}, {:.0e} allowed",
            of("energy_residual"),
            of("torque_residual"),
            of("tolerance")
        ),
        alarm: !passed,
    }
}

/// Sentences if means over the end of the run hide a motion.
fn unsteady(results: &Results) -> Vec<String> {
    let part = |object: &str, name: &str, what: &str| {
        let of = |means: &str| results.number(&[means, object, name, what]);
        (of("scatter") / of("steady")).abs()
    };
    let spans = span_names(results).into_iter().enumerate();
    let spans = spans.map(|(i, name)| {
        let part = part("span", &name, "tension");
        (format!("tension of span {}", letter(i)), part)
    });
    let free = results.drive.pulley.iter().filter(|p| !p.is_driver());
    let pulleys = free.map(|pulley| {
        let part = part("pulley", &pulley.name, "speed");
        (format!("speed of {}", pulley.name), part)
    });
    let worst = [greatest(spans), greatest(pulleys)].into_iter().flatten();
    let moving: Vec<String> = worst
        .filter(|(_, part)| *part > STEADY)
        .map(|(what, part)| format!("the {what} still varies by {:.0} %", 100.0 * part))
        .collect();
    if moving.is_empty() {
        return Vec::new();
    }
    let moving = moving.join(" and ");
    let is_shaken = results
        .drive
        .pulley
        .iter()
        .any(|p| !p.irregularity.is_empty());
    vec![if is_shaken {
        format!(
            "The drive swings with its irregular driver: at the end of the run {moving} (standard deviation). Means are those of a swinging drive."
        )
    } else {
        format!(
            "The drive has not settled: at the end of the run {moving} (standard deviation). Means are those of a moving drive; a longer run may settle."
        )
    }]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A drive that speeds up has no efficiency; one that runs steadily, but for a part below what counts as steady, has.
    #[test]
    fn power_that_is_stored_is_no_loss_of_efficiency() {
        assert_eq!(rest_of_power(210.0, 87.5, 2.5), ", 120.0 W into motion");
        assert_eq!(rest_of_power(-0.5, 0.0, 0.02), ", 520.0 mW out of motion");
        assert_eq!(rest_of_power(100.0, 97.0, 2.0), ": efficiency 97.00 %");
        assert_eq!(rest_of_power(2.0, 0.0, 2.0), "");
        assert_eq!(rest_of_power(f64::NAN, 0.0, 0.0), "");
    }
}
