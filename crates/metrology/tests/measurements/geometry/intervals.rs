//! Stated intervals cover the true value: distortion, focal length, calibration, lateral colour, with 200 seeds.

use super::cameras::perspective;
use super::paint::View;
use crate::coverage::{CoverageRun, assert_coverage};
use crate::draws::normals;
use etendue_metrology::Estimate;
use etendue_metrology::calibrate::{
    CalibrationOptions, CalibrationResult, Family, RadialTerms, Sighting, Sightings, calibrate,
};
use etendue_metrology::chromatic::{displacements, rings, shift};
use etendue_metrology::distortion::distortion;
use etendue_metrology::target::{Grid, Node};
use etendue_projection::{Calibration, CameraMatrix, DistortionDirection, Model, RadialDistortion};
use glam::{DVec2, DVec3};

/// Noise of a point, px.
const SIGMA_PX: f64 = 0.03;
const SIZE: [usize; 2] = [800, 600];
const HALF_DIAGONAL_PX: f64 = 500.0;

/// r′ = r (1 + k₁ r² + k₂ r⁴), r in half diagonals, about the image centre.
fn barrel(k1: f64, k2: f64) -> Calibration {
    let f = 700.0;
    let radial =
        RadialDistortion::new(DistortionDirection::IdealToObserved, k1, k2, HALF_DIAGONAL_PX / f).expect("finite");
    let matrix = CameraMatrix { fx: f, fy: f, skew: 0.0, cx: 400.0, cy: 300.0 };
    Calibration::new(Model::Radial(radial), matrix, SIZE).expect("a camera")
}

/// Observed points of a chart with steps of 1, with noise.
fn observe(view: &View, [columns, rows]: [usize; 2], mut normal: impl FnMut() -> f64) -> Grid {
    let node = |i: usize| {
        let index = [i % columns, i / columns];
        let noise = SIGMA_PX * DVec2::new(normal(), normal());
        let at = view.image(DVec2::new(index[0] as f64, index[1] as f64))? + noise;
        Some(Node { index, at, uncertainty_px: SIGMA_PX })
    };
    let nodes = (0..columns * rows).filter_map(node).collect();
    Grid { nodes, size: [columns, rows], disc_radius_steps: None }
}

fn distorted(seed: u64) -> CoverageRun {
    let (k1, k2) = (-0.06, 0.01);
    let camera = barrel(k1, k2);
    let view = View::new(&camera, [0.02, -0.03, 0.01], DVec2::new(8.0, 6.0), DVec3::new(0.05, -0.1, 13.5));
    let measured = distortion(&observe(&view, [17, 13], normals(seed, 0)), SIZE, None).expect("enough points");
    let Model::Radial(radial) = camera.model() else { panic!("radial") };
    let ratio = |field: f64| {
        let observed = field * radial.unit_mm();
        observed / radial.ideal_radius_mm(observed).expect("no fold")
    };
    let fit = measured.forward;
    let point = |k: usize| (measured.curve[k].ratio, ratio(measured.curve[k].field));
    let [a, b, c] = [7, 19, 31].map(point);
    vec![
        ("k1", fit.k1, k1),
        ("k2", fit.k2, k2),
        ("centre, column", fit.centre_px[0], 400.0),
        ("centre, row", fit.centre_px[1], 300.0),
        ("curve at 20 % of the field", a.0, a.1),
        ("curve at 50 %", b.0, b.1),
        ("curve at 80 %", c.0, c.1),
    ]
}

#[test]
fn distortion_of_a_chart() {
    assert_coverage("distortion", distorted);
}

