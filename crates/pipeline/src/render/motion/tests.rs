//! Motion compared with closed forms. Flow is stored in 32-bit floats with a relative error of 6e-8; geometry is f64: the tolerance is 1e-5 px.

use super::{MotionTruth, Visibility, disparity, motion_truth};
use crate::Plan;
use crate::plan::{RowExposure, RowSkipping};
use crate::render::frame_view::FrameView;
use crate::render::test_scenes::{
    BOARD, FOCAL_PX, PINHOLE, WALL, camera, path, plan, plan_of, pose_of, shifting, track, with_motion,
};
use etendue_core::{CameraPath, CameraPose, RowTiming, Shutter};
use etendue_tracer::accel::Simd;
use glam::{DMat3, DQuat, DVec2, DVec3};

const TOLERANCE_PX: f32 = 1e-5;

/// Ground truth of the frame at 0 relative to those 0.1 s later and earlier.
fn truth(plan: &Plan, path: &CameraPath, shutter: &Shutter) -> MotionTruth {
    let camera = camera(plan, path, shutter);
    let at = |frame: u32| FrameView { camera: &camera, frame };
    motion_truth(plan, &at(1), &[at(2), at(0)], Simd::Auto)
}

fn centres() -> impl Iterator<Item = DVec2> {
    (0..24 * 32).map(|i| DVec2::new(f64::from(i % 32), f64::from(i / 32)) + 0.5)
}

fn assert_flow(truth: &MotionTruth, neighbour: usize, expected: impl Fn(DVec2) -> DVec2) {
    for (actual, at_px) in truth.neighbours[neighbour].flow.samples().iter().zip(centres()) {
        let expected = expected(at_px).as_vec2().to_array();
        let close = (0..2).all(|i| (actual[i] - expected[i]).abs() <= TOLERANCE_PX * (1.0 + 0.01 * expected[i].abs()));
        assert!(close, "{at_px}: {actual:?} for {expected:?}");
    }
}

fn count_visibility(truth: &MotionTruth, neighbour: usize, visibility: Visibility) -> usize {
    truth.neighbours[neighbour].visibility.samples().iter().filter(|v| **v == visibility as u32).count()
}

#[test]
fn a_camera_that_moves_along_a_wall_sees_it_pass_by_f_v_over_z() {
    let plan = plan(PINHOLE, WALL);
    // 3 m/s to the left (the image moves right) and 1 m/s up (the image moves down).
    let path = path(pose_of(&plan), &shifting(DVec3::new(0.0, 3.0, 1.0)));
    let truth = truth(&plan, &path, &Shutter::Global);
    let velocity = DVec2::new(3.0, 1.0) * FOCAL_PX / 10.0;
    assert_flow(&truth, 0, |_| velocity * 0.1);
    assert_flow(&truth, 1, |_| velocity * -0.1);
    for (actual, world) in truth.motion_vector.samples().iter().zip(truth.velocity.samples()) {
        let close = (0..2).all(|i| (f64::from(actual[i]) - velocity[i]).abs() < 1e-5);
        assert!(close && *world == [0.0; 3], "{actual:?} {world:?}");
    }
    let scene_flow = truth.neighbours[0].scene_flow.samples();
    assert!(scene_flow.iter().all(|v| (DVec3::from(v.map(f64::from)) - DVec3::new(0.3, 0.1, 0.0)).length() < 1e-6));
    // Displacements of 1.8 and 0.6 px leave two columns on the right and one row at the bottom outside.
    assert_eq!(count_visibility(&truth, 0, Visibility::Outside), 24 * 2 + 32 - 2);
    assert_eq!(count_visibility(&truth, 0, Visibility::Seen), 30 * 23);
    assert!(truth.time.samples().iter().all(|t| (*t - 0.005).abs() < 1e-9));
}

#[test]
fn a_camera_that_comes_nearer_sees_everything_go_away_from_the_centre() {
    let plan = plan(PINHOLE, WALL);
    let path = path(pose_of(&plan), &shifting(DVec3::new(20.0, 0.0, 0.0)));
    // At the middle of the exposure the wall is 9.9 m away, 0.1 s later 7.9 m.
    assert_flow(&truth(&plan, &path, &Shutter::Global), 0, |at| (at - DVec2::new(16.0, 12.0)) * (9.9 / 7.9 - 1.0));
}

