//! ROS `camera_info` of the raw image, before rectification.
//!
//! | written by | keys |
//! | --- | --- |
//! | camera_calibration_parsers, YAML | `image_width`, `image_height`, `camera_name`, `camera_matrix`, `distortion_model`, `distortion_coefficients` |
//! | the same, INI (`ost.txt`) | [`ros_ini`] |
//! | `rostopic echo` of ROS 1, and JSON | `width`, `height`, `K`, `distortion_model`, `D` |
//! | `ros2 topic echo` of ROS 2 | the same with `k`, `d` |
//!
//! | distortion_model | coefficients |
//! | --- | --- |
//! | plumb_bob | k1, k2, p1, p2 (, k3); more as in OpenCV, which ROS passes them to; none without distortion |
//! | rational_polynomial | k1, k2, p1, p2, k3, k4, k5, k6 (, s1 … s4 (, τx, τy)) |
//! | thin_prism | the same, 12 or 14 |
//! | equidistant, fisheye | k1, k2, k3, k4 of the polynomial fisheye, whose camera matrix may hold a skew α fx |
//! | none | none, or zeros |
//!
//! Some drivers call the model `camera_model`. Without a model, plumb_bob is assumed, as ROS does. The rectification and projection matrices describe the
//! rectified image, so they are ignored. Of several printed messages, which `---` separates, the first is read.

use etendue_projection::{Calibration, CameraMatrix, Model};

use super::models::{fisheye, perspective};
use super::ros_ini::{self, IniCamera};
use super::yaml::{self, TreeNode};
use super::{ErrorCode, ReaderResult, TreeError, TreeResult, camera_error, passed_over, reader_result};

const WIDTH: [&str; 2] = ["image_width", "width"];
const HEIGHT: [&str; 2] = ["image_height", "height"];
const MATRIX: [&str; 3] = ["camera_matrix", "K", "k"];
const DISTORTION: [&str; 3] = ["distortion_coefficients", "D", "d"];
const REST: [&str; 7] = ["camera_name", "distortion_model", "camera_model", "header", "binning_x", "binning_y", "roi"];
const MODELS: &str = "plumb_bob, rational_polynomial, equidistant, fisheye, thin_prism, none";

pub(super) fn read(text: &str, requested: Option<&str>) -> TreeResult<ReaderResult> {
    if ros_ini::is_ini(text) {
        let cameras = ros_ini::parse(text)?;
        let names: Vec<&str> = cameras.iter().map(|camera| camera.name.as_str()).collect();
        let IniCamera { name, root } = &cameras[reader_result::choose(&names, requested)?];
        return Ok(ReaderResult { name: name.clone(), ..camera(root, Vec::new())? });
    }
    let (root, has_more) = yaml::first_document(text)?;
    let more = has_more.then(|| "the file contains several messages; the first is used".to_owned());
    camera(&root, more.into_iter().collect())
}

fn camera(root: &TreeNode, mut notes: Vec<String>) -> TreeResult<ReaderResult> {
    let size_px = [side(root, &WIDTH)?, side(root, &HEIGHT)?];
    let node = root.any(&MATRIX)?;
    let camera_matrix = matrix(node)?;
    let coefficients = root.any(&DISTORTION)?;
    let (model_name, line) = match stated_model(root)? {
        Some(model) => (model.text()?, model.line),
        None => {
            notes.push("the file states no distortion model; plumb_bob is assumed, as in ROS".to_owned());
            ("plumb_bob", coefficients.line)
        }
    };
    let model = model(model_name, line, coefficients)?;
    if let Model::Perspective(_) = model
        && camera_matrix.skew != 0.0
    {
        return Err(TreeError::coded(
            ErrorCode::UnsupportedFile,
            node.line,
            "the camera matrix has a skew, which ROS ignores for this distortion model; expected 0",
        ));
    }
    let calibration = Calibration::new(model, camera_matrix, size_px).map_err(camera_error(node.line))?;
    notes.extend(passed_over(&root.others(&[&WIDTH[..], &HEIGHT, &MATRIX, &DISTORTION, &REST].concat())));
    notes.extend(read_out(root)?);
    Ok(ReaderResult::new(name(root)?, calibration, notes))
}

