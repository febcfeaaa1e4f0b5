//! The side-car of this program beside a picture.

use std::path::{Path, PathBuf};

use serde_json::Value;

use super::Encoding;
use crate::{Error, sidecar};

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
        for candidate in NAMES.map(|name| folder.join(name)).into_iter().filter(|candidate| candidate.is_file()) {
            let said = sidecar::read(&candidate)?;
            if said["program"] == "etendue" && !said["files"][&picture].is_null() {
                return Ok(Some(SideCar { file: candidate, said, picture }));
            }
        }
    }
    Ok(None)
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
    pub(super) fn correlated_block_px(&self) -> Result<u32, Error> {
        let stated = &self.said["sampling"]["correlated_block_px"];
        if stated.is_null() {
            return Ok(1);
        }
        let number = stated.as_u64().and_then(|n| u32::try_from(n).ok()).filter(|n| *n > 0);
        let strange = || {
            format!(
                "its sampling.correlated_block_px is {stated}, where a whole number above 0 is expected; render again"
            )
        };
        number.ok_or_else(|| Error::new(&self.file, strange()))
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
