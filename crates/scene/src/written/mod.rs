//! A record as a table of the format, written by the macros of `reader`.
//!
//! A [`Table`] gives the text of a file ([`File`]), the bytes of a hash ([`Table::feed`]) and the places of keys ([`Table::place_of`]), all from the
//! same statement of each key that reads it. Keys that were not given are absent: a default is never written.

mod bytes;
mod comments;
mod file;
mod json;
mod layout;
#[cfg(test)]
mod tests;

pub use bytes::FileHash;
pub use file::File;

use std::path::{Path, PathBuf};

use crate::document::join;
use crate::place::{Place, Placed};

/// A value and its place. Equality ignores the place.
#[derive(Clone, Debug)]
pub struct Item {
    pub value: Value,
    /// Its place; [`Place::unstated`] if no file states it.
    pub place: Place,
}

impl PartialEq for Item {
    fn eq(&self, other: &Self) -> bool {
        self.value == other.value
    }
}

/// A value of the format.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// `true` or `false`.
    Flag(bool),
    /// A non-negative integer.
    Whole(u64),
    /// A finite number, in the unit of its key.
    Number(f64),
    /// A text: a name, or a word of the format.
    Text(String),
    /// Path of a file, relative to the location of the written file.
    Path(PathBuf),
    /// A date or a time, as in TOML: 2026-06-21, 09:30:00.
    Moment(String),
    List(Vec<Item>),
    Table(Table),
}

/// Keys and values in the order of the record.
#[derive(Clone, Debug, Default)]
pub struct Table {
    entries: Vec<(String, Item)>,
    /// Place of the table.
    place: Option<Place>,
    /// True if it represents a value and is written in one line.
    inline: bool,
}

impl PartialEq for Table {
    fn eq(&self, other: &Self) -> bool {
        self.entries == other.entries
    }
}

impl Table {
    /// Creates an empty table.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a key.
    #[must_use]
    pub fn with(mut self, key: &str, value: impl Into<Item>) -> Self {
        self.put(key, value);
        self
    }

    /// Appends all keys of another table.
    #[must_use]
    pub fn and(mut self, other: Self) -> Self {
        self.entries.extend(other.entries);
        self
    }

    /// Marks the table for one line: `{ a = 1, b = 2 }`.
    #[must_use]
    pub fn in_line(mut self) -> Self {
        self.inline = true;
        self
    }

    /// Adds a key.
    pub fn put(&mut self, key: &str, value: impl Into<Item>) {
        self.entries.push((key.to_owned(), value.into()));
    }

    /// Keys and values, in order.
    pub fn entries(&self) -> impl Iterator<Item = (&str, &Item)> {
        self.entries.iter().map(|(key, item)| (key.as_str(), item))
    }

    /// The value of a key.
    #[must_use]
    pub fn get(&self, key: &str) -> Option<&Item> {
        self.entries().find(|(known, _)| *known == key).map(|(_, item)| item)
    }

    /// Place of the innermost stated part of a dotted key: of `dark.hot.fraction` the fraction, else `hot`, else `dark`; of a list its first entry. `None`
    /// if no part is stated.
    #[must_use]
    pub fn place_of(&self, key: &str) -> Option<&Place> {
        let (first, rest) = key.split_once('.').unwrap_or((key, ""));
        let item = self.get(first)?;
        let inner = match &item.value {
            Value::Table(table) if !rest.is_empty() => table.place_of(rest),
            _ => None,
        };
        inner.or(Some(&item.place)).filter(|place| place.has_source())
    }

    /// Sets the place of the table, unless it is known.
    pub(crate) fn set_place(&mut self, place: &Place) {
        self.place.get_or_insert_with(|| place.clone());
    }

    /// Name of a list's entry.
    fn name(&self) -> Option<&str> {
        match self.get("name").map(|item| &item.value) {
            Some(Value::Text(name)) => Some(name),
            _ => None,
        }
    }
}

impl Item {
    /// Creates a value at a place.
    pub(crate) fn at(place: &Place, value: Value) -> Self {
        Self { value, place: place.clone() }
    }

    /// Marks a table for one line.
    pub(crate) fn inline(self) -> Self {
        match self.value {
            Value::Table(table) => Self { value: Value::Table(table.in_line()), ..self },
            _ => self,
        }
    }

    /// Dotted key of this value as the entry `index` of a list.
    fn key_in(&self, list: &str, index: usize) -> String {
        match &self.value {
            Value::Table(table) => table.name().map(|name| join(list, name)),
            _ => None,
        }
        .unwrap_or_else(|| format!("{list}[{index}]"))
    }
}

impl From<Value> for Item {
    fn from(value: Value) -> Self {
        Self { value, place: Place::unstated() }
    }
}

impl From<Table> for Item {
    fn from(table: Table) -> Self {
        let first = table.entries.first().map(|(_, item)| &item.place);
        let place = table.place.as_ref().or(first).cloned().unwrap_or_else(Place::unstated);
        Self { value: Value::Table(table), place }
    }
}

impl<T: Into<Self>> From<Vec<T>> for Item {
    fn from(list: Vec<T>) -> Self {
        let list: Vec<Self> = list.into_iter().map(Into::into).collect();
        let place = list.first().map_or_else(Place::unstated, |first| first.place.clone());
        Self { value: Value::List(list), place }
    }
}

impl<T: Into<Self>, const N: usize> From<[T; N]> for Item {
    fn from(list: [T; N]) -> Self {
        list.into_iter().collect::<Vec<_>>().into()
    }
}

impl<T: Into<Self>> From<Placed<T>> for Item {
    fn from(placed: Placed<T>) -> Self {
        Self { place: placed.place, ..placed.value.into() }
    }
}

/// Conversions of values that are a variant of [`Value`].
macro_rules! values {
    ($($ty:ty => $variant:ident,)*) => {$(
        impl From<$ty> for Item {
            fn from(value: $ty) -> Self {
                Value::$variant(value.into()).into()
            }
        }
    )*};
}

values! {
    bool => Flag,
    u32 => Whole,
    u64 => Whole,
    f64 => Number,
    &str => Text,
    String => Text,
    &Path => Path,
    PathBuf => Path,
}
