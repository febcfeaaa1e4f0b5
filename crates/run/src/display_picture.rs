//! Pictures as a display shows them, in memory.

use crate::results::CameraResults;
use etendue_core::Plane;
use etendue_core::quantity::Display;
use etendue_io::failure::Error;
use etendue_io::jpeg::encode_jpeg;

impl CameraResults {
    /// The first frame's picture as a display shows it, 0 to 1; `None` where the camera has no processing.
    #[must_use]
    pub fn display_picture(&self) -> Option<Plane<Display>> {
        self.frames().next()?.picture.map(|developed| developed.display)
    }
}

/// A display picture as a JPEG of a quality from 1 to 100.
///
/// # Errors
/// Where it cannot be encoded.
pub fn display_jpeg(picture: &Plane<Display>, quality: u8) -> Result<Vec<u8>, Error> {
    encode_jpeg(picture, quality).map_err(|error| Error::Run(error.to_string()))
}
