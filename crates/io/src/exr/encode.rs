//! Encoder from channels and facts to an EXR file.
//!
//! Blocks are compressed in parallel.
//!
//! The encoder's own method starts threads for every file; this one runs on the caller's pool. A block's bytes depend on that block alone, and blocks are
//! written in order, so the file does not depend on the number of threads.

use std::fmt::{Debug, Formatter};
use std::io::{self, Cursor, Seek, SeekFrom, Write};
use std::{borrow::Cow, collections::BTreeMap};

use ::exr::block::{self, BlockIndex, UncompressedBlock};
use ::exr::prelude::{
    AnyChannel, AnyChannels, Blocks, Compression, Encoding, Image, Layer, LayerAttributes, LineOrder, Text,
};
use ::exr::{
    block::writer::ChunksWriter, image::write::layers::WritableLayers, meta::Headers, meta::attribute::AttributeValue,
};
use rayon::prelude::*;

use super::channel::{ChannelSource, EncodeError, ImageRows, Strips};
use crate::Provenance;

/// Image to be stored: facts and sources of samples.
pub struct ExrImage<'a> {
    pub(super) width: usize,
    pub(super) height: usize,
    pub(super) channels: Vec<(String, ChannelSource<'a>)>,
    pub(super) strips: Option<Box<dyn Strips + 'a>>,
    /// Header attributes, all texts: current readers ignore attributes of 64-bit floats (OpenEXR 3.5 for Python).
    pub(crate) facts: BTreeMap<String, String>,
    /// Luminance of R = G = B = 1, cd/m², if R, G, B are photometric.
    pub(crate) white_luminance: Option<f32>,
}

impl Debug for ExrImage<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        let names: Vec<&str> = self.channels.iter().map(|(name, _)| name.as_str()).collect();
        f.debug_struct("ExrImage").field("size", &(self.width, self.height)).field("channels", &names).finish()
    }
}

impl<'a> ExrImage<'a> {
    /// Returns an image without channels, with `provenance` as `etendue:…` facts.
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
        self.add(name, ChannelSource::Float(samples.into()));
    }

    /// Adds a plane of unsigned integers.
    pub(crate) fn uint(&mut self, name: impl Into<String>, samples: impl Into<Cow<'a, [u32]>>) {
        self.add(name, ChannelSource::Uint(samples.into()));
    }

    /// Adds a channel.
    pub(super) fn add(&mut self, name: impl Into<String>, channel: ChannelSource<'a>) {
        self.channels.push((name.into(), channel));
    }

    /// Returns the bytes of the file. Runs on the caller's thread pool.
    ///
    /// # Errors
    /// If the image cannot be stored.
    pub fn into_bytes(self) -> Result<Vec<u8>, EncodeError> {
        let mut bytes = Cursor::new(Vec::new());
        self.write_to(&mut bytes)?;
        Ok(bytes.into_inner())
    }

    /// Writes the same bytes, some rows at a time. Runs on the caller's thread pool.
    ///
    /// # Errors
    /// If the image cannot be stored, its samples cannot be read, or `sink` fails.
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
        let described = named.iter().map(|(name, channel)| AnyChannel::new(name.clone(), channel.sample_type()));
        let described = AnyChannels::sort(described.collect());
        let image = Image::from_layer(Layer::new((self.width, self.height), attributes, ENCODING, described));
        let rows = ImageRows {
            width: self.width,
            channels: named.into_iter().map(|(_, channel)| channel).collect(),
            strips: self.strips,
        };
        let headers = image.layer_data.infer_headers(&image.attributes);
        let head = sorted_head(&headers)?;
        compress(headers, &rows, HeadReplacingWriter::new(sink, head))
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
        let wrong = |(name, channel): &(String, ChannelSource<'_>)| {
            channel.len().filter(|length| *length != expected).map(|length| (name.clone(), length))
        };
        match self.channels.iter().find_map(wrong) {
            Some((name, length)) => Err(EncodeError::Size { name, actual: length, expected }),
            None => Ok(()),
        }
    }
}

