//! The invariants of the at-the-pupil route.

use etendue_core::WavelengthRange;
use etendue_core::plane::{Plane, SpectralCube};
use etendue_core::quantity::Radiance;
use etendue_core::wavelength::Bands;
use etendue_optics::{Lens, OpticsError, PupilProjection, Resampling, ThinParameters, irradiance};
use etendue_projection::{DistortionDirection, RadialDistortion, Raster};
use glam::DVec2;

fn lens() -> Lens {
    Lens::thin(ThinParameters {
        focal_length_mm: 4.0,
        f_number: 2.0,
        focus_distance_m: f64::INFINITY,
        transmittance: 0.9,
    })
    .expect("legal")
}

fn distorted(sense: DistortionDirection, k1: f64) -> Lens {
    lens().with_distortion(RadialDistortion::new(sense, k1, 0.01, 4.0).expect("legal")).expect("a paraxial lens")
}

const RANGE: WavelengthRange = WavelengthRange::new(400.0, 700.0);

fn raster() -> Raster {
    Raster::new(64, 48, DVec2::splat(0.05), DVec2::new(30.25, 25.5)).expect("legal")
}

fn bands() -> Bands {
    Bands::new(500.0, 10.0, 2).expect("legal")
}

fn cube(geometry: &PupilProjection, value: impl Fn(DVec2) -> f64) -> SpectralCube<Radiance> {
    let mut plane = Plane::<Radiance>::new(geometry.width(), geometry.height());
    for y in 0..geometry.height() {
        for x in 0..geometry.width() {
            let d = geometry.direction(DVec2::new(x as f64 + 0.5, y as f64 + 0.5)).expect("one view");
            plane.set(x, y, value(d.truncate() / d.z) as f32);
        }
    }
    let double = plane.map(|v| 2.0 * v);
    SpectralCube::from_planes(bands(), vec![plane, double]).expect("two planes")
}

#[test]
fn without_distortion_the_stored_pixels_are_the_image_s() {
    let (lens, raster) = (lens(), raster());
    let geometry = PupilProjection::covering(&lens, &raster, [0, 0], RANGE).expect("legal");
    assert_eq!((geometry.width(), geometry.height()), (64, 48));
    let stored = cube(&geometry, |t| if (t.x * 80.0).floor() % 2.0 == 0.0 { 1.0 } else { 3.0 });
    let image =
        Resampling::new(geometry, &lens, &raster, [0, 0], bands()).expect("covered").apply(&stored).expect("size");
    for (a, b) in image.planes().iter().zip(stored.planes()) {
        for (a, b) in a.samples().iter().zip(b.samples()) {
            // Cell edges are found to about 1e-13 px.
            assert!((a - b).abs() <= 1e-6 * b.abs());
        }
    }
}

#[test]
fn uniform_radiance_stays_uniform_and_becomes_the_etendue() {
    for lens in
        [distorted(DistortionDirection::IdealToObserved, -0.15), distorted(DistortionDirection::ObservedToIdeal, -0.08)]
    {
        let raster = raster();
        let geometry = PupilProjection::covering(&lens, &raster, [0, 0], RANGE).expect("legal");
        let image = Resampling::new(geometry, &lens, &raster, [0, 0], bands())
            .expect("covered")
            .apply(&cube(&geometry, |_| 7.0))
            .expect("size");
        // Weights of f64 sum to one; the result is rounded to f32 once.
        assert!(image.planes()[0].samples().iter().all(|v| (v - 7.0).abs() < 1e-6));
        let light = irradiance(&image, &lens, &raster).expect("size");
        for (x, y) in [(0, 0), (31, 25), (63, 47)] {
            let at = raster.sensor_mm(DVec2::new(x as f64 + 0.5, y as f64 + 0.5));
            let expected = 14.0 * lens.projected_solid_angle_sr(at);
            assert!((f64::from(light.planes()[1].at(x, y)) / expected - 1.0).abs() < 1e-6);
        }
    }
}

