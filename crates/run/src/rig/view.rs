//! How a camera projects and what carries it, for programs that know a camera matrix alone.

use super::intrinsics;
use etendue_core::CameraPose;
use etendue_pipeline::plan::CameraPlan;

/// A camera whose pictures are rectilinear.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PinholeView {
    /// fx, skew, cx, fy, cy, px; raster coordinates: pixel centres are at + 0.5.
    pub matrix_px: [f64; 5],
    /// From the camera's frame (x right, y down, z forward) to the frame of the scene that carries it, m; `None` where none does, or where
    /// the camera moves in it.
    pub mount: Option<CameraPose>,
}

/// The camera matrix of a camera of a plan.
///
/// # Errors
/// The rest of a sentence that begins with the camera: why none describes it.
pub fn pinhole_view(camera: &CameraPlan) -> Result<PinholeView, String> {
    let matrix = intrinsics::pinhole(&camera.body)?;
    let matrix_px = [matrix.fx, matrix.skew, matrix.cx, matrix.fy, matrix.cy];
    Ok(PinholeView { matrix_px, mount: camera_mount(camera) })
}

/// From a camera's frame to the frame of the scene that carries it, m; `None` where none does, or where the camera moves in it.
#[must_use]
pub fn camera_mount(camera: &CameraPlan) -> Option<CameraPose> {
    camera.mount.pose.filter(|_| camera.mount.frame.is_some())
}
