//! Result of a reader of one format: a camera, or the reason why the text holds none. Also matrices and sizes in the form of OpenCV and ROS.

use etendue_projection::{Calibration, CalibrationError, CameraMatrix};

use super::yaml::Node;
use crate::ErrorCode;
use crate::tree::{Fault, Read};

/// Result of a reader.
pub(super) struct Found {
    pub(super) name: String,
    pub(super) calibration: Calibration,
    pub(super) notes: Vec<String>,
}

impl Found {
    /// The camera, if it is the requested one.
    pub(super) fn chosen(self, camera: Option<&str>) -> Read<(String, Calibration, Vec<String>)> {
        match camera {
            Some(asked) if asked != self.name && self.name.is_empty() => {
                Err(Fault::at(0, format!("contains one camera, which has no name; do not request \"{asked}\"")))
            }
            Some(asked) if asked != self.name => Err(Fault::coded(
                ErrorCode::UnknownName,
                0,
                format!("contains no camera \"{asked}\"; it contains \"{}\"", self.name),
            )),
            _ => Ok((self.name, self.calibration, self.notes)),
        }
    }
}

/// Error of the camera as a whole, reported at the line where it starts.
pub(super) fn of_camera(line: usize) -> impl Fn(CalibrationError) -> Fault {
    move |cause| Fault::at(line, cause.to_string())
}

/// The numbers of a matrix, by rows: OpenCV's rows, cols and data, or plain (nested) lists.
pub(super) fn numbers(node: &Node) -> Read<Vec<f64>> {
    let Some(data) = node.find("data") else { return node.numbers() };
    let (rows, columns) = (node.key("rows")?.count()?, node.key("cols")?.count()?);
    let numbers = data.numbers()?;
    if numbers.len() == rows * columns {
        return Ok(numbers);
    }
    let found = numbers.len();
    Err(Fault::at(data.line, format!("found {found} numbers; expected rows × cols = {rows} × {columns}")))
}

/// A camera matrix with the centre of the top-left pixel at (0, 0), in raster coordinates.
pub(super) fn camera(node: &Node) -> Read<CameraMatrix> {
    let numbers = numbers(node)?;
    let [fx, skew, cx, zero, fy, cy, rest @ ..] = &numbers[..] else {
        return Err(Fault::at(node.line, format!("found {} numbers; expected a 3 × 3 camera matrix", numbers.len())));
    };
    if *zero != 0.0 || rest != [0.0, 0.0, 1.0] {
        return Err(Fault::at(node.line, "expected a camera matrix fx s cx, 0 fy cy, 0 0 1"));
    }
    Ok(CameraMatrix { fx: *fx, fy: *fy, skew: *skew, cx: *cx, cy: *cy }.from_opencv())
}

/// `image_width` and `image_height`, or `image_size` as a list of both.
pub(super) fn size(root: &Node) -> Read<[usize; 2]> {
    if let Some(items) = root.find("image_size").and_then(Node::items)
        && let [width, height] = items
    {
        return Ok([width.count()?, height.count()?]);
    }
    Ok([root.key("image_width")?.count()?, root.key("image_height")?.count()?])
}
