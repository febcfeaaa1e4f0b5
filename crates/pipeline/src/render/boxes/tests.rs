//! Boxes against closed forms: 60 px of focal length, the optical axis at (16, 12) px.

use super::{ObjectBoxes, object_boxes, world_objects};
use crate::Plan;
use crate::render::frame_view::FrameView;
use crate::render::test_scenes::{
    BOARD, FOCAL_PX, PINHOLE, WALL, camera, path, plan, plan_of, pose_of, shifting, with_motion,
};
use crate::render::truth::ground_truth;
use etendue_core::{CameraPath, RowTiming, Shutter};
use etendue_tracer::accel::Simd;
use glam::{DMat3, DVec3};

fn boxes_by(plan: &Plan, path: &CameraPath, shutter: &Shutter) -> Vec<ObjectBoxes> {
    let mut camera = camera(plan, path, shutter);
    camera.time = crate::plan::TimeDependence::Motion;
    let ids = ground_truth(plan, &camera, 1, Simd::Auto).instance;
    object_boxes(plan, &FrameView { camera: &camera, frame: 1 }, &ids, Simd::Auto)
}

fn boxes(plan: &Plan) -> Vec<ObjectBoxes> {
    boxes_by(plan, &CameraPath::constant(pose_of(plan)), &Shutter::Global)
}

fn close(actual: [f64; 4], expected: [f64; 4]) -> bool {
    actual.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-6)
}

fn object(name: &str, shape: &str, keys: &str) -> String {
    format!("[[scene.objects]]\nname = \"{name}\"\nmaterial = \"grey\"\nshape = {{ {shape} }}\n{keys}\n")
}

#[test]
fn a_board_has_the_boxes_of_its_pixels_and_of_its_corners() {
    // 2 m at 5 m: 24 px around (16, 12), not clipped. The wall behind it fills the image and extends 1 200 px beyond each side.
    let object_boxes = boxes(&plan(PINHOLE, &format!("{WALL}{BOARD}")));
    let [wall, board] = &object_boxes[..] else { panic!("{object_boxes:?}") };
    assert_eq!((board.id, board.visible_pixels, board.alone_pixels), (2, 576, 576));
    let (visible, amodal) = (board.visible.expect("seen"), board.amodal.expect("seen"));
    assert_eq!(visible.edges_px(), [4.0, 0.0, 28.0, 24.0]);
    assert!(close(amodal.edges_px(), [4.0, 0.0, 28.0, 24.0]), "{amodal:?}");
    assert_eq!((board.visible_fraction(), board.is_cut), (1.0, false));
    assert!(board.truncated_fraction(32, 24).is_some_and(|part| part < 1e-6));
    assert_eq!((wall.visible_pixels, wall.alone_pixels), (32 * 24 - 576, 32 * 24));
    assert!(close(wall.amodal.expect("seen").edges_px(), [16.0 - 1200.0, 12.0 - 1200.0, 16.0 + 1200.0, 12.0 + 1200.0]));
    let outside = 1.0 - 32.0 * 24.0 / (2400.0 * 2400.0);
    assert!(wall.truncated_fraction(32, 24).is_some_and(|part| (part - outside).abs() < 1e-9));
}

#[test]
fn what_another_object_hides_is_no_part_of_the_visible_box() {
    // A board of 1 m at 2.5 m before the left half of that at 5 m: 24 px wide, 12 px to the left.
    let before =
        object("a", "type = \"quad\", size_m = [1, 1]", "position_m = [2.5, 0.5, 0]\nrotation_deg = [0, 90, 0]");
    let object_boxes = boxes(&plan(PINHOLE, &format!("{BOARD}{before}")));
    let [board, before] = &object_boxes[..] else { panic!("{object_boxes:?}") };
    assert_eq!(board.visible.expect("seen").edges_px(), [16.0, 0.0, 28.0, 24.0]);
    assert!(close(board.amodal.expect("seen").edges_px(), [4.0, 0.0, 28.0, 24.0]));
    assert_eq!((board.visible_fraction(), before.visible_fraction()), (0.5, 1.0));
    // From −8 to 16 px: a third is outside.
    assert!(close(before.amodal.expect("seen").edges_px(), [-8.0, 0.0, 16.0, 24.0]), "{before:?}");
    assert!(before.truncated_fraction(32, 24).is_some_and(|part| (part - 1.0 / 3.0).abs() < 1e-9));
}

