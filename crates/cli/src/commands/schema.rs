//! `etendue schema`: the JSON Schema of a file kind.

use crate::args::{self, SchemaKind};
use crate::output::print;
use etendue::Error;
use etendue_scene::{FileKind, schema};

pub fn run(arguments: &args::Schema) -> Result<(), Error> {
    let kind = match arguments.kind {
        SchemaKind::Scene => FileKind::Scene,
        SchemaKind::Camera => FileKind::Camera,
        SchemaKind::Job => FileKind::Job,
        SchemaKind::Datasheet => FileKind::DataSheet,
    };
    let text = serde_json::to_string_pretty(&schema(kind)).map_err(|error| Error::Run(error.to_string()))?;
    print(&format!("{text}\n"));
    Ok(())
}
