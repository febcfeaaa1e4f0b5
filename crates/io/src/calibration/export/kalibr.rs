//! Kalibr's camera chain (`camchain.yaml`): rigidly connected cameras, each with its pose relative to the one before it.
//!
//! | camera | camera_model | distortion_model |
//! | --- | --- | --- |
//! | perspective with k1, k2, p1, p2 | pinhole | radtan |
//! | polynomial fisheye | pinhole | equidistant |
//! | field-of-view | pinhole | fov |
//! | unified | omni | radtan |
//! | extended unified | eucm | none |
//! | double sphere | ds | none |
//!
//! `T_cn_cnm1` maps points of the previous camera's frame to this one's. `T_cam_imu` maps those of the frame that carries both, which takes the place of the
//! inertial sensor of Kalibr's own chains, with a `timeshift_cam_imu` of 0: times are the world's. Matrices act on columns (x, y, z, 1), m.

use etendue_core::CameraPose;
use etendue_projection::{Model, plane::DistortionTerms};
use glam::{DMat4, DVec3};

use super::{ExportError, NamedCamera, fisheye, list, no_model, number, perspective, quoted, shortest, without_skew};

const FORMAT: &str = "Kalibr";

/// Kalibr's description of a projection.
#[derive(Clone, Debug, PartialEq)]
pub struct Intrinsics {
    camera_model: &'static str,
    intrinsics: Vec<f64>,
    distortion_model: &'static str,
    distortion: Vec<f64>,
}

/// A camera of a chain.
#[derive(Clone, Debug)]
pub struct ChainLink<'a> {
    pub camera: NamedCamera<'a>,
    /// Projection: [`intrinsics`].
    pub intrinsics: Intrinsics,
    /// Transform from the camera's frame to the one that carries the chain.
    pub pose: CameraPose,
}

/// Writes a chain. `frame` is the name of the frame that carries it, unless that is the world. `left_out` are sentences written above it.
#[must_use]
pub fn camchain(frame: Option<&str>, links: &[ChainLink<'_>], left_out: &[String]) -> String {
    let mut text = match frame {
        Some(frame) => format!("# T_cam_imu: from the frame {} to the camera's\n", quoted(frame)),
        None => String::new(),
    };
    left_out.iter().for_each(|note| text.push_str(&format!("# left out: {note}\n")));
    for (i, link) in links.iter().enumerate() {
        let Intrinsics { camera_model, intrinsics, distortion_model, distortion } = &link.intrinsics;
        let [width, height] = link.camera.calibration.size_px();
        text.push_str(&format!("cam{i}:\n"));
        let to_camera = to_camera(&link.pose);
        if frame.is_some() {
            text.push_str(&matrix("T_cam_imu", &to_camera));
        }
        if let Some(before) = i.checked_sub(1) {
            text.push_str(&matrix("T_cn_cnm1", &between(&links[before].pose, &link.pose)));
        }
        text.push_str(&format!(
            "  camera_model: {camera_model}\n  distortion_coeffs: {}\n  distortion_model: {distortion_model}\n  intrinsics: {}\n  \
             resolution: [{width}, {height}]\n  rostopic: /{}/image_raw\n",
            list(distortion),
            list(intrinsics),
            link.camera.name
        ));
        if frame.is_some() {
            text.push_str("  timeshift_cam_imu: 0.0\n");
        }
    }
    text
}

/// Intrinsics of a camera in Kalibr's form.
///
/// # Errors
/// The reason for which Kalibr cannot represent it.
pub fn intrinsics(camera: &NamedCamera<'_>) -> Result<Intrinsics, ExportError> {
    let calibration = camera.calibration;
    without_skew(FORMAT, calibration)?;
    let matrix = calibration.matrix().to_opencv();
    let mut result = model(calibration.model())?;
    result.intrinsics.extend([matrix.fx, matrix.fy, matrix.cx, matrix.cy]);
    Ok(result)
}

/// Model with its own parameters, without focal lengths and centre.
fn model(model: &Model) -> Result<Intrinsics, ExportError> {
    let build = |camera_model, own: &[f64], distortion_model, distortion: &[f64]| {
        let (intrinsics, distortion) = (own.to_vec(), distortion.to_vec());
        Ok(Intrinsics { camera_model, intrinsics, distortion_model, distortion })
    };
    if let Some(k) = fisheye(model) {
        return build("pinhole", &[], "equidistant", &k);
    }
    if let Some(k) = perspective(model).filter(|k| shortest(k, &[4]).is_some()) {
        return build("pinhole", &[], "radtan", &k[..4]);
    }
    match model {
        Model::FieldOfView(m) => build("pinhole", &[], "fov", &[m.omega_rad()]),
        Model::Unified(m) => match m.distortion().terms() {
            DistortionTerms {
                numerator: [k1, k2, 0.0, 0.0],
                denominator: [0.0, 0.0, 0.0],
                tangential: [p1, p2],
                prism: [0.0, 0.0, 0.0, 0.0],
            } => build("omni", &[m.xi()], "radtan", &[k1, k2, p1, p2]),
            _ => Err(no_model(FORMAT, model)),
        },
        Model::ExtendedUnified(m) => build("eucm", &[m.alpha(), m.beta()], "none", &[]),
        Model::DoubleSphere(m) => build("ds", &[m.xi(), m.alpha()], "none", &[]),
        _ => Err(no_model(FORMAT, model)),
    }
}

fn to_camera(pose: &CameraPose) -> DMat4 {
    let inverse = pose.rotation.transpose();
    affine(inverse, -(inverse * pose.position_m))
}

/// Transform from one camera to another, without the rounding of a far origin.
fn between(from: &CameraPose, to: &CameraPose) -> DMat4 {
    affine(to.rotation.transpose() * from.rotation, to.point_to_camera(from.position_m))
}

fn affine(rotation: glam::DMat3, translation: DVec3) -> DMat4 {
    DMat4::from_cols(
        rotation.x_axis.extend(0.0),
        rotation.y_axis.extend(0.0),
        rotation.z_axis.extend(0.0),
        translation.extend(1.0),
    )
}

fn matrix(name: &str, matrix: &DMat4) -> String {
    let row = |i: usize| {
        let row = matrix.row(i).to_array().map(number);
        format!("  - [{}]\n", row.join(", "))
    };
    format!("  {name}:\n{}", (0..4).map(row).collect::<String>())
}