#[test]
fn a_camera_that_turns_sees_its_homography_and_the_background_as_well() {
    for objects in [WALL, ""] {
        let plan = plan(PINHOLE, objects);
        let axis = DVec3::new(0.2, -0.3, 1.0).normalize();
        let turned = |time_s: f64| DQuat::from_axis_angle(axis, 0.4 * time_s);
        let motion = track(&[(-1.0, DVec3::ZERO, turned(-1.0)), (1.0, DVec3::ZERO, turned(1.0))]);
        let pose = pose_of(&plan);
        let rotation = |time_s: f64| DMat3::from_quat(turned(time_s)) * pose.rotation;
        let k = DMat3::from_cols(DVec3::X * FOCAL_PX, DVec3::Y * FOCAL_PX, DVec3::new(16.0, 12.0, 1.0));
        let homography = k * rotation(0.105).transpose() * rotation(0.005) * k.inverse();
        let image_at = |at: DVec2| {
            let image = homography * at.extend(1.0);
            image.truncate() / image.z
        };
        assert_flow(&truth(&plan, &path(pose, &motion), &Shutter::Global), 0, |at| image_at(at) - at);
    }
}

#[test]
fn a_fisheye_that_turns_about_an_axis_sees_its_own_projection_turn() {
    let lens = "type = \"calibrated\", f_number = 2, projection = { type = \"equidistant\", fx_px = 12 }";
    let plan = plan(lens, "");
    let yaw = |time_s: f64| DQuat::from_rotation_z(-0.5 * time_s);
    let motion = track(&[(-1.0, DVec3::ZERO, yaw(-1.0)), (1.0, DVec3::ZERO, yaw(1.0))]);
    let flow = truth(&plan, &path(pose_of(&plan), &motion), &Shutter::Global).neighbours.remove(0).flow;
    // On the middle row r = f θ: 0.05 rad to the right shift everything 0.6 px to the left, and the row remains straight.
    let flow_at = |x: usize, y: usize| flow.at(x, y);
    let above_and_below: Vec<[f32; 2]> = (4..28).flat_map(|x| [flow_at(x, 11), flow_at(x, 12)]).collect();
    for pair in above_and_below.chunks(2) {
        assert!((pair[0][1] + pair[1][1]).abs() < 1e-5, "mirrored about the middle: {pair:?}");
    }
    let direction = |at: DVec2| {
        let from_centre = (at - DVec2::new(16.0, 12.0)) / 12.0;
        let (sin, cos) = etendue_core::maths::f64::sin_cos(from_centre.length());
        (from_centre.normalize() * sin).extend(cos)
    };
    let back = |d: DVec3| {
        let angle = etendue_core::maths::f64::atan2(d.truncate().length(), d.z);
        d.truncate().normalize() * (12.0 * angle) + DVec2::new(16.0, 12.0)
    };
    let turn = DMat3::from_rotation_y(-0.05);
    for (actual, at) in flow.samples().iter().zip(centres()) {
        let expected = (back(turn * direction(at)) - at).as_vec2().to_array();
        assert!((0..2).all(|i| (actual[i] - expected[i]).abs() < TOLERANCE_PX), "{at}: {actual:?} for {expected:?}");
    }
}

#[test]
fn rolling_rows_see_a_point_when_it_comes_to_them() {
    let plan = plan(PINHOLE, WALL);
    let path = path(pose_of(&plan), &shifting(DVec3::new(0.0, 3.0, 5.0)));
    let velocity = DVec2::new(3.0, 5.0) * FOCAL_PX / 10.0;
    for upwards in [false, true] {
        let row_time_s = 1e-3;
        let shutter = Shutter::Rolling(RowTiming { row_time_s, upwards, fields: 1 });
        let truth = truth(&plan, &path, &shutter);
        // Rows later by Δy rows: Δy = v (T + Δy t_row), with t_row negative from the bottom up.
        let later = |v: f64| 0.1 / (1.0 - v * if upwards { -row_time_s } else { row_time_s });
        assert_flow(&truth, 0, |_| velocity * later(velocity.y));
        let expected = |y: usize| 0.005 + row_time_s * if upwards { 23.0 - y as f64 } else { y as f64 };
        assert!((0..24).all(|y| (f64::from(truth.time.at(3, y)) - expected(y)).abs() < 1e-8));
    }
}

