//! The validation dossier as a page of the book.

use std::fmt::Write;

use super::{Case, Finding, Verdict};

/// How the page came about, for its reader.
const HEAD: &str = "\
# Validation

Published values and what this program computes, case by case. This page is written by

```sh
cargo run --release -- validate --markdown > docs/src/validation.md
```

*Deviation* is computed less published, or less the reference in brackets where the printed value is a
misprint or none is printed; of a bound, the distance to it. The reasons of the tolerances and the notes
stand below each table. Values that are only shown are other programs', or depend on the machine.
";

/// The page for the findings of `cases`, in their order.
pub fn markdown(cases: &[&Case], findings: &[Finding]) -> String {
    let mut page = HEAD.to_owned();
    let judged = findings.iter().filter(|finding| finding.passed.is_some());
    let passed = judged
        .clone()
        .filter(|finding| finding.passed == Some(true));
    // Writing to a string cannot fail.
    let _ = writeln!(
        page,
        "\n{} of {} judged values agree.",
        passed.count(),
        judged.count()
    );
    for case in cases {
        let _ = writeln!(
            page,
            "\n## `{}`\n\n{}. {}.\n",
            case.name, case.title, case.source
        );
        page.push_str(
            "| quantity | unit | published | computed | deviation | tolerance | verdict |\n\
             |---|---|---|---|---|---|---|\n",
        );
        let rows: Vec<_> = findings
            .iter()
            .filter(|finding| finding.case == case.name)
            .collect();
        for finding in &rows {
            let _ = writeln!(
                page,
                "| {} | {} | {} | {} | {} | {} | {} |",
                escaped(&finding.quantity),
                finding.unit,
                escaped(&finding.published_in_words()),
                finding.computed_in_words(),
                finding.deviation_in_words(),
                finding.tolerance_in_words(),
                finding.verdict().in_words(),
            );
        }
        remarks(&mut page, &rows);
    }
    page
}

/// Reasons and notes, each said once for all the rows that share it.
fn remarks(page: &mut String, rows: &[&Finding]) {
    let mut said: Vec<(String, Vec<&str>)> = Vec::new();
    for row in rows {
        for (kind, text) in [("tolerance", &row.reason), ("note", &row.note)] {
            if text.is_empty() {
                continue;
            }
            let line = format!("{kind}: {text}");
            match said.iter_mut().find(|(known, _)| *known == line) {
                Some((_, quantities)) => quantities.push(&row.quantity),
                None => said.push((line, vec![&row.quantity])),
            }
        }
    }
    if !said.is_empty() {
        page.push('\n');
    }
    for (line, quantities) in said {
        let of = if quantities.len() == rows.len() {
            "all".to_owned()
        } else {
            quantities.join("; ")
        };
        // Writing to a string cannot fail.
        let _ = writeln!(page, "- {}: {}", escaped(&of), escaped(&line));
    }
}

/// Text that a table's cell can hold.
fn escaped(text: &str) -> String {
    text.replace('|', "\\|")
}

impl Verdict {
    /// One word.
    pub fn in_words(self) -> &'static str {
        match self {
            Self::Passed => "passed",
            Self::Failed => "FAILED",
            Self::Shown => "shown",
        }
    }
}

impl Finding {
    /// As printed, `(reference)` beside or instead, or the statement.
    pub fn published_in_words(&self) -> String {
        let mut words: Vec<String> = Vec::new();
        words.extend(self.published.map(|value| value.to_string()));
        words.extend(self.reference.map(|value| format!("({value})")));
        words.extend(self.statement.clone());
        words.join(" ")
    }

    /// With a digit more than the tolerance tells apart.
    pub fn computed_in_words(&self) -> String {
        self.computed.map_or_else(String::new, |value| {
            let resolution = self.tolerance.or(self.deviation_scale());
            number(value, resolution)
        })
    }

    /// Two digits.
    pub fn deviation_in_words(&self) -> String {
        self.deviation.map_or_else(String::new, short)
    }

    /// `1e-6`, `>= 0`, `<= 1e-12`, `1.5 … 1.6`.
    pub fn tolerance_in_words(&self) -> String {
        match (self.tolerance, self.at_least, self.at_most) {
            (Some(tolerance), ..) => short(tolerance),
            (_, Some(low), Some(high)) => format!("{low} … {high}"),
            (_, Some(low), None) => format!(">= {low}"),
            (_, None, Some(high)) => format!("<= {}", short(high)),
            _ => String::new(),
        }
    }

    /// What a bounded value is told apart by: a hundredth of the width between its bounds.
    fn deviation_scale(&self) -> Option<f64> {
        Some(0.01 * (self.at_most? - self.at_least?))
    }
}

/// A number to one digit beyond `resolution`, or to five digits.
fn number(value: f64, resolution: Option<f64>) -> String {
    let resolved = resolution.filter(|resolution| *resolution > 0.0);
    match resolved.map(|resolution| (1.0 - resolution.log10()).ceil()) {
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "between 0 and 15"
        )]
        Some(decimals) if (0.0..=15.0).contains(&decimals) => {
            format!("{value:.*}", decimals as usize)
        }
        _ => short_or_long(value),
    }
}

fn short_or_long(value: f64) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    if (1.0e-3..1.0e6).contains(&value.abs()) {
        format!("{value:.5}")
    } else {
        format!("{value:.4e}")
    }
}

/// `1.5e-7`.
fn short(value: f64) -> String {
    if value == 0.0 {
        "0".to_owned()
    } else {
        format!("{value:.1e}")
    }
}
