//! Sensor layout: the pixels that are read, and those that are read together.
//!
//! - Optical black: rows above and columns left of the image without light. They have dark current, smear and all noises.
//! - Binning: n × m pixels of the same colour give one. Charge: their electrons are added before the read-out chain, whose noise is added once (the
//!   register is assumed to hold the sum). Digital: their digital numbers are averaged and rounded. With tiles of w × h pixels, the pixel (x, y) of
//!   the result takes the pixels ⌊x/w⌋ w n + x mod w + i w of a row, i < n, and likewise along columns: the order of the tile is preserved.
//! - Skipping: of every n × m tiles of the colour filter array only the first is read. The pixel (x, y) of the result is the pixel (⌊x/w⌋ w n + x mod
//!   w, ⌊y/h⌋ h m + y mod h) alone, without its neighbours' charge: finer patterns alias. The others still collect charge, smear and bloom.
//! - Region: a rectangle of the image is read. The pixels around it still collect charge, smear and bloom.
//!
//! Left out: binning across colours, binning and skipping together.

#[cfg(test)]
mod tests;

use etendue_core::quantity::{Charge, DigitalNumber, MeanElectrons, Quantity, SignalPart};
use etendue_core::{EffectStatus, KeyChange, Plane};

use crate::check::{Checks, SensorError};
use crate::effect::{Effect, SensorFacts};
use crate::{capture::Operation, cfa::Cfa};

/// Optical-black pixels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct OpticalBlack {
    /// Rows above the image.
    pub rows: usize,
    /// Columns left of the image.
    pub columns: usize,
}

/// A rectangle of pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Region {
    /// First column.
    pub x: usize,
    /// First row.
    pub y: usize,
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
}

/// Quantity combined by binning.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BinningMode {
    /// Charge is added before it is read.
    Charge,
    /// Digital numbers are averaged.
    Numbers,
}

/// Pixels that are read together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Binning {
    /// Pixels of a row.
    pub columns: usize,
    /// Pixels of a column.
    pub rows: usize,
    /// Quantity combined.
    pub of: BinningMode,
}

/// The pixels that are read, and those that are read together.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Layout {
    /// Optical-black pixels.
    pub optical_black: OpticalBlack,
    /// The part of the image that is read; `None`: all of it.
    pub region: Option<Region>,
    /// Binning; `None`: each pixel on its own.
    pub binning: Option<Binning>,
    /// Skipping; `None`: all pixels are read.
    pub skipping: Option<Skipping>,
}

impl Effect for Layout {
    const NAME: &'static str = "region and binning";
    const KEY: &'static str = "sensor.binning";

    /// The layout must fit the image, whose size the sensor does not know ([`Layout::errors`]).
    fn check(&self, _: &SensorFacts, _: &mut Checks) {}

    fn status(&self, _: &SensorFacts, _: &Operation) -> EffectStatus {
        let Layout { optical_black: dark, region, binning, skipping } = *self;
        let mut parts = Vec::new();
        if dark != OpticalBlack::default() {
            parts.push(format!("{} rows above and {} columns left are optically black", dark.rows, dark.columns));
        }
        if let Some(Binning { columns, rows, of }) = binning {
            let how = if of == BinningMode::Charge { "charge is added" } else { "digital numbers are averaged" };
            parts.push(format!("{columns} × {rows} pixels of one colour are binned: {how}"));
        }
        if let Some(Skipping { columns, rows }) = skipping {
            parts.push(format!(
                "of {columns} × {rows} tiles of the filter array the first is read, the others are skipped"
            ));
        }
        if let Some(Region { x, y, width, height }) = region {
            parts.push(format!("{width} × {height} pixels from column {x}, row {y} are read"));
        }
        if parts.is_empty() { EffectStatus::NotDescribed } else { EffectStatus::Modelled(parts.join("; ")) }
    }

    /// A sensor always has a layout.
    fn left_out_by(&self) -> Vec<KeyChange> {
        Vec::new()
    }
}

impl Layout {
    /// True if every pixel of the sensor is a pixel of the image.
    #[must_use]
    pub fn is_whole(&self) -> bool {
        self.region.is_none() && self.binning.is_none() && self.skipping.is_none()
    }

