//! Point-spread functions from images on a film.

use etendue_core::Plane;
use etendue_core::WavelengthRange;
use etendue_core::quantity::{Irradiance, Variance};
use etendue_optics::effects::{FilmPart, PointSpread, SpreadImage, SpreadImageParameters};
use etendue_optics::{Effects, EffectsError, EffectsParameters};
use etendue_projection::Raster;
use glam::DVec2;

const BAND: WavelengthRange = WavelengthRange::new(545.0, 555.0);
const PIXEL_UM: f64 = 4.0;

fn raster() -> Raster {
    Raster::centred(41, 31, PIXEL_UM / 1000.0).expect("legal")
}

fn image(width: usize, light: &[f32], pitch_um: f64, wavelength_nm: Option<f64>) -> SpreadImageParameters {
    SpreadImageParameters { width, light: light.to_vec(), pitch_um, wavelength_nm, deviation: None }
}

fn spread(
    parameters: SpreadImageParameters,
    band: WavelengthRange,
    film: &Plane<Irradiance>,
    variance: Option<&Plane<Variance>>,
) -> (Plane<Irradiance>, Option<Plane<Variance>>) {
    let image = SpreadImage::new(parameters, &raster()).expect("legal");
    let psf = Some(PointSpread::Image(image));
    let effects = Effects::new(EffectsParameters { psf, margin: Some(0.0), ..Default::default() }, &raster());
    effects.expect("legal").prepared(&raster(), band, FilmPart::Whole).apply(band, film, variance)
}

fn film() -> Plane<Irradiance> {
    let value = |i: usize| ((i * 7919 + 104_729) % 1013) as f32 / 1013.0;
    Plane::from_samples(41, 31, (0..41 * 31).map(value).collect()).expect("one sample per pixel")
}

fn point() -> Plane<Irradiance> {
    let mut film = Plane::new(41, 31);
    film.set(20, 15, 1.0);
    film
}

/// Sum, centroid from the point and variance along x, px.
fn moments(image: &Plane<Irradiance>) -> (f64, DVec2, f64) {
    let place = |i: usize| DVec2::new((i % 41) as f64 - 20.0, (i / 41) as f64 - 15.0);
    let all = || image.samples().iter().enumerate().map(|(i, v)| (place(i), f64::from(*v)));
    let sum: f64 = all().map(|(_, v)| v).sum();
    let centroid = all().map(|(p, v)| p * v).sum::<DVec2>() / sum;
    (sum, centroid, all().map(|(p, v)| (p.x - centroid.x) * (p.x - centroid.x) * v).sum::<f64>() / sum)
}

#[test]
fn one_sample_is_the_identity_to_the_bit() {
    for wavelength_nm in [None, Some(800.0)] {
        assert_eq!(spread(image(1, &[37.0], 1.5, wavelength_nm), BAND, &film(), None).0, film());
    }
}

const SKEW: [f32; 9] = [1.0, 2.0, 0.0, 4.0, 5.0, 9.0, 0.0, 3.0, 1.0];

#[test]
fn three_by_three_samples_on_the_pixels_are_the_direct_convolution() {
    let variance: Plane<Variance> = film().map(|v| v);
    let (moments_found, spread_variance) = spread(image(3, &SKEW, PIXEL_UM, None), BAND, &film(), Some(&variance));
    let spread_variance = spread_variance.expect("given");
    for y in 1..30 {
        for x in 1..40 {
            let taps = || (0..9).map(|k| (SKEW[k] / 25.0, film().at(x + 1 - k % 3, y + 1 - k / 3)));
            let expected: f32 = taps().map(|(tap, v)| tap * v).sum();
            let wanted_variance: f32 = taps().map(|(tap, v)| tap * tap * v).sum();
            // Rounding of nine terms below 1 in 32 bits.
            assert!((moments_found.at(x, y) - expected).abs() < 1e-6, "({x}, {y})");
            assert!((spread_variance.at(x, y) - wanted_variance).abs() < 1e-6, "({x}, {y})");
        }
    }
}

