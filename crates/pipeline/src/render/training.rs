//! Paths traced before an image to train path guiding at diffuse surfaces.
//!
//! Their number is a sixteenth of the pass's paths (with noise-limited sampling, of the paths common to all pixels), at most 524 288. They are spread evenly
//! over the whole film whatever part of it is rendered: every shard, and every run of the same pass, learns the same. They have their own random numbers and
//! are not part of the image.

use crate::plan::{CameraPlan, NumberedPass};
use crate::render::light::{RenderError, RenderJob};
use crate::render::observer::Observer;
use etendue_core::FieldRay;
use etendue_core::random::{Draw, PathStream, Pixel, PixelAddress};
use etendue_tracer::guiding::{Guide, Training};
use etendue_tracer::integrator::{PathTracer, SpectralPaths};
use rayon::prelude::*;

/// Image paths for each training path.
const PATHS_PER_CELL: u64 = 16;
/// Maximum number of training paths: one or two seconds of a single thread.
const MAX_PATHS: u64 = 1 << 19;
/// Number of paths between two tests for cancellation.
const CHUNK_PATHS: u64 = 1 << 12;
/// Steps from one path's pixel to the next, of columns and rows (Roberts 2018, the R2 sequence).
const STEPS: [f64; 2] = [0.754_877_666_246_692_7, 0.569_840_290_998_053_3];

/// Radiance that paths of the image find at diffuse surfaces, learned before a pass of it.
///
/// # Errors
/// The observer cancels.
pub(super) fn guide<const N: usize>(
    job: &RenderJob<'_>,
    tracer: &PathTracer<'_>,
    camera: &CameraPlan,
    observer: &dyn Observer,
) -> Result<Guide, RenderError>
where
    for<'t> PathTracer<'t>: SpectralPaths<N>,
{
    let training = Training::default();
    let paths = paths(job.width, job.height, spp(camera, job.sampling.pass));
    (0..paths.div_ceil(CHUNK_PATHS)).into_par_iter().try_for_each(|chunk| {
        if observer.cancelled() {
            return Err(RenderError::Cancelled);
        }
        (chunk * CHUNK_PATHS..paths.min((chunk + 1) * CHUNK_PATHS))
            .for_each(|path| train::<N>(job, tracer, path, &training));
        Ok(())
    })?;
    Ok(training.guide())
}

/// Number of training paths before the passes of a camera's image, all together.
#[must_use]
pub fn paths_of(camera: &CameraPlan) -> u64 {
    let passes = (0..camera.pass_count()).map(|number| camera.pass(number));
    let (width, height) = camera.film_size();
    passes.map(|pass| paths(width, height, spp(camera, pass))).sum()
}

/// Samples common to all pixels in a pass.
fn spp(camera: &CameraPlan, pass: NumberedPass) -> u32 {
    camera.settings.adaptive.map_or(pass.pass.samples, |limit| limit.min_spp)
}

/// Number of training paths before a pass, for columns, rows and samples per pixel.
fn paths(width: u32, height: u32, spp: u32) -> u64 {
    (u64::from(width) * u64::from(height) * u64::from(spp) / PATHS_PER_CELL).min(MAX_PATHS)
}

fn train<const N: usize>(job: &RenderJob<'_>, tracer: &dyn SpectralPaths<N>, path: u64, training: &Training) {
    let place = |step: f64, size: u32| (((0.5 + path as f64 * step).fract() * f64::from(size)) as u32).min(size - 1);
    let pixel = Pixel { x: place(STEPS[0], job.width), y: place(STEPS[1], job.height) };
    // Distinct from all addresses that are part of the image.
    let address = PixelAddress { replicate: u32::MAX, ..job.address(pixel, 0) };
    let stream = PathStream::new(&address, path as u32);
    let wavelengths = job.wavelengths::<N>(job.mosaic.map(|mosaic| mosaic.at(pixel)), stream.one(Draw::Wavelength, 0));
    let (displaced_px, _) = job.displacement(pixel, &stream, &wavelengths);
    let Some(pupil_ray) = job.pupil_ray(pixel, displaced_px, &stream, wavelengths.nm[0]) else { return };
    let moment_s = job.exposure.sample_time_s(pixel.y, job.time_number(&stream));
    let (ray, light_interval) =
        (job.exposure.to_render(&pupil_ray, moment_s), job.exposure.light_interval(pixel.y, moment_s));
    tracer.train(&FieldRay { ray, stream, light_interval }, &wavelengths, training);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sixteenth_of_the_paths_and_no_more_than_the_most() {
        assert_eq!(paths(32, 20, 16), 640);
        assert_eq!(paths(3, 1, 4), 0);
        assert_eq!(paths(u32::MAX, 2, 64), MAX_PATHS);
    }

    /// A wrong step of the sequence would leave gaps or hit pixels twice.
    #[test]
    fn paths_are_spread_over_the_film() {
        let place = |path: u32, step: f64| ((0.5 + f64::from(path) * step).fract() * 8.0) as usize;
        let mut counts = [[0; 8]; 8];
        (0..64 * 16).for_each(|path| counts[place(path, STEPS[0])][place(path, STEPS[1])] += 1);
        assert!(counts.iter().flatten().all(|count| (11..=21).contains(count)), "{counts:?}");
    }
}
