//! Images in tiles: the same bits as in memory, for any amount of tile memory.

use super::*;
use etendue_core::random::{Draw, FrameAddress, PathStream, Pixel, PixelAddress};
use etendue_core::storage::{BlockWriter, Blocks};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Blocks in memory that count how often they are read.
#[derive(Debug, Default)]
struct MemoryBlocks {
    blocks: Vec<Vec<u8>>,
    reads: AtomicUsize,
}

impl Blocks for MemoryBlocks {
    fn read(&self, block: usize, bytes: &mut [u8]) -> Result<(), String> {
        self.reads.fetch_add(1, Ordering::Relaxed);
        bytes.copy_from_slice(&self.blocks[block]);
        Ok(())
    }
}

impl BlockWriter for MemoryBlocks {
    fn write(&mut self, block: usize, bytes: &[u8]) -> Result<(), String> {
        assert!(
            std::mem::replace(&mut self.blocks[block], bytes.to_vec()).is_empty(),
            "block {block} is written twice"
        );
        Ok(())
    }
}

/// Numbers of 0 to 1 without a pattern.
fn noise(i: usize) -> f32 {
    let address = PixelAddress {
        frame: FrameAddress { seed: 5, ..FrameAddress::default() },
        pixel: Pixel { x: i as u32, y: 0 },
        replicate: 0,
    };
    PathStream::new(&address, 0).one(Draw::PixelArea, 0)
}

fn texels(count: usize, encoding: TexelEncoding) -> Texels {
    let bytes = || (0..count).map(|i| [0, 1, 2].map(|c| (255.0 * noise(3 * i + c)) as u8)).collect();
    match encoding {
        TexelEncoding::Srgb8 => Texels::Srgb8(bytes()),
        TexelEncoding::Linear8 => Texels::Linear8(bytes()),
        TexelEncoding::Float => Texels::Float((0..count).map(|i| [0, 1, 2].map(|c| noise(3 * i + c) - 0.25)).collect()),
    }
}

/// The texels from `first` on, as many as fit.
fn part(texels: &Texels, first: usize, count: usize) -> Texels {
    let last = |length: usize| (first + count).min(length);
    match texels {
        Texels::Srgb8(t) => Texels::Srgb8(t[first..last(t.len())].to_vec()),
        Texels::Linear8(t) => Texels::Linear8(t[first..last(t.len())].to_vec()),
        Texels::Float(t) => Texels::Float(t[first..last(t.len())].to_vec()),
    }
}

/// Tiles of an image given by `rows` rows at a time.
fn tiles(width: u32, height: u32, texels: &Texels, encoding: TexelEncoding, rows: usize) -> MemoryBlocks {
    let lengths = PyramidWriter::lengths(width, height, encoding);
    let mut memory_blocks = MemoryBlocks { blocks: vec![Vec::new(); lengths.len()], ..MemoryBlocks::default() };
    let mut writer = PyramidWriter::new(width, height, encoding).expect("a picture");
    let strip = rows * width as usize;
    for first in (0..texels.len()).step_by(strip) {
        writer.push(&part(texels, first, strip), &mut memory_blocks).expect("rows");
    }
    writer.finish(&mut memory_blocks).expect("all rows");
    let lengths_found: Vec<usize> = memory_blocks.blocks.iter().map(Vec::len).collect();
    assert!(
        lengths_found.iter().zip(&lengths).all(|(actual, expected)| *actual == *expected as usize),
        "{lengths_found:?} {lengths:?}"
    );
    memory_blocks
}

fn lookups() -> Vec<Lookup> {
    let at = |i: usize| {
        let [u, v, w, l] = [0, 1, 2, 3].map(|k| noise(9_000_000 + 4 * i + k));
        // Widths from a tenth of a texel to more than the image.
        let width = 1e-4 * etendue_core::maths::f32::exp(11.0 * w);
        let long = if i.is_multiple_of(3) { Vec2::new(4.0 * width * l, -2.0 * width) } else { Vec2::ZERO };
        Lookup { width, long, ..Lookup::point(Vec2::new(3.0 * u - 1.0, 2.0 * v - 0.5)) }
    };
    (0..3000).map(at).collect()
}

