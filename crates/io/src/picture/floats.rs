//! Pictures of floats.

use std::path::Path;

use etendue_scene::asset::ImagePixels;

use crate::Error;
use crate::exr::ExrFile;

/// Width, height and pixels.
pub(super) type Picture = (u32, u32, ImagePixels);

/// R, G, B of an EXR file, or Y for all three; with A where it is there.
pub(super) fn of_exr(file: &Path, exr: &ExrFile) -> Result<Picture, Error> {
    let plane = |name: &str| exr.channel(name).map(crate::exr::Samples::to_floats);
    let [r, g, b] = match (plane("R"), plane("G"), plane("B"), plane("Y")) {
        (Some(r), Some(g), Some(b), _) => [r, g, b],
        (None, None, None, Some(y)) => [y.clone(), y.clone(), y],
        _ => {
            let names: Vec<&str> = exr.channels.iter().map(|c| c.name.as_str()).take(8).collect();
            return Err(Error::new(file, format!("no picture of R, G, B or Y; its channels are {}", names.join(", "))));
        }
    };
    let colours = r.iter().zip(&g).zip(&b).map(|((r, g), b)| [*r, *g, *b]);
    let pixels = match plane("A") {
        None => ImagePixels::Rgb32F(colours.collect()),
        Some(a) => ImagePixels::Rgba32F(colours.zip(&a).map(|([r, g, b], a)| [r, g, b, *a]).collect()),
    };
    Ok((size(file, exr.width)?, size(file, exr.height)?, pixels))
}

fn size(file: &Path, pixels: usize) -> Result<u32, Error> {
    u32::try_from(pixels).map_err(|_| Error::new(file, format!("a side of {pixels} pixels is too long")))
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
