//! ROS: `camera_info` YAML of the raw image (camera_calibration_parsers), and static transforms.
//!
//! | camera | distortion_model | coefficients |
//! | --- | --- | --- |
//! | perspective with k1, k2, p1, p2, k3 | plumb_bob | 5 |
//! | perspective with more | rational_polynomial | 8, 12 (with s1 … s4) or 14 (with τx, τy) |
//! | polynomial fisheye, with or without skew | equidistant | 4 |
//!
//! The projection matrix is that of the rectified image: the camera's own matrix, and −fx b in its fourth column for the right camera of a rectified pair of
//! baseline b.

use etendue_core::CameraPose;
use etendue_projection::{Calibration, Model};

use super::{
    ExportError, NamedCamera, fisheye, list, no_model, number, perspective, quaternion, quoted, shortest, without_skew,
};

const FORMAT: &str = "ROS";
const EQUIDISTANT: &str = "equidistant";

/// Fields of a `camera_info`. The rectification matrix is the identity.
#[derive(Clone, Debug, PartialEq)]
pub struct CameraInfo {
    /// Width and height, px.
    pub size_px: [usize; 2],
    /// Name of the distortion model.
    pub distortion_model: &'static str,
    /// Its coefficients, D.
    pub coefficients: Vec<f64>,
    /// Camera matrix K, by rows; pixel centres are at whole numbers.
    pub matrix: [[f64; 3]; 3],
    /// Projection matrix P, by rows.
    pub projection: [[f64; 4]; 3],
}

impl CameraInfo {
    /// Describes a camera; `base_m` is the baseline from a rectified pair's left camera to the right, 0 for all others.
    ///
    /// # Errors
    /// The reason for which ROS cannot represent it.
    pub fn new(calibration: &Calibration, base_m: f64) -> Result<Self, ExportError> {
        let (distortion_model, coefficients) = distortion(calibration.model())?;
        // The skew of a fisheye is that of OpenCV's fisheye, α fx.
        if distortion_model != EQUIDISTANT {
            without_skew(FORMAT, calibration)?;
        }
        let camera = calibration.matrix().to_opencv();
        let matrix = camera.rows();
        let [[fx, skew, cx], [_, fy, cy], _] = matrix;
        let projection = [[fx, skew, cx, -fx * base_m], [0.0, fy, cy, 0.0], [0.0, 0.0, 1.0, 0.0]];
        Ok(Self { size_px: calibration.size_px(), distortion_model, coefficients, matrix, projection })
    }

    /// The fields as YAML of camera_calibration_parsers.
    #[must_use]
    pub fn to_yaml(&self, name: &str) -> String {
        let [width, height] = self.size_px;
        let identity = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        format!(
            "image_width: {width}\nimage_height: {height}\ncamera_name: {}\n{}distortion_model: {}\n{}{}{}",
            quoted(name),
            table("camera_matrix", 3, 3, self.matrix.as_flattened()),
            self.distortion_model,
            table("distortion_coefficients", 1, self.coefficients.len(), &self.coefficients),
            table("rectification_matrix", 3, 3, identity.as_flattened()),
            table("projection_matrix", 3, 4, self.projection.as_flattened()),
        )
    }
}

/// A camera as `camera_info` YAML; `base_m` as in [`CameraInfo::new`].
///
/// # Errors
/// The reason for which ROS cannot represent it.
pub fn camera_info(camera: &NamedCamera<'_>, base_m: f64) -> Result<String, ExportError> {
    CameraInfo::new(camera.calibration, base_m).map(|info| info.to_yaml(camera.name))
}

fn distortion(model: &Model) -> Result<(&'static str, Vec<f64>), ExportError> {
    if let Some(k) = fisheye(model) {
        return Ok((EQUIDISTANT, k.to_vec()));
    }
    let k = perspective(model).ok_or_else(|| no_model(FORMAT, model))?;
    let count = shortest(&k, &[5, 8, 12]).unwrap_or(k.len());
    Ok((if count == 5 { "plumb_bob" } else { "rational_polynomial" }, k[..count].to_vec()))
}

fn table(name: &str, rows: usize, columns: usize, data: &[f64]) -> String {
    format!("{name}:\n  rows: {rows}\n  cols: {columns}\n  data: {}\n", list(data))
}

/// Frame fixed in another frame.
#[derive(Clone, Debug)]
pub struct StaticTransform<'a> {
    /// Name of the parent frame.
    pub parent: &'a str,
    /// Name of the frame.
    pub child: String,
    /// Transform from the frame to its parent, m.
    pub pose: CameraPose,
}

/// Frame of a camera's image (x right, y down, z forward), named as in REP 103.
#[must_use]
pub fn optical_frame(camera: &str) -> String {
    format!("{camera}_optical_frame")
}

/// Transforms as a YAML list of `geometry_msgs/TransformStamped` without stamps: the content of `/tf_static`. `left_out` are sentences written above them.
#[must_use]
pub fn static_transforms(transforms: &[StaticTransform<'_>], left_out: &[String]) -> String {
    let mut text = String::from(
        "# Where frames are fixed: translation (m) and rotation take points of the child to the parent.\n",
    );
    left_out.iter().for_each(|note| text.push_str(&format!("# left out: {note}\n")));
    if transforms.is_empty() {
        text.push_str("transforms: []\n");
        return text;
    }
    text.push_str("transforms:\n");
    transforms.iter().for_each(|transform| text.push_str(&entry(transform)));
    text
}

fn entry(transform: &StaticTransform<'_>) -> String {
    let [x, y, z] = transform.pose.position_m.to_array().map(number);
    let [qw, qx, qy, qz] = quaternion(&transform.pose.rotation).map(number);
    format!(
        "  - header: {{frame_id: {}}}\n    child_frame_id: {}\n    transform:\n      translation: {{x: {x}, y: {y}, z: {z}}}\n      \
         rotation: {{x: {qx}, y: {qy}, z: {qz}, w: {qw}}}\n",
        quoted(transform.parent),
        quoted(&transform.child)
    )
}
