//! Where the cameras of a job stand and how they project, in the files of other programs: ROS, Kalibr, COLMAP.
//!
//! | file, in the folder `calibration` | holds |
//! | --- | --- |
//! | `ros/NAME.yaml` | `camera_info` of a camera |
//! | `ros/static_transforms.yaml` | from each camera's optical frame to the frame that carries it |
//! | `kalibr/camchain-NAME.yaml` | the cameras that one frame carries, beginning with NAME |
//! | `colmap/cameras.txt`, `images.txt`, `points3D.txt` | all cameras, and the pose of every frame in the world |

mod intrinsics;
mod view;

pub use view::{PinholeView, camera_mount, pinhole_view};

use crate::result_files::Files;
use etendue_core::CameraPose;
use etendue_core::observer::{Message, Observer};
use etendue_io::OutputFolder;
use etendue_io::calibration::export::{NamedCamera, colmap, kalibr, ros};
use etendue_io::failure::Error;
use etendue_pipeline::plan::{CameraPlan, Plan, TimeDependence};
use etendue_projection::Calibration;
use std::ops::Range;

/// What carries a camera that no frame does.
const WORLD: &str = "world";

/// Files of a rig, and what they leave out.
#[derive(Clone, Debug, Default)]
pub(crate) struct RigFiles {
    /// Names within the output folder, with their text.
    pub(crate) files: Vec<(String, String)>,
    /// A sentence for each camera that a format cannot say.
    pub(crate) left_out: Vec<String>,
}

/// A camera that has a calibration.
struct Calibrated<'a> {
    plan: &'a CameraPlan,
    calibration: Calibration,
}

impl Calibrated<'_> {
    fn named(&self) -> NamedCamera<'_> {
        NamedCamera { name: &self.plan.name, calibration: &self.calibration }
    }
}

/// The files of the cameras of a plan that ask for them, over frames; none where no camera does.
pub(crate) fn asked_files(plan: &Plan, frames: &Range<u32>) -> RigFiles {
    let cameras: Vec<&CameraPlan> = plan.cameras.iter().filter(|c| c.products.calibration_files).collect();
    if cameras.is_empty() { RigFiles::default() } else { rig_files(plan, &cameras, frames) }
}

/// The files of all cameras of a plan, over frames.
pub(crate) fn all_files(plan: &Plan, frames: &Range<u32>) -> RigFiles {
    rig_files(plan, &plan.cameras.iter().collect::<Vec<_>>(), frames)
}

/// Writes files, and tells what they leave out.
pub(crate) fn write(rig: &RigFiles, folder: &mut OutputFolder, observer: &dyn Observer) -> Result<(), Error> {
    rig.left_out.iter().for_each(|told| observer.message(Message::Warning(told)));
    rig.files.iter().try_for_each(|(name, text)| folder.write(name, text.as_bytes()).map_err(Error::run))
}

/// The files of some cameras of a plan.
fn rig_files(plan: &Plan, cameras: &[&CameraPlan], frames: &Range<u32>) -> RigFiles {
    let mut rig = RigFiles::default();
    let mut found = Vec::new();
    for camera in cameras {
        match intrinsics::calibration(&camera.body) {
            Ok(calibration) => found.push(Calibrated { plan: camera, calibration }),
            Err(why) => rig.left_out.push(format!("calibration files leave camera {} out: {why}", camera.name)),
        }
    }
    let none = rig.left_out.clone();
    add_ros(plan, cameras, &found, &mut rig);
    add_kalibr(&found, &none, &mut rig);
    add_colmap(&found, &none, frames, &mut rig);
    rig
}

fn add(rig: &mut RigFiles, name: &str, text: String) {
    rig.files.push((format!("calibration/{name}"), text));
}

/// Notes why a format leaves a camera out; answers with the sentence.
fn leave_out(rig: &mut RigFiles, camera: &str, why: &str) -> String {
    let told = format!("camera {camera}: {why}");
    rig.left_out.push(format!("calibration files: {told}"));
    told
}

