//! Point spreads whose core displaces samples: modulation of the displacements and of the part left to the film.

use core::f64::consts::{PI, TAU};
use etendue_core::Plane;
use etendue_core::WavelengthRange;
use etendue_core::maths::f64::{acos, cos, exp};
use etendue_core::quantity::Irradiance;
use etendue_core::random::Pixel;
use etendue_optics::effects::{
    FilmPart, PointSpread, Psf, PsfParameters, SampleSpread, SpreadImage, SpreadImageParameters, SpreadMethod,
    SpreadRandomNumbers, Zernike, ZernikeTerm,
};
use etendue_optics::{Effects, EffectsError, EffectsParameters, Lens, ThinParameters};
use etendue_projection::Raster;
use glam::DVec2;

const RANGE: WavelengthRange = WavelengthRange::new(400.0, 720.0);
const PITCH_UM: f64 = 4.0;
/// Samples along each axis of the square.
const SAMPLES_PER_AXIS: usize = 160;

fn raster() -> Raster {
    fine_raster(1)
}

/// The same sensor with `times` as many pixels along its sides.
fn fine_raster(times: usize) -> Raster {
    Raster::centred(64 * times, 48 * times, 1e-3 * PITCH_UM / times as f64).expect("legal")
}

fn effects(psf: PointSpread, spread_by: Option<SpreadMethod>) -> Result<Effects, EffectsError> {
    let parameters = EffectsParameters { psf: Some(psf), spread_by, margin: Some(0.0), ..Default::default() };
    Effects::new(parameters, &raster())
}

/// An image of a Gaussian, sampled at twelfths of a pixel.
fn gaussian(sigma_px: f64) -> PointSpread {
    const SIDE: usize = 85;
    let step = 1.0 / 12.0;
    let light = |i: usize| {
        let at = (DVec2::new((i % SIDE) as f64, (i / SIDE) as f64) - (SIDE / 2) as f64) * step;
        exp(-0.5 * at.length_squared() / (sigma_px * sigma_px)) as f32
    };
    let light = (0..SIDE * SIDE).map(light).collect();
    let parameters =
        SpreadImageParameters { width: SIDE, light, pitch_um: PITCH_UM * step, wavelength_nm: None, deviation: None };
    PointSpread::Image(SpreadImage::new(parameters, &raster()).expect("a picture"))
}

fn aperture(f_number: f64, wavefront: Vec<ZernikeTerm>) -> PointSpread {
    let lens = Lens::thin(ThinParameters {
        focal_length_mm: 50.0,
        f_number,
        focus_distance_m: f64::INFINITY,
        transmittance: 1.0,
    });
    let parameters = PsfParameters {
        blades: 0,
        curvature: 0.0,
        rotation_rad: 0.0,
        obstruction: 0.0,
        wavefront,
        reach_mm: None,
        patches: None,
    };
    PointSpread::Aperture(Psf::new(parameters, &lens.expect("a lens"), &raster()).expect("legal"))
}

/// Mean weight and modulation (real, imaginary) of each wavelength's displacements at a frequency, cycles per pixel.
fn sampled_modulation<const N: usize>(spread: &SampleSpread, nm: [f32; N], frequency: DVec2) -> [(f64, DVec2); N] {
    let mut sums = [(0.0, DVec2::ZERO); N];
    for i in 0..SAMPLES_PER_AXIS * SAMPLES_PER_AXIS {
        // A lattice, with a golden-ratio sequence for the choice.
        let choice = (0.618_033_988_75 * i as f64).fract();
        let place =
            (DVec2::new((i % SAMPLES_PER_AXIS) as f64, (i / SAMPLES_PER_AXIS) as f64) + 0.5) / SAMPLES_PER_AXIS as f64;
        let (offset_px, weights) =
            spread.sample_offset(Pixel { x: 32, y: 24 }, &nm, SpreadRandomNumbers { choice, place });
        let phase = TAU * frequency.dot(offset_px);
        let wave = DVec2::new(cos(phase), cos(phase - 0.5 * PI));
        for ((weight, sum), own) in sums.iter_mut().zip(weights) {
            *weight += f64::from(own);
            *sum += f64::from(own) * wave;
        }
    }
    let n = (SAMPLES_PER_AXIS * SAMPLES_PER_AXIS) as f64;
    sums.map(|(weight, sum)| (weight / n, sum / n))
}

/// The modulation (real, imaginary) of a film's part of the function, at one wavelength.
fn film_modulation(effects: &Effects, part: FilmPart, nm: f64, frequency: DVec2) -> DVec2 {
    film_modulation_on(&raster(), effects, part, nm, frequency)
}

fn film_modulation_on(raster: &Raster, effects: &Effects, part: FilmPart, nm: f64, frequency: DVec2) -> DVec2 {
    let (x, y) = (raster.width() / 2, raster.height() / 2);
    let mut film: Plane<Irradiance> = Plane::new(raster.width(), raster.height());
    film.set(x, y, 1.0);
    let band = WavelengthRange::new(nm - 1.0, nm + 1.0);
    let (spread, _) = effects.prepared(raster, band, part).apply(band, &film, None);
    let wave = |(i, v): (usize, &f32)| {
        let at = DVec2::new((i % raster.width()) as f64 - x as f64, (i / raster.width()) as f64 - y as f64);
        let phase = TAU * frequency.dot(at);
        f64::from(*v) * DVec2::new(cos(phase), cos(phase - 0.5 * PI))
    };
    spread.samples().iter().enumerate().map(wave).sum()
}

/// Modulation of displaced samples on a film that spreads the tails.
fn product(samples: DVec2, film: DVec2) -> DVec2 {
    DVec2::new(samples.x * film.x - samples.y * film.y, samples.x * film.y + samples.y * film.x)
}