#[test]
fn a_hidden_object_has_an_entry_and_one_beside_the_picture_has_none() {
    let hidden = object("b", "type = \"sphere\", radius_m = 0.5", "position_m = [8, 0, 0]");
    let outside = object("c", "type = \"sphere\", radius_m = 0.5", "position_m = [8, 30, 0]");
    let object_boxes = boxes(&plan(PINHOLE, &format!("{BOARD}{hidden}{outside}")));
    let [_, hidden] = &object_boxes[..] else { panic!("{object_boxes:?}") };
    assert_eq!((hidden.visible, hidden.visible_pixels, hidden.visible_fraction()), (None, 0, 0.0));
    // The outline of a ball of radius r at distance d is a circle of f r / √(d² − r²).
    let radius_px = FOCAL_PX * 0.5 / (64.0_f64 - 0.25).sqrt();
    let [left, top, right, bottom] = hidden.amodal.expect("a ball").edges_px();
    // 256 points of the outline.
    for (actual, expected) in
        [(16.0 - left, radius_px), (12.0 - top, radius_px), (right - 16.0, radius_px), (bottom - 12.0, radius_px)]
    {
        assert!((actual / expected - 1.0).abs() < 1e-4, "{actual} for {expected}");
    }
    assert!(hidden.alone_pixels.abs_diff((core::f64::consts::PI * radius_px * radius_px) as usize) <= 6);
}

#[test]
fn what_reaches_behind_the_camera_is_cut() {
    let floor = object("d", "type = \"quad\", size_m = [100, 100]", "position_m = [0, 0, -1.5]");
    let object_boxes = boxes(&plan(PINHOLE, &floor));
    let [floor] = &object_boxes[..] else { panic!("{object_boxes:?}") };
    assert!(floor.is_cut && floor.truncated_fraction(32, 24).is_none());
    // The far edge at 50 m is 1.5 / 50 · 60 px below the axis.
    let visible = floor.visible.expect("seen");
    assert_eq!(visible.edges_px(), [0.0, 14.0, 32.0, 24.0]);
    assert!((floor.amodal.expect("seen").low.y - 13.8).abs() < 0.01, "{floor:?}");
}

/// A bar along the camera's axis, 0.5 m to 2.3 m to its right, from 1.2 m below the axis to 0.3 m above. It ends 5.05 m before the camera and leaves the
/// image to the right, either entirely before the camera or extending behind it.
#[test]
fn what_leaves_the_picture_sideways_ends_at_its_border() {
    for from_m in [0.55, -2.0] {
        let (length_m, middle_m) = (5.05 - from_m, 0.5 * (5.05 + from_m));
        let bar = object(
            "g",
            &format!("type = \"box\", size_m = [{length_m}, 1.8, 1.5]"),
            &format!("position_m = [{middle_m}, -1.4, -0.45]"),
        );
        let object_boxes = boxes(&plan(PINHOLE, &bar));
        let within_image = object_boxes[0].amodal_in_picture.expect("seen").edges_px();
        // The upper inner edge meets the right border, 16 px from the axis, at a depth of 0.5 m · 60 / 16.
        let expected = [16.0 + 60.0 * 0.5 / 5.05, 12.0 - 60.0 * 0.3 / 1.875, 32.0, 24.0];
        assert!(close(within_image, expected), "{from_m}: {within_image:?}");
        assert_eq!(object_boxes[0].is_cut, from_m < 0.0);
        // The whole image, of the bar before the camera, extends 20.7 px above the frame.
        let top = 12.0 - 60.0 * 0.3 / 0.55;
        assert!(object_boxes[0].is_cut || (object_boxes[0].amodal.expect("seen").low.y - top).abs() < 1e-6);
    }
}

#[test]
fn what_covers_the_picture_has_its_borders() {
    let object_boxes = boxes(&plan(PINHOLE, WALL));
    assert_eq!(object_boxes[0].amodal_in_picture.expect("seen").edges_px(), [0.0, 0.0, 32.0, 24.0]);
    // A ball around the camera has no outline.
    let surrounding = object("h", "type = \"sphere\", radius_m = 3", "");
    let object_boxes = boxes(&plan(PINHOLE, &surrounding));
    assert_eq!(
        (object_boxes[0].amodal_in_picture.expect("seen").edges_px(), object_boxes[0].is_cut),
        ([0.0, 0.0, 32.0, 24.0], true)
    );
}

#[test]
fn edges_that_a_fisheye_bends_are_inside_the_box() {
    let lens = "type = \"calibrated\", f_number = 2, projection = { type = \"equidistant\", fx_px = 8 }";
    // Corners at (±2, ±2, 1): 70.5° from the axis, on the diagonals; the middles of the edges at 63.4° extend farther to the sides.
    let board = object("e", "type = \"quad\", size_m = [4, 4]", "position_m = [1, 0, 0]\nrotation_deg = [0, 90, 0]");
    let object_boxes = boxes(&plan(lens, &board));
    let reach = 8.0 * etendue_core::maths::f64::atan(2.0);
    assert!(close(
        object_boxes[0].amodal.expect("seen").edges_px(),
        [16.0 - reach, 12.0 - reach, 16.0 + reach, 12.0 + reach]
    ));
}

