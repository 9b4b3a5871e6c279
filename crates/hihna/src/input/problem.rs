//! What can be wrong with a drive: where, what was expected, and what to do.

use std::error::Error;
use std::fmt;

use crate::input::place::Place;

/// Where a value stands in a drive: `belt.length`, `pulley.driven.radius`.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct FieldPath(pub Vec<Segment>);

/// One step into a drive.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Segment {
    /// A field of a table.
    Field(String),
    /// An item of a list, from 0, with its name if it has one of its own.
    Item {
        /// Position in the list, from 0.
        index: usize,
        /// Name of the item, if it has one that no other item has.
        name: Option<String>,
    },
}

impl FieldPath {
    /// The path one field further.
    pub fn field(&self, name: &str) -> Self {
        self.with(Segment::Field(name.to_owned()))
    }

    /// The path one item further.
    pub fn item(&self, index: usize, name: Option<&str>) -> Self {
        self.with(Segment::Item {
            index,
            name: name.map(str::to_owned),
        })
    }

    /// What a value out of range may break rules of by the way: its table, of a pulley only the field.
    pub fn scope(&self) -> &[Segment] {
        let of_a_list = matches!(self.0.get(1), Some(Segment::Item { .. }));
        let depth = if of_a_list { 3 } else { 1 };
        &self.0[..self.0.len().min(depth)]
    }

    fn with(&self, segment: Segment) -> Self {
        let mut path = self.clone();
        path.0.push(segment);
        path
    }
}

impl fmt::Display for FieldPath {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, segment) in self.0.iter().enumerate() {
            if i > 0 {
                formatter.write_str(".")?;
            }
            match segment {
                Segment::Field(name)
                | Segment::Item {
                    name: Some(name), ..
                } => formatter.write_str(name)?,
                Segment::Item { index, name: None } => write!(formatter, "{index}")?,
            }
        }
        Ok(())
    }
}

/// One thing that is wrong with a drive.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Problem {
    /// The field; empty if no single field is to blame.
    pub path: FieldPath,
    /// What is wrong.
    pub message: String,
    /// What could stand there instead.
    pub expected: Option<String>,
    /// What to do.
    pub help: Option<String>,
    /// Whether the field's name is to blame rather than its value.
    pub at_name: bool,
}

impl Problem {
    /// A problem with neither expectation nor help.
    pub fn new(path: FieldPath, message: impl Into<String>) -> Self {
        Self {
            path,
            message: message.into(),
            expected: None,
            help: None,
            at_name: false,
        }
    }

    /// Adds what could stand there instead.
    pub fn expected(mut self, expected: impl Into<String>) -> Self {
        self.expected = Some(expected.into());
        self
    }

    /// Adds what to do, after what was said before.
    pub fn help(mut self, help: impl Into<String>) -> Self {
        let help = help.into();
        self.help = match self.help.take() {
            Some(before) => Some(format!("{before}; {help}")),
            None => Some(help),
        };
        self
    }

    pub(crate) fn at_name(mut self) -> Self {
        self.at_name = true;
        self
    }
}

impl fmt::Display for Problem {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(&self.message)?;
        if let Some(expected) = &self.expected {
            write!(formatter, "\n  expected: {expected}")?;
        }
        if let Some(help) = &self.help {
            write!(formatter, "\n  help: {help}")?;
        }
        Ok(())
    }
}

/// A problem and the text that caused it.
#[derive(Clone, Debug)]
pub struct InputError {
    /// What is wrong.
    pub problem: Problem,
    /// Where it was written; `None` if there is no text to show.
    pub place: Option<Place>,
}

impl fmt::Display for InputError {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(place) = &self.place {
            write!(formatter, "{place}: ")?;
        }
        self.problem.fmt(formatter)
    }
}

impl Error for InputError {}

/// All that is wrong with an input, in the order of the text; never empty.
#[derive(Clone, Debug)]
pub struct InputErrors {
    errors: Vec<InputError>,
}

impl InputErrors {
    pub(crate) fn sorted(mut errors: Vec<InputError>) -> Self {
        // Overrides come after the file because their source was read later.
        errors.sort_by_key(|error| {
            error
                .place
                .as_ref()
                .map(|place| (place.is_override(), place.span.start))
        });
        Self { errors }
    }

    /// The errors.
    pub fn iter(&self) -> std::slice::Iter<'_, InputError> {
        self.errors.iter()
    }
}

impl<'a> IntoIterator for &'a InputErrors {
    type Item = &'a InputError;
    type IntoIter = std::slice::Iter<'a, InputError>;

    fn into_iter(self) -> Self::IntoIter {
        self.iter()
    }
}

impl IntoIterator for InputErrors {
    type Item = InputError;
    type IntoIter = std::vec::IntoIter<InputError>;

    fn into_iter(self) -> Self::IntoIter {
        self.errors.into_iter()
    }
}

impl From<InputError> for InputErrors {
    fn from(error: InputError) -> Self {
        Self {
            errors: vec![error],
        }
    }
}

impl fmt::Display for InputErrors {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, error) in self.errors.iter().enumerate() {
            if i > 0 {
                formatter.write_str("\n")?;
            }
            error.fmt(formatter)?;
        }
        Ok(())
    }
}

impl Error for InputErrors {}

/// The known name nearest to `name`, if one is near enough to be a slip of the keyboard or the memory.
pub(crate) fn nearest<'a>(name: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    known
        .into_iter()
        .map(|candidate| {
            (
                strsim::jaro_winkler(&name.to_lowercase(), &candidate.to_lowercase()),
                candidate,
            )
        })
        .filter(|(similarity, _)| *similarity >= 0.75)
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, candidate)| candidate)
}

/// `"a", "b"` of a, b.
pub(crate) fn quoted<'a>(names: impl IntoIterator<Item = &'a str>, quote: char) -> String {
    names
        .into_iter()
        .map(|name| format!("{quote}{name}{quote}"))
        .collect::<Vec<_>>()
        .join(", ")
}
