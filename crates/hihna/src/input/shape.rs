//! What may stand in a drive file, read from the JSON schema of [`Drive`](crate::drive::Drive).

use std::sync::LazyLock;

use serde_json::Value;

use crate::input::problem::quoted;
use crate::units::{self, Dimension};

/// What may stand at one place.
#[derive(Debug)]
pub(crate) enum Shape {
    /// A number of a dimension, or text with a unit.
    Quantity(&'static Dimension, Bounds),
    /// A whole number.
    Count(Bounds),
    /// `true` or `false`.
    Flag,
    /// Any text.
    Text,
    /// One of several words.
    Choice(Vec<String>),
    /// A list, perhaps of fixed length.
    List(Box<Shape>, Option<usize>),
    /// A table.
    Table(Vec<Field>),
    /// A table whose field `tag` says which other fields it has.
    Tagged {
        tag: String,
        variants: Vec<(String, Vec<Field>)>,
    },
    /// One of several shapes.
    Either(Vec<Shape>),
    /// Anything: the schema says something that this file does not understand.
    Anything,
}

/// A field of a table.
#[derive(Debug)]
pub(crate) struct Field {
    pub name: String,
    pub shape: Shape,
    pub required: bool,
    /// The field's documentation.
    pub about: String,
}

/// Least and greatest value; the second of each pair says whether it is excluded.
#[derive(Clone, Debug, Default)]
pub(crate) struct Bounds {
    pub least: Option<(f64, bool)>,
    pub greatest: Option<(f64, bool)>,
}

impl Shape {
    /// The shape of a drive.
    pub fn of_drive() -> &'static Self {
        static SHAPE: LazyLock<Shape> = LazyLock::new(|| Shape::read(&super::schema()));
        &SHAPE
    }

    fn read(schema: &Value) -> Self {
        if let Some(dimension) = schema[units::QUANTITY].as_str().and_then(units::dimension) {
            return Self::Quantity(dimension, Bounds::read(schema));
        }
        if let Some(word) = schema["const"].as_str() {
            return Self::Choice(vec![word.to_owned()]);
        }
        if let Some(words) = schema["enum"].as_array() {
            return Self::Choice(
                words
                    .iter()
                    .filter_map(Value::as_str)
                    .map(str::to_owned)
                    .collect(),
            );
        }
        if let Some(alternatives) = schema["oneOf"].as_array() {
            return Self::read_variants(alternatives);
        }
        if let Some(alternatives) = schema["anyOf"].as_array() {
            // TOML has no null: an optional field is there or not.
            let present = alternatives.iter().filter(|one| one["type"] != "null");
            let mut shapes: Vec<_> = present.map(Self::read).collect();
            return match shapes.pop() {
                Some(only) if shapes.is_empty() => only,
                last => Self::Either(shapes.into_iter().chain(last).collect()),
            };
        }
        // TOML has no null: a table that may be absent has it as its other type.
        let kinds = schema["type"].as_array().into_iter().flatten();
        let present = kinds.filter_map(Value::as_str).find(|kind| *kind != "null");
        match schema["type"].as_str().or(present) {
            Some("integer") => Self::Count(Bounds::read(schema)),
            Some("boolean") => Self::Flag,
            Some("string") => Self::Text,
            Some("array") => {
                let least = schema["minItems"].as_u64();
                let fixed = least.filter(|_| least == schema["maxItems"].as_u64());
                Self::List(
                    Box::new(Self::read(&schema["items"])),
                    fixed.and_then(|n| usize::try_from(n).ok()),
                )
            }
            Some("object") => Self::Table(Field::read_all(schema)),
            _ => Self::Anything,
        }
    }

    /// Words, or tables that are told apart by a field with one fixed word.
    fn read_variants(alternatives: &[Value]) -> Self {
        let words: Option<Vec<_>> = alternatives
            .iter()
            .map(|schema| schema["const"].as_str().map(str::to_owned))
            .collect();
        if let Some(words) = words {
            return Self::Choice(words);
        }
        let mut tag = String::new();
        let mut variants = Vec::new();
        for schema in alternatives {
            let Some((name, word)) = schema["properties"].as_object().and_then(|properties| {
                properties
                    .iter()
                    .find_map(|(name, property)| Some((name, property["const"].as_str()?)))
            }) else {
                return Self::Anything;
            };
            tag.clone_from(name);
            variants.push((word.to_owned(), Field::read_all(schema)));
        }
        Self::Tagged { tag, variants }
    }

    /// Names of the fields that a table of this shape can have.
    pub fn field_names(&self) -> Vec<&str> {
        self.fields().map(|field| field.name.as_str()).collect()
    }

