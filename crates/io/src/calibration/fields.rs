//! Result of a reader of one format: a camera, or the reason why the text holds none. Also matrices and sizes in the form of OpenCV and ROS.

use etendue_projection::{Calibration, CalibrationError, CameraMatrix};

use super::yaml::TreeNode;
use crate::ErrorCode;
use crate::tree::{TreeError, TreeResult};

/// Result of a reader.
pub(super) struct ReaderResult {
    pub(super) name: String,
    pub(super) calibration: Calibration,
    pub(super) notes: Vec<String>,
}

impl ReaderResult {
    /// The camera, if it is the requested one.
    pub(super) fn chosen(self, camera: Option<&str>) -> TreeResult<(String, Calibration, Vec<String>)> {
        match camera {
            Some(requested) if requested != self.name && self.name.is_empty() => {
                Err(TreeError::at(0, format!("contains one camera, which has no name; do not request \"{requested}\"")))
            }
            Some(requested) if requested != self.name => Err(TreeError::coded(
                ErrorCode::UnknownName,
                0,
                format!("contains no camera \"{requested}\"; it contains \"{}\"", self.name),
            )),
            _ => Ok((self.name, self.calibration, self.notes)),
        }
    }
}

/// Error of the camera as a whole, reported at the line where it starts.
pub(super) fn camera_error(line: usize) -> impl Fn(CalibrationError) -> TreeError {
    move |cause| TreeError::at(line, cause.to_string())
}

/// The numbers of a matrix, by rows: OpenCV's rows, cols and data, or plain (nested) lists.
pub(super) fn numbers(node: &TreeNode) -> TreeResult<Vec<f64>> {
    let Some(data) = node.find("data") else { return node.numbers() };
    let (rows, columns) = (node.key("rows")?.count()?, node.key("cols")?.count()?);
    let numbers = data.numbers()?;
    if numbers.len() == rows * columns {
        return Ok(numbers);
    }
    let actual = numbers.len();
    Err(TreeError::at(
        data.line,
        format!("the number of values is {actual}; expected rows × cols = {rows} × {columns}"),
    ))
}

/// A camera matrix with the centre of the top-left pixel at (0, 0), in raster coordinates.
pub(super) fn camera(node: &TreeNode) -> TreeResult<CameraMatrix> {
    let numbers = numbers(node)?;
    let [fx, skew, cx, zero, fy, cy, rest @ ..] = &numbers[..] else {
        return Err(TreeError::at(
            node.line,
            format!("the number of values is {}; expected a 3 × 3 camera matrix", numbers.len()),
        ));
    };
    if *zero != 0.0 || rest != [0.0, 0.0, 1.0] {
        return Err(TreeError::at(node.line, "expected a camera matrix fx s cx, 0 fy cy, 0 0 1"));
    }
    Ok(CameraMatrix { fx: *fx, fy: *fy, skew: *skew, cx: *cx, cy: *cy }.from_opencv())
}

/// `image_width` and `image_height`, or `image_size` as a list of both.
pub(super) fn size(root: &TreeNode) -> TreeResult<[usize; 2]> {
    if let Some(items) = root.find("image_size").and_then(TreeNode::items)
        && let [width, height] = items
    {
        return Ok([width.count()?, height.count()?]);
    }
    Ok([root.key("image_width")?.count()?, root.key("image_height")?.count()?])
}
