//! The tables of the files: each record once, with all its places.

use etendue_scene::FileKind;
use serde_json::Value as Json;

use super::keys::keys_of;

/// A kind of file, with its page.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum File {
    Scene,
    Camera,
    Job,
    DataSheet,
    Weather,
    Variations,
    Laboratory,
}

impl File {
    /// Search order of tables: tables of files of their own come before the job that may contain them.
    pub(super) const ALL: [Self; 7] =
        [Self::Scene, Self::Camera, Self::Job, Self::DataSheet, Self::Weather, Self::Variations, Self::Laboratory];

    pub(super) fn word(self) -> &'static str {
        match self {
            Self::Scene => "scene",
            Self::Camera => "camera",
            Self::Job => "job",
            Self::DataSheet => "datasheet",
            Self::Weather => "weather",
            Self::Variations => "variations",
            Self::Laboratory => "laboratory",
        }
    }

    /// The schema of a complete file, not of one over a base.
    fn schema(self) -> Json {
        let schema = etendue_scene::schema(match self {
            Self::Scene => FileKind::Scene,
            Self::Camera => FileKind::Camera,
            Self::Job => FileKind::Job,
            Self::DataSheet => FileKind::DataSheet,
            Self::Weather => FileKind::Weather,
            Self::Variations => FileKind::Variations,
            Self::Laboratory => FileKind::Laboratory,
        });
        schema.get("else").unwrap_or(&schema).clone()
    }
}

/// Notation of a table at its place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum TableNotation {
    /// `[x]`
    Table,
    /// `[[x]]`
    List,
    /// An entry of a list that may also hold other values: `x = [{ … }]`.
    Entry,
}

/// Place of a table: the file and the keys that lead to it, none for the file itself.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct TableLocation {
    pub(super) file: File,
    keys: Vec<String>,
    brackets: TableNotation,
}

impl TableLocation {
    fn head(file: File) -> Self {
        Self { file, keys: Vec::new(), brackets: TableNotation::Table }
    }

    fn child(&self, key: &str) -> Self {
        let keys = self.keys.iter().map(String::as_str).chain([key]).map(str::to_owned).collect();
        Self { file: self.file, keys, brackets: TableNotation::Table }
    }

    fn with(&self, brackets: TableNotation) -> Self {
        Self { brackets, ..self.clone() }
    }

    pub(super) fn depth(&self) -> usize {
        self.keys.len()
    }

    /// The table's header in TOML, as code.
    pub(super) fn header(&self) -> String {
        let keys = self.keys.join(".");
        match self.brackets {
            TableNotation::Table => format!("`[{keys}]`"),
            TableNotation::List => format!("`[[{keys}]]`"),
            TableNotation::Entry => format!("`{keys} = [{{ … }}]`"),
        }
    }

    /// The anchor on the file's page: `sensor-dark`.
    pub(super) fn anchor(&self) -> String {
        match self.keys.as_slice() {
            [] => self.file.word().to_owned(),
            keys => keys.join("-").replace(['<', '>'], ""),
        }
    }
}

/// A record and all its places.
#[derive(Debug)]
pub(super) struct Section {
    pub(super) schema: Json,
    pub(super) places: Vec<TableLocation>,
}

impl Section {
    /// The file on whose page the record is described; none if it occurs in several kinds of file.
    pub(super) fn file(&self) -> Option<File> {
        let file = self.places[0].file;
        self.places.iter().all(|place| place.file == file).then_some(file)
    }
}

/// The records of all files, parents before their children.
pub(super) fn sections() -> Vec<Section> {
    let mut sections = Vec::new();
    for file in File::ALL {
        meet_table(&mut sections, &file.schema(), &TableLocation::head(file));
    }
    sections.iter_mut().for_each(|section| section.places.sort_by_key(TableLocation::depth));
    sections
}

fn meet_table(sections: &mut Vec<Section>, schema: &Json, place: &TableLocation) {
    let schema = plain(schema);
    let known = sections.iter_mut().find(|section| section.schema == schema);
    // A job may contain tables from the top level of other files; their rules describe them completely.
    let holds = |section: &Section| section.places.iter().any(|p| p.file != place.file && p.depth() <= 1);
    match known {
        Some(section) if section.places.contains(place) || holds(section) => return,
        Some(section) => section.places.push(place.clone()),
        None => sections.push(Section { schema: schema.clone(), places: vec![place.clone()] }),
    }
    let forms = schema["oneOf"].as_array().cloned().unwrap_or_else(|| vec![schema.clone()]);
    for (key, value) in forms.iter().flat_map(|form| keys_of(std::slice::from_ref(form))) {
        meet_value(sections, &value, &place.child(&key));
    }
}

/// Collects the tables that a value may be or contain.
fn meet_value(sections: &mut Vec<Section>, schema: &Json, place: &TableLocation) {
    let items = &schema["items"];
    if is_table(schema) {
        meet_table(sections, schema, place);
    } else if let Some(options) = schema["anyOf"].as_array() {
        options.iter().for_each(|option| meet_value(sections, option, place));
    } else if is_table(items) {
        meet_table(sections, items, &place.with(TableNotation::List));
    } else if let Some(options) = items["anyOf"].as_array() {
        options.iter().filter(|o| is_table(o)).for_each(|o| meet_table(sections, o, &place.with(TableNotation::Entry)));
    } else if schema["additionalProperties"].is_object() {
        meet_value(sections, &schema["additionalProperties"], &place.child("<name>"));
    }
}

pub(super) fn is_table(schema: &Json) -> bool {
    schema.get("properties").is_some() || schema.get("oneOf").is_some()
}

/// The schema without keys of the top level of a file.
pub(super) fn plain(schema: &Json) -> Json {
    let mut schema = schema.clone();
    if let Some(table) = schema.as_object_mut() {
        ["$schema", "title", "description"].iter().for_each(|k| {
            table.remove(*k);
        });
        // The format's number; a key of that name in a table is an ordinary key.
        if table.get("properties").is_some_and(|p| p["format"].get("const").is_some()) {
            table.get_mut("properties").and_then(Json::as_object_mut).map(|p| p.remove("format"));
            table.get_mut("required").and_then(Json::as_array_mut).iter_mut().for_each(|r| r.retain(|k| k != "format"));
        }
    }
    schema
}
