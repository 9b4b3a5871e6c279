//! Drive files: TOML text, with units and overrides, becomes a checked [`Drive`].
//!
//! The fields, their dimensions and ranges are stated once, as attributes of [`Drive`]. From them comes
//! the JSON schema, and from the schema the shape against which text is checked, so that a new field of
//! `Drive` needs no line here. What involves several fields is in `rules`.

use std::fs;
use std::path::Path;
use std::str::FromStr;

use schemars::generate::SchemaSettings;
use serde_path_to_error::Segment as Step;

use crate::drive::Drive;

mod check;
mod document;
mod number_field;
mod overrides;
mod place;
mod problem;
mod rules;
mod shape;
mod spatial;

pub use number_field::{NumberField, NumberRefused, UnknownNumber, broken_rule};
pub use overrides::Override;
pub use place::{Place, Source};
pub(crate) use problem::nearest;
pub use problem::{FieldPath, InputError, InputErrors, Problem, Segment};

use check::Checker;
use document::Node;
use shape::Shape;

/// The element whose contact is stated per area of belt.
const PER_AREA: [&str; 3] = ["plate", "belt-beam-3d", "linear-beam-3d"];

/// A checked drive and the text that it came from, so that what is found to be wrong with it later
/// is told with the line of the file, too.
#[derive(Clone, Debug)]
pub struct DriveFile {
    /// The drive.
    pub drive: Drive,
    document: Node,
}

/// Reads a drive from text; `source_name` is what errors call it, usually the file's path.
///
/// All problems of one stage are reported together: first those of TOML's syntax, then unknown, missing
/// and ill-typed fields, overrides and ranges, then those that involve several fields.
///
/// ```
/// let text = include_str!("../../../examples/two_pulley.toml");
/// let drive = hihna::input::parse("two_pulley.toml", text, &["belt.length=1275 mm".parse()?])?;
/// assert_eq!(drive.belt.length, Some(1.275));
/// # Ok::<(), hihna::input::InputErrors>(())
/// ```
pub fn parse(source_name: &str, text: &str, overrides: &[Override]) -> Result<Drive, InputErrors> {
    DriveFile::parse(source_name, text, overrides).map(|file| file.drive)
}

impl DriveFile {
    /// As [`parse`].
    pub fn parse(
        source_name: &str,
        text: &str,
        overrides: &[Override],
    ) -> Result<Self, InputErrors> {
        let mut document = document::parse(source_name, text)?;
        let shape = Shape::of_drive();
        let mut checker = Checker::default();
        for change in overrides {
            if let Err(error) = change.apply(shape, &mut document) {
                checker.structural.push(*error);
            }
        }
        let element = document.get("belt").and_then(|belt| belt.get("element"));
        checker.per_area =
            (element.and_then(Node::text)).is_some_and(|name| PER_AREA.contains(&name));
        let value = checker.check(shape, &document, &FieldPath::default());
        let mut problems = checker.ranges;
        let drive = match value {
            Some(value) if checker.structural.is_empty() => match deserialize(value) {
                Ok(drive) => {
                    add_broken_rules(&drive, &mut problems);
                    Some(drive)
                }
                Err(problem) => {
                    problems.push(problem);
                    None
                }
            },
            _ => None,
        };
        let mut errors = checker.structural;
        errors.extend(problems.into_iter().map(|problem| document.locate(problem)));
        match drive {
            Some(drive) if errors.is_empty() => Ok(Self { drive, document }),
            _ => Err(InputErrors::sorted(errors)),
        }
    }

    /// As [`load`].
    pub fn load(path: &Path, overrides: &[Override]) -> Result<Self, InputErrors> {
        let name = path.display().to_string();
        let text = fs::read_to_string(path).map_err(|error| {
            let problem = Problem::new(
                FieldPath::default(),
                format!("cannot read `{name}`: {error}"),
            )
            .help("give the path of a drive file, or none to use the built-in two-pulley drive");
            InputErrors::from(InputError {
                problem,
                place: None,
            })
        })?;
        Self::parse(&name, &text, overrides)
    }

    /// Adds to a problem of the drive where it was written.
    pub fn locate(&self, problem: Problem) -> InputError {
        self.document.locate(problem)
    }
}

/// Reads a drive file.
pub fn load(path: &Path, overrides: &[Override]) -> Result<Drive, InputErrors> {
    DriveFile::load(path, overrides).map(|file| file.drive)
}

/// The JSON schema of drive files, for editors and programs.
///
/// Numbers state their dimension as `x-quantity` and their SI unit as `x-unit`; in place of a number
/// there may be text with a unit.
pub fn schema() -> serde_json::Value {
    let settings =
        SchemaSettings::draft2020_12().with(|settings| settings.inline_subschemas = true);
    settings
        .into_generator()
        .into_root_schema_for::<Drive>()
        .to_value()
}

/// A drive as text with every default written out. Reading it again gives the same drive, bit for bit.
pub fn to_toml(drive: &Drive) -> String {
    // A drive has string keys only and counts within TOML's range, so this cannot fail.
    toml::to_string(drive).unwrap_or_else(|error| format!("# not a drive: {error}\n"))
}

impl FromStr for Drive {
    type Err = InputErrors;

    /// Reads a drive from TOML text.
    fn from_str(text: &str) -> Result<Self, Self::Err> {
        parse("<text>", text, &[])
    }
}

impl Drive {
    /// Everything that is wrong with a drive made in a program; empty if it can be run.
    ///
    /// Drives that come from [`parse`] or [`load`] have passed this.
    pub fn validate(&self) -> Vec<Problem> {
        let value = match toml::Value::try_from(self) {
            Ok(value) => value,
            Err(error) => return vec![Problem::new(FieldPath::default(), error.to_string())],
        };
        let mut checker = Checker::default();
        let _ = checker.check(
            Shape::of_drive(),
            &Node::from_value(&value),
            &FieldPath::default(),
        );
        let mut problems: Vec<_> = checker
            .structural
            .into_iter()
            .map(|error| error.problem)
            .collect();
        problems.extend(checker.ranges);
        add_broken_rules(self, &mut problems);
        problems
    }
}

/// Adds the rules that `drive` breaks to the `problems` that it has, but for those that a field out of its range breaks by the way.
fn add_broken_rules(drive: &Drive, problems: &mut Vec<Problem>) {
    let mut broken = rules::problems(drive);
    broken.retain(|rule| problems.iter().all(|p| p.path.scope() != rule.path.scope()));
    problems.extend(broken);
    if problems.is_empty() {
        problems.extend(rules::mounting(drive));
    }
}

/// Turns a value of the right shape into a drive. An error is a gap in the shape, but still told well.
fn deserialize(value: toml::Value) -> Result<Drive, Problem> {
    serde_path_to_error::deserialize(value).map_err(|error| {
        let segments = error.path().iter().filter_map(|step| match step {
            Step::Seq { index } => Some(Segment::Item {
                index: *index,
                name: None,
            }),
            Step::Map { key } => Some(Segment::Field(key.clone())),
            Step::Enum { .. } | Step::Unknown => None,
        });
        Problem::new(FieldPath(segments.collect()), error.inner().to_string())
    })
}
