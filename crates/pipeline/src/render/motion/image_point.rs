//! Image of a point: the inverse of the ground truth's ray.
//!
//! - Without windscreen or mirror the lens's own projection of directions is used. A real pupil moves with the field, so that the
//!   direction of a near point is not that from the pupil's centre: projection and the principal ray's origin are iterated. Each
//!   iteration reduces the error by the ratio of the pupil's shift to the distance.
//! - Behind a windscreen, by a mirror, of a telecentric camera and through the open part of a clipped pupil there is no closed-form
//!   projection: Newton's method finds the ray that meets the point, from the position where the point was seen last. Of several images it
//!   follows that one; where the ray ends on the way (the edge of a mirror, the end of the field) there is none.

use crate::plan::CameraBody;
use etendue_optics::front::Optic;
use etendue_optics::{FrontRay, Lens};
use glam::{DMat2, DVec2, DVec3};

/// Target of the search, in the camera's frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum ImageTarget {
    /// A point, m.
    Point(DVec3),
    /// A direction: an infinitely distant point.
    Direction(DVec3),
}

impl ImageTarget {
    /// Unit direction of the target from a point (m).
    pub(crate) fn direction_from(self, origin_m: DVec3) -> Option<DVec3> {
        match self {
            Self::Point(point_m) => (point_m - origin_m).try_normalize(),
            Self::Direction(direction) => direction.try_normalize(),
        }
    }
}

const MAX_STEPS: usize = 32;
/// Step (px) below which the iteration has converged.
const CONVERGED_PX: f64 = 1e-9;

/// Image position of a target (raster, px), inside or outside the image; `None` if it has no image. `near_px` is its last known position, seen by a ray with
/// the value `off_centre` of `CameraBody::truth_ray`.
pub(crate) fn image_point(body: &CameraBody, target: ImageTarget, near_px: DVec2, off_centre: bool) -> Option<DVec2> {
    let bends = body.front.as_ref().is_some_and(|front| front.optic().is_some());
    if bends || off_centre || matches!(body.lens, Lens::Telecentric(_)) {
        search_near(body, target, near_px)
    } else {
        project(body, target)
    }
}

/// Image position (px) of a target with nothing before the lens; for a telecentric camera the centre of the image. `None` if it has no image, and with a
/// mirror, before which the target is elsewhere.
pub(super) fn without_external_optics(body: &CameraBody, target: ImageTarget) -> Option<DVec2> {
    let by_mirror = body.front.as_ref().is_some_and(|front| matches!(front.optic(), Some(Optic::Mirror(_))));
    match body.lens {
        _ if by_mirror => None,
        Lens::Telecentric(_) => Some(body.raster.principal_px()),
        _ => project(body, target),
    }
}

fn project(body: &CameraBody, target: ImageTarget) -> Option<DVec2> {
    let mut at_mm = body.lens.project(target.direction_from(DVec3::ZERO)?)?;
    if matches!(body.lens, Lens::Prescription(_) | Lens::RayTransfer(_)) {
        for _ in 0..MAX_STEPS {
            // If the principal ray is clipped, that of the pupil's centre is kept.
            let Some(ray) = body.lens.principal_ray(at_mm) else { break };
            let before_mm = at_mm;
            at_mm = body.lens.project(target.direction_from(ray.origin_m)?)?;
            if (at_mm - before_mm).length() < CONVERGED_PX * body.raster.pitch_mm().x {
                break;
            }
        }
    }
    Some(body.raster.raster_px(at_mm))
}

/// Newton's method with differences over a hundredth of a pixel, starting at the last known position.
fn search_near(body: &CameraBody, target: ImageTarget, near_px: DVec2) -> Option<DVec2> {
    const DIFFERENCE_PX: f64 = 0.01;
    let axes = {
        let (ray, _) = body.truth_ray(near_px)?;
        ray.ray.direction.any_orthonormal_pair()
    };
    // Miss of the target by a ray, as the difference of unit directions.
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
        if step.length() < CONVERGED_PX {
            return Some(at_px);
        }
    }
    None
}