#[test]
fn boxes_in_space_have_the_poses_of_their_objects() {
    let cuboid =
        object("f", "type = \"box\", size_m = [4, 2, 1]", "position_m = [9, 1, 0.5]\nrotation_deg = [30, 0, 0]");
    let object_boxes = boxes(&plan(PINHOLE, &cuboid));
    let solid = object_boxes[0].solid;
    assert!((solid.size_m - DVec3::new(4.0, 2.0, 1.0)).length() < 1e-6);
    assert!((solid.world.centre_m - DVec3::new(9.0, 1.0, 0.5)).length() < 1e-6);
    let ahead = solid.world.rotation * DVec3::X;
    assert!((ahead - DVec3::new(0.75_f64.sqrt(), 0.5, 0.0)).length() < 1e-9, "{ahead}");
    // Camera: x right is −y, y down is −z, z forward is x.
    assert!((solid.camera.centre_m - DVec3::new(-1.0, -0.5, 9.0)).length() < 1e-6);
    let ahead = solid.camera.rotation * DVec3::X;
    assert!((ahead - DVec3::new(-0.5, 0.0, 0.75_f64.sqrt())).length() < 1e-9, "{ahead}");
    assert!((DMat3::from_quat(solid.camera.rotation).determinant() - 1.0).abs() < 1e-12);
}

#[test]
fn boxes_are_those_of_the_rows_times() {
    // 3 m/s to the right at 5 m: 36 px/s. Rows of 2 ms: the last starts 46 ms after the first, 1.7 px later.
    let moving = with_motion(plan(PINHOLE, BOARD), 0, &shifting(DVec3::Y * -3.0));
    let still = CameraPath::constant(pose_of(&moving));
    let shutter = Shutter::Rolling(RowTiming { row_time_s: 2e-3, upwards: false, fields: 1 });
    let object_boxes = boxes_by(&moving, &still, &shutter);
    let amodal = object_boxes[0].amodal.expect("seen").edges_px();
    // At 5 ms + 2 ms (y − 0.5), y = 0 for the upper and 24 for the lower corners.
    let shift = |y: f64| 36.0 * (5e-3 + 2e-3 * (y - 0.5));
    assert!(close(amodal, [4.0 + shift(0.0), 0.0, 28.0 + shift(24.0), 24.0]), "{amodal:?}");
    let middle_s = 0.5 * (0.01 + 23.0 * 2e-3);
    assert!((object_boxes[0].solid.world.centre_m.y + 3.0 * middle_s).abs() < 1e-9);
    let driving = boxes_by(&plan(PINHOLE, BOARD), &path(pose_of(&moving), &shifting(DVec3::Y * 3.0)), &shutter);
    assert!(
        close(driving[0].amodal.expect("seen").edges_px(), amodal),
        "a camera that moves the other way sees the same"
    );
}

#[test]
fn a_windscreen_shifts_boxes_and_a_mirror_has_those_of_pixels() {
    let windscreen = "distance_mm = 100, tilt_deg = 60, radius_across_mm = 3000, radius_upright_mm = 8000";
    let camera = format!("lens = {{ {PINHOLE} }}\nexternal_optics = {{ windscreen = {{ {windscreen} }} }}\n");
    let object_boxes = boxes(&plan_of(&camera, 100.0, BOARD));
    let (amodal, visible) = (object_boxes[0].amodal.expect("seen"), object_boxes[0].visible.expect("seen"));
    // Pixels are whole: their box differs from that of the corners by less than a pixel on every side.
    let differences = amodal.edges_px().into_iter().zip(visible.edges_px()).map(|(a, b)| (a - b).abs());
    assert!(differences.fold(0.0, f64::max) < 1.0 && !object_boxes[0].is_cut, "{amodal:?} {visible:?}");
}

#[test]
fn the_world_has_objects_that_no_camera_sees_with_their_velocities() {
    // Behind the camera, which looks along +x.
    let behind =
        object("behind", "type = \"box\", size_m = [4, 2, 1]", "position_m = [-9, 1, 0.5]\nrotation_deg = [30, 0, 0]");
    let moving = with_motion(plan(PINHOLE, &format!("{BOARD}{behind}")), 1, &shifting(DVec3::new(3.0, -4.0, 0.0)));
    let time_s = 0.25;
    let [board, behind] = &world_objects(&moving, time_s)[..] else { panic!("two objects") };
    assert_eq!((board.moves, board.velocity_m_s, behind.moves), (false, DVec3::ZERO, true));
    assert_eq!((board.id, behind.id, behind.name.as_str()), (1, 2, "behind"));
    assert!((behind.size_m - DVec3::new(4.0, 2.0, 1.0)).length() < 1e-6);
    assert!((behind.velocity_m_s - DVec3::new(3.0, -4.0, 0.0)).length() < 1e-9, "{behind:?}");
    let place = DVec3::new(-9.0, 1.0, 0.5) + time_s * DVec3::new(3.0, -4.0, 0.0);
    assert!((behind.pose.centre_m - place).length() < 1e-6, "{behind:?}");
}
