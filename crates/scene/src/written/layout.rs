//! Layout of tables in a file: sections and lines.

use std::fmt::{self, Write as _};
use std::path::{MAIN_SEPARATOR, Path};

use super::comments::{Comments, write_comment};
use super::{Item, Table, Value};
use crate::document::join;

/// Maximum line length of an inline table within an entry of a list, characters.
const MAX_INLINE_LENGTH: usize = 120;

/// Writes the keys of a table: values first, then sections.
pub(super) fn write_section(f: &mut fmt::Formatter<'_>, comments: &Comments, path: &str, table: &Table) -> fmt::Result {
    write_keys(f, comments, path, table, is_section)
}

/// True for a table that is a section.
fn is_section(item: &Item, _: &str) -> bool {
    match &item.value {
        Value::Table(table) => !table.inline,
        Value::List(_) => tables_of(item).is_some(),
        _ => false,
    }
}

/// The same within an entry of a list.
fn is_section_of_entry(item: &Item, key: &str) -> bool {
    let Value::Table(table) = &item.value else { return false };
    let mut line = String::new();
    let is_text = write!(line, "{key} = {}", InlineValue(item)).is_ok();
    !table.inline && is_text && line.chars().count() > MAX_INLINE_LENGTH
}

fn write_keys(
    f: &mut fmt::Formatter<'_>,
    comments: &Comments,
    path: &str,
    table: &Table,
    is_section: fn(&Item, &str) -> bool,
) -> fmt::Result {
    for (key, item) in table.entries().filter(|(key, item)| !is_section(item, key)) {
        let path = join(path, key);
        write_comment(f, comments.above.get(&path))?;
        write!(f, "{} = ", Key(key))?;
        write_value(f, item)?;
        match comments.trailing.get(&path) {
            Some(comment) => writeln!(f, " # {comment}")?,
            None => f.write_char('\n')?,
        }
    }
    for (key, item) in table.entries().filter(|(key, item)| is_section(item, key)) {
        let path = join(path, key);
        match (&item.value, tables_of(item)) {
            (Value::Table(table), _) => {
                write_head(f, comments, &path, ["[", &path, "]"])?;
                write_keys(f, comments, &path, table, is_section)?;
            }
            (_, Some(tables)) => {
                for (index, (item, table)) in tables.into_iter().enumerate() {
                    write_head(f, comments, &item.key_in(&path, index), ["[[", &path, "]]"])?;
                    write_keys(f, comments, &path, table, is_section_of_entry)?;
                }
            }
            _ => {}
        }
    }
    Ok(())
}

fn write_head(f: &mut fmt::Formatter<'_>, comments: &Comments, path: &str, head: [&str; 3]) -> fmt::Result {
    f.write_char('\n')?;
    write_comment(f, comments.above.get(path))?;
    writeln!(f, "{}", head.concat())
}

/// The entries of a list of tables that are sections.
fn tables_of(item: &Item) -> Option<Vec<(&Item, &Table)>> {
    let Value::List(list) = &item.value else { return None };
    let tables = list.iter().map(|item| match &item.value {
        Value::Table(table) if !table.inline => Some((item, table)),
        _ => None,
    });
    tables.collect::<Option<Vec<_>>>().filter(|tables| !tables.is_empty())
}

/// Writes a value inline, but a list of tables with one line each.
fn write_value(f: &mut fmt::Formatter<'_>, item: &Item) -> fmt::Result {
    let Some(tables) = tables_of(item) else { return write!(f, "{}", InlineValue(item)) };
    f.write_str("[\n")?;
    for (item, _) in tables {
        writeln!(f, "  {},", InlineValue(item))?;
    }
    f.write_str("]")
}

impl Item {
    /// The value in one line, as TOML. A path that is not UTF-8 has no text (an empty one).
    #[must_use]
    pub fn in_one_line(&self) -> String {
        let mut line = String::new();
        let written = write!(line, "{}", InlineValue(self));
        if written.is_ok() { line } else { String::new() }
    }
}

/// A value in one line.
struct InlineValue<'a>(&'a Item);

impl fmt::Display for InlineValue<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.0.value {
            Value::Flag(flag) => write!(f, "{flag}"),
            Value::Whole(number) => write!(f, "{number}"),
            Value::Number(number) => write_number(f, *number),
            Value::Text(text) => write_text(f, text),
            Value::Path(path) => write_path(f, path),
            Value::Moment(text) => f.write_str(text),
            Value::List(list) => {
                f.write_char('[')?;
                write_separated(f, list, |f, item| write!(f, "{}", InlineValue(item)))?;
                f.write_char(']')
            }
            Value::Table(table) if table.entries.is_empty() => f.write_str("{}"),
            Value::Table(table) => {
                f.write_str("{ ")?;
                write_separated(f, &table.entries, |f, (key, item)| write!(f, "{} = {}", Key(key), InlineValue(item)))?;
                f.write_str(" }")
            }
        }
    }
}

fn write_separated<T>(
    f: &mut fmt::Formatter<'_>,
    list: &[T],
    write: impl Fn(&mut fmt::Formatter<'_>, &T) -> fmt::Result,
) -> fmt::Result {
    for (index, entry) in list.iter().enumerate() {
        if index > 0 {
            f.write_str(", ")?;
        }
        write(f, entry)?;
    }
    Ok(())
}

/// Writes the shortest decimal that reads back to the same bits; with an exponent where it would have many zeros.
fn write_number(f: &mut fmt::Formatter<'_>, number: f64) -> fmt::Result {
    let plain = number == 0.0 || (1e-5..1e15).contains(&number.abs());
    match plain {
        // TOML's integers have no negative zero.
        true if number == 0.0 && number.is_sign_negative() => f.write_str("-0.0"),
        true => write!(f, "{number}"),
        false => write!(f, "{number:e}"),
    }
}

/// Writes a path with `/` separators, as in files of the format on every system.
fn write_path(f: &mut fmt::Formatter<'_>, path: &Path) -> fmt::Result {
    let text = path.to_str().ok_or(fmt::Error)?;
    match MAIN_SEPARATOR {
        '/' => write_text(f, text),
        separator => write_text(f, &text.replace(separator, "/")),
    }
}

/// Writes a basic string of TOML.
fn write_text(f: &mut fmt::Formatter<'_>, text: &str) -> fmt::Result {
    f.write_char('"')?;
    for c in text.chars() {
        match c {
            '"' | '\\' => write!(f, "\\{c}")?,
            c if c.is_control() => write!(f, "\\u{:04X}", c as u32)?,
            c => f.write_char(c)?,
        }
    }
    f.write_char('"')
}

/// A key, quoted if necessary.
struct Key<'a>(&'a str);

impl fmt::Display for Key<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let bare = !self.0.is_empty() && self.0.chars().all(|c| c.is_ascii_alphanumeric() || c == '_' || c == '-');
        if bare { f.write_str(self.0) } else { write_text(f, self.0) }
    }
}
