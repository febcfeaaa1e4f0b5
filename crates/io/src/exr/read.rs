//! Reader of any flat EXR: all channels of all parts, at full resolution; R, G and B in the primaries of Rec. 709 (`colour_space.rs`).

use std::{collections::BTreeMap, io::Cursor, path::Path};

use ::exr::meta::attribute::AttributeValue;
use ::exr::prelude::{AnyChannels, FlatSamples, Layer, ReadChannels, ReadLayers};
use etendue_scene::asset::ColourMatrix;

use super::colour_space;
use crate::source::{read_bytes, read_expected_bytes};
use crate::{Error, ErrorCode, Provenance, error::guarded, texture_memory};

/// Samples of a channel, row by row from the top left.
#[derive(Clone, Debug, PartialEq)]
pub enum ExrSamples {
    /// 16-bit floats in the file, widened.
    Half(Vec<f32>),
    /// 32-bit floats.
    Float(Vec<f32>),
    /// 32-bit unsigned integers.
    Uint(Vec<u32>),
}

/// Channel by its full name; in a file of several named parts the part's name precedes it.
#[derive(Clone, Debug, PartialEq)]
pub struct ExrChannel {
    pub name: String,
    /// Values.
    pub samples: ExrSamples,
}

/// Content of an EXR file.
#[derive(Clone, Debug, PartialEq)]
pub struct ExrFile {
    /// Pixels per row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Channels, sorted by name within a part.
    pub channels: Vec<ExrChannel>,
    /// Header attributes other than the technical ones, as text.
    pub attributes: BTreeMap<String, String>,
    /// Compression, as OpenEXR names it.
    pub compression: String,
    /// Matrix from R, G and B to Rec. 709; `None` if they are in it.
    pub to_rec_709: Option<ColourMatrix>,
}

impl ExrFile {
    /// Facts of a result; for files of other programs all are at their defaults.
    #[must_use]
    pub fn provenance(&self) -> Provenance {
        let facts = self.attributes.iter().filter_map(|(name, text)| Some((name.strip_prefix("etendue:")?, text)));
        Provenance::from_texts(&facts.map(|(name, text)| (name.to_owned(), text.clone())).collect())
    }
}

impl ExrSamples {
    /// Samples one by one, as [`ExrSamples::to_floats`] returns them.
    pub(crate) fn floats(&self) -> Box<dyn Iterator<Item = f32> + '_> {
        match self {
            Self::Half(values) | Self::Float(values) => Box::new(values.iter().copied()),
            Self::Uint(values) => Box::new(values.iter().map(|&v| v as f32)),
        }
    }

    /// The samples as floats; unsigned integers above 2²⁴ are rounded.
    #[must_use]
    pub fn to_floats(&self) -> Vec<f32> {
        self.clone().into_floats()
    }

    /// The same, without a second copy of floats in memory.
    #[must_use]
    pub fn into_floats(self) -> Vec<f32> {
        match self {
            Self::Half(values) | Self::Float(values) => values,
            Self::Uint(values) => values.into_iter().map(|v| v as f32).collect(),
        }
    }
}

impl ExrFile {
    /// Channel of that name.
    #[must_use]
    pub fn channel(&self, name: &str) -> Option<&ExrSamples> {
        self.channels.iter().find(|c| c.name == name).map(|c| &c.samples)
    }
}

impl ExrFile {
    /// Converts R, G and B, if all three are present, to Rec. 709; the attributes state it.
    fn in_rec_709(mut self) -> Self {
        if let Some(matrix) = self.to_rec_709.take()
            && convert(&mut self.channels, &matrix)
        {
            let stated = self.attributes.entry("chromaticities".to_owned()).or_default();
            *stated += "; R, G and B are converted to Rec. 709";
        }
        self
    }

    /// Refuses a cube map, whose faces are stacked vertically, as an image.
    pub(crate) fn check_is_no_cube_map(&self, file: &Path) -> Result<(), Error> {
        if self.attributes.get(colour_space::ENVMAP).is_none_or(|projection| projection != colour_space::CUBE) {
            return Ok(());
        }
        Err(Error::coded(
            ErrorCode::UnsupportedFile,
            file,
            "a cube map (by its attribute \"envmap\"), which is not supported; convert it to a latitude-longitude panorama, for example with \
             OpenEXR's exrenvmap -latlong",
        ))
    }
}

