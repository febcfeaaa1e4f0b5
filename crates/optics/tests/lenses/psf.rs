//! The point-spread function on a film.

use etendue_core::Plane;
use etendue_core::WavelengthRange;
use etendue_core::quantity::{Irradiance, Variance};
use etendue_optics::effects::{FilmPart, PointSpread, Psf, PsfParameters};
use etendue_optics::effects::{Zernike, ZernikeTerm};
use etendue_optics::{Effects, EffectsError, EffectsParameters, Lens, PinholeParameters};
use etendue_projection::Raster;
use glam::DVec2;

fn lens(focal_length_mm: f64, f_number: f64) -> Lens {
    Lens::pinhole(PinholeParameters { focal_length_mm, f_number, transmittance: 1.0 }).expect("legal")
}

fn round() -> PsfParameters {
    PsfParameters {
        blades: 0,
        curvature: 0.0,
        rotation_rad: 0.0,
        obstruction: 0.0,
        wavefront: Vec::new(),
        reach_mm: None,
        patches: None,
    }
}

fn effects(parameters: PsfParameters, lens: &Lens, raster: &Raster) -> Effects {
    let psf = Psf::new(parameters, lens, raster).expect("legal");
    Effects::new(
        EffectsParameters { psf: Some(PointSpread::Aperture(psf)), margin: Some(0.0), ..Default::default() },
        raster,
    )
    .expect("legal")
}

fn point(raster: &Raster, x: usize, y: usize) -> Plane<Irradiance> {
    let mut film = Plane::new(raster.width(), raster.height());
    film.set(x, y, 1.0);
    film
}

const BAND: WavelengthRange = WavelengthRange::new(540.0, 560.0);

fn centroid(image: &Plane<Irradiance>) -> DVec2 {
    let place = |i: usize| DVec2::new((i % image.width()) as f64, (i / image.width()) as f64);
    let sum: f64 = image.samples().iter().map(|v| f64::from(*v)).sum();
    let moment: DVec2 = image.samples().iter().enumerate().map(|(i, v)| place(i) * f64::from(*v)).sum();
    moment / sum
}

#[test]
fn a_point_keeps_its_light_and_its_place() {
    let raster = Raster::centred(121, 101, 0.003).expect("legal");
    let effects = effects(PsfParameters { reach_mm: Some(0.1), blades: 6, ..round() }, &lens(50.0, 8.0), &raster);
    let image = effects.prepared(&raster, BAND, FilmPart::Whole).apply(BAND, &point(&raster, 60, 50), None).0;
    let sum: f64 = image.samples().iter().map(|v| f64::from(*v)).sum();
    // 32-bit pixels; the lattice of the pattern has one more row on the side of the image's origin.
    assert!((sum - 1.0).abs() < 1e-6 && (centroid(&image) - DVec2::new(60.0, 50.0)).length() < 1e-3, "{sum}");
}

#[test]
fn a_uniform_irradiance_stays_uniform_whatever_the_patches() {
    let raster = Raster::centred(90, 70, 0.006).expect("legal");
    let coma =
        ZernikeTerm { zernike: Zernike::noll(8).expect("known"), field_mm: vec![0.0, 0.3], rms_um: vec![0.0, 0.2] };
    let parameters = PsfParameters { wavefront: vec![coma], reach_mm: Some(0.05), ..round() };
    let effects = effects(PsfParameters { patches: Some([3, 2]), ..parameters }, &lens(0.4, 4.0), &raster);
    let film = Plane::filled(90, 70, 2.0);
    let image = effects.prepared(&raster, BAND, FilmPart::Whole).apply(BAND, &film, None).0;
    for y in 10..60 {
        for x in 10..80 {
            assert!((image.at(x, y) - 2.0).abs() < 1e-6, "({x}, {y}): {}", image.at(x, y));
        }
    }
}

