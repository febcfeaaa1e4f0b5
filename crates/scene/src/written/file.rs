//! A table as a file of the format, with comments.

use std::fmt;

use super::Table;
use super::comments::{Comments, write_comment};
use super::layout::write_section;

/// A file of the format: `format = 1`, a table, and comments.
///
/// Its text ([`fmt::Display`]) has the keys in the table's order, but tables of their own behind the values: a table that is a
/// value of its own is `[key]`, one that stands for a value is written in line, lists of tables are `[[key]]`, within one of these
/// lists of lines. A file of the format is UTF-8: a table with a path that is not has no text, and to write it is an error
/// (`to_string` panics).
#[derive(Clone, Debug, Default)]
pub struct File {
    head: String,
    table: Table,
    comments: Comments,
}

impl File {
    /// A file that says what the table says.
    #[must_use]
    pub fn new(table: Table) -> Self {
        Self { table, ..Self::default() }
    }

    /// With a comment at its head, one line or more.
    #[must_use]
    pub fn head(mut self, comment: impl Into<String>) -> Self {
        self.head = comment.into();
        self
    }

    /// With a comment, one line or more, above a key or a section: `sensor.dark`, `materials.glass` of an entry with a name.
    /// A key that is not written has none.
    #[must_use]
    pub fn above(mut self, key: &str, comment: impl Into<String>) -> Self {
        self.comments.above.insert(key.to_owned(), comment.into());
        self
    }

    /// With a comment on the line of a key.
    #[must_use]
    pub fn beside(mut self, key: &str, comment: impl Into<String>) -> Self {
        self.comments.beside.insert(key.to_owned(), comment.into());
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
