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
            for ((place, _), chunk) in some.iter().zip(compressed.collect::<Vec<_>>()) {
                file.write_chunk(*place, chunk?)?;
            }
        }
        Ok(())
    })?;
    Ok(bytes.into_inner())
}

#[cfg(test)]
mod tests {
    use super::*;
    use ::exr::prelude::{AnyChannel, Encoding, LayerAttributes, WritableImage};

    /// More rows than one round of blocks has on these numbers of threads, and a last block of few rows.
    #[test]
    fn the_bytes_are_those_of_the_encoder_on_one_thread() {
        let floats = (0..5 * 1003).map(|i| (i * 7919 % 1009) as f32).collect();
        let uints = (0..5 * 1003).map(|i| i / 3).collect();
        let channels = [("Y", FlatSamples::F32(floats)), ("Z", FlatSamples::U32(uints))];
        let channels =
            AnyChannels::sort(channels.into_iter().map(|(name, samples)| AnyChannel::new(name, samples)).collect());
        let encoding = Encoding { compression: ::exr::prelude::Compression::ZIP16, ..Encoding::default() };
        let image = Image::from_layer(Layer::new((5, 1003), LayerAttributes::default(), encoding, channels));
        let mut plain = Cursor::new(Vec::new());
        image.write().non_parallel().to_buffered(&mut plain).expect("a picture");
        for threads in [1, 2, 3, 7] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
            let bytes = pool.install(|| compress(&image)).expect("a picture");
            assert!(bytes == *plain.get_ref(), "{threads} threads");
        }
    }
}
