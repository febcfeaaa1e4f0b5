//! Where a camera sees a point: the inverse of the ray by which ground truth looks.
//!
//! - Without wind-screen or mirror the lens's own projection of directions is used. A real pupil moves with the field, so that the
//!   direction of a near point is not that from the pupil's centre: projection and the principal ray's origin are iterated, which
//!   shrinks the error by the pupil's shift over the distance each time.
//! - Behind a wind-screen, by a mirror, of a telecentric camera and through the open part of a clipped pupil there is no projection in closed
//!   form: Newton's method finds the ray that meets the point, from the place where the point was seen last. Of several images it
//!   follows that one; where the ray ends on the way (the rim of a mirror, the end of the field) there is none.

use crate::plan::CameraBody;
use etendue_optics::front::Optic;
use etendue_optics::{FrontRay, Lens};
use glam::{DMat2, DVec2, DVec3};

/// What is looked for, in the camera's frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Target {
    /// A point, m.
    Point(DVec3),
    /// A direction: something infinitely far.
    Direction(DVec3),
}

impl Target {
    /// The unit direction in which it is seen from a point (m).
    pub(crate) fn direction_from(self, origin_m: DVec3) -> Option<DVec3> {
        match self {
            Self::Point(point_m) => (point_m - origin_m).try_normalize(),
            Self::Direction(direction) => direction.try_normalize(),
        }
    }
}

const MAX_STEPS: usize = 32;
/// A step (px) after which an image point is found.
const CLOSE_PX: f64 = 1e-9;

/// Where a camera sees a target (raster, px), within the picture or beyond; `None` where it has no image. `near_px` is where it was seen
/// last, by a ray `off_centre` as `CameraBody::truth_ray` tells it.
pub(crate) fn image_point(body: &CameraBody, target: Target, near_px: DVec2, off_centre: bool) -> Option<DVec2> {
    let bends = body.front.as_ref().is_some_and(|front| front.optic().is_some());
    if bends || off_centre || matches!(body.lens, Lens::Telecentric(_)) {
        followed(body, target, near_px)
    } else {
        projected(body, target)
    }
}

/// Where the lens would see a target (px) if nothing stood before it; of a telecentric camera the middle of the picture. `None` where it has no
/// image, and by a mirror, before which the target is elsewhere.
pub(super) fn unbent(body: &CameraBody, target: Target) -> Option<DVec2> {
    let by_mirror = body.front.as_ref().is_some_and(|front| matches!(front.optic(), Some(Optic::Mirror(_))));
    match body.lens {
        _ if by_mirror => None,
        Lens::Telecentric(_) => Some(body.raster.principal_px()),
        _ => projected(body, target),
    }
}

fn projected(body: &CameraBody, target: Target) -> Option<DVec2> {
    let mut at_mm = body.lens.project(target.direction_from(DVec3::ZERO)?)?;
    if matches!(body.lens, Lens::Prescription(_) | Lens::RayTransfer(_)) {
        for _ in 0..MAX_STEPS {
            // Where the principal ray is clipped, that of the pupil's centre stays.
            let Some(ray) = body.lens.principal_ray(at_mm) else { break };
            let before_mm = at_mm;
            at_mm = body.lens.project(target.direction_from(ray.origin_m)?)?;
            if (at_mm - before_mm).length() < CLOSE_PX * body.raster.pitch_mm().x {
                break;
            }
        }
    }
    Some(body.raster.raster_px(at_mm))
}

/// Newton's method with differences over a hundredth of a pixel, about the place where the target was seen last.
fn followed(body: &CameraBody, target: Target, near_px: DVec2) -> Option<DVec2> {
    const DIFFERENCE_PX: f64 = 0.01;
    let axes = {
        let (ray, _) = body.truth_ray(near_px)?;
        ray.ray.direction.any_orthonormal_pair()
    };
    // How far a ray passes the target by, as the difference of unit directions.
    let miss = |at_px: DVec2| {
        let (FrontRay { ray, .. }, _) = body.truth_ray(at_px)?;
        let miss = ray.direction - target.direction_from(ray.origin_m)?;
        Some(DVec2::new(miss.dot(axes.0), miss.dot(axes.1)))
    };
    let longest_px = 0.25 * body.raster.width().max(body.raster.height()) as f64;
    let mut at_px = near_px;
    for _ in 0..MAX_STEPS {
        let here = miss(at_px)?;
        let slope = |side: DVec2| Some((miss(at_px + side)? - miss(at_px - side)?) / (2.0 * DIFFERENCE_PX));
        let jacobian = DMat2::from_cols(slope(DVec2::X * DIFFERENCE_PX)?, slope(DVec2::Y * DIFFERENCE_PX)?);
        let step = jacobian.inverse() * here;
        if !step.is_finite() {
            return None;
        }
        at_px -= step.clamp_length_max(longest_px);
        if step.length() < CLOSE_PX {
            return Some(at_px);
        }
    }
    None
}
