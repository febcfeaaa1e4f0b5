//! Bands of a film in a scratch file, tile by tile.
//!
//! Each tile is one piece, written once when its light is complete: bands in order, each row by row, all means and then all variances (32 bits,
//! little-endian, the same values as in memory). Tiles are in row order of the film's grid. A band, or rows of it, are read from all pieces that contain some
//! of them. A single replicate gives no variance: none is written then, and NaN is read.

use crate::render::tile_bands::TileBands;
use crate::sizes::film::scratch_planes;
use crate::sizes::tile::Tile;
use etendue_core::Bands;
use etendue_core::storage::BandReader;
use etendue_core::storage::{NUMBER_BYTES, Scratch, ScratchStore, read_numbers, write_numbers};
use std::ops::Range;
use std::sync::Arc;

/// Means and variances of bands in a scratch file. Clones share the file.
#[derive(Clone, Debug)]
pub struct TiledCube {
    bands: Bands,
    grid: TileGrid,
    store: Arc<dyn ScratchStore>,
    scratch: Arc<dyn Scratch>,
    mean: Arc<dyn BandReader>,
    variance: Arc<dyn BandReader>,
}

/// Cubes are equal if they share a file.
impl PartialEq for TiledCube {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.scratch, &other.scratch)
    }
}

/// Positions of the pieces.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct TileGrid {
    width: usize,
    height: usize,
    /// Side of a tile, px.
    side: usize,
    /// Number of values stored per pixel.
    planes: usize,
}

impl TiledCube {
    /// A cube of `width` × `height` pixels, all 0, in tiles of `side` pixels; variances are written if there are any.
    ///
    /// # Errors
    /// There is no space.
    pub fn new(
        store: &Arc<dyn ScratchStore>,
        bands: Bands,
        [width, height, side]: [u32; 3],
        has_variance: bool,
    ) -> Result<Self, String> {
        let planes = scratch_planes(bands, has_variance);
        let grid = TileGrid { width: width as usize, height: height as usize, side: side as usize, planes };
        let scratch = store.room(grid.offset(0, grid.height))?;
        let reader = |first| Arc::new(PlaneReader { grid, scratch: Arc::clone(&scratch), first });
        let mean = reader(0);
        let variance: Arc<dyn BandReader> =
            if has_variance { reader(bands.count()) } else { Arc::new(UnknownVariance) };
        Ok(Self { bands, grid, store: Arc::clone(store), scratch, mean, variance })
    }

    /// Storage for results computed from it.
    #[must_use]
    pub fn store(&self) -> &dyn ScratchStore {
        &*self.store
    }

    /// The wavelength bands.
    #[must_use]
    pub fn bands(&self) -> Bands {
        self.bands
    }

    /// Columns and rows.
    #[must_use]
    pub fn size(&self) -> (usize, usize) {
        (self.grid.width, self.grid.height)
    }

    #[must_use]
    pub fn mean(&self) -> &Arc<dyn BandReader> {
        &self.mean
    }

    /// The variances of the means.
    #[must_use]
    pub fn variance(&self) -> &Arc<dyn BandReader> {
        &self.variance
    }

    /// Writes a tile of the grid.
    ///
    /// # Errors
    /// It cannot be written.
    pub(super) fn write(&self, bands: &TileBands) -> Result<(), String> {
        let tile = bands.tile();
        let values = &bands.samples()[..self.grid.planes * tile.len()];
        write_numbers(&*self.scratch, self.grid.offset(tile.x0 as usize, tile.y0 as usize), values)
    }

    /// Reads a tile of the grid.
    ///
    /// # Errors
    /// It cannot be read.
    pub(super) fn tile(&self, tile: Tile) -> Result<TileBands, String> {
        let mut samples = vec![f32::NAN; 2 * self.bands.count() * tile.len()];
        let offset = self.grid.offset(tile.x0 as usize, tile.y0 as usize);
        read_numbers(&*self.scratch, offset, &mut samples[..self.grid.planes * tile.len()])?;
        Ok(TileBands::from_samples(tile, self.bands.count(), samples))
    }
}

impl TileGrid {
    /// Offset of the piece of the tile that starts at column `x`, row `y`, bytes.
    fn offset(&self, x: usize, y: usize) -> u64 {
        let rows = self.side.min(self.height - y);
        ((y * self.width + x * rows) * self.planes * NUMBER_BYTES) as u64
    }
}

/// Planes of the pieces.
#[derive(Debug)]
struct PlaneReader {
    grid: TileGrid,
    scratch: Arc<dyn Scratch>,
    /// Index of the plane of band 0.
    first: usize,
}

impl BandReader for PlaneReader {
    fn read(&self, band: usize, rows: Range<usize>, samples: &mut [f32]) -> Result<(), String> {
        let TileGrid { width, height, side, .. } = self.grid;
        let mut part = Vec::new();
        for y0 in (rows.start / side * side..rows.end).step_by(side) {
            let y1 = (y0 + side).min(height);
            let (from, to) = (rows.start.max(y0), rows.end.min(y1));
            for x0 in (0..width).step_by(side) {
                let columns = side.min(width - x0);
                let before = (self.first + band) * columns * (y1 - y0) + columns * (from - y0);
                part.resize(columns * (to - from), 0.0);
                read_numbers(&*self.scratch, self.grid.offset(x0, y0) + (before * NUMBER_BYTES) as u64, &mut part)?;
                for (row, numbers) in part.chunks_exact(columns).enumerate() {
                    samples[(from - rows.start + row) * width + x0..][..columns].copy_from_slice(numbers);
                }
            }
        }
        Ok(())
    }
}

/// Variances of a single replicate.
#[derive(Debug)]
struct UnknownVariance;

impl BandReader for UnknownVariance {
    fn read(&self, _: usize, _: Range<usize>, samples: &mut [f32]) -> Result<(), String> {
        samples.fill(f32::NAN);
        Ok(())
    }
}
