//! Compiled motion: positions compared with closed forms, files with keys, and errors that only compilation finds.

use super::{Choices, compile};
use crate::Plan;
use core::f64::consts::FRAC_PI_2;
use etendue_core::maths::f64::sin_cos;
use etendue_core::{Motion, TimeInterval};
use etendue_scene::asset::{Assets, TrajectoryAsset, TrajectoryRow};
use etendue_scene::record::transform::yaw_pitch_roll_quaternion;
use etendue_scene::{Description, Overrides};
use glam::{DMat3, DVec3};
use std::path::Path;

const HEAD: &str = r#"format = 1
[[cameras]]
name = "front"
lens = { type = "pinhole", focal_length_mm = 6, f_number = 2.0 }
sensor = { width_px = 8, height_px = 6, pixel_pitch_um = 6.0 }
"#;
const STILL: &str = "position_m = [0, 0, 1]\nlook_at_m = [10, 0, 1]\n";
const PAINT: &str = "[[scene.materials]]\nname = \"paint\"\ntype = \"diffuse\"\nreflectance = 0.5\n";
/// At 15 m/s straight ahead, then stationary.
const CAR: &str =
    "[[scene.frames]]\nname = \"car\"\nkeys = [{ time_s = 0 }, { time_s = 2, position_m = [30, 0, 0] }]\n";

/// Plan of a job with a trajectory "drive.csv", or its errors, one per line.
fn plan(camera: &str, scene: &str, rows: &[TrajectoryRow]) -> Result<Plan, String> {
    let text = format!("{HEAD}{camera}{PAINT}{scene}");
    let read = |_: &Path| Ok(text.clone());
    let job = Description::load(Path::new("job.toml"), &read, &Overrides::default()).map_err(|f| f.to_string())?;
    let asset = TrajectoryAsset { rows: rows.to_vec(), unread: vec!["speed".to_owned()], hash: [7; 32] };
    let assets = Assets { trajectories: [("drive.csv".into(), asset)].into(), ..Assets::default() };
    let errors = |list: Vec<etendue_scene::DescriptionError>| list.iter().map(|f| format!("{f}\n")).collect::<String>();
    compile(&job, &assets, &Choices::default()).map_err(errors)
}

/// A ball with these keys.
fn ball(keys: &str) -> String {
    format!(
        "[[scene.objects]]\nname = \"ball\"\nmaterial = \"paint\"\nshape = {{ type = \"sphere\", radius_m = 1 }}\n{keys}\n"
    )
}

fn motion(plan: &Plan) -> &Motion {
    &plan.world.instances()[0].to_world
}

fn rows() -> Vec<TrajectoryRow> {
    let row = |time_s: f64, x: f64, yaw_deg: f64| TrajectoryRow {
        time: time_s.into(),
        position_m: DVec3::new(x, 0.5 * x, 0.25),
        rotation: yaw_pitch_roll_quaternion([yaw_deg, 5.0, -3.0]),
    };
    vec![row(100.0, 0.0, 10.0), row(101.0, 4.0, 20.0), row(103.0, 9.0, 60.0)]
}

const KEYS: &str = "keys = [{ time_s = 0, position_m = [0, 0, 0.25], rotation_deg = [10, 5, -3] }, \
                    { time_s = 1, position_m = [4, 2, 0.25], rotation_deg = [20, 5, -3] }, \
                    { time_s = 3, position_m = [9, 4.5, 0.25], rotation_deg = [60, 5, -3] }]";

