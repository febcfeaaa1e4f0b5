//! Where the files of one camera go.

use crate::failure::Failure;
use crate::files::Files;
use etendue_io::exr::{EncodeError, encode_spectral};
use etendue_io::{OutputFolder, Provenance, sidecar};
use etendue_pipeline::photograph::Light;

/// Where the results of one camera go.
pub struct Results<'a> {
    /// Folder of the camera within the output folder.
    pub prefix: String,
    /// The output folder.
    pub folder: &'a mut OutputFolder,
}

impl Results<'_> {
    /// Writes a file.
    pub fn write(&mut self, name: &str, bytes: Result<Vec<u8>, EncodeError>) -> Result<(), Failure> {
        let name = format!("{}/{name}", self.prefix);
        let bytes = bytes.map_err(|error| Failure::Run(format!("{name}: {error}")))?;
        self.folder.write(&name, &bytes).map_err(Failure::run)
    }

    /// Writes a side-car.
    pub fn json(&mut self, name: &str, facts: &serde_json::Value) -> Result<(), Failure> {
        let bytes = sidecar::encode(facts).map_err(|error| Failure::Run(format!("{name}: {error}")))?;
        self.write(name, Ok(bytes))
    }

    /// Writes an irradiance image.
    pub fn irradiance(&mut self, light: &Light, variance: bool, facts: &Provenance) -> Result<(), Failure> {
        let Some(cube) = &light.irradiance else { return Ok(()) };
        let variance = light.irradiance_variance.as_ref().filter(|_| variance);
        self.write(Files::IRRADIANCE, encode_spectral(cube, variance, facts))
    }

    /// Writes the part of the irradiance that is ghosts.
    pub fn ghosts(&mut self, light: &Light, facts: &Provenance) -> Result<(), Failure> {
        let Some(cube) = &light.ghosts else { return Ok(()) };
        self.write(Files::GHOSTS, encode_spectral(cube, None, facts))
    }
}
