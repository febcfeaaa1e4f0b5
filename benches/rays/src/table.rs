//! A table in Markdown.

use std::fmt::{self, Display, Formatter};

/// A table with a title and a note.
#[derive(Clone, Debug)]
pub struct Table {
    title: &'static str,
    note: String,
    rows: Vec<Vec<String>>,
}

impl Table {
    /// A table without rows; `note` says what was measured.
    pub fn new(title: &'static str, note: impl Into<String>, head: &[&str]) -> Self {
        Self { title, note: note.into(), rows: vec![head.iter().map(|name| (*name).to_owned()).collect()] }
    }

    /// Adds a row, a cell a column.
    pub fn row(&mut self, cells: impl IntoIterator<Item = String>) {
        self.rows.push(cells.into_iter().collect());
    }
}

impl Display for Table {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        writeln!(f, "### {}\n\n{}\n", self.title, self.note)?;
        let (head, body) = self.rows.split_at(1);
        line(f, &head[0])?;
        let numbers = head[0].len() - 1;
        write!(f, "\n| --- |{}", " ---: |".repeat(numbers))?;
        body.iter().try_for_each(|row| {
            writeln!(f)?;
            line(f, row)
        })
    }
}

fn line(f: &mut Formatter<'_>, cells: &[String]) -> fmt::Result {
    write!(f, "| {} |", cells.join(" | "))
}
