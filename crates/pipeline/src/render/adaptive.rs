//! Number of samples of a pixel in noise-limited sampling.
//!
//! Every pixel receives the pilot's samples in each of its R replicates. Replicate r then continues to the number that the pilots of the *next* ⌊(R − 1)/2⌋
//! replicates, cyclically, require. The samples of a replicate do not determine its own number of samples, so that the mean of each replicate is unbiased (a
//! pixel that stops when its estimate looks good is wrong on average). No two replicates determine each other's number, so that their errors are
//! uncorrelated: the mean of all, each of weight 1/R whatever its samples, has the variance that their scatter gives. (If two halves determine each other's
//! number, each is unbiased, but where bright light is rare both err to the same side.)
//!
//! A pilot requires n = n₀ v/(R T) samples: v is the variance of the mean of one replicate of n₀ samples, T the permitted variance. v and the mean from which
//! T follows are averages of the pixel's own and of those of all pixels of its colour in its cell, because few replicates estimate them poorly. Errors of
//! stratified samples decrease faster than 1/n; the limit is then met with a margin.

use crate::render::gather::{PixelLight, ReplicateMoments, ReplicateSums};
use crate::render::light::{BlockSample, RenderJob};
use crate::render::mosaic::Mosaic;
use crate::sizes::film::FilmLayout;
use crate::sizes::tile::Tile;
use crate::sizes::tolerance::Tolerance;
use etendue_core::RadianceField;
use etendue_core::random::Pixel;

/// Samples of a block so far: sums of each replicate and pixel.
struct BlockSums {
    block: Vec<Pixel>,
    replicates: Vec<Vec<ReplicateSums>>,
}

/// Pilot estimate of one pixel from some replicates: its mean, and the variance of the mean of one replicate.
#[derive(Clone, Copy)]
struct PilotEstimate {
    mean: f64,
    variance: f64,
}

impl PilotEstimate {
    fn mean_of<'a>(pilots: impl Iterator<Item = &'a Self>) -> Self {
        let (mut mean, mut variance, mut count) = (0.0, 0.0, 0.0);
        for pilot in pilots {
            (mean, variance, count) = (mean + pilot.mean, variance + pilot.variance, count + 1.0);
        }
        Self { mean: mean / count, variance: variance / count }
    }
}

impl BlockSums {
    /// Pilot estimates, for each pixel after `samples` samples, from the replicates that determine the samples of `replicate`.
    fn pilots(&self, replicate: usize, samples: u32) -> impl Iterator<Item = PilotEstimate> {
        let all = self.replicates.len();
        let deciding = (all - 1) / 2;
        let next = (1..=deciding).map(move |step| &self.replicates[(replicate + step) % all]);
        let count = deciding as f64;
        (0..self.block.len()).map(move |pixel| {
            let means = || next.clone().map(|replicate_sums| replicate_sums[pixel].watched() / f64::from(samples));
            let mean = means().sum::<f64>() / count;
            let squares: f64 = means().map(|value| (value - mean) * (value - mean)).sum();
            PilotEstimate { mean, variance: squares / (count - 1.0) }
        })
    }

    /// Light of each pixel; its replicates have the given numbers of samples.
    fn light(mut self, layout: &FilmLayout, samples: &[u32]) -> Vec<(Pixel, PixelLight)> {
        let mut of = |pixel: usize| {
            let mut gather = ReplicateMoments::new(layout);
            let mut not_finite = 0;
            for (replicate_sums, samples) in self.replicates.iter_mut().zip(samples) {
                not_finite += replicate_sums[pixel].not_finite();
                gather.end_replicate(&mut replicate_sums[pixel], *samples);
            }
            gather.light(layout, samples.iter().sum(), not_finite)
        };
        self.block.iter().enumerate().map(|(i, pixel)| (*pixel, of(i))).collect()
    }
}

