//! File formats of images.

use crate::fault::{DescriptionErrors, ErrorCode};
use crate::place::Placed;
use crate::reader::words;

words! {
    /// File format of an image.
    pub enum PictureFormat {
        /// Lossless.
        "png" => Png,
        /// Lossy, 8 bits.
        "jpeg" => Jpeg,
    }
}

/// Checks that bits and quality fit the format.
pub(super) fn check(
    format: Option<&Placed<PictureFormat>>,
    bits: Option<&Placed<u64>>,
    quality: Option<&Placed<u64>>,
    errors: &mut DescriptionErrors,
) {
    let jpeg = format.is_some_and(|f| f.value == PictureFormat::Jpeg);
    if let Some(bits) = bits.filter(|bits| jpeg && bits.value != 8) {
        errors.add(
            ErrorCode::UnsupportedOutput,
            &bits.place,
            format!("a JPEG cannot store {} bits", bits.value),
            "give 8, or picture_format = \"png\"",
        );
    }
    if let Some(quality) = quality.filter(|_| !jpeg) {
        errors.add(
            ErrorCode::NoEffect,
            &quality.place,
            "\"jpeg_quality\" has no effect on PNG",
            "remove it, or add picture_format = \"jpeg\"",
        );
    }
}
