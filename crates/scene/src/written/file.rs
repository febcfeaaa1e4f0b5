//! A table as a file of the format, with comments.

use std::fmt;

use super::Table;
use super::comments::{Comments, write_comment};
use super::layout::write_section;

/// A file of the format: `format = 1`, a table, and comments.
///
/// Its text ([`fmt::Display`]) has the keys in the table's order, with values before sections: a table is a section `[key]`, one that stands for a
/// value is written inline, lists of tables are `[[key]]`, and within one of these lists of lines. A file of the format is UTF-8: a table with a path
/// that is not has no text, and writing it is an error (`to_string` panics).
#[derive(Clone, Debug, Default)]
pub struct File {
    head: String,
    table: Table,
    comments: Comments,
}

impl File {
    /// Creates a file with the table's keys.
    #[must_use]
    pub fn new(table: Table) -> Self {
        Self { table, ..Self::default() }
    }

    /// Adds a comment at its head, one line or more.
    #[must_use]
    pub fn head(mut self, comment: impl Into<String>) -> Self {
        self.head = comment.into();
        self
    }

    /// Adds a comment, one line or more, above a key or a section: `sensor.dark`, `materials.glass` of a named entry. A key that is not written has
    /// no comment.
    #[must_use]
    pub fn above(mut self, key: &str, comment: impl Into<String>) -> Self {
        self.comments.above.insert(key.to_owned(), comment.into());
        self
    }

    /// Adds a comment at the end of a key's line.
    #[must_use]
    pub fn beside(mut self, key: &str, comment: impl Into<String>) -> Self {
        self.comments.trailing.insert(key.to_owned(), comment.into());
        self
    }
}

impl fmt::Display for File {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write_comment(f, Some(&self.head).filter(|head| !head.is_empty()))?;
        f.write_str("format = 1\n")?;
        write_section(f, &self.comments, "", &self.table)
    }
}