impl RenderJob<'_> {
    /// Samples the pixels of a tile, which splits no cell, each to the tolerance.
    pub(super) fn gather_to_tolerance<const N: usize>(
        &self,
        field: &dyn RadianceField<N>,
        tile: Tile,
        tolerance: &Tolerance,
    ) -> Vec<(Pixel, PixelLight)> {
        let cells = tile.parts(self.blocks.cell_px());
        cells.flat_map(|cell| self.gather_cell(field, cell, tolerance)).collect()
    }

    fn gather_cell<const N: usize>(
        &self,
        field: &dyn RadianceField<N>,
        cell: Tile,
        tolerance: &Tolerance,
    ) -> Vec<(Pixel, PixelLight)> {
        let layout = self.gathered_layout();
        let mut block_sample = BlockSample::default();
        let replicates = self.sampling.replicates as usize;
        let pilot = tolerance.min_spp() / self.sampling.replicates;
        let empty = |block: Vec<Pixel>| BlockSums {
            replicates: vec![vec![ReplicateSums::new(layout); block.len()]; replicates],
            block,
        };
        let mut cell: Vec<BlockSums> = self.blocks.in_tile(cell).map(empty).collect();
        cell.iter_mut().for_each(|sampled| self.add(field, sampled, 0, &vec![pilot; replicates], &mut block_sample));
        let needs: Vec<Vec<u32>> =
            (0..replicates).map(|replicate| self.required_samples(&cell, replicate, tolerance)).collect();
        let go_on = |(i, mut sampled): (usize, BlockSums)| {
            let samples: Vec<u32> = needs.iter().map(|of_replicate| of_replicate[i]).collect();
            self.add(field, &mut sampled, pilot, &samples, &mut block_sample);
            sampled.light(&layout, &samples)
        };
        cell.into_iter().enumerate().flat_map(go_on).collect()
    }

    /// Adds samples to the replicates of a block: each has `from`, and continues to its own number.
    fn add<const N: usize>(
        &self,
        field: &dyn RadianceField<N>,
        sampled: &mut BlockSums,
        from: u32,
        to: &[u32],
        block_sample: &mut BlockSample<N>,
    ) {
        for (replicate, (replicate_sums, to)) in sampled.replicates.iter_mut().zip(to).enumerate() {
            self.add_replicate(field, &sampled.block, replicate as u32, from..*to, block_sample, replicate_sums);
        }
    }

    /// Number of samples of a replicate for each block of a cell, from the pilots of the replicates that determine it.
    fn required_samples(&self, cell: &[BlockSums], replicate: usize, tolerance: &Tolerance) -> Vec<u32> {
        let replicates = self.sampling.replicates;
        let pilot = tolerance.min_spp() / replicates;
        let colour = |sampled: &BlockSums| self.mosaic.map_or(0, |mosaic| mosaic.place(sampled.block[0]));
        let pilots: Vec<(usize, Vec<PilotEstimate>)> =
            cell.iter().map(|sampled| (colour(sampled), sampled.pilots(replicate, pilot).collect())).collect();
        let of_cell = |colour: usize| {
            let same_colour = pilots.iter().filter(|(c, _)| *c == colour).flat_map(|(_, pixels)| pixels);
            PilotEstimate::mean_of(same_colour.filter(|pilot| pilot.variance.is_finite()))
        };
        let cells: Vec<PilotEstimate> = (0..self.mosaic.map_or(1, Mosaic::places)).map(of_cell).collect();
        let need = |(colour, pixels): &(usize, Vec<PilotEstimate>)| {
            let cell = &cells[*colour];
            let times = |pixel: &PilotEstimate| {
                let pilot = PilotEstimate::mean_of([pixel, cell].into_iter());
                pilot.variance / (f64::from(replicates) * tolerance.variance(pilot.mean))
            };
            let max_samples = pixels.iter().map(times).fold(0.0, f64::max);
            let samples = max_samples.ceil() * f64::from(pilot);
            (samples.min(f64::from(u32::MAX)) as u32).clamp(pilot, self.sampling.spp() / replicates)
        };
        pilots.iter().map(need).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::{AdaptiveSampling, NumberedPass};
    use crate::render::film::Film;
    use crate::render::light::{RaySource, RenderJob, Sampling};
    use crate::render::observer::NullObserver;
    use crate::render::test_job::{sampling, still_job};
    use crate::sizes::spectrum_spread::SpectrumSpread;
    use etendue_core::random::Draw;
    use etendue_core::{FieldRay, PupilRay, Spectral, Wavelengths};
    use glam::{DVec2, DVec3};

    /// Rays that leave the columns of the film at their own x.
    struct ColumnRays;

    impl RaySource for ColumnRays {
        fn ray(&self, raster_px: DVec2, _pupil: DVec2, _wavelength_nm: f64) -> Option<PupilRay> {
            Some(PupilRay { origin_m: DVec3::new(raster_px.x, 0.0, 0.0), direction: DVec3::Z, weight_sr: 1.0 })
        }
    }

    /// Radiance with mean 1: uniform light in columns below 32; in the others `strength` with probability 1/`strength`, otherwise none.
    struct FireflyField {
        strength: f32,
    }

    impl RadianceField<1> for FireflyField {
        fn radiance(&self, field_ray: &FieldRay, _: &Wavelengths<1>) -> Spectral<1> {
            // The low-order digits of a stratified number are not stratified.
            let u = (f64::from(field_ray.stream.two(Draw::Pupil, 0).x) * 9973.0).fract() as f32;
            let is_lit = field_ray.ray.origin.x < 32.0;
            Spectral::splat(if is_lit {
                1.0
            } else if u * self.strength < 1.0 {
                self.strength
            } else {
                0.0
            })
        }
    }

    fn film(field: &dyn RadianceField<1>, factor: f64, tile_px: u32) -> Film {
        let tolerance = Tolerance::new(AdaptiveSampling { threshold: factor, min_spp: 16 }, None);
        let layout = FilmLayout { bands: None, accumulates_electrons: false, watched: true };
        let spread = SpectrumSpread::Drawn;
        let sampling =
            Sampling { seed: 11, low_nm: 500.0, high_nm: 501.0, spread, ..sampling(NumberedPass::only(4096), 8) };
        let job = still_job(&ColumnRays, [64, ROWS as u32], layout, sampling);
        let job = RenderJob { tolerance: Some(tolerance), tile_px, ..job };
        job.gather::<1>(field, None, &NullObserver).expect("not cancelled")
    }

    /// Rows of the film.
    const ROWS: usize = 384;

    /// Means, variances and samples of 32 columns from `first` on.
    fn columns(film: &Film, first: usize) -> Vec<(f64, f64, u32)> {
        let watched = film.watched.as_ref().expect("watched");
        let of = |x: usize, y: usize| {
            (f64::from(watched.mean.at(x, y)), f64::from(watched.variance.at(x, y)), film.samples.at(x, y))
        };
        (0..ROWS).flat_map(|y| (first..first + 32).map(move |x| (x, y))).map(|(x, y)| of(x, y)).collect()
    }

    fn mean(values: impl ExactSizeIterator<Item = f64>) -> f64 {
        let n = values.len() as f64;
        values.sum::<f64>() / n
    }

    /// Two of three pilots see no spark, and would stop at 0 by their own estimate.
    #[test]
    fn rare_bright_light_has_no_bias_and_an_honest_variance() {
        let pixels = columns(&film(&FireflyField { strength: 40.0 }, 0.3, 16), 32);
        let light = mean(pixels.iter().map(|p| p.0));
        let variance = mean(pixels.iter().map(|p| p.1));
        let error = (variance / pixels.len() as f64).sqrt();
        assert!((light - 1.0).abs() < 4.0 * error, "{light} ± {error}");
        let scatter = mean(pixels.iter().map(|p| (p.0 - 1.0) * (p.0 - 1.0)));
        // Over about 12 000 pixels; the standard deviation of a pixel's square is at most about five times its mean.
        assert!(
            (scatter / variance - 1.0).abs() < 4.0 * 5.0 / (pixels.len() as f64).sqrt(),
            "{scatter} for {variance}"
        );
    }

    #[test]
    fn even_light_stops_at_the_pilot_and_noise_at_the_limit() {
        let film = film(&FireflyField { strength: 3.0 }, 0.1, 16);
        assert!(
            columns(&film, 0).iter().all(|(light, variance, samples)| {
                (light - 1.0).abs() < 1e-6 && *variance < 1e-12 && *samples == 16
            })
        );
        // A sample has the variance 2, so that 200 give 0.1; with 64 pixels of 3 replicates the uncertainty is a tenth.
        let noisy = columns(&film, 32);
        let error = mean(noisy.iter().map(|p| (p.0 - 1.0) * (p.0 - 1.0))).sqrt();
        let samples = mean(noisy.iter().map(|p| f64::from(p.2)));
        assert!((0.08..0.115).contains(&error), "{error}");
        assert!((180.0..320.0).contains(&samples), "{samples}");
    }

    #[test]
    fn tiles_do_not_change_the_film() {
        let sparks = FireflyField { strength: 5.0 };
        assert_eq!(film(&sparks, 0.2, 16), film(&sparks, 0.2, 32));
    }
}
