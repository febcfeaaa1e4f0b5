//! How many samples a pixel gets, where noise decides.
//!
//! Every pixel gets the pilot's samples in each of its R replicates. Then replicate r goes on to a part of what the *next*
//! ⌊(R − 1)/2⌋ replicates ask for, counted round, and from there to as many as the same replicates, now better known, ask for: what is summed has no say in how long
//! it is summed (what decides of what decides reaches 2 ⌊(R − 1)/2⌋ < R replicates on, and never back), so that the mean of each
//! replicate has no bias (a pixel that stops when it looks right is wrong on average). Nor do any two replicates' sums decide of each other, so
//! that their errors are not correlated: the mean of all, each of weight 1/R whatever its samples, has the variance that their scatter tells.
//! (Of two halves that decide of each other, each is unbiased, but where bright light is rare both err to the same side. Beyond the first
//! look replicates do reach each other round the circle, but only by how well others are known: a test bounds what that does.)
//!
//! A replicate needs n = v/(R T) samples: v the variance of one sample, T the variance that is tolerated. v, by the scatter of the deciding replicates' means, each times its samples, and the
//! mean by which T is told are means of the pixel's own and of those of all pixels of its colour in its cell, as few replicates
//! know them badly. Errors of stratified samples fall faster than 1/n: then the limit is kept with something to spare.

use crate::render::block::Blocks;
use crate::render::gather::{Gather, Layout, PixelLight, Sums};
use crate::render::light::{Asked, RaySource, RenderJob};
use crate::render::mosaic::Mosaic;
use crate::render::tile::Tile;
use crate::render::tolerance::Tolerance;
use etendue_core::RadianceField;
use etendue_core::random::Pixel;

/// Least side of a cell, px: where bright light is rare, fewer pixels do not know it together.
const CELL_PX: u32 = 16;
/// What part of the need that the pilots see is rendered before the need is looked at again.
const LOOK_PART: f64 = 0.25;
/// Side of the cells whose pixels know their noise together, px: they cut no block. Cells lie on a grid of the whole frame.
#[must_use]
pub fn cell_px(blocks: Blocks) -> u32 {
    blocks.tile_px(CELL_PX)
}

/// The samples of a block so far: sums of each replicate and pixel.
struct Sampled {
    block: Vec<Pixel>,
    replicates: Vec<Vec<Sums>>,
    /// Samples of each replicate.
    samples: Vec<u32>,
}

/// What some replicates say of one pixel: its mean, and the variance of one sample.
#[derive(Clone, Copy)]
struct Pilot {
    mean: f64,
    variance: f64,
}

impl Pilot {
    fn mean_of<'a>(pilots: impl Iterator<Item = &'a Self>) -> Self {
        let (mut mean, mut variance, mut count) = (0.0, 0.0, 0.0);
        for pilot in pilots {
            (mean, variance, count) = (mean + pilot.mean, variance + pilot.variance, count + 1.0);
        }
        Self { mean: mean / count, variance: variance / count }
    }
}

impl Sampled {
    /// What the replicates that decide of `replicate` say of each pixel.
    fn pilots(&self, replicate: usize) -> impl Iterator<Item = Pilot> {
        let all = self.replicates.len();
        let deciding = (all - 1) / 2;
        let next = (1..=deciding).map(move |step| {
            let of = (replicate + step) % all;
            (&self.replicates[of], f64::from(self.samples[of]))
        });
        (0..self.block.len()).map(move |pixel| {
            let sums = || next.clone().map(|(sums, n)| (sums[pixel].watched(), n));
            let mean = sums().map(|(sum, _)| sum).sum::<f64>() / sums().map(|(_, n)| n).sum::<f64>();
            let squares: f64 = sums().map(|(sum, n)| n * (sum / n - mean) * (sum / n - mean)).sum();
            Pilot { mean, variance: squares / (deciding as f64 - 1.0) }
        })
    }

    /// The light of each pixel.
    fn light(mut self, layout: &Layout) -> Vec<(Pixel, PixelLight)> {
        let samples = self.samples;
        let mut of = |pixel: usize| {
            let mut gather = Gather::new(layout);
            let mut not_finite = 0;
            for (sums, samples) in self.replicates.iter_mut().zip(&samples) {
                not_finite += sums[pixel].not_finite();
                gather.end_replicate(&mut sums[pixel], *samples);
            }
            gather.light(layout, samples.iter().sum(), not_finite)
        };
        self.block.iter().enumerate().map(|(i, pixel)| (*pixel, of(i))).collect()
    }
}