/// A point of the tread: the hub moves at 15 m/s, the wheel rotates by its distance over its radius, within its scale.
#[test]
fn a_wheel_on_a_car_rolls() {
    let r = 0.3;
    let keys =
        format!("frame = \"car\"\nposition_m = [1.4, 0.8, {r}]\nscale = [{r}, 0.1, {r}]\nrolls = {{ radius_m = {r} }}");
    let plan = plan(STILL, &format!("{CAR}{}", ball(&keys)), &[]).expect("no fault");
    for i in 0..=60_u8 {
        let time_s = 0.05 * f64::from(i);
        let distance_m = 15.0 * time_s.min(2.0);
        let (sin, cos) = sin_cos(distance_m / r);
        let expected = DVec3::new(distance_m + 1.4 + r * sin, 0.9, r + r * cos);
        let actual = motion(&plan).at(time_s).transform_point3(DVec3::new(0.0, 1.0, 1.0));
        assert!((actual - expected).length() < 1e-12, "{time_s} {actual} {expected}");
    }
    let standing = TimeInterval::new(2.0, 9.0).expect("in order");
    assert!(motion(&plan).constant_over(standing).is_some(), "it holds still after the last key");
    assert_eq!(plan.cameras[0].time, crate::plan::TimeDependence::Motion);
}

#[test]
fn a_trajectory_is_its_keys() {
    for interpolation in ["", "interpolation = \"linear\"\n", "interpolation = \"smooth\"\n"] {
        let keyed = plan(STILL, &ball(&format!("{interpolation}{KEYS}")), &[]).expect("no fault");
        let file = format!("{interpolation}trajectory = {{ file = \"drive.csv\", time_offset_s = -100 }}");
        let driven = plan(STILL, &ball(&file), &rows()).expect("no fault");
        assert_eq!(motion(&keyed), motion(&driven));
        assert!(driven.notes.iter().any(|note| note.text == "not read: speed"), "{:?}", driven.notes);
        let framed = format!("[[scene.frames]]\nname = \"rig\"\n{file}\n{}", ball("frame = \"rig\""));
        assert_eq!(motion(&keyed), motion(&plan(STILL, &framed, &rows()).expect("no fault")));
    }
    let [linear, smooth] = ["linear", "smooth"].map(|how| {
        let keys = format!("interpolation = \"{how}\"\n{KEYS}");
        motion(&plan(STILL, &ball(&keys), &[]).expect("no fault")).at(0.5).translation
    });
    assert!((linear - DVec3::new(2.0, 1.0, 0.25)).length() < 1e-15 && (smooth - linear).length() > 0.01);
}

/// Frames in frames, instances in their own frames, and stationary objects in stationary frames, bit for bit.
#[test]
fn frames_carry_what_is_placed_in_them() {
    let scene = format!(
        "{CAR}[[scene.frames]]\nname = \"arm\"\nparent = \"car\"\nposition_m = [0, 2, 0]\nrotation_deg = [90, 0, 0]\n{}",
        ball("frame = \"arm\"\ninstances = [{ position_m = [1, 0, 0] }, { position_m = [1, 0, 0], frame = \"car\" }]")
    );
    let framed = plan(STILL, &scene, &[]).expect("no fault");
    let [in_arm, in_car] = [0, 1].map(|i| framed.world.instances()[i].to_world.at(1.0).translation);
    assert!((in_arm - DVec3::new(15.0, 3.0, 0.0)).length() < 1e-12, "{in_arm}");
    assert!((in_car - DVec3::new(16.0, 0.0, 0.0)).length() < 1e-12, "{in_car}");
    let still = "[[scene.frames]]\nname = \"room\"\nposition_m = [3, 2, 0.1]\n";
    let room =
        plan(STILL, &format!("{still}{}", ball("frame = \"room\"\nposition_m = [0.5, 0, 0]")), &[]).expect("no fault");
    assert_eq!(motion(&room).as_constant().map(|at| at.translation), Some(DVec3::new(3.5, 2.0, 0.1)));
    assert_eq!(room.cameras[0].time, crate::plan::TimeDependence::None);
}

