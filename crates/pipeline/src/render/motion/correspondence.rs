//! Position and time at which a point is seen in a frame whose rows are exposed one after the other.
//!
//! A point at p(t) is seen in the row y for which the image of p(t(y)) lies at y, where t(y) is the middle of the exposure there
//! ([`FrameView::middle_at_s`]). The iteration y ← image of p(t(y)) reduces errors by |image velocity| × row time, far below 1 for everything that does not
//! outrun the shutter; what does has no single image.

use super::image_point::{ImageTarget, image_point, without_external_optics};
use super::surface_path::{HALF_STEP_S, OwnPoint, SurfacePath};
use crate::render::frame_view::FrameView;
use etendue_core::{CameraPose, Motion};
use glam::DVec2;

/// View of a pixel: its image position, and whether its ray is off the pupil's centre.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PixelView {
    /// Image position, px.
    pub at_px: DVec2,
    /// Second value of `CameraBody::truth_ray`.
    pub off_centre: bool,
}

/// An image of a point.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Correspondence {
    /// Image position, px.
    pub at_px: DVec2,
    /// Simulated time, s.
    pub time_s: f64,
    /// Pose of the camera at that time.
    pub pose: CameraPose,
    /// The point in the camera's frame at that time.
    pub target: ImageTarget,
}

const MAX_STEPS: usize = 64;
/// Step (px) below which the iteration has converged.
const CONVERGED_PX: f64 = 1e-9;

/// Image, in a frame, of the point that is seen from `sight` in another; `None` if it has no image there.
pub(crate) fn correspondence(
    frame: &FrameView<'_>,
    surface: &SurfacePath<'_>,
    pixel_view: PixelView,
) -> Option<Correspondence> {
    let row = pixel_view.at_px.y.max(0.0) as usize;
    let mut at_px = pixel_view.at_px;
    for _ in 0..MAX_STEPS {
        let time_s = frame.middle_at_s(at_px.y, row);
        let pose = frame.pose_at(time_s);
        let target = surface.target_from(&pose, time_s);
        let image_px = image_point(frame.body(), target, at_px, pixel_view.off_centre)?;
        let step_px = (image_px.y - at_px.y).abs();
        at_px = image_px;
        let same_time = frame.middle_at_s(at_px.y, row) == time_s;
        if step_px < CONVERGED_PX || same_time {
            return Some(Correspondence { at_px, time_s, pose, target });
        }
    }
    None
}

/// Velocity of a point's image at a time, px/s, of a camera with an open shutter; `None` without an image.
pub(crate) fn image_velocity(
    frame: &FrameView<'_>,
    surface: &SurfacePath<'_>,
    pixel_view: PixelView,
    time_s: f64,
) -> Option<DVec2> {
    let image = |time_s: f64| {
        let target = surface.target_from(&frame.pose_at(time_s), time_s);
        image_point(frame.body(), target, pixel_view.at_px, pixel_view.off_centre)
    };
    Some((image(time_s + HALF_STEP_S)? - image(time_s - HALF_STEP_S)?) / (2.0 * HALF_STEP_S))
}

/// Image position, px, of a point of an instance's own frame. The search starts where the bare lens would see it. `None` if it has no image, and with
/// mirrors.
pub(crate) fn image_of(frame: &FrameView<'_>, own: OwnPoint<'_>, to_world: &Motion) -> Option<DVec2> {
    let surface = SurfacePath::Point { own, to_world };
    let middle_s = frame.interval().middle_s();
    let at_px = without_external_optics(frame.body(), surface.target_from(&frame.pose_at(middle_s), middle_s))?;
    Some(correspondence(frame, &surface, PixelView { at_px, off_centre: false })?.at_px)
}
