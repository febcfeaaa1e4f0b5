//! Corrections of raw images: of shading and of defective pixels.
//!
//! Shading correction: gains that make a uniformly lit image uniform.
//!
//! | model | gain at a pixel |
//! | --- | --- |
//! | [`Shading::Radial`] | a table over the distance from a centre, equal steps from 0 to 1, linear between; 1 is the farthest corner of the image |
//! | [`Shading::Grid`] | a table of columns by rows laid over the image, its outer nodes on the corners, bilinear between |
//!
//! Gains are at least 1, so that a saturated pixel stays white (clipped at 1 after the gain). One gain serves all colours; shading that differs by
//! colour is left out. Noise grows with the gain.
//!
//! Defect correction: a pixel that does not measure light is replaced from its neighbours of the same colour.
//!
//! Neighbours are the pixels under the same kind of filter within one period of the tile (mono: three by three; Bayer: five by five, eight of red or
//! blue, twelve of green); the new value is the median of the non-defective ones. Defective are
//!
//! - the pixels of a map (known from calibration), and
//! - outliers: v outside the range of its neighbours **and** |v − median| > t, t a fraction of the range from black to white.
//!   An edge or a line two pixels wide has neighbours on both sides and stays; a lamp smaller than a pixel can be taken
//!   for a hot pixel, so the rule is off unless requested.
//!
//! All corrections use the uncorrected image, so their order does not matter.

use rayon::prelude::*;

use crate::raw::Mosaic;

/// Gains over the image.
#[derive(Clone, Debug, PartialEq)]
pub enum Shading {
    /// By the distance from a centre.
    Radial {
        /// The centre, raster coordinates (the top left corner is 0, 0), px.
        centre_px: [f64; 2],
        /// Gains at equal steps of the distance, from the centre to the farthest corner; two or more.
        gains: Vec<f64>,
    },
    /// By a grid over the image.
    Grid {
        /// Columns of the grid, two or more.
        columns: usize,
        /// Gains row by row.
        gains: Vec<f64>,
    },
}

/// Error of a table.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ShadingError {
    /// Too few entries or no rectangle.
    #[error("a shading table of {entries} gains {shape}: give at least two along each direction")]
    Shape {
        /// Gains given.
        entries: usize,
        /// Description of the problem.
        shape: &'static str,
    },
    /// An invalid gain.
    #[error("a shading gain is {0}, but finite gains of at least 1 are needed: divide them by the smallest")]
    Gain(f64),
}

impl Shading {
    /// Checks the table.
    ///
    /// # Errors
    /// If it is too small, not a rectangle, or holds a gain below 1.
    pub fn check(&self) -> Result<(), ShadingError> {
        let (gains, shape) = match self {
            Self::Radial { gains, .. } => (gains, (gains.len() < 2).then_some("is too short")),
            Self::Grid { columns, gains } => {
                let rectangle = *columns >= 2 && gains.len() % columns == 0 && gains.len() / columns >= 2;
                (gains, (!rectangle).then_some("is not a grid of two by two or more"))
            }
        };
        if let Some(shape) = shape {
            return Err(ShadingError::Shape { entries: gains.len(), shape });
        }
        gains.iter().find(|g| !(g.is_finite() && **g >= 1.0)).map_or(Ok(()), |g| Err(ShadingError::Gain(*g)))
    }

    /// The gains of row `y` of an image of `width` × `height` pixels. The table must have been checked.
    pub(crate) fn row(&self, y: usize, width: usize, height: usize) -> Vec<f32> {
        let gain = |x: usize| match self {
            Self::Radial { centre_px, gains } => radial(gains, *centre_px, [x, y], [width, height]),
            Self::Grid { columns, gains } => grid(gains, *columns, [x, y], [width, height]),
        };
        (0..width).map(|x| gain(x) as f32).collect()
    }
}

fn radial(gains: &[f64], centre: [f64; 2], pixel: [usize; 2], size: [usize; 2]) -> f64 {
    let far = [0, 1].map(|i| centre[i].abs().max((size[i] as f64 - centre[i]).abs()));
    let from = [0, 1].map(|i| pixel[i] as f64 + 0.5 - centre[i]);
    let fraction = ((from[0] * from[0] + from[1] * from[1]) / (far[0] * far[0] + far[1] * far[1])).sqrt();
    let (low, part) = place(fraction, gains.len());
    gains[low] + part * (gains[low + 1] - gains[low])
}

