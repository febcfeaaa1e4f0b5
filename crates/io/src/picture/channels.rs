//! What a picture's head says of its numbers.

use std::io::{BufRead, Seek};
use std::path::Path;

use image::{ColorType, ImageDecoder as _, ImageReader};

use crate::guard::guarded;

/// Whether a picture has three or four channels of 8 bits each, as pictures of encoded colours have; of palettes, what they lead to. `false` where its head cannot be
/// read. `file` names it in messages.
pub fn has_colours_of_8_bits(file: &Path, bytes: impl BufRead + Seek) -> bool {
    let colours = || Some(ImageReader::new(bytes).with_guessed_format().ok()?.into_decoder().ok()?.color_type());
    let found = guarded(file, || Ok(colours())).ok().flatten();
    matches!(found, Some(ColorType::Rgb8 | ColorType::Rgba8))
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::{DynamicImage, ImageFormat};
    use std::io::Cursor;

    #[test]
    fn only_colours_of_8_bits_are_those() {
        let found = |picture: DynamicImage, format: ImageFormat| {
            let mut bytes = Cursor::new(Vec::new());
            picture.write_to(&mut bytes, format).expect("encodable");
            bytes.set_position(0);
            has_colours_of_8_bits(Path::new("a"), bytes)
        };
        assert!(found(DynamicImage::new_rgb8(2, 2), ImageFormat::Png));
        assert!(found(DynamicImage::new_rgba8(2, 2), ImageFormat::Png));
        assert!(found(DynamicImage::new_rgb8(2, 2), ImageFormat::Jpeg));
        assert!(!found(DynamicImage::new_luma8(2, 2), ImageFormat::Png));
        assert!(!found(DynamicImage::new_luma_a8(2, 2), ImageFormat::Png));
        assert!(!found(DynamicImage::new_rgb16(2, 2), ImageFormat::Png));
        assert!(!found(DynamicImage::new_rgb32f(2, 2), ImageFormat::Hdr));
        assert!(!has_colours_of_8_bits(Path::new("a"), Cursor::new(b"\x76\x2f\x31\x01".as_slice())));
    }
}
