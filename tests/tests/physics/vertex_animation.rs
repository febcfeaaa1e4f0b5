//! Vertices that move within their mesh: blur, ground truth of motion and boxes against closed forms.

use crate::motion::{SIZE, electrons, falloff, job, overlap};
use etendue_core::Plane;
use etendue_core::quantity::MeanElectrons;
use etendue_pipeline::boxes::object_boxes;
use etendue_pipeline::frame_view::FrameView;
use etendue_pipeline::motion::{MotionTruth, Visibility, motion_truth};
use etendue_pipeline::truth::ground_truth;
use etendue_tests::Job;
use etendue_tracer::accel::Simd;
use glam::{DMat2, DVec2};

const QUAD: [[u32; 3]; 2] = [[0, 1, 2], [0, 2, 3]];

/// The places of the picture's column (y goes to the left, 500 px a metre).
fn y_of(column: f64) -> f64 {
    (50.0 - column) / 500.0
}

/// A bar from one column to another, all over the rows.
fn bar(from: f64, to: f64) -> [[f64; 3]; 4] {
    let (a, b) = (y_of(from), y_of(to));
    [[-0.5, a, 0.0], [-0.5, b, 0.0], [0.5, b, 0.0], [0.5, a, 0.0]]
}

/// A mesh of these files in place of the bar.
fn moving(files: &[Vec<[f64; 3]>], keys: &str, place: &str, sensor: &str, spp: u32) -> Job {
    let object = format!("mesh = \"quad\"\n{place}");
    let meshes = format!(
        "[scene]\n[[scene.meshes]]\nname = \"quad\"\nup_axis = \"z\"\n\
         vertex_animation = {{ files = \"quad-%d.obj\", count = {}, {keys} }}",
        files.len()
    );
    let job = job(&object, sensor, spp).replaced("[scene]\n", &format!("{meshes}\n"));
    let add = |job: Job, (number, positions): (usize, &Vec<[f64; 3]>)| {
        job.with_triangles(&format!("quad-{number}.obj"), positions, &QUAD)
    };
    files.iter().enumerate().fold(job, add)
}

const GLOBAL: &str = "exposure_s = 0.05\nshutter = { type = \"global\" }";

/// The bar's left edge stays at column 20, its right edge goes from 30 to 60 within half the exposure and to 70 in the other half. A pixel
/// right of 30 has the share of the time in which the edge lies beyond it. Tolerance: of 512 stratified samples some 20 cannot tell on which side
/// of the edge they lie, half of which are wrong either way: 2.2 of 512, 0.44 %, a pixel, 0.06 % the mean of 60 rows; three of these.
#[test]
fn a_bar_that_stretches_is_blurred_by_the_path_of_its_edge() {
    let files = [bar(20.0, 30.0), bar(20.0, 60.0), bar(20.0, 70.0)].map(Vec::from);
    let times = "times_s = [1000, 1000.025, 1000.05]";
    let shot = moving(&files, times, "", GLOBAL, 512).shot();
    let still = moving(&files, "times_s = [2000, 2001, 2002]", "", GLOBAL, 512).shot();
    let mean = |plane: &Plane<MeanElectrons>, x: usize| {
        (0..SIZE[1]).map(|y| f64::from(plane.at(x, y)) / falloff(x, y)).sum::<f64>() / SIZE[1] as f64
    };
    let (blurred, before) = (electrons(&shot, 0), electrons(&still, 0));
    let full = (21..29).map(|x| mean(&before, x)).sum::<f64>() / 8.0;
    for x in 0..SIZE[0] {
        const STEPS: usize = 20_000;
        let edge = |i: usize| match (i as f64 + 0.5) / STEPS as f64 {
            part if part < 0.5 => 30.0 + 60.0 * part,
            part => 60.0 + 20.0 * (part - 0.5),
        };
        let cover = |i: usize| overlap(x as f64, x as f64 + 1.0, 20.0, edge(i));
        let expected = (0..STEPS).map(cover).sum::<f64>() / STEPS as f64;
        let actual = mean(&blurred, x) / full;
        assert!((actual - expected).abs() < 0.002, "column {x}: {actual} for {expected}");
        let overlap_before = overlap(x as f64, x as f64 + 1.0, 20.0, 30.0);
        assert!((mean(&before, x) / full - overlap_before).abs() < 0.002, "column {x} before the first file");
    }
}

/// A square of 4 m whose corners go by A(t) = 1 + B t: at every time its image under a matrix, wherever its two triangles part it.
const B: DMat2 = DMat2::from_cols_array(&[0.7, 0.4, -0.3, 0.5]);

