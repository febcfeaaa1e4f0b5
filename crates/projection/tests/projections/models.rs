//! Properties of every camera model: round trips over the whole image, the solid angle, folds.

use core::f64::consts::{PI, TAU};

use etendue_core::maths::f64::{sin_cos, tan};
use etendue_projection::model::{
    Division, DoubleSphere, ExtendedUnified, FTheta, FThetaSense, FieldOfView, Ideal, KannalaBrandt, Ocam, Panorama,
    Perspective, ThinPrismFisheye, Unified,
};
use etendue_projection::plane::{Affine, DistortionTerms};
use etendue_projection::{Calibration, CalibrationError, CameraMatrix, DistortionDirection, Model, RadialDistortion};
use glam::{DVec2, DVec3};

const SIZE: [usize; 2] = [1920, 1208];

fn camera(model: Model, focal_px: f64) -> Calibration {
    let matrix = CameraMatrix { fx: focal_px, fy: 1.01 * focal_px, skew: 0.7, cx: 966.3, cy: 598.2 };
    Calibration::new(model, matrix, SIZE).expect("legal")
}

fn perspective(coefficients: &[f64]) -> Model {
    Model::Perspective(Perspective::from_opencv(coefficients).expect("legal"))
}

fn fisheye(k: [f64; 4]) -> Model {
    Model::KannalaBrandt(KannalaBrandt::new(k).expect("legal"))
}

/// Realistic cameras, with the minimum fraction of the image that they fill.
fn cameras() -> Vec<(&'static str, Calibration, f64)> {
    let rational = [0.4, -0.25, 0.0009, 0.0002, 0.03, 0.72, -0.19, 0.01];
    let all = [-0.2, 0.05, 0.0011, -0.0008, 0.01, 0.02, -0.005, 0.001, 0.002, -0.001, 0.0015, 0.0004, 0.06, -0.11];
    vec![
        ("pinhole", camera(perspective(&[]), 1100.0), 1.0),
        ("radial and tangential", camera(perspective(&[-0.28, 0.07, 0.0011, -0.0008]), 1450.0), 1.0),
        ("rational", camera(perspective(&rational), 1500.0), 1.0),
        ("all fourteen", camera(perspective(&all), 1500.0), 1.0),
        ("equidistant to 360°", camera(fisheye([0.0; 4]), 400.0), 1.0),
        ("Kannala-Brandt", camera(fisheye([-0.012, 0.0042, -0.0031, 0.0006]), 700.0), 1.0),
        ("Kannala-Brandt beyond 180°", camera(fisheye([0.05, -0.02, 0.004, -0.0003]), 540.0), 1.0),
        ("radial, ideal to observed", camera(radial(DistortionDirection::IdealToObserved, -0.1), 1400.0), 1.0),
        ("radial, observed to ideal", camera(radial(DistortionDirection::ObservedToIdeal, 0.1), 1400.0), 1.0),
        ("division, barrel", camera(Model::Division(Division::new(-0.4).expect("legal")), 600.0), 1.0),
        ("division, cushion", camera(Model::Division(Division::new(0.1).expect("legal")), 900.0), 1.0),
        ("field of view", camera(Model::FieldOfView(FieldOfView::new(0.93).expect("legal")), 900.0), 1.0),
        ("thin-prism fisheye", camera(thin_prism(), 700.0), 1.0),
        ("unified", camera(unified(0.8), 900.0), 1.0),
        ("unified with xi above 1", camera(unified(1.6), 1700.0), 1.0),
        ("pinhole as unified", camera(unified(0.0), 1700.0), 1.0),
        ("extended unified", camera(extended(0.62, 1.1), 600.0), 1.0),
        ("extended unified, near the pinhole", camera(extended(0.2, 0.9), 900.0), 1.0),
        ("double sphere", camera(double(-0.18, 0.59), 600.0), 1.0),
        ("double sphere, low alpha", camera(double(0.2, 0.4), 600.0), 1.0),
    ]
    .into_iter()
    .chain(in_pixels())
    .chain(ideal())
    .collect()
}

fn radial(sense: DistortionDirection, k1: f64) -> Model {
    Model::Radial(RadialDistortion::new(sense, k1, 0.01, 1.0).expect("legal"))
}

fn unified(xi: f64) -> Model {
    let terms =
        DistortionTerms { numerator: [-0.1, 0.02, 0.0, 0.0], tangential: [0.0007, -0.0003], ..Default::default() };
    Model::Unified(Unified::new(xi, terms).expect("legal"))
}