fn directions() -> [DVec2; 3] {
    [DVec2::X, DVec2::Y, DVec2::splat(0.5f64.sqrt())]
}

#[test]
fn narrow_gaussians_keep_their_contrast() {
    for sigma_px in [0.1, 0.2, 0.4, 0.6] {
        let effects = effects(gaussian(sigma_px), Some(SpreadMethod::Samples)).expect("narrow");
        let spread = effects.sample_spread(&raster(), RANGE).expect("samples");
        for f in [0.125, 0.25, 0.5] {
            for along in directions() {
                let [(weight, actual), ..] = sampled_modulation(&spread, [450.0f32, 550.0, 600.0, 700.0], along * f);
                let modulation = product(actual, film_modulation(&effects, FilmPart::Tails, 550.0, along * f)).x;
                let expected = exp(-2.0 * (PI * sigma_px * f) * (PI * sigma_px * f));
                assert_eq!(weight, 1.0, "the same at all wavelengths");
                // Half a per cent at half a cycle, from the cells; the bilinear loss of the light beyond a pixel, largest at 0.6 px.
                assert!(
                    (modulation - expected).abs() < 0.006,
                    "{sigma_px} at {f} along {along}: {modulation} for {expected}"
                );
                assert!(actual.y.abs() < 1e-3, "even");
            }
        }
    }
}

#[test]
fn diffraction_keeps_its_contrast_at_each_of_a_path_s_wavelengths() {
    for f_number in [2.0, 4.0, 8.0] {
        let effects = effects(aperture(f_number, Vec::new()), Some(SpreadMethod::Samples)).expect("narrow");
        let spread = effects.sample_spread(&raster(), RANGE).expect("samples");
        let nm = [425.0f32, 505.0, 585.0, 665.0];
        for (f, along) in [0.125, 0.25, 0.5].into_iter().flat_map(|f| directions().map(|along| (f, along))) {
            for ((weight, actual), nm) in sampled_modulation(&spread, nm, along * f).into_iter().zip(nm.map(f64::from))
            {
                let v = f * nm * 1e-3 * f_number / PITCH_UM;
                let expected = if v < 1.0 { 2.0 / PI * (acos(v) - v * (1.0 - v * v).sqrt()) } else { 0.0 };
                let modulation = product(actual, film_modulation(&effects, FilmPart::Tails, nm, along * f)).x;
                assert!((weight - 1.0).abs() < 0.01, "f/{f_number} {nm}: {weight}");
                // Cells, the lattice of the samples, steps of 10 nm; light beyond the pattern's end (0.3 %).
                assert!(
                    (modulation - expected).abs() < 0.015,
                    "f/{f_number} {nm} nm {f} {along}: {modulation} for {expected}"
                );
            }
        }
    }
}

/// Coma sends light to one side. A film of finer pixels shows the side and the amount: on pixels as wide as the function it is wrong by 0.04.
#[test]
fn light_lands_on_the_side_where_a_finer_film_puts_it() {
    const TIMES: usize = 4;
    let coma = ZernikeTerm { zernike: Zernike::noll(8).expect("known"), field_mm: Vec::new(), rms_um: vec![0.08] };
    let psf = || aperture(2.8, vec![coma.clone()]);
    let effects = effects(psf(), Some(SpreadMethod::Samples)).expect("narrow");
    let spread = effects.sample_spread(&raster(), WavelengthRange::new(540.0, 560.0)).expect("samples");
    let [(_, actual)] = sampled_modulation(&spread, [550.0f32], DVec2::X * 0.125);
    let actual = product(actual, film_modulation(&effects, FilmPart::Tails, 550.0, DVec2::X * 0.125));
    let fine = EffectsParameters { psf: Some(psf()), margin: Some(0.0), ..Default::default() };
    let fine = (fine_raster(TIMES), Effects::new(fine, &fine_raster(TIMES)).expect("legal"));
    let expected = film_modulation_on(&fine.0, &fine.1, FilmPart::Whole, 550.0, DVec2::X * 0.125 / TIMES as f64);
    assert!(expected.y > 0.1, "coma is to one side: {expected}");
    // For the tails, 8 % of the light, the core's own displacement of 0.2 px is applied twice; the finer film is wrong by 0.005.
    assert!((actual - expected).length() < 0.015, "{actual} for {expected}");
}

#[test]
fn what_is_chosen_follows_the_width() {
    let by = |psf: PointSpread| effects(psf, None).expect("legal").spread_by().expect("there is one");
    let (narrow, width) = by(gaussian(0.4));
    assert!(narrow == SpreadMethod::Samples && (0.05..0.12).contains(&width.film_error), "{width:?}");
    let (diffraction, width) = by(aperture(8.0, Vec::new()));
    assert!(diffraction == SpreadMethod::Film && width.film_error < 0.065, "it would cost noise: {width:?}");
    let (wide, width) = by(gaussian(1.2));
    assert!(wide == SpreadMethod::Film && width.film_error < 0.01, "{width:?}");
    let message = effects(gaussian(3.0), Some(SpreadMethod::Samples)).expect_err("wide").to_string();
    assert!(message.contains("of the light falls close enough"), "{message}");
    let film = effects(gaussian(0.4), Some(SpreadMethod::Film)).expect("legal");
    assert!(film.sample_spread(&raster(), RANGE).is_none());
    assert_eq!((film.film_part(true), film.film_part(false)), (FilmPart::Whole, FilmPart::Whole));
    let samples = effects(gaussian(0.4), None).expect("legal");
    assert_eq!((samples.film_part(true), samples.film_part(false)), (FilmPart::Tails, FilmPart::Whole));
}
