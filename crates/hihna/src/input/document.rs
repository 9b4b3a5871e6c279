//! TOML text as a tree whose values remember where they were written.

use std::sync::Arc;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::input::place::{Place, Source};
use crate::input::problem::{FieldPath, InputError, InputErrors, Problem, Segment};

/// A value and where it and its name were written.
#[derive(Clone, Debug)]
pub(crate) struct Node {
    pub value: NodeValue,
    /// The value; for a table the header.
    pub place: Option<Place>,
    /// The name.
    pub name_place: Option<Place>,
}

#[derive(Clone, Debug)]
pub(crate) enum NodeValue {
    Text(String),
    Integer(i64),
    Float(f64),
    Flag(bool),
    Date,
    List(Vec<Node>),
    Table(Vec<(String, Node)>),
}

/// Parses a document; errors are those of TOML's syntax.
pub(crate) fn parse(name: &str, text: &str) -> Result<Node, InputErrors> {
    let source = Arc::new(Source {
        name: name.to_owned(),
        text: text.to_owned(),
    });
    let (table, errors) = DeTable::parse_recoverable(text);
    if errors.is_empty() {
        return Ok(Node {
            value: table_value(table.get_ref(), &source, 0),
            place: Some(Place { source, span: 0..0 }),
            name_place: None,
        });
    }
    let mut lines = Vec::new();
    let errors = errors
        .into_iter()
        .map(|error| syntax_error(&error, &source))
        .filter(|error| {
            // One line of nonsense often gives several errors; the first tells most.
            let line = error.place.as_ref().map(Place::line);
            let new = !lines.contains(&line);
            lines.push(line);
            new
        });
    Err(InputErrors::sorted(errors.collect()))
}

fn syntax_error(error: &toml::de::Error, source: &Arc<Source>) -> InputError {
    let problem = Problem::new(
        FieldPath::default(),
        format!("not valid TOML: {}", error.message()),
    )
    .help("text and units need quotes, each value its own line; see https://toml.io");
    InputError {
        problem,
        place: error.span().map(|span| Place {
            source: Arc::clone(source),
            span,
        }),
    }
}

/// The value of an override, which starts at byte `offset` of `source`; what is no TOML is text.
pub(crate) fn parse_value(text: &str, source: &Arc<Source>, offset: usize) -> Node {
    let place = Some(Place {
        source: Arc::clone(source),
        span: offset..offset + text.len(),
    });
    let value = match DeValue::parse(text) {
        Ok(value) => node_value(value.get_ref(), source, offset),
        Err(_) => NodeValue::Text(text.trim().to_owned()),
    };
    Node {
        value,
        place,
        name_place: None,
    }
}

fn node(value: &Spanned<DeValue<'_>>, source: &Arc<Source>, offset: usize) -> Node {
    let span = value.span();
    let place = Place {
        source: Arc::clone(source),
        span: span.start + offset..span.end + offset,
    };
    Node {
        value: node_value(value.get_ref(), source, offset),
        place: Some(place),
        name_place: None,
    }
}

fn node_value(value: &DeValue<'_>, source: &Arc<Source>, offset: usize) -> NodeValue {
    match value {
        DeValue::String(text) => NodeValue::Text(text.to_string()),
        DeValue::Integer(integer) => match i64::from_str_radix(integer.as_str(), integer.radix()) {
            Ok(integer) => NodeValue::Integer(integer),
            // Too long for an integer: still a number.
            Err(_) => NodeValue::Float(integer.as_str().parse().unwrap_or(f64::INFINITY)),
        },
        DeValue::Float(float) => NodeValue::Float(float.as_str().parse().unwrap_or(f64::NAN)),
        DeValue::Boolean(flag) => NodeValue::Flag(*flag),
        DeValue::Datetime(_) => NodeValue::Date,
        DeValue::Array(list) => {
            NodeValue::List(list.iter().map(|item| node(item, source, offset)).collect())
        }
        DeValue::Table(table) => table_value(table, source, offset),
    }
}

fn table_value(table: &DeTable<'_>, source: &Arc<Source>, offset: usize) -> NodeValue {
    let fields = table.iter().map(|(name, value)| {
        let span = name.span();
        let mut field = node(value, source, offset);
        field.name_place = Some(Place {
            source: Arc::clone(source),
            span: span.start + offset..span.end + offset,
        });
        (name.get_ref().to_string(), field)
    });
    NodeValue::Table(fields.collect())
}

impl Node {
    /// A tree without places.
    pub fn from_value(value: &toml::Value) -> Self {
        let value = match value {
            toml::Value::String(text) => NodeValue::Text(text.clone()),
            toml::Value::Integer(integer) => NodeValue::Integer(*integer),
            toml::Value::Float(float) => NodeValue::Float(*float),
            toml::Value::Boolean(flag) => NodeValue::Flag(*flag),
            toml::Value::Datetime(_) => NodeValue::Date,
            toml::Value::Array(list) => {
                NodeValue::List(list.iter().map(Self::from_value).collect())
            }
            toml::Value::Table(table) => NodeValue::Table(
                table
                    .iter()
                    .map(|(name, value)| (name.clone(), Self::from_value(value)))
                    .collect(),
            ),
        };
        Self {
            value,
            place: None,
            name_place: None,
        }
    }

    /// The field of that name, if this is a table that has it.
    pub fn get(&self, name: &str) -> Option<&Self> {
        match &self.value {
            NodeValue::Table(fields) => fields
                .iter()
                .find(|(known, _)| known == name)
                .map(|(_, node)| node),
            _ => None,
        }
    }

    /// The text, if this is one.
    pub fn text(&self) -> Option<&str> {
        match &self.value {
            NodeValue::Text(text) => Some(text),
            _ => None,
        }
    }

    /// Adds to a problem where it was written: at its field, or where that field is missing.
    pub fn locate(&self, problem: Problem) -> InputError {
        let mut place = self.place.clone();
        let mut node = self;
        for (i, segment) in problem.path.0.iter().enumerate() {
            let next = match (segment, &node.value) {
                (Segment::Field(name), _) => node.get(name),
                (Segment::Item { index, .. }, NodeValue::List(items)) => items.get(*index),
                (Segment::Item { .. }, _) => None,
            };
            let Some(next) = next else { break };
            node = next;
            let at_name = problem.at_name && i + 1 == problem.path.0.len();
            let preferred = if at_name {
                node.name_place.clone()
            } else {
                node.place.clone()
            };
            place = preferred.or(place);
        }
        InputError { problem, place }
    }
}

impl NodeValue {
    /// What it is, for messages.
    pub fn kind(&self) -> String {
        match self {
            Self::Text(text) => format!("the text {text:?}"),
            Self::Integer(integer) => format!("the number {integer}"),
            Self::Float(float) => format!("the number {}", readable(*float)),
            Self::Flag(flag) => flag.to_string(),
            Self::Date => "a date".to_owned(),
            Self::List(items) => format!("a list of {}", items.len()),
            Self::Table(_) => "a table".to_owned(),
        }
    }
}

/// A number without hundreds of zeros.
pub(crate) fn readable(number: f64) -> String {
    if number == 0.0 || (1.0e-5..1.0e9).contains(&number.abs()) || !number.is_finite() {
        number.to_string()
    } else {
        format!("{number:e}")
    }
}