/// One of every three rows is read, so that a row of the sensor takes a third of a row time.
#[test]
fn rows_between_those_that_are_read_take_no_time() {
    let plan = plan(PINHOLE, WALL);
    let path = path(pose_of(&plan), &shifting(DVec3::new(0.0, 3.0, 5.0)));
    let velocity = DVec2::new(3.0, 5.0) * FOCAL_PX / 10.0;
    let shutter = Shutter::Rolling(RowTiming { row_time_s: 1e-3, upwards: false, fields: 1 });
    let mut camera = camera(&plan, &path, &shutter);
    let skipping = RowSkipping { together: 1, pitch: 3 };
    camera.timing.exposure = RowExposure { rows: 8, skipping, ..camera.timing.exposure };
    let at = |frame: u32| FrameView { camera: &camera, frame };
    let truth = motion_truth(&plan, &at(1), &[at(2)], Simd::Auto);
    let expected = (velocity * (0.1 / (1.0 - velocity.y * 1e-3 / 3.0))).as_vec2().to_array();
    for (x, y) in (0..32 * 8).map(|i| (i % 32, 3 * (i / 32))) {
        assert!((f64::from(truth.time.at(x, y)) - 0.005 - 1e-3 * (y / 3) as f64).abs() < 1e-8);
        let actual = truth.neighbours[0].flow.at(x, y);
        assert!((0..2).all(|i| (actual[i] - expected[i]).abs() < TOLERANCE_PX), "{x} {y}: {actual:?} for {expected:?}");
    }
}

#[test]
fn interlaced_rows_follow_their_own_field() {
    let plan = plan(PINHOLE, WALL);
    let path = path(pose_of(&plan), &shifting(DVec3::new(0.0, 3.0, 5.0)));
    let velocity = DVec2::new(3.0, 5.0) * FOCAL_PX / 10.0;
    let shutter = Shutter::Rolling(RowTiming { row_time_s: 1e-3, upwards: false, fields: 2 });
    // Within a field, a row of the image is half a row time.
    assert_flow(&truth(&plan, &path, &shutter), 0, |_| velocity * (0.1 / (1.0 - velocity.y * 0.5e-3)));
}

#[test]
fn what_moves_and_turns_is_followed_in_its_own_frame() {
    let still = CameraPath::constant(pose_of(&plan(PINHOLE, "")));
    let translated = with_motion(plan(PINHOLE, BOARD), 0, &shifting(DVec3::new(0.0, -4.0, 0.0)));
    let motion = truth(&translated, &still, &Shutter::Global);
    for (i, at) in centres().enumerate() {
        // At 5 ms the board has moved by 2 cm to the right; it is 24 px wide.
        let is_board = (at - DVec2::new(16.24, 12.0)).abs().max_element() < 12.0;
        let [flow, vector] = [motion.neighbours[0].flow.samples()[i], motion.motion_vector.samples()[i]];
        let (u, v) = if is_board { (4.8, 48.0) } else { (0.0, 0.0) };
        assert!((flow[0] - u).abs() < TOLERANCE_PX && flow[1].abs() < TOLERANCE_PX, "{at}: {flow:?}");
        assert!((vector[0] - v).abs() < 1e-3 && vector[1].abs() < 1e-3, "{at}: {vector:?}");
        let velocity = motion.velocity.samples()[i];
        assert!(if is_board { (velocity[1] + 4.0).abs() < 1e-5 } else { velocity[1].is_nan() }, "{at}: {velocity:?}");
    }
    // Around the camera's axis: the wheel's own rotation.
    let angle = |time_s: f64| DQuat::from_rotation_x(time_s);
    let spin = track(&[(-1.0, DVec3::ZERO, angle(-1.0)), (1.0, DVec3::ZERO, angle(1.0))]);
    let spun = with_motion(plan(PINHOLE, WALL), 0, &spin);
    let centre = DVec2::new(16.0, 12.0);
    let turn = glam::DMat2::from_angle(0.1);
    let motion = truth(&spun, &still, &Shutter::Global);
    assert_flow(&motion, 0, |at| centre + turn * (at - centre) - at);
    for (vector, at) in motion.motion_vector.samples().iter().zip(centres()) {
        let expected = (at - centre).perp();
        // Differences over 40 µs of a rotation: ω³ h²/6 of the radius, 5e-10, and rounding, 1e-12 px / 4e-5 s.
        assert!((0..2).all(|i| (f64::from(vector[i]) - expected[i]).abs() < 1e-4), "{at}: {vector:?} for {expected}");
    }
}

