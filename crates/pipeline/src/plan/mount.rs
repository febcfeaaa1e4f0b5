//! Where a camera is fixed: what is known of its pose without a time.

use etendue_core::CameraPose;

/// The frame that carries a camera, and its pose there.
#[derive(Clone, Debug, PartialEq)]
pub struct Mount {
    /// The frame of the scene; `None` is the world.
    pub frame: Option<String>,
    /// From the camera frame (x right, y down, z forward; origin at the centre of the entrance pupil) to that frame, m; `None` where the
    /// camera moves in it.
    pub pose: Option<CameraPose>,
}
