//! JSON Schema of the files, for editors; derived from the same rules that read them.

use serde_json::{Value as Json, json};

use crate::reader::{Record, Rule as _, record};
use crate::record::variations::Variations;
use crate::record::weather::Weather;
use crate::record::{Camera, DataSheet, Job, Laboratory, Scene};

/// The kinds of file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FileKind {
    /// Scene.
    Scene,
    /// Lens, sensor, processing.
    Camera,
    /// Job.
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
        FileKind::Scene => based::<Scene>("Étendue scene"),
        FileKind::Camera => based::<Camera>("Étendue camera"),
        FileKind::Job => based::<Job>("Étendue job"),
        FileKind::DataSheet => unbased::<DataSheet>("EMVA 1288 data sheet"),
        FileKind::Weather => unbased::<Weather>("Étendue weather"),
        FileKind::Variations => unbased::<Variations>("Étendue variations"),
        FileKind::Laboratory => unbased::<Laboratory>("Étendue laboratory"),
    }
}

/// A file that extends no other.
fn unbased<T: Record>(title: &str) -> Json {
    let mut schema = whole::<T>();
    head(&mut schema, title);
    schema
}

fn head(schema: &mut Json, title: &str) {
    schema["$schema"] = json!("https://json-schema.org/draft/2020-12/schema");
    schema["title"] = json!(title);
}

/// A file that is complete, or extends another.
fn based<T: Record>(title: &str) -> Json {
    let mut schema = json!({ "if": { "required": ["base"] }, "then": derived::<T>(), "else": whole::<T>() });
    head(&mut schema, title);
    schema
}

/// The schema of a record at the head of a file.
fn whole<T: Record>() -> Json {
    let mut schema = record::<T>().schema();
    schema["properties"]["format"] = format();
    if let Some(required) = schema["required"].as_array_mut() {
        required.insert(0, json!("format"));
    }
    schema
}

/// A file merged over another: any part of it may be missing, so only the names of its keys are given.
fn derived<T: Record>() -> Json {
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