fn convert(channels: &mut [ExrChannel], matrix: &ColourMatrix) -> bool {
    let place = |name: &str| channels.iter().position(|channel| channel.name == name);
    let (Some(r), Some(g), Some(b)) = (place("R"), place("G"), place("B")) else { return false };
    let Ok([r, g, b]) = channels.get_disjoint_mut([r, g, b]) else { return false };
    let (Some(r), Some(g), Some(b)) = (floats(&mut r.samples), floats(&mut g.samples), floats(&mut b.samples)) else {
        return false;
    };
    for ((r, g), b) in r.iter_mut().zip(g).zip(b) {
        [*r, *g, *b] = matrix.apply([*r, *g, *b]);
    }
    true
}

fn floats(samples: &mut ExrSamples) -> Option<&mut [f32]> {
    match samples {
        ExrSamples::Half(values) | ExrSamples::Float(values) => Some(values),
        ExrSamples::Uint(_) => None,
    }
}

/// Reads `file`.
///
/// # Errors
/// If it is missing, damaged or of an unsupported kind, or unpacks to more than its size allows (`texture_memory.rs`).
pub fn read_exr(file: &Path) -> Result<ExrFile, Error> {
    decode_exr(file, &read_bytes(file, "EXR")?)
}

/// Maximum bytes of the header of a film, with the names of its channels.
const HEAD_BYTES: u64 = 64 << 20;

/// Reads `file`, whose samples take at most `most_bytes` as 32-bit numbers.
///
/// # Errors
/// If it is missing, damaged or of an unsupported kind, or unpacks to more.
pub fn read_exr_within(file: &Path, most_bytes: u64) -> Result<ExrFile, Error> {
    // Blocks that would grow are stored uncompressed; the rest is the header and the table of blocks.
    let most_packed = most_bytes.saturating_add(most_bytes / 8).saturating_add(HEAD_BYTES);
    let bytes = read_expected_bytes(file, "EXR", most_packed)?;
    texture_memory::check_within(file, samples(file, &bytes)?, most_bytes.into())?;
    decode_all(file, &bytes)
}

/// Reads the bytes of `file`, with R, G and B of Rec. 709.
pub(crate) fn decode_exr(file: &Path, bytes: &[u8]) -> Result<ExrFile, Error> {
    Ok(decode_exr_as_stored(file, bytes)?.in_rec_709())
}

/// Reads the bytes of `file`, with R, G and B as they are stored.
pub(crate) fn decode_exr_as_stored(file: &Path, bytes: &[u8]) -> Result<ExrFile, Error> {
    texture_memory::check(file, samples(file, bytes)?, bytes.len())?;
    decode_all(file, bytes)
}

/// Number of samples that the headers state; `None` if they cannot be read, which the reader then reports.
fn samples(file: &Path, bytes: &[u8]) -> Result<u128, Error> {
    guarded(file, || Ok(stated_samples(bytes)))
}

fn stated_samples(bytes: &[u8]) -> u128 {
    let meta = ::exr::meta::MetaData::read_from_buffered(Cursor::new(bytes), false);
    let samples = |header: &::exr::meta::header::Header| {
        let (width, height) = (header.layer_size.width() as u128, header.layer_size.height() as u128);
        width.saturating_mul(height).saturating_mul(header.channels.list.len() as u128)
    };
    meta.map_or(0, |meta| meta.headers.iter().map(samples).fold(0, u128::saturating_add))
}

fn decode_all(file: &Path, bytes: &[u8]) -> Result<ExrFile, Error> {
    guarded(file, || decode_unguarded(file, bytes))
}

fn decode_unguarded(file: &Path, bytes: &[u8]) -> Result<ExrFile, Error> {
    let image = ::exr::prelude::read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .all_layers()
        .all_attributes()
        .non_parallel()
        .from_buffered(Cursor::new(bytes))
        .map_err(|cause| Error::new(file, explain(&cause)))?;
    let mut read = ExrFile {
        width: 0,
        height: 0,
        channels: Vec::new(),
        attributes: attribute_texts(&image.attributes.other),
        compression: String::new(),
        to_rec_709: None,
    };
    let several = image.layer_data.len() > 1;
    let chromaticities = image.attributes.chromaticities;
    for layer in image.layer_data {
        add_layer(&mut read, file, layer, several)?;
    }
    if let Some(stated) = chromaticities {
        read.to_rec_709 = colour_space::to_rec_709(file, &stated)?;
        read.attributes.insert("chromaticities".to_owned(), colour_space::text(&stated));
    }
    Ok(read)
}

