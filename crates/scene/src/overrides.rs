//! Overrides: `--set key=value`, applied to the documents before they are checked.
//!
//! The key is a dotted path of the description. An entry of a list is addressed by its name or its number (from 0):
//! `cameras.front.sensor.exposure_s=0.01`, `scene.objects.2.material=red`. Referenced files are reached through the key that names them. The value is
//! TOML; other text is read as a string, so that `scene=other.toml` needs no quotes. `null`, which TOML does not have, removes the key or the entry
//! of a list: `cameras.front.effects.psf=null`.

use std::path::Path;
use std::sync::Arc;

use crate::document::{Entry, Node, Table, Value, join, parse_override};
use crate::fault::{DescriptionErrors, ErrorCode};
use crate::place::Place;
use crate::suggest::nearest;

/// Changes to a description, in order.
#[derive(Clone, Debug, Default)]
pub struct Overrides {
    texts: Vec<ChangeText>,
    flags: Vec<Flag>,
}

/// A `key=value`.
#[derive(Clone, Debug)]
struct ChangeText {
    text: Arc<str>,
    /// Place in the file that states it; `None` for the command line.
    by: Option<Arc<Place>>,
}

impl ChangeText {
    /// Place of a key of `file` that it changes.
    fn place(&self, file: &Path, key: &str) -> Place {
        match &self.by {
            Some(by) => Place::change(file.into(), by.clone(), key.into()),
            None => Place::set(file.into(), self.text.clone(), key.into()),
        }
    }
}

impl From<&str> for ChangeText {
    fn from(text: &str) -> Self {
        Self { text: text.into(), by: None }
    }
}

/// A key that a command-line option sets for all cameras.
#[derive(Clone, Debug)]
struct Flag {
    table: FlagTable,
    key: &'static str,
    value: String,
    text: Arc<str>,
}

/// The table that contains the key of a flag.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum FlagTable {
    /// `[render]` of the job.
    Render,
    /// `[sensor]` of each camera, in the job or in its own file.
    Sensors,
}

impl Overrides {
    /// Creates overrides from `key=value` texts; they are checked when the description is loaded.
    pub fn new<S: AsRef<str>>(texts: impl IntoIterator<Item = S>) -> Self {
        Self { texts: texts.into_iter().map(|t| t.as_ref().into()).collect(), flags: Vec::new() }
    }

    /// Adds `text`, a `key=value`, after the others.
    pub fn add(&mut self, text: &str) {
        self.texts.push(text.into());
    }

    /// Adds a change that a file of changes states at `by`, where its errors are reported.
    pub fn add_stated(&mut self, text: &str, by: &Place) {
        self.texts.push(ChangeText { text: text.into(), by: Some(Arc::new(by.clone())) });
    }

    /// Sets `key` of `[render]` for all cameras, over files and the other changes. Errors are reported at the flag `text` of the command line.
    pub fn add_render(&mut self, text: &str, key: &'static str, value: &str) {
        self.flags.push(Flag { table: FlagTable::Render, key, value: value.to_owned(), text: text.into() });
    }

    /// Adds a flag that sets `key` in `[sensor]` of each camera: of all cameras of a job, or of the camera of a camera file.
    pub fn push_sensor(&mut self, text: &str, key: &'static str, value: &str) {
        self.flags.push(Flag { table: FlagTable::Sensors, key, value: value.to_owned(), text: text.into() });
    }

    /// Applies the changes that select files to read (`early`), or the others.
    pub(crate) fn apply(&self, document: &mut Node, early: bool, errors: &mut DescriptionErrors) {
        for text in &self.texts {
            let change = KeyOverride::parse(text);
            let names_file = change.as_ref().is_some_and(KeyOverride::names_file);
            match change {
                Some(change) if change.path.len() > MAX_KEY_PARTS && !early => {
                    note_too_deep(document, text, change.path.len(), errors);
                }
                Some(change) if names_file == early => change.apply(document, errors),
                None if !early => note_missing_value(document, text, errors),
                _ => {}
            }
        }
        if !early {
            self.flags.iter().for_each(|flag| flag.apply(document));
        }
    }
}

impl Flag {
    fn apply(&self, document: &mut Node) {
        match self.table {
            FlagTable::Render => self.apply_to_render(document),
            FlagTable::Sensors => self.apply_to_sensors(document),
        }
    }

    /// Sets the key in the job, and removes it from its cameras.
    fn apply_to_render(&self, document: &mut Node) {
        let Some(job) = document.as_table_mut() else { return };
        if let Some(Node { value: Value::List(cameras), .. }) = job.get_mut("cameras") {
            for camera in cameras {
                if let Some(render) = camera.as_table_mut().and_then(|c| c.get_mut("render")?.as_table_mut()) {
                    render.remove(self.key);
                }
            }
        }
        let place = self.place(document, "render");
        let Some(job) = document.as_table_mut() else { return };
        self.set(entry_or_table(job, "render", &place));
    }

