//! The catalogue is whole, verdicts can fail, names pick cases.

use super::*;

fn row(published: Option<f64>, tolerance: Option<f64>) -> Row {
    Row {
        quantity: "length".into(),
        unit: "m".into(),
        published,
        statement: None,
        reference: None,
        tolerance,
        at_least: None,
        at_most: None,
        reason: String::new(),
        note: String::new(),
        decimals: None,
        computed: true,
    }
}

fn judge(row: &Row, value: Option<f64>) -> Finding {
    let cases = catalogue().unwrap();
    Finding::new(&cases[0], row, value, None)
}

/// Data and computations name the same cases and quantities, every judged row says why its tolerance is
/// what it is, and no row both has and lacks a value to judge.
#[test]
fn data_and_computations_fit() {
    let cases = catalogue().unwrap();
    let names: Vec<_> = cases.iter().map(|case| case.name.as_str()).collect();
    for (name, _) in COMPUTATIONS {
        let times = names.iter().filter(|known| *known == name).count();
        assert_eq!(times, 1, "{name} in the data");
    }
    for case in &cases {
        for (i, row) in case.rows.iter().enumerate() {
            let place = format!("{} {}", case.name, row.quantity);
            let same = |other: &&Row| other.quantity == row.quantity;
            assert_eq!(
                case.rows.iter().position(|other| same(&other)),
                Some(i),
                "{place}"
            );
            let bounded = row.at_least.or(row.at_most).is_some();
            assert!(!(bounded && row.tolerance.is_some()), "{place}");
            assert!(!bounded || row.statement.is_some(), "{place}");
            assert!(!row.is_judged() || !row.reason.is_empty(), "{place}");
            assert!(
                row.published.is_some()
                    || row.reference.is_some()
                    || row.statement.is_some()
                    || row.computed,
                "{place}"
            );
            // A misprint has its reason.
            let misprint = row.published.is_some() && row.reference.is_some();
            assert!(!misprint || !row.note.is_empty(), "{place}");
        }
    }
}

#[test]
fn verdicts_follow_tolerances_and_bounds() {
    let near = row(Some(2.0), Some(0.5));
    assert_eq!(judge(&near, Some(2.5)).passed, Some(true));
    assert_eq!(judge(&near, Some(1.4)).passed, Some(false));
    assert_eq!(judge(&near, Some(f64::NAN)).passed, Some(false));
    assert_eq!(
        judge(&near, None).passed,
        Some(false),
        "no value is no agreement"
    );
    let misprint = Row {
        reference: Some(3.0),
        ..near.clone()
    };
    let finding = judge(&misprint, Some(3.25));
    assert_eq!(
        (finding.passed, finding.deviation),
        (Some(true), Some(0.25))
    );
    assert_eq!(finding.published, Some(2.0), "the printed value stays");
    assert_eq!(judge(&misprint, Some(2.0)).passed, Some(false));
    let mut bounded = row(None, None);
    bounded.at_least = Some(1.0);
    bounded.at_most = Some(2.0);
    for (value, passed, deviation) in [(1.0, true, 0.0), (2.5, false, 0.5), (0.75, false, -0.25)] {
        let finding = judge(&bounded, Some(value));
        assert_eq!(
            (finding.passed, finding.deviation),
            (Some(passed), Some(deviation))
        );
    }
    assert_eq!(judge(&bounded, Some(f64::NAN)).passed, Some(false));
    assert_eq!(
        judge(&row(Some(2.0), None), Some(7.0)).passed,
        None,
        "only shown"
    );
    let findings = [judge(&near, Some(2.0)), judge(&row(Some(2.0), None), None)];
    assert!(passed(&findings));
    assert!(!passed(&[judge(&near, Some(9.0))]));
}

#[test]
fn names_pick_cases_and_groups() {
    let cases = catalogue().unwrap();
    let pick = |names: &[&str]| {
        let names: Vec<_> = names.iter().map(|name| (*name).to_owned()).collect();
        select(&cases, &names).map(|cases| {
            cases
                .iter()
                .map(|case| case.name.clone())
                .collect::<Vec<_>>()
        })
    };
    assert_eq!(pick(&[]).unwrap().len(), cases.len());
    let group = pick(&["chapter-4-analytical"]).unwrap();
    assert_eq!(group.len(), 4);
    assert!(
        group
            .iter()
            .all(|name| name.starts_with("chapter-4-analytical/"))
    );
    let chapter = pick(&["chapter-4"]).unwrap();
    assert_eq!(chapter[..4], group);
    assert!(chapter[4..].starts_with(&pick(&["chapter-4-plate"]).unwrap()));
    let one = "chapter-4-analytical/speed-loss";
    assert_eq!(pick(&[one, one]).unwrap(), [one]);
    let unknown = pick(&["chapter-4-analytical/speed-los"]).unwrap_err();
    assert_eq!(unknown.nearest.as_deref(), Some(one));
    assert_eq!(
        pick(&["chapter-4-anal"]).unwrap_err().nearest.as_deref(),
        Some("chapter-4-analytical")
    );
    assert_eq!(pick(&["zzz"]).unwrap_err().nearest, None);
}
