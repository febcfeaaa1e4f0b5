//! Writer of one camera's files.

use etendue_core::quantity::Irradiance;
use etendue_io::exr::{EncodeError, ExrImage, SpectralBands, spectral_image};
use etendue_io::failure::Error;
use etendue_io::{OutputFolder, Provenance, sidecar};
use etendue_pipeline::photograph::Light;
use rayon::prelude::*;

/// Makes the bytes of a file.
pub(crate) type Encoder<'a> = Box<dyn FnOnce() -> Result<Vec<u8>, EncodeError> + Send + 'a>;

/// Destination of one camera's results.
pub(crate) struct ResultWriter<'a> {
    /// Folder of the camera within the output folder.
    pub(crate) prefix: String,
    /// The output folder.
    pub(crate) folder: &'a mut OutputFolder,
}

impl ResultWriter<'_> {
    /// Fails early if a result already exists.
    pub(crate) fn check_absent(&self, name: &str) -> Result<(), Error> {
        self.folder.claim([format!("{}/{name}", self.prefix).as_str()]).map_err(Error::input)
    }

    /// Writes a file.
    pub(crate) fn write(&mut self, name: &str, bytes: Result<Vec<u8>, EncodeError>) -> Result<(), Error> {
        let name = format!("{}/{name}", self.prefix);
        let bytes = bytes.map_err(|error| Error::Run(format!("{name}: {error}")))?;
        self.folder.write(&name, &bytes).map_err(Error::run)
    }

    /// Writes an EXR file, some rows at a time.
    pub(crate) fn exr(&mut self, name: &str, image: ExrImage<'_>) -> Result<(), Error> {
        write_exr(self.folder, &format!("{}/{name}", self.prefix), image)
    }

    /// Writes files in order, encoded in parallel on the caller's thread pool.
    pub(crate) fn write_all(&mut self, files: Vec<(String, Encoder<'_>)>) -> Result<(), Error> {
        let encoded: Vec<_> = files.into_par_iter().map(|(name, encode)| (name, encode())).collect();
        encoded.into_iter().try_for_each(|(name, bytes)| self.write(&name, bytes))
    }

    /// Writes a side-car.
    pub(crate) fn json(&mut self, name: &str, facts: &serde_json::Value) -> Result<(), Error> {
        let bytes = sidecar::encode(facts).map_err(|error| Error::Run(format!("{name}: {error}")))?;
        self.write(name, Ok(bytes))
    }

    /// Writes an irradiance image.
    pub(crate) fn irradiance(
        &mut self,
        name: &str,
        light: &Light,
        variance: bool,
        facts: &Provenance,
    ) -> Result<(), Error> {
        let Some(cube) = &light.irradiance else { return Ok(()) };
        let variance = light.irradiance_variance.as_ref().filter(|_| variance);
        self.exr(name, spectral_image::<Irradiance>(SpectralBands::from_stored(cube, variance), facts))
    }

    /// Writes the ghosts as part of the irradiance.
    pub(crate) fn ghosts(&mut self, name: &str, light: &Light, facts: &Provenance) -> Result<(), Error> {
        let Some(cube) = &light.ghosts else { return Ok(()) };
        self.exr(name, spectral_image::<Irradiance>(SpectralBands::from_stored(cube, None), facts))
    }
}

/// Writes an EXR file into a folder, some rows at a time.
pub(crate) fn write_exr(folder: &mut OutputFolder, name: &str, image: ExrImage<'_>) -> Result<(), Error> {
    let mut failure = None;
    let written = folder.write_with(name, |file| {
        image.write_to(file).map_err(|cause| {
            let io_error = std::io::Error::other(cause.to_string());
            failure = Some(cause);
            io_error
        })
    });
    match failure {
        // The folder's error names the file.
        Some(EncodeError::Write(_)) | None => written.map_err(Error::run),
        Some(cause) => Err(Error::Run(format!("{name}: {cause}"))),
    }
}