fn grid(gains: &[f64], columns: usize, pixel: [usize; 2], size: [usize; 2]) -> f64 {
    let fraction = |i: usize| (pixel[i] as f64 + 0.5) / size[i] as f64;
    let ((x, u), (y, v)) = (place(fraction(0), columns), place(fraction(1), gains.len() / columns));
    let along = |row: usize| {
        let left = gains[row * columns + x];
        left + u * (gains[row * columns + x + 1] - left)
    };
    let (top, bottom) = (along(y), along(y + 1));
    top + v * (bottom - top)
}

/// The node below a fraction of the whole, and the fraction towards the next, for `count` nodes.
fn place(fraction: f64, count: usize) -> (usize, f64) {
    let at = fraction.clamp(0.0, 1.0) * (count - 1) as f64;
    let low = (at as usize).min(count - 2);
    (low, at - low as f64)
}

/// Defective pixels.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Defects {
    /// Columns and rows of pixels known to be defective.
    pub map: Vec<[u32; 2]>,
    /// Fraction of the range from black to white by which an outlier differs from the median of its neighbours, above 0.
    pub outlier_threshold: Option<f64>,
}

impl Defects {
    /// True if no correction is enabled.
    #[must_use]
    pub fn is_off(&self) -> bool {
        self.map.is_empty() && self.outlier_threshold.is_none()
    }
}

/// The corrected samples and the number of corrected pixels.
pub(crate) fn corrected(samples: Vec<f32>, width: usize, mosaic: &Mosaic, defects: &Defects) -> (Vec<f32>, usize) {
    if defects.is_off() {
        return (samples, 0);
    }
    let mut bad = vec![false; samples.len()];
    for [x, y] in &defects.map {
        bad[*y as usize * width + *x as usize] = true;
    }
    let samples_of = MosaicSamples { samples: &samples, bad: &bad, width, mosaic };
    let threshold = defects.outlier_threshold.map(|t| t as f32);
    let rows: Vec<Vec<(usize, f32)>> =
        (0..samples.len() / width.max(1)).into_par_iter().map(|y| samples_of.corrections(y, threshold)).collect();
    let corrections = rows.concat();
    let mut samples = samples;
    for (i, v) in &corrections {
        samples[*i] = *v;
    }
    (samples, corrections.len())
}

struct MosaicSamples<'a> {
    samples: &'a [f32],
    bad: &'a [bool],
    width: usize,
    mosaic: &'a Mosaic,
}

impl MosaicSamples<'_> {
    /// Positions and new values of a row's defective pixels.
    fn corrections(&self, y: usize, threshold: Option<f32>) -> Vec<(usize, f32)> {
        let mut neighbours = Vec::new();
        let correction = |x: usize| {
            let i = y * self.width + x;
            if !self.bad[i] && threshold.is_none() {
                return None;
            }
            self.gather(x, y, &mut neighbours);
            let (low, high) = (*neighbours.first()?, *neighbours.last()?);
            let (v, median) = (self.samples[i], median(&neighbours));
            let outlier = threshold.is_some_and(|t| (v < low || v > high) && (v - median).abs() > t);
            (self.bad[i] || outlier).then_some((i, median))
        };
        (0..self.width).filter_map(correction).collect()
    }

    /// The good neighbours of the same colour, sorted.
    fn gather(&self, x: usize, y: usize, neighbours: &mut Vec<f32>) {
        neighbours.clear();
        let (reach_x, reach_y) = self.mosaic.period();
        let (height, channel) = (self.samples.len() / self.width, self.mosaic.channel_at(x, y));
        for row in y.saturating_sub(reach_y)..(y + reach_y + 1).min(height) {
            for column in x.saturating_sub(reach_x)..(x + reach_x + 1).min(self.width) {
                let i = row * self.width + column;
                let itself = row == y && column == x;
                if !itself && !self.bad[i] && self.mosaic.channel_at(column, row) == channel {
                    neighbours.push(self.samples[i]);
                }
            }
        }
        neighbours.sort_unstable_by(f32::total_cmp);
    }
}

