//! `--set KEY=VALUE`: a field of the drive file, replaced from outside.

use std::str::FromStr;
use std::sync::Arc;

use crate::input::check::{own_name, unknown_field};
use crate::input::document::{Node, NodeValue, parse_value};
use crate::input::place::{OVERRIDE, Place, Source};
use crate::input::problem::{FieldPath, InputError, InputErrors, Problem, nearest, quoted};
use crate::input::shape::Shape;

/// Fields of one table of which one replaces the others, so that `--set belt.tension=50` works on a
/// drive whose file gives the length.
const ALTERNATIVES: [&[&str]; 2] = [&["length", "tension", "strain"], &["speed", "angle"]];

/// A field's path and its new value, from text such as `pulley.driven.inertia=0.2`.
///
/// Pulleys are called by name or by their number from 0. The value is TOML; what is no TOML is text, so
/// that `belt.length=1.3 m` needs no quotes.
#[derive(Clone, Debug)]
pub struct Override {
    source: Arc<Source>,
    /// Bytes of the source before `=`.
    key_length: usize,
}

impl FromStr for Override {
    type Err = InputErrors;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let source = Arc::new(Source {
            name: OVERRIDE.to_owned(),
            text: text.to_owned(),
        });
        if let Some(key_length) = text.find('=') {
            return Ok(Self { source, key_length });
        }
        let problem = Problem::new(FieldPath::default(), format!("`{text}` has no `=`"))
            .expected("KEY=VALUE, such as belt.elements=30");
        let place = Some(Place {
            span: 0..text.len(),
            source,
        });
        Err(InputError { problem, place }.into())
    }
}

impl Override {
    /// Puts the value in its place.
    pub(crate) fn apply(&self, shape: &Shape, document: &mut Node) -> Result<(), Box<InputError>> {
        let (key, value) = self.source.text.split_at(self.key_length);
        let value = value.strip_prefix('=').unwrap_or(value).trim_start();
        let start = self.source.text.len() - value.len();
        let mut value = parse_value(value.trim_end(), &self.source, start);
        value.name_place = Some(self.key_place());
        let names: Vec<_> = key.trim().split('.').map(str::trim).collect();
        self.descend(&names, value, shape, document, &FieldPath::default())
            .map_err(|problem| {
                Box::new(InputError {
                    problem: *problem,
                    place: Some(self.key_place()),
                })
            })
    }

    fn key_place(&self) -> Place {
        Place {
            source: Arc::clone(&self.source),
            span: 0..self.key_length,
        }
    }

    /// Follows the names, of which the first is looked up in `node`.
    fn descend(
        &self,
        names: &[&str],
        value: Node,
        shape: &Shape,
        node: &mut Node,
        path: &FieldPath,
    ) -> Result<(), Box<Problem>> {
        let Some((&name, rest)) = names.split_first() else {
            *node = value;
            return Ok(());
        };
        if let Shape::List(item, _) = shape {
            let (index, path) = find_item(name, node, path)?;
            // `find_item` found the index in this list.
            return match &mut node.value {
                NodeValue::List(items) => match items.get_mut(index) {
                    Some(node) => self.descend(rest, value, item, node, &path),
                    None => Ok(()),
                },
                _ => Ok(()),
            };
        }
        let known = shape.field_names();
        let place = path.field(name);
        if !known.contains(&name) {
            return Err(Box::new(unknown_field(name, known.into_iter(), place)));
        }
        // Fields of one name in several variants have the same shape as far as paths go.
        let Some(field) = shape.fields().find(|field| field.name == name) else {
            return Ok(());
        };
        let NodeValue::Table(entries) = &mut node.value else {
            let problem = Problem::new(
                path.clone(),
                format!("`{path}` is {}, so it has no `{name}`", node.value.kind()),
            )
            .help(format!("set it as a whole: {OVERRIDE} '{path}={{ ... }}'"));
            return Err(Box::new(problem));
        };
        if rest.is_empty() {
            drop_alternatives(name, &known, entries);
        }
        let new = !entries.iter().any(|(entry, _)| entry == name);
        if let (true, Shape::List(..), [item, ..]) = (new, &field.shape, rest) {
            let message = format!("the drive file has no `{place}`, so it has no item `{item}`");
            let help = format!("set it as a whole: {OVERRIDE} '{place}=[...]'");
            let problem = Problem::new(place, message).expected(field.shape.expectation());
            return Err(Box::new(problem.help(help)));
        }
        if new {
            let key = Some(self.key_place());
            let empty = Node {
                value: NodeValue::Table(Vec::new()),
                place: key.clone(),
                name_place: key,
            };
            entries.push((name.to_owned(), empty));
        }
        let done = match entries.iter_mut().find(|(entry, _)| entry == name) {
            Some((_, node)) => self.descend(rest, value, &field.shape, node, &place),
            None => Ok(()),
        };
        if done.is_err() && new {
            entries.pop();
        }
        done
    }
}

/// Removes what a field replaces, unless an override gave that, too.
fn drop_alternatives(name: &str, known: &[&str], entries: &mut Vec<(String, Node)>) {
    for group in ALTERNATIVES {
        if group.contains(&name) && group.iter().all(|field| known.contains(field)) {
            entries.retain(|(entry, node)| {
                entry == name
                    || !group.contains(&entry.as_str())
                    || node.name_place.as_ref().is_some_and(Place::is_override)
            });
        }
    }
}

/// The item of that name or number, and its path.
fn find_item(
    name: &str,
    list: &Node,
    path: &FieldPath,
) -> Result<(usize, FieldPath), Box<Problem>> {
    let NodeValue::List(items) = &list.value else {
        return Err(Box::new(Problem::new(
            path.clone(),
            format!("`{path}` is {} and has no items", list.value.kind()),
        )));
    };
    let names: Vec<_> = items
        .iter()
        .map(|item| item.get("name").and_then(Node::text))
        .collect();
    let index = names
        .iter()
        .position(|known| *known == Some(name))
        .or_else(|| name.parse().ok());
    if let Some(index) = index.filter(|&index| index < items.len()) {
        return Ok((index, path.item(index, own_name(&names, index))));
    }
    let names: Vec<_> = names.into_iter().flatten().collect();
    let mut problem = Problem::new(
        path.field(name),
        format!("there is no `{}`", path.field(name)),
    );
    problem = if names.is_empty() {
        problem.expected(format!("a number from 0 to less than {}", items.len()))
    } else {
        problem.expected(format!(
            "one of {}, or a number from 0",
            quoted(names.iter().copied(), '`')
        ))
    };
    if let Some(near) = nearest(name, names.iter().copied()) {
        problem = problem.help(format!("did you mean `{near}`?"));
    }
    Err(Box::new(problem))
}
