//! Recovery of cameras from views of charts.

use super::cameras::{calibration, fisheye, perspective};
use super::paint::View;
use etendue_core::random::unit_f64;
use etendue_metrology::Estimate;
use etendue_metrology::calibrate::{
    CalibrateError, CalibrationOptions, Family, RadialTerms, Sighting, Sightings, calibrate,
};
use etendue_projection::model::{DoubleSphere, ExtendedUnified, FieldOfView, Ideal, Unified};
use etendue_projection::plane::DistortionTerms;
use etendue_projection::{Calibration, DistortionDirection, Model, RadialDistortion};
use etendue_stats::normal;
use glam::{DVec2, DVec3};

const BROWN: Family = Family::Perspective { radial: RadialTerms::Polynomial(2), tangential: true };
const SIZE: [usize; 2] = [640, 480];

/// Views of a 9 × 7 grid with steps of 30 mm, rotated about all axes.
fn views(camera: &Calibration, distance: f64) -> Vec<View> {
    let rotations =
        [[0.0, 0.0, 0.0], [0.5, 0.0, 0.1], [-0.5, 0.1, 0.0], [0.0, 0.5, 0.2], [0.1, -0.5, 1.6], [0.4, 0.4, 0.8]];
    let places = [[0.0, 0.0], [0.02, 0.0], [-0.02, 0.03], [0.05, -0.02], [0.0, 0.0], [-0.05, 0.01]];
    let view = |(turn, [x, y]): (&[f64; 3], &[f64; 2])| {
        View::new(camera, *turn, DVec2::new(0.12, 0.09), DVec3::new(*x, *y, distance))
    };
    rotations.iter().zip(&places).map(view).collect()
}

/// Observed positions of the points, with normal noise of a standard deviation.
fn observe(view: &View, sigma_px: f64, word: &mut u64) -> Sightings {
    let mut noise = || {
        *word = word.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        sigma_px * normal::quantile(unit_f64(*word ^ (*word >> 29)).clamp(1e-12, 1.0 - 1e-12))
    };
    let points = (0..63).filter_map(|i| {
        let chart = DVec2::new(f64::from(i % 9), f64::from(i / 9)) * 0.03;
        let noise = DVec2::new(noise(), noise());
        Some(Sighting { chart, at: view.image(chart)? + noise })
    });
    Sightings { points: points.collect(), disc_radius: None }
}

fn all(camera: &Calibration, distance: f64, sigma_px: f64, mut word: u64) -> Vec<Sightings> {
    views(camera, distance).iter().map(|v| observe(v, sigma_px, &mut word)).collect()
}

/// The largest difference in the image, px, of two cameras for the same directions.
fn largest_difference(a: &Calibration, b: &Calibration) -> f64 {
    let places = (0..=16).flat_map(|i| (0..=12).map(move |j| DVec2::new(40.0 * f64::from(i), 40.0 * f64::from(j))));
    let off = |at: DVec2| Some((b.project(a.unproject(at)?)? - at).length());
    places.filter_map(off).fold(0.0, f64::max)
}

#[test]
fn exact_points_give_every_model_back() {
    let terms = DistortionTerms { numerator: [-0.05, 0.01, 0.0, 0.0], ..DistortionTerms::default() };
    let radial = |sense| Model::Radial(RadialDistortion::new(sense, -0.1, 0.02, 1.0).expect("finite"));
    let cases = [
        (perspective(500.0, &[-0.2, 0.05, 0.001, -0.002], SIZE), BROWN, 0.5),
        (
            calibration(radial(DistortionDirection::IdealToObserved), 500.0, SIZE),
            Family::Polynomial(DistortionDirection::IdealToObserved),
            0.5,
        ),
        (
            calibration(radial(DistortionDirection::ObservedToIdeal), 500.0, SIZE),
            Family::Polynomial(DistortionDirection::ObservedToIdeal),
            0.5,
        ),
        (fisheye(250.0, SIZE), Family::KannalaBrandt(3), 0.15),
        (calibration(Model::FieldOfView(FieldOfView::new(0.9).expect("legal")), 300.0, SIZE), Family::FieldOfView, 0.2),
        (calibration(Model::Unified(Unified::new(0.9, terms).expect("legal")), 450.0, SIZE), Family::Unified, 0.15),
        (
            calibration(Model::ExtendedUnified(ExtendedUnified::new(0.6, 1.1).expect("legal")), 260.0, SIZE),
            Family::ExtendedUnified,
            0.15,
        ),
        (
            calibration(Model::DoubleSphere(DoubleSphere::new(-0.2, 0.55).expect("legal")), 260.0, SIZE),
            Family::DoubleSphere,
            0.15,
        ),
        (calibration(Model::Ideal(Ideal::Equisolid), 260.0, SIZE), Family::Ideal(Ideal::Equisolid), 0.15),
    ];
    for (camera, family, distance) in cases {
        let result = calibrate(&all(&camera, distance, 0.0, 1), SIZE, family, CalibrationOptions::default());
        let result = result.unwrap_or_else(|e| panic!("{family:?}: {e}"));
        assert!(result.rms_px() < 1e-5, "{family:?}: {}", result.rms_px());
        let off = largest_difference(&camera, &result.calibration);
        // For models with few parameters the whole image is accurate; for polynomials the region beyond the chart is less so.
        assert!(off < 1e-2, "{family:?}: {off}");
    }
}

