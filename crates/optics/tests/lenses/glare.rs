//! Veiling glare compared with closed forms.

use etendue_core::Plane;
use etendue_core::WavelengthRange;
use etendue_core::quantity::{Irradiance, Variance};
use etendue_optics::effects::{FilmPart, Glare, GlareParameters};
use etendue_optics::{Effects, EffectsError, EffectsParameters};
use etendue_projection::Raster;

const PITCH_MM: f64 = 0.01;

fn glare(scatter: f64, core_um: f64, exponent: f64, reach_mm: Option<f64>) -> Glare {
    Glare::new(GlareParameters { scatter, core_um, exponent, reach_mm }).expect("legal")
}

fn effects(glare: Glare, margin: f64, width: usize, height: usize) -> (Effects, Raster) {
    let raster = Raster::centred(width, height, PITCH_MM).expect("legal");
    let parameters = EffectsParameters { glare: Some(glare), margin: Some(margin), ..Default::default() };
    (Effects::new(parameters, &raster).expect("legal"), raster)
}

/// The image of a film that is filled by a function of its pixels.
fn glare_image(effects: &Effects, raster: &Raster, light: impl Fn(usize, usize) -> f32) -> Plane<Irradiance> {
    let film = effects.film(raster);
    let samples = (0..film.width() * film.height()).map(|i| light(i % film.width(), i / film.width())).collect();
    let film = Plane::from_samples(film.width(), film.height(), samples).expect("one sample per pixel");
    effects
        .prepared(raster, WavelengthRange::new(500.0, 600.0), FilmPart::Whole)
        .apply(WavelengthRange::new(500.0, 600.0), &film, None)
        .0
}

#[test]
fn a_black_spot_in_a_white_field_is_veiled_by_its_closed_form() {
    // The field ends 256 px from the centre: the fraction of the kernel beyond is subtracted.
    for (core_um, exponent, reach_mm) in [(4.0, 3.0, Some(1.9)), (30.0, 2.0, Some(1.5)), (100.0, 1.2, Some(1.0))] {
        let glare = glare(0.03, core_um, exponent, reach_mm);
        let (effects, raster) = effects(glare, 0.0, 513, 513);
        let radius_px = 40.0;
        let spot = |x: usize, y: usize| {
            let (x, y) = (x as f64 - 256.0, y as f64 - 256.0);
            f32::from(x * x + y * y > radius_px * radius_px)
        };
        let veil = f64::from(glare_image(&effects, &raster, spot).at(256, 256));
        let expected = 0.03 * (1.0 - glare.light_within(radius_px * PITCH_MM));
        // The spot's edge is jagged: half a pixel in forty at worst, far less on average over its border.
        assert!((veil / expected - 1.0).abs() < 3e-3, "{core_um} {exponent}: {veil} for {expected}");
    }
}

#[test]
fn a_square_outside_the_image_lights_it() {
    // Between the centres of square and pixel the density is nearly linear over the square.
    let glare = glare(0.02, 20.0, 2.6, None);
    let (effects, raster) = effects(glare, 0.25, 200, 120);
    assert_eq!(effects.margin_px(), [50, 30]);
    let lit = |x: usize, y: usize| if x < 10 && (70..80).contains(&y) { 1000.0 } else { 0.0 };
    let image = glare_image(&effects, &raster, lit);
    for (x, y) in [(0, 44), (60, 20), (199, 119)] {
        let (dx, dy) = ((x + 50) as f64 - 4.5, (y + 30) as f64 - 74.5);
        let distance_mm = PITCH_MM * (dx * dx + dy * dy).sqrt();
        let expected = 1000.0 * 0.02 * glare.density_per_mm2(distance_mm) * (10.0 * PITCH_MM) * (10.0 * PITCH_MM);
        let actual = f64::from(image.at(x, y));
        // Second order in the square's side over the distance: (10/45)² p²/24 = 1.4 % at the nearest.
        assert!((actual / expected - 1.0).abs() < 0.015, "at ({x}, {y}): {actual} for {expected}");
    }
}

