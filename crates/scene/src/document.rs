//! A TOML text as a tree whose values know their places.

use std::borrow::Cow;
use std::num::IntErrorKind;
use std::path::Path;
use std::sync::Arc;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::fault::{DescriptionErrors, ErrorCode};
use crate::line_index::LineIndex;
use crate::place::Place;

/// A value and its place.
#[derive(Clone, Debug)]
pub(crate) struct Node {
    pub(crate) place: Place,
    pub(crate) value: Value,
}

/// A value of a file.
#[derive(Clone, Debug)]
pub(crate) enum Value {
    Flag(bool),
    Whole(i64),
    Number(f64),
    Text(String),
    /// A date or a time, as written.
    Moment(String),
    List(Vec<Node>),
    Table(Table),
    /// A TOML value that no key accepts: its type.
    Foreign(&'static str),
    /// Placeholder of a file that could not be read; the error is reported where the file is named.
    Unreadable,
}

/// A table, in the order of the file.
#[derive(Clone, Debug, Default)]
pub(crate) struct Table {
    pub(crate) entries: Vec<Entry>,
}

/// A key of a table.
#[derive(Clone, Debug)]
pub(crate) struct Entry {
    pub(crate) key: String,
    /// Place of the key (the value follows to its right).
    pub(crate) place: Place,
    pub(crate) node: Node,
}

impl Table {
    pub(crate) fn get(&self, key: &str) -> Option<&Node> {
        self.entries.iter().find(|e| e.key == key).map(|e| &e.node)
    }

    pub(crate) fn get_mut(&mut self, key: &str) -> Option<&mut Node> {
        self.entries.iter_mut().find(|e| e.key == key).map(|e| &mut e.node)
    }

    /// Removes an entry.
    pub(crate) fn remove(&mut self, key: &str) -> Option<Entry> {
        let index = self.entries.iter().position(|e| e.key == key)?;
        Some(self.entries.remove(index))
    }
}

impl Node {
    /// Description, in words.
    pub(crate) fn describe(&self) -> String {
        match &self.value {
            Value::Flag(v) => v.to_string(),
            Value::Whole(v) => v.to_string(),
            Value::Number(v) => v.to_string(),
            Value::Text(v) => format!("the text \"{v}\""),
            Value::Moment(v) => format!("the date {v}"),
            Value::List(v) => format!("a list of {}", v.len()),
            Value::Table(_) => "a table".to_owned(),
            Value::Foreign(name) => (*name).to_owned(),
            Value::Unreadable => "nothing".to_owned(),
        }
    }

    pub(crate) fn as_table(&self) -> Option<&Table> {
        match &self.value {
            Value::Table(t) => Some(t),
            _ => None,
        }
    }

    pub(crate) fn as_table_mut(&mut self) -> Option<&mut Table> {
        match &mut self.value {
            Value::Table(t) => Some(t),
            _ => None,
        }
    }

    pub(crate) fn as_list(&self) -> &[Node] {
        match &self.value {
            Value::List(v) => v,
            _ => &[],
        }
    }

    pub(crate) fn as_text(&self) -> Option<&str> {
        match &self.value {
            Value::Text(v) => Some(v),
            _ => None,
        }
    }

