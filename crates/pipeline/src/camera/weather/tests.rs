//! Weather over images of few pixels, compared with closed forms.

use super::*;
use etendue_core::{Bands, Motion};
use etendue_optics::PupilProjection;
use etendue_spectra::Spectrum;
use etendue_tracer::media::{DensityVariation, Medium, MediumRegion, Noise, Phase};
use glam::{DAffine3, DMat3};
use glam::{DVec2, DVec3};

/// Four pixels with a field of 45° in all, the axis along +x of the world: one of the upper row sees the sky.
fn through_fog(fog: Medium, airlight: Airlight) -> Result<WeatheredImage, WeatherError> {
    let bands = Bands::new(400.0, 100.0, 2).expect("bands");
    let projection = PupilProjection::rectilinear(2, 2, 0.4, DVec2::ONE).expect("a view");
    let mut radiance = SpectralCube::new(2, 2, bands);
    for (i, plane) in radiance.planes_mut().iter_mut().enumerate() {
        plane.samples_mut().copy_from_slice(&[5.0 + i as f32, 2.0, 3.0, 0.0]);
    }
    let distance = Plane::from_samples(2, 2, vec![f32::INFINITY, 20.0, 50.0, f32::NAN]).expect("filled");
    let stored = StoredRadianceImage { projection: &projection, radiance: &radiance, distance: Some(&distance) };
    let rotation = DMat3::from_cols(DVec3::NEG_Y, DVec3::NEG_Z, DVec3::X);
    let pose = CameraPose { position_m: DVec3::new(3.0, 0.0, 1.0), rotation };
    Weather { airlight, media: vec![fog], falling: None }.apply(&stored, &pose, TimeInterval::default())
}

fn fog(extinction_per_m: f64, shape: MediumRegion) -> Medium {
    let (extinction, albedo) = (Spectrum::constant(extinction_per_m), Spectrum::constant(1.0));
    Medium::new(extinction, albedo, Phase::Isotropic, shape, Motion::constant(DAffine3::IDENTITY)).expect("legal")
}

fn pixel_values(weathered: &WeatheredImage, i: usize) -> [f32; 3] {
    let band = 1;
    let at = |planes: &[f32]| planes[i];
    [
        at(weathered.radiance.planes()[band].samples()),
        at(weathered.transmittance.planes()[band].samples()),
        at(weathered.airlight.planes()[band].samples()),
    ]
}

fn agrees(actual: [f32; 3], expected: [f64; 3]) {
    actual.iter().zip(expected).for_each(|(actual, expected)| {
        // f32, and the distance within it.
        assert!((f64::from(*actual) - expected).abs() < 1e-5 * expected.abs().max(1.0), "{actual} {expected}");
    });
}

#[test]
fn the_law_of_koschmieder() {
    let uniform = Airlight::Uniform(Spectrum::constant(4.0));
    let everywhere = through_fog(fog(0.02, MediumRegion::Everywhere), uniform.clone()).expect("fog");
    let transmittance = exp(-0.02 * 20.0);
    agrees(
        pixel_values(&everywhere, 1),
        [2.0 * transmittance + 4.0 * (1.0 - transmittance), transmittance, 4.0 * (1.0 - transmittance)],
    );
    agrees(pixel_values(&everywhere, 0), [4.0, 0.0, 4.0]);
    agrees(pixel_values(&everywhere, 3), [0.0, 1.0, 0.0]);
    // Half inside a box: 7 m of it before the camera, along x; a pixel's ray is inclined by tan 0.2 twice.
    let within = through_fog(fog(0.1, MediumRegion::Box { half_m: DVec3::splat(10.0) }), uniform).expect("fog");
    let transmittance = exp(-0.1 * 7.0 * 1.08_f64.sqrt());
    agrees(
        pixel_values(&within, 1),
        [2.0 * transmittance + 4.0 * (1.0 - transmittance), transmittance, 4.0 * (1.0 - transmittance)],
    );
    assert!((within.depth.samples()[1] - 20.0 / 1.08_f32.sqrt()).abs() < 1e-4);
}

#[test]
fn the_sky_gives_the_airlight() {
    let sky = |elevation_deg: f64| Airlight::Sky { elevation_rad: elevation_deg.to_radians() };
    let layer = || fog(0.02, MediumRegion::Below { top_m: 500.0 });
    // The sky's pixel looks up by atan(0.2/√1.04) = 11.1°.
    assert_eq!(through_fog(layer(), sky(10.0)).expect_err("no sky"), WeatherError::Sky { elevation_deg: 10 });
    let transmittance = exp(-0.02 * 20.0);
    agrees(
        pixel_values(&through_fog(layer(), sky(20.0)).expect("fog"), 1),
        [2.0 * transmittance + 6.0 * (1.0 - transmittance), transmittance, 6.0 * (1.0 - transmittance)],
    );
}

/// Over 50 m of 3 m eddies the mean density is near 1; the sum along the ray agrees with one in finer steps.
#[test]
fn noise_is_summed_along_the_ray() {
    let noise = Noise { scale_m: 3.0, octaves: 3, gain: 0.5, seed: 5 };
    let uneven = DensityVariation { noise, amplitude: 0.9, wind_mps: DVec3::ZERO };
    let medium = fog(0.02, MediumRegion::Everywhere).with_unevenness(uneven);
    let transmittance =
        pixel_values(&through_fog(medium, Airlight::Uniform(Spectrum::constant(4.0))).expect("fog"), 2)[1];
    let direction = DVec3::new(1.0, 0.2, -0.2).normalize();
    let n = 200_000;
    let step_m = 50.0 / f64::from(n);
    let at = |i: i32| DVec3::new(3.0, 0.0, 1.0) + direction * (f64::from(i) + 0.5) * step_m;
    let column_m: f64 = (0..n).map(|i| (1.0 + 0.9 * noise.at(at(i))) * step_m).sum();
    // The midpoint rule's error at 100 steps of a smallest eddy's sixth.
    assert!(
        (f64::from(transmittance) - exp(-0.02 * column_m)).abs() < 1e-3,
        "{transmittance} {}",
        exp(-0.02 * column_m)
    );
    assert!((column_m / 50.0 - 1.0).abs() > 1e-4, "uneven");
}