fn extended(alpha: f64, beta: f64) -> Model {
    Model::ExtendedUnified(ExtendedUnified::new(alpha, beta).expect("legal"))
}

fn double(xi: f64, alpha: f64) -> Model {
    Model::DoubleSphere(DoubleSphere::new(xi, alpha).expect("legal"))
}

fn thin_prism() -> Model {
    let fisheye = KannalaBrandt::long([-0.012, 0.004, -0.002, 0.0006, -0.0002, 0.00002]).expect("legal");
    let prism = [0.0011, -0.0009, 0.0002, -0.0001];
    let terms = DistortionTerms { tangential: [0.0007, -0.0003], prism, ..Default::default() };
    Model::ThinPrismFisheye(ThinPrismFisheye::new(fisheye, terms).expect("legal"))
}

/// Models whose polynomials are in pixels.
fn in_pixels() -> Vec<(&'static str, Calibration, f64)> {
    let matrix = CameraMatrix { fx: 1.0, fy: 1.0, skew: 0.0, cx: 966.3, cy: 598.2 };
    let camera = |model| Calibration::new(model, matrix, SIZE).expect("legal");
    let affine = Affine { c: 1.0005, d: 0.0003, e: -0.0002 };
    let ocam = Ocam::new(vec![-620.0, 0.0, 5.2e-4, -1.1e-7, 1.9e-10], affine).expect("legal");
    let f_theta = |sense, c, maximum| Model::FTheta(FTheta::new(sense, c, maximum, affine).expect("legal"));
    let by_angle = f_theta(FThetaSense::AngleToRadius, vec![0.0, 700.0, 3.0, -21.0, 4.0], 2.0);
    let by_radius = f_theta(FThetaSense::RadiusToAngle, vec![0.0, 1.4e-3, -1e-8, 9e-11, 2e-14], 1.8);
    vec![
        ("OCam", camera(Model::Ocam(ocam)), 1.0),
        ("f-theta by angle", camera(by_angle), 1.0),
        ("f-theta by radius", camera(by_radius), 1.0),
    ]
}

fn ideal() -> Vec<(&'static str, Calibration, f64)> {
    let sphere = CameraMatrix { fx: 1920.0 / TAU, fy: 1208.0 / PI, skew: 0.0, cx: 960.0, cy: 604.0 };
    let panorama = Calibration::new(Model::Panorama(Panorama::Equirectangular), sphere, SIZE).expect("legal");
    vec![
        ("equidistant", camera(Model::Ideal(Ideal::Equidistant), 380.0), 1.0),
        ("equisolid", camera(Model::Ideal(Ideal::Equisolid), 600.0), 1.0),
        ("stereographic", camera(Model::Ideal(Ideal::Stereographic), 200.0), 1.0),
        // A circle of 600 px radius in the image.
        ("orthographic", camera(Model::Ideal(Ideal::Orthographic), 600.0), 0.4),
        ("rectilinear", camera(Model::Ideal(Ideal::Rectilinear), 600.0), 1.0),
        // All except points of the border that rounding puts outside.
        ("equirectangular", panorama, 0.95),
        ("cylindrical", camera(Model::Panorama(Panorama::Cylindrical), 310.0), 0.97),
    ]
}

/// Points of the whole image, its border included.
fn pixels() -> impl Iterator<Item = DVec2> {
    let [width, height] = SIZE.map(|n| n as f64);
    (0..=96)
        .flat_map(move |i| (0..=60).map(move |j| DVec2::new(f64::from(i) / 96.0 * width, f64::from(j) / 60.0 * height)))
}

#[test]
fn every_pixel_comes_back_and_so_does_every_direction() {
    for (name, camera, filled) in cameras() {
        let (mut count, mut all) = (0, 0);
        for pixel in pixels() {
            all += 1;
            let Some(direction) = camera.unproject(pixel) else { continue };
            count += 1;
            // Three roundings of unit vectors.
            assert!((direction.length() - 1.0).abs() < 1e-15, "{name}: {direction}");
            let back = camera.project(direction * 3.7).unwrap_or_else(|| panic!("{name}: {pixel} is not seen again"));
            assert!((back - pixel).length() < 1e-9, "{name}: {back} for {pixel}");
            let again = camera.unproject(back).unwrap_or_else(|| panic!("{name}: {back} sees nothing"));
            let error_px = (again - direction).length() / camera.solid_angle_per_area(pixel).expect("seen").sqrt();
            assert!(error_px < 1e-9, "{name}: {error_px} px at {pixel}");
        }
        assert!(f64::from(count) >= filled * f64::from(all), "{name}: {count} of {all}");
    }
}

