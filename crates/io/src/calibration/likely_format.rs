//! Format that a text appears to have, for the error of a text that is read as another one.

use super::CalibrationFormat;
use super::yaml::{self, TreeNode};

/// The format whose keys a text has, if it is another one than the stated.
pub(super) fn other_format(text: &str, stated: CalibrationFormat) -> Option<CalibrationFormat> {
    use CalibrationFormat::{Colmap, FTheta, Ocam, OpenCv, OpenCvFisheye, Ros};
    let is_same = |format: &CalibrationFormat| *format == stated || (*format == OpenCv && stated == OpenCvFisheye);
    let start = text.trim_start();
    let by_start = [
        ("<?xml", OpenCv),
        ("<opencv_storage", OpenCv),
        ("# Camera list with one line", Colmap),
        ("# oST version", Ros),
        ("#polynomial coefficients", Ocam),
    ];
    let format = by_start.iter().find(|(words, _)| start.starts_with(words)).map(|(_, format)| *format);
    // Formats of plain numbers are no YAML.
    let tree = || if matches!(stated, FTheta) { None } else { yaml::parse(text).ok() };
    format.or_else(|| by_keys(&tree()?)).filter(|format| !is_same(format))
}

fn by_keys(root: &TreeNode) -> Option<CalibrationFormat> {
    let has = |node: &TreeNode, keys: &[&str]| keys.iter().all(|key| node.find(key).is_some());
    let is_link = |node: &TreeNode| has(node, &["camera_model", "intrinsics"]);
    if has(root, &["model_type", "image_width"]) {
        return Some(CalibrationFormat::Camodocal);
    }
    if is_link(root) {
        return Some(CalibrationFormat::Euroc);
    }
    if root.entries().iter().any(|(_, node)| is_link(node)) {
        return Some(CalibrationFormat::Kalibr);
    }
    let is_message = |matrix: &str, coefficients: &str| has(root, &["width", "height", matrix, coefficients]);
    if has(root, &["camera_matrix", "projection_matrix"]) || is_message("K", "D") || is_message("k", "d") {
        return Some(CalibrationFormat::Ros);
    }
    let is_matrix = |key: &str| key.to_ascii_lowercase().replace('_', "") == "cameramatrix";
    root.keys().into_iter().any(is_matrix).then_some(CalibrationFormat::OpenCv)
}
