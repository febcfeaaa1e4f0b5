//! Poses and projections of a job's cameras, in the formats of other programs: ROS, Kalibr, COLMAP.
//!
//! | file, in the folder `calibration` | holds |
//! | --- | --- |
//! | `ros/NAME.yaml` | `camera_info` of a camera |
//! | `ros/static_transforms.yaml` | from each camera's optical frame to the frame that carries it |
//! | `kalibr/camchain-NAME.yaml` | the cameras that one frame carries, beginning with NAME |
//! | `colmap/cameras.txt`, `images.txt`, `points3D.txt` | all cameras, and the pose of every frame in the world |

use crate::result_files::ResultFiles;
use etendue_core::CameraPose;
use etendue_core::observer::{Message, Observer};
use etendue_io::OutputFolder;
use etendue_io::calibration::export::{NamedCamera, colmap, kalibr, ros};
use etendue_io::failure::Error;
use etendue_optics::{Front, Lens};
use etendue_pipeline::plan::{CameraBody, CameraPlan, Plan, TimeDependence};
use etendue_projection::model::Perspective;
use etendue_projection::plane::DistortionTerms;
use etendue_projection::{Calibration, CameraMatrix, DistortionDirection, Model};
use glam::DVec2;
use std::ops::Range;

/// Parent frame of a camera that no frame carries.
const WORLD: &str = "world";

/// Files of a rig, and the cameras that they omit.
#[derive(Clone, Debug, Default)]
pub(crate) struct RigFiles {
    /// Names within the output folder, with the text of each file.
    pub(crate) files: Vec<(String, String)>,
    /// One sentence for each camera that a format cannot describe.
    pub(crate) omitted: Vec<String>,
}

/// A camera that has a calibration.
struct CalibratedCamera<'a> {
    plan: &'a CameraPlan,
    calibration: Calibration,
}

impl CalibratedCamera<'_> {
    fn named(&self) -> NamedCamera<'_> {
        NamedCamera { name: &self.plan.name, calibration: &self.calibration }
    }
}

/// Files of the cameras of a plan that request them, over frames; empty if no camera does.
pub(crate) fn requested_files(plan: &Plan, frames: &Range<u32>) -> RigFiles {
    let cameras: Vec<&CameraPlan> = plan.cameras.iter().filter(|c| c.products.calibration_files).collect();
    if cameras.is_empty() { RigFiles::default() } else { rig_files(plan, &cameras, frames) }
}

/// The files of all cameras of a plan, over frames.
pub(crate) fn all_files(plan: &Plan, frames: &Range<u32>) -> RigFiles {
    rig_files(plan, &plan.cameras.iter().collect::<Vec<_>>(), frames)
}

/// Writes the files, and reports the omitted cameras.
pub(crate) fn write(rig: &RigFiles, folder: &mut OutputFolder, observer: &dyn Observer) -> Result<(), Error> {
    rig.omitted.iter().for_each(|warning| observer.message(Message::Warning(warning)));
    rig.files.iter().try_for_each(|(name, text)| folder.write(name, text.as_bytes()).map_err(Error::run))
}

/// The files of some cameras of a plan.
fn rig_files(plan: &Plan, cameras: &[&CameraPlan], frames: &Range<u32>) -> RigFiles {
    let mut rig = RigFiles::default();
    let mut calibrated = Vec::new();
    for camera in cameras {
        match calibration(&camera.body) {
            Ok(calibration) => calibrated.push(CalibratedCamera { plan: camera, calibration }),
            Err(why) => rig.omitted.push(format!("calibration files omit camera {}: {why}", camera.name)),
        }
    }
    let none = rig.omitted.clone();
    add_ros(plan, cameras, &calibrated, &mut rig);
    add_kalibr(&calibrated, &none, &mut rig);
    add_colmap(&calibrated, &none, frames, &mut rig);
    rig
}

fn add(rig: &mut RigFiles, name: &str, text: String) {
    rig.files.push((format!("calibration/{name}"), text));
}

