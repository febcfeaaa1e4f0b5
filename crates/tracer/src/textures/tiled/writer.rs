//! Writes the tiles of an image at all its resolutions from its rows, a few at a time.
//!
//! For each resolution, memory holds the rows of one row of tiles, and those whose mean is the next row of the next resolution.

use std::collections::VecDeque;

use etendue_core::storage::BlockWriter;
use glam::{DVec3, Vec3};

use super::super::mipmap::{TexelArea, overlaps};
use super::super::texels::{Texel as _, TexelEncoding, Texels, TextureError, TiledError};
use super::layout::{FLOAT_TEXEL, ImageStatistics, LevelLayout, TILE, layout, lengths};

/// Writes tiles from rows.
#[derive(Debug)]
pub struct PyramidWriter {
    levels: Vec<LevelWriter>,
    encoding: TexelEncoding,
    linear: Option<Box<[f32; 256]>>,
    texels: usize,
    low: Vec3,
    high: Vec3,
    sum: DVec3,
}

impl PyramidWriter {
    /// For an image of `width` × `height` texels.
    ///
    /// # Errors
    /// If it has no texels.
    pub fn new(width: u32, height: u32, encoding: TexelEncoding) -> Result<Self, TextureError> {
        if width == 0 || height == 0 {
            return Err(TextureError::Size { width, height, actual: 0 });
        }
        let layouts = layout(width, height, encoding);
        let nexts = layouts.iter().skip(1).copied().map(Some).chain([None]);
        let levels = layouts.iter().zip(nexts).map(|(layout, next)| LevelWriter::new(*layout, next)).collect();
        let (low, high) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
        Ok(Self { levels, encoding, linear: encoding.table(), texels: 0, low, high, sum: DVec3::ZERO })
    }

    /// Bytes of each block that is written.
    #[must_use]
    pub fn lengths(width: u32, height: u32, encoding: TexelEncoding) -> Vec<u32> {
        lengths(&layout(width, height, encoding))
    }

    /// The next rows, from the top; whole rows of the encoding.
    ///
    /// # Errors
    /// If a texel is not finite, there are too many rows or others than expected, or a tile cannot be written.
    pub fn push(&mut self, rows: &Texels, out: &mut dyn BlockWriter) -> Result<(), TiledError> {
        let width = self.levels[0].layout.width as usize;
        match (rows, self.encoding) {
            (Texels::Srgb8(texels), TexelEncoding::Srgb8) | (Texels::Linear8(texels), TexelEncoding::Linear8) => {
                let linear = self.linear.take();
                let decode = |texel: &[u8; 3]| linear.as_deref().map_or(Vec3::ZERO, |l| Vec3::decoded(*texel, l));
                let mut rows = texels.chunks(width);
                let pushed =
                    rows.try_for_each(|row| self.row(row.iter().map(decode).collect(), row.as_flattened(), out));
                self.linear = linear;
                pushed
            }
            (Texels::Float(texels), TexelEncoding::Float) => texels.chunks(width).try_for_each(|row| {
                let values: Vec<Vec3> = row.iter().copied().map(Vec3::from).collect();
                let bytes = float_bytes(&values);
                self.row(values, &bytes, out)
            }),
            _ => Err(self.wrong_size(rows.len()).into()),
        }
    }

    /// Finishes the image.
    ///
    /// # Errors
    /// If rows are missing, or the statistics cannot be written.
    pub fn finish(self, out: &mut dyn BlockWriter) -> Result<(), TiledError> {
        let LevelLayout { width, height, .. } = self.levels[0].layout;
        if self.levels[0].rows != height {
            return Err(self.wrong_size(0).into());
        }
        let mean = (self.sum / (f64::from(width) * f64::from(height))).as_vec3();
        let ranges = core::array::from_fn(|i| (self.low[i], self.high[i]));
        out.write(0, &ImageStatistics { ranges, mean }.to_bytes()).map_err(TiledError::Tiles)
    }

    fn wrong_size(&self, more: usize) -> TextureError {
        let LevelLayout { width, height, .. } = self.levels[0].layout;
        TextureError::Size { width, height, actual: self.texels + more }
    }

