//! Checks a tree against the shape of a drive and turns quantities into SI.

use toml::Value;

use crate::input::document::{Node, NodeValue, readable};
use crate::input::problem::{FieldPath, InputError, Problem, nearest, quoted};
use crate::input::shape::{Bounds, Field, Shape};
use crate::units::{Dimension, QuantityError};

/// Collects what is wrong on the way down a tree.
#[derive(Default)]
pub(crate) struct Checker {
    /// Problems that leave no drive to look at.
    pub structural: Vec<InputError>,
    /// Values outside their range.
    pub ranges: Vec<Problem>,
    /// Whether contact is stated per area of belt, not per length.
    pub per_area: bool,
}

impl Checker {
    /// The value in SI, or `None` where the structure is broken; problems are collected.
    pub fn check(&mut self, shape: &Shape, node: &Node, path: &FieldPath) -> Option<Value> {
        match (shape, &node.value) {
            (Shape::Quantity(dimension, bounds), value) => {
                if let Some(per_area) = dimension.per_area().filter(|_| self.per_area) {
                    return self.check(&Shape::Quantity(per_area, bounds.clone()), node, path);
                }
                let number = self.quantity(shape, dimension, node, value, path)?;
                self.range(shape, bounds, number, dimension.unit, path);
                Some(Value::Float(number))
            }
            (Shape::Count(bounds), NodeValue::Integer(integer)) => {
                self.range(shape, bounds, *integer as f64, "", path);
                // A negative count cannot become a drive; its range is reported already.
                (*integer >= 0).then_some(Value::Integer(*integer))
            }
            (Shape::Flag, NodeValue::Flag(flag)) => Some(Value::Boolean(*flag)),
            (Shape::Text, NodeValue::Text(text)) => Some(Value::String(text.clone())),
            (Shape::Choice(words), NodeValue::Text(text)) => {
                if words.contains(text) {
                    return Some(Value::String(text.clone()));
                }
                self.unknown_word(text, words, shape, node, path)
            }
            (Shape::List(item, length), NodeValue::List(nodes)) => {
                self.list(shape, item, *length, nodes, node, path)
            }
            (Shape::Table(fields), NodeValue::Table(entries)) => {
                self.table(fields, entries, node, path)
            }
            (Shape::Tagged { tag, variants }, NodeValue::Table(entries)) => {
                self.tagged(tag, variants, entries, node, path)
            }
            (Shape::Either(alternatives), value) => {
                match alternatives.iter().find(|shape| fits(shape, value)) {
                    Some(shape) => self.check(shape, node, path),
                    None => self.wrong_kind(shape, node, path),
                }
            }
            (Shape::Anything, _) => Some(as_written(node)),
            _ => self.wrong_kind(shape, node, path),
        }
    }

    fn quantity(
        &mut self,
        shape: &Shape,
        dimension: &Dimension,
        node: &Node,
        value: &NodeValue,
        path: &FieldPath,
    ) -> Option<f64> {
        let text = match value {
            NodeValue::Integer(integer) => return Some(*integer as f64),
            NodeValue::Float(float) if float.is_finite() => return Some(*float),
            NodeValue::Float(float) => {
                let message = format!("`{path}` must be a finite number, but is {float}");
                return self.fail(
                    node,
                    Problem::new(path.clone(), message).expected(shape.expectation()),
                );
            }
            NodeValue::Text(text) => text,
            _ => return self.wrong_kind(shape, node, path),
        };
        let units = format!(
            "units of {}: {}",
            dimension.name,
            dimension.usual.join(", ")
        );
        let (message, help) = match dimension.parse(text) {
            Ok(number) if number.is_finite() => return Some(number),
            Ok(_) => (format!("`{path}` is too large a number: {text:?}"), units),
            Err(QuantityError::NoNumber) => (
                format!("`{path}` should start with a number, but is {text:?}"),
                units,
            ),
            Err(QuantityError::NoUnit) => {
                let si = if dimension.unit.is_empty() {
                    "a plain number"
                } else {
                    dimension.unit
                };
                let help = format!(
                    "write {} without quotes for {si}, or add a unit: {}",
                    text.trim(),
                    dimension.usual.join(", ")
                );
                (format!("`{path}` is text without a unit: {text:?}"), help)
            }
            Err(QuantityError::WrongUnit(unit, Some(other))) => (
                format!(
                    "`{path}` is {}, but `{unit}` is a unit of {other}",
                    dimension.with_article()
                ),
                units,
            ),
            Err(QuantityError::WrongUnit(unit, None)) => {
                let mut help = units;
                if let Some(near) = nearest(&unit, dimension.usual.iter().copied()) {
                    help = format!("did you mean `{near}`? {help}");
                }
                (format!("`{path}` has the unknown unit `{unit}`"), help)
            }
        };
        self.fail(
            node,
            Problem::new(path.clone(), message)
                .expected(shape.expectation())
                .help(help),
        )
    }

