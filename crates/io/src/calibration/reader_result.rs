//! Result of a reader of one format: a camera, or the reason why the text holds none. Also matrices in the form of OpenCV and ROS.

use etendue_projection::{Calibration, CalibrationError, CameraMatrix, Model};

use super::yaml::{TreeNode, list};
use crate::ErrorCode;
use crate::tree::{TreeError, TreeResult};

/// Result of a reader.
pub(super) struct ReaderResult {
    pub(super) name: String,
    pub(super) calibration: Calibration,
    /// False if the file states no image size; that of the calibration is then arbitrary.
    pub(super) states_size: bool,
    pub(super) notes: Vec<String>,
}

impl ReaderResult {
    /// Camera of a file that states the image size.
    pub(super) fn new(name: impl Into<String>, calibration: Calibration, notes: Vec<String>) -> Self {
        Self { name: name.into(), calibration, states_size: true, notes }
    }

    /// Camera of a file that may state no image size. `line` is that of the camera, for errors.
    pub(super) fn with_size(
        model: Model,
        matrix: CameraMatrix,
        size_px: Option<[usize; 2]>,
        line: usize,
    ) -> TreeResult<Self> {
        // Any size is legal until the sensor's replaces it; the principal point is about half of the image.
        let side = |centre: f64| (2.0 * centre).round().clamp(1.0, 1e6) as usize;
        let calibration = Calibration::new(model, matrix, size_px.unwrap_or([side(matrix.cx), side(matrix.cy)]))
            .map_err(camera_error(line))?;
        Ok(Self { name: String::new(), calibration, states_size: size_px.is_some(), notes: Vec::new() })
    }

    /// The camera, if it is the requested one.
    pub(super) fn chosen(self, camera: Option<&str>) -> TreeResult<Self> {
        match camera {
            Some(requested) if requested != self.name && self.name.is_empty() => {
                Err(TreeError::at(0, format!("contains one camera, which has no name; do not request \"{requested}\"")))
            }
            Some(requested) if requested != self.name => Err(missing_camera(requested, &[&self.name])),
            _ => Ok(self),
        }
    }
}

/// Index of the requested camera, or of the only one.
pub(super) fn choose(names: &[&str], requested: Option<&str>) -> TreeResult<usize> {
    match (names, requested) {
        (_, Some(requested)) => {
            names.iter().position(|name| *name == requested).ok_or_else(|| missing_camera(requested, names))
        }
        ([_], None) => Ok(0),
        _ => Err(TreeError::coded(
            ErrorCode::UnknownName,
            0,
            format!("contains the cameras {}; select one by its name", list(names)),
        )),
    }
}

fn missing_camera(requested: &str, names: &[&str]) -> TreeError {
    let names = match names {
        [only] => format!("\"{only}\""),
        _ => list(names),
    };
    TreeError::coded(ErrorCode::UnknownName, 0, format!("contains no camera \"{requested}\"; it contains {names}"))
}

/// Error of the camera as a whole, reported at the line where it starts.
pub(super) fn camera_error(line: usize) -> impl Fn(CalibrationError) -> TreeError {
    move |cause| TreeError::at(line, cause.to_string())
}

/// The numbers of a matrix, by rows: OpenCV's rows, cols and data, or plain (nested) lists.
pub(super) fn numbers(node: &TreeNode) -> TreeResult<Vec<f64>> {
    let Some(data) = node.find("data") else { return node.numbers() };
    let (rows, columns) = (side(node.key("rows")?)?, side(node.key("cols")?)?);
    let numbers = data.numbers_or_none()?;
    if numbers.len() == rows * columns {
        return Ok(numbers);
    }
    let actual = numbers.len();
    Err(TreeError::at(data.line, format!("found {actual} numbers; expected rows × cols = {rows} × {columns}")))
}

/// Number of rows or columns of a matrix, which may be empty.
fn side(node: &TreeNode) -> TreeResult<usize> {
    if node.text().is_ok_and(|text| text == "0") { Ok(0) } else { node.count() }
}

/// A camera matrix with the centre of the top-left pixel at (0, 0), in raster coordinates.
pub(super) fn camera(node: &TreeNode) -> TreeResult<CameraMatrix> {
    let numbers = numbers(node)?;
    let [fx, skew, cx, zero, fy, cy, rest @ ..] = &numbers[..] else {
        return Err(TreeError::at(
            node.line,
            format!("found {} numbers; expected a 3 × 3 camera matrix", numbers.len()),
        ));
    };
    if *zero != 0.0 || rest != [0.0, 0.0, 1.0] {
        return Err(TreeError::at(node.line, "expected a camera matrix fx s cx, 0 fy cy, 0 0 1"));
    }
    Ok(CameraMatrix { fx: *fx, fy: *fy, skew: *skew, cx: *cx, cy: *cy }.from_opencv())
}