#[test]
fn a_gradient_lands_where_the_lens_looks() {
    for lens in
        [distorted(DistortionDirection::IdealToObserved, -0.15), distorted(DistortionDirection::ObservedToIdeal, -0.08)]
    {
        let raster = raster();
        let geometry = PupilProjection::covering(&lens, &raster, [0, 0], RANGE).expect("legal");
        let stored = cube(&geometry, |t| 5.0 + 2.0 * t.x - 3.0 * t.y);
        let image =
            Resampling::new(geometry, &lens, &raster, [0, 0], bands()).expect("covered").apply(&stored).expect("size");
        for (x, y) in [(0, 0), (12, 40), (31, 25), (63, 47)] {
            let ray = lens.principal_ray(raster.sensor_mm(DVec2::new(x as f64 + 0.5, y as f64 + 0.5))).expect("open");
            let t = ray.direction.truncate() / ray.direction.z;
            let expected = 5.0 + 2.0 * t.x - 3.0 * t.y;
            // Stored pixels count as uniform: a footprint of the width of a pixel samples a linear ramp to within an
            // eighth of a pixel's step (times two axes), and the footprint's own curvature adds less.
            let step = 5.0 * geometry.pitch_tan();
            assert!((f64::from(image.planes()[0].at(x, y)) - expected).abs() < 0.25 * step);
        }
    }
}

#[test]
fn overscan_grows_with_barrel_and_the_pixels_are_fine_enough() {
    let raster = raster();
    let barrel =
        PupilProjection::covering(&distorted(DistortionDirection::IdealToObserved, -0.15), &raster, [0, 0], RANGE)
            .expect("legal");
    assert!(barrel.width() > 66 && barrel.height() > 50, "{barrel:?}");
    assert!(barrel.pitch_tan() <= 0.05 / 4.0);
    let pincushion =
        PupilProjection::covering(&distorted(DistortionDirection::ObservedToIdeal, -0.08), &raster, [0, 0], RANGE)
            .expect("legal");
    assert!(pincushion.pitch_tan() < 0.05 / 4.0, "pincushion magnifies the corners");
}

#[test]
fn an_image_that_looks_beyond_the_stored_image_is_refused_with_the_angle() {
    let raster = raster();
    let geometry = PupilProjection::covering(&lens(), &raster, [0, 0], RANGE).expect("legal");
    assert!(Resampling::new(geometry, &lens(), &raster, [0, 0], bands()).is_ok());
    let wider = Raster::new(68, 48, DVec2::splat(0.05), DVec2::new(34.25, 25.5)).expect("legal");
    let refused =
        Resampling::new(geometry, &lens(), &wider, [0, 0], bands()).expect_err("four columns more on the left");
    let OpticsError::MissingDirections { edge, missing_rad } = refused else { panic!("{refused}") };
    assert_eq!(edge, "left");
    assert!(
        Resampling::new(geometry.widened(4, 0), &lens(), &wider, [0, 0], bands()).is_ok()
            && Resampling::new(geometry.widened(3, 9), &lens(), &wider, [0, 0], bands()).is_err()
    );
    let across = |px: f64| etendue_core::maths::f64::atan(px * 0.05 / 4.0);
    // In the row of the axis the four columns span the largest angle.
    assert!((missing_rad - (across(34.25) - across(30.25))).abs() < 1e-3, "{missing_rad}");
}

#[test]
fn an_image_of_another_size_is_refused() {
    let (lens, raster) = (lens(), raster());
    let geometry = PupilProjection::covering(&lens, &raster, [0, 0], RANGE).expect("legal");
    let other = SpectralCube::<Radiance>::new(10, 10, bands());
    let resampling = Resampling::new(geometry, &lens, &raster, [0, 0], bands()).expect("covered");
    assert!(matches!(resampling.apply(&other), Err(OpticsError::Size { got_width: 10, .. })));
    assert!(matches!(irradiance(&other, &lens, &raster), Err(OpticsError::Size { .. })));
}
