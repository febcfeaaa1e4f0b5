//! Defect correction: a pixel that does not measure light gets what its neighbours of the same colour suggest.
//!
//! Neighbours are the pixels under the same kind of filter within one period of the tile (mono: three by three; Bayer:
//! five by five, eight of red or blue, twelve of green); the new value is the median of the good ones. Defective are
//!
//! - the pixels of a map (known from calibration), and
//! - outliers: v outside the range of its neighbours **and** |v − median| > t, t a share of the range from black to white.
//!   An edge or a line two pixels wide has neighbours on both sides and stays; a lamp smaller than a pixel can be taken
//!   for a hot pixel, so the rule is off unless asked for.
//!
//! All corrections look at the uncorrected picture, so that their order does not matter.

use crate::mosaic::Mosaic;
use rayon::prelude::*;

/// Which pixels are defective.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Defects {
    /// Columns and rows of pixels known to be defective.
    pub map: Vec<[u32; 2]>,
    /// Share of the range from black to white by which an outlier differs from the median of its neighbours, above 0.
    pub outlier_threshold: Option<f64>,
}

impl Defects {
    /// Whether there is nothing to look for.
    #[must_use]
    pub fn is_off(&self) -> bool {
        self.map.is_empty() && self.outlier_threshold.is_none()
    }
}

/// The corrected samples and how many pixels were corrected.
pub(crate) fn corrected(samples: Vec<f32>, width: usize, mosaic: &Mosaic, defects: &Defects) -> (Vec<f32>, usize) {
    if defects.is_off() {
        return (samples, 0);
    }
    let mut bad = vec![false; samples.len()];
    for [x, y] in &defects.map {
        bad[*y as usize * width + *x as usize] = true;
    }
    let picture = Picture { samples: &samples, bad: &bad, width, mosaic };
    let threshold = defects.outlier_threshold.map(|t| t as f32);
    let rows: Vec<Vec<(usize, f32)>> =
        (0..samples.len() / width.max(1)).into_par_iter().map(|y| picture.corrections(y, threshold)).collect();
    let corrections = rows.concat();
    let mut samples = samples;
    for (i, v) in &corrections {
        samples[*i] = *v;
    }
    (samples, corrections.len())
}

struct Picture<'a> {
    samples: &'a [f32],
    bad: &'a [bool],
    width: usize,
    mosaic: &'a Mosaic,
}

impl Picture<'_> {
    /// Places and new values of a row's defective pixels.
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
    fn gather(&self, x: usize, y: usize, found: &mut Vec<f32>) {
        found.clear();
        let (reach_x, reach_y) = self.mosaic.period();
        let (height, channel) = (self.samples.len() / self.width, self.mosaic.channel_at(x, y));
        for row in y.saturating_sub(reach_y)..(y + reach_y + 1).min(height) {
            for column in x.saturating_sub(reach_x)..(x + reach_x + 1).min(self.width) {
                let i = row * self.width + column;
                let itself = row == y && column == x;
                if !itself && !self.bad[i] && self.mosaic.channel_at(column, row) == channel {
                    found.push(self.samples[i]);
                }
            }
        }
        found.sort_unstable_by(f32::total_cmp);
    }
}

/// Of sorted values; of two in the middle their mean.
fn median(sorted: &[f32]) -> f32 {
    let half = sorted.len() / 2;
    if sorted.len() % 2 == 1 { sorted[half] } else { 0.5 * (sorted[half - 1] + sorted[half]) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mosaic::Filter::{Blue, Green, Red};

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
        let found = Defects { map: vec![], outlier_threshold: Some(0.1) };
        assert_eq!(corrected(broken, 8, &bayer(), &found), (flat(), 4));
    }

    #[test]
    fn edges_and_lines_stay() {
        let edge: Vec<f32> = (0..64).map(|i| if i % 8 < 4 { 0.1 } else { 0.9 }).collect();
        let line: Vec<f32> = (0..64).map(|i| if i / 8 == 3 { 0.9 } else { 0.1 }).collect();
        let rule = Defects { map: vec![], outlier_threshold: Some(0.05) };
        for picture in [edge, line] {
            assert_eq!(corrected(picture.clone(), 8, &Mosaic::Mono, &rule), (picture, 0));
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
