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
use super::encode_error::EncodeError;

/// Blocks a thread that wait, compressed, to be written.
const BLOCKS_A_THREAD: usize = 8;
/// Bytes of the blocks that wait, before they are compressed; one waits at least.
pub const WAITING_BYTES: usize = 32 << 20;

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