    /// The fields that a table of this shape can have.
    pub fn fields(&self) -> Box<dyn Iterator<Item = &Field> + '_> {
        match self {
            Self::Table(fields) => Box::new(fields.iter()),
            Self::Tagged { variants, .. } => {
                Box::new(variants.iter().flat_map(|(_, fields)| fields))
            }
            Self::Either(alternatives) => Box::new(alternatives.iter().flat_map(Self::fields)),
            _ => Box::new(std::iter::empty()),
        }
    }

    /// What is expected, for messages.
    pub fn expectation(&self) -> String {
        match self {
            Self::Quantity(dimension, _) if dimension.unit.is_empty() => {
                format!(
                    "a number, or text with a unit such as {:?}",
                    dimension.example
                )
            }
            Self::Quantity(dimension, _) => format!(
                "{}: a number in {}, or text with a unit such as {:?}",
                dimension.with_article(),
                dimension.unit,
                dimension.example
            ),
            Self::Count(bounds) => match (bounds.least, bounds.greatest) {
                (Some((least, _)), Some((most, _))) => {
                    format!("a whole number from {least} to {most}")
                }
                (Some((least, _)), None) => format!("a whole number of at least {least}"),
                (None, Some((most, _))) => format!("a whole number of at most {most}"),
                (None, None) => "a whole number".to_owned(),
            },
            Self::Flag => "true or false".to_owned(),
            Self::Text => "text in quotes".to_owned(),
            Self::Choice(words) => match words.as_slice() {
                [word] => format!("{word:?}"),
                words => format!("one of {}", quoted(words.iter().map(String::as_str), '"')),
            },
            Self::List(item, Some(length)) => {
                format!("a list of {length}, each {}", item.expectation())
            }
            Self::List(item, None) if matches!(**item, Self::Table(_)) => {
                "a list of tables".to_owned()
            }
            Self::List(item, None) => format!("a list, each item {}", item.expectation()),
            Self::Table(_) => "a table".to_owned(),
            Self::Tagged { tag, variants } => {
                format!(
                    "a table with {tag} = {}",
                    quoted(variants.iter().map(|(word, _)| word.as_str()), '"')
                )
            }
            Self::Either(alternatives) => alternatives
                .iter()
                .map(Self::expectation)
                .collect::<Vec<_>>()
                .join("; or "),
            Self::Anything => "a value".to_owned(),
        }
    }
}

impl Field {
    fn read_all(schema: &Value) -> Vec<Self> {
        let required: Vec<_> = schema["required"]
            .as_array()
            .into_iter()
            .flatten()
            .filter_map(Value::as_str)
            .collect();
        let properties = schema["properties"].as_object().into_iter().flatten();
        properties
            .map(|(name, property)| Self {
                name: name.clone(),
                shape: Shape::read(property),
                required: required.contains(&name.as_str()),
                about: property["description"]
                    .as_str()
                    .unwrap_or_default()
                    .to_owned(),
            })
            .collect()
    }
}

impl Bounds {
    fn read(schema: &Value) -> Self {
        let bound = |included: &str, excluded: &str| {
            let included = schema[included].as_f64().map(|value| (value, false));
            included.or(schema[excluded].as_f64().map(|value| (value, true)))
        };
        Self {
            least: bound("minimum", "exclusiveMinimum"),
            greatest: bound("maximum", "exclusiveMaximum"),
        }
    }

    /// What a value that breaks the bounds must be: `must be positive`.
    pub fn broken_by(&self, value: f64, unit: &str) -> Option<String> {
        let amount = |value: f64| {
            if unit.is_empty() {
                value.to_string()
            } else {
                format!("{value} {unit}")
            }
        };
        match (self.least, self.greatest) {
            (Some((0.0, true)), _) if value <= 0.0 => Some("must be positive".to_owned()),
            (Some((0.0, false)), _) if value < 0.0 => Some("must not be negative".to_owned()),
            (Some((least, true)), _) if value <= least => {
                Some(format!("must be greater than {}", amount(least)))
            }
            (Some((least, false)), _) if value < least => {
                Some(format!("must be at least {}", amount(least)))
            }
            (_, Some((greatest, true))) if value >= greatest => {
                Some(format!("must be less than {}", amount(greatest)))
            }
            (_, Some((greatest, false))) if value > greatest => {
                Some(format!("must be at most {}", amount(greatest)))
            }
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn no_gaps(shape: &Shape, path: &str) {
        match shape {
            Shape::Anything => panic!("{path} has a schema that Shape does not understand"),
            Shape::List(item, _) => no_gaps(item, path),
            Shape::Either(alternatives) => {
                for shape in alternatives {
                    no_gaps(shape, path);
                }
            }
            _ => shape
                .fields()
                .for_each(|field| no_gaps(&field.shape, &format!("{path}.{}", field.name))),
        }
    }

    /// Whoever adds a field of a new kind to `Drive` learns here that it would go unchecked.
    #[test]
    fn every_field_of_a_drive_has_a_shape() {
        no_gaps(Shape::of_drive(), "drive");
    }

    /// A plain number has no dimension: it must say so by `units::ratio`.
    #[test]
    fn every_field_is_documented() {
        fn documented(shape: &Shape, path: &str) {
            for field in shape.fields() {
                let tag = matches!(&field.shape, Shape::Choice(words) if words.len() == 1);
                assert!(
                    tag || !field.about.is_empty(),
                    "{path}.{} has no documentation",
                    field.name
                );
                documented(&field.shape, &format!("{path}.{}", field.name));
            }
            if let Shape::List(item, _) = shape {
                documented(item, path);
            }
        }
        documented(Shape::of_drive(), "drive");
    }
}
