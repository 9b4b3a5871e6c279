//! `hihna validate` as users and scripts see it.

use std::process::{Command, Output};

use serde_json::Value;

fn validate(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_hihna"))
        // Away from the repository: the data is in the program.
        .current_dir(std::env::temp_dir())
        .env("NO_COLOR", "1")
        .arg("validate")
        .args(arguments)
        .output()
        .unwrap()
}

fn told(arguments: &[&str], status: i32) -> (String, String) {
    let output = validate(arguments);
    assert_eq!(output.status.code(), Some(status), "{output:?}");
    let text = |bytes| String::from_utf8(bytes).unwrap();
    (text(output.stdout), text(output.stderr))
}

#[test]
fn a_group_passes_with_a_table_and_a_total() {
    let (table, messages) = told(&["chapter-4-analytical"], 0);
    assert_eq!(messages, "", "no bar where nobody looks");
    for part in [
        "chapter-4-analytical/figures-4.4-4.5",
        "published",
        "computed",
        "deviation",
        "tolerance",
        "verdict",
        "0.146",
        "(0.1516)",
        "4 cases: 30 values passed, 0 failed, 0 only shown",
    ] {
        assert!(table.contains(part), "{part}:\n{table}");
    }
}

/// The keys that scripts read, in the order of the catalogue, the same each time.
#[test]
fn the_object_has_a_row_for_each_quantity() {
    let arguments = ["chapter-4-analytical", "--json"];
    let (stdout, _) = told(&arguments, 0);
    assert_eq!(stdout, told(&arguments, 0).0, "threads do not matter");
    let report: Value = serde_json::from_str(&stdout).unwrap();
    assert_eq!(report["passed"], true);
    let rows = report["cases"].as_array().unwrap();
    assert_eq!(rows.len(), 30);
    for row in rows {
        for key in [
            "case",
            "quantity",
            "published",
            "computed",
            "deviation",
            "tolerance",
            "passed",
            "source",
            "note",
        ] {
            assert!(row.get(key).is_some(), "{key}: {row}");
        }
    }
    let loss = rows
        .iter()
        .find(|row| row["quantity"] == "full model, unstretched length kept")
        .unwrap();
    assert_eq!(loss["case"], "chapter-4-analytical/speed-loss");
    assert_eq!(loss["published"], 0.146);
    assert!((loss["computed"].as_f64().unwrap() - 0.1516).abs() < 0.5e-4);
}

#[test]
fn one_case_can_be_asked_for_and_all_be_listed() {
    let (table, _) = told(&["chapter-4-analytical/speed-loss"], 0);
    assert!(table.contains("1 case: 7 values passed"), "{table}");
    let (list, _) = told(&["--list"], 0);
    assert!(
        list.contains("chapter-4-analytical/speed-loss") && !list.contains("passed"),
        "{list}"
    );
    let (list, _) = told(&["--list", "--json", "chapter-4-analytical/speed-loss"], 0);
    let list: Value = serde_json::from_str(&list).unwrap();
    assert_eq!(list["cases"][0]["quantities"].as_array().unwrap().len(), 7);
}

#[test]
fn an_unknown_case_has_status_two_and_the_nearest_name() {
    let (stdout, message) = told(&["chapter-4-analyticl"], 2);
    assert_eq!(stdout, "");
    assert!(
        message.contains("did you mean `chapter-4-analytical`?"),
        "{message}"
    );
    let (stdout, _) = told(&["chapter-4-analyticl", "--json"], 2);
    let errors: Value = serde_json::from_str(&stdout).unwrap();
    assert!(
        errors["errors"][0]["message"]
            .as_str()
            .unwrap()
            .contains("chapter-4-analyticl")
    );
}