#[test]
fn a_spread_much_smaller_than_a_pixel_is_nearly_the_identity() {
    let raster = Raster::centred(31, 31, 0.5).expect("legal");
    let effects = effects(round(), &lens(50.0, 2.0), &raster);
    let image = effects.prepared(&raster, BAND, FilmPart::Whole).apply(BAND, &point(&raster, 15, 15), None).0;
    // Mean |x| + |y| of the pattern in units of a pixel: λN = 1.1 µm, reach 140 µm of 500.
    assert!(image.at(15, 15) > 0.99, "{}", image.at(15, 15));
}

#[test]
fn away_from_the_axis_the_pattern_is_wider_towards_it() {
    // θ′ = 45° at the node on the right: cos³ and cos differ by two.
    let raster = Raster::new(61, 61, DVec2::splat(0.002), DVec2::new(-970.0, 30.5)).expect("legal");
    let effects = effects(PsfParameters { patches: Some([1, 1]), ..round() }, &lens(2.001, 8.0), &raster);
    let image = effects.prepared(&raster, BAND, FilmPart::Whole).apply(BAND, &point(&raster, 30, 30), None).0;
    let half = |at: &dyn Fn(usize) -> f32| (0..30).map(at).take_while(|v| *v > 0.5 * image.at(30, 30)).count();
    let (wide, tall) = (half(&|i| image.at(30 + i, 30)), half(&|i| image.at(30, 30 + i)));
    // The half width of Airy's pattern is 0.51 λN: 2.27 µm here, times 2.83 and 1.41: 3.2 and 1.6 pixels.
    assert_eq!((wide, tall), (4, 2));
}

#[test]
fn coma_points_outwards_and_turns_with_the_field() {
    let raster = Raster::centred(81, 81, 0.004).expect("legal");
    let coma = |rms_um: f64| ZernikeTerm {
        zernike: Zernike::noll(8).expect("known"),
        field_mm: vec![0.0, 0.1],
        rms_um: vec![rms_um; 2],
    };
    let bright = |patches: [usize; 2], x: usize, y: usize| {
        let parameters = PsfParameters { wavefront: vec![coma(0.3)], patches: Some(patches), ..round() };
        let effects = effects(parameters, &lens(50.0, 8.0), &raster);
        let image = effects.prepared(&raster, BAND, FilmPart::Whole).apply(BAND, &point(&raster, x, y), None).0;
        let brightest = (0..81 * 81).max_by(|a, b| image.samples()[*a].total_cmp(&image.samples()[*b])).expect("some");
        DVec2::new((brightest % 81) as f64, (brightest / 81) as f64) - DVec2::new(x as f64, y as f64)
    };
    // The bright core of W = a √8 (3r³ − 2r) cos θ lies where the rays of its centre land: 2N ∂W/∂x(0) = −2N 2√8 a = −27 µm.
    let right = bright([5, 1], 72, 40);
    let below = bright([1, 5], 40, 72);
    assert!(right.x < -3.0 && right.y == 0.0 && below.y < -3.0 && below.x == 0.0, "{right} {below}");
}

#[test]
fn variances_go_through_the_squared_function() {
    let raster = Raster::centred(61, 61, 0.003).expect("legal");
    let effects = effects(PsfParameters { reach_mm: Some(0.05), ..round() }, &lens(50.0, 5.6), &raster);
    let film = point(&raster, 30, 30);
    let variance: Plane<Variance> = film.map(|v| v);
    let (mean, variance) = effects.prepared(&raster, BAND, FilmPart::Whole).apply(BAND, &film, Some(&variance));
    for (m, v) in mean.samples().iter().zip(variance.expect("given").samples()) {
        assert!((m * m - v).abs() < 1e-7, "{m} {v}");
    }
}

#[test]
fn what_cannot_be_is_refused() {
    let raster = Raster::centred(61, 61, 0.003).expect("legal");
    let defocus = |rms_um| ZernikeTerm { zernike: Zernike::noll(4).expect("known"), field_mm: Vec::new(), rms_um };
    let new = |term| Psf::new(PsfParameters { wavefront: vec![term], ..round() }, &lens(50.0, 5.6), &raster);
    assert!(matches!(new(defocus(vec![30.0])), Err(EffectsError::Slope { .. })));
    assert_eq!(new(defocus(vec![0.1, 0.2])).expect_err("two"), EffectsError::Table);
    assert!(new(defocus(vec![0.5])).is_ok());
}