impl<S: RaySource> RenderJob<'_, S> {
    /// Gathers the pixels of a tile that cuts no cell, each to the tolerance.
    pub(super) fn gather_to_tolerance<const N: usize>(
        &self,
        field: &impl RadianceField<N>,
        tile: Tile,
        tolerance: &Tolerance,
    ) -> Vec<(Pixel, PixelLight)> {
        let cells = tile.parts(cell_px(self.blocks));
        cells.flat_map(|cell| self.gather_cell(field, cell, tolerance)).collect()
    }

    fn gather_cell<const N: usize>(
        &self,
        field: &impl RadianceField<N>,
        cell: Tile,
        tolerance: &Tolerance,
    ) -> Vec<(Pixel, PixelLight)> {
        let layout = self.gathered();
        let mut asked = Asked::default();
        let replicates = self.sampling.replicates as usize;
        let empty = |block: Vec<Pixel>| Sampled {
            replicates: vec![vec![Sums::new(layout); block.len()]; replicates],
            samples: vec![0; replicates],
            block,
        };
        let mut cell: Vec<Sampled> = self.blocks.of(cell).map(empty).collect();
        let pilot = vec![self.pilot(tolerance); replicates];
        cell.iter_mut().for_each(|sampled| self.go_on(field, sampled, &pilot, &mut asked));
        for part in [LOOK_PART, 1.0] {
            let needs: Vec<Vec<u32>> =
                (0..replicates).map(|replicate| self.needs(&cell, replicate, (tolerance, part))).collect();
            for (i, sampled) in cell.iter_mut().enumerate() {
                let to: Vec<u32> = needs.iter().map(|of_replicate| of_replicate[i]).collect();
                self.go_on(field, sampled, &to, &mut asked);
            }
        }
        cell.into_iter().flat_map(|sampled| sampled.light(&layout)).collect()
    }

    /// Samples of a pilot in each replicate.
    fn pilot(&self, tolerance: &Tolerance) -> u32 {
        tolerance.min_spp() / self.sampling.replicates
    }

    /// Goes on with the replicates of a block to so many samples each; one that has more keeps them.
    fn go_on<const N: usize>(
        &self,
        field: &impl RadianceField<N>,
        sampled: &mut Sampled,
        to: &[u32],
        asked: &mut Asked<N>,
    ) {
        let replicates = sampled.replicates.iter_mut().zip(&mut sampled.samples).zip(to);
        for (replicate, ((sums, samples), to)) in replicates.enumerate() {
            if to > samples {
                self.add_replicate(field, (&sampled.block, replicate as u32), *samples..*to, asked, sums);
                *samples = *to;
            }
        }
    }

    /// How many samples a replicate of each block of a cell needs, times a part, as those that decide of it see it.
    fn needs(&self, cell: &[Sampled], replicate: usize, (tolerance, part): (&Tolerance, f64)) -> Vec<u32> {
        let pilot = self.pilot(tolerance);
        let colour = |sampled: &Sampled| self.mosaic.map_or(0, |mosaic| mosaic.place(sampled.block[0]));
        let pilots: Vec<(usize, Vec<Pilot>)> =
            cell.iter().map(|sampled| (colour(sampled), sampled.pilots(replicate).collect())).collect();
        let of_cell = |colour: usize| {
            let alike = pilots.iter().filter(|(c, _)| *c == colour).flat_map(|(_, pixels)| pixels);
            Pilot::mean_of(alike.filter(|pilot| pilot.variance.is_finite()))
        };
        let cells: Vec<Pilot> = (0..self.mosaic.map_or(1, Mosaic::places)).map(of_cell).collect();
        let need = |(colour, pixels): &(usize, Vec<Pilot>)| {
            let cell = &cells[*colour];
            let samples = |pixel: &Pilot| {
                let known = Pilot::mean_of([pixel, cell].into_iter());
                known.variance / (f64::from(self.sampling.replicates) * tolerance.variance(known.mean))
            };
            let most = pixels.iter().map(samples).fold(0.0, f64::max);
            let samples = (part * most / f64::from(pilot)).ceil() * f64::from(pilot);
            (samples.min(f64::from(u32::MAX)) as u32).clamp(pilot, self.sampling.spp / self.sampling.replicates)
        };
        pilots.iter().map(need).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::AdaptiveSampling;
    use crate::render::Shot;
    use crate::render::exposure::FilmExposure;
    use crate::render::film::Film;
    use crate::render::light::{RenderJob, Sampling};
    use crate::render::observer::Unobserved;
    use crate::render::spectrum_spread::SpectrumSpread;
    use crate::render::tile::Shard;
    use etendue_core::random::Draw;
    use etendue_core::{CameraPath, CameraPose, FieldRay, PupilRay, Spectral, Wavelengths};
    use glam::{DMat3, DVec2, DVec3};

    static PATH: std::sync::LazyLock<CameraPath> = std::sync::LazyLock::new(|| {
        CameraPath::still(CameraPose { position_m: DVec3::ZERO, rotation: DMat3::IDENTITY })
    });

    /// Rays that leave the columns of the film at their own x.
    struct Columns;

    impl RaySource for Columns {
        fn ray(&self, raster_px: DVec2, _pupil: DVec2, _wavelength_nm: f64) -> Option<PupilRay> {
            Some(PupilRay { origin_m: DVec3::new(raster_px.x, 0.0, 0.0), direction: DVec3::Z, weight_sr: 1.0 })
        }
    }

    /// Radiance 1 on average: even light in columns below 32, in the others `strength` with the chance of 1/`strength`, else none.
    struct Sparks {
        strength: f32,
    }

    impl RadianceField<1> for Sparks {
        fn radiance(&self, asked: &FieldRay, _: &Wavelengths<1>) -> Spectral<1> {
            // Far digits of a stratified number are not stratified.
            let u = (f64::from(asked.stream.two(Draw::Pupil, 0).x) * 9973.0).fract() as f32;
            let lit = asked.ray.origin.x < 32.0;
            Spectral::splat(if lit {
                1.0
            } else if u * self.strength < 1.0 {
                self.strength
            } else {
                0.0
            })
        }
    }

    fn film(field: &impl RadianceField<1>, factor: f64, tile_px: u32) -> Film {
        let tolerance = Tolerance::new(AdaptiveSampling { threshold: factor, min_spp: 16 }, None);
        let job = RenderJob {
            source: &Columns,
            exposure: FilmExposure::still(&PATH),
            width: 64,
            height: ROWS as u32,
            aperture_px: 1.0,
            layout: Layout { bands: None, folded: false, watched: true },
            mosaic: None,
            sampling: Sampling {
                spp: 4096,
                replicates: 8,
                seed: 11,
                camera: 0,
                shot: Shot::default(),
                low_nm: 500.0,
                high_nm: 501.0,
                spread: SpectrumSpread::Drawn,
            },
            tolerance: Some(tolerance),
            blocks: Blocks::SINGLE,
            tile_px,
            shard: Shard::WHOLE,
        };
        job.gather::<1>(field, &Unobserved).expect("not cancelled")
    }

    /// Rows of the film.
    const ROWS: usize = 384;

    /// Means, variances and samples of the columns from `first` to the 32nd after it.
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

    /// Two pilots of three see no spark, and would have stopped at 0 by their own word.
    #[test]
    fn rare_bright_light_has_no_bias_and_an_honest_variance() {
        let pixels = columns(&film(&Sparks { strength: 40.0 }, 0.3, 16), 32);
        let light = mean(pixels.iter().map(|p| p.0));
        let variance = mean(pixels.iter().map(|p| p.1));
        let error = (variance / pixels.len() as f64).sqrt();
        assert!((light - 1.0).abs() < 4.0 * error, "{light} ± {error}");
        let scatter = mean(pixels.iter().map(|p| (p.0 - 1.0) * (p.0 - 1.0)));
        // Of some 12 000 pixels; a pixel's square has at most some five times its mean as deviation.
        assert!(
            (scatter / variance - 1.0).abs() < 4.0 * 5.0 / (pixels.len() as f64).sqrt(),
            "{scatter} for {variance}"
        );
    }

    #[test]
    fn even_light_stops_at_the_pilot_and_noise_at_the_limit() {
        let film = film(&Sparks { strength: 3.0 }, 0.1, 16);
        assert!(
            columns(&film, 0).iter().all(|(light, variance, samples)| {
                (light - 1.0).abs() < 1e-6 && *variance < 1e-12 && *samples == 16
            })
        );
        // A sample has the variance 2, so that 200 make 0.1; 64 pixels of 3 replicates know that to a tenth.
        let noisy = columns(&film, 32);
        let error = mean(noisy.iter().map(|p| (p.0 - 1.0) * (p.0 - 1.0))).sqrt();
        let samples = mean(noisy.iter().map(|p| f64::from(p.2)));
        assert!((0.08..0.115).contains(&error), "{error}");
        assert!((180.0..320.0).contains(&samples), "{samples}");
    }

    #[test]
    fn tiles_do_not_change_the_film() {
        let sparks = Sparks { strength: 5.0 };
        assert_eq!(film(&sparks, 0.2, 16), film(&sparks, 0.2, 32));
    }
}
