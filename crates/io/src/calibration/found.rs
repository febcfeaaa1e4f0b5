//! What a reader of one format answers: a camera, or why the text holds none.

use crate::Error;
use etendue_projection::{Calibration, CalibrationError};
use std::path::Path;

/// What is wrong, and in which line (from 1; 0 for the whole file).
#[derive(Debug)]
pub(super) struct Fault {
    pub(super) line: usize,
    pub(super) what: String,
}

pub(super) type Read<T> = Result<T, Fault>;

impl Fault {
    pub(super) fn at(line: usize, what: impl Into<String>) -> Self {
        Self { line, what: what.into() }
    }

    pub(super) fn of(self, file: &Path) -> Error {
        if self.line == 0 { Error::new(file, self.what) } else { Error::at(file, self.line, self.what) }
    }
}

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
            Some(asked) if asked != self.name => {
                Err(Fault::at(0, format!("holds no camera \"{asked}\"; it holds \"{}\"", self.name)))
            }
            _ => Ok((self.name, self.calibration, self.notes)),
        }
    }
}

/// A note of keys that say nothing of the camera.
pub(super) fn passed_over(keys: &[&str]) -> Vec<String> {
    if keys.is_empty() { Vec::new() } else { vec![format!("passed over: {}", keys.join(", "))] }
}

/// A fault of the camera as a whole, told at the line where it starts.
pub(super) fn of_camera(line: usize) -> impl Fn(CalibrationError) -> Fault {
    move |cause| Fault::at(line, cause.to_string())
}
