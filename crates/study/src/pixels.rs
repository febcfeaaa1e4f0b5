//! The pixels of a study: their cells, and the normalisation of errors.

use crate::error::{ErrorMetrics, Estimate};
use etendue::{SampledPixel, TemporalNoise};
use etendue_stats::Moments;
use std::collections::BTreeMap;

/// Side of a cell, px.
const CELL_PX: u32 = 8;
/// Lower limit of a cell's light as a fraction of the image's mean: avoids division by nearly zero in dark parts.
const MIN_LIGHT: f64 = 1e-3;

/// Pixels of one colour in 8 × 8 px of a tile.
#[derive(Clone, Debug)]
struct PixelCell {
    tile: usize,
    pixels: Vec<usize>,
    /// Reciprocal of the square of its light.
    relative: f64,
    /// Reciprocal of the sensor's variance; `None` at white.
    sensor: Option<f64>,
}

/// The pixels of a study, with the normalisation of their errors.
#[derive(Clone, Debug)]
pub(crate) struct SampledPixels {
    tiles: usize,
    cells: Vec<PixelCell>,
    has_sensor: bool,
}

/// Planes of one quantity over the study's pixels, one per seed.
pub(crate) type Planes<'a> = &'a [Vec<f32>];

impl SampledPixels {
    /// Normalisation from the light of the exact form, one plane per seed, and the noise of the sensor.
    pub(crate) fn new(pixels: &[SampledPixel], light: Planes<'_>, noise: Option<&TemporalNoise>) -> Self {
        let mut members: BTreeMap<(u32, u32, u32, u32), Vec<usize>> = BTreeMap::new();
        for (i, p) in pixels.iter().enumerate() {
            members.entry((p.tile, p.y / CELL_PX, p.x / CELL_PX, p.colour)).or_default().push(i);
        }
        let mean_of = |pixels: &[usize]| {
            let of = |plane: &Vec<f32>| pixels.iter().map(|i| f64::from(plane[*i])).sum::<f64>();
            light.iter().map(of).sum::<f64>() / (pixels.len() * light.len()) as f64
        };
        let all: Vec<usize> = (0..pixels.len()).collect();
        let floor = MIN_LIGHT * mean_of(&all);
        let cell = |((tile, ..), pixels): ((u32, u32, u32, u32), Vec<usize>)| {
            let mean = mean_of(&pixels);
            let floored = mean.max(floor);
            let relative = if floored > 0.0 { 1.0 / (floored * floored) } else { 0.0 };
            let sensor = noise.filter(|noise| mean < noise.white_e()).map(|noise| 1.0 / noise.variance_e2(mean));
            PixelCell { tile: tile as usize, pixels, relative, sensor }
        };
        let tiles = pixels.iter().map(|p| p.tile as usize + 1).max().unwrap_or(0);
        Self { tiles, cells: members.into_iter().map(cell).collect(), has_sensor: noise.is_some() }
    }

    /// Variance of one plane from the scatter of two or more independent planes.
    pub(crate) fn variance(&self, planes: Planes<'_>) -> ErrorMetrics<Estimate> {
        self.error_metrics(planes, variance)
    }

    /// Square of the mean over independent planes, corrected for the contribution of their scatter.
    pub(crate) fn squared_mean(&self, planes: Planes<'_>) -> ErrorMetrics<Estimate> {
        self.error_metrics(planes, |moments| {
            moments.mean() * moments.mean() - variance(moments) / moments.count() as f64
        })
    }