fn explain(cause: &::exr::error::Error) -> String {
    match cause {
        ::exr::error::Error::NotSupported(what) => {
            format!(
                "uses an EXR feature that is not supported ({what}); save the file as flat scan lines with ZIP compression"
            )
        }
        other => format!("not a readable EXR file ({other}); it may be truncated: create or download it again"),
    }
}

fn add_layer(
    read: &mut ExrFile,
    file: &Path,
    layer: Layer<AnyChannels<FlatSamples>>,
    several: bool,
) -> Result<(), Error> {
    let (width, height) = (layer.size.width(), layer.size.height());
    if read.channels.is_empty() {
        (read.width, read.height) = (width, height);
    } else if (read.width, read.height) != (width, height) {
        let sizes = format!("{}x{} and {width}x{height}", read.width, read.height);
        return Err(Error::coded(
            ErrorCode::UnsupportedFile,
            file,
            format!("has parts of different sizes ({sizes}); store each part as a separate file"),
        ));
    }
    read.compression = layer.encoding.compression.to_string().trim_end_matches(" compression").to_uppercase();
    read.attributes.extend(attribute_texts(&layer.attributes.other));
    let projection = colour_space::projection(layer.attributes.environment_map);
    read.attributes.extend(projection.map(|word| (colour_space::ENVMAP.to_owned(), word.to_owned())));
    let part = layer.attributes.layer_name.as_ref().filter(|_| several).map(|name| format!("{name}."));
    for channel in layer.channel_data.list {
        let name = format!("{}{}", part.as_deref().unwrap_or_default(), channel.name);
        if channel.sample_data.len() != width * height {
            return Err(Error::coded(
                ErrorCode::UnsupportedFile,
                file,
                format!("channel `{name}` is subsampled; store all channels at full resolution"),
            ));
        }
        read.channels.push(ExrChannel { name, samples: owned(channel.sample_data) });
    }
    Ok(())
}

fn owned(samples: FlatSamples) -> ExrSamples {
    match samples {
        FlatSamples::F16(values) => ExrSamples::Half(values.into_iter().map(f32::from).collect()),
        FlatSamples::F32(values) => ExrSamples::Float(values),
        FlatSamples::U32(values) => ExrSamples::Uint(values),
    }
}

fn attribute_texts<'a>(
    attributes: impl IntoIterator<Item = (&'a ::exr::prelude::Text, &'a AttributeValue)>,
) -> BTreeMap<String, String> {
    attributes.into_iter().map(|(name, value)| (name.to_string(), attribute_text(value))).collect()
}

fn attribute_text(value: &AttributeValue) -> String {
    match value {
        AttributeValue::Text(text) => text.to_string(),
        AttributeValue::F64(number) => number.to_string(),
        AttributeValue::F32(number) => number.to_string(),
        AttributeValue::I32(number) => number.to_string(),
        other => format!("{other:?}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exr::tests_support::small_exr;

    /// File of some hundred bytes that claims 20 000² pixels.
    fn large() -> Vec<u8> {
        let mut bytes = small_exr(1, 1, &["Y"], 0.0);
        for window in [&b"dataWindow\0box2i\0"[..], b"displayWindow\0box2i\0"] {
            let at = bytes.windows(window.len()).position(|w| w == window).expect("a window") + window.len() + 4;
            bytes[at + 8..at + 16].copy_from_slice(&[19_999_u32.to_le_bytes(); 2].concat());
        }
        bytes
    }

    #[test]
    fn a_small_file_of_many_pixels_is_refused_by_its_header() {
        let message = decode_exr(Path::new("a.exr"), &large()).expect_err("too large").to_string();
        let expected = "a.exr: decompresses to 1526 MiB; at most 1024 MiB are allowed for a file of its size: make the image smaller";
        assert!(message.starts_with(expected), "{message}");
        assert_eq!(stated_samples(&large()), 400_000_000);
    }

    #[test]
    fn who_knows_the_size_says_the_bound() {
        let place = tempfile::tempdir().expect("temporary folder");
        let file = place.path().join("film.exr");
        std::fs::write(&file, small_exr(20, 10, &["a", "b"], 1.0)).expect("write");
        assert_eq!(read_exr_within(&file, 1600).expect("a film").channels.len(), 2);
        let message = read_exr_within(&file, 1599).expect_err("more than known").to_string();
        assert!(message.contains("decompresses to 1 MiB; expected 1 MiB"), "{message}");
    }
}
