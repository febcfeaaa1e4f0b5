//! The print of a texture: a picture in sRGB encoding.

use super::{ChartFile, Contents};
use crate::drawing::Texture;
use etendue_spectra::colour::encode;

/// A texture encoded as sRGB, for the print.
pub(super) fn print_of(texture: &Texture) -> ChartFile {
    let encoded = |v: &u16| (encode(f32::from(*v) / 65_535.0) * 65_535.0).round() as u16;
    let values = texture.values.iter().map(encoded).collect();
    ChartFile { name: print_name(texture), contents: Contents::Grey16(texture.width, texture.height, values) }
}

/// The file's name of a texture for the print.
pub(super) fn print_name(texture: &Texture) -> String {
    format!("{}-print.png", texture.name)
}
