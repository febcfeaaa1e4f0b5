//! Point spreads wider than the picture and narrower than a pixel.

use core::f64::consts::{PI, TAU};
use etendue_core::Plane;
use etendue_core::WavelengthRange;
use etendue_core::maths::f64::{cos, exp};
use etendue_core::quantity::Irradiance;
use etendue_core::random::Pixel;
use etendue_optics::effects::{
    FilmPart, PointSpread, SpreadImage, SpreadImageParameters, SpreadMethod, SpreadRandomNumbers,
};
use etendue_optics::{Effects, EffectsParameters};
use etendue_projection::Raster;
use etendue_testkit::page::{Row, check, worst};
use glam::DVec2;

const PITCH_UM: f64 = 4.0;
/// Draws along each axis of the square.
const SAMPLES_PER_AXIS: usize = 160;
const RANGE: WavelengthRange = WavelengthRange::new(500.0, 600.0);

/// A picture of so many pixels a side behind a Gaussian of `sigma_px`, sampled `per_px` times a pixel.
fn behind_gaussian(
    (side, margin): (usize, f64),
    sigma_px: f64,
    per_px: f64,
    spread_by: SpreadMethod,
) -> (Raster, Effects) {
    let raster = Raster::centred(side, side, 1e-3 * PITCH_UM).expect("legal");
    let width = 2 * (6.0 * sigma_px * per_px) as usize + 1;
    let at = |i: usize| (DVec2::new((i % width) as f64, (i / width) as f64) - (width / 2) as f64) / per_px;
    let light = (0..width * width).map(|i| exp(-0.5 * at(i).length_squared() / (sigma_px * sigma_px)) as f32);
    let image = SpreadImageParameters {
        width,
        light: light.collect(),
        pitch_um: PITCH_UM / per_px,
        wavelength_nm: None,
        deviation: None,
    };
    let psf = PointSpread::Image(SpreadImage::new(image, &raster).expect("a picture"));
    let parameters =
        EffectsParameters { psf: Some(psf), spread_by: Some(spread_by), margin: Some(margin), ..Default::default() };
    let effects = Effects::new(parameters, &raster).expect("legal");
    (raster, effects)
}

/// The contrast that displaced samples leave to bars of so many cycles a pixel.
fn contrast_of_samples(sigma_px: f64, cycles: f64) -> f64 {
    let (raster, effects) = behind_gaussian((64, 0.0), sigma_px, 24.0, SpreadMethod::Samples);
    let spread = effects.sample_spread(&raster, RANGE).expect("narrow enough for samples");
    let wave = |i: usize| {
        // A lattice, with a golden-ratio sequence for the choice.
        let choice = (0.618_033_988_75 * i as f64).fract();
        let place =
            (DVec2::new((i % SAMPLES_PER_AXIS) as f64, (i / SAMPLES_PER_AXIS) as f64) + 0.5) / SAMPLES_PER_AXIS as f64;
        let (offset_px, [weight]) =
            spread.sample_offset(Pixel { x: 32, y: 32 }, &[550.0], SpreadRandomNumbers { choice, place });
        f64::from(weight) * cos(TAU * cycles * offset_px.x)
    };
    (0..SAMPLES_PER_AXIS * SAMPLES_PER_AXIS).map(wave).sum::<f64>() / (SAMPLES_PER_AXIS * SAMPLES_PER_AXIS) as f64
}

/// Standard deviation of the wide Gaussian, and pixels a side of the picture behind it.
const WIDE_PX: f64 = 48.0;
const SIDE: usize = 16;

/// Even light of 1 behind a Gaussian three times as wide as the picture, which has no margin: the largest relative error of a pixel.
fn uniform_light_behind_wide_spread() -> f64 {
    let (raster, effects) = behind_gaussian((SIDE, 0.0), WIDE_PX, 1.0, SpreadMethod::Film);
    let uniform = Plane::<Irradiance>::filled(SIDE, SIDE, 1.0);
    let (spread, _) = effects.prepared(&raster, RANGE, FilmPart::Whole).apply(RANGE, &uniform, None);
    let fractions: Vec<f64> = (0..SIDE).map(fraction_from_image).collect();
    let pixels = spread.samples().iter().zip(0..);
    worst(pixels.map(|(v, i)| (f64::from(*v) / (fractions[i % SIDE] * fractions[i / SIDE]) - 1.0).abs()))
}

/// The part of the wide Gaussian, along one axis, that a pixel receives from the pixels of the picture.
fn fraction_from_image(pixel: usize) -> f64 {
    let weight = |offset: f64| exp(-0.5 * (offset / WIDE_PX) * (offset / WIDE_PX));
    let reach = (6.0 * WIDE_PX) as i32;
    let all: f64 = (-reach..=reach).map(|offset| weight(f64::from(offset))).sum();
    (0..SIDE).map(|source| weight(source as f64 - pixel as f64)).sum::<f64>() / all
}

#[test]
fn point_spreads() {
    let narrow = |sigma_px: f64, cycles: f64| {
        let exact = exp(-2.0 * (PI * sigma_px * cycles) * (PI * sigma_px * cycles));
        Row::at_most(
            &format!("a Gaussian of {sigma_px} px, bars of {cycles} cycles/px"),
            &format!("contrast {exact:.3} (absolute error)"),
            (contrast_of_samples(sigma_px, cycles) - exact).abs(),
            6e-3,
        )
    };
    let mut rows: Vec<Row> =
        [(0.05, 0.5), (0.1, 0.25), (0.2, 0.5), (0.4, 0.25), (0.4, 0.5)].map(|(s, c)| narrow(s, c)).into();
    rows.push(Row::at_most(
        "a Gaussian three times as wide as an image without margin, uniform illumination",
        "the part of the function within the image, in every pixel (relative error)",
        uniform_light_behind_wide_spread(),
        // Some roundings of f32, in which the spread's picture and the film are held.
        1e-6,
    ));
    let introduction = "Narrow point spreads displace samples (`spread_by = \"samples\"`, the default where the film would be wrong, by up to 0.08 at 0.4 px); wide ones are applied to the film.";
    check("Point spreads", introduction, &rows);
}