#[test]
fn values_are_those_of_the_image_in_memory() {
    let sizes = [(1, 1), (3, 2), (64, 64), (65, 1), (131, 300), (1, 200), (257, 129)];
    for (size, encoding) in
        sizes.into_iter().zip([TexelEncoding::Srgb8, TexelEncoding::Linear8, TexelEncoding::Float].into_iter().cycle())
    {
        for filter in [Filter::Trilinear, Filter::Bilinear] {
            let sampling = Sampling { wrap: [Wrap::Repeat, Wrap::Mirror], filter, ..Sampling::default() };
            let texels = texels(size.0 as usize * size.1 as usize, encoding);
            let held = ImageTexture::new(size.0, size.1, texels.clone(), sampling).expect("a picture");
            for (rows, limit) in [(1, 1), (7, 200_000), (1000, 1 << 30)] {
                let memory = Arc::new(TileMemory::new(limit));
                let blocks: Arc<dyn Blocks> = Arc::new(tiles(size.0, size.1, &texels, encoding, rows));
                let tiled =
                    ImageTexture::tiled(size.0, size.1, encoding, blocks, &memory, sampling).expect("a picture");
                assert_eq!(format!("{tiled:?}"), format!("{held:?}"), "size, ranges and mean");
                assert_eq!((tiled.texel_bytes(), tiled.tiles().map(|t| t.0)), (0, Some(held.texel_bytes() as u64)));
                for lookup in lookups() {
                    assert_eq!(tiled.sample(&lookup), held.sample(&lookup), "{size:?} {encoding:?} {lookup:?}");
                }
            }
        }
    }
}

#[test]
fn values_do_not_depend_on_who_reads_and_tiles_that_are_there_are_not_read_again() {
    let (size, encoding) = ((500, 400), TexelEncoding::Srgb8);
    let texels = texels(500 * 400, encoding);
    let held = ImageTexture::new(500, 400, texels.clone(), Sampling::default()).expect("a picture");
    let reads = |limit: u64| {
        let tiled_texels = Arc::new(tiles(size.0, size.1, &texels, encoding, 13));
        let memory = Arc::new(TileMemory::new(limit));
        let blocks: Arc<dyn Blocks> = tiled_texels.clone();
        let tiled =
            ImageTexture::tiled(size.0, size.1, encoding, blocks, &memory, Sampling::default()).expect("a picture");
        std::thread::scope(|scope| {
            for part in 0..4 {
                let (tiled, held) = (&tiled, &held);
                scope.spawn(move || {
                    for lookup in lookups().iter().skip(500 * part).take(1500) {
                        assert_eq!(tiled.sample(lookup), held.sample(lookup));
                    }
                });
            }
        });
        assert_eq!(memory.failure(), None);
        assert!(memory.held_bytes() <= limit.max(2 * 64 * 64 * 12));
        (tiled_texels.reads.load(Ordering::Relaxed), tiled_texels.blocks.len())
    };
    let (all, tiles) = reads(1 << 30);
    // Threads that miss the same tile at the same time each read it.
    assert!(all <= 4 * tiles, "{all} readings of {tiles} tiles");
    assert!(reads(100_000).0 > all, "what does not fit is read again");
}

#[test]
fn what_is_no_image_is_refused_as_in_memory() {
    let mut nowhere = MemoryBlocks { blocks: vec![Vec::new(); 3], ..MemoryBlocks::default() };
    let writer = || PyramidWriter::new(2, 2, TexelEncoding::Float).expect("a picture");
    let push = |writer: &mut PyramidWriter, texels: Vec<[f32; 3]>, out: &mut MemoryBlocks| {
        writer.push(&Texels::Float(texels), out)
    };
    let size = |actual| TiledError::Texture(TextureError::Size { width: 2, height: 2, actual });
    let mut short = writer();
    push(&mut short, vec![[0.0; 3]; 2], &mut nowhere).expect("a row");
    assert_eq!(short.finish(&mut nowhere), Err(size(2)));
    assert_eq!(push(&mut writer(), vec![[0.0; 3]; 3], &mut nowhere), Err(size(3)), "half a row");
    let mut long = writer();
    nowhere.blocks = vec![Vec::new(); 3];
    assert_eq!(push(&mut long, vec![[0.0; 3]; 6], &mut nowhere), Err(size(6)), "a row more");
    let infinite = vec![[0.0; 3], [0.0; 3], [0.0; 3], [0.0, f32::INFINITY, 0.0]];
    let refused = push(&mut writer(), infinite, &mut nowhere);
    assert_eq!(refused, Err(TextureError::NonFinite { texel: 3 }.into()));
    assert_eq!(
        PyramidWriter::new(0, 2, TexelEncoding::Float).err(),
        Some(TextureError::Size { width: 0, height: 2, actual: 0 })
    );
}
