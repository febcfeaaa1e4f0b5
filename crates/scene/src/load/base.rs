//! Files that extend another: `base = "other.toml"`.
//!
//! A job, a scene or a camera file may name a base of its own kind and state only the differences. They are merged over the base's tree before any
//! key is read:
//! - a table is merged key by key, but one that states its `type` replaces the base's as a whole;
//! - in lists of named entries, an entry replaces the base's of the same name, and others are appended; a camera of a job is merged over
//!   the base's of its name;
//! - any other value replaces the base's.
//!
//! `remove = ["lights.sun", "environment"]` first removes entries from the base. A base may have a base.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use super::files::{FileKind, open};
use super::read_text::ReadText;
use crate::document::{Node, Table, Value};
use crate::fault::{DescriptionErrors, ErrorCode};
use crate::limits::BASES;
use crate::place::Place;
use crate::reader::{Rule as _, path};

/// Returns a file's own tree merged over that of its base, if it names one. `chain` are the files that led here, this one last.
pub(super) fn merge_over_base(
    mut tree: Node,
    kind: FileKind,
    read: &ReadText<'_>,
    chain: &[PathBuf],
    errors: &mut DescriptionErrors,
) -> Option<Node> {
    let table = tree.as_table_mut()?;
    let (base, removed) = (table.remove("base"), table.remove("remove"));
    let Some(base) = base else {
        if let Some(removed) = removed {
            errors.add(
                ErrorCode::NoEffect,
                &removed.place,
                "\"remove\" has no effect without \"base\"",
                "add \"base\", or remove it",
            );
        }
        return Some(tree);
    };
    let file = path(&["toml"]).read(&base.node, errors)?;
    let mut base_node = based_on(&file.value, kind, read, &base.node.place, chain, errors)?;
    if let Some(removed) = removed {
        remove_entries(&mut base_node, &removed.node, errors);
    }
    merge(&mut base_node, tree);
    Some(base_node)
}

fn based_on(
    file: &Path,
    kind: FileKind,
    read: &ReadText<'_>,
    named: &Place,
    chain: &[PathBuf],
    errors: &mut DescriptionErrors,
) -> Option<Node> {
    if chain.iter().any(|above| above == file) {
        errors.add(
            ErrorCode::CircularReference,
            named,
            format!("\"{}\" is its own base", file.display()),
            "give another base, or none",
        );
        return None;
    }
    // More are taken for a cycle that different spellings of paths hide.
    let max_depth = BASES.current();
    if chain.len() as u64 > max_depth {
        let problem = format!("the chain of \"base\" references has more than {max_depth} files and may be circular");
        errors.add(
            ErrorCode::TooLarge,
            named,
            problem,
            format!("shorten the chain, {}", BASES.remedy(BASES.suggested(max_depth))),
        );
        return None;
    }
    open(file, kind, read, named, chain, errors)
}

/// Removes the entries that `list` names from the base.
fn remove_entries(base: &mut Node, list: &Node, errors: &mut DescriptionErrors) {
    if !matches!(list.value, Value::List(_)) {
        let problem = format!("found {}", list.describe());
        errors.add(
            ErrorCode::WrongType,
            &list.place,
            problem,
            "give a list of dotted keys of the base: [\"lights.sun\"]",
        );
    }
    for name in list.as_list() {
        let removed = name.as_text().is_some_and(|key| remove(base, &key.split('.').collect::<Vec<_>>()));
        if !removed {
            let problem = format!("found {}, but the base has no such entry", name.describe());
            errors.add(
                ErrorCode::UnknownName,
                &name.place,
                problem,
                "give dotted keys of the base: \"environment\", \"lights.sun\"",
            );
        }
    }
}

fn remove(node: &mut Node, key: &[&str]) -> bool {
    match (&mut node.value, key) {
        (Value::Table(table), [last]) => table.remove(last).is_some(),
        (Value::Table(table), [first, rest @ ..]) => table.get_mut(first).is_some_and(|inner| remove(inner, rest)),
        (Value::List(entries), [name, rest @ ..]) => match entries.iter().position(|e| e.name() == Some(name)) {
            Some(at) if rest.is_empty() => {
                entries.remove(at);
                true
            }
            Some(at) => remove(&mut entries[at], rest),
            None => false,
        },
        _ => false,
    }
}

/// Merges `over` into `under`.
fn merge(base_node: &mut Node, overlay: Node) {
    match (&mut base_node.value, overlay.value) {
        (Value::Table(base), Value::Table(table)) if !has_type(&table) => {
            base_node.place = overlay.place;
            table.entries.into_iter().for_each(|entry| match base.get_mut(&entry.key) {
                Some(node) if entry.key == MERGED_LIST => merge_entries(node, entry.node, merge),
                Some(node) => merge(node, entry.node),
                None => base.entries.push(entry),
            });
        }
        (Value::List(base), Value::List(list)) if named(base) && named(&list) => merge_lists(base, list, replace),
        (value, other) => {
            *value = other;
            base_node.place = overlay.place;
        }
    }
}

/// The list whose entries are merged with those of the base: the cameras of a job.
const MERGED_LIST: &str = "cameras";

fn merge_entries(base_node: &mut Node, overlay: Node, merge: impl Fn(&mut Node, Node)) {
    match (&mut base_node.value, overlay.value) {
        (Value::List(base), Value::List(list)) if named(base) && named(&list) => merge_lists(base, list, merge),
        (value, other) => {
            *value = other;
            base_node.place = overlay.place;
        }
    }
}

fn replace(base_node: &mut Node, overlay: Node) {
    *base_node = overlay;
}

/// Merges entries with those of the same name, and appends the others.
fn merge_lists(base: &mut Vec<Node>, list: Vec<Node>, merge: impl Fn(&mut Node, Node)) {
    let name_of = |node: &Node| node.name().unwrap_or_default().to_owned();
    let mut places: BTreeMap<String, usize> = BTreeMap::new();
    for (i, entry) in base.iter().enumerate() {
        places.entry(name_of(entry)).or_insert(i);
    }
    for entry in list {
        match places.get(&name_of(&entry)) {
            Some(&at) => merge(&mut base[at], entry),
            None => {
                places.insert(name_of(&entry), base.len());
                base.push(entry);
            }
        }
    }
}

/// True if a table selects one form of its kind, so that the base's keys may not fit.
fn has_type(table: &Table) -> bool {
    table.get("type").is_some()
}

fn named(list: &[Node]) -> bool {
    !list.is_empty() && list.iter().all(|entry| entry.name().is_some())
}
