//! Channels and facts to the bytes of an EXR file.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::fmt::{Debug, Formatter};
use std::io::{Cursor, Seek, Write};

use ::exr::block;
use ::exr::image::write::layers::WritableLayers;
use ::exr::meta::Headers;
use ::exr::meta::attribute::AttributeValue;
use ::exr::prelude::{AnyChannel, AnyChannels, Encoding, Image, Layer, LayerAttributes, Text};
use ::exr::prelude::{Blocks, Compression, LineOrder};

use super::channel::{Channel, ImageRows, Strips};
use super::compress::compress;
use super::head::HeadReplaced;
use crate::Provenance;

/// Why values cannot become an EXR or PNG file.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum EncodeError {
    /// Zero pixels.
    #[error("a picture of {width} × {height} pixels cannot be stored; expected at least one pixel")]
    Empty {
        /// Pixels a row.
        width: usize,
        /// Rows.
        height: usize,
    },
    /// A digital number that 16 bits do not hold.
    #[error("the digital number {value} does not fit into 16 bits; write the raw as TIFF")]
    Wide {
        /// The number.
        value: u32,
    },
    /// A picture without channels.
    #[error("a picture without channels cannot be stored; expected at least one plane")]
    NoChannels,
    /// Planes of different sizes.
    #[error("plane `{name}` has {found} samples, expected {expected}; all planes of one file have the same size")]
    Size {
        /// The plane.
        name: String,
        /// Its samples.
        found: usize,
        /// The file's pixels.
        expected: usize,
    },
    /// A text outside Latin-1, or a name longer than 31 bytes, which EXR headers do not hold.
    #[error("`{0}` cannot stand in an EXR header: texts are Latin-1 without NUL, attribute names at most 31 bytes")]
    Text(String),
    /// Samples that are kept on the disk cannot be read.
    #[error("{0}")]
    Read(String),
    /// The file cannot be written.
    #[error("{0}")]
    Write(String),
    /// The encoder refused.
    #[error("the encoder failed: {0}")]
    Encoder(String),
}

/// A picture to be stored: what it states, and where its samples come from.
pub struct ExrImage<'a> {
    pub(super) width: usize,
    pub(super) height: usize,
    pub(super) channels: Vec<(String, Channel<'a>)>,
    pub(super) strips: Option<Box<dyn Strips + 'a>>,
    /// Header attributes, all texts: readers in use pass over attributes of 64-bit floats (OpenEXR 3.5 for Python).
    pub(crate) facts: BTreeMap<String, String>,
    /// Luminance of R = G = B = 1, cd/m², where R, G, B are photometric.
    pub(crate) white_luminance: Option<f32>,
}

impl Debug for ExrImage<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        let names: Vec<&str> = self.channels.iter().map(|(name, _)| name.as_str()).collect();
        f.debug_struct("ExrImage").field("size", &(self.width, self.height)).field("channels", &names).finish()
    }
}

impl<'a> ExrImage<'a> {
    /// A picture without channels that carries `provenance` as `etendue:…` facts.
    pub(crate) fn new(width: usize, height: usize, provenance: &Provenance) -> Self {
        let (facts, white_luminance) = (BTreeMap::new(), None);
        let mut image = Self { width, height, channels: Vec::new(), strips: None, facts, white_luminance };
        for (name, text) in provenance.texts() {
            image.state(&name, text);
        }
        image
    }

    /// States `etendue:<name>`.
    pub(crate) fn state(&mut self, name: &str, text: impl Into<String>) {
        self.facts.insert(format!("etendue:{name}"), text.into());
    }

    /// Adds a plane of floats.
    pub(crate) fn float(&mut self, name: impl Into<String>, samples: impl Into<Cow<'a, [f32]>>) {
        self.add(name, Channel::Float(samples.into()));
    }

    /// Adds a plane of unsigned integers.
    pub(crate) fn uint(&mut self, name: impl Into<String>, samples: impl Into<Cow<'a, [u32]>>) {
        self.add(name, Channel::Uint(samples.into()));
    }

    /// Adds a channel.
    pub(super) fn add(&mut self, name: impl Into<String>, channel: Channel<'a>) {
        self.channels.push((name.into(), channel));
    }

    /// The bytes of the file. Runs on the caller's thread pool.
    ///
    /// # Errors
    /// Where the picture cannot be stored.
    pub fn into_bytes(self) -> Result<Vec<u8>, EncodeError> {
        let mut bytes = Cursor::new(Vec::new());
        self.write_to(&mut bytes)?;
        Ok(bytes.into_inner())
    }

    /// Writes the same bytes, some rows at a time. Runs on the caller's thread pool.
    ///
    /// # Errors
    /// Where the picture cannot be stored, its samples cannot be read, or `sink` fails.
    pub fn write_to(mut self, sink: impl Write + Seek) -> Result<(), EncodeError> {
        self.check()?;
        let mut attributes = LayerAttributes { white_luminance: self.white_luminance, ..LayerAttributes::default() };
        for (name, fact) in &self.facts {
            attributes.other.insert(header_name(name)?, AttributeValue::Text(text(fact)?));
        }
        let mut named = Vec::with_capacity(self.channels.len());
        for (name, channel) in std::mem::take(&mut self.channels) {
            named.push((text(&name)?, channel));
        }
        named.sort_by(|(a, _), (b, _)| a.cmp(b));
        let described = named.iter().map(|(name, channel)| AnyChannel::new(name.clone(), channel.described()));
        let described = AnyChannels::sort(described.collect());
        let image = Image::from_layer(Layer::new((self.width, self.height), attributes, ENCODING, described));
        let rows = ImageRows {
            width: self.width,
            channels: named.into_iter().map(|(_, channel)| channel).collect(),
            strips: self.strips,
        };
        let headers = image.layer_data.infer_headers(&image.attributes);
        let head = sorted_head(&headers)?;
        compress(headers, &rows, HeadReplaced::new(sink, head))
    }

