//! `hihna validate`: published values against computed ones.

use std::fmt::Write;

use clap::Args;
use hihna::validate::{self, Case, Finding, Verdict};
use serde::Serialize;

use crate::diagnostics::Failure;
use crate::loudness::Loudness;
use crate::progress::CountBar;
use crate::standard_output;
use crate::tables::columns;

/// Compare with published values: compute validation cases and judge them, case by case.
///
/// A case is picked by its name or by the beginning of it, such as `chapter-4-analytical`; without any,
/// all are computed.
#[derive(Debug, Args)]
pub struct Arguments {
    /// Cases or groups of cases
    #[arg(value_name = "CASE")]
    cases: Vec<String>,

    /// List the cases and compute nothing
    #[arg(long, conflicts_with = "markdown")]
    list: bool,

    /// Print one JSON object
    #[arg(long)]
    pub json: bool,

    /// Print the validation page of the documentation
    #[arg(long, conflicts_with = "json")]
    markdown: bool,
}

#[derive(Serialize)]
struct Listing<'a> {
    cases: Vec<Listed<'a>>,
}

#[derive(Serialize)]
struct Listed<'a> {
    case: &'a str,
    title: &'a str,
    source: &'a str,
    quantities: Vec<&'a str>,
}

#[derive(Serialize)]
struct Report<'a> {
    cases: &'a [Finding],
    passed: bool,
}

/// Computes, judges and tells; an error if any value is judged to differ.
pub fn validate(arguments: &Arguments, loudness: Loudness) -> Result<(), Failure> {
    let catalogue = validate::catalogue()?;
    let cases = validate::select(&catalogue, &arguments.cases)?;
    if arguments.list {
        return list(&cases, arguments.json);
    }
    let bar = CountBar::new(cases.len(), loudness.shows_progress());
    let findings = validate::run(&cases, |case| bar.done(&case.name));
    bar.finish();
    let passed = validate::passed(&findings);
    if arguments.json {
        standard_output::print_json(&Report {
            cases: &findings,
            passed,
        })?;
    } else if arguments.markdown {
        standard_output::print(&validate::markdown(&cases, &findings))?;
    } else if !loudness.quiet {
        standard_output::print(&in_words(&cases, &findings))?;
    }
    let failed = findings
        .iter()
        .filter(|finding| finding.verdict() == Verdict::Failed);
    if passed {
        Ok(())
    } else {
        Err(Failure::Validation {
            failed: failed.count(),
        })
    }
}

fn list(cases: &[&Case], json: bool) -> Result<(), Failure> {
    if json {
        let listed = cases.iter().map(|case| Listed {
            case: &case.name,
            title: &case.title,
            source: &case.source,
            quantities: case.rows.iter().map(|row| row.quantity.as_str()).collect(),
        });
        return standard_output::print_json(&Listing {
            cases: listed.collect(),
        });
    }
    let mut table = columns(&["case", "values", "about"], &[1]);
    for case in cases {
        table.add_row([
            case.name.clone(),
            case.rows.len().to_string(),
            case.title.clone(),
        ]);
    }
    standard_output::print(&format!("{}\n", table.trim_fmt()))
}

fn in_words(cases: &[&Case], findings: &[Finding]) -> String {
    let mut text = String::new();
    // Writing to a string cannot fail.
    for case in cases {
        let _ = writeln!(text, "{}: {}", case.name, case.title);
        let _ = writeln!(text, "{}\n", case.source);
        let header = [
            "quantity",
            "unit",
            "published",
            "computed",
            "deviation",
            "tolerance",
            "verdict",
            "note",
        ];
        let mut table = columns(&header, &[2, 3, 4, 5]);
        let mut notes: Vec<&str> = Vec::new();
        for finding in findings.iter().filter(|finding| finding.case == case.name) {
            table.add_row([
                finding.quantity.clone(),
                finding.unit.clone(),
                finding.published_in_words(),
                finding.computed_in_words(),
                finding.deviation_in_words(),
                finding.tolerance_in_words(),
                finding.verdict().in_words().to_owned(),
                number_of(&finding.note, &mut notes),
            ]);
        }
        let _ = writeln!(text, "{}\n", table.trim_fmt());
        for (i, note) in notes.iter().enumerate() {
            let _ = writeln!(text, "[{}] {note}", i + 1);
        }
        if !notes.is_empty() {
            text.push('\n');
        }
    }
    let count = |verdict: Verdict| {
        let of = |finding: &&Finding| finding.verdict() == verdict;
        findings.iter().filter(of).count()
    };
    let _ = writeln!(
        text,
        "{} {}: {} values passed, {} failed, {} only shown",
        cases.len(),
        if cases.len() == 1 { "case" } else { "cases" },
        count(Verdict::Passed),
        count(Verdict::Failed),
        count(Verdict::Shown),
    );
    text
}

/// `[2]` of the second different note.
fn number_of<'a>(note: &'a str, notes: &mut Vec<&'a str>) -> String {
    if note.is_empty() {
        return String::new();
    }
    let known = notes.iter().position(|known| *known == note);
    let number = known.unwrap_or_else(|| {
        notes.push(note);
        notes.len() - 1
    });
    format!("[{}]", number + 1)
}
