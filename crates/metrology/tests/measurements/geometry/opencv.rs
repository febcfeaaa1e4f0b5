//! Comparison with OpenCV, on its own photographs: tests/oracles/checkerboard.py, corners.py.

use etendue_metrology::calibrate::{CalibrationOptions, Family, RadialTerms, Sighting, Sightings, calibrate};
use etendue_metrology::target::{Node, Target, TargetError, TargetQuery, find};
use etendue_metrology::{Estimate, Image};
use glam::DVec2;
use serde_json::Value;

const FIGURES: &str = include_str!("../../../../../tests/oracles/figures/checkerboard/opencv.json");
const CORNERS: &str = include_str!("../../../../../tests/oracles/figures/checkerboard/corners.json");

fn figures() -> Value {
    serde_json::from_str(FIGURES).expect("JSON")
}

/// Corners of a photograph in raster coordinates.
fn corners(list: &Value) -> Vec<DVec2> {
    let number = |v: &Value| v.as_f64().expect("a number");
    let list = list.as_array().expect("a list");
    list.iter().map(|p| DVec2::new(number(&p[0]), number(&p[1])) + 0.5).collect()
}

fn file(name: &str) -> Image {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/oracles/figures/checkerboard");
    let read = image::open(folder.join(name)).expect("a picture").into_luma8();
    let samples = read.as_raw().iter().map(|v| f32::from(*v)).collect();
    Image::from_samples(read.width() as usize, read.height() as usize, samples).expect("as large")
}

/// Corners detected in an image, each with the nearest in a list.
fn compared_corners(name: &str, list: &[DVec2]) -> Vec<(Node, DVec2)> {
    let query = TargetQuery { target: Some(Target::Checkerboard), size: Some([9, 6]) };
    let own_grid = find(&file(name), query).unwrap_or_else(|error| panic!("{name}: {error}"));
    let from = |at: DVec2, other: &DVec2| (*other - at).length_squared();
    let nearest = |n: &Node| list.iter().copied().min_by(|a, b| from(n.at, a).total_cmp(&from(n.at, b)));
    own_grid.nodes.iter().map(|n| (*n, nearest(n).expect("a list of corners"))).collect()
}

/// Standard deviation of a coordinate of OpenCV's corners in a synthetic image similar to the photograph.
fn deviation(name: &str) -> f64 {
    corner_figures()["photographs"][name]["opencv_deviation_px"].as_f64().expect("a number")
}

fn corner_figures() -> Value {
    serde_json::from_str(CORNERS).expect("JSON")
}

#[test]
fn corners_of_photographs_are_opencv_s_within_their_joint_uncertainty() {
    let figures = figures();
    let (mut agreeing, mut all) = (0, 0);
    for (name, list) in figures["views"].as_object().expect("views") {
        let pairs = compared_corners(name, &corners(list));
        assert!(pairs.len() >= 52, "{name}: {}", pairs.len());
        let off: Vec<DVec2> = pairs.iter().map(|(n, opencv_px)| *opencv_px - n.at).collect();
        let mean = off.iter().sum::<DVec2>() / off.len() as f64;
        // 0.05 px, and twice the contribution of OpenCV's scatter of 0.12 px at most to a mean of 54.
        assert!(mean.abs().max_element() < 0.05 + 0.033, "{name}: {mean}");
        let within = |((n, _), d): &(&(Node, DVec2), &DVec2)| {
            let joint = etendue_core::maths::f64::hypot(n.uncertainty_px, deviation(name));
            d.abs().to_array().iter().filter(|c| **c <= 0.05 + 2.0 * joint).count()
        };
        agreeing += pairs.iter().zip(&off).map(|pair| within(&pair)).sum::<usize>();
        all += 2 * off.len();
    }
    // Fraction of coordinates within 0.05 px and the expanded joint uncertainty, the coverage of 95 % intervals.
    let fraction = agreeing as f64 / all as f64;
    assert!(fraction >= 0.95, "{fraction}");
}

#[test]
fn corners_of_drawn_photographs_are_nearer_to_the_truth_than_opencv_s() {
    let figures = corner_figures();
    for (name, list) in figures["drawn"].as_object().expect("drawn") {
        let pairs = compared_corners(&format!("drawn-{name}"), &corners(list));
        let mean = |value: &dyn Fn(&(Node, DVec2)) -> f64| pairs.iter().map(value).sum::<f64>() / pairs.len() as f64;
        let error = (0.5 * mean(&|(n, truth)| (n.at - *truth).length_squared())).sqrt();
        assert!(error < 0.5 * deviation(name), "{name}: {error}");
        let normal = (0.5 * mean(&|(n, truth)| ((n.at - *truth) / n.uncertainty_px).length_squared())).sqrt();
        // 108 coordinates: 7 %; the limit is four of them, plus some tenths, as compression errors are not noise.
        assert!((0.6..1.5).contains(&normal), "{name}: {normal}");
    }
}

