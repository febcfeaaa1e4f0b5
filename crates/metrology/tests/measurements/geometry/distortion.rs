//! Distortion and lateral colour of images in closed form.

use super::cameras::perspective;
use super::paint::{View, checkerboard, dots, noisy};
use etendue_metrology::chromatic::{displacements, rings};
use etendue_metrology::distortion::{Distortion, DistortionError, distortion};
use etendue_metrology::target::{Grid, Node, Target, TargetQuery, find};
use etendue_projection::{Calibration, CameraMatrix, DistortionDirection, Model, RadialDistortion};
use glam::{DVec2, DVec3};

const SIZE: [usize; 2] = [800, 600];
const HALF_DIAGONAL_PX: f64 = 500.0;

/// A camera with r′ = r (1 + k₁ r² + k₂ r⁴), r in half diagonals, about the image centre.
fn camera(sense: DistortionDirection, k1: f64, k2: f64, f: f64) -> Calibration {
    let unit = HALF_DIAGONAL_PX / f;
    let model = Model::Radial(RadialDistortion::new(sense, k1, k2, unit).expect("finite"));
    let matrix = CameraMatrix { fx: f, fy: f, skew: 0.0, cx: 400.0, cy: 300.0 };
    Calibration::new(model, matrix, SIZE).expect("a camera")
}

/// Observed over ideal radius at an observed one, both in half diagonals.
fn ratio(camera: &Calibration, field: f64) -> f64 {
    let Model::Radial(radial) = camera.model() else { panic!("radial") };
    let observed = field * radial.unit_mm();
    observed / radial.ideal_radius_mm(observed).expect("no fold")
}

fn check(camera: &Calibration, measured: &Distortion, tolerance: f64) {
    let last = measured.curve.last().expect("a curve");
    assert!(last.field >= 0.9, "{last:?}");
    for point in &measured.curve {
        let off = point.ratio.value - ratio(camera, point.field);
        // Near the centre a fraction of a pixel is a large part of the distance.
        let limit = tolerance.max(4.0 * point.ratio.standard_uncertainty);
        assert!(off.abs() < limit && point.ratio.standard_uncertainty < 5.0 * tolerance, "{point:?} {off}");
    }
}

#[test]
fn the_curve_is_the_camera_s() {
    for (sense, k1, k2) in
        [(DistortionDirection::ObservedToIdeal, 0.15, 0.03), (DistortionDirection::IdealToObserved, 0.06, -0.01)]
    {
        let camera = camera(sense, k1, k2, 700.0);
        let view = View::new(&camera, [0.02, -0.03, 0.01], DVec2::new(20.0, 15.0), DVec3::new(0.1, -0.2, 22.0));
        let image = view.render(6, &dots(41, 31, 0.25));
        let grid = find(&image, TargetQuery { target: Some(Target::Dots), size: None }).expect("dots");
        let measured = distortion(&grid, SIZE, None).expect("enough points");
        // The requirement is 0.1 % of the field; dots to 0.01 px and a polynomial of degree 9 are ten times better.
        check(&camera, &measured, 1e-4);
        let fit = if sense == DistortionDirection::IdealToObserved { measured.forward } else { measured.backward };
        assert!(fit.rms_px < 0.02, "{fit:?}");
        assert!((fit.k1.value - k1).abs() < 1e-3 && (fit.k2.value - k2).abs() < 1e-3, "{fit:?}");
        let off =
            fit.centre_px.iter().zip([400.0, 300.0]).map(|(c, expected)| (c.value - expected, c.standard_uncertainty));
        // A thirtieth of 0.01 px of noise remains, over a distortion of a tenth; at most a few standard uncertainties.
        assert!(off.into_iter().all(|(off, u)| off.abs() < 0.3 && u < 0.3), "{fit:?}");
        let worst = measured.local.iter().filter(|l| l.field > 0.2);
        let off = worst.map(|l| (l.distortion.value + 1.0 - ratio(&camera, l.field)).abs()).fold(0.0, f64::max);
        assert!(off < 5e-4, "{off}");
        let bow = measured.lines.iter().find(|l| l.is_row).expect("rows").bow;
        assert!(if sense == DistortionDirection::ObservedToIdeal { bow < -0.005 } else { bow > 0.002 }, "{bow}");
    }
}

