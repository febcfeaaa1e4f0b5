//! Charts before calibrated cameras, and what OpenCV made of their pictures (tests/oracles/charts.py).
//!
//! The stored figures have their bounds; and the pictures that they come from are rendered again, with fewer samples, so that the
//! figures are those of this program: corners are where OpenCV found them and where the calibration puts them.

use etendue_core::Plane;
use etendue_core::maths::f64::exp;
use etendue_core::quantity::LinearRgb;
use etendue_io::load_assets;
use etendue_pipeline::plan::CameraPlan;
use etendue_pipeline::rectified::RectifiedCamera;
use etendue_pipeline::{Choices, compile};
use etendue_scene::{Description, Overrides};
use etendue_tests::Shot;
use glam::{DMat2, DVec2, DVec3};
use serde_json::Value;
use std::path::{Path, PathBuf};

const CAMERAS: [&str; 2] = ["perspective", "fisheye"];

fn figures() -> Value {
    let text = include_str!("../../oracles/figures/charts.json");
    serde_json::from_str(text).expect("JSON")
}

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().expect("a list").iter().map(|x| x.as_f64().expect("a number")).collect()
}

/// Focal lengths and principal point to 0.05 px or three standard deviations, the distortion to 0.1 px.
#[test]
fn opencv_finds_the_camera_that_took_the_charts() {
    let figures = figures();
    for name in CAMERAS {
        let camera = &figures["cameras"][name];
        assert!(camera["found"].as_u64() >= Some(25), "{name}: {} views", camera["found"]);
        let deviations = numbers(&camera["estimated"]["deviations"]);
        for (off, deviation) in numbers(&camera["off"]["fx_fy_cx_cy"]).iter().zip(deviations) {
            assert!(off.abs() <= f64::max(0.05, 3.0 * deviation), "{name}: {off} ± {deviation}");
        }
        for key in ["curve_px", "field_px"] {
            assert!(camera["off"][key].as_f64().expect("a number") <= 0.1, "{name}: {}", camera["off"]);
        }
        // No shift of all corners: a half of a pixel would be one.
        for mean in numbers(&camera["corners_off"]["mean_px"]) {
            assert!(mean.abs() < 0.005, "{name}: {mean}");
        }
    }
}

/// A view of a chart, rendered again.
struct View {
    shot: Shot,
    /// Electrons over their largest.
    picture: Plane<LinearRgb>,
}

fn view(name: &str, index: usize) -> View {
    let job: PathBuf = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("oracles/figures/charts/{name}.toml"));
    let read = |path: &Path| std::fs::read_to_string(path).map_err(|error| error.to_string().into());
    let mut overrides = Overrides::default();
    overrides.add_render("`spp` 16", "spp", "16");
    let job = Description::load(&job, &read, &overrides).unwrap_or_else(|errors| panic!("{errors}"));
    let assets = load_assets(&job.assets()).unwrap_or_else(|errors| panic!("{errors:?}"));
    let plan = compile(&job, &assets, &Choices::default()).unwrap_or_else(|errors| panic!("{errors:?}"));
    let shot = Shot::render_camera(plan, index);
    let electrons = shot.electrons();
    let max_electrons = electrons.iter().copied().fold(0.0, f32::max);
    let raster = &shot.camera().body.raster;
    let samples = electrons.iter().map(|e| [e / max_electrons; 3]).collect();
    let image = Plane::from_samples(raster.width(), raster.height(), samples).expect("one sample per pixel");
    View { shot, picture: image }
}

/// The inner corners of the board in the world.
fn board() -> Vec<DVec3> {
    let board = &figures()["board"];
    let number = |key: &str| board[key].as_f64().expect("a number");
    let (columns, rows, square) = (number("columns"), number("rows"), number("square_m"));
    let at = |i: u32, n: f64| square * (f64::from(i) - 0.5 * (n - 1.0));
    // The board's right is −y, its down −z.
    let row = |j: u32| (0..columns as u32).map(move |i| DVec3::new(0.0, -at(i, columns), -at(j, rows)));
    (0..rows as u32).flat_map(row).collect()
}

/// A direction of the camera to a point of the world.
fn towards(camera: &CameraPlan, point: DVec3) -> DVec3 {
    camera.path.at(0.0).point_to_camera(point)
}