/// The median of sorted values; the mean of the two middle values for an even number.
fn median(sorted: &[f32]) -> f32 {
    let half = sorted.len() / 2;
    if sorted.len() % 2 == 1 { sorted[half] } else { 0.5 * (sorted[half - 1] + sorted[half]) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::raw::Filter::{Blue, Green, Red};

    #[test]
    fn a_radial_table_undoes_the_vignetting_it_was_made_of() {
        // 1/gain of a fall-off 1 − 0.5 r², tabulated in 64 steps: the error of linear interpolation is at most h² max|g″|/8.
        let gains: Vec<f64> = (0..=64).map(|i| 1.0 / (1.0 - 0.5 * square(f64::from(i) / 64.0))).collect();
        let table = Shading::Radial { centre_px: [32.0, 24.0], gains };
        table.check().expect("a legal table");
        for y in 0..48 {
            for (x, gain) in table.row(y, 64, 48).iter().enumerate() {
                let (dx, dy) = (x as f64 + 0.5 - 32.0, y as f64 + 0.5 - 24.0);
                let light = 1.0 - 0.5 * (dx * dx + dy * dy) / (32.0 * 32.0 + 24.0 * 24.0);
                // max g″ = 14 at the corner: 14/8/64² = 4.3e-4, relative to a gain of 2 half of it.
                assert!((f64::from(*gain) * light - 1.0).abs() < 4.3e-4, "{x} {y}");
            }
        }
    }

    fn square(x: f64) -> f64 {
        x * x
    }

    #[test]
    fn a_grid_is_bilinear() {
        let table = Shading::Grid { columns: 3, gains: vec![1.0, 2.0, 3.0, 3.0, 4.0, 5.0] };
        table.check().expect("a legal table");
        for y in 0..6 {
            for (x, gain) in table.row(y, 8, 6).iter().enumerate() {
                let expected = 1.0 + 2.0 * (x as f64 + 0.5) / 8.0 + 2.0 * (y as f64 + 0.5) / 6.0;
                assert!((f64::from(*gain) - expected).abs() < 1e-6, "{gain} {expected}");
            }
        }
    }

    #[test]
    fn tables_that_are_none_are_refused() {
        let radial = |gains| Shading::Radial { centre_px: [1.0, 1.0], gains };
        assert!(matches!(radial(vec![1.0]).check(), Err(ShadingError::Shape { .. })));
        assert_eq!(radial(vec![1.0, 0.5]).check(), Err(ShadingError::Gain(0.5)));
        assert!(radial(vec![1.0, f64::NAN]).check().is_err());
        assert!(Shading::Grid { columns: 2, gains: vec![1.0; 5] }.check().is_err());
        assert!(Shading::Grid { columns: 0, gains: vec![] }.check().is_err());
    }

    fn bayer() -> Mosaic {
        Mosaic::tile(2, 2, vec![Red, Green, Green, Blue]).expect("Bayer")
    }

    /// Red 0.6, green 0.4, blue 0.2, on 8 × 8 pixels.
    fn flat() -> Vec<f32> {
        (0..64).map(|i| [0.6, 0.4, 0.2][bayer().channel_at(i % 8, i / 8)]).collect()
    }

    #[test]
    fn mapped_and_found_defects_get_their_own_colour() {
        let mut broken = flat();
        for (i, v) in [(0, 1.0), (27, 1.0), (33, 0.0), (63, 0.9)] {
            broken[i] = v;
        }
        let mapped = Defects { map: vec![[0, 0], [3, 3], [1, 4], [7, 7]], outlier_threshold: None };
        assert_eq!(corrected(broken.clone(), 8, &bayer(), &mapped), (flat(), 4));
        let defects = Defects { map: vec![], outlier_threshold: Some(0.1) };
        assert_eq!(corrected(broken, 8, &bayer(), &defects), (flat(), 4));
    }

    #[test]
    fn edges_and_lines_stay() {
        let edge: Vec<f32> = (0..64).map(|i| if i % 8 < 4 { 0.1 } else { 0.9 }).collect();
        let line: Vec<f32> = (0..64).map(|i| if i / 8 == 3 { 0.9 } else { 0.1 }).collect();
        let rule = Defects { map: vec![], outlier_threshold: Some(0.05) };
        for samples in [edge, line] {
            assert_eq!(corrected(samples.clone(), 8, &Mosaic::Mono, &rule), (samples, 0));
        }
    }

    #[test]
    fn a_pixel_among_defects_uses_the_good_ones() {
        let mut broken = vec![0.5; 9];
        broken[0] = 1.0;
        broken[4] = 1.0;
        let map = Defects { map: vec![[0, 0], [1, 1]], outlier_threshold: None };
        assert_eq!(corrected(broken, 3, &Mosaic::Mono, &map), (vec![0.5; 9], 2));
    }
}