/// A list of exact points without distortion leaves residuals of rounding or none.
#[test]
fn exact_points_without_distortion_have_none() {
    let node = |i: usize| {
        let index = [i % 9, i / 9];
        let at = DVec2::new(80.0 + 80.0 * index[0] as f64, 60.0 + 80.0 * index[1] as f64);
        Node { index, at, uncertainty_px: 0.0 }
    };
    let grid = Grid { nodes: (0..63).map(node).collect(), size: [9, 7], disc_radius_steps: None };
    let measured = distortion(&grid, SIZE, None).expect("enough points");
    for point in &measured.curve {
        let u = point.ratio.standard_uncertainty;
        assert!((point.ratio.value - 1.0).abs() < 1e-9 && u.is_finite() && u < 1e-9, "{point:?}");
    }
}

#[test]
fn noise_is_covered_by_the_uncertainty() {
    let camera = camera(DistortionDirection::ObservedToIdeal, 0.1, 0.02, 700.0);
    let view = View::new(&camera, [0.03, 0.01, 0.0], DVec2::new(16.0, 12.0), DVec3::new(0.0, 0.0, 25.0));
    let image = view.render(6, &checkerboard(33, 25));
    let (mut inside, mut all) = (0, 0);
    for seed in 0..3 {
        let board = TargetQuery { target: Some(Target::Checkerboard), size: Some([33, 25]) };
        let n = noisy(&image, 0.03, seed);
        let grid = find(&n, board).expect("a board");
        let measured = distortion(&grid, SIZE, None).expect("enough points");
        for point in &measured.curve {
            let off = point.ratio.value - ratio(&camera, point.field);
            inside += usize::from(off.abs() < 2.0 * point.ratio.standard_uncertainty);
            all += 1;
        }
    }
    // 95.4 %, over three independent curves whose points are correlated.
    assert!(inside as f64 > 0.8 * f64::from(all), "{inside} of {all}");
}

#[test]
fn what_shows_no_distortion_is_refused() {
    let camera = camera(DistortionDirection::ObservedToIdeal, 0.1, 0.02, 700.0);
    let view = View::new(&camera, [0.0; 3], DVec2::new(2.0, 2.0), DVec3::new(-4.0, -2.5, 12.0));
    let image = view.render(4, &dots(5, 5, 0.25));
    let grid = find(&image, TargetQuery::default()).expect("dots");
    assert!(matches!(distortion(&grid, SIZE, None), Err(DistortionError::Centre { .. })));
    let mut few = grid.clone();
    few.nodes.truncate(12);
    assert_eq!(distortion(&few, SIZE, None).map(|_| ()), Err(DistortionError::Few { points: 12, least: 16 }));
}

#[test]
fn a_channel_of_another_scale_is_displaced_in_proportion_to_the_field() {
    let grid = |scale: f64, shift: f64| {
        let camera = perspective(700.0 * scale, &[], SIZE);
        let view = View::new(&camera, [0.0; 3], DVec2::new(10.0, 7.5), DVec3::new(shift, 0.0, 20.0));
        let image = view.render(8, &dots(21, 16, 0.25));
        find(&image, TargetQuery { target: Some(Target::Dots), size: None }).expect("dots")
    };
    let (green, red) = (grid(1.0, 0.0), grid(1.002, 0.0));
    let list = displacements(&green, &red, SIZE);
    assert_eq!(list.len(), 336);
    // About the principal point, (406.3, 295.3), not the centre; the remainder is the centroids' 0.01 px.
    for d in &list {
        let expected = 0.002 * (d.at - DVec2::new(406.3, 295.3));
        assert!((d.by - expected).length() < 0.02, "{d:?} {expected}");
    }
    let outer = *rings(&list).last().expect("rings");
    let expected = 0.002 * outer.field * HALF_DIAGONAL_PX;
    assert!(
        (outer.radial.value - expected).abs() < 3.0 * outer.radial.standard_uncertainty + 0.01,
        "{outer:?} {expected}"
    );
    // Shifted by half a pixel: constant over the image.
    let shifted = displacements(&green, &grid(1.0, 0.5 / 700.0 * 20.0), SIZE);
    let mean = shifted.iter().map(|d| d.by).sum::<DVec2>() / shifted.len() as f64;
    assert!((mean - DVec2::new(0.5, 0.0)).length() < 0.01, "{mean}");
}
