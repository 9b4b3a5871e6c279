//! Every validation case against its published values, and the committed dossier against the catalogue.

use hihna::validate::{catalogue, run, select};

/// Tolerances and their reasons stand in the data files below `validation/`.
#[test]
fn every_case_agrees_with_what_is_published() {
    let cases = catalogue().unwrap();
    let all = select(&cases, &[]).unwrap();
    let findings = run(&all, |_| {});
    assert_eq!(
        findings.len(),
        cases.iter().map(|case| case.rows.len()).sum::<usize>()
    );
    let failed: Vec<_> = findings
        .iter()
        .filter(|finding| finding.passed == Some(false))
        .collect();
    assert!(failed.is_empty(), "{failed:#?}");
    // A row that should have been computed but was not would pass where it is only shown.
    for (finding, row) in findings.iter().zip(all.iter().flat_map(|case| &case.rows)) {
        assert_eq!(finding.computed.is_some(), row.computed, "{finding:?}");
    }
}

/// The page `docs/src/validation.md` has the cases and quantities of the catalogue, in its order, and no
/// failure. Its numbers are not compared: `cargo run --release -- validate --markdown` writes them.
#[test]
fn the_dossier_has_the_same_cases() {
    let page = include_str!("../../../docs/src/validation.md");
    let mut written = Vec::new();
    for line in page.lines() {
        if let Some(name) = line.strip_prefix("## `") {
            written.push(name.trim_end_matches('`').to_owned());
        } else if let Some(cells) = line.strip_prefix("| ")
            && !cells.starts_with("quantity")
        {
            let cell = cells.split(" | ").next().unwrap_or_default();
            written.push(cell.replace("\\|", "|"));
            assert!(!line.contains("FAILED"), "{line}");
        }
    }
    let mut expected = Vec::new();
    for case in catalogue().unwrap() {
        expected.push(case.name.clone());
        expected.extend(case.rows.into_iter().map(|row| row.quantity));
    }
    assert_eq!(written, expected);
}