#[test]
fn what_another_surface_comes_before_is_hidden() {
    let still = CameraPath::constant(pose_of(&plan(PINHOLE, "")));
    let board = with_motion(plan(PINHOLE, &format!("{WALL}{BOARD}")), 1, &shifting(DVec3::new(0.0, -4.0, 0.0)));
    let motion = truth(&board, &still, &Shutter::Global);
    let [forward, backward] = [0, 1].map(|n| motion.neighbours[n].visibility.samples());
    for (i, at) in centres().enumerate() {
        let on_board = |shift_px: f64| (at - DVec2::new(16.24 + shift_px, 12.0)).abs().max_element() < 12.0;
        let expected = |shift_px: f64| {
            let outside = on_board(0.0) && !(0.0..32.0).contains(&(at.x + shift_px));
            match () {
                () if outside => Visibility::Outside,
                () if !on_board(0.0) && on_board(shift_px) => Visibility::Hidden,
                () => Visibility::Seen,
            }
        };
        assert_eq!((forward[i], backward[i]), (expected(4.8) as u32, expected(-4.8) as u32), "{at}");
    }
    // 4.8 px of 24 rows each, and the background behind the board as well.
    assert!(count_visibility(&motion, 0, Visibility::Hidden) >= 4 * 24);
    let alone = with_motion(plan(PINHOLE, BOARD), 0, &shifting(DVec3::new(0.0, -4.0, 0.0)));
    let alone = truth(&alone, &still, &Shutter::Global);
    assert_eq!(count_visibility(&alone, 0, Visibility::Hidden), count_visibility(&motion, 0, Visibility::Hidden));
}

#[test]
fn what_is_behind_the_camera_later_has_no_image() {
    let plan = plan(PINHOLE, BOARD);
    let path = path(pose_of(&plan), &shifting(DVec3::new(60.0, 0.0, 0.0)));
    let motion = truth(&plan, &path, &Shutter::Global);
    let board = motion.velocity.samples().iter().filter(|v| !v[0].is_nan()).count();
    assert_eq!(count_visibility(&motion, 0, Visibility::NoImage), board);
    let none = motion.neighbours[0].flow.samples().iter().filter(|v| v[0].is_nan()).count();
    assert!(none == board && board > 24 * 24, "{none} {board}");
}

/// Cameras of every kind with their pixel pitch, µm.
fn cameras() -> Vec<(String, f64)> {
    let lens = |keys: &str, pitch_um: f64| (format!("lens = {{ {keys} }}\n"), pitch_um);
    let opencv = "type = \"opencv\", fx_px = 60, cx_px = 15, distortion = [-0.2, 0.05, 0.002, -0.001]";
    let distortion = "direction = \"ideal_to_observed\", radius_unit = \"focal_lengths\", k1 = -0.2";
    let windscreen = "distance_mm = 100, tilt_deg = 60, radius_across_mm = 3000, radius_upright_mm = 8000";
    let mirror = "type = \"hyperboloid\", radius_mm = 30, conic = -1.69, rim_radius_mm = 40, metal = \"Al\"";
    let near = "type = \"thin\", focal_length_mm = 5.3, f_number = 5.6, focus_distance_m = 0.115";
    vec![
        lens(PINHOLE, 100.0),
        lens(&format!("{PINHOLE}, distortion = {{ {distortion} }}"), 100.0),
        lens("type = \"thin\", focal_length_mm = 6, f_number = 2, focus_distance_m = 3", 100.0),
        lens(&format!("type = \"calibrated\", f_number = 2, projection = {{ {opencv} }}"), 100.0),
        lens("type = \"telecentric\", f_number = 2, field_width_m = 3", 100.0),
        lens("type = \"prescription\", published = \"double-gauss\", f_number = 2.8, focus_distance_m = 8", 1000.0),
        (format!("lens = {{ {PINHOLE} }}\nexternal_optics = {{ windscreen = {{ {windscreen} }} }}\n"), 100.0),
        (format!("lens = {{ {near} }}\nexternal_optics = {{ mirror = {{ {mirror} }} }}\n"), 150.0),
    ]
}

/// A wall behind the camera, for mirrors.
const BEHIND: &str = "[[scene.objects]]\nname = \"behind\"\nmaterial = \"grey\"\nshape = { type = \"quad\", size_m = [400, 400] }\n\
                      position_m = [-10, 0, 0]\nrotation_deg = [0, 90, 0]\n";

