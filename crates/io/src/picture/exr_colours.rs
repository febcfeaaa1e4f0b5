//! Colours of OpenEXR files: of the channels without a layer, or of a layer by its name.

use std::collections::BTreeSet;
use std::path::Path;

use etendue_scene::asset::ImagePixels;

use super::raster::DecodedImage;
use crate::exr::{ExrChannel, ExrFile};
use crate::{Error, ErrorCode};

/// R, G, B of an EXR file, or Y for all three; with A if present. Of a `layer` its channels of these names, or the channel that has its name.
pub(super) fn from_exr(file: &Path, exr: ExrFile, layer: Option<&str>) -> Result<DecodedImage, Error> {
    exr.check_is_no_cube_map(file)?;
    let (width, height) = (size(file, exr.width)?, size(file, exr.height)?);
    let names: Vec<String> = exr.channels.iter().map(|channel| channel.name.clone()).collect();
    let to_rec_709 = exr.to_rec_709;
    // Unused channels are dropped before the image is assembled.
    let mut planes = ["R", "G", "B", "Y", "A"].map(|_| None);
    for ExrChannel { name, samples } in exr.channels {
        let place = match layer {
            Some(layer) if name == layer => Some(3),
            _ => ["R", "G", "B", "Y", "A"].iter().position(|wanted| own_name(&name, layer) == Some(wanted)),
        };
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
        _ => return Err(no_colours(file, &names, layer)),
    };
    Ok((width, height, pixels, to_rec_709))
}

/// Name of a channel within a layer; `None` for channels of others.
fn own_name<'a>(name: &'a str, layer: Option<&str>) -> Option<&'a str> {
    match layer {
        None => Some(name),
        Some(layer) => name.strip_prefix(layer)?.strip_prefix('.'),
    }
}

fn no_colours(file: &Path, names: &[String], layer: Option<&str>) -> Error {
    const MAX_NAMES: usize = 8;
    let layers: BTreeSet<&str> =
        names.iter().filter_map(|name| name.strip_suffix(".R").or(name.strip_suffix(".Y"))).collect();
    let listed = |names: &mut dyn Iterator<Item = &str>| names.take(MAX_NAMES).collect::<Vec<_>>().join(", ");
    let subject = match layer {
        Some(layer) => format!("has no layer \"{layer}\" of R, G, B or Y, and no such channel"),
        None => "not an image of R, G, B or Y".to_owned(),
    };
    let words = match layers.is_empty() {
        true => format!("{subject}; its channels are {}", listed(&mut names.iter().map(String::as_str))),
        false => format!("{subject}; name one of its layers with \"layer\": {}", listed(&mut layers.into_iter())),
    };
    Error::new(file, words)
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exr::decode_exr_as_stored;
    use crate::exr::tests_support::small_exr;

    fn read(channels: &[&str], layer: Option<&str>) -> Result<ImagePixels, String> {
        let file = Path::new("t.exr");
        let exr = decode_exr_as_stored(file, &small_exr(1, 1, channels, 0.25)).expect("readable");
        from_exr(file, exr, layer).map(|(_, _, pixels, _)| pixels).map_err(|error| error.to_string())
    }

    #[test]
    fn layers_are_read_by_their_names() {
        let channels = ["View.Combined.A", "View.Combined.B", "View.Combined.G", "View.Combined.R", "depth.Z"];
        assert_eq!(read(&channels, Some("View.Combined")), Ok(ImagePixels::Rgba32F(vec![[0.25; 4]])));
        assert_eq!(read(&channels, Some("depth.Z")), Ok(ImagePixels::Rgb32F(vec![[0.25; 3]])));
        assert_eq!(
            read(&channels, None),
            Err("t.exr: not an image of R, G, B or Y; name one of its layers with \"layer\": View.Combined".to_owned())
        );
        assert_eq!(
            read(&channels, Some("View")),
            Err("t.exr: has no layer \"View\" of R, G, B or Y, and no such channel; name one of its layers with \"layer\": View.Combined".to_owned())
        );
    }
}