    fn check(&self) -> Result<(), EncodeError> {
        let (width, height) = (self.width, self.height);
        if width == 0 || height == 0 {
            return Err(EncodeError::Empty { width, height });
        }
        if self.channels.is_empty() {
            return Err(EncodeError::NoChannels);
        }
        let expected = width * height;
        let wrong = |(name, channel): &(String, Channel<'_>)| {
            channel.len().filter(|found| *found != expected).map(|found| (name.clone(), found))
        };
        match self.channels.iter().find_map(wrong) {
            Some((name, found)) => Err(EncodeError::Size { name, found, expected }),
            None => Ok(()),
        }
    }
}

/// The one encoding we write.
pub(super) const ENCODING: Encoding =
    Encoding { compression: Compression::ZIP16, blocks: Blocks::ScanLines, line_order: LineOrder::Increasing };

fn text(string: &str) -> Result<Text, EncodeError> {
    let held = if string.contains('\0') { None } else { Text::new_or_none(string) };
    held.ok_or_else(|| EncodeError::Text(string.to_owned()))
}

/// Attribute names of at most 31 bytes: longer ones need a file flag that older readers refuse.
fn header_name(name: &str) -> Result<Text, EncodeError> {
    if name.len() > 31 { Err(EncodeError::Text(name.to_owned())) } else { text(name) }
}

/// The head of a file up to the end of its header, the header's records sorted by name. The encoder writes custom attributes in the random order
/// of a hash map; the sum of their lengths does not change, so the offsets that follow stay valid.
fn sorted_head(headers: &Headers) -> Result<Vec<u8>, EncodeError> {
    let mut bytes = Cursor::new(Vec::new());
    match block::write(&mut bytes, headers.clone(), true, |_, _| Err(::exr::error::Error::Aborted)) {
        Ok(()) | Err(::exr::error::Error::Aborted) => {}
        Err(cause) => return Err(EncodeError::Encoder(cause.to_string())),
    }
    let mut bytes = bytes.into_inner();
    let length = sort_header(&mut bytes);
    let length = length.ok_or_else(|| EncodeError::Encoder("the header cannot be followed".to_owned()))?;
    bytes.truncate(length);
    Ok(bytes)
}

/// Sorts the header's records by name in place; answers with where they end. `None` where the bytes are no single-part header.
fn sort_header(bytes: &mut [u8]) -> Option<usize> {
    const START: usize = 8; // magic number and version
    let mut records: Vec<&[u8]> = Vec::new();
    let mut rest = bytes.get(START..)?;
    while *rest.first()? != 0 {
        let (record, after) = rest.split_at_checked(record_length(rest)?)?;
        records.push(record);
        rest = after;
    }
    records.sort_by_key(|record| record.split(|&b| b == 0).next());
    let sorted = records.concat();
    bytes[START..START + sorted.len()].copy_from_slice(&sorted);
    Some(START + sorted.len())
}

/// Length of the record at the head of `bytes`: name, NUL, type, NUL, length as little-endian i32, value.
fn record_length(bytes: &[u8]) -> Option<usize> {
    let name = bytes.iter().position(|&b| b == 0)?;
    let kind = bytes[name + 1..].iter().position(|&b| b == 0)?;
    let head = name + kind + 2;
    let length = i32::from_le_bytes(bytes.get(head..head + 4)?.try_into().ok()?);
    Some(head + 4 + usize::try_from(length).ok()?)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn image() -> ExrImage<'static> {
        let mut image = ExrImage::new(3, 2, &Provenance::default());
        image.float("Y", vec![0.5; 6]);
        image
    }

    #[test]
    fn records_are_sorted_by_name() {
        let bytes = image().into_bytes().expect("a small picture");
        let mut names = Vec::new();
        let mut rest = &bytes[8..];
        while rest[0] != 0 {
            names.push(String::from_utf8_lossy(rest.split(|&b| b == 0).next().expect("name")).into_owned());
            rest = &rest[record_length(rest).expect("record")..];
        }
        assert!(names.is_sorted(), "{names:?}");
        assert!(names.len() > 12);
    }

    #[test]
    fn bytes_are_the_same_in_every_thread() {
        // Each hash map of each thread has its own random order.
        let first = image().into_bytes().expect("a small picture");
        for _ in 0..8 {
            let again = std::thread::spawn(|| image().into_bytes()).join().expect("no panic").expect("a small picture");
            assert_eq!(again, first);
        }
    }

    #[test]
    fn what_an_exr_cannot_hold_is_refused() {
        let mut odd = image();
        odd.state("note", "λ");
        assert_eq!(odd.into_bytes(), Err(EncodeError::Text("λ".to_owned())));
        let mut long = image();
        long.state("a_name_that_goes_on_and_on_and_on", "x");
        assert!(matches!(long.into_bytes(), Err(EncodeError::Text(_))));
        let mut uneven = image();
        uneven.uint("Z", vec![1; 5]);
        assert_eq!(uneven.into_bytes(), Err(EncodeError::Size { name: "Z".to_owned(), found: 5, expected: 6 }));
        assert!(matches!(ExrImage::new(0, 2, &Provenance::default()).into_bytes(), Err(EncodeError::Empty { .. })));
        assert_eq!(ExrImage::new(1, 2, &Provenance::default()).into_bytes(), Err(EncodeError::NoChannels));
    }
}