/// A chart over one side of the image: the tilt at its edge does not average over directions.
fn to_one_side(seed: u64) -> CoverageRun {
    let camera = perspective(700.0, &[], SIZE);
    let view = View::new(&camera, [0.02, -0.03, 0.01], DVec2::new(4.0, 6.0), DVec3::new(0.0, 0.0, 18.0));
    let measured = distortion(&observe(&view, [15, 13], normals(seed, 0)), SIZE, None).expect("enough points");
    let at = |field: f64| {
        let point = measured.curve.iter().find(|p| (p.field - field).abs() < 1e-9).expect("the chart reaches there");
        assert!(point.covered < 0.8, "{point:?}");
        (point.ratio, 1.0)
    };
    let (a, b) = (at(0.5), at(0.65));
    vec![("curve of one side at 50 % of the field", a.0, a.1), ("curve of one side at 65 %", b.0, b.1)]
}

#[test]
fn distortion_of_a_chart_to_one_side() {
    assert_coverage("distortion to one side", to_one_side);
}

/// A chart with this many points that fills the image, except its borders, through a camera, slightly tilted.
fn filling(camera: &Calibration, [columns, rows]: [usize; 2], tilt: f64) -> View {
    let [x, y] = [columns as f64 - 1.0, rows as f64 - 1.0];
    let distance = 700.0 / f64::min(720.0 / x, 540.0 / y);
    View::new(camera, [tilt, -tilt, 0.01], DVec2::new(0.5 * x, 0.5 * y), DVec3::new(0.0, 0.0, distance))
}

/// The largest local distortion, that of a corner of the chart, and the curve's last point, of a chart with this many points.
fn grid_run(camera: &Calibration, size: [usize; 2], tilt: f64, truth: impl Fn(f64) -> f64, seed: u64) -> CoverageRun {
    let view = filling(camera, size, tilt);
    let grid = observe(&view, size, normals(seed, 0));
    let measured = distortion(&grid, SIZE, None).expect("enough points");
    let all = (0..size[0] * size[1]).filter_map(|i| {
        let at = view.image(DVec2::new((i % size[0]) as f64, (i / size[0]) as f64))? - DVec2::new(400.0, 300.0);
        Some(truth(at.length() / HALF_DIAGONAL_PX) - 1.0)
    });
    let largest = all.fold(0.0, |a: f64, b| if b.abs() > a.abs() { b } else { a });
    let corner = measured.local.iter().find(|l| l.index == [0, 0]).expect("seen");
    let last = measured.curve.last().expect("a curve");
    vec![
        ("largest local distortion", measured.largest.expect("points").distortion, largest),
        ("of a corner", corner.distortion, truth(corner.field) - 1.0),
        ("curve's last point", last.ratio, truth(last.field)),
    ]
}

/// Charts of few and of many points, of few rows, through lenses without distortion and with it.
#[test]
fn distortion_of_charts_of_few_points_and_many() {
    let none = ("none", [0.0, 0.0]);
    let barrel_of = ("barrel", [-0.1, 0.02]);
    let cases = [
        ("5 × 4", [5, 4], none),
        ("5 × 4", [5, 4], barrel_of),
        ("10 × 7", [10, 7], ("pincushion", [0.08, -0.01])),
        ("11 × 8", [11, 8], none),
        ("20 × 9", [20, 9], barrel_of),
        ("40 × 30", [40, 30], barrel_of),
    ];
    for (chart, size, (kind, [k1, k2])) in cases {
        let camera = barrel(k1, k2);
        let Model::Radial(radial) = camera.model().clone() else { panic!("radial") };
        let truth = |field: f64| {
            let observed = field * radial.unit_mm();
            observed / radial.ideal_radius_mm(observed).expect("no fold")
        };
        assert_coverage(&format!("distortion, {chart}, {kind}"), |seed| grid_run(&camera, size, 0.02, truth, seed));
    }
}

/// Sightings of a 6 × 5 grid of steps of 50 mm.
fn sighted(view: &View, mut normal: impl FnMut() -> f64) -> Sightings {
    let point = |i: usize| {
        let chart = DVec2::new((i % 6) as f64, (i / 6) as f64) * 0.05;
        let noise = 0.1 * DVec2::new(normal(), normal());
        Some(Sighting { chart, at: view.image(chart)? + noise })
    };
    Sightings { points: (0..30).filter_map(point).collect(), disc_radius: None }
}