/// The Airy disc of f/10⁵ has a radius of 67 mm: samples of the pattern would be 400 px apart, and the image would have the wrong amount of light.
#[test]
fn a_pattern_wider_than_can_be_computed_is_refused() {
    let raster = Raster::centred(32, 24, 0.005).expect("legal");
    let new = |f_number| Psf::new(round(), &lens(5.0, f_number), &raster);
    for f_number in [411.0, 1e4, 1e5, 1e6] {
        assert!(matches!(new(f_number), Err(EffectsError::WidePattern { .. })), "f/{f_number}");
    }
    // The limit is λN = 64 px at 780 nm: f/410.2.
    assert!(new(410.0).is_ok(), "a pinhole");
}

/// The Airy disc of a pinhole of f/400: half its peak at 0.5145 λN, dark at 1.2197 λN (Born and Wolf, 8.5.2), which are 22.6 px and 53.7 px. The
/// pupil is 18 cells wide, so its area, and with it the width, is accurate to 2 %.
#[test]
fn the_pattern_of_a_pinhole_is_an_airy_disc() {
    let raster = Raster::centred(241, 241, 0.005).expect("legal");
    let effects = effects(round(), &lens(5.0, 400.0), &raster);
    let image = effects.prepared(&raster, BAND, FilmPart::Whole).apply(BAND, &point(&raster, 120, 120), None).0;
    let at = |distance: usize| f64::from(image.at(120 + distance, 120)) / f64::from(image.at(120, 120));
    let half = (1..60).find(|distance| at(*distance) < 0.5).expect("falls");
    assert!((22..=24).contains(&half), "{half}");
    let darkest = (40..70).min_by(|a, b| at(*a).total_cmp(&at(*b))).expect("some");
    assert!((52..=56).contains(&darkest) && at(darkest) < 2e-3, "{darkest} {}", at(darkest));
}

#[test]
fn diffraction_has_the_modulation_of_a_circle_along_rows_and_columns() {
    use core::f64::consts::{PI, TAU};
    use etendue_core::maths::f64::{acos, cos};
    let band = WavelengthRange::new(549.0, 551.0);
    for (pitch_mm, f_number) in [(0.003, 2.0), (0.003, 2.8), (0.0083, 2.8), (0.0083, 8.0), (0.0014, 2.8)] {
        let raster = Raster::centred(301, 301, pitch_mm).expect("legal");
        let effects = effects(PsfParameters { patches: Some([1, 1]), ..round() }, &lens(50.0, f_number), &raster);
        let image = effects.prepared(&raster, band, FilmPart::Whole).apply(band, &point(&raster, 150, 150), None).0;
        assert!(image.samples().iter().all(|v| *v >= -1e-9), "no light is negative, to rounding");
        for f in [0.05, 0.1, 0.2, 0.3, 0.4, 0.45, 0.5] {
            let v = f * 550e-6 * f_number / pitch_mm;
            let expected = 2.0 / PI * (acos(v) - v * (1.0 - v * v).sqrt());
            let wave = |i: usize, of: fn(usize) -> usize| {
                f64::from(image.samples()[i]) * cos(TAU * f * (of(i) as f64 - 150.0))
            };
            let along = |of: fn(usize) -> usize| (0..301 * 301).map(|i| wave(i, of)).sum::<f64>();
            for profile in [along(|i| i % 301), along(|i| i / 301)] {
                // The sinc's window mixes f and 1 − f near 0.5 (0.004), and a little light lies beyond the pattern's end.
                assert!((profile - expected).abs() < 0.005, "{pitch_mm} f/{f_number} at {f}: {profile} for {expected}");
            }
        }
    }
}
