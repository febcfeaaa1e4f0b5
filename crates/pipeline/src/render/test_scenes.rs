//! Boards before a camera at the origin that looks along +x, for tests of ground truth: 32 × 24 pixels, 60 px of focal length.

use crate::plan::{CameraPlan, RowExposure, Timing};
use crate::{Choices, Plan, compile};
use etendue_core::track::{Interpolation, Key};
use etendue_core::{CameraPath, CameraPose, Epoch, Shutter, Track};
use etendue_scene::asset::Assets;
use etendue_scene::{Description, Overrides};
use etendue_tracer::accel::{World, WorldBuilder};
use etendue_tracer::geometry::Instance;
use glam::{DAffine3, DQuat, DVec3};
use std::path::Path;

/// A lens without distortion.
pub(super) const PINHOLE: &str = "type = \"pinhole\", focal_length_mm = 6, f_number = 2";
/// Focal length over pitch.
pub(super) const FOCAL_PX: f64 = 60.0;
/// A wall across the camera's view, 10 m before it.
pub(super) const WALL: &str = "[[scene.objects]]\nname = \"wall\"\nmaterial = \"grey\"\nshape = { type = \"quad\", size_m = [400, 400] }\n\
                    position_m = [10, 0, 0]\nrotation_deg = [0, 90, 0]\n";
/// A board of 2 m, 5 m before the camera, in the plane x = 5.
pub(super) const BOARD: &str = "[[scene.objects]]\nname = \"board\"\nmaterial = \"grey\"\nshape = { type = \"quad\", size_m = [2, 2] }\n\
                     position_m = [5, 0, 0]\nrotation_deg = [0, 90, 0]\n";

pub(super) fn plan(lens: &str, objects: &str) -> Plan {
    plan_of(&format!("lens = {{ {lens} }}\n"), 100.0, objects)
}

pub(super) fn plan_of(camera: &str, pitch_um: f64, objects: &str) -> Plan {
    let text = format!(
        "format = 1\n[[cameras]]\nname = \"eye\"\nposition_m = [0, 0, 0]\nrotation_deg = [0, 0, 0]\n{camera}\
         sensor = {{ width_px = 32, height_px = 24, pixel_pitch_um = {pitch_um} }}\n\
         [[scene.materials]]\nname = \"grey\"\ntype = \"diffuse\"\nreflectance = 0.5\n{objects}"
    );
    let read = |_: &Path| Ok(text.clone());
    let job = Description::load(Path::new("job.toml"), &read, &Overrides::default()).unwrap_or_else(|f| panic!("{f}"));
    compile(&job, &Assets::default(), &Choices::default()).unwrap_or_else(|f| panic!("{f:?}"))
}

/// The plan with a track for an object's instance from its initial pose.
pub(super) fn with_motion(mut plan: Plan, instance: usize, motion: &Track) -> Plan {
    let mut builder = WorldBuilder::new();
    let meshes: Vec<_> = plan.world.meshes().iter().map(|mesh| builder.add_mesh(mesh.clone())).collect();
    assert!(!meshes.is_empty());
    for (i, placed) in plan.world.instances().iter().enumerate() {
        let still = placed.to_world.as_constant().expect("a still description");
        let to_world = if i == instance { motion.after(&still).into() } else { placed.to_world.clone() };
        builder.add_instance(Instance { to_world, ..placed.clone() });
    }
    let world: World = builder.build().expect("a legal world");
    plan.world = world.into();
    plan
}

/// A straight motion through (time, translation, rotation).
pub(super) fn track(keys: &[(f64, DVec3, DQuat)]) -> Track {
    let key = |(time_s, position_m, rotation): &(f64, DVec3, DQuat)| Key {
        time_s: *time_s,
        position_m: *position_m,
        rotation: *rotation,
        scale: DVec3::ONE,
    };
    Track::new(&keys.iter().map(key).collect::<Vec<_>>(), Interpolation::Linear).expect("a legal track")
}

pub(super) fn shifting(velocity_m_s: DVec3) -> Track {
    track(&[(-10.0, velocity_m_s * -10.0, DQuat::IDENTITY), (10.0, velocity_m_s * 10.0, DQuat::IDENTITY)])
}

/// The camera's path: its pose (x right is −y of the world, y down is −z, z forward is x) moved by a track of the world.
pub(super) fn path(pose: CameraPose, motion: &Track) -> CameraPath {
    CameraPath::moving(motion.after(&DAffine3::from_mat3_translation(pose.rotation, pose.position_m)))
}

pub(super) fn pose_of(plan: &Plan) -> CameraPose {
    plan.cameras[0].path.at(0.0)
}

/// The plan's camera on a path, with frames of 10 ms every 0.1 s, the second at 0 s.
pub(super) fn camera(plan: &Plan, path: &CameraPath, shutter: &Shutter) -> CameraPlan {
    let exposure = RowExposure { shutter: *shutter, ..RowExposure::global(24, 0.01) };
    let timing = Timing { epoch: Epoch::default(), start_s: -0.1, period_s: Some(0.1), jitter: None, exposure };
    CameraPlan { path: path.clone(), timing, ..plan.cameras[0].clone() }
}
