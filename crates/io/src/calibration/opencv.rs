//! OpenCV's FileStorage, YAML or JSON: `camera_matrix`, `distortion_coefficients`, `image_width`, `image_height`.
//!
//! The keys are those of OpenCV's own calibration programs; `cameraMatrix`, `K` and `distCoeffs`, `dist_coeffs`, `D` are read as well, and matrices as plain
//! nested lists. `fisheye_model: 1` means `cv::fisheye`, whose camera matrix holds α fx as its skew; `xi` means `cv::omnidir`. The perspective functions of
//! OpenCV ignore a skew, so one is refused.
//!
//! ROS `camera_info` YAML (camera_calibration_parsers): the raw image, before rectification.
//!
//! | distortion_model | coefficients |
//! | --- | --- |
//! | plumb_bob | k1, k2, p1, p2 (, k3) |
//! | rational_polynomial | k1, k2, p1, p2, k3, k4, k5, k6 (, s1 … s4 (, τx, τy)) |
//! | equidistant | k1, k2, k3, k4 of the polynomial fisheye |
//!
//! The rectification and projection matrices describe the rectified image, so they are ignored.

use etendue_projection::model::{KannalaBrandt, ModelError, Perspective, Unified};
use etendue_projection::{Calibration, CameraMatrix, Model, plane::DistortionTerms};

use super::yaml::{self, TreeNode};
use super::{ErrorCode, ReaderResult, TreeError, TreeResult, camera_error, fields, passed_over};

const MATRIX: [&str; 3] = ["camera_matrix", "cameraMatrix", "K"];
const DISTORTION: [&str; 4] = ["distortion_coefficients", "distCoeffs", "dist_coeffs", "D"];
const REST: [&str; 5] = ["image_width", "image_height", "image_size", "fisheye_model", "xi"];

/// Reads a camera; `fisheye` if the caller knows it to be one.
pub(super) fn read_opencv(text: &str, fisheye: bool) -> TreeResult<ReaderResult> {
    let root = yaml::parse(text)?;
    let size_px = fields::size(&root)?;
    let node = root.any(&MATRIX)?;
    let camera_matrix = fields::camera(node)?;
    let says_fisheye = root.find("fisheye_model").map(TreeNode::number).transpose()?.is_some_and(|flag| flag != 0.0);
    let distortion = root.any(&DISTORTION)?;
    let k = fields::numbers(distortion)?;
    let model = match root.find("xi") {
        Some(xi) => omnidir(xi, distortion.line, &k),
        None if fisheye || says_fisheye => self::fisheye(distortion.line, &k),
        None => perspective(node.line, camera_matrix, distortion.line, &k),
    }?;
    let calibration = Calibration::new(model, camera_matrix, size_px).map_err(camera_error(node.line))?;
    let known = [&MATRIX[..], &DISTORTION, &REST].concat();
    Ok(ReaderResult { name: String::new(), calibration, notes: passed_over(&root.others(&known)) })
}

fn perspective(at: usize, matrix: CameraMatrix, line: usize, k: &[f64]) -> TreeResult<Model> {
    if matrix.skew != 0.0 {
        let what = format!("the skew is {} px, which OpenCV's perspective functions ignore; expected 0", matrix.skew);
        return Err(TreeError::at(at, what));
    }
    Perspective::from_opencv(k).map(Model::Perspective).map_err(wrong(line))
}

pub(super) fn fisheye(line: usize, k: &[f64]) -> TreeResult<Model> {
    let k = k
        .try_into()
        .map_err(|_| TreeError::at(line, format!("the number of values is {}; expected k1, k2, k3, k4", k.len())))?;
    KannalaBrandt::new(k).map(Model::KannalaBrandt).map_err(wrong(line))
}

fn omnidir(xi: &TreeNode, line: usize, k: &[f64]) -> TreeResult<Model> {
    let [xi_value] = fields::numbers(xi)?[..] else { return Err(TreeError::at(xi.line, "expected xi as one number")) };
    let &[k1, k2, p1, p2] = k else {
        return Err(TreeError::at(line, format!("the number of values is {}; expected k1, k2, p1, p2", k.len())));
    };
    unified(xi_value, [k1, k2, p1, p2]).map_err(wrong(xi.line))
}

pub(super) fn unified(xi: f64, [k1, k2, p1, p2]: [f64; 4]) -> Result<Model, ModelError> {
    let terms = DistortionTerms { numerator: [k1, k2, 0.0, 0.0], tangential: [p1, p2], ..Default::default() };
    Unified::new(xi, terms).map(Model::Unified)
}

pub(super) fn wrong(line: usize) -> impl Fn(ModelError) -> TreeError {
    move |cause| TreeError::at(line, cause.to_string())
}

const KNOWN: [&str; 6] =
    ["image_width", "image_height", "camera_name", "camera_matrix", "distortion_model", "distortion_coefficients"];

pub(super) fn read_ros(text: &str) -> TreeResult<ReaderResult> {
    let root = yaml::parse(text)?;
    let size_px = [root.key("image_width")?.count()?, root.key("image_height")?.count()?];
    let node = root.key("camera_matrix")?;
    let camera_matrix = fields::camera(node)?;
    if camera_matrix.skew != 0.0 {
        return Err(TreeError::coded(
            ErrorCode::UnsupportedFile,
            node.line,
            "expected a camera matrix without skew, as camera_info defines it",
        ));
    }
    let model = model(root.key("distortion_model")?, root.key("distortion_coefficients")?)?;
    let calibration = Calibration::new(model, camera_matrix, size_px).map_err(camera_error(node.line))?;
    let name = root.find("camera_name").map(TreeNode::text).transpose()?.unwrap_or_default().to_owned();
    Ok(ReaderResult { name, calibration, notes: passed_over(&root.others(&KNOWN)) })
}

fn model(name: &TreeNode, coefficients: &TreeNode) -> TreeResult<Model> {
    let k = fields::numbers(coefficients)?;
    let counts: &[usize] = match name.text()? {
        "plumb_bob" => &[4, 5],
        "rational_polynomial" => &[8, 12, 14],
        "equidistant" => return fisheye(coefficients.line, &k),
        other => {
            let known = "plumb_bob, rational_polynomial, equidistant";
            return Err(TreeError::coded(
                ErrorCode::UnsupportedFile,
                name.line,
                format!("unknown distortion model {other}; expected one of {known}"),
            ));
        }
    };
    if !counts.contains(&k.len()) {
        let counts = counts.iter().map(usize::to_string).collect::<Vec<_>>().join(" or ");
        let what = format!("the number of values is {}; {} has {counts}", k.len(), name.text()?);
        return Err(TreeError::at(coefficients.line, what));
    }
    Perspective::from_opencv(&k).map(Model::Perspective).map_err(wrong(coefficients.line))
}