    /// One row of the finest resolution: its values, and its bytes in tiles.
    fn row(&mut self, row: Vec<Vec3>, bytes: &[u8], out: &mut dyn BlockWriter) -> Result<(), TiledError> {
        let LevelLayout { width, height, .. } = self.levels[0].layout;
        if row.len() != width as usize || self.levels[0].rows == height {
            return Err(self.wrong_size(row.len()).into());
        }
        for value in &row {
            if !value.is_finite() {
                return Err(TextureError::NonFinite { texel: self.texels }.into());
            }
            (self.low, self.high) = (self.low.min(*value), self.high.max(*value));
            self.sum += value.as_dvec3();
            self.texels += 1;
        }
        self.levels[0].store(bytes, out).map_err(TiledError::Tiles)?;
        let mut next = Some(row);
        for level in 0..self.levels.len() {
            let Some(row) = next else { break };
            next = self.levels[level].halve(row);
            if let (Some(coarse), Some(level)) = (&next, self.levels.get_mut(level + 1)) {
                level.store(&float_bytes(coarse), out).map_err(TiledError::Tiles)?;
            }
        }
        Ok(())
    }
}

/// Data in memory for one resolution.
#[derive(Debug)]
struct LevelWriter {
    layout: LevelLayout,
    /// Rows so far.
    rows: u32,
    /// The rows of the current row of tiles, one after the other.
    band: Vec<u8>,
    coarser: Option<Halving>,
}

/// The rows from which the next resolution is computed.
#[derive(Debug)]
struct Halving {
    /// Rows of both resolutions.
    fine: u32,
    coarse: u32,
    /// The columns of each texel of the next resolution, with their weights.
    columns: Vec<Vec<(usize, f32)>>,
    /// The next row of the next resolution, and its rows of this one, with their weights.
    next: u32,
    weights: Vec<(usize, f32)>,
    /// Rows from `first` on.
    window: VecDeque<Vec<Vec3>>,
    first: usize,
}

impl LevelWriter {
    fn new(layout: LevelLayout, next: Option<LevelLayout>) -> Self {
        let coarser = next.map(|next| Halving {
            fine: layout.height,
            coarse: next.height,
            columns: (0..next.width).map(|x| overlaps(x, next.width, layout.width).collect()).collect(),
            next: 0,
            weights: overlaps(0, next.height, layout.height).collect(),
            window: VecDeque::new(),
            first: 0,
        });
        Self { layout, rows: 0, band: Vec::new(), coarser }
    }

    /// Adds a row to the tiles; writes the full ones.
    fn store(&mut self, bytes: &[u8], out: &mut dyn BlockWriter) -> Result<(), String> {
        self.band.extend_from_slice(bytes);
        self.rows += 1;
        if self.rows.is_multiple_of(TILE) || self.rows == self.layout.height {
            self.write_band(out)?;
            self.band.clear();
        }
        Ok(())
    }

    fn write_band(&self, out: &mut dyn BlockWriter) -> Result<(), String> {
        let [columns, _] = self.layout.tiles();
        let (row, texel_bytes) = ((self.rows - 1) / TILE, self.layout.texel_bytes);
        let mut tile = Vec::new();
        for column in 0..columns {
            let first = (column * TILE) as usize * texel_bytes;
            let range = first..first + self.layout.tile_width(column) as usize * texel_bytes;
            tile.clear();
            let rows = self.band.chunks_exact(self.layout.width as usize * texel_bytes);
            rows.for_each(|row| tile.extend_from_slice(&row[range.clone()]));
            out.write(self.layout.first_block + (row * columns + column) as usize, &tile)?;
        }
        Ok(())
    }

    /// Adds a row to the input of the next resolution; returns that resolution's next row if this completes it.
    fn halve(&mut self, row: Vec<Vec3>) -> Option<Vec<Vec3>> {
        self.coarser.as_mut()?.add(row)
    }
}

impl Halving {
    fn add(&mut self, row: Vec<Vec3>) -> Option<Vec<Vec3>> {
        self.window.push_back(row);
        let newest = self.first + self.window.len() - 1;
        if self.weights.last().is_none_or(|(last, _)| *last != newest) {
            return None;
        }
        let (window, first) = (&self.window, self.first);
        let texel =
            |columns: &Vec<(usize, f32)>| TexelArea { columns, rows: &self.weights }.mean(|i, j| window[j - first][i]);
        let coarse = self.columns.iter().map(texel).collect();
        self.next += 1;
        if self.next < self.coarse {
            self.weights = overlaps(self.next, self.coarse, self.fine).collect();
            let needed = self.weights.first().map_or(newest + 1, |(first, _)| *first);
            self.window.drain(..(needed - self.first).min(self.window.len()));
            self.first = needed;
        }
        Some(coarse)
    }
}

fn float_bytes(texels: &[Vec3]) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(texels.len() * FLOAT_TEXEL);
    texels.iter().for_each(|texel| texel.to_array().iter().for_each(|v| bytes.extend_from_slice(&v.to_le_bytes())));
    bytes
}
