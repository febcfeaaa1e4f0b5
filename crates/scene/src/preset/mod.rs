//! Built-in materials: `preset = "chrome"` stands for the keys of that name in `materials.toml`.
//!
//! A preset is a table in the words of the format, read by the same rules as any material. Keys that the user gives with `preset` replace the
//! preset's: the same key, or an alternative of it (`metal` and `index_file`). For errors, the place of the preset's keys is where the user names it.

use std::path::Path;
use std::sync::{Arc, LazyLock};

use crate::document::{Entry, Node, Table, Value, parse};
use crate::fault::{DescriptionErrors, ErrorCode};
use crate::place::Place;
use crate::reader::word;

/// The presets, each a table: "about" and "source" in words, then keys of a material.
const MATERIALS: &str = include_str!("materials.toml");

/// Alternative keys, of which a material has at most one: a user's key replaces the preset's.
const ALTERNATIVES: &[&[&str]] = &[
    &["metal", "index_file"],
    &["absorption_per_m", "internal_transmittance"],
    &["class", "r_l_mcd_m2_lx"],
    &["q_d_mcd_m2_lx", "luminance_factor"],
];

/// A built-in material.
#[derive(Clone, Debug)]
pub struct Preset {
    pub name: String,
    /// Description, one sentence.
    pub description: String,
    /// Source of its values.
    pub source: String,
    /// Its keys and values, in the words of the format.
    keys: Table,
}

static PRESETS: LazyLock<Vec<Preset>> = LazyLock::new(|| {
    let mut errors = DescriptionErrors::none();
    let tree = parse(&Arc::from(Path::new("materials.toml")), MATERIALS, &mut errors);
    let entries = tree.as_table().map_or(&[][..], |t| &t.entries);
    entries.iter().map(|entry| Preset::new(&entry.key, &entry.node)).collect()
});

/// All built-in materials.
#[must_use]
pub fn all() -> &'static [Preset] {
    &PRESETS
}

/// Names of all built-in materials.
#[must_use]
pub fn names() -> Vec<&'static str> {
    all().iter().map(|p| p.name.as_str()).collect()
}

impl Preset {
    fn new(name: &str, node: &Node) -> Self {
        let mut keys = node.as_table().cloned().unwrap_or_default();
        let mut words = |key: &str| {
            let entry = keys.remove(key);
            entry.and_then(|e| e.node.as_text().map(str::to_owned)).unwrap_or_default()
        };
        let (description, source) = (words("about"), words("source"));
        Self { name: name.to_owned(), description, source, keys }
    }

    /// Its keys and values, in the words of the format: `type = "conductor"`, …
    pub fn keys_and_values(&self) -> impl Iterator<Item = String> {
        self.keys.entries.iter().map(|e| format!("{} = {}", e.key, e.node.written()))
    }
}

/// Expands the preset of every material of the scene.
pub(crate) fn expand(document: &mut Node, errors: &mut DescriptionErrors) {
    let scene = document.as_table_mut().and_then(|job| job.get_mut("scene"));
    let materials = scene.and_then(Node::as_table_mut).and_then(|scene| scene.get_mut("materials"));
    if let Some(Node { value: Value::List(materials), .. }) = materials {
        materials.iter_mut().filter_map(Node::as_table_mut).for_each(|material| spell_out_material(material, errors));
    }
}

fn spell_out_material(material: &mut Table, errors: &mut DescriptionErrors) {
    let Some(named) = material.remove("preset") else { return };
    if let Some(kind) = material.entries.iter().find(|e| e.key == "type") {
        let problem = format!("\"preset\" contradicts \"type\" ({})", kind.place);
        errors.add(
            ErrorCode::Contradiction,
            &named.place,
            problem,
            "keep the preset, which sets the type, or the type",
        );
        return;
    }
    let preset = word(&named.node, &names(), errors).and_then(|name| all().iter().find(|p| p.name == name));
    match preset {
        Some(preset) => {
            let preset_entries = preset.keys.entries.iter().filter(|e| !is_given(material, &e.key));
            let entries: Vec<_> = preset_entries.map(|e| e.with_place(&named.node.place)).collect();
            material.entries.extend(entries);
        }
        // A material of unknown kind cannot be checked further.
        None => material.entries.push(Entry {
            key: "type".to_owned(),
            place: named.place.clone(),
            node: Node { place: named.place, value: Value::Unreadable },
        }),
    }
}

