//! Pictures as a display shows them, in memory.

use crate::error::Error;
use crate::results::CameraResults;
use etendue_core::Plane;
use etendue_core::quantity::Display;
use etendue_io::photograph::Encoding;
use etendue_io::png::encode_display;

impl CameraResults {
    /// The first frame's picture as a display shows it, 0 to 1; `None` where the camera has no processing.
    #[must_use]
    pub fn display_picture(&self) -> Option<Plane<Display>> {
        self.frames().next()?.picture.map(|developed| developed.display)
    }
}

/// A display picture as an 8-bit PNG that says it is sRGB.
///
/// # Errors
/// Where it cannot be encoded.
pub fn display_png(picture: &Plane<Display>) -> Result<Vec<u8>, Error> {
    encode_display(picture, &Encoding::Srgb).map_err(|error| Error::Run(error.to_string()))
}
