//! OpenCV's FileStorage: YAML, XML or JSON. Keys: [`file_storage`].
//!
//! | camera | stated by |
//! | --- | --- |
//! | `cv::projectPoints`: 0, 4, 5, 8, 12 or 14 coefficients | – |
//! | `cv::fisheye`: 4 coefficients; the camera matrix holds α fx as its skew | `fisheye_model: 1`, or the name of the model |
//! | `cv::omnidir`: ξ and 4 coefficients | `xi`, or the name of the model |
//!
//! The perspective functions of OpenCV ignore a skew, so one is refused.

use etendue_projection::{CameraMatrix, Model};

use super::file_storage::{self, Numbers, StoredCamera, folded};
use super::models::{fisheye, invalid_model, perspective, unified};
use super::yaml::{self, TreeNode};
use super::{ErrorCode, ReaderResult, TreeError, TreeResult, passed_over, reader_result, xml};

/// Keys of a camera matrix and of coefficients, for errors.
const MATRIX: [&str; 3] = ["camera_matrix", "cameraMatrix", "K"];
const DISTORTION: [&str; 4] = ["distortion_coefficients", "distCoeffs", "dist_coeffs", "D"];

/// Model that a file names.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum NamedModel {
    Perspective,
    Fisheye,
    Omnidirectional,
}

/// Reads a camera; `is_fisheye` if the caller knows it to be one.
pub(super) fn read(text: &str, is_fisheye: bool, requested: Option<&str>) -> TreeResult<ReaderResult> {
    let root = if text.trim_start().starts_with('<') { xml::parse(text)? } else { yaml::parse(text)? };
    let cameras = file_storage::cameras(&root);
    let camera = chosen(&root, &cameras, requested)?;
    let size_px = camera.size_px()?;
    let name = match camera.names.first() {
        Some(name) => requested.unwrap_or(name),
        None => "",
    };
    let (model, matrix) = match camera.numbers {
        Numbers::Matrix(node) => from_matrix(camera, node, is_fisheye)?,
        Numbers::Single => from_single_numbers(camera, is_fisheye)?,
    };
    let result = ReaderResult::with_size(model, matrix, size_px, camera.line())?;
    Ok(ReaderResult { name: name.to_owned(), notes: passed_over(&camera.other_keys()), ..result })
}

/// The requested camera, or the only one.
fn chosen<'a, 'b>(
    root: &TreeNode,
    cameras: &'b [StoredCamera<'a>],
    requested: Option<&str>,
) -> TreeResult<&'b StoredCamera<'a>> {
    if let [only] = cameras
        && only.names.is_empty()
    {
        return Ok(only);
    }
    if cameras.is_empty() {
        root.any(&MATRIX)?;
    }
    let has_name = |camera: &&StoredCamera<'_>| camera.names.iter().any(|name| Some(name.as_str()) == requested);
    if let Some(camera) = cameras.iter().find(has_name) {
        return Ok(camera);
    }
    let names: Vec<&str> = cameras.iter().filter_map(|camera| camera.names.first()).map(String::as_str).collect();
    Ok(&cameras[reader_result::choose(&names, requested)?])
}

fn from_matrix(camera: &StoredCamera<'_>, node: &TreeNode, is_fisheye: bool) -> TreeResult<(Model, CameraMatrix)> {
    let matrix = reader_result::camera(node)?;
    let Some(distortion) = camera.distortion() else {
        let name = camera.names.first().map_or(String::new(), |name| format!(" of camera \"{name}\""));
        let expected = DISTORTION.join(" or ");
        return Err(TreeError::at(node.line, format!("expected the key {expected}{name} beside its camera matrix")));
    };
    let k = reader_result::numbers(distortion)?;
    let line = distortion.line;
    let model = match named_model(camera, is_fisheye)? {
        NamedModel::Omnidirectional => omnidirectional(camera, line, &k)?,
        NamedModel::Fisheye => fisheye(line, &k)?,
        NamedModel::Perspective => {
            without_skew(node.line, matrix)?;
            perspective(line, &k)?
        }
    };
    Ok((model, matrix))
}

fn without_skew(line: usize, matrix: CameraMatrix) -> TreeResult<()> {
    if matrix.skew == 0.0 {
        return Ok(());
    }
    let what = format!("the skew is {} px, which OpenCV's perspective functions ignore; expected 0", matrix.skew);
    Err(TreeError::at(line, what))
}

/// Names of the coefficients of `cv::projectPoints`, in its order.
const COEFFICIENTS: [&str; 14] =
    ["k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6", "s1", "s2", "s3", "s4", "taux", "tauy"];

