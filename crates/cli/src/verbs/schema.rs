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
    (FileKind::DataSheet, "datasheet", "Input of `etendue datasheet`"),
    (FileKind::Variations, "variations", "Variations between the samples of `etendue dataset`"),
    (FileKind::Laboratory, "laboratory", "Input of `etendue characterise` in addition to images"),
    (FileKind::Weather, "weather", "Weather that `etendue weather` applies to stored radiance"),
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
