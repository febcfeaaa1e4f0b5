//! What OpenCV made of rendered pictures (tests/oracles/reconstruction.py), beside the ground truth that is traced here anew.
//!
//! Bounds are those of the algorithms, twice and more what they were found to be off by: matching in sixteenths of a pixel for disparity,
//! patches of eight pixels for flow, features to some tenths of a pixel for poses. Half a pixel, a row too many, a swapped sign or a pose of
//! another moment is beyond all of them.

use etendue_core::Plane;
use etendue_core::quantity::Identity;
use etendue_io::load_assets;
use etendue_pipeline::frame_view::FrameView;
use etendue_pipeline::motion::{disparity, motion_truth};
use etendue_pipeline::{Choices, Plan, compile};
use etendue_scene::{Description, Overrides};
use etendue_tracer::accel::Simd;
use glam::{DQuat, DVec3};
use serde_json::Value;
use std::path::{Path, PathBuf};

/// Seen in the other picture.
const VISIBLE: u32 = 1;

fn figures() -> Value {
    serde_json::from_str(include_str!("../../oracles/figures/reconstruction.json")).expect("JSON")
}

fn room() -> Plan {
    let job: PathBuf = Path::new(env!("CARGO_MANIFEST_DIR")).join("oracles/figures/reconstruction/room.toml");
    let read = |path: &Path| std::fs::read_to_string(path).map_err(|error| error.to_string().into());
    let job = Description::load(&job, &read, &Overrides::default()).unwrap_or_else(|errors| panic!("{errors}"));
    let assets = load_assets(&job.assets()).unwrap_or_else(|errors| panic!("{errors:?}"));
    compile(&job, &assets, &Choices::default()).unwrap_or_else(|errors| panic!("{errors:?}"))
}

fn view<'a>(plan: &'a Plan, name: &str, frame: u32) -> FrameView<'a> {
    FrameView { camera: plan.camera(name).expect("a camera"), frame }
}