/// Records the reason for which a format omits a camera; returns the sentence.
fn omit(rig: &mut RigFiles, camera: &str, why: &str) -> String {
    let message = format!("camera {camera}: {why}");
    rig.omitted.push(format!("calibration files: {message}"));
    message
}

fn add_ros(plan: &Plan, cameras: &[&CameraPlan], calibrated: &[CalibratedCamera<'_>], rig: &mut RigFiles) {
    for camera in calibrated {
        match ros::camera_info(&camera.named(), base_m(plan, camera.plan)) {
            Ok(text) => add(rig, &format!("ros/{}.yaml", camera.plan.name), text),
            Err(why) => drop(omit(rig, &camera.plan.name, &why)),
        }
    }
    let (mut transforms, mut left_out) = (Vec::new(), Vec::new());
    for camera in cameras {
        let parent = camera.mount.frame.as_deref().unwrap_or(WORLD);
        let child = ros::optical_frame(&camera.name);
        match camera.mount.pose {
            Some(pose) => transforms.push(ros::StaticTransform { parent, child, pose }),
            None => left_out.push(omit(rig, &camera.name, &moving_reason(parent))),
        }
    }
    add(rig, "ros/static_transforms.yaml", ros::static_transforms(&transforms, &left_out));
}

/// Reason for which a camera has no fixed pose.
fn moving_reason(parent: &str) -> String {
    format!("it moves in \"{parent}\", so no fixed transform describes it; attach it to a frame")
}

/// Baseline: distance of the right camera of a rectified pair to the right of the left one, m; 0 if the camera is no right camera or its distance varies.
fn base_m(plan: &Plan, camera: &CameraPlan) -> f64 {
    let is_left = |left: &&CameraPlan| left.products.annotations.disparity.is_some_and(|d| d.right == camera.index);
    plan.cameras.iter().find(is_left).map_or(0.0, |left| {
        // Computed in their common frame, if any, to avoid the rounding of a far origin.
        if let Some([from, to]) = left.fixed_pair(camera) {
            return from.point_to_camera(to.position_m).x;
        }
        let at = |time_s: f64| left.path.at(time_s).point_to_camera(camera.path.at(time_s).position_m).x;
        let bases_m: Vec<f64> = left.comparison_times_s(camera).into_iter().map(at).collect();
        let is_equal = bases_m.iter().all(|base_m| (base_m - bases_m[0]).abs() <= 1e-9 * bases_m[0].abs());
        if is_equal { bases_m[0] } else { 0.0 }
    })
}

fn add_kalibr(calibrated: &[CalibratedCamera<'_>], none: &[String], rig: &mut RigFiles) {
    let mut frames: Vec<Option<&str>> = Vec::new();
    for frame in calibrated.iter().map(|camera| camera.plan.mount.frame.as_deref()) {
        if !frames.contains(&frame) {
            frames.push(frame);
        }
    }
    for frame in frames {
        let (mut links, mut left_out) = (Vec::new(), none.to_vec());
        for camera in calibrated.iter().filter(|camera| camera.plan.mount.frame.as_deref() == frame) {
            match (camera.plan.mount.pose, kalibr::intrinsics(&camera.named())) {
                (Some(pose), Ok(intrinsics)) => {
                    links.push(kalibr::ChainLink { camera: camera.named(), intrinsics, pose });
                }
                (None, _) => {
                    left_out.push(format!("camera {}: {}", camera.plan.name, moving_reason(frame.unwrap_or(WORLD))));
                }
                (_, Err(why)) => left_out.push(omit(rig, &camera.plan.name, &why)),
            }
        }
        if let Some(first) = links.first() {
            let name = format!("kalibr/camchain-{}.yaml", first.camera.name);
            add(rig, &name, kalibr::camchain(frame, &links, &left_out));
        }
    }
}

fn add_colmap(calibrated: &[CalibratedCamera<'_>], none: &[String], frames: &Range<u32>, rig: &mut RigFiles) {
    let (mut lines, mut images, mut left_out) = (Vec::new(), Vec::new(), none.to_vec());
    for camera in calibrated {
        match colmap::camera(&camera.named()) {
            Ok(line) => {
                lines.push(line);
                let of_camera = frames.clone().map(|frame| colmap::ColmapImage {
                    camera: lines.len(),
                    pose: pose(camera.plan, frame),
                    file: picture(camera.plan, frame),
                });
                images.extend(of_camera);
            }
            Err(why) => left_out.push(omit(rig, &camera.plan.name, &why)),
        }
    }
    add(rig, "colmap/cameras.txt", colmap::cameras(&lines, &left_out));
    add(rig, "colmap/images.txt", colmap::images(&images));
    add(rig, "colmap/points3D.txt", colmap::NO_POINTS.to_owned());
}

/// Pose at the middle of the frame's first exposure, as in the side-car.
pub(crate) fn pose(camera: &CameraPlan, frame: u32) -> CameraPose {
    let frame = if camera.time == TimeDependence::None { 0 } else { frame };
    camera.path.at(camera.timing.capture(frame, 0).middle_s())
}

/// File of a frame's image: developed, or raw if there is no developed one.
fn picture(camera: &CameraPlan, frame: u32) -> String {
    let products = &camera.products;
    let file = match products.raw && !products.picture {
        true => ResultFiles::raw(frame, products.raw_format),
        false => ResultFiles::picture(frame, camera.body.picture_format()),
    };
    format!("{}/{file}", camera.name)
}

/// A camera with rectilinear images.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PinholeView {
    /// fx, skew, cx, fy, cy, px; raster coordinates: pixel centres are at + 0.5.
    pub matrix_px: [f64; 5],
    /// Transform from the camera's frame (x right, y down, z forward) to the frame of the scene that carries it, m; `None` if none does, or if the camera
    /// moves in it.
    pub mount: Option<CameraPose>,
}

/// Returns the camera matrix of a camera of a plan.
///
/// # Errors
/// No matrix describes the camera: the rest of a sentence that begins with the camera.
pub fn pinhole_view(camera: &CameraPlan) -> Result<PinholeView, String> {
    let matrix = pinhole(&camera.body)?;
    let matrix_px = [matrix.fx, matrix.skew, matrix.cx, matrix.fy, matrix.cy];
    Ok(PinholeView { matrix_px, mount: camera_mount(camera) })
}

/// A camera that a `camera_info` of ROS describes.
#[derive(Clone, Debug)]
pub struct RosView {
    /// Fields of the `camera_info`.
    pub info: ros::CameraInfo,
    calibration: Calibration,
}

impl RosView {
    /// Tangents (x/z, y/z) of the direction in the camera's frame that a raster point sees; `None` if it sees nothing before the camera.
    #[must_use]
    pub fn tangents(&self, raster_px: DVec2) -> Option<DVec2> {
        let direction = self.calibration.unproject(raster_px)?;
        (direction.z > 0.0).then(|| direction.truncate() / direction.z)
    }
}

/// Returns the `camera_info` of a camera of a plan, with its distortion.
///
/// # Errors
/// ROS has no model for the camera: the rest of a sentence that begins with the camera.
pub fn ros_view(camera: &CameraPlan) -> Result<RosView, String> {
    let calibration = calibration(&camera.body)?;
    let info = ros::CameraInfo::new(&calibration, 0.0)?;
    Ok(RosView { info, calibration })
}

/// Transform from a camera's frame to the frame of the scene that carries it, m; `None` if none does, or if the camera moves in it.
#[must_use]
pub fn camera_mount(camera: &CameraPlan) -> Option<CameraPose> {
    camera.mount.pose.filter(|_| camera.mount.frame.is_some())
}

/// Maximum distance, px, between a point's image by the calibration and by the camera.
const TOLERANCE_PX: f64 = 1e-6;
/// Number of test positions along each side of the image.
const TEST_POSITIONS: u32 = 9;

/// The calibration that agrees with the camera in every direction.
///
/// # Errors
/// There is none: the rest of a sentence that begins with the camera.
fn calibration(body: &CameraBody) -> Result<Calibration, String> {
    if let Some(optic) = body.front.as_ref().and_then(Front::optic) {
        return Err(format!("its view is through a {}, which no calibration file describes", optic.name()));
    }
    let layout = body.sensor.as_ref().map(|sensor| sensor.parameters().read_out.layout);
    if layout.is_some_and(|layout| !layout.is_whole()) {
        return Err("its images are cropped, binned or subsampled, so their pixel grid is not that of the full sensor"
            .to_owned());
    }
    let own = match &body.lens {
        Lens::Calibrated(lens) => lens.parameters().calibration.clone(),
        Lens::Pinhole(_) | Lens::Thin(_) | Lens::Thick(_) => paraxial(body)?,
        Lens::Prescription(_) => {
            return Err(
                "its lens is traced surface by surface; \"etendue calibrate\" fits a model to images of a chart"
                    .to_owned(),
            );
        }
        Lens::RayTransfer(_) => {
            return Err("its lens is described by ray-transfer functions; \"etendue calibrate\" fits a model to images of a chart".to_owned());
        }
        Lens::Telecentric(_) => return Err("its rays are parallel".to_owned()),
    };
    match farthest_px(body, &own) {
        off if off <= TOLERANCE_PX => Ok(own),
        off => Err(format!("its projection differs from every model by {off:.2e} px")),
    }
}

/// Camera matrix of a camera with rectilinear images, in raster coordinates.
///
/// # Errors
/// There is none: the rest of a sentence that begins with the camera.
fn pinhole(body: &CameraBody) -> Result<CameraMatrix, String> {
    let own = calibration(body)?;
    let straight = Perspective::new(DistortionTerms::default(), [0.0; 2]).map_err(|error| error.to_string())?;
    match own.model() {
        Model::Perspective(model) if *model == straight => Ok(own.matrix()),
        _ => Err("its images are distorted, but the format has only a camera matrix".to_owned()),
    }
}

/// The camera matrix of a paraxial lens, with its radial distortion.
fn paraxial(body: &CameraBody) -> Result<Calibration, String> {
    let (lens, raster) = (&body.lens, &body.raster);
    let principal_mm = lens.principal_distance_mm();
    let mut terms = DistortionTerms::default();
    if let Some(distortion) = lens.distortion() {
        if distortion.sense() == DistortionDirection::ObservedToIdeal {
            return Err("its distortion is a polynomial from observed to ideal points, but calibration files use the \
                        opposite direction"
                .to_owned());
        }
        let [k1, k2] = distortion.coefficients();
        let square = (principal_mm / distortion.unit_mm()) * (principal_mm / distortion.unit_mm());
        (terms.numerator[0], terms.numerator[1]) = (k1 * square, k2 * square * square);
    }
    let model = Perspective::new(terms, [0.0; 2]).map_err(|error| error.to_string())?;
    let size_px = [raster.width(), raster.height()];
    Calibration::new(Model::Perspective(model), raster.camera_matrix(principal_mm), size_px)
        .map_err(|error| error.to_string())
}

/// Maximum distance, px, between the calibration and the camera over a grid of directions.
fn farthest_px(body: &CameraBody, calibration: &Calibration) -> f64 {
    let raster = &body.raster;
    let size = DVec2::new(raster.width() as f64, raster.height() as f64);
    let last = f64::from(TEST_POSITIONS - 1);
    let places = (0..TEST_POSITIONS * TEST_POSITIONS)
        .map(|i| DVec2::new(f64::from(i % TEST_POSITIONS), f64::from(i / TEST_POSITIONS)) / last * size);
    let off = |at_px: DVec2| {
        let direction = body.lens.direction(raster.sensor_mm(at_px))?;
        Some(calibration.project(direction).map_or(f64::INFINITY, |image_px| (image_px - at_px).length()))
    };
    places.filter_map(off).fold(0.0, f64::max)
}
