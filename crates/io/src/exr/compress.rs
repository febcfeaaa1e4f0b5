//! Channels to the compressed blocks of an EXR file, in parallel.
//!
//! The encoder's own way to do so starts threads of its own for every file; this one runs on the caller's. A block's bytes
//! are its own, and blocks are written in their order: the number of threads does not show.

use std::io::Cursor;

use ::exr::block::writer::ChunksWriter;
use ::exr::block::{self, BlockIndex, UncompressedBlock};
use ::exr::error::Result;
use ::exr::image::write::layers::{LayersWriter, WritableLayers};
use ::exr::prelude::{AnyChannels, FlatSamples, Image, Layer};
use rayon::prelude::*;

/// Blocks a thread that wait, compressed, to be written.
const BLOCKS_A_THREAD: usize = 8;

/// The bytes of the file.
pub(super) fn compress(image: &Image<Layer<AnyChannels<FlatSamples>>>) -> Result<Vec<u8>> {
    let headers = image.layer_data.infer_headers(&image.attributes);
    let layers = image.layer_data.create_writer(&headers);
    let mut bytes = Cursor::new(Vec::new());
    block::write(&mut bytes, headers, true, |meta, file| {
        let blocks: Vec<(usize, BlockIndex)> = meta.enumerate_ordered_header_block_indices().collect();
        for some in blocks.chunks(BLOCKS_A_THREAD * rayon::current_num_threads()) {
            let compressed = some.par_iter().map(|(_, index)| {
                let data = layers.extract_uncompressed_block(&meta.headers, *index);
                UncompressedBlock { index: *index, data }.compress_to_chunk(&meta.headers)
            });
            for ((place, _), chunk) in some.iter().zip(compressed.collect::<Result<Vec<_>>>()?) {
                file.write_chunk(*place, chunk)?;
            }
        }
        Ok(())
    })?;
    Ok(bytes.into_inner())
}