/// A low beam on a car and its camera: both move with it; a lamp with keys rotates between its aims.
#[test]
fn lamps_and_cameras_move() {
    let lamp = "[[scene.lights]]\nname = \"lamp\"\ntype = \"spot\"\nfield_angle_deg = 60\nintensity_cd = 100\nilluminant = \"LED-B3\"\n";
    let camera = "frame = \"car\"\nposition_m = [1, 0, 1.2]\nrotation_deg = [0, 0, 0]\n";
    let opening = "opening = { shape = \"disc\", radius_m = 0.05 }\nframe = \"car\"\nposition_m = [2, 0.5, 0.6]\n";
    let framed = plan(camera, &format!("{CAR}{lamp}{opening}"), &[]).expect("no fault");
    let pose = framed.cameras[0].path.at(1.0);
    assert!((pose.position_m - DVec3::new(16.0, 0.0, 1.2)).length() < 1e-12, "{pose:?}");
    assert!((pose.rotation.z_axis - DVec3::X).length() < 1e-12);
    let at = framed.sources.lamps[0].to_world().at(1.0).translation;
    assert!((at - DVec3::new(17.0, 0.5, 0.6)).length() < 1e-12, "{at}");
    let glass = framed.world.instances()[0].to_world.at(1.0).translation;
    assert!((glass - at).length() < 1e-12, "the opening goes with its lamp: {glass}");
    let keys = "keys = [{ time_s = 0, position_m = [0, 0, 5], target_m = [1, 0, 5] }, \
                { time_s = 1, position_m = [0, 0, 5], target_m = [0, 1, 5] }]\n";
    let turning = plan(STILL, &format!("{lamp}{keys}"), &[]).expect("no fault");
    let half = turning.sources.lamps[0].to_world().at(0.5).matrix3.x_axis;
    let (sin, cos) = sin_cos(0.5 * FRAC_PI_2);
    assert!((half - DVec3::new(cos, sin, 0.0)).length() < 1e-15, "{half}");
    assert_eq!(turning.cameras[0].time, crate::plan::TimeDependence::Motion, "a lamp that moves changes the light");
    // A camera that rotates in place, by keys and by a file of a body that looks along +x.
    let keys = "keys = [{ time_s = 0, position_m = [0, 0, 1], look_at_m = [1, 0, 1] }, \
                { time_s = 1, position_m = [2, 0, 1], look_at_m = [2, 1, 1] }]\n";
    let driven = "trajectory = { file = \"drive.csv\" }\n";
    let row = |time_s: f64| TrajectoryRow {
        time: time_s.into(),
        position_m: DVec3::new(2.0 * time_s, 0.0, 1.0),
        rotation: yaw_pitch_roll_quaternion([90.0 * time_s, 0.0, 0.0]),
    };
    for camera in [keys, driven] {
        let pose = plan(camera, "", &[row(0.0), row(1.0)]).expect("no fault").cameras[0].path.at(0.5);
        let axes = DMat3::from_cols(DVec3::new(sin, -cos, 0.0), DVec3::NEG_Z, DVec3::new(cos, sin, 0.0));
        let off = (pose.rotation - axes).to_cols_array().map(f64::abs).into_iter().fold(0.0, f64::max);
        assert!(off < 1e-14 && (pose.position_m - DVec3::new(1.0, 0.0, 1.0)).length() < 1e-14, "{camera} {pose:?}");
    }
}