/// The corner near a raster point: where all edges' lines meet (Förstner & Gülch 1987) in the picture blurred by 1.5 px, by the
/// gradients within ± 6 px; what the oracle does.
fn corner(image: &Plane<LinearRgb>, guess: DVec2) -> DVec2 {
    let value = |x: i64, y: i64| f64::from(image.at(x as usize, y as usize)[0]);
    let bell = |distance: f64, sigma: f64| exp(-0.5 * (distance / sigma) * (distance / sigma));
    let kernel: Vec<(i64, f64)> = (-5..=5).map(|i| (i, bell(i as f64, 1.5))).collect();
    let blurred = |x: i64, y: i64| {
        let row = |j: i64| kernel.iter().map(|(i, w)| w * value(x + i, y + j)).sum::<f64>();
        kernel.iter().map(|(j, w)| w * row(*j)).sum::<f64>()
    };
    let (cx, cy) = (guess.x.floor() as i64, guess.y.floor() as i64);
    let window = (-6..=6).flat_map(|j| (-6..=6).map(move |i| (cx + i, cy + j)));
    let edges: Vec<(DVec2, DVec2)> = window
        .map(|(x, y)| {
            let gradient = DVec2::new(blurred(x + 1, y) - blurred(x - 1, y), blurred(x, y + 1) - blurred(x, y - 1));
            (DVec2::new(x as f64, y as f64) + 0.5, gradient)
        })
        .collect();
    (0..20).fold(guess, |at, _| {
        let (mut normal, mut right) = (DMat2::ZERO, DVec2::ZERO);
        for (place, gradient) in &edges {
            let weight = bell((*place - at).length(), 3.0);
            let outer = DMat2::from_cols(*gradient * gradient.x, *gradient * gradient.y) * weight;
            normal += outer;
            right += outer * *place;
        }
        normal.inverse() * right
    })
}

/// Root of the mean square, and the largest, of distances.
fn spread(distances: &[f64]) -> (f64, f64) {
    let square = distances.iter().map(|d| d * d).sum::<f64>() / distances.len() as f64;
    (square.sqrt(), distances.iter().copied().fold(0.0, f64::max))
}

/// Corners of 16 samples a pixel: the oracle's own corners, of 64, lie 0.02 px (RMS of the distance) and at worst 0.06 px from the
/// truth, by what a box of a pixel leaves of an edge; fewer samples add as much again. Half a pixel would be 0.7.
const RMS_PX: f64 = 0.04;
const WORST_PX: f64 = 0.15;

#[test]
fn the_charts_of_the_figures_are_still_those_of_this_program() {
    let figures = figures();
    for (name, index) in [("perspective", 3), ("fisheye", 8)] {
        let View { shot, picture: image } = view(name, index);
        let camera = shot.camera();
        let stored = numbers(&figures["cameras"][name]["seen_px"][&camera.name]);
        let (mut to_stored, mut to_truth) = (Vec::new(), Vec::new());
        for (point, expected_px) in board().into_iter().zip(stored.chunks(2)) {
            let truth = camera.body.raster.raster_px(camera.body.lens.project(towards(camera, point)).expect("seen"));
            let actual = corner(&image, truth);
            // OpenCV counts pixel centres as whole numbers.
            to_stored.push((actual - DVec2::new(expected_px[0], expected_px[1]) - 0.5).length());
            to_truth.push((actual - truth).length());
        }
        for (reference, (rms, worst)) in [("OpenCV's", spread(&to_stored)), ("the true", spread(&to_truth))] {
            assert!(rms < RMS_PX && worst < WORST_PX, "{name}: {rms} px, at worst {worst} px from {reference} corners");
        }
    }
}

/// The corners of an undistorted picture are where the twin's matrix puts the board's points, on straight lines.
#[test]
fn an_undistorted_chart_is_a_pinhole_s() {
    let View { shot, picture: image } = view("perspective", 3);
    let camera = shot.camera();
    let twin = RectifiedCamera::new(&camera.body, 0.9).expect("a twin");
    let straight = twin.resampled(&camera.body, &image);
    let (mut off, mut moved) = (Vec::new(), 0.0_f64);
    for point in board() {
        let ray = towards(camera, point);
        let truth = DVec2::new(ray.x, ray.y) / ray.z * DVec2::new(twin.matrix.fx, twin.matrix.fy)
            + DVec2::new(twin.matrix.cx, twin.matrix.cy);
        off.push((corner(&straight, truth) - truth).length());
        let source = twin.source(&camera.body, truth).expect("seen");
        moved = moved.max((source - truth).length());
    }
    assert!(moved > 10.0, "distortion moves corners by {moved} px at most");
    let (rms, worst) = spread(&off);
    assert!(rms < RMS_PX && worst < WORST_PX, "{rms} px, at worst {worst} px");
}