    /// Errors of this layout for an image of `width` × `height` pixels under a tile.
    pub(crate) fn errors(&self, cfa: &Cfa, width: usize, height: usize) -> Vec<SensorError> {
        let mut checks = Checks::default();
        let (w, h) = (cfa.width(), cfa.height());
        checks.agree("cfa", width.is_multiple_of(w) && height.is_multiple_of(h), || {
            format!("{width} × {height} pixels of the sensor are no multiple of the {w} × {h} pixels of the tile: change the size")
        });
        let (n, m) = self.steps();
        let key = if self.skipping.is_some() { "skipping" } else { "binning" };
        checks.agree("skipping", self.skipping.is_none() || self.binning.is_none(), || {
            "pixels are binned or skipped, not both: remove this or \"binning\"".to_owned()
        });
        checks.agree(key, (1..=64).contains(&n) && (1..=64).contains(&m), || {
            format!("{n} × {m} pixels cannot be combined: give 1 to 64 each")
        });
        checks.agree(key, (self.binning.is_none() && self.skipping.is_none()) || (n, m) != (1, 1), || {
            "1 × 1 has no effect: give more, or remove it".to_owned()
        });
        if !checks.errors.is_empty() {
            return checks.errors;
        }
        let (w, h) = (w * n, h * m);
        let is_divisible = |columns: usize, rows: usize| columns.is_multiple_of(w) && rows.is_multiple_of(h);
        let tile = match (n, m) {
            (1, 1) => "the colour filter tile".to_owned(),
            _ => format!("the colour filter tile times the {key}"),
        };
        let multiples = format!("expected multiples of {w} columns and {h} rows, the size of {tile}");
        checks.agree(key, is_divisible(width, height), || {
            format!("the sensor has {width} columns and {height} rows; {multiples}")
        });
        let dark = self.optical_black;
        checks.agree("optical_black", is_divisible(dark.columns, dark.rows), || {
            format!("found {} columns and {} rows; {multiples}", dark.columns, dark.rows)
        });
        if let Some(r) = self.region {
            checks.agree(
                "roi_px",
                is_divisible(r.x, r.y) && is_divisible(r.width, r.height) && r.width > 0 && r.height > 0,
                || {
                    let Region { x, y, width, height } = r;
                    format!("found {width} × {height} pixels from column {x}, row {y}; {multiples}")
                },
            );
            let ends_inside =
                |from: usize, length: usize, all: usize| from.checked_add(length).is_some_and(|end| end <= all);
            checks.agree("roi_px", ends_inside(r.x, r.width, width) && ends_inside(r.y, r.height, height), || {
                format!("it ends beyond the image of {width} × {height} pixels: move it or make it smaller")
            });
            checks.agree("roi_px", dark == OpticalBlack::default(), || {
                "a region excludes the optical black: remove one of the two".to_owned()
            });
        }
        checks.errors
    }

    /// The whole array: the image with its optical-black pixels. `None` if there are none.
    pub(crate) fn with_optical_black(&self, image: &Plane<MeanElectrons>) -> Option<Plane<MeanElectrons>> {
        let OpticalBlack { rows, columns } = self.optical_black;
        if rows == 0 && columns == 0 {
            return None;
        }
        let (width, height) = (image.width(), image.height());
        let mut array = Plane::new(width + columns, height + rows);
        for y in 0..height {
            let start = (y + rows) * (width + columns) + columns;
            array.samples_mut()[start..start + width].copy_from_slice(&image.samples()[y * width..(y + 1) * width]);
        }
        Some(array)
    }

    /// The binning of charge, if any.
    pub(crate) fn charge_binning(&self) -> Option<Binning> {
        self.binning.filter(|b| b.of == BinningMode::Charge)
    }

    /// The binning of digital numbers, if any.
    pub(crate) fn number_binning(&self) -> Option<Binning> {
        self.binning.filter(|b| b.of == BinningMode::Numbers)
    }

    /// Columns and rows of the array per pixel of the result.
    fn steps(&self) -> (usize, usize) {
        let binned = self.binning.map(|b| (b.columns, b.rows));
        binned.or(self.skipping.map(|s| (s.columns, s.rows))).unwrap_or((1, 1))
    }

    /// The part of the array that is read, in pixels of the result; `None` for all of it.
    pub(crate) fn read_part(&self) -> Option<Region> {
        let (n, m) = self.steps();
        self.region.map(|r| Region { x: r.x / n, y: r.y / m, width: r.width / n, height: r.height / m })
    }

    /// Position of the image in a raw of `width` × `height` pixels.
    pub(crate) fn image_in_raw(&self, width: usize, height: usize) -> Region {
        let (n, m) = self.steps();
        let (x, y) = (self.optical_black.columns / n, self.optical_black.rows / m);
        Region { x, y, width: width - x, height: height - y }
    }

    /// Columns and rows of the delivered image of a sensor of `width` × `height` pixels.
    pub(crate) fn image_size(&self, width: usize, height: usize) -> (usize, usize) {
        let (n, m) = self.steps();
        let (width, height) = self.region.map_or((width, height), |r| (r.width, r.height));
        (width / n, height / m)
    }

    /// Maps a point of the sensor (pixels, the top left corner is 0, 0) to the delivered image. With skipping, tiles of more than one pixel keep
    /// their centre.
    pub(crate) fn image_point(&self, cfa: &Cfa, [x, y]: [f64; 2]) -> [f64; 2] {
        let (n, m) = self.steps();
        let (left, top) = self.region.map_or((0, 0), |r| (r.x, r.y));
        let middle = |tile: usize| if self.skipping.is_some() { 0.5 * tile as f64 } else { 0.0 };
        let along = |at: f64, middle: f64, n: usize| (at - middle) / n as f64 + middle;
        let (x, y) = (x - left as f64, y - top as f64);
        [along(x, middle(cfa.width()), n), along(y, middle(cfa.height()), m)]
    }

