//! `etendue schema`: the JSON Schema of a file kind.

use crate::console::Console;
use clap::Args;
use etendue::Error;
use etendue_arguments::{Word, choice};
use etendue_scene::{FileKind, schema};

const KINDS: [Word<FileKind>; 7] = [
    (FileKind::Scene, "scene", "Geometry, materials, lights"),
    (FileKind::Camera, "camera", "Lens, sensor, processing"),
    (FileKind::Job, "job", "Scene, cameras, render and output settings"),
    (FileKind::DataSheet, "datasheet", "What `etendue datasheet` reads"),
    (FileKind::Variations, "variations", "What `etendue dataset` varies from sample to sample"),
    (FileKind::Laboratory, "laboratory", "What `etendue characterise` reads beside pictures"),
    (FileKind::Weather, "weather", "What `etendue weather` lays over stored radiance"),
];

/// `etendue schema`
#[derive(Debug, Args)]
pub struct Schema {
    /// The kind of file
    #[arg(value_parser = choice(KINDS))]
    pub kind: FileKind,
}

impl Schema {
    pub fn run(&self, console: &dyn Console) -> Result<(), Error> {
        let text = serde_json::to_string_pretty(&schema(self.kind)).map_err(|error| Error::Run(error.to_string()))?;
        console.print_json(&format!("{text}\n"));
        Ok(())
    }
}