fn from_single_numbers(camera: &StoredCamera<'_>, is_fisheye: bool) -> TreeResult<(Model, CameraMatrix)> {
    let number = |name: &str| camera.single(name).map_or(Ok(0.0), TreeNode::number);
    let (fx, fy, cx, cy) = (number("fx")?, number("fy")?, number("cx")?, number("cy")?);
    let matrix = CameraMatrix { fx, fy, skew: 0.0, cx, cy }.from_opencv();
    let line = camera.line();
    let values = |names: &[&str]| names.iter().map(|name| number(name)).collect::<TreeResult<Vec<f64>>>();
    let model = match named_model(camera, is_fisheye)? {
        NamedModel::Omnidirectional => omnidirectional(camera, line, &values(&COEFFICIENTS[..4])?)?,
        NamedModel::Fisheye => fisheye(line, &values(&["k1", "k2", "k3", "k4"])?)?,
        NamedModel::Perspective => perspective(line, &values(&COEFFICIENTS)?)?,
    };
    Ok((model, matrix))
}

fn omnidirectional(camera: &StoredCamera<'_>, line: usize, k: &[f64]) -> TreeResult<Model> {
    let Some(xi) = camera.value(&["xi"]) else {
        return Err(TreeError::at(line, "expected the key xi of the omnidirectional camera"));
    };
    let [xi_value] = reader_result::numbers(xi)?[..] else {
        return Err(TreeError::at(xi.line, "expected xi as one number"));
    };
    let &[k1, k2, p1, p2] = k else {
        return Err(TreeError::at(line, format!("the number of values is {}; expected k1, k2, p1, p2", k.len())));
    };
    unified(xi_value, [k1, k2, p1, p2]).map_err(invalid_model(xi.line))
}

/// Keys whose value is the name of a model, and keys whose value may be: of a product as well, for example.
const MODEL: [&str; 4] = ["distortionmodel", "cameramodel", "projectionmodel", "distortiontype"];
const MODEL_OR_OTHER: [&str; 5] = ["cameratype", "modeltype", "lensmodel", "model", "type"];
/// Keys of a flag.
const FISHEYE: [&str; 4] = ["fisheyemodel", "isfisheye", "usefisheye", "fisheye"];

/// The model that the file states, or the perspective one.
fn named_model(camera: &StoredCamera<'_>, is_fisheye: bool) -> TreeResult<NamedModel> {
    if let Some(node) = camera.value(&MODEL) {
        let name = node.text()?;
        let model = model_of(name).ok_or_else(|| unsupported_model(node.line, name))?;
        return consistent(camera, node.line, model, is_fisheye);
    }
    if let Some(node) = camera.value(&MODEL_OR_OTHER)
        && let Ok(name) = node.text()
    {
        match model_of(name) {
            Some(model) => return consistent(camera, node.line, model, is_fisheye),
            None if OTHER_MODELS.contains(&folded(name).as_str()) => return Err(unsupported_model(node.line, name)),
            None => {}
        }
    }
    let flag = camera.value(&FISHEYE).map(flag).transpose()?.unwrap_or(false);
    Ok(match camera.value(&["xi"]) {
        Some(_) => NamedModel::Omnidirectional,
        None if flag || is_fisheye => NamedModel::Fisheye,
        None => NamedModel::Perspective,
    })
}

fn unsupported_model(line: usize, name: &str) -> TreeError {
    let what = format!("the model \"{name}\" is not supported; expected perspective, fisheye or omnidirectional");
    TreeError::coded(ErrorCode::UnsupportedFile, line, what)
}

/// Refuses a model that contradicts the format that the caller states.
fn consistent(camera: &StoredCamera<'_>, line: usize, model: NamedModel, is_fisheye: bool) -> TreeResult<NamedModel> {
    if is_fisheye && model != NamedModel::Fisheye {
        return Err(TreeError::at(line, "the file states another model than a fisheye; use the format \"opencv\""));
    }
    if model == NamedModel::Perspective && camera.value(&["xi"]).is_some() {
        return Ok(NamedModel::Omnidirectional);
    }
    Ok(model)
}

/// Folded names of models that OpenCV does not have.
const OTHER_MODELS: [&str; 9] =
    ["doublesphere", "ds", "eucm", "extendedunified", "fov", "division", "ocam", "scaramuzza", "ftheta"];

fn model_of(name: &str) -> Option<NamedModel> {
    match folded(name).as_str() {
        "pinhole" | "perspective" | "plumbbob" | "radtan" | "radialtangential" | "brown" | "brownconrady"
        | "rationalpolynomial" | "rational" | "thinprism" | "tilted" | "standard" | "opencv" | "rectilinear" => {
            Some(NamedModel::Perspective)
        }
        "fisheye" | "equidistant" | "equi" | "kannalabrandt" | "kannalabrandt4" | "kannalabrandt8"
        | "opencvfisheye" | "pinholefisheye" | "pinholeequi" => Some(NamedModel::Fisheye),
        "omnidir" | "omnidirectional" | "omni" | "mei" | "unified" => Some(NamedModel::Omnidirectional),
        _ => None,
    }
}

fn flag(node: &TreeNode) -> TreeResult<bool> {
    match node.text()?.to_ascii_lowercase().as_str() {
        "true" | "yes" | "on" => Ok(true),
        "false" | "no" | "off" | "" => Ok(false),
        _ => node.number().map(|flag| flag != 0.0),
    }
}
