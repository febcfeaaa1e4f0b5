//! The side-car of this program beside a picture.

use std::path::{Path, PathBuf};

use serde_json::Value;

use super::Encoding;
use crate::Error;
use crate::source::{decode_text, read_description_bytes};

/// Names of side-cars: of a render, and of a development.
const NAMES: [&str; 2] = ["camera.json", "develop.json"];

/// A side-car that lists a picture.
pub(super) struct SideCar {
    /// Its file.
    pub file: PathBuf,
    /// All that it says.
    pub said: Value,
    /// The picture's name in its list.
    pub picture: String,
}

/// The side-car that lists `file`: in its folder, or in the folder around it, as that of undistorted pictures is.
pub(super) fn beside(file: &Path) -> Result<Option<SideCar>, Error> {
    let Some(name) = file.file_name().and_then(|name| name.to_str()) else { return Ok(None) };
    let folder = file.parent().unwrap_or(Path::new(""));
    let within = folder.file_name().and_then(|folder| folder.to_str());
    let outer = within.zip(folder.parent()).map(|(within, outer)| (outer, format!("{within}/{name}")));
    for (folder, picture) in [(folder, name.to_owned())].into_iter().chain(outer) {
        for sidecar in NAMES.map(|name| folder.join(name)).into_iter().filter(|sidecar| sidecar.is_file()) {
            let said = read(&sidecar)?;
            if said["program"] == "etendue" && !said["files"][&picture].is_null() {
                return Ok(Some(SideCar { file: sidecar, said, picture }));
            }
        }
    }
    Ok(None)
}

fn read(file: &Path) -> Result<Value, Error> {
    let bytes = read_description_bytes(file, "side-car")?;
    serde_json::from_str(decode_text(file, &bytes)?)
        .map_err(|cause| Error::new(file, format!("not JSON ({cause}); remove it, or render again")))
}

impl SideCar {
    /// The name of its file.
    pub(super) fn name(&self) -> String {
        self.file.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned())
    }

    /// What it says of the picture.
    pub(super) fn entry(&self) -> &Value {
        &self.said["files"][&self.picture]
    }

    /// Pixels whose errors may be equal, because their paths shared what they found.
    pub(super) fn correlated_block_px(&self) -> u32 {
        let stated = self.said["sampling"]["correlated_block_px"].as_u64();
        stated.and_then(|n| u32::try_from(n).ok()).filter(|n| *n > 0).unwrap_or(1)
    }

    /// How the picture's numbers are encoded, where it says so.
    pub(super) fn encoding(&self) -> Result<Option<Encoding>, Error> {
        let said = &self.entry()["encoding"];
        let strange = || {
            let problem = format!("it states an unknown encoding of {}; render again", self.picture);
            Error::new(&self.file, problem)
        };
        if said.is_null() { Ok(None) } else { Encoding::from_json(said).map(Some).ok_or_else(strange) }
    }
}
