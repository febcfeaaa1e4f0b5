//! Films of one frame: pixels, tiles, shards, and the noise of bands.

use super::*;
use crate::render::observer::NullObserver;
use crate::render::test_job::{sampling, still_job};
use etendue_core::Bands;
use etendue_core::ray::ConstantField;
use glam::DVec3;

struct LeftHalfRays;

impl RaySource for LeftHalfRays {
    fn ray(&self, raster_px: DVec2, _pupil: DVec2, _wavelength_nm: f64) -> Option<PupilRay> {
        let ray = PupilRay { origin_m: DVec3::ZERO, direction: DVec3::Z, weight_sr: 0.25 };
        (raster_px.x < 4.0).then_some(ray)
    }
}

fn exposure(tile_px: u32, shard: Shard) -> RenderJob<'static> {
    let layout =
        FilmLayout { bands: Bands::covering(400.0, 700.0, 50.0), accumulates_electrons: false, watched: false };
    RenderJob { tile_px, shard, ..still_job(&LeftHalfRays, [9, 5], layout, sampling(NumberedPass::only(64), 2)) }
}

fn film(tile_px: u32, shard: Shard) -> Film {
    exposure(tile_px, shard).gather::<4>(&ConstantField { radiance: 2.0 }, None, &NullObserver).expect("not cancelled")
}

#[test]
fn a_stopped_pixel_is_dark_and_an_open_one_sees_weight_times_radiance() {
    let film = film(4, Shard::WHOLE);
    let cube = film.cube().expect("a cube");
    let sum = |x: usize| cube.mean.planes().iter().map(|p| p.at(x, 2)).sum::<f32>() / 6.0;
    assert!((sum(1) - 0.5).abs() < 1e-6, "the mean over all bands is exact: {}", sum(1));
    assert_eq!(sum(7), 0.0);
    assert_eq!(film.radiance().expect("a cube").mean.planes()[0].at(7, 2), 0.0);
}

#[test]
fn tiles_and_shards_do_not_change_the_film() {
    let full = film(16, Shard::WHOLE);
    assert_eq!(film(2, Shard::WHOLE), full);
    let mut merged_film = exposure(2, Shard::WHOLE).empty_film();
    for index in 0..3 {
        let shard = Shard::new(index, 3).expect("a shard");
        let part = film(2, shard);
        tiles(9, 5, 2, shard).into_iter().for_each(|tile| merged_film.copy_tile(tile, &part));
    }
    assert_eq!(merged_film, full);
}

/// All values of the lit pixels of a uniform field of radiance 1 over a weight of 0.25, in bands of 5 nm.
fn bands(spp: u32, replicates: u32, spread: SpectrumSpread) -> Vec<f64> {
    let mut exposure = exposure(16, Shard::WHOLE);
    exposure.width = 64;
    exposure.height = 40;
    exposure.layout.bands = Bands::covering(380.0, 780.0, 5.0);
    let (low_nm, high_nm) = (380.0, 780.0);
    exposure.sampling =
        Sampling { pass: NumberedPass::only(spp), replicates, low_nm, high_nm, spread, ..exposure.sampling };
    let film = exposure.gather::<4>(&ConstantField { radiance: 4.0 }, None, &NullObserver).expect("not cancelled");
    let cube = film.cube().expect("a cube");
    let bands_at =
        |y: usize, x: usize| cube.mean.planes().iter().map(move |p| f64::from(p.at(x, y))).collect::<Vec<_>>();
    (0..40).flat_map(|y| (0..4).flat_map(move |x| bands_at(y, x)).collect::<Vec<_>>()).collect()
}

fn moments(values: &[f64]) -> (f64, f64) {
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    let square = values.iter().map(|v| (v - mean) * (v - mean)).sum::<f64>();
    (mean, (square / values.len() as f64).sqrt())
}

/// 64 wavelengths of 80 bands: none or one in each, where independent ones gave 0 to 7.5.
#[test]
fn bands_of_uniform_light_are_sampled_as_evenly_as_wavelengths_allow() {
    let uniform = bands(16, 4, SpectrumSpread::AllReplicates);
    assert!(uniform.iter().all(|v| *v == 0.0 || (v - 1.25).abs() < 1e-5), "{:?}", moments(&uniform));
    let random = bands(16, 4, SpectrumSpread::Drawn);
    assert!(random.iter().any(|v| *v > 4.0), "{:?}", moments(&random));
    // 320 wavelengths: four in every band.
    assert!(bands(80, 4, SpectrumSpread::AllReplicates).iter().all(|v| (v - 1.0).abs() < 1e-5));
}

#[test]
fn the_noise_of_a_band_is_the_estimated_one_and_its_mean_the_light() {
    for (spp, replicates, spread) in [
        (16, 4, SpectrumSpread::AllReplicates),
        (48, 2, SpectrumSpread::AllReplicates),
        (16, 4, SpectrumSpread::EachReplicate),
        (64, 4, SpectrumSpread::EachReplicate),
    ] {
        let values = bands(spp, replicates, spread);
        let ((mean, noise), n) = (moments(&values), values.len() as f64);
        let estimated = spread.band_noise(spp, replicates, 4, 5.0 / 400.0).expect("spread");
        assert!((mean - 1.0).abs() < 5.0 * estimated / n.sqrt() + 1e-6, "{spread:?} {spp}: {mean}");
        assert!((noise / estimated - 1.0).abs() < 0.05, "{spread:?} {spp}: {noise} for {estimated}");
    }
}
