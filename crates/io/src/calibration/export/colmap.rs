//! COLMAP's text model: `cameras.txt`, `images.txt` and an empty `points3D.txt`.
//!
//! Poses are those of the world in the camera's frame: a quaternion (w, x, y, z; w not below 0) and a translation (m). Pixel centres are at + 0.5,
//! as in the raster.

use etendue_core::CameraPose;
use etendue_projection::{Model, plane::DistortionTerms};

use super::{ExportError, NamedCamera, fisheye, no_model, number, perspective, quaternion, shortest, without_skew};

const FORMAT: &str = "COLMAP";

/// `points3D.txt` without points.
pub const NO_POINTS: &str =
    "# 3D points: none; POINT3D_ID, X, Y, Z, R, G, B, ERROR, TRACK[] as (IMAGE_ID, POINT2D_IDX)\n";

/// Line of `cameras.txt` for a camera, after its id.
///
/// # Errors
/// The reason for which COLMAP cannot represent it.
pub fn camera(camera: &NamedCamera<'_>) -> Result<String, ExportError> {
    let calibration = camera.calibration;
    without_skew(FORMAT, calibration)?;
    let (name, more) = model(calibration.model())?;
    let [width, height] = calibration.size_px();
    let matrix = calibration.matrix();
    let parameters = [matrix.fx, matrix.fy, matrix.cx, matrix.cy].into_iter().chain(more).map(number);
    Ok(format!("{name} {width} {height} {}", parameters.collect::<Vec<_>>().join(" ")))
}

fn model(model: &Model) -> Result<(&'static str, Vec<f64>), ExportError> {
    if let Some(k) = fisheye(model) {
        return Ok(("OPENCV_FISHEYE", k.to_vec()));
    }
    if let Some(k) = perspective(model) {
        return match shortest(&k, &[0, 4, 8]) {
            Some(0) => Ok(("PINHOLE", Vec::new())),
            Some(4) => Ok(("OPENCV", k[..4].to_vec())),
            Some(_) => Ok(("FULL_OPENCV", k[..8].to_vec())),
            None => Err(no_model(FORMAT, model)),
        };
    }
    match model {
        Model::FieldOfView(m) => Ok(("FOV", vec![m.omega_rad()])),
        Model::Division(m) => Ok(("DIVISION", vec![m.k()])),
        Model::ExtendedUnified(m) => Ok(("EUCM", vec![m.alpha(), m.beta()])),
        Model::ThinPrismFisheye(m) => {
            thin_prism(m.fisheye().coefficients(), m.distortion().terms()).ok_or_else(|| no_model(FORMAT, model))
        }
        _ => Err(no_model(FORMAT, model)),
    }
}

/// The two thin-prism fisheyes: one has its polynomial in the plane; the other has it in the angle, and its first tangential coefficient belongs to x.
fn thin_prism(k: [f64; 6], terms: DistortionTerms) -> Option<(&'static str, Vec<f64>)> {
    let ([p1, p2], [s1, s2, s3, s4]) = (terms.tangential, terms.prism);
    if terms.denominator != [0.0; 3] {
        return None;
    }
    if k == [0.0; 6] && (s2, s4) == (0.0, 0.0) {
        let [k1, k2, k3, k4] = terms.numerator;
        return Some(("THIN_PRISM_FISHEYE", vec![k1, k2, p1, p2, k3, k4, s1, s3]));
    }
    let more = [p2, p1, s1, s2, s3, s4];
    (terms.numerator == [0.0; 4]).then(|| ("RAD_TAN_THIN_PRISM_FISHEYE", k.into_iter().chain(more).collect()))
}

/// `cameras.txt` from the [`camera`] line of each camera; ids count from 1.
#[must_use]
pub fn cameras(lines: &[String], left_out: &[String]) -> String {
    let mut text = format!("# CAMERA_ID, MODEL, WIDTH, HEIGHT, PARAMS[]\n# Number of cameras: {}\n", lines.len());
    left_out.iter().for_each(|note| text.push_str(&format!("# left out: {note}\n")));
    for (i, line) in lines.iter().enumerate() {
        text.push_str(&format!("{} {line}\n", i + 1));
    }
    text
}

/// Image with the pose of its camera.
#[derive(Clone, Debug)]
pub struct ColmapImage {
    /// The camera, from 1.
    pub camera: usize,
    /// Pose of the camera in the world.
    pub pose: CameraPose,
    /// Image file.
    pub file: String,
}

/// `images.txt`; ids count from 1, and no image has points.
#[must_use]
pub fn images(images: &[ColmapImage]) -> String {
    let mut text = format!(
        "# IMAGE_ID, QW, QX, QY, QZ, TX, TY, TZ, CAMERA_ID, NAME; then POINTS2D[] as (X, Y, POINT3D_ID): none\n\
         # Number of images: {}, mean observations per image: 0\n",
        images.len()
    );
    for (i, image) in images.iter().enumerate() {
        let inverse = image.pose.rotation.transpose();
        let translation = -(inverse * image.pose.position_m);
        let numbers = quaternion(&inverse).into_iter().chain(translation.to_array()).map(number);
        let numbers = numbers.collect::<Vec<_>>().join(" ");
        text.push_str(&format!("{} {numbers} {} {}\n\n", i + 1, image.camera, image.file));
    }
    text
}