/// The last example of docs/motion.md: the wheels rotate by the distance that the car travels, the camera and the lamps move with it.
#[test]
fn the_example_of_the_page_moves() {
    let page = include_str!("../../../../docs/motion.md");
    let example = page.rsplit("```toml\n").next().and_then(|rest| rest.split("```").next()).expect("an example");
    let read = |_: &Path| Ok(example.to_owned());
    let job = Description::load(Path::new("job.toml"), &read, &Overrides::default()).expect("no fault");
    let plan = compile(&job, &Assets::default(), &Choices::default()).expect("no fault");
    let displacement = |motion: &Motion| motion.at(1.0).translation - motion.at(0.0).translation;
    let instances = plan.world.instances();
    assert_eq!(instances.iter().filter(|instance| instance.to_world.as_constant().is_some()).count(), 1, "the ground");
    assert!(instances[..5].iter().all(|instance| (displacement(&instance.to_world).x - 12.0).abs() < 0.3));
    assert!(plan.sources.lamps.iter().all(|lamp| (displacement(lamp.to_world()).x - 12.0).abs() < 0.3));
    let [front, roadside] = [0, 1].map(|i| &plan.cameras[i].path);
    assert!(!front.is_stationary() && roadside.is_stationary());
    // Each wheel's distance in small steps along the body's x axis, with an error of h²/24 of the second derivative: below 1e-5 m.
    for wheel in &instances[1..5] {
        let step = |i: u32| {
            let [from, middle, to] = [0.0, 0.5, 1.0].map(|part| 0.001 * (f64::from(i) + part));
            let forward = instances[0].to_world.at(middle).matrix3.x_axis;
            (wheel.to_world.at(to).translation - wheel.to_world.at(from).translation).dot(forward)
        };
        let angle = (0..1000).map(step).sum::<f64>() / 0.32;
        let (sin, cos) = sin_cos(angle);
        let body = instances[0].to_world.at(1.0).matrix3;
        let off = body.transpose() * wheel.to_world.at(1.0).matrix3.x_axis - DVec3::new(cos, 0.0, -sin);
        assert!(angle > 35.0 && off.length() < 1e-4, "{angle} {off}");
    }
}

#[test]
fn what_cannot_move_is_refused() {
    let error = |scene: &str| plan(STILL, scene, &rows()).expect_err("a fault");
    let parked = error(&ball("position_m = [5, 0, 1]\nrolls = { radius_m = 0.3 }"));
    assert!(
        parked.contains("scene.objects.ball.rolls: \"rolls\" has no effect: the wheel does not move; give the wheel")
    );
    let missing = error(&ball("trajectory = { file = \"other.csv\" }"));
    assert!(missing.contains("the trajectory was not loaded"), "{missing}");
    let lamp = "[[scene.materials]]\nname = \"glow\"\ntype = \"emitter\"\nemission = { luminous_flux_lm = 100, illuminant = \"D65\" }\n";
    let growing = |scale: f64| {
        let keys = format!("keys = [{{ time_s = 0 }}, {{ time_s = 1, position_m = [5, 0, 0], scale = {scale} }}]");
        format!("{lamp}{}", ball(&keys)).replace("\"paint\"\nshape", "\"glow\"\nshape")
    };
    assert!(error(&growing(2.0)).contains("the scale of this surface changes over time"));
    assert!(plan(STILL, &growing(1.0), &[]).is_ok(), "rigid motion keeps the area");
    let flat = "keys = [{ time_s = 0, scale = [1, 1, 1] }, { time_s = 1, scale = [0.1, 1, 1] }, { time_s = 2, scale = [3, 1, 1] }]";
    let smooth = error(&ball(&format!("interpolation = \"smooth\"\n{flat}")));
    assert!(smooth.contains("is 0 at some time of its motion"), "{smooth}");
    let idle = plan(STILL, &format!("{CAR}{}", ball("position_m = [5, 0, 1]")), &[]).expect("no fault");
    assert!(
        idle.notes.iter().any(|r| r.text == "not read: frame to which nothing is attached: car"),
        "{:?}",
        idle.notes
    );
}

/// A world's unit must suffice along the camera's whole path.
#[test]
fn reach_is_checked_along_the_whole_way() {
    let keys = |x: f64| {
        format!(
            "keys = [{{ time_s = 0, position_m = [-9, 0, 1], look_at_m = [0, 0, 1] }}, \
             {{ time_s = 1, position_m = [{x:e}, 0, 1], look_at_m = [0, 0, 1] }}]\n"
        )
    };
    let small = "[[scene.objects]]\nname = \"mote\"\nmaterial = \"paint\"\nshape = { type = \"quad\", size_m = [1, 1] }\nscale = 1e-6\n";
    assert!(plan(&keys(-90.0), small, &[]).is_ok());
    let error = plan(&keys(-1e7), small, &[]).expect_err("a fault");
    assert!(
        error.contains("cameras.front.keys[0]: rays may start 1") && error.contains("at most 1e12 can be traced"),
        "{error}"
    );
}