#[test]
fn nothing_moves_where_nothing_moves_whatever_the_lens() {
    for (camera, pitch_um) in cameras() {
        let plan = plan_of(&camera, pitch_um, &format!("{WALL}{BOARD}{BEHIND}"));
        let motion = truth(&plan, &CameraPath::constant(pose_of(&plan)), &Shutter::Global);
        for (flow, visibility) in
            motion.neighbours[0].flow.samples().iter().zip(motion.neighbours[0].visibility.samples())
        {
            let is_still = flow.iter().all(|v| v.abs() < TOLERANCE_PX) && *visibility == Visibility::Seen as u32;
            assert!(
                is_still || (flow[0].is_nan() && *visibility == Visibility::NotKnown as u32),
                "{camera}: {flow:?} {visibility}"
            );
        }
        assert!(count_visibility(&motion, 0, Visibility::Seen) > 300, "{camera}");
    }
}

#[test]
fn the_ray_of_the_place_that_is_found_meets_the_point() {
    for (camera, pitch_um) in cameras() {
        let plan = plan_of(&camera, pitch_um, &format!("{WALL}{BEHIND}"));
        let (body, pose) = (&plan.cameras[0].body, pose_of(&plan));
        let path = path(pose, &shifting(DVec3::new(1.0, 2.0, -1.0)));
        let motion = truth(&plan, &path, &Shutter::Global);
        // Intersection of a pixel's ray at a time with one of the walls, in the closed form of planes.
        let meets = |at_px: DVec2, time_s: f64| {
            let (front, _) = body.truth_ray(at_px)?;
            let pose = path.at(time_s);
            let direction = pose.direction_to_world(front.ray.direction);
            let origin_m = pose.position_m + pose.point_to_render(front.ray.origin_m);
            Some(origin_m + direction * ((10.0_f64.copysign(direction.x) - origin_m.x) / direction.x))
        };
        let mut checked = 0;
        for (flow, at_px) in motion.neighbours[0].flow.samples().iter().zip(centres()) {
            let there_px = at_px + DVec2::new(f64::from(flow[0]), f64::from(flow[1]));
            let Some((here, there)) = meets(at_px, 0.005).zip(meets(there_px, 0.105)) else { continue };
            // Outside the walls, or beyond the mirror's edge, where an image ends.
            if here.y.abs().max(here.z.abs()) > 200.0 || flow[0].is_nan() {
                continue;
            }
            // 1e-6 px of rounded flow, at the distance of the pixel's point.
            let pixel_m =
                meets(at_px + DVec2::X, 0.005).map_or(f64::INFINITY, |neighbour_m| (neighbour_m - here).length());
            assert!((here - there).length() < 1e-6 + 1e-5 * pixel_m, "{camera} {at_px}: {here} {there}");
            checked += 1;
        }
        assert!(checked > 300, "{camera}: {checked}");
    }
}

#[test]
fn a_telecentric_camera_sees_shifts_and_no_distance() {
    let plan = plan("type = \"telecentric\", f_number = 2, field_width_m = 3.2", &format!("{WALL}{BOARD}"));
    let path = path(pose_of(&plan), &shifting(DVec3::new(7.0, 1.0, -2.0)));
    // 0.1 m per pixel; 0.1 m left and 0.2 m down in 0.1 s.
    assert_flow(&truth(&plan, &path, &Shutter::Global), 0, |_| DVec2::new(1.0, -2.0));
}

#[test]
fn disparity_is_base_times_focal_length_over_depth() {
    let plan = plan(PINHOLE, &format!("{WALL}{BOARD}"));
    let pose = pose_of(&plan);
    let at = |y_m: f64| CameraPath::constant(CameraPose { position_m: DVec3::Y * y_m, ..pose });
    let [left, right] = [0.0, -0.25].map(|y_m| camera(&plan, &at(y_m), &Shutter::Global));
    let [left, right] = [&left, &right].map(|camera| FrameView { camera, frame: 0 });
    let (actual, visibility) = disparity(&plan, &left, &right, Simd::Auto);
    for (i, at) in centres().enumerate() {
        let is_board = (at - DVec2::new(16.0, 12.0)).abs().max_element() < 12.0;
        let expected = 0.25 * FOCAL_PX / if is_board { 5.0 } else { 10.0 };
        assert!((f64::from(actual.samples()[i]) - expected).abs() < 1e-6, "{at}");
    }
    assert!(visibility.samples().contains(&(Visibility::Hidden as u32)));
}
