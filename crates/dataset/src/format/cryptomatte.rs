//! Cryptomatte (Psyop's specification 1.2.0): `cryptomatte/SPLIT/NAME.exr`, and the image with the same name.
//!
//! The layers `CryptoObject` and `CryptoMaterial` hold, for each pixel, the objects and the materials with the largest coverage, through the lens and over the
//! exposure ([`etendue_io::exr::cryptomatte_image`]); names are those of the scene. Unlike masks, which sample the pixel's centre, they have antialiased edges.

use etendue::{Error, OutputFolder};

use crate::records::{FormatWriter, Records, write};
use crate::{picture::SampleImage, set::Set};

pub(super) struct Cryptomatte;

impl FormatWriter for Cryptomatte {
    fn write_image(&self, _set: &Set, image: &SampleImage<'_>, folder: &mut OutputFolder) -> Result<(), Error> {
        let (sample, split) = image.sample;
        let stem = format!("cryptomatte/{}/{}", split.name(), image.record.stem(sample));
        write(folder, &format!("{stem}.{}", image.record.extension), &image.bytes)?;
        write(folder, &format!("{stem}.exr"), image.cryptomatte()?)
    }

    fn finish(&self, _set: &Set, _records: &Records, _folder: &mut OutputFolder) -> Result<(), Error> {
        Ok(())
    }
}
