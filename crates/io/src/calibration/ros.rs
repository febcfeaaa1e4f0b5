//! ROS `camera_info` YAML (camera_calibration_parsers): the raw picture, before rectification.
//!
//! | distortion_model | coefficients |
//! | --- | --- |
//! | plumb_bob | k1, k2, p1, p2 (, k3) |
//! | rational_polynomial | k1, k2, p1, p2, k3, k4, k5, k6 (, s1 … s4 (, τx, τy)) |
//! | equidistant | k1, k2, k3, k4 of the polynomial fisheye |
//!
//! The rectification and projection matrices describe the rectified picture, so they are passed over.

use etendue_projection::model::Perspective;
use etendue_projection::{Calibration, Model};

use super::yaml::{self, Node};
use super::{ErrorCode, Fault, Found, Read, matrix, of_camera, opencv, passed_over};

const KNOWN: [&str; 6] =
    ["image_width", "image_height", "camera_name", "camera_matrix", "distortion_model", "distortion_coefficients"];

pub(super) fn read(text: &str) -> Read<Found> {
    let root = yaml::parse(text)?;
    let size_px = [root.key("image_width")?.count()?, root.key("image_height")?.count()?];
    let node = root.key("camera_matrix")?;
    let camera_matrix = matrix::camera(node)?;
    if camera_matrix.skew != 0.0 {
        return Err(Fault::coded(
            ErrorCode::UnsupportedFile,
            node.line,
            "expected a camera matrix without skew, as camera_info defines it",
        ));
    }
    let model = model(root.key("distortion_model")?, root.key("distortion_coefficients")?)?;
    let calibration = Calibration::new(model, camera_matrix, size_px).map_err(of_camera(node.line))?;
    let name = root.find("camera_name").map(Node::text).transpose()?.unwrap_or_default().to_owned();
    Ok(Found { name, calibration, notes: passed_over(&root.others(&KNOWN)) })
}

fn model(name: &Node, coefficients: &Node) -> Read<Model> {
    let k = matrix::numbers(coefficients)?;
    let counts: &[usize] = match name.text()? {
        "plumb_bob" => &[4, 5],
        "rational_polynomial" => &[8, 12, 14],
        "equidistant" => return opencv::fisheye(coefficients.line, &k),
        other => {
            let known = "plumb_bob, rational_polynomial, equidistant";
            return Err(Fault::coded(
                ErrorCode::UnsupportedFile,
                name.line,
                format!("the distortion model {other} is none of {known}"),
            ));
        }
    };
    if !counts.contains(&k.len()) {
        let counts = counts.iter().map(usize::to_string).collect::<Vec<_>>().join(" or ");
        let what = format!("found {} numbers; {} has {counts}", k.len(), name.text()?);
        return Err(Fault::at(coefficients.line, what));
    }
    Perspective::from_opencv(&k).map(Model::Perspective).map_err(opencv::wrong(coefficients.line))
}
