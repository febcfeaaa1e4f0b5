//! Samples displaced by the point spread, on the film of a pattern of light.

use super::film::Film;
use super::light::{RaySource, RenderJob};
use super::observer::NullObserver;
use super::test_job::{sampling, still_job};
use crate::plan::NumberedPass;
use crate::sizes::film::FilmLayout;
use core::f64::consts::{PI, TAU};
use etendue_core::maths::f64::{cos, exp, sin};
use etendue_core::{Bands, FieldRay, PupilRay, RadianceField, Spectral, WavelengthRange, Wavelengths};
use etendue_optics::effects::{
    PointSpread, Psf, PsfParameters, SampleSpread, SpreadImage, SpreadImageParameters, SpreadMethod,
};
use etendue_optics::{Effects, EffectsParameters, Lens, ThinParameters};
use etendue_projection::Raster;
use glam::{DVec2, DVec3};

const SIDE: u32 = 32;
const PITCH_MM: f64 = 0.004;

/// The film position is the origin of the ray.
struct PositionRays;

impl RaySource for PositionRays {
    fn ray(&self, raster_px: DVec2, _: DVec2, _: f64) -> Option<PupilRay> {
        Some(PupilRay { origin_m: raster_px.extend(0.0), direction: DVec3::Z, weight_sr: 1.0 })
    }
}

/// Bars across the columns with the given frequency, cycles per pixel, and mean 1.
struct BarField(f64);

impl RadianceField<4> for BarField {
    fn radiance(&self, field_ray: &FieldRay, _: &Wavelengths<4>) -> Spectral<4> {
        Spectral::splat((1.0 + cos(TAU * self.0 * f64::from(field_ray.ray.origin.x))) as f32)
    }
}

/// Four bands, one for each of the four wavelengths of a sample.
fn film(field: &BarField, spread: Option<&SampleSpread>, spp: u32) -> Film {
    let layout =
        FilmLayout { bands: Bands::covering(400.0, 700.0, 75.0), accumulates_electrons: false, watched: false };
    let job = still_job(&PositionRays, [SIDE, SIDE], layout, sampling(NumberedPass::only(spp), 4));
    RenderJob { sample_spread: spread, ..job }.gather::<4>(field, None, &NullObserver).expect("not cancelled")
}

fn means(film: &Film) -> Vec<f64> {
    film.cube().expect("a cube").mean.planes()[0].samples().iter().map(|v| f64::from(*v)).collect()
}

fn spread(psf: PointSpread) -> SampleSpread {
    let raster = Raster::centred(SIDE as usize, SIDE as usize, PITCH_MM).expect("legal");
    let spread_by = Some(SpreadMethod::Samples);
    let parameters = EffectsParameters { psf: Some(psf), spread_by, margin: Some(0.0), ..Default::default() };
    let effects = Effects::new(parameters, &raster).expect("legal");
    effects.sample_spread(&raster, WavelengthRange::new(400.0, 700.0)).expect("narrow enough for samples")
}

fn raster() -> Raster {
    Raster::centred(SIDE as usize, SIDE as usize, PITCH_MM).expect("legal")
}

fn gaussian(sigma_px: f64) -> PointSpread {
    const WIDE: usize = 49;
    let at = |i: usize| (DVec2::new((i % WIDE) as f64, (i / WIDE) as f64) - 24.0) / 12.0;
    let light = |i: usize| exp(-0.5 * at(i).length_squared() / (sigma_px * sigma_px)) as f32;
    let light = (0..WIDE * WIDE).map(light).collect();
    let pitch_um = 1e3 * PITCH_MM / 12.0;
    let image = SpreadImageParameters { width: WIDE, light, pitch_um, wavelength_nm: None, deviation: None };
    PointSpread::Image(SpreadImage::new(image, &raster()).expect("a picture"))
}

/// A kernel sampled at whole pixels has 0.08 too little at 0.4 px and a quarter of a cycle.
#[test]
fn bars_behind_a_narrow_gaussian_keep_their_contrast() {
    for (sigma_px, cycles) in [(0.2, 0.25), (0.4, 0.25), (0.4, 0.125)] {
        let contrasts = means(&film(&BarField(cycles), Some(&spread(gaussian(sigma_px))), 256));
        let wave = |(i, v): (usize, &f64)| 2.0 * v * cos(TAU * cycles * ((i % SIDE as usize) as f64 + 0.5));
        let contrast = contrasts.iter().enumerate().map(wave).sum::<f64>() / contrasts.len() as f64;
        let pixel = sin(PI * cycles) / (PI * cycles);
        let expected = pixel * exp(-2.0 * (PI * sigma_px * cycles) * (PI * sigma_px * cycles));
        // 262 144 samples of a wave with a standard deviation below 1 (0.002 each way at 95 %), and 0.001 of the cells.
        assert!((contrast - expected).abs() < 0.003, "{sigma_px} at {cycles}: {contrast} for {expected}");
    }
}

/// The weights of a path's wavelengths add noise where their functions differ in width.
#[test]
fn even_light_stays_even_but_for_the_noise_of_wavelengths() {
    let scatter = |psf: PointSpread, spp: u32| {
        let values = means(&film(&BarField(0.0), Some(&spread(psf)), spp));
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        let square = values.iter().map(|v| (v - mean) * (v - mean)).sum::<f64>();
        (0.5 * mean, (square / values.len() as f64).sqrt() / mean)
    };
    let (mean, noise) = scatter(gaussian(0.4), 16);
    assert!((mean - 1.0).abs() < 1e-6 && noise < 1e-6, "the same at all wavelengths: {mean} {noise}");
    let lens =
        ThinParameters { focal_length_mm: 50.0, f_number: 4.0, focus_distance_m: f64::INFINITY, transmittance: 1.0 };
    let round = PsfParameters {
        blades: 0,
        curvature: 0.0,
        rotation_rad: 0.0,
        obstruction: 0.0,
        wavefront: Vec::new(),
        reach_mm: None,
        patches: None,
    };
    let diffraction = Psf::new(round, &Lens::thin(lens).expect("a lens"), &raster()).expect("legal");
    let (mean, noise) = scatter(PointSpread::Aperture(diffraction), 64);
    assert!((mean - 1.0).abs() < 4.0 * noise / f64::from(2 * SIDE), "{mean} {noise}");
    // Measured: 0.042.
    assert!(noise < 0.37 / 8.0, "{noise}");
}