#[test]
fn energy_is_kept_where_the_kernel_ends_within_the_film() {
    for (core_um, exponent) in [(0.5, 3.5), (7.0, 2.0), (60.0, 1.0)] {
        let glare = glare(0.4, core_um, exponent, Some(0.4));
        let (effects, raster) = effects(glare, 0.0, 101, 101);
        let image = glare_image(&effects, &raster, |x, y| f32::from(u8::from(x == 50 && y == 50)));
        let sum: f64 = image.samples().iter().map(|v| f64::from(*v)).sum();
        // Rounding of ten thousand pixels to 32 bits.
        assert!((sum - 1.0).abs() < 1e-6, "{core_um} {exponent}: {sum}");
        assert!(image.samples().iter().all(|v| *v >= 0.0));
    }
}

#[test]
fn the_kernel_within_a_circle_is_its_closed_form() {
    let glare = glare(0.5, 15.0, 2.4, None);
    let (effects, raster) = effects(glare, 0.0, 401, 401);
    let image = glare_image(&effects, &raster, |x, y| f32::from(u8::from(x == 200 && y == 200)));
    for radius_px in [5.0, 20.0, 60.0, 150.0] {
        let inside = |i: &usize| {
            let (x, y) = ((i % 401) as f64 - 200.0, (i / 401) as f64 - 200.0);
            x * x + y * y <= radius_px * radius_px
        };
        let sum: f64 = (0..401 * 401).filter(inside).map(|i| f64::from(image.samples()[i])).sum();
        let expected = 0.5 + 0.5 * glare.light_within(radius_px * PITCH_MM);
        // The circle's jagged edge: lattice points in a circle differ from its area by some of its border.
        assert!((sum - expected).abs() < 0.5 / radius_px / radius_px.sqrt(), "{radius_px}: {sum} for {expected}");
    }
}

#[test]
fn variances_go_through_the_squared_kernel() {
    let (effects, raster) = effects(glare(0.3, 10.0, 2.5, Some(0.05)), 0.0, 41, 41);
    let one = |i: usize| f32::from(u8::from(i == 20 * 41 + 20));
    let film = Plane::from_samples(41, 41, (0..41 * 41).map(one).collect()).expect("one sample per pixel");
    let variance: Plane<Variance> = film.map(|v| v);
    let (mean, variance) = effects.prepared(&raster, WavelengthRange::new(500.0, 600.0), FilmPart::Whole).apply(
        WavelengthRange::new(500.0, 600.0),
        &film,
        Some(&variance),
    );
    let variance = variance.expect("given");
    for (m, v) in mean.samples().iter().zip(variance.samples()) {
        assert!((m * m - v).abs() < 1e-7, "{m} {v}");
    }
    let unknown = Plane::filled(41, 41, f32::NAN);
    let (_, variance) = effects.prepared(&raster, WavelengthRange::new(500.0, 600.0), FilmPart::Whole).apply(
        WavelengthRange::new(500.0, 600.0),
        &film,
        Some(&unknown),
    );
    assert!(variance.expect("given").samples().iter().all(|v| v.is_nan()));
}

#[test]
fn what_scatters_nothing_is_absent() {
    let raster = Raster::centred(40, 30, PITCH_MM).expect("legal");
    let clean = EffectsParameters { glare: Some(glare(0.0, 10.0, 3.0, None)), ..Default::default() };
    let effects = Effects::new(clean.clone(), &raster).expect("legal");
    assert!(effects.is_idle() && effects.margin_px() == [0, 0]);
    let idle = Effects::new(EffectsParameters { margin: Some(0.1), ..clean }, &raster);
    assert_eq!(idle, Err(EffectsError::IdleMargin));
    let dirty = EffectsParameters { glare: Some(glare(0.1, 10.0, 3.0, None)), ..Default::default() };
    assert_eq!(Effects::new(dirty, &raster).expect("legal").margin_px(), [10, 8]);
}

#[test]
fn what_cannot_be_is_refused() {
    let new = |scatter, core_um, exponent| {
        Glare::new(GlareParameters { scatter, core_um, exponent, reach_mm: None }).expect_err("illegal")
    };
    assert_eq!(new(0.6, 1.0, 3.0), EffectsError::Scatter { fraction: 0.6, most: 0.5 });
    assert_eq!(new(0.1, 0.0, 3.0), EffectsError::NotPositive { key: "core_um", value: 0.0 });
    assert_eq!(new(0.1, 1.0, 2.0), EffectsError::Endless { exponent: 2.0 });
}