/// The only encoding written.
const ENCODING: Encoding =
    Encoding { compression: Compression::ZIP16, blocks: Blocks::ScanLines, line_order: LineOrder::Increasing };

fn text(string: &str) -> Result<Text, EncodeError> {
    let held = if string.contains('\0') { None } else { Text::new_or_none(string) };
    held.ok_or_else(|| EncodeError::Text(string.to_owned()))
}

/// Attribute names of at most 31 bytes: longer ones need a file flag that older readers refuse.
fn header_name(name: &str) -> Result<Text, EncodeError> {
    if name.len() > 31 { Err(EncodeError::Text(name.to_owned())) } else { text(name) }
}

/// Start of a file up to the end of its header, with the header's records sorted by name. The encoder writes custom attributes in the random order of a hash
/// map; the sum of their lengths does not change, so the offsets that follow stay valid.
fn sorted_head(headers: &Headers) -> Result<Vec<u8>, EncodeError> {
    let mut bytes = Cursor::new(Vec::new());
    match block::write(&mut bytes, headers.clone(), true, |_, _| Err(::exr::error::Error::Aborted)) {
        Ok(()) | Err(::exr::error::Error::Aborted) => {}
        Err(cause) => return Err(EncodeError::Encoder(cause.to_string())),
    }
    let mut bytes = bytes.into_inner();
    let length = sort_header(&mut bytes);
    let length = length.ok_or_else(|| EncodeError::Encoder("the header could not be parsed".to_owned()))?;
    bytes.truncate(length);
    Ok(bytes)
}

/// Sorts the header's records by name in place; returns their end. `None` if the bytes are no single-part header.
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

/// Length of the first record in `bytes`: name, NUL, type, NUL, length as little-endian i32, value.
fn record_length(bytes: &[u8]) -> Option<usize> {
    let name = bytes.iter().position(|&b| b == 0)?;
    let kind = bytes[name + 1..].iter().position(|&b| b == 0)?;
    let head = name + kind + 2;
    let length = i32::from_le_bytes(bytes.get(head..head + 4)?.try_into().ok()?);
    Some(head + 4 + usize::try_from(length).ok()?)
}

/// Compressed blocks per thread that wait to be written.
const BLOCKS_A_THREAD: usize = 8;
/// Maximum uncompressed bytes of the waiting blocks; at least one block waits.
pub const WAITING_BYTES: usize = 32 << 20;

/// Writes the file.
fn compress(headers: Headers, image: &ImageRows<'_>, sink: impl Write + Seek) -> Result<(), EncodeError> {
    let mut failure = None;
    let written = block::write(sink, headers, true, |meta, file| {
        let blocks: Vec<(usize, BlockIndex)> = meta.enumerate_ordered_header_block_indices().collect();
        let rows = blocks.iter().map(|(_, index)| index.pixel_size.1).max().unwrap_or(1);
        let waiting = (WAITING_BYTES / (image.row_bytes() * rows).max(1)).max(1);
        for some in blocks.chunks(waiting.min(BLOCKS_A_THREAD * rayon::current_num_threads())) {
            let chunks = some.par_iter().map(|(_, index)| {
                let first = index.pixel_position.1;
                let data = image.bytes(first..first + index.pixel_size.1)?;
                let compressed = UncompressedBlock { index: *index, data }.compress_to_chunk(&meta.headers);
                compressed.map_err(|cause| EncodeError::Encoder(cause.to_string()))
            });
            for ((place, _), chunk) in some.iter().zip(chunks.collect::<Vec<_>>()) {
                let chunk = chunk.map_err(|cause| {
                    failure = Some(cause);
                    ::exr::error::Error::Aborted
                })?;
                file.write_chunk(*place, chunk)?;
            }
        }
        Ok(())
    });
    match (failure, written) {
        (Some(cause), _) => Err(cause),
        (None, Ok(())) => Ok(()),
        (None, Err(::exr::error::Error::Io(cause))) => Err(EncodeError::Write(cause.to_string())),
        (None, Err(cause)) => Err(EncodeError::Encoder(cause.to_string())),
    }
}

