//! Small EXR files for the tests of this crate.

use super::encode::ExrImage;
use crate::Provenance;

/// Image whose channels of these names are `value` everywhere.
pub(crate) fn small_exr(width: usize, height: usize, names: &[&str], value: f32) -> Vec<u8> {
    let mut image = ExrImage::new(width, height, &Provenance::default());
    for name in names {
        image.float(*name, vec![value; width * height]);
    }
    image.into_bytes().expect("a small picture")
}
