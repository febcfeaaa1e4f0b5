//! Channels to the compressed blocks of an EXR file, in parallel.
//!
//! The encoder's own way to do so starts threads of its own for every file; this one runs on the caller's. A block's bytes
//! are its own, and blocks are written in their order: the number of threads does not show.

use std::io::{Seek, Write};

use ::exr::block::writer::ChunksWriter;
use ::exr::block::{self, BlockIndex, UncompressedBlock};
use ::exr::meta::Headers;
use rayon::prelude::*;

use super::channel::ImageRows;
use super::encode::EncodeError;

/// Blocks a thread that wait, compressed, to be written.
const BLOCKS_A_THREAD: usize = 8;
/// Bytes of the blocks that wait, before they are compressed; one waits at least.
const WAITING_BYTES: usize = 256 << 20;

/// Writes the file.
pub(super) fn compress(headers: Headers, image: &ImageRows<'_>, sink: impl Write + Seek) -> Result<(), EncodeError> {
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

#[cfg(test)]
mod tests {
    use crate::Provenance;
    use crate::exr::encode::{ENCODING, ExrImage};
    use ::exr::prelude::{AnyChannel, AnyChannels, FlatSamples, Image, Layer, LayerAttributes, WritableImage};
    use std::io::Cursor;

    /// More rows than one round of blocks has on these numbers of threads, and a last block of few rows.
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
        // Our header says more, in an order of its own; the blocks are the same.
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

    /// From the first block on: its offset is the first in the table behind the header.
    fn length_of_blocks(bytes: &[u8]) -> usize {
        let meta = ::exr::meta::MetaData::read_from_buffered(Cursor::new(bytes), true).expect("a header");
        let count = meta.headers[0].chunk_count;
        let at = |place: usize| u64::from_le_bytes(bytes[place..place + 8].try_into().expect("eight bytes"));
        // The table is where its first number points behind its last.
        let table = (0..bytes.len() - 8 * count).find(|place| at(*place) == (place + 8 * count) as u64);
        bytes.len() - (table.expect("a table of offsets") + 8 * count)
    }
}
