//! Where a text stands: in a file or an override, at which line.

use std::fmt;
use std::ops::Range;
use std::sync::Arc;

/// What places in overrides call their source.
pub(crate) const OVERRIDE: &str = "--set";

/// A text that was read: a file or an override.
#[derive(Debug, PartialEq, Eq)]
pub struct Source {
    /// What to call it: a file's path, or `--set`.
    pub name: String,
    /// The text.
    pub text: String,
}

/// A stretch of a text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Place {
    /// The text.
    pub source: Arc<Source>,
    /// Bytes of the text.
    pub span: Range<usize>,
}

impl Place {
    /// Line, from 1.
    pub fn line(&self) -> usize {
        self.before().matches('\n').count() + 1
    }

    /// Column in characters, from 1.
    pub fn column(&self) -> usize {
        self.before()
            .chars()
            .rev()
            .take_while(|&c| c != '\n')
            .count()
            + 1
    }

    /// Whether the text is an override of the command line.
    pub fn is_override(&self) -> bool {
        self.source.name == OVERRIDE
    }

    fn before(&self) -> &str {
        self.source
            .text
            .get(..self.span.start)
            .unwrap_or(&self.source.text)
    }
}

impl fmt::Display for Place {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.is_override() {
            return write!(formatter, "{} {}", self.source.name, self.source.text);
        }
        write!(
            formatter,
            "{}:{}:{}",
            self.source.name,
            self.line(),
            self.column()
        )
    }
}
