//! What the side-car beside a file says.

use etendue::Error;
use etendue_io::sidecar;
use serde_json::Value;
use std::path::Path;

/// A side-car `camera.json`, or nothing.
#[derive(Clone, Debug, Default)]
pub(crate) struct SideCar {
    said: Value,
}

impl SideCar {
    /// The side-car of a folder, or of the folder about it, as that of an undistorted twin is.
    ///
    /// # Errors
    /// Where there is one and it is no JSON.
    pub(crate) fn of(folder: &Path) -> Result<Self, Error> {
        let about = folder.parent().filter(|_| folder.ends_with("undistorted"));
        let files = [Some(folder), about].into_iter().flatten().map(|folder| folder.join("camera.json"));
        let Some(file) = files.into_iter().find(|file| file.is_file()) else { return Ok(Self::default()) };
        let said = sidecar::read(&file).map_err(Error::input)?;
        Ok(Self { said })
    }

    /// What it says at a place, `null` where nothing.
    pub(super) fn at(&self, path: &[&str]) -> &Value {
        path.iter().fold(&self.said, |value, key| &value[*key])
    }

    /// What it says of a file: quantity and unit; empty where nothing.
    pub(super) fn entry(&self, name: &str) -> [&str; 2] {
        let entry = self.at(&["files", name]);
        ["quantity", "unit"].map(|key| entry[key].as_str().unwrap_or(""))
    }
}