    /// Sets the key in the sensor of each camera; a camera without one is refused when it is read.
    fn apply_to_sensors(&self, document: &mut Node) {
        let Some(table) = document.as_table_mut() else { return };
        if let Some(Node { value: Value::List(cameras), .. }) = table.get_mut("cameras") {
            cameras.iter_mut().filter_map(sensor_of_entry).for_each(|sensor| self.set(sensor));
        } else if let Some(sensor) = table.get_mut("sensor") {
            self.set(sensor);
        }
    }

    /// Sets the key in `table`.
    fn set(&self, table: &mut Node) {
        let key: Arc<str> = join(&table.place.key(), self.key).into();
        let place = self.place(table, &key);
        let at = |key: &Arc<str>| Place::set(place.file().into(), self.text.clone(), key.clone());
        let value =
            parse_override(&self.value, &key, &at).map_or_else(|| Value::Text(self.value.clone()), |node| node.value);
        let Some(table) = table.as_table_mut() else { return };
        table.remove(self.key);
        let node = Node { place: place.clone(), value };
        table.entries.push(Entry { key: self.key.to_owned(), place, node });
    }

    fn place(&self, node: &Node, key: &str) -> Place {
        Place::flag(node.place.file().into(), self.text.clone(), key.into())
    }
}

/// Returns the sensor of a camera of a job, in its entry or in its file.
fn sensor_of_entry(entry: &mut Node) -> Option<&mut Node> {
    let entry = entry.as_table_mut()?;
    let is_in_file = entry.get("file").is_some_and(|file| file.as_table().is_some());
    let camera = if is_in_file { entry.get_mut("file")?.as_table_mut()? } else { entry };
    camera.get_mut("sensor")
}

fn note_missing_value(document: &Node, text: &ChangeText, errors: &mut DescriptionErrors) {
    let place = text.place(document.place.file(), "");
    errors.add(
        ErrorCode::InvalidChange,
        &place,
        "expected key=value",
        "give a dotted key, \"=\" and a value: render.spp=16",
    );
}

/// The value that removes a key.
const REMOVED: &str = "null";

/// Maximum number of parts of a key: the nesting depth of the TOML reader. No description comes near it.
const MAX_KEY_PARTS: usize = 80;

fn note_too_deep(document: &Node, text: &ChangeText, parts: usize, errors: &mut DescriptionErrors) {
    let place = text.place(document.place.file(), "");
    let problem = format!("this key has {parts} parts; at most {MAX_KEY_PARTS} are possible");
    errors.add(ErrorCode::InvalidChange, &place, problem, "correct the key: render.spp=16");
}

/// One `key=value`.
struct KeyOverride<'t> {
    text: &'t ChangeText,
    path: Vec<&'t str>,
    value: &'t str,
}

impl<'t> KeyOverride<'t> {
    fn parse(text: &'t ChangeText) -> Option<Self> {
        let (key, value) = text.text.split_once('=')?;
        let path: Vec<_> = key.trim().split('.').map(str::trim).collect();
        let is_complete = path.iter().all(|part| !part.is_empty()) && !value.trim().is_empty();
        is_complete.then_some(Self { text, path, value: value.trim() })
    }

    /// True if the change selects a file to read.
    fn names_file(&self) -> bool {
        matches!(self.path.as_slice(), ["scene"] | ["cameras", _, "file"])
    }

