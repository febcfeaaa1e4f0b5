//! Changes of keys in the text of a file, for programs that generate files with changes by the user.

use std::path::Path;

use super::files::own_tree_of;
use crate::document::{Entry, Node, Value};
use crate::fault::DescriptionErrors;
use crate::overrides::Overrides;
use crate::place::Place;
use crate::reader::unread_item;
use crate::written::{File, Item, Table, Value as WrittenValue};

/// Returns the text of `file` with changes `key=value` of its keys, without its comments; values of a base are not copied. A key that is removed (`null`) and
/// that the file does not state itself is removed from the base with "remove".
///
/// # Errors
/// The text is not of the format, or a change does not apply to it.
pub fn edit(file: &Path, text: &str, changes: &[String]) -> Result<String, DescriptionErrors> {
    let mut errors = DescriptionErrors::none();
    let table = own_tree_of(file, text, &mut errors).and_then(|mut tree| {
        changes.iter().for_each(|change| apply(&mut tree, change, &mut errors));
        section(&tree)
    });
    errors.into_result(table).map(|table| File::new(table).to_string())
}

fn apply(tree: &mut Node, change: &str, errors: &mut DescriptionErrors) {
    let key = removed_key(change);
    let has_base = tree.as_table().is_some_and(|table| table.get("base").is_some());
    match key {
        Some(key) if has_base && !states(tree, key) => remove_from_base(tree, key),
        _ => {
            let overrides = Overrides::new([change]);
            overrides.apply(tree, true, errors);
            overrides.apply(tree, false, errors);
        }
    }
}

/// Returns the key that a change removes.
fn removed_key(change: &str) -> Option<&str> {
    let (key, value) = change.split_once('=')?;
    (value.trim() == "null").then_some(key.trim())
}

/// Returns true if the file itself states the key.
fn states(tree: &Node, key: &str) -> bool {
    key.split('.').try_fold(tree, |node, part| node.as_table()?.get(part)).is_some()
}

fn remove_from_base(tree: &mut Node, key: &str) {
    let place = tree.place.clone();
    let entry = Node { place: place.clone(), value: Value::Text(key.to_owned()) };
    let Some(table) = tree.as_table_mut() else { return };
    match table.get_mut("remove").map(|node| &mut node.value) {
        Some(Value::List(list)) => list.push(entry),
        _ => {
            let node = Node { place: place.clone(), value: Value::List(vec![entry]) };
            // After "base", before the tables.
            table.entries.insert(1, Entry { key: "remove".to_owned(), place, node });
        }
    }
}

/// Converts the tree to sections of a file.
fn section(tree: &Node) -> Option<Table> {
    let mut table = Table::new();
    for entry in &tree.as_table()?.entries {
        table.put(&entry.key, item(&entry.node)?);
    }
    Some(table)
}

/// Converts a table or a list of tables to sections; other values are unchanged.
fn item(node: &Node) -> Option<Item> {
    match &node.value {
        Value::Table(_) => Some(section(node)?.into()),
        Value::List(list) if !list.is_empty() && list.iter().all(|entry| entry.as_table().is_some()) => {
            let tables: Vec<Item> = list.iter().map(item).collect::<Option<_>>()?;
            Some(Item::at(&Place::unstated(), WrittenValue::List(tables)))
        }
        _ => unread_item(node),
    }
}

#[cfg(test)]
mod tests {
    use super::edit;
    use std::path::Path;

    fn edited(text: &str, changes: &[&str]) -> String {
        let changes: Vec<String> = changes.iter().map(|change| (*change).to_owned()).collect();
        edit(Path::new("a.toml"), text, &changes).expect("an edited file")
    }

    #[test]
    fn changes_are_written_where_the_key_is() {
        let text =
            "# a comment\nformat = 1\nspeed = -2\n[render]\nspp = 4 # few\n[[cameras]]\nname = \"a\"\nat = [0, 1.5]\n";
        let edited_text = edited(text, &["render.spp=16", "cameras.a.output.raw=true", "speed=null"]);
        assert_eq!(
            edited_text,
            "format = 1\n\n[render]\nspp = 16\n\n[[cameras]]\nname = \"a\"\nat = [0, 1.5]\noutput = { raw = true }\n"
        );
    }

    #[test]
    fn keys_of_a_base_are_removed_with_remove() {
        let text = "format = 1\nbase = \"b.toml\"\n[sensor]\nbits = 8\n";
        let edited_text = edited(text, &["sensor.dark=null", "sensor.bits=null", "isp=null"]);
        assert_eq!(edited_text, "format = 1\nbase = \"b.toml\"\nremove = [\"sensor.dark\", \"isp\"]\n\n[sensor]\n");
    }
}
