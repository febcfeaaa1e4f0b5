//! Pictures of floats.

use std::path::Path;

use etendue_scene::asset::{ColourMatrix, ImagePixels};

use crate::exr::{ExrChannel, ExrFile};
use crate::{Error, ErrorCode};

/// Width, height, pixels, and what makes their colours those of Rec. 709.
pub(super) type Picture = (u32, u32, ImagePixels, Option<ColourMatrix>);

/// R, G, B of an EXR file, or Y for all three; with A where it is there.
pub(super) fn of_exr(file: &Path, exr: ExrFile) -> Result<Picture, Error> {
    exr.check_is_no_cube_map(file)?;
    let (width, height) = (size(file, exr.width)?, size(file, exr.height)?);
    let names: Vec<String> = exr.channels.iter().map(|channel| channel.name.clone()).take(8).collect();
    let to_rec_709 = exr.to_rec_709;
    // What the picture does not need goes before it is put together.
    let mut planes = ["R", "G", "B", "Y", "A"].map(|_| None);
    for ExrChannel { name, samples } in exr.channels {
        let place = ["R", "G", "B", "Y", "A"].iter().position(|wanted| name == *wanted);
        if let Some(empty @ None) = place.map(|at| &mut planes[at]) {
            *empty = Some(samples.into_floats());
        }
    }
    let [r, g, b, y, a] = planes;
    let (pixels, to_rec_709) = match (r, g, b, y) {
        (Some(r), Some(g), Some(b), _) => {
            (joined(r.iter().zip(&g).zip(&b).map(|((r, g), b)| [*r, *g, *b]), a), to_rec_709)
        }
        (None, None, None, Some(y)) => (joined(y.iter().map(|y| [*y; 3]), a), None),
        _ => {
            return Err(Error::new(file, format!("no picture of R, G, B or Y; its channels are {}", names.join(", "))));
        }
    };
    Ok((width, height, pixels, to_rec_709))
}

fn joined(colours: impl Iterator<Item = [f32; 3]>, opacity: Option<Vec<f32>>) -> ImagePixels {
    match opacity {
        None => ImagePixels::Rgb32F(colours.collect()),
        Some(a) => ImagePixels::Rgba32F(colours.zip(&a).map(|([r, g, b], a)| [r, g, b, *a]).collect()),
    }
}

fn size(file: &Path, pixels: usize) -> Result<u32, Error> {
    u32::try_from(pixels)
        .map_err(|_| Error::coded(ErrorCode::TooLarge, file, format!("a side of {pixels} pixels is too long")))
}

/// Refuses the first pixel that is not finite.
pub(super) fn check_finite(file: &Path, width: u32, pixels: &ImagePixels) -> Result<(), Error> {
    match pixels {
        ImagePixels::Rgb32F(values) => check(file, width, values),
        ImagePixels::Rgba32F(values) => check(file, width, values),
        ImagePixels::Gray8(_) | ImagePixels::Gray16(_) | ImagePixels::Rgb8(_) | ImagePixels::Rgba8(_) => Ok(()),
    }
}

fn check<const N: usize>(file: &Path, width: u32, pixels: &[[f32; N]]) -> Result<(), Error> {
    let Some(at) = pixels.iter().position(|p| !p.iter().all(|v| v.is_finite())) else { return Ok(()) };
    let (x, y) = (at % width as usize, at / width as usize);
    let told = format!(
        "pixel ({x}, {y}) is {:?}; expected finite numbers: cut the picture to its range before use",
        pixels[at]
    );
    Err(Error::new(file, told))
}