    /// Path in the document, where the tree of a camera's file is stored under "file".
    fn path_through_files(&self, document: &Node) -> Vec<&'t str> {
        let mut path = self.path.clone();
        if let ["cameras", camera, "lens" | "sensor" | "isp" | "external_optics" | "effects", ..] = self.path.as_slice()
            && is_in_file(document, camera)
        {
            path.insert(2, "file");
        }
        path
    }

    fn apply(&self, document: &mut Node, errors: &mut DescriptionErrors) {
        let path = self.path_through_files(document);
        let Some((last, parents)) = path.split_last() else { return };
        let mut node = document;
        for part in parents {
            let Some(next) = self.step(node, part, errors) else { return };
            node = next;
        }
        if self.value == REMOVED { self.remove(node, last, errors) } else { self.set_value(node, last, errors) }
    }

    /// Removes the entry `last` from `node`; reports an error if it is absent.
    fn remove(&self, node: &mut Node, last: &str, errors: &mut DescriptionErrors) {
        let place = self.text.place(node.place.file(), &join(&node.place.key(), last));
        let parent = node.place.key().into_owned();
        let is_taken = match &mut node.value {
            Value::Table(table) => table.remove(last).is_some(),
            Value::List(list) => find_entry(list, last).map(|at| list.remove(at)).is_some(),
            Value::Unreadable => true,
            _ => false,
        };
        if is_taken {
            return;
        }
        let names: Vec<&str> = match &node.value {
            Value::Table(table) => table.entries.iter().map(|entry| entry.key.as_str()).collect(),
            Value::List(list) => list.iter().filter_map(Node::name).collect(),
            _ => Vec::new(),
        };
        let hint = nearest(last, &names).map_or(String::new(), |near| format!("did you mean \"{near}\"? "));
        let within = if parent.is_empty() { String::new() } else { format!(" in \"{parent}\"") };
        let problem = format!("there is no \"{last}\"{within} to remove");
        errors.add(ErrorCode::InvalidChange, &place, problem, format!("{hint}correct the key, or omit the change"));
    }

    /// Returns the entry `part` of `node`; an absent table is created.
    fn step<'n>(&self, node: &'n mut Node, part: &str, errors: &mut DescriptionErrors) -> Option<&'n mut Node> {
        let parent = node.place.key().into_owned();
        let place = self.text.place(node.place.file(), &join(&parent, part));
        match &mut node.value {
            Value::Table(table) => Some(entry_or_table(table, part, &place)),
            Value::List(list) => entry_of_list(list, part, &place, errors),
            Value::Unreadable => None,
            _ => {
                errors.add(
                    ErrorCode::InvalidChange,
                    &place,
                    format!("\"{parent}\" is not a table and has no key \"{part}\""),
                    "correct the key",
                );
                None
            }
        }
    }

    fn set_value(&self, node: &mut Node, last: &str, errors: &mut DescriptionErrors) {
        let file: Arc<Path> = node.place.file().into();
        let key = join(&node.place.key(), last);
        let place = self.text.place(&file, &key);
        let value = parse_override(self.value, &key, &|key| self.text.place(&file, key))
            .unwrap_or_else(|| Node { place: place.clone(), value: Value::Text(self.value.to_owned()) });
        match &mut node.value {
            Value::Table(table) => match table.get_mut(last) {
                Some(old) => *old = value,
                None => table.entries.push(Entry { key: last.to_owned(), place, node: value }),
            },
            Value::List(list) => {
                if let Some(old) = entry_of_list(list, last, &place, errors) {
                    *old = value;
                }
            }
            Value::Unreadable => {}
            _ => errors.add(
                ErrorCode::InvalidChange,
                &place,
                format!("there is no table for \"{last}\""),
                "correct the key",
            ),
        }
    }
}

/// True if the camera has its lens, sensor and processing in a file.
fn is_in_file(document: &Node, camera: &str) -> bool {
    let cameras = document.as_table().and_then(|job| job.get("cameras")).map_or(&[][..], Node::as_list);
    let entry = find_entry(cameras, camera).and_then(|i| cameras[i].as_table());
    let file = entry.and_then(|entry| entry.get("file"));
    file.is_some_and(|file| matches!(file.value, Value::Table(_) | Value::Unreadable))
}

/// Index of the entry with that name or number.
fn find_entry(list: &[Node], part: &str) -> Option<usize> {
    let by_name = list.iter().position(|n| n.name() == Some(part));
    by_name.or_else(|| part.parse().ok().filter(|i| *i < list.len()))
}

fn entry_or_table<'n>(table: &'n mut Table, part: &str, place: &Place) -> &'n mut Node {
    let index = table.entries.iter().position(|e| e.key == part).unwrap_or_else(|| {
        let node = Node { place: place.clone(), value: Value::Table(Table::default()) };
        table.entries.push(Entry { key: part.to_owned(), place: place.clone(), node });
        table.entries.len() - 1
    });
    &mut table.entries[index].node
}

fn entry_of_list<'n>(
    list: &'n mut [Node],
    part: &str,
    place: &Place,
    errors: &mut DescriptionErrors,
) -> Option<&'n mut Node> {
    let entry = find_entry(list, part);
    if entry.is_none() {
        note_missing_entry(list, part, place, errors);
    }
    entry.map(|i| &mut list[i])
}

fn note_missing_entry(list: &[Node], part: &str, place: &Place, errors: &mut DescriptionErrors) {
    let names: Vec<_> = list.iter().filter_map(Node::name).collect();
    let hint = nearest(part, &names).map_or(String::new(), |n| format!("did you mean \"{n}\"? "));
    let entries = if names.is_empty() { String::new() } else { format!(", or a name: {}", names.join(", ")) };
    let remedy = match list.len() {
        0 => "the list is empty; remove the override".to_owned(),
        1 => format!("{hint}give the number 0{entries}"),
        n => format!("{hint}give a number from 0 to {}{entries}", n - 1),
    };
    errors.add(ErrorCode::UnknownName, place, format!("there is no entry \"{part}\""), remedy);
}