    fn range(&mut self, shape: &Shape, bounds: &Bounds, value: f64, unit: &str, path: &FieldPath) {
        if let Some(demand) = bounds.broken_by(value, unit) {
            let amount = format!("{} {unit}", readable(value));
            let amount = amount.trim_end();
            self.ranges.push(
                Problem::new(path.clone(), format!("`{path}` {demand}, but is {amount}"))
                    .expected(shape.expectation()),
            );
        }
    }

    fn list(
        &mut self,
        shape: &Shape,
        item: &Shape,
        length: Option<usize>,
        nodes: &[Node],
        node: &Node,
        path: &FieldPath,
    ) -> Option<Value> {
        if length.is_some_and(|length| length != nodes.len()) {
            return self.wrong_kind(shape, node, path);
        }
        let names: Vec<_> = nodes
            .iter()
            .map(|node| node.get("name").and_then(Node::text))
            .collect();
        let values: Vec<_> = nodes
            .iter()
            .enumerate()
            .map(|(i, node)| self.check(item, node, &path.item(i, own_name(&names, i))))
            .collect();
        values
            .into_iter()
            .collect::<Option<Vec<_>>>()
            .map(Value::Array)
    }

    fn table(
        &mut self,
        fields: &[Field],
        entries: &[(String, Node)],
        node: &Node,
        path: &FieldPath,
    ) -> Option<Value> {
        let mut table = toml::Table::new();
        let mut complete = true;
        let mut misspelt = Vec::new();
        for (name, entry) in entries {
            let place = path.field(name);
            let Some(field) = fields.iter().find(|field| field.name == *name) else {
                complete = false;
                let known = || fields.iter().map(|field| field.name.as_str());
                misspelt.extend(nearest(name, known()));
                self.fail::<()>(entry, unknown_field(name, known(), place));
                continue;
            };
            match self.check(&field.shape, entry, &place) {
                Some(value) => {
                    table.insert(name.clone(), value);
                }
                None => complete = false,
            }
        }
        for field in fields.iter().filter(|field| field.required) {
            let name = field.name.as_str();
            if entries.iter().all(|(entry, _)| entry != name) {
                complete = false;
                // What was misspelt is not missing, too.
                if !misspelt.contains(&name) {
                    self.fail::<()>(node, missing_field(field, path));
                }
            }
        }
        complete.then_some(Value::Table(table))
    }

    fn tagged(
        &mut self,
        tag: &str,
        variants: &[(String, Vec<Field>)],
        entries: &[(String, Node)],
        node: &Node,
        path: &FieldPath,
    ) -> Option<Value> {
        let words: Vec<_> = variants.iter().map(|(word, _)| word.clone()).collect();
        let choice = Shape::Choice(words.clone());
        let Some((_, chosen)) = entries.iter().find(|(name, _)| name == tag) else {
            let problem = Problem::new(path.clone(), format!("`{path}` does not say its `{tag}`"))
                .expected(format!("`{tag}`: {}", choice.expectation()));
            return self.fail(node, problem);
        };
        let tag_path = path.field(tag);
        let Some(text) = chosen.text() else {
            return self.wrong_kind(&choice, chosen, &tag_path);
        };
        match variants.iter().find(|(word, _)| word == text) {
            Some((_, fields)) => self.table(fields, entries, node, path),
            None => self.unknown_word(text, &words, &choice, chosen, &tag_path),
        }
    }

    fn unknown_word(
        &mut self,
        text: &str,
        words: &[String],
        shape: &Shape,
        node: &Node,
        path: &FieldPath,
    ) -> Option<Value> {
        let mut problem = Problem::new(path.clone(), format!("`{path}` cannot be {text:?}"))
            .expected(shape.expectation());
        if let Some(near) = nearest(text, words.iter().map(String::as_str)) {
            problem = problem.help(format!("did you mean {near:?}?"));
        }
        self.fail(node, problem)
    }

