//! Films of several passes: their combination, compared with each pass alone.

use super::film::Film;
use super::light::RaySource;
use super::observer::NullObserver;
use super::test_job::{sampling, still_job};
use crate::plan::{NumberedPass, Pass, Passes};
use crate::sizes::film::FilmLayout;
use etendue_core::random::Draw;
use etendue_core::{Bands, FieldRay, PupilRay, RadianceField, Spectral, Wavelengths};
use glam::{DVec2, DVec3};

const WIDTH: usize = 24;
const HEIGHT: usize = 16;

struct ForwardRays;

impl RaySource for ForwardRays {
    fn ray(&self, _: DVec2, _: DVec2, _: f64) -> Option<PupilRay> {
        Some(PupilRay { origin_m: DVec3::ZERO, direction: DVec3::Z, weight_sr: 0.25 })
    }
}

fn pixels() -> impl Iterator<Item = (usize, usize)> {
    (0..HEIGHT).flat_map(|y| (0..WIDTH).map(move |x| (x, y)))
}

/// Light that varies from sample to sample, with mean 1.
struct NoisyField;

impl RadianceField<4> for NoisyField {
    fn radiance(&self, field_ray: &FieldRay, _: &Wavelengths<4>) -> Spectral<4> {
        // The low-order digits of a stratified number are not stratified.
        Spectral::splat(2.0 * (f64::from(field_ray.stream.one(Draw::Pupil, 0)) * 9973.0).fract() as f32)
    }
}

fn pass_of(pass: NumberedPass, before: Option<&Film>) -> Film {
    let layout =
        FilmLayout { bands: Bands::covering(400.0, 700.0, 50.0), accumulates_electrons: false, watched: false };
    let job = still_job(&ForwardRays, [WIDTH as u32, HEIGHT as u32], layout, sampling(pass, 4));
    job.gather::<4>(&NoisyField, before, &NullObserver).expect("not cancelled")
}

fn passes() -> Passes {
    Passes::new(vec![Pass::all_pixels(8), Pass { samples: 4, part: 64 }, Pass::all_pixels(16)])
}

#[test]
fn passes_join_to_the_mean_of_all_samples_and_its_variance() {
    let passes = passes();
    let alone: Vec<Film> = (0..3).map(|number| pass_of(passes.at(number), None)).collect();
    let mut merged_film = pass_of(passes.at(0), None);
    for number in 1..3 {
        merged_film = pass_of(passes.at(number), Some(&merged_film));
    }
    let cube = |film: &Film| film.cube().expect("a cube").clone();
    let mut parts = 0;
    for pixel in pixels() {
        let weights: Vec<f64> = alone.iter().map(|film| f64::from(film.samples.at(pixel.0, pixel.1))).collect();
        let total: f64 = weights.iter().sum();
        let mean_of = |film: &Film| f64::from(cube(film).mean.planes()[2].at(pixel.0, pixel.1));
        let mean: f64 = alone.iter().zip(&weights).map(|(film, n)| n * mean_of(film)).sum();
        let variance = alone.iter().zip(&weights);
        let variance: f64 =
            variance.map(|(film, n)| n * n * f64::from(cube(film).variance.planes()[2].at(pixel.0, pixel.1))).sum();
        let film = cube(&merged_film);
        let actual = f64::from(film.variance.planes()[2].at(pixel.0, pixel.1));
        // Two roundings to f32.
        assert!((mean_of(&merged_film) / (mean / total) - 1.0).abs() < 3e-7, "{pixel:?}");
        assert!((actual / (variance / (total * total)) - 1.0).abs() < 3e-7, "{pixel:?}");
        assert_eq!(f64::from(merged_film.samples.at(pixel.0, pixel.1)), total);
        parts += usize::from(total == 28.0);
    }
    // A quarter of 24 × 16 pixels, evenly distributed.
    assert!(parts.abs_diff(96) <= 6, "{parts}");
}

#[test]
fn the_stated_variance_of_joined_passes_is_their_scatter() {
    let passes = Passes::new(vec![Pass::all_pixels(8), Pass::all_pixels(8), Pass::all_pixels(16)]);
    let mut merged_film = pass_of(passes.at(0), None);
    for number in 1..3 {
        merged_film = pass_of(passes.at(number), Some(&merged_film));
    }
    let cube = merged_film.cube().expect("a cube");
    let sum =
        |plane: &dyn Fn(usize, usize) -> f64| pixels().map(|(x, y)| plane(x, y)).sum::<f64>() / (WIDTH * HEIGHT) as f64;
    let planes = cube.mean.planes();
    let mean = sum(&|x, y| f64::from(planes[2].at(x, y)));
    let off = |x, y| f64::from(planes[2].at(x, y)) - mean;
    let scatter = sum(&|x, y| off(x, y) * off(x, y));
    let stated = sum(&|x, y| f64::from(cube.variance.planes()[2].at(x, y)));
    // For n pixels the relative uncertainty of the scatter is √(2/n), that of the estimate less; the limit is four times that.
    assert!(
        (scatter / stated - 1.0).abs() < 4.0 * (2.0_f64 / (WIDTH * HEIGHT) as f64).sqrt(),
        "{scatter} for {stated}"
    );
}
