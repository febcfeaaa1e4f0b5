//! A table as bytes for hashes: one form for one meaning.

use std::path::Path;

use super::{Item, Table, Value};

/// The hash of a file's contents, by its path; empty for a file that was not read.
pub type FileHash<'f> = dyn Fn(&Path) -> Vec<u8> + 'f;

impl Table {
    /// Feeds the table to `sink`: every value after a tag of its kind, numbers as 64 bits in little-endian order, texts and lists after their
    /// lengths, keys in the order of the record, and for a file the bytes of `file` instead of its path. Places, comments and formatting are ignored.
    pub fn feed(&self, file: &FileHash<'_>, sink: &mut dyn FnMut(&[u8])) {
        feed_length(self.entries.len(), sink);
        for (key, item) in &self.entries {
            feed_bytes(key.as_bytes(), sink);
            feed_item(item, file, sink);
        }
    }
}

fn feed_item(item: &Item, file: &FileHash<'_>, sink: &mut dyn FnMut(&[u8])) {
    sink(&[tag(&item.value)]);
    match &item.value {
        Value::Flag(flag) => sink(&[u8::from(*flag)]),
        Value::Whole(number) => sink(&number.to_le_bytes()),
        Value::Number(number) => sink(&number.to_bits().to_le_bytes()),
        Value::Text(text) | Value::Moment(text) => feed_bytes(text.as_bytes(), sink),
        Value::Path(path) => feed_bytes(&file(path), sink),
        Value::List(list) => {
            feed_length(list.len(), sink);
            list.iter().for_each(|item| feed_item(item, file, sink));
        }
        Value::Table(table) => table.feed(file, sink),
    }
}

fn tag(value: &Value) -> u8 {
    match value {
        Value::Flag(_) => 1,
        Value::Whole(_) => 2,
        Value::Number(_) => 3,
        Value::Text(_) => 4,
        Value::Path(_) => 5,
        Value::Moment(_) => 6,
        Value::List(_) => 7,
        Value::Table(_) => 8,
    }
}

fn feed_bytes(bytes: &[u8], sink: &mut dyn FnMut(&[u8])) {
    feed_length(bytes.len(), sink);
    sink(bytes);
}

fn feed_length(length: usize, sink: &mut dyn FnMut(&[u8])) {
    sink(&(length as u64).to_le_bytes());
}