fn sheared(time_s: f64) -> Vec<[f64; 3]> {
    let matrix = DMat2::IDENTITY + B * time_s;
    [[-2.0, -2.0], [2.0, -2.0], [2.0, 2.0], [-2.0, 2.0]]
        .map(|corner| (matrix * DVec2::from(corner)).extend(0.0).to_array())
        .to_vec()
}

/// Truth of frame 0 (middle 0.005 s after 1 000 s) against frame 1, 0.1 s later.
fn truth(place: &str) -> MotionTruth {
    let files = [sheared(0.0), sheared(1.0)];
    let sensor = "exposure_s = 0.01\nshutter = { type = \"global\" }";
    let plan = moving(&files, "rate_hz = 1, time_offset_s = 1000", place, sensor, 1).plan();
    let at = |frame| FrameView { camera: &plan.cameras[0], frame };
    motion_truth(&plan, &at(0), &[at(1)], Simd::Auto)
}

/// World (x up in the picture, y to its left) of a picture's place, m.
fn world(at_px: DVec2) -> DVec2 {
    DVec2::new(30.0 - at_px.y, 50.0 - at_px.x) / 500.0
}

fn render_image(world_m: DVec2) -> DVec2 {
    DVec2::new(50.0 - 500.0 * world_m.y, 30.0 - 500.0 * world_m.x)
}

/// With v = A′A⁻¹ p at each point, in the mesh alone and on a mesh that goes along by 0.2 m/s: flow to 1e-4 px, velocities to 1e-6 of f32.
#[test]
fn flow_and_velocity_are_those_of_the_vertices() {
    let keys = "keys = [{ time_s = 1000, position_m = [0, 0, 0] }, { time_s = 1001, position_m = [0, 0.2, 0] }]";
    for (place, along) in [("", 0.0), (keys, 0.2)] {
        let truth = truth(place);
        let (now_s, next_s) = (0.005, 0.105);
        let [now, next] = [now_s, next_s].map(|time_s| DMat2::IDENTITY + B * time_s);
        let [shift, later] = [now_s, next_s].map(|time_s| DVec2::new(0.0, along * time_s));
        for y in 0..SIZE[1] {
            for x in 0..SIZE[0] {
                let at_px = DVec2::new(x as f64, y as f64) + 0.5;
                let own = now.inverse() * (world(at_px) - shift);
                let flow = render_image(next * own + later) - at_px;
                let actual = DVec2::from(truth.neighbours[0].flow.at(x, y).map(f64::from));
                assert!((actual - flow).length() < 1e-4, "{at_px}: {actual} for {flow}");
                let velocity = B * own + DVec2::new(0.0, along);
                let [vx, vy, vz] = truth.velocity.at(x, y).map(f64::from);
                assert!((DVec2::new(vx, vy) - velocity).length() < 1e-6 && vz.abs() < 1e-9, "{vx} {vy} for {velocity}");
                let moved = next * own + later - world(at_px);
                let [right, down, ahead] = truth.neighbours[0].scene_flow.at(x, y).map(f64::from);
                assert!((DVec2::new(right, down) + DVec2::new(moved.y, moved.x)).length() < 1e-6 && ahead.abs() < 1e-6);
                let motion = DVec2::from(truth.motion_vector.at(x, y).map(f64::from));
                assert!((motion + 500.0 * DVec2::new(velocity.y, velocity.x)).length() < 1e-3);
                let inside = at_px + flow;
                if inside.min_element() > 0.01 && inside.x < 99.99 && inside.y < 59.99 {
                    assert_eq!(truth.neighbours[0].visibility.at(x, y), Visibility::Seen as u32);
                }
            }
        }
    }
}

/// At the middle of frame 0 the bar reaches from column 20 to 31, of frame 1 to 41: its boxes in the picture and in space.
#[test]
fn boxes_are_those_of_the_time() {
    let files = [bar(20.0, 30.0), bar(20.0, 50.0)].map(Vec::from);
    let sensor = "exposure_s = 0.02\nshutter = { type = \"global\" }";
    let plan = moving(&files, "times_s = [1000, 1000.2]", "", sensor, 1).plan();
    for (frame, right) in [(0, 31.0), (1, 41.0)] {
        let view = FrameView { camera: &plan.cameras[0], frame };
        let ids = ground_truth(&plan, view.camera, frame, Simd::Auto).instance;
        let boxes = object_boxes(&plan, &view, &ids, Simd::Auto);
        let [bounding_box] = &boxes[..] else { panic!("{boxes:?}") };
        let amodal = bounding_box.amodal.expect("it has an image");
        assert!((amodal.low.x - 20.0).abs() < 1e-4 && (amodal.high.x - right).abs() < 1e-4, "{amodal:?}");
        assert!((bounding_box.solid.size_m.y - (right - 20.0) / 500.0).abs() < 1e-7, "{:?}", bounding_box.solid);
    }
}