    /// The `name` of a table, if any.
    pub(crate) fn name(&self) -> Option<&str> {
        self.as_table()?.get("name")?.as_text()
    }
}

/// Maximum number of syntax errors reported per file: those after the first are often its consequence.
const MAX_SYNTAX_ERRORS: usize = 3;

/// Parses a file's text to its tree; reports its first syntax errors.
pub(crate) fn parse(file: &Arc<Path>, text: &str, description_errors: &mut DescriptionErrors) -> Node {
    let (table, mut errors) = DeTable::parse_recoverable(text);
    errors.sort_by_key(|error| error.span().map_or(0, |s| s.start));
    let builder = Builder { spots: PlaceResolver::File { file: file.clone(), lines: LineIndex::new(text) } };
    for error in errors.iter().take(MAX_SYNTAX_ERRORS) {
        let place = builder.spots.place(error.span().map_or(0, |s| s.start), &"".into());
        description_errors.add(
            ErrorCode::InvalidToml,
            &place,
            format!("invalid TOML: {}", error.message()),
            "correct the syntax",
        );
    }
    let table = builder.table(table.into_inner(), &"".into());
    Node { place: Place::file_head(file.clone()), value: Value::Table(table) }
}

/// Parses the value of an override, with the place of the override throughout; `None` if it is no TOML value.
pub(crate) fn parse_override(value: &str, key: &str, place: &dyn Fn(&Arc<str>) -> Place) -> Option<Node> {
    let parsed = DeValue::parse(value).ok()?;
    let builder = Builder { spots: PlaceResolver::Override(place) };
    Some(builder.node(parsed, &key.into()))
}

/// Conversion of byte offsets to places.
enum PlaceResolver<'a> {
    File {
        file: Arc<Path>,
        lines: LineIndex<'a>,
    },
    /// The place of a key that an override changes.
    Override(&'a dyn Fn(&Arc<str>) -> Place),
}

impl PlaceResolver<'_> {
    fn place(&self, offset: usize, key: &Arc<str>) -> Place {
        match self {
            Self::Override(place) => place(key),
            Self::File { file, lines } => {
                let (line, column) = lines.line_column(offset);
                Place::at(file.clone(), line, column, key.clone())
            }
        }
    }
}

struct Builder<'a> {
    spots: PlaceResolver<'a>,
}

// Values are consumed as they are read: a large file is held once as text and once as a tree.
impl Builder<'_> {
    fn node(&self, value: Spanned<DeValue<'_>>, key: &Arc<str>) -> Node {
        let place = self.spots.place(value.span().start, key);
        Node { place, value: self.value(value.into_inner(), key) }
    }

    fn value(&self, value: DeValue<'_>, key: &Arc<str>) -> Value {
        match value {
            DeValue::Boolean(v) => Value::Flag(v),
            DeValue::Integer(v) => integer(&v),
            DeValue::Float(v) => {
                v.as_str().parse().map_or(Value::Foreign("a number too large for 64 bits"), Value::Number)
            }
            DeValue::String(v) => Value::Text(v.into_owned()),
            DeValue::Datetime(v) => Value::Moment(v.to_string()),
            DeValue::Array(v) => Value::List(v.into_iter().enumerate().map(|(i, e)| self.element(i, e, key)).collect()),
            DeValue::Table(v) => Value::Table(self.table(v, key)),
        }
    }

    fn element(&self, index: usize, value: Spanned<DeValue<'_>>, list: &Arc<str>) -> Node {
        if !matches!(value.get_ref(), DeValue::Table(_) | DeValue::Array(_)) {
            let node = self.node(value, list);
            return Node { place: node.place.with_element(index as u32), ..node };
        }
        let name = value.get_ref().get("name").and_then(|n| n.as_ref().as_str());
        let key = name.map_or_else(|| format!("{list}[{index}]"), |name| join(list, name));
        self.node(value, &key.into())
    }

    fn table(&self, table: DeTable<'_>, key: &Arc<str>) -> Table {
        let mut entries: Vec<_> = table.into_iter().collect();
        entries.sort_by_key(|(k, _)| k.span().start);
        Table { entries: entries.into_iter().map(|(k, v)| self.entry(k, v, key)).collect() }
    }

    fn entry(&self, key: Spanned<Cow<'_, str>>, value: Spanned<DeValue<'_>>, parent: &str) -> Entry {
        let path = join(parent, key.get_ref()).into();
        let place = self.spots.place(key.span().start, &path);
        Entry { key: key.into_inner().into_owned(), place, node: self.node(value, &path) }
    }
}

/// A dotted key.
pub(crate) fn join(parent: &str, key: &str) -> String {
    if parent.is_empty() { key.to_owned() } else { format!("{parent}.{key}") }
}

fn integer(v: &toml::de::DeInteger<'_>) -> Value {
    match i64::from_str_radix(v.as_str(), v.radix()) {
        Ok(v) => Value::Whole(v),
        Err(error) => Value::Foreign(match error.kind() {
            IntErrorKind::PosOverflow | IntErrorKind::NegOverflow => "an integer too large for 64 bits",
            _ => "an invalid integer",
        }),
    }
}