    fn wrong_kind<T>(&mut self, shape: &Shape, node: &Node, path: &FieldPath) -> Option<T> {
        let mut problem = Problem::new(
            path.clone(),
            format!("`{path}` cannot be {}", node.value.kind()),
        )
        .expected(shape.expectation());
        if matches!((shape, &node.value), (Shape::List(..), NodeValue::Table(_))) {
            problem = problem.help(format!(
                "write `[[{path}]]` with double brackets, once for each"
            ));
        }
        if matches!((shape, &node.value), (Shape::Count(_), NodeValue::Text(_))) {
            problem = problem.help("write the number without quotes");
        }
        self.fail(node, problem)
    }

    /// Notes a problem of a node.
    fn fail<T>(&mut self, node: &Node, problem: Problem) -> Option<T> {
        let place = if problem.at_name {
            node.name_place.clone()
        } else {
            node.place.clone()
        };
        self.structural.push(InputError {
            problem,
            place: place.or_else(|| node.name_place.clone()),
        });
        None
    }
}

/// Whether a value is of a kind that a shape may have.
fn fits(shape: &Shape, value: &NodeValue) -> bool {
    match (shape, value) {
        // Words win over quantities: a text that starts like a number is no word.
        (Shape::Quantity(..), NodeValue::Text(text)) => {
            !text.trim_start().starts_with(char::is_alphabetic)
        }
        (Shape::Choice(words), NodeValue::Text(text)) => words.contains(text),
        (Shape::Either(alternatives), value) => alternatives.iter().any(|shape| fits(shape, value)),
        _ => matches!(
            (shape, value),
            (
                Shape::Quantity(..),
                NodeValue::Integer(_) | NodeValue::Float(_)
            ) | (Shape::Text, NodeValue::Text(_))
                | (Shape::Count(_), NodeValue::Integer(_))
                | (Shape::Flag, NodeValue::Flag(_))
                | (Shape::List(..), NodeValue::List(_))
                | (Shape::Table(_) | Shape::Tagged { .. }, NodeValue::Table(_))
                | (Shape::Anything, _)
        ),
    }
}

/// The name of an item, if it can stand in a path and no other item has it.
pub(crate) fn own_name<'a>(names: &[Option<&'a str>], index: usize) -> Option<&'a str> {
    let name = names.get(index).copied().flatten()?;
    let unique = names.iter().filter(|other| **other == Some(name)).count() == 1;
    (unique && !name.is_empty() && !name.contains(['.', ' ', '\t', '\n'])).then_some(name)
}

/// A name that is none of the `known`.
pub(crate) fn unknown_field<'a>(
    name: &str,
    known: impl Iterator<Item = &'a str>,
    path: FieldPath,
) -> Problem {
    let mut seen = Vec::new();
    for name in known {
        if !seen.contains(&name) {
            seen.push(name);
        }
    }
    let known = seen;
    let message = format!("there is no field `{path}`");
    let problem = Problem::new(path, message)
        .expected(if known.is_empty() {
            "no field".to_owned()
        } else {
            format!("one of {}", quoted(known.iter().copied(), '`'))
        })
        .at_name();
    match nearest(name, known.iter().copied()) {
        Some(near) => problem.help(format!("did you mean `{near}`?")),
        None => problem,
    }
}

fn missing_field(field: &Field, path: &FieldPath) -> Problem {
    let place = path.field(&field.name);
    let message = match &field.shape {
        Shape::Table(_) => format!("the table `[{place}]` is missing"),
        Shape::List(item, _) if matches!(**item, Shape::Table(_)) => {
            format!("there is no table `[[{place}]]`")
        }
        _ => format!("the field `{place}` is missing"),
    };
    Problem::new(place, message)
        .expected(format!("`{}`: {}", field.name, field.shape.expectation()))
        .help(field.about.clone())
}

fn as_written(node: &Node) -> Value {
    match &node.value {
        NodeValue::Text(text) => Value::String(text.clone()),
        NodeValue::Integer(integer) => Value::Integer(*integer),
        NodeValue::Float(float) => Value::Float(*float),
        NodeValue::Flag(flag) => Value::Boolean(*flag),
        NodeValue::Date => Value::String("date".to_owned()),
        NodeValue::List(items) => Value::Array(items.iter().map(as_written).collect()),
        NodeValue::Table(fields) => Value::Table(
            fields
                .iter()
                .map(|(name, node)| (name.clone(), as_written(node)))
                .collect(),
        ),
    }
}