    fn error_metrics(&self, planes: Planes<'_>, of: impl Fn(&Moments) -> f64) -> ErrorMetrics<Estimate> {
        let mut relative = vec![(0.0, 0); self.tiles];
        let mut sensor = relative.clone();
        let mut patch = relative.clone();
        for cell in &self.cells {
            let values = |i: usize| planes.iter().map(move |plane| f64::from(plane[i]));
            let sum: f64 = cell.pixels.iter().map(|i| of(&Moments::from_values(values(*i)))).sum();
            let count = cell.pixels.len();
            add(&mut relative[cell.tile], sum * cell.relative, count);
            if let Some(weight) = cell.sensor {
                add(&mut sensor[cell.tile], sum * weight, count);
            }
            let means =
                planes.iter().map(|plane| cell.pixels.iter().map(|i| f64::from(plane[*i])).sum::<f64>() / count as f64);
            add(&mut patch[cell.tile], of(&Moments::from_values(means)) * cell.relative, 1);
        }
        let known = |groups: &[(f64, usize)]| {
            let sampled: Vec<_> = groups.iter().copied().filter(|(_, count)| *count > 0).collect();
            Estimate::from_groups(&sampled)
        };
        let has_signal = sensor.iter().any(|(_, count)| *count > 0);
        ErrorMetrics {
            relative: known(&relative),
            sensor: (self.has_sensor && has_signal).then(|| known(&sensor)),
            patch: known(&patch),
        }
    }
}

fn add(group: &mut (f64, usize), sum: f64, count: usize) {
    *group = (group.0 + sum, group.1 + count);
}

/// Variance of two numbers or more; NaN for fewer.
fn variance(moments: &Moments) -> f64 {
    moments.variance().unwrap_or(f64::NAN)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Four tiles of 8 × 8 px of one colour.
    fn pixels() -> Vec<SampledPixel> {
        let of = |tile: u32| (0..64).map(move |i| SampledPixel { x: 8 * tile + i % 8, y: i / 8, tile, colour: 0 });
        (0..4).flat_map(of).collect()
    }

    /// Numbers of mean `mean` and standard deviation `by`: uniformly distributed, from a multiplicative congruential generator.
    fn random_samples(mean: f64, by: f64, seed: u64) -> Vec<f32> {
        let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1;
        let mut next = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 53) as f64
        };
        (0..256).map(|_| (mean + by * 12_f64.sqrt() * (next() - 0.5)) as f32).collect()
    }

    #[test]
    fn variance_and_bias_come_apart_in_every_currency() {
        let noise = TemporalNoise::from_one_capture(1.0, 25.0, 1000.0);
        let exact: Vec<_> = (0..16).map(|k| random_samples(100.0, 10.0, 1 + k)).collect();
        let pixels = SampledPixels::new(&pixels(), &exact, Some(&noise));
        let variance = pixels.variance(&exact);
        // 10² of 100²; of 100 + 25; a 64th of it for the mean of 64. With 256 pixels of 15 degrees of freedom the uncertainty is 2.5 %, of patches 20 %.
        assert!((variance.relative.value / 0.01 - 1.0).abs() < 0.1, "{variance:?}");
        assert!((variance.sensor.expect("a sensor").value / 0.8 - 1.0).abs() < 0.1, "{variance:?}");
        assert!((variance.patch.value * 64.0 / 0.01 - 1.0).abs() < 0.7, "{variance:?}");
        // Differences of 7 with a scatter of 10: the bias is found below its noise.
        let differences: Vec<_> = (0..16).map(|k| random_samples(7.0, 10.0, 100 + k)).collect();
        let bias = pixels.squared_mean(&differences);
        assert!((bias.relative.value - 0.0049).abs() < 4.0 * bias.relative.uncertainty, "{bias:?}");
        assert!(bias.relative.uncertainty < 0.001, "{bias:?}");
        let none: Vec<_> = (0..16).map(|k| random_samples(0.0, 10.0, 200 + k)).collect();
        let none = pixels.squared_mean(&none);
        assert!(none.relative.value.abs() < 4.0 * none.relative.uncertainty, "{none:?}");
    }

    #[test]
    fn white_pixels_have_no_noise_to_be_compared_with() {
        let noise = TemporalNoise::from_one_capture(1.0, 25.0, 50.0);
        let exact: Vec<_> = (0..4).map(|k| random_samples(100.0, 10.0, 1 + k)).collect();
        assert_eq!(SampledPixels::new(&pixels(), &exact, Some(&noise)).variance(&exact).sensor, None);
    }
}