/// Width or height, px: in a file, or in a message.
fn side(root: &TreeNode, keys: &[&str; 2]) -> TreeResult<usize> {
    root.find(keys[1]).map_or_else(|| root.key(keys[0]), Ok)?.count()
}

fn matrix(node: &TreeNode) -> TreeResult<CameraMatrix> {
    // ROS marks an uncalibrated camera by zeros.
    if reader_result::numbers(node)?.iter().all(|number| *number == 0.0) {
        return Err(TreeError::at(node.line, "the camera is not calibrated: its camera matrix is 0"));
    }
    reader_result::camera(node)
}

/// Name of the camera: in a message, of its frame.
fn name(root: &TreeNode) -> TreeResult<&str> {
    let frame = || root.find("header").and_then(|header| header.find("frame_id"));
    root.find("camera_name").or_else(frame).map_or(Ok(""), TreeNode::text)
}

/// Name of the distortion model, unless the file states none.
fn stated_model(root: &TreeNode) -> TreeResult<Option<&TreeNode>> {
    let (distortion, camera) = (root.find("distortion_model"), root.find("camera_model"));
    let Some(camera) = camera else { return Ok(distortion.filter(|node| !node.text().is_ok_and(str::is_empty))) };
    let Some(distortion) = distortion else { return Ok(Some(camera).filter(|node| !is_pinhole(node))) };
    let (name, general) = (distortion.text()?, camera.text()?);
    let agree = is_pinhole(camera) || general == name || (is_fisheye(general) && is_fisheye(name));
    if agree {
        return Ok(Some(distortion));
    }
    Err(TreeError::at(
        camera.line,
        format!("camera_model \"{general}\" contradicts distortion_model \"{name}\"; expected one of them"),
    ))
}

fn is_pinhole(node: &TreeNode) -> bool {
    matches!(node.text(), Ok("pinhole" | "perspective" | ""))
}

fn is_fisheye(name: &str) -> bool {
    matches!(name, "equidistant" | "fisheye" | "kannala_brandt" | "kannala_brandt4")
}

fn model(name: &str, line: usize, coefficients: &TreeNode) -> TreeResult<Model> {
    let k = reader_result::numbers(coefficients)?;
    let counts: &[usize] = match name {
        "plumb_bob" => &[0, 4, 5, 8, 12, 14],
        "rational_polynomial" => &[8, 12, 14],
        "thin_prism" => &[12, 14],
        "none" if k.iter().all(|k| *k == 0.0) => return perspective(coefficients.line, &[]),
        "none" => return Err(TreeError::at(coefficients.line, "the distortion model \"none\" has no coefficients")),
        name if is_fisheye(name) => return fisheye(coefficients.line, &k),
        other => {
            return Err(TreeError::coded(
                ErrorCode::UnsupportedFile,
                line,
                format!("unknown distortion model {other}; expected one of {MODELS}"),
            ));
        }
    };
    if !counts.contains(&k.len()) {
        let counts = counts.iter().map(usize::to_string).collect::<Vec<_>>().join(" or ");
        let what = format!("found {} numbers; {name} has {counts}", k.len());
        return Err(TreeError::at(coefficients.line, what));
    }
    perspective(coefficients.line, &k)
}

/// Note on a message whose images are binned or of a region: its camera matrix is that of the full image.
fn read_out(root: &TreeNode) -> TreeResult<Option<String>> {
    let number = |node: Option<&TreeNode>| node.map_or(Ok(0.0), TreeNode::number);
    let mut is_full = number(root.find("binning_x"))? <= 1.0 && number(root.find("binning_y"))? <= 1.0;
    if let Some(region) = root.find("roi") {
        for key in ["x_offset", "y_offset", "width", "height"] {
            let full =
                if key == "width" { root.find("width") } else { root.find("height").filter(|_| key == "height") };
            let value = number(region.find(key))?;
            is_full &= value == 0.0 || Some(value) == full.map(TreeNode::number).transpose()?;
        }
    }
    Ok((!is_full).then(|| {
        "the images of the message are binned or of a region; the camera is that of the full image".to_owned()
    }))
}
