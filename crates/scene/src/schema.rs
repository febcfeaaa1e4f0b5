//! JSON Schema of the files, for editors; made of the same rules that read them.

use serde_json::{Value as Json, json};

use crate::reader::{Record, Rule as _, record};
use crate::record::{Camera, Job, Scene};

/// The kinds of file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FileKind {
    /// What is seen.
    Scene,
    /// Lens, sensor, processing.
    Camera,
    /// What is rendered.
    Job,
}

/// The JSON Schema (draft 2020-12) of a kind of file.
#[must_use]
pub fn schema(kind: FileKind) -> Json {
    match kind {
        FileKind::Scene => file_schema::<Scene>("Étendue scene"),
        FileKind::Camera => file_schema::<Camera>("Étendue camera"),
        FileKind::Job => file_schema::<Job>("Étendue job"),
    }
}

/// The schema of a record at the head of a file.
fn file_schema<T: Record>(title: &str) -> Json {
    let mut schema = record::<T>().schema();
    schema["$schema"] = json!("https://json-schema.org/draft/2020-12/schema");
    schema["title"] = json!(title);
    schema["properties"]["format"] = json!({ "const": 1, "description": "The version of the format: 1." });
    if let Some(required) = schema["required"].as_array_mut() {
        required.insert(0, json!("format"));
    }
    schema
}