/// Errors of an estimate at the stored places that the other picture shows.
struct Errors {
    places: usize,
    median_px: f64,
    outliers_over_3_px: f64,
    /// Median of each component's signed error.
    shift_px: [f64; 2],
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

/// `truth` of a pixel; the stored list holds every eighth pixel of every eighth row, from the fourth on.
fn errors(estimate: &Value, visible: &Plane<Identity>, truth: impl Fn(usize, usize) -> [f64; 2]) -> Errors {
    let step = figures()["step_px"].as_u64().expect("a number") as usize;
    let columns = (visible.width() - step / 2).div_ceil(step);
    let stored = estimate.as_array().expect("a list");
    let off = stored.iter().enumerate().filter_map(|(i, estimated)| {
        let (x, y) = (step / 2 + step * (i % columns), step / 2 + step * (i / columns));
        let number = |value: &Value| value.as_f64().expect("a number");
        let estimated = match estimated {
            Value::Null => return None,
            Value::Array(uv) => [number(&uv[0]), number(&uv[1])],
            value => [number(value), 0.0],
        };
        let truth = truth(x, y);
        (visible.at(x, y) == VISIBLE).then(|| [estimated[0] - truth[0], estimated[1] - truth[1]])
    });
    let off: Vec<[f64; 2]> = off.collect();
    let lengths: Vec<f64> = off.iter().map(|[u, v]| (u * u + v * v).sqrt()).collect();
    Errors {
        places: off.len(),
        outliers_over_3_px: lengths.iter().filter(|px| **px > 3.0).count() as f64 / lengths.len() as f64,
        median_px: median(lengths),
        shift_px: [0, 1].map(|k| median(off.iter().map(|off| off[k]).collect())),
    }
}

#[track_caller]
fn assert_within(actual: &Errors, stored: &Value, (median_px, outliers, shift_px): (f64, f64, f64)) {
    let number = |key: &str| stored["errors"][key].as_f64().expect("a number");
    assert!(actual.places > 900, "{} places", actual.places);
    for (median, over_3) in
        [(actual.median_px, actual.outliers_over_3_px), (number("median_px"), number("outliers_over_3_px"))]
    {
        assert!(median < median_px && over_3 < outliers, "median {median} px, {over_3} beyond 3 px");
    }
    assert!(actual.shift_px.iter().all(|px| px.abs() < shift_px), "{:?}", actual.shift_px);
}

#[test]
fn semi_global_matching_finds_the_disparity() {
    let (plan, figures) = (room(), figures());
    let (truth, visible) = disparity(&plan, &view(&plan, "left", 0), &view(&plan, "right", 0), Simd::Auto);
    let actual = errors(&figures["disparity"]["estimate"], &visible, |x, y| [f64::from(truth.at(x, y)), 0.0]);
    assert_within(&actual, &figures["disparity"], (0.25, 0.015, 0.15));
    assert!(figures["disparity"]["found"].as_f64() > Some(0.9), "part of the pixels that has an estimate");
}

#[test]
fn dense_inverse_search_finds_the_flow() {
    let (plan, figures) = (room(), figures());
    let truth = motion_truth(&plan, &view(&plan, "left", 0), &[view(&plan, "left", 1)], Simd::Auto);
    let (flow, visible) = (&truth.neighbours[0].flow, &truth.neighbours[0].visibility);
    let actual = errors(&figures["flow"]["estimate"], visible, |x, y| flow.at(x, y).map(f64::from));
    assert_within(&actual, &figures["flow"], (0.1, 0.01, 0.05));
}

/// Angles of the relative pose of two frames against OpenCV's, degrees: of rotation and of direction; and the ratio of lengths.
fn off(plan: &Plan, stored: &Value, from: (&str, u32), to: (&str, u32)) -> [f64; 3] {
    let pose = |(name, frame): (&str, u32)| {
        let view = view(plan, name, frame);
        view.camera.path.at(view.interval().middle_s())
    };
    let vector = |key: &str| {
        let list = stored[key].as_array().expect("a list");
        DVec3::from_array(std::array::from_fn(|i| list[i].as_f64().expect("a number")))
    };
    let (from, to) = (pose(from), pose(to));
    let turn = DQuat::from_mat3(&(to.rotation.transpose() * from.rotation));
    let shift = to.point_to_camera(from.position_m);
    let translation = vector("translation");
    let direction = shift.angle_between(translation);
    let turned = DQuat::from_scaled_axis(vector("rotation_rad")) * turn.inverse();
    // Twice the asine of the imaginary part, which is small.
    let rotation = 2.0 * turned.xyz().length();
    [rotation.to_degrees(), direction.to_degrees(), translation.length() / shift.length()]
}

#[test]
fn features_tell_the_poses_that_are_stated() {
    let (plan, figures) = (room(), figures());
    // 0.2 m at 6 to 9 m: a shift across and a turn are told apart by what perspective leaves, some degrees.
    let [rotation, direction, _] = off(&plan, &figures["left_to_right"], ("left", 0), ("right", 0));
    assert!(rotation < 0.2 && direction < 6.0, "{rotation}°, {direction}°");
    let [rotation, direction, ratio] = off(&plan, &figures["frame_0_to_1"], ("left", 0), ("left", 1));
    assert!(rotation < 0.02 && direction < 0.3 && (ratio - 1.0).abs() < 0.01, "{rotation}°, {direction}°, {ratio}");
}

#[test]
fn the_video_that_opencv_reads_is_the_pictures() {
    let video = &figures()["video"];
    assert_eq!((video["frames"].as_u64(), video["frame_rate_hz"].as_f64()), (Some(2), Some(10.0)));
    // 219 steps of luma for 255 of grey: half a step each way.
    assert!(video["largest_difference"].as_f64() <= Some(1.0), "{video}");
}