#[test]
fn one_view_from_the_front_has_no_focal_length() {
    let camera = perspective(500.0, &[-0.2, 0.05, 0.0, 0.0], SIZE);
    let mut word = 3;
    let front = vec![observe(&views(&camera, 0.5)[0], 0.05, &mut word)];
    let result =
        calibrate(&front, SIZE, BROWN, CalibrationOptions { square_pixels: true, ..CalibrationOptions::default() });
    let Err(CalibrateError::Undetermined { names }) = result else { panic!("{result:?}") };
    assert!(names.contains(&"fx_px".to_owned()), "{names:?}");
    // With its distance stated, it has one, with the same uncertainty.
    let known = CalibrationOptions {
        square_pixels: true,
        principal_px: Some(DVec2::new(326.3, 235.3)),
        distance: Some(Estimate::new(0.5, 0.001)),
        ..CalibrationOptions::default()
    };
    let family = Family::Perspective { radial: RadialTerms::Polynomial(2), tangential: false };
    let calibrated = calibrate(&front, SIZE, family, known).expect("determined");
    let f = calibrated.estimate("fx_px").expect("fitted");
    // fx is 500, fy 501.5: between the two.
    assert!((f.value - 500.75).abs() < 1.0 && (0.9..3.0).contains(&f.standard_uncertainty), "{f:?}");
    let result = calibrate(&front[..0], SIZE, BROWN, CalibrationOptions::default());
    assert!(matches!(result, Err(CalibrateError::NoViews)), "{result:?}");
}

#[test]
fn a_stated_distance_counts_as_much_as_it_is_known() {
    let camera = perspective(500.0, &[-0.2, 0.05, 0.001, -0.002], SIZE);
    const DISTANCE: f64 = 0.5;
    // Tilted charts whose planes are all at the same distance.
    let level = |v: &View| {
        let far = v.rotation.z_axis.dot(v.translation);
        View { translation: v.translation + v.rotation.z_axis * (DISTANCE - far), ..v.clone() }
    };
    let mut word = 11;
    let sightings: Vec<Sightings> =
        views(&camera, DISTANCE).iter().map(level).map(|v| self::observe(&v, 0.05, &mut word)).collect();
    let calibrated = |views: &[Sightings], value: f64, u: f64| {
        let distance = Some(Estimate::new(value, u));
        let options = CalibrationOptions { distance, ..CalibrationOptions::default() };
        calibrate(views, SIZE, BROWN, options)
    };
    let focal = |value, u| calibrated(&sightings, value, u).expect("determined").estimate("fx_px").expect("fitted");
    let free = calibrate(&sightings, SIZE, BROWN, CalibrationOptions::default()).expect("determined");
    let free = free.estimate("fx_px").expect("fitted");
    // One standard uncertainty off, which is negligible compared with the information of the views.
    let vague = focal(0.52, 0.02);
    assert!((vague.value - free.value).abs() < 0.2 * free.standard_uncertainty, "{vague:?} {free:?}");
    // The views determine the distance to about 2·10⁻⁴; a more accurate stated distance dominates.
    let sharp = focal(DISTANCE, 1e-5);
    assert!(sharp.standard_uncertainty < 0.5 * free.standard_uncertainty, "{sharp:?} {free:?}");
    assert!((sharp.value - 500.0).abs() < 3.0 * sharp.standard_uncertainty, "{sharp:?}");
    // A wrong one is refused, exact or not.
    for u in [0.0, 0.005] {
        assert!(matches!(calibrated(&sightings, 0.55, u), Err(CalibrateError::Distance { .. })));
    }
    // If the views do not determine it, its uncertainty is that of the focal length.
    let front = CalibrationOptions {
        distance: Some(Estimate::new(DISTANCE, 0.005)),
        square_pixels: true,
        principal_px: Some(DVec2::new(camera.matrix().cx, camera.matrix().cy)),
        ..CalibrationOptions::default()
    };
    let alone = calibrate(
        &sightings[..1],
        SIZE,
        Family::Perspective { radial: RadialTerms::Polynomial(2), tangential: false },
        front,
    )
    .expect("determined")
    .estimate("fx_px")
    .expect("fitted");
    assert!((alone.standard_uncertainty / alone.value - 0.01).abs() < 2e-3, "{alone:?}");
}

#[test]
fn outliers_spoil_a_fit_unless_it_is_robust() {
    let camera = perspective(500.0, &[-0.2, 0.05, 0.0, 0.0], SIZE);
    let mut views = all(&camera, 0.5, 0.05, 5);
    views.iter_mut().for_each(|v| v.points[20].at += DVec2::new(8.0, -5.0));
    let off = |robust| {
        let options = CalibrationOptions { robust, ..CalibrationOptions::default() };
        let result = calibrate(&views, SIZE, BROWN, options).expect("settles");
        (result.estimate("fx_px").expect("fitted").value - 500.0).abs()
    };
    assert!(off(true) < 1.0 && off(true) < 0.3 * off(false), "{} {}", off(true), off(false));
}