/// True if the material gives the key, or an alternative of it.
fn is_given(material: &Table, key: &str) -> bool {
    let alternatives = ALTERNATIVES.iter().find(|group| group.contains(&key));
    material.get(key).is_some() || alternatives.is_some_and(|group| group.iter().any(|k| material.get(k).is_some()))
}

impl Entry {
    /// Returns a copy with the place `place` throughout.
    fn with_place(&self, place: &Place) -> Self {
        Self { key: self.key.clone(), place: place.clone(), node: self.node.with_place(place) }
    }
}

impl Node {
    fn with_place(&self, place: &Place) -> Self {
        let value = match &self.value {
            Value::List(list) => Value::List(list.iter().map(|n| n.with_place(place)).collect()),
            Value::Table(table) => {
                Value::Table(Table { entries: table.entries.iter().map(|e| e.with_place(place)).collect() })
            }
            other => other.clone(),
        };
        Self { place: place.clone(), value }
    }

    /// The value as written in a file.
    fn written(&self) -> String {
        match &self.value {
            Value::Text(text) => format!("\"{text}\""),
            Value::List(list) => format!("[{}]", list.iter().map(Self::written).collect::<Vec<_>>().join(", ")),
            Value::Table(table) => {
                let entries = table.entries.iter().map(|e| format!("{} = {}", e.key, e.node.written()));
                format!("{{ {} }}", entries.collect::<Vec<_>>().join(", "))
            }
            _ => self.describe(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_preset_says_what_it_is_where_from_and_of_what_type() {
        assert!(all().len() > 10, "the file was read");
        for Preset { name, description, source, keys } in all() {
            assert!(description.ends_with('.') && !source.is_empty(), "{name}");
            assert!(keys.get("type").is_some(), "{name}");
        }
    }

    fn expanded(material: &str) -> (Table, Vec<String>) {
        let mut errors = DescriptionErrors::none();
        let text = format!("[[scene.materials]]\nname = \"m\"\n{material}");
        let mut tree = parse(&Arc::from(Path::new("job.toml")), &text, &mut errors);
        expand(&mut tree, &mut errors);
        let scene = tree.as_table().and_then(|t| t.get("scene")).and_then(Node::as_table).expect("the scene");
        let table = scene.get("materials").expect("materials").as_list()[0].as_table().expect("a table").clone();
        (table, errors.as_slice().iter().map(ToString::to_string).collect())
    }

    #[test]
    fn keys_beside_a_preset_take_the_place_of_its_own() {
        let (table, errors) = expanded("preset = \"chrome\"\nalpha = 0.3");
        assert!(errors.is_empty(), "{errors:?}");
        assert_eq!(table.get("alpha").map(Node::describe), Some("0.3".to_owned()));
        let metal = table.get("metal").expect("of the preset");
        assert_eq!((metal.describe(), metal.place.line_column()), ("the text \"Cr\"".to_owned(), Some((3, 10))));
        let (table, _) = expanded("preset = \"chrome\"\nindex_file = \"nickel.csv\"");
        assert!(table.get("metal").is_none(), "a file of n and k says which metal");
    }

    #[test]
    fn presets_that_are_none_and_types_beside_them() {
        let (_, errors) = expanded("preset = \"crome\"");
        assert!(errors.len() == 1 && errors[0].contains("did you mean \"chrome\"?"), "{errors:?}");
        let (_, errors) = expanded("type = \"diffuse\"\npreset = \"chrome\"");
        let both = "job.toml:4:1: scene.materials.m.preset: \"preset\" contradicts \"type\" (job.toml:3:1: scene.materials.m.type)";
        assert!(errors.len() == 1 && errors[0].starts_with(both), "{errors:?}");
    }
}