#[test]
fn the_solid_angle_is_the_jacobian() {
    for (name, camera, filled) in cameras() {
        let mut compared = 0;
        for pixel in pixels().step_by(37) {
            // At the edge of an orthographic image the directions' derivatives are unbounded.
            let far =
                [DVec2::X, DVec2::Y, DVec2::NEG_X, DVec2::NEG_Y].map(|axis| camera.unproject(pixel + 100.0 * axis));
            if far.contains(&None) {
                continue;
            }
            let expected = area_of_directions(&camera, pixel).expect("seen");
            compared += 1;
            let actual = camera.solid_angle_per_area(pixel).expect("seen");
            // Sixth-order differences over 4 px of a function smooth over hundreds.
            assert!((actual / expected - 1.0).abs() < 1e-9, "{name}: {actual} for {expected} at {pixel}");
        }
        assert!(f64::from(compared) > 0.5 * filled * 160.0, "{name}: {compared} points");
    }
}

/// |∂d/∂u × ∂d/∂v| by sixth-order central differences.
fn area_of_directions(camera: &Calibration, pixel: DVec2) -> Option<f64> {
    let slope = |axis: DVec2| -> Option<DVec3> {
        [(1.0, 45.0), (2.0, -9.0), (3.0, 1.0)].iter().try_fold(DVec3::ZERO, |sum, (step, weight)| {
            let (ahead, behind) = (camera.unproject(pixel + axis * *step)?, camera.unproject(pixel - axis * *step)?);
            Some(sum + (ahead - behind) * (weight / 60.0))
        })
    };
    Some(slope(DVec2::X)?.cross(slope(DVec2::Y)?).length())
}

#[test]
fn a_fold_inside_the_image_is_refused_with_its_radius() {
    // r (1 − 0.3 r²) turns at r = 1/√0.9, where it is 2/3 of that.
    let fold = 2.0 / (3.0 * 0.9_f64.sqrt());
    let matrix = CameraMatrix { fx: 1000.0, fy: 1000.0, skew: 0.0, cx: 960.0, cy: 604.0 };
    let at = |focal: f64| {
        let matrix = CameraMatrix { fx: focal, fy: focal, ..matrix };
        Calibration::new(perspective(&[-0.3, 0.0, 0.0, 0.0]), matrix, SIZE).expect("legal")
    };
    let refused = at(1000.0).check().expect_err("folds");
    let CalibrationError::Fold { radius_px, angle_rad, needed_px } = refused else { panic!("{refused}") };
    assert!((radius_px - 1000.0 * fold).abs() < 1e-9 && radius_px < needed_px, "{refused}");
    assert!((tan(angle_rad) - 1.0 / 0.9_f64.sqrt()).abs() < 1e-12);
    assert!(refused.to_string().contains("702.728 px"), "{refused}");
    // The corner lies at 1134.3 px.
    assert!(at(1134.3 / fold).check().is_ok() && at(1134.2 / fold).check().is_err());
    // No direction beyond the fold's image.
    assert!(at(1000.0).unproject(DVec2::new(960.0 + 1000.0 * fold + 1e-6, 604.0)).is_none());
    assert!(at(1000.0).unproject(DVec2::new(960.0 + 1000.0 * fold - 1e-6, 604.0)).is_some());
    assert!(at(1000.0).project(DVec3::new(1.06, 0.0, 1.0)).is_none());
    assert!(at(1000.0).project(DVec3::new(1.05, 0.0, 1.0)).is_some());
}

#[test]
fn a_stated_greatest_angle_takes_the_fold_out_of_the_image() {
    let camera = camera(fisheye([-0.1, 0.0, 0.0, 0.0]), 400.0);
    // 1 − 0.3 θ² = 0.
    let fold = (1.0_f64 / 0.3).sqrt();
    let refused = camera.check().expect_err("folds");
    assert!(matches!(refused, CalibrationError::Fold { angle_rad, .. } if (angle_rad - fold).abs() < 1e-14));
    let limited = camera.clone().with_max_angle(1.6).expect("legal");
    assert!(limited.check().is_ok());
    let (sin, cos) = sin_cos(1.61);
    let beyond = DVec3::new(0.0, sin, cos);
    let pixel = camera.project(beyond).expect("before the fold");
    assert!(limited.project(beyond).is_none() && limited.unproject(pixel).is_none());
    assert!(limited.solid_angle_per_area(pixel).is_none() && camera.solid_angle_per_area(pixel).is_some());
    assert!(camera.with_max_angle(4.0).is_err());
}