#[test]
fn a_sample_to_the_right_and_below_moves_the_image_there() {
    let right_below = [0.0, 0.0, 0.0, 0.0, 0.0, 1.0];
    let spread_plane = spread(image(3, &right_below, PIXEL_UM, None), BAND, &point(), None).0;
    // One column right, and half a row below the centre between two rows.
    assert_eq!([spread_plane.at(21, 15), spread_plane.at(21, 16)], [0.5, 0.5]);
}

#[test]
fn sum_and_centroid_are_those_of_the_image_whatever_its_size_and_pitch() {
    let light: Vec<f32> = (0..12 * 7).map(|i| ((i * 37) % 19) as f32).collect();
    let place = |i: usize| DVec2::new((i % 12) as f64 - 5.5, (i / 12) as f64 - 3.0) * 2.6 / PIXEL_UM;
    let sum: f64 = light.iter().map(|v| f64::from(*v)).sum();
    let expected = light.iter().enumerate().map(|(i, v)| place(i) * f64::from(*v)).sum::<DVec2>() / sum;
    let (sum, centroid, _) = moments(&spread(image(12, &light, 2.6, None), BAND, &point(), None).0);
    // 32-bit pixels.
    assert!((sum - 1.0).abs() < 1e-6 && (centroid - expected).length() < 1e-5, "{sum} {centroid} {expected}");
}

#[test]
fn the_image_grows_with_the_wavelength_where_one_is_stated() {
    let two = |band, at| {
        let mut light = [0.0; 9];
        (light[0], light[8]) = (1.0, 1.0);
        moments(&spread(image(9, &light, 2.0, at), band, &point(), None).0).2
    };
    // Two samples 8 steps of 2 µm apart, 4 px: at ±2 px, whose variance is 4; at ±3 px at one and a half times the wavelength.
    let narrow = |nm: f64| WavelengthRange::new(nm - 1e-6, nm + 1e-6);
    assert!((two(narrow(500.0), Some(500.0)) - 4.0).abs() < 1e-5);
    assert!((two(narrow(750.0), Some(500.0)) - 9.0).abs() < 1e-5);
    for band in [narrow(500.0), narrow(750.0)] {
        assert!((two(band, None) - 4.0).abs() < 1e-5);
    }
}

#[test]
fn what_is_no_spread_is_refused() {
    let error_of = |parameters| SpreadImage::new(parameters, &raster()).expect_err("a fault");
    let of = |light: &[f32]| error_of(image(2, light, 2.0, None));
    assert_eq!(of(&[0.0; 4]), EffectsError::Dark);
    assert_eq!(of(&[1.0, 0.0, 0.5, -0.25]), EffectsError::NoLight { column: 1, row: 1, value: -0.25 });
    assert!(matches!(of(&[1.0, f32::NAN]), EffectsError::NoLight { column: 1, row: 0, .. }));
    assert_eq!(of(&[1.0; 3]), EffectsError::Samples { count: 3, width: 2 });
    assert!(matches!(of(&[]), EffectsError::Samples { .. }));
    assert!(matches!(error_of(image(1, &[1.0], 0.0, None)), EffectsError::NotPositive { key: "image_pitch_um", .. }));
    assert!(matches!(error_of(image(1, &[1.0], 1.0, Some(-1.0))), EffectsError::NotPositive { .. }));
    assert!(matches!(error_of(image(1, &[1.0], 4.1, None)), EffectsError::Coarse { .. }));
    assert!(matches!(error_of(image(1, &[1.0], 4.0, Some(550.0))), EffectsError::Coarse { .. }));
    assert!(matches!(
        error_of(image(1030, &[1.0; 1030], 4.0, None)),
        EffectsError::Wide { reach_px: 515, most_px: 512 }
    ));
}