/// Writer that replaces the first bytes by a given head and passes on the rest.
pub(super) struct HeadReplacingWriter<W> {
    sink: W,
    head: Vec<u8>,
    position: u64,
}

impl<W: Write + Seek> HeadReplacingWriter<W> {
    /// `head` replaces the first bytes of the same length.
    pub(super) fn new(sink: W, head: Vec<u8>) -> Self {
        Self { sink, head, position: 0 }
    }
}

impl<W: Write> Write for HeadReplacingWriter<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let rest = usize::try_from(self.position).ok().and_then(|at| self.head.get(at..)).unwrap_or_default();
        let count = match rest.len().min(bytes.len()) {
            0 => self.sink.write(bytes)?,
            count => self.sink.write(&rest[..count])?,
        };
        self.position += count as u64;
        Ok(count)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.sink.flush()
    }
}

impl<W: Seek> Seek for HeadReplacingWriter<W> {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.position = self.sink.seek(to)?;
        Ok(self.position)
    }
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use ::exr::prelude::{FlatSamples, WritableImage};

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
        assert_eq!(uneven.into_bytes(), Err(EncodeError::Size { name: "Z".to_owned(), actual: 5, expected: 6 }));
        assert!(matches!(ExrImage::new(0, 2, &Provenance::default()).into_bytes(), Err(EncodeError::Empty { .. })));
        assert_eq!(ExrImage::new(1, 2, &Provenance::default()).into_bytes(), Err(EncodeError::NoChannels));
    }

    /// More rows than one round of blocks on these numbers of threads, and a short last block.
    #[test]
    fn the_bytes_are_those_of_the_encoder_on_one_thread() {
        let floats: Vec<f32> = (0..5 * 1003).map(|i| (i * 7919 % 1009) as f32).collect();
        let uints: Vec<u32> = (0..5 * 1003).map(|i| i / 3).collect();
        let channels = [("Y", FlatSamples::F32(floats.clone())), ("Z", FlatSamples::U32(uints.clone()))];
        let channels =
            AnyChannels::sort(channels.into_iter().map(|(name, samples)| AnyChannel::new(name, samples)).collect());
        let image = Image::from_layer(Layer::new((5, 1003), LayerAttributes::default(), ENCODING, channels));
        let mut plain = Cursor::new(Vec::new());
        image.write().non_parallel().to_buffered(&mut plain).expect("a picture");
        // Our header contains more, in its own order; the blocks are the same.
        let blocks = |bytes: &[u8]| bytes[bytes.len() - length_of_blocks(bytes)..].to_vec();
        for threads in [1, 2, 3, 7] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
            let mut ours = ExrImage::new(5, 1003, &Provenance::default());
            ours.uint("Z", uints.as_slice());
            ours.float("Y", floats.as_slice());
            let bytes = pool.install(|| ours.into_bytes()).expect("a picture");
            assert!(blocks(&bytes) == blocks(plain.get_ref()), "{threads} threads");
        }
    }

    /// Length from the first block on; its offset is the first in the table after the header.
    fn length_of_blocks(bytes: &[u8]) -> usize {
        let meta = ::exr::meta::MetaData::read_from_buffered(Cursor::new(bytes), true).expect("a header");
        let count = meta.headers[0].chunk_count;
        let at = |place: usize| u64::from_le_bytes(bytes[place..place + 8].try_into().expect("eight bytes"));
        // The table begins where its first number points just past its last.
        let table = (0..bytes.len() - 8 * count).find(|place| at(*place) == (place + 8 * count) as u64);
        bytes.len() - (table.expect("a table of offsets") + 8 * count)
    }

    #[test]
    fn the_head_stands_whatever_is_written_there() {
        let mut sink = Cursor::new(Vec::new());
        let mut file = HeadReplacingWriter::new(&mut sink, b"HEAD".to_vec());
        file.write_all(b"abcdefg").expect("memory");
        file.seek(SeekFrom::Start(2)).expect("memory");
        file.write_all(b"xyz").expect("memory");
        assert_eq!(sink.into_inner(), b"HEADzfg");
    }
}
