//! What a reader of one format answers: a camera, or why the text holds none.

use crate::ErrorCode;
use crate::tree::{Fault, Read};
use etendue_projection::{Calibration, CalibrationError};

/// What a reader found.
pub(super) struct Found {
    pub(super) name: String,
    pub(super) calibration: Calibration,
    pub(super) notes: Vec<String>,
}

impl Found {
    /// The camera, if it is the one asked for.
    pub(super) fn chosen(self, camera: Option<&str>) -> Read<(String, Calibration, Vec<String>)> {
        match camera {
            Some(asked) if asked != self.name && self.name.is_empty() => {
                Err(Fault::at(0, format!("holds one camera without a name; do not ask for \"{asked}\"")))
            }
            Some(asked) if asked != self.name => Err(Fault::coded(
                ErrorCode::UnknownName,
                0,
                format!("holds no camera \"{asked}\"; it holds \"{}\"", self.name),
            )),
            _ => Ok((self.name, self.calibration, self.notes)),
        }
    }
}

/// A fault of the camera as a whole, told at the line where it starts.
pub(super) fn of_camera(line: usize) -> impl Fn(CalibrationError) -> Fault {
    move |cause| Fault::at(line, cause.to_string())
}