#[test]
fn cameras_from_both_s_corners_agree_within_their_joint_uncertainty() {
    let figures = figures();
    let views: Vec<Sightings> = figures["views"]
        .as_object()
        .expect("views")
        .iter()
        .map(|(name, list)| {
            let opencv_corners = corners(list);
            let index = |at: DVec2| opencv_corners.iter().position(|t| *t == at).expect("of the list");
            let chart = |i: usize| DVec2::new((i % 9) as f64, (i / 9) as f64);
            let points = compared_corners(name, &opencv_corners)
                .into_iter()
                .map(|(n, t)| Sighting { chart: chart(index(t)), at: n.at });
            Sightings { points: points.collect(), disc_radius: None }
        })
        .collect();
    let calibrated = calibrate(&views, [640, 480], FAMILY, CalibrationOptions::default()).expect("settles");
    for (key, opencv_estimate) in camera(&figures) {
        let own_estimate = calibrated.estimate(&key).expect("fitted");
        let e_n = (own_estimate.value - opencv_estimate.value)
            / (2.0
                * etendue_core::maths::f64::hypot(
                    own_estimate.standard_uncertainty,
                    opencv_estimate.standard_uncertainty,
                ));
        assert!(e_n.abs() < 1.0, "{key}: {own_estimate:?} {opencv_estimate:?}");
    }
    // Their corners leave 0.195 px.
    assert!(calibrated.rms_px() < 0.17, "{}", calibrated.rms_px());
}

const FAMILY: Family = Family::Perspective { radial: RadialTerms::Polynomial(3), tangential: true };

/// OpenCV's camera, in raster coordinates, with this program's names.
fn camera(figures: &Value) -> Vec<(String, Estimate)> {
    let named = |(name, opencv_value): (&String, &Value)| {
        let number = |key: &str| opencv_value[key].as_f64().expect("a number");
        let centre = if name.starts_with('c') { 0.5 } else { 0.0 };
        let unit = if ["fx", "fy", "cx", "cy"].contains(&name.as_str()) { "_px" } else { "" };
        (format!("{name}{unit}"), Estimate::new(number("value") + centre, number("standard_deviation")))
    };
    figures["camera"].as_object().expect("a camera").iter().map(named).collect()
}

#[test]
fn a_pattern_that_is_no_chart_is_refused() {
    // Another of OpenCV's images: a print whose moiré forms rows and columns, 8 px apart. Of the 125 images without a chart of
    // Debian's opencv-doc it is the most similar to one (tests/oracles/figures/checkerboard/no_chart.json).
    for target in [Some(Target::Checkerboard), Some(Target::Dots), None] {
        let result = find(&file("pic4.png"), TargetQuery { target, size: None });
        assert!(matches!(result, Err(TargetError::None { .. } | TargetError::Small { .. })), "{result:?}");
    }
}

#[test]
fn the_camera_from_opencv_s_corners_is_opencv_s() {
    let figures = figures();
    let views: Vec<Sightings> = figures["views"]
        .as_object()
        .expect("views")
        .values()
        .map(|list| {
            let chart = |i: usize| DVec2::new((i % 9) as f64, (i / 9) as f64);
            let points = corners(list).into_iter().enumerate().map(|(i, at)| Sighting { chart: chart(i), at });
            Sightings { points: points.collect(), disc_radius: None }
        })
        .collect();
    let calibrated = calibrate(&views, [640, 480], FAMILY, CalibrationOptions::default()).expect("settles");
    for (name, opencv_estimate) in camera(&figures) {
        let place = calibrated.parameters.iter().position(|p| p.name == name).expect("fitted");
        let (own_estimate, independent) =
            (calibrated.parameters[place].estimate, calibrated.independent_uncertainties[place]);
        // The same points and the same sum of squares: the parameters agree to a hundredth of their uncertainty, and the
        // uncertainties for independent points, which OpenCV states, to the linearisation. This program's uncertainties include
        // errors shared by a row or column: on these photographs they are up to twice as large.
        assert!(
            (own_estimate.value - opencv_estimate.value).abs() < 0.01 * opencv_estimate.standard_uncertainty,
            "{name}: {own_estimate:?} {opencv_estimate:?}"
        );
        assert!(
            (independent / opencv_estimate.standard_uncertainty - 1.0).abs() < 0.02,
            "{name}: {independent} {opencv_estimate:?}"
        );
        assert!(
            (1.0..2.0).contains(&(own_estimate.standard_uncertainty / independent)),
            "{name}: {own_estimate:?} {independent}"
        );
    }
    assert!(
        (calibrated.rms_px() / figures["rms_px"].as_f64().expect("a number") - 1.0).abs() < 1e-4,
        "{}",
        calibrated.rms_px()
    );
}