fn pose(camera: &Calibration, rotation: [f64; 3], distance: f64) -> View {
    View::new(camera, rotation, DVec2::new(0.125, 0.1), DVec3::new(0.0, 0.01, distance))
}

fn named(calibrated: &CalibrationResult, truth: &[(&'static str, f64)]) -> CoverageRun {
    truth.iter().map(|(name, truth)| (*name, calibrated.estimate(name).expect("fitted"), *truth)).collect()
}

#[test]
fn calibration_from_views() {
    let family = Family::Perspective { radial: RadialTerms::Polynomial(2), tangential: true };
    assert_coverage("calibrate", |seed| {
        let camera = perspective(500.0, &[-0.2, 0.05, 0.001, -0.002], [640, 480]);
        let rotations = [[0.5, 0.0, 0.1], [-0.5, 0.1, 0.0], [0.1, -0.5, 1.6]];
        let mut normal = normals(seed, 0);
        let views: Vec<Sightings> =
            rotations.iter().map(|rotation| sighted(&pose(&camera, *rotation, 0.5), &mut normal)).collect();
        let calibrated = calibrate(&views, [640, 480], family, CalibrationOptions::default()).expect("settles");
        let k = [("k1", -0.2), ("k2", 0.05), ("p1", 0.001), ("p2", -0.002)];
        named(
            &calibrated,
            &[&[("fx_px", 500.0), ("fy_px", 501.5), ("cx_px", 326.3), ("cy_px", 235.3)][..], &k].concat(),
        )
    });
}

/// One frontal view; its distance is known to 1 mm of 500.
#[test]
fn focal_length_from_a_distance() {
    let family = Family::Perspective { radial: RadialTerms::Polynomial(2), tangential: false };
    assert_coverage("focal", |seed| {
        let mut normal = normals(seed, 0);
        let camera = {
            let Model::Perspective(model) = perspective(500.0, &[-0.2, 0.05, 0.0, 0.0], [640, 480]).model().clone()
            else {
                panic!("perspective")
            };
            let matrix = CameraMatrix { fx: 500.0, fy: 500.0, skew: 0.0, cx: 320.0, cy: 240.0 };
            Calibration::new(Model::Perspective(model), matrix, [640, 480]).expect("a camera")
        };
        let options = CalibrationOptions {
            square_pixels: true,
            principal_px: Some(DVec2::new(320.0, 240.0)),
            distance: Some(Estimate::new(0.5 + 0.001 * normal(), 0.001)),
            ..CalibrationOptions::default()
        };
        let views = [sighted(&pose(&camera, [0.0; 3], 0.5), normal)];
        let calibrated = calibrate(&views, [640, 480], family, options).expect("settles");
        named(&calibrated, &[("fx_px", 500.0), ("k1", -0.2), ("k2", 0.05)])
    });
}

/// One frontal view with a distance typed to half a millimetre: the rounding error is not normally distributed, and as large as
/// that of the points.
#[test]
fn focal_length_from_a_typed_distance() {
    const DIGIT: f64 = 5e-4;
    let family = Family::Perspective { radial: RadialTerms::Polynomial(0), tangential: false };
    assert_coverage("focal, distance typed", |seed| {
        let mut normal = normals(seed, 0);
        let matrix = CameraMatrix { fx: 500.0, fy: 500.0, skew: 0.0, cx: 320.0, cy: 240.0 };
        let model = perspective(500.0, &[], [640, 480]).model().clone();
        let camera = Calibration::new(model, matrix, [640, 480]).expect("a camera");
        let distance = 0.5 + 0.01 * normal();
        let view = View::new(&camera, [0.0; 3], DVec2::new(0.125, 0.1), DVec3::new(0.0, 0.01, distance));
        let typed = (distance / DIGIT).round() * DIGIT;
        let options = CalibrationOptions {
            square_pixels: true,
            principal_px: Some(DVec2::new(320.0, 240.0)),
            distance: Some(Estimate::new(typed, DIGIT / 12_f64.sqrt())),
            ..CalibrationOptions::default()
        };
        let calibrated = calibrate(&[sighted(&view, normal)], [640, 480], family, options).expect("settles");
        named(&calibrated, &[("fx_px", 500.0)])
    });
}

/// Errors of 0.05 px shared by all points of a column or a row, in addition to 0.02 px of each point's own.
#[test]
fn focal_length_by_points_that_share_errors() {
    let family = Family::Perspective { radial: RadialTerms::Polynomial(0), tangential: false };
    assert_coverage("focal, errors shared by rows and columns", |seed| {
        let mut normal = normals(seed, 0);
        let matrix = CameraMatrix { fx: 500.0, fy: 500.0, skew: 0.0, cx: 320.0, cy: 240.0 };
        let model = perspective(500.0, &[], [640, 480]).model().clone();
        let camera = Calibration::new(model, matrix, [640, 480]).expect("a camera");
        let view = View::new(&camera, [0.0; 3], DVec2::new(0.22, 0.16), DVec3::new(0.0, 0.0, 0.5));
        let columns: Vec<f64> = (0..12).map(|_| 0.05 * normal()).collect();
        let rows: Vec<f64> = (0..9).map(|_| 0.05 * normal()).collect();
        let point = |i: usize| {
            let chart = DVec2::new((i % 12) as f64, (i / 12) as f64) * 0.04;
            let shared = DVec2::new(columns[i % 12], rows[i / 12]);
            Some(Sighting { chart, at: view.image(chart)? + shared + 0.02 * DVec2::new(normal(), normal()) })
        };
        let view = Sightings { points: (0..108).filter_map(point).collect(), disc_radius: None };
        let options = CalibrationOptions {
            square_pixels: true,
            principal_px: Some(DVec2::new(320.0, 240.0)),
            distance: Some(Estimate::new(0.5, 0.0)),
            ..CalibrationOptions::default()
        };
        let calibrated = calibrate(&[view], [640, 480], family, options).expect("settles");
        named(&calibrated, &[("fx_px", 500.0)])
    });
}

/// Red is 0.1 % larger than green, and shifted by 0.05 px.
#[test]
fn lateral_colour() {
    assert_coverage("chromatic", |seed| {
        let camera = |f: f64| {
            let matrix = CameraMatrix { fx: f, fy: f, skew: 0.0, cx: 400.0, cy: 300.0 };
            let model = perspective(f, &[], SIZE).model().clone();
            Calibration::new(model, matrix, SIZE).expect("a camera")
        };
        let grid = |f: f64, purpose: u32| {
            let view = View::new(&camera(f), [0.0; 3], DVec2::new(10.0, 7.5), DVec3::new(0.0, 0.0, 20.0));
            let mut grid = observe(&view, [21, 16], normals(seed, purpose));
            grid.nodes.iter_mut().for_each(|n| n.at.x += if purpose == 1 { 0.05 } else { 0.0 });
            grid
        };
        let list = displacements(&grid(700.0, 0), &grid(700.7, 1), SIZE);
        let rings = rings(&list);
        let [inner, outer] = [rings[1], rings[rings.len() - 2]];
        let truth = |field: f64| 0.001 * field * HALF_DIAGONAL_PX;
        let [x, y] = shift(&list).expect("points");
        vec![
            ("mean along x", x, 0.05),
            ("mean along y", y, 0.0),
            ("radial, an inner ring", inner.radial, truth(inner.field)),
            ("radial, an outer ring", outer.radial, truth(outer.field)),
            ("tangential, an outer ring", outer.tangential, 0.0),
        ]
    });
}