#[test]
fn polynomials_in_pixels_fold_where_they_turn_back() {
    let matrix = CameraMatrix { fx: 1.0, fy: 1.0, skew: 0.0, cx: 960.0, cy: 604.0 };
    let camera = |model| Calibration::new(model, matrix, SIZE).expect("legal");
    let fold = |camera: &Calibration| match camera.check() {
        Err(CalibrationError::Fold { radius_px, angle_rad, .. }) => [radius_px, angle_rad],
        other => panic!("{other:?}"),
    };
    // f = −500 − ρ²/1000: tan θ = ρ/(500 + ρ²/1000) is largest at ρ² = 500 000.
    let ocam = camera(Model::Ocam(Ocam::new(vec![-500.0, 0.0, -1e-3], Affine::default()).expect("legal")));
    let [radius_px, angle_rad] = fold(&ocam);
    // The angle is stationary at the fold: the radius is accurate to the root of the angle's 1e-14.
    assert!((radius_px / 500_000.0_f64.sqrt() - 1.0).abs() < 1e-6, "{radius_px}");
    assert!((tan(angle_rad) - 500_000.0_f64.sqrt() / 1000.0).abs() < 1e-12);
    let f_theta =
        |sense, c, maximum| camera(Model::FTheta(FTheta::new(sense, c, maximum, Affine::default()).expect("legal")));
    // r = 600 (θ − θ³/10) turns at θ² = 10/3; a maximum angle before it is the end.
    let by_angle = |maximum| f_theta(FThetaSense::AngleToRadius, vec![0.0, 600.0, 0.0, -60.0], maximum);
    let turn = (10.0_f64 / 3.0).sqrt();
    let [radius_px, angle_rad] = fold(&by_angle(2.5));
    assert!((angle_rad - turn).abs() < 1e-14 && (radius_px - 600.0 * turn * 2.0 / 3.0).abs() < 1e-9);
    assert!(by_angle(1.8).check().is_ok());
    // θ = ρ/400 − ρ³/1e9 turns at ρ² = 1e9/1200 with 1.52 rad.
    let by_radius = |maximum| f_theta(FThetaSense::RadiusToAngle, vec![0.0, 0.0025, 0.0, -1e-9], maximum);
    let turn_px = (1e9_f64 / 1200.0).sqrt();
    assert!((fold(&by_radius(2.5))[0] / turn_px - 1.0).abs() < 1e-6);
    assert!(by_radius(2.5).unproject(DVec2::new(960.0 + turn_px + 1e-6, 604.0)).is_none());
    assert!(by_radius(2.5).unproject(DVec2::new(960.0 + turn_px - 1e-3, 604.0)).is_some());
    assert!(by_radius(1.5).check().is_ok());
}

#[test]
fn a_circle_in_a_larger_image_is_no_fold() {
    let camera = camera(fisheye([0.0; 4]), 150.0);
    assert!(camera.check().is_ok());
    assert!(camera.unproject(DVec2::new(1.0, 1.0)).is_none());
    assert!(camera.unproject(DVec2::new(966.3 + 150.0 * (PI - 0.01), 598.2)).is_some());
    assert!(camera.project(DVec3::NEG_Z).is_none() && camera.project(DVec3::ZERO).is_none());
    assert!(camera.project(DVec3::NAN).is_none() && camera.unproject(DVec2::NAN).is_none());
}

#[test]
fn what_is_no_camera_is_refused() {
    assert!(Perspective::from_opencv(&[0.1; 6]).is_err());
    let refused = Perspective::from_opencv(&[0.1, f64::NAN, 0.0, 0.0]).expect_err("not finite");
    assert!(refused.to_string().contains("finite"), "{refused}");
    let matrix = CameraMatrix { fx: 0.0, fy: 1.0, skew: 0.0, cx: 0.0, cy: 0.0 };
    assert!(matches!(Calibration::new(perspective(&[]), matrix, SIZE), Err(CalibrationError::Matrix { .. })));
    let matrix = CameraMatrix { fx: 1.0, ..matrix };
    assert!(matches!(Calibration::new(perspective(&[]), matrix, [0, 2]), Err(CalibrationError::Empty { .. })));
}
