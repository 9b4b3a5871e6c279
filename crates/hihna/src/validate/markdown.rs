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
misprint or none is printed; of a bound, the distance to it. The numbered remarks stand below each table.
Values that are only shown are other programs', depend on the machine, or have nothing in print to judge
them by.
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
            "| quantity | unit | published | computed | deviation | tolerance | verdict | remarks |\n\
             |---|---|---|---|---|---|---|---|\n",
        );
        let rows: Vec<_> = findings
            .iter()
            .filter(|finding| finding.case == case.name)
            .collect();
        let mut remarks = Remarks::default();
        for finding in &rows {
            let _ = writeln!(
                page,
                "| {} | {} | {} | {} | {} | {} | {} | {} |",
                escaped(&finding.quantity),
                finding.unit,
                escaped(&finding.published_in_words()),
                finding.computed_in_words(),
                finding.deviation_in_words(),
                finding.tolerance_in_words(),
                finding.verdict().in_words(),
                remarks.of(finding),
            );
        }
        remarks.list(&mut page);
    }
    page
}

/// Reasons and notes, each said once and numbered.
#[derive(Default)]
struct Remarks {
    said: Vec<String>,
}

impl Remarks {
    /// The numbers of a row's remarks.
    fn of(&mut self, finding: &Finding) -> String {
        let reason = ("Tolerance: ", &finding.reason);
        let texts = [reason, ("", &finding.note)];
        let numbers = texts.iter().filter(|(_, text)| !text.is_empty());
        let numbers = numbers.map(|(kind, text)| self.number(format!("{kind}{text}.")));
        numbers.collect::<Vec<_>>().join(", ")
    }

    fn number(&mut self, remark: String) -> String {
        let known = self.said.iter().position(|said| *said == remark);
        let number = known.unwrap_or_else(|| {
            self.said.push(remark);
            self.said.len() - 1
        });
        (number + 1).to_string()
    }

    fn list(&self, page: &mut String) {
        for (i, remark) in self.said.iter().enumerate() {
            let gap = if i == 0 { "\n" } else { "" };
            // Writing to a string cannot fail.
            let _ = writeln!(page, "{gap}{}. {remark}", i + 1);
        }
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
        words.extend(self.published.map(|value| match self.decimals {
            Some(decimals) => format!("{value:.decimals$}"),
            None => value.to_string(),
        }));
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