fn add_ros(plan: &Plan, cameras: &[&CameraPlan], found: &[Calibrated<'_>], rig: &mut RigFiles) {
    for camera in found {
        match ros::camera_info(&camera.named(), base_m(plan, camera.plan)) {
            Ok(text) => add(rig, &format!("ros/{}.yaml", camera.plan.name), text),
            Err(why) => drop(leave_out(rig, &camera.plan.name, &why)),
        }
    }
    let (mut transforms, mut left_out) = (Vec::new(), Vec::new());
    for camera in cameras {
        let parent = camera.mount.frame.as_deref().unwrap_or(WORLD);
        let child = ros::optical_frame(&camera.name);
        match camera.mount.pose {
            Some(pose) => transforms.push(ros::StaticTransform { parent, child, pose }),
            None => left_out.push(leave_out(rig, &camera.name, &moves(parent))),
        }
    }
    add(rig, "ros/static_transforms.yaml", ros::static_transforms(&transforms, &left_out));
}

/// Why a camera has no fixed place.
fn moves(parent: &str) -> String {
    format!("it moves in \"{parent}\", so that no fixed transform holds it; let a frame carry it")
}

/// How far to the right of a rectified pair's left camera it stands, m; 0 where it is no right camera, or one that does not keep its distance.
fn base_m(plan: &Plan, camera: &CameraPlan) -> f64 {
    let is_left = |left: &&CameraPlan| left.products.annotations.disparity.is_some_and(|d| d.right == camera.index);
    plan.cameras.iter().find(is_left).map_or(0.0, |left| {
        // In their own frame, if they share one: without the rounding of a far origin.
        if let Some([from, to]) = left.fixed_pair(camera) {
            return from.point_to_camera(to.position_m).x;
        }
        let at = |time_s: f64| left.path.at(time_s).point_to_camera(camera.path.at(time_s).position_m).x;
        let bases_m: Vec<f64> = left.times_beside_s(camera).into_iter().map(at).collect();
        let is_kept = bases_m.iter().all(|base_m| (base_m - bases_m[0]).abs() <= 1e-9 * bases_m[0].abs());
        if is_kept { bases_m[0] } else { 0.0 }
    })
}

fn add_kalibr(found: &[Calibrated<'_>], none: &[String], rig: &mut RigFiles) {
    let mut frames: Vec<Option<&str>> = Vec::new();
    for frame in found.iter().map(|camera| camera.plan.mount.frame.as_deref()) {
        if !frames.contains(&frame) {
            frames.push(frame);
        }
    }
    for frame in frames {
        let (mut links, mut left_out) = (Vec::new(), none.to_vec());
        for camera in found.iter().filter(|camera| camera.plan.mount.frame.as_deref() == frame) {
            match (camera.plan.mount.pose, kalibr::intrinsics(&camera.named())) {
                (Some(pose), Ok(intrinsics)) => links.push(kalibr::Link { camera: camera.named(), intrinsics, pose }),
                (None, _) => left_out.push(format!("camera {}: {}", camera.plan.name, moves(frame.unwrap_or(WORLD)))),
                (_, Err(why)) => left_out.push(leave_out(rig, &camera.plan.name, &why)),
            }
        }
        if let Some(first) = links.first() {
            let name = format!("kalibr/camchain-{}.yaml", first.camera.name);
            add(rig, &name, kalibr::camchain(frame, &links, &left_out));
        }
    }
}

fn add_colmap(found: &[Calibrated<'_>], none: &[String], frames: &Range<u32>, rig: &mut RigFiles) {
    let (mut lines, mut images, mut left_out) = (Vec::new(), Vec::new(), none.to_vec());
    for camera in found {
        match colmap::camera(&camera.named()) {
            Ok(line) => {
                lines.push(line);
                let of_camera = frames.clone().map(|frame| colmap::Image {
                    camera: lines.len(),
                    pose: pose(camera.plan, frame),
                    file: picture(camera.plan, frame),
                });
                images.extend(of_camera);
            }
            Err(why) => left_out.push(leave_out(rig, &camera.plan.name, &why)),
        }
    }
    add(rig, "colmap/cameras.txt", colmap::cameras(&lines, &left_out));
    add(rig, "colmap/images.txt", colmap::images(&images));
    add(rig, "colmap/points3D.txt", colmap::NO_POINTS.to_owned());
}

/// Half-way through the frame's first exposure, as the side-car states it.
pub(crate) fn pose(camera: &CameraPlan, frame: u32) -> CameraPose {
    let frame = if camera.time == TimeDependence::None { 0 } else { frame };
    camera.path.at(camera.timing.capture(frame, 0).middle_s())
}

/// The file of a frame's picture: developed, or raw where none is.
fn picture(camera: &CameraPlan, frame: u32) -> String {
    let products = &camera.products;
    let file = match products.raw && !products.picture {
        true => Files::raw(frame, products.raw_format),
        false => Files::picture(frame, camera.body.picture_format()),
    };
    format!("{}/{file}", camera.name)
}
