//! JSON Schema of the files, for editors; derived from the same rules that read them.

use serde_json::{Value as Json, json};

use crate::reader::{Record, Rule as _, record};
use crate::record::variations::Variations;
use crate::record::weather::Weather;
use crate::record::{Camera, DataSheet, Job, Laboratory, Scene};

/// The kinds of file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FileKind {
    Scene,
    /// Lens, sensor, processing.
    Camera,
    Job,
    /// Data sheet of a camera's maker after EMVA 1288.
    DataSheet,
    /// Weather for stored radiance.
    Weather,
    /// Differences between the samples of a data set.
    Variations,
    /// Facts about a laboratory folder that its images do not contain.
    Laboratory,
}

/// Returns the JSON Schema (draft 2020-12) of a kind of file. For jobs, scenes and cameras it is a choice: a file with a `base` ("then") may omit
/// keys of the base, all others ("else") are complete.
#[must_use]
pub fn schema(kind: FileKind) -> Json {
    match kind {
        FileKind::Scene => file_with_base::<Scene>("Étendue scene"),
        FileKind::Camera => file_with_base::<Camera>("Étendue camera"),
        FileKind::Job => file_with_base::<Job>("Étendue job"),
        FileKind::DataSheet => complete_file::<DataSheet>("EMVA 1288 data sheet"),
        FileKind::Weather => complete_file::<Weather>("Étendue weather"),
        FileKind::Variations => complete_file::<Variations>("Étendue variations"),
        FileKind::Laboratory => complete_file::<Laboratory>("Étendue laboratory"),
    }
}

/// A file that extends no other.
fn complete_file<T: Record>(title: &str) -> Json {
    let mut schema = record_at_head::<T>();
    head(&mut schema, title);
    schema
}

fn head(schema: &mut Json, title: &str) {
    schema["$schema"] = json!("https://json-schema.org/draft/2020-12/schema");
    schema["title"] = json!(title);
}

/// A file that is complete, or extends another.
fn file_with_base<T: Record>(title: &str) -> Json {
    let mut schema =
        json!({ "if": { "required": ["base"] }, "then": partial_file::<T>(), "else": record_at_head::<T>() });
    head(&mut schema, title);
    schema
}

/// The schema of a record at the head of a file.
fn record_at_head<T: Record>() -> Json {
    let mut schema = record::<T>().schema();
    schema["properties"]["format"] = format();
    if let Some(required) = schema["required"].as_array_mut() {
        required.insert(0, json!("format"));
    }
    schema
}

/// A file merged over another: any part of it may be missing, so only the names of its keys are given.
fn partial_file<T: Record>() -> Json {
    let base = "The path of a file of this kind, which this file extends and overrides.";
    let removed = "Dotted keys of entries that are removed from the base: \"environment\", \"lights.sun\".";
    let mut properties = json!({
        "format": format(),
        "base": { "type": "string", "description": base },
        "remove": { "type": "array", "items": { "type": "string" }, "description": removed },
    });
    T::keys().into_iter().for_each(|key| properties[key] = json!({}));
    json!({ "type": "object", "properties": properties, "required": ["format", "base"], "additionalProperties": false })
}

fn format() -> Json {
    json!({ "const": 1, "description": "The version of the format: 1." })
}