    /// Position in the raw of pixel (x, y) of the array; `None` if it is not read.
    pub(crate) fn raw_of_array(&self, cfa: &Cfa, x: usize, y: usize) -> Option<(usize, usize)> {
        let along = |i: usize, tile: usize, n: usize| i / (tile * n) * tile + i % tile;
        let (n, m) = self.steps();
        let is_first = |i: usize, tile: usize, n: usize| i % (tile * n) < tile;
        if self.skipping.is_some() && !(is_first(x, cfa.width(), n) && is_first(y, cfa.height(), m)) {
            return None;
        }
        let (x, y) = (along(x, cfa.width(), n), along(y, cfa.height(), m));
        match self.read_part() {
            None => Some((x, y)),
            Some(r) => {
                let inside = (r.x..r.x + r.width).contains(&x) && (r.y..r.y + r.height).contains(&y);
                inside.then(|| (x - r.x, y - r.y))
            }
        }
    }
}

/// Quantities that are summed over pixels read together.
pub(crate) trait Summable: Quantity<Sample = f32> {}

impl Summable for Charge {}
impl Summable for SignalPart {}

impl Binning {
    /// Samples of the same colour combined by `fold`.
    fn folded<Q: Quantity>(&self, cfa: &Cfa, plane: &Plane<Q>, fold: impl Fn(&[Q::Sample]) -> Q::Sample) -> Plane<Q> {
        let (n, m, w, h) = (self.columns, self.rows, cfa.width(), cfa.height());
        let mut out = Plane::new(plane.width() / n, plane.height() / m);
        let mut samples = Vec::with_capacity(n * m);
        for y in 0..out.height() {
            for x in 0..out.width() {
                let (x0, y0) = (first_of(x, w, n), first_of(y, h, m));
                samples.clear();
                samples.extend(
                    (0..m).flat_map(|j| (0..n).map(move |i| (x0 + i * w, y0 + j * h))).map(|(x, y)| plane.at(x, y)),
                );
                out.set(x, y, fold(&samples));
            }
        }
        out
    }

    /// The sum of charge, or of its parts.
    pub(crate) fn added<Q: Summable>(&self, cfa: &Cfa, plane: &Plane<Q>) -> Plane<Q> {
        self.folded(cfa, plane, |q| q.iter().map(|q| f64::from(*q)).sum::<f64>() as f32)
    }

    /// The mean of the parts of digital numbers.
    pub(crate) fn mean(&self, cfa: &Cfa, plane: &Plane<SignalPart>) -> Plane<SignalPart> {
        self.folded(cfa, plane, |q| (q.iter().map(|q| f64::from(*q)).sum::<f64>() / q.len() as f64) as f32)
    }

    /// The mean of digital numbers, halves to even.
    pub(crate) fn averaged(&self, cfa: &Cfa, plane: &Plane<DigitalNumber>) -> Plane<DigitalNumber> {
        let mean = |dn: &[u32]| dn.iter().map(|dn| f64::from(*dn)).sum::<f64>() / dn.len() as f64;
        self.folded(cfa, plane, |dn| mean(dn).round_ties_even() as u32)
    }
}

impl Region {
    /// The rectangle of a plane.
    pub(crate) fn crop<Q: Quantity>(&self, plane: &Plane<Q>) -> Plane<Q> {
        let rows = plane.samples().chunks(plane.width()).skip(self.y).take(self.height);
        let samples = rows.flat_map(|row| row[self.x..self.x + self.width].iter().copied()).collect();
        Plane::from_samples(self.width, self.height, samples).expect("a checked region")
    }
}

/// Skipped pixels: of each group of tiles of the colour filter array only the first is read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Skipping {
    /// Tiles per group along a row.
    pub columns: usize,
    /// Tiles per group along a column.
    pub rows: usize,
}

impl Skipping {
    /// The samples that are read.
    pub(crate) fn read<Q: Quantity>(&self, cfa: &Cfa, plane: &Plane<Q>) -> Plane<Q> {
        let (width, height) = (plane.width() / self.columns, plane.height() / self.rows);
        let row = |y: usize| {
            let y = first_of(y, cfa.height(), self.rows);
            (0..width).map(move |x| plane.at(first_of(x, cfa.width(), self.columns), y))
        };
        Plane::from_samples(width, height, (0..height).flat_map(row).collect()).expect("whole tiles")
    }
}

/// The first array column (or row) that contributes to column (or row) `i` of the result, with `n` per result pixel, in tiles of a length.
fn first_of(i: usize, tile: usize, n: usize) -> usize {
    i / tile * tile * n + i % tile
}
