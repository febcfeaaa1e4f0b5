//! Images of other programs' scenes, in formats that descriptions do not name.
//!
//! | file | becomes |
//! | --- | --- |
//! | PFM, grey and colour, of either byte order | floats times the header's scale |
//! | QOI | bytes as stored |
//! | TGA, BMP, PNM | bytes as stored; 16 bits as for PNG |
//! | others | as [`read_image`](super::read_image) |
//!
//! TGA has no magic number: its files are recognised by their name.

use std::path::Path;

use etendue_scene::asset::ImageAsset;
use image::ImageFormat;

use super::{decode_image, pfm, qoi, raster};
use crate::{Error, hash, source::read_bytes};

/// Reads an image of any format of the table.
pub fn read_foreign_image(file: &Path) -> Result<ImageAsset, Error> {
    let bytes = read_bytes(file, "image")?;
    let is_pnm = matches!(bytes.get(..3), Some([b'P', b'1'..=b'7', b' ' | b'\t' | b'\r' | b'\n']));
    let has_tga_name =
        file.extension().is_some_and(|e| ["tga", "icb", "vda", "vst"].iter().any(|t| e.eq_ignore_ascii_case(t)));
    let format = match &bytes[..] {
        [b'P', b'F' | b'f', b' ' | b'\t' | b'\r' | b'\n', ..] => {
            return assembled(file, &bytes, pfm::decode(file, &bytes)?);
        }
        [b'q', b'o', b'i', b'f', ..] => return assembled(file, &bytes, qoi::decode(file, &bytes)?),
        [b'B', b'M', ..] => ImageFormat::Bmp,
        _ if is_pnm => ImageFormat::Pnm,
        _ if has_tga_name && image::guess_format(&bytes).is_err() => ImageFormat::Tga,
        _ => return decode_image(file, &bytes),
    };
    assembled(file, &bytes, raster::decode_as(file, &bytes, format)?)
}

fn assembled(file: &Path, bytes: &[u8], decoded: raster::DecodedImage) -> Result<ImageAsset, Error> {
    let (width, height, pixels, to_rec_709) = decoded;
    if width == 0 || height == 0 {
        return Err(Error::new(file, format!("the image has {width} × {height} pixels; expected at least one pixel")));
    }
    raster::check_finite(file, width, &pixels)?;
    Ok(ImageAsset { width, height, pixels, to_rec_709, hash: hash::hash_bytes(bytes) })
}

#[cfg(test)]
mod tests {
    use etendue_scene::asset::ImagePixels;
    use image::DynamicImage;

    use super::*;

    fn read(name: &str, bytes: &[u8]) -> Result<ImagePixels, String> {
        let folder = tempfile::tempdir().expect("a folder");
        let file = folder.path().join(name);
        std::fs::write(&file, bytes).expect("written");
        read_foreign_image(&file).map(|image| image.pixels).map_err(|e| e.to_string())
    }

    #[test]
    fn tga_bmp_and_pnm_keep_their_bytes() {
        let colours: Vec<[u8; 3]> = (0..12).map(|i| [20 * i, 255 - i, 7]).collect();
        let buffer = image::ImageBuffer::from_raw(4, 3, colours.as_flattened().to_vec()).expect("12 pixels");
        let picture = DynamicImage::ImageRgb8(buffer);
        for (name, format) in [("a.TGA", ImageFormat::Tga), ("a.bmp", ImageFormat::Bmp), ("a.ppm", ImageFormat::Pnm)] {
            let mut bytes = std::io::Cursor::new(Vec::new());
            picture.write_to(&mut bytes, format).expect("encodable");
            assert_eq!(read(name, bytes.get_ref()), Ok(ImagePixels::Rgb8(colours.clone())), "{name}");
        }
    }
}
