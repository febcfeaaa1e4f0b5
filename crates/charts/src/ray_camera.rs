//! A camera as a function from raster points to rays, its view of a plane, and the inverse function.

use etendue_core::maths::f64::{cos, tan};
use glam::{DMat2, DVec2, DVec3};

use crate::error::ChartError;

/// The ray of a raster point, camera frame (x right, y down, z forward; m).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RasterRay {
    pub origin_m: DVec3,
    /// Unit direction.
    pub direction: DVec3,
}

/// A camera: its image size and the ray of each raster point (top left corner 0, 0; pixel centres at +0.5).
pub struct RayCamera<'a> {
    /// Columns and rows.
    pub size_px: DVec2,
    /// The ray of a raster point; `None` if no light arrives.
    pub ray: &'a dyn Fn(DVec2) -> Option<RasterRay>,
}

/// Maximum angle of rays from the axis for the intersection with the sheet: beyond it the sheet would be unbounded.
const MAX_ANGLE_DEG: f64 = 60.0;
/// Points per side of the image border.
const BORDER: usize = 32;
/// Points per side of the lattice from which an inversion starts.
const LATTICE: usize = 24;
/// Maximum steps of Newton's method.
const STEPS: usize = 40;
/// Newton's method ends at steps below this, px.
const EXACT_PX: f64 = 1e-9;
/// Step of the derivative, px.
const STEP_PX: f64 = 1e-2;

/// A camera's view of the sheet's plane at a distance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Footprint {
    /// Distance of the plane from the entrance pupil, m.
    pub distance_m: f64,
    /// Size of the smallest rectangle about the sheet's centre that contains the whole view, mm.
    pub outer_mm: DVec2,
    /// Size of the largest fully visible rectangle of that shape, mm.
    pub inner_mm: DVec2,
    /// Millimetres per pixel at the image centre.
    pub pixel_mm: f64,
    /// True if the outer rectangle covers the image; wider cameras see beyond it.
    pub fills: bool,
}

impl RayCamera<'_> {
    /// Returns the view of the plane perpendicular to the axis at `distance_m`.
    ///
    /// # Errors
    /// If the camera does not look ahead at the image centre.
    pub fn footprint(&self, distance_m: f64) -> Result<Footprint, ChartError> {
        let middle = self.size_px / 2.0;
        let meets = |at: DVec2| (self.ray)(at).and_then(|ray| on_plane(&ray, distance_m));
        let ahead = |hit: &(DVec2, bool)| hit.1;
        let [left, right] = [-0.5, 0.5].map(|x| meets(middle + DVec2::new(x, 0.0)).filter(ahead));
        let (Some((left, _)), Some((right, _))) = (left, right) else { return Err(sideways()) };
        // If the border is dark, as with a fisheye: the last visible point on the way to it.
        let inwards = |at: DVec2| {
            let on_segment = |i: usize| meets(middle + (at - middle) * (i as f64 / BORDER as f64));
            meets(at).or_else(|| (1..BORDER).rev().find_map(on_segment).map(|(hit, _)| (hit, false)))
        };
        let border: Vec<(DVec2, bool)> = self.border().filter_map(inwards).collect();
        let half = border.iter().fold(DVec2::ZERO, |max_distance, (at, _)| max_distance.max(at.abs()));
        let fraction = border.iter().map(|(at, _)| (at.abs() / half).max_element()).fold(1.0, f64::min);
        let fills = border.iter().all(|(_, is_ahead)| *is_ahead);
        let pixel_mm = 1e3 * (right - left).length();
        Ok(Footprint { distance_m, outer_mm: 2e3 * half, inner_mm: 2e3 * fraction * half, pixel_mm, fills })
    }

    fn border(&self) -> impl Iterator<Item = DVec2> + '_ {
        let along = (0..BORDER).map(|i| i as f64 / BORDER as f64);
        let corners = |t: f64| [(t, 0.0), (1.0, t), (1.0 - t, 1.0), (0.0, 1.0 - t)];
        along.flat_map(corners).map(|(x, y)| DVec2::new(x, y) * self.size_px)
    }

    /// A lattice of rays from which inversions start.
    #[must_use]
    pub fn starts(&self) -> Vec<(DVec2, RasterRay)> {
        let at = |i: usize| (i as f64 + 0.5) / LATTICE as f64;
        let points = (0..LATTICE * LATTICE).map(|i| DVec2::new(at(i % LATTICE), at(i / LATTICE)) * self.size_px);
        points.filter_map(|point| Some((point, (self.ray)(point)?))).collect()
    }

    /// Position in the raster of a point of the camera frame (m), by Newton's method on the rays; `None` outside the image.
    #[must_use]
    pub fn project(&self, starts: &[(DVec2, RasterRay)], point_m: DVec3) -> Option<DVec2> {
        let near = |ray: &RasterRay| ray.direction.dot((point_m - ray.origin_m).normalize_or_zero());
        let (start, _) = starts.iter().max_by(|a, b| near(&a.1).total_cmp(&near(&b.1)))?;
        let raster_px = self.newton(*start, point_m)?;
        let inside = raster_px.cmpge(DVec2::splat(-EXACT_PX)).all() && raster_px.cmple(self.size_px + EXACT_PX).all();
        inside.then_some(raster_px)
    }

    fn newton(&self, start: DVec2, point_m: DVec3) -> Option<DVec2> {
        let mut at = start;
        for _ in 0..STEPS {
            let ray = (self.ray)(at)?;
            let error = ray_offset(&ray, &ray, point_m)?;
            let slope = |step: DVec2| {
                let (sign, other) = [1.0, -1.0].into_iter().find_map(|s| Some((s, (self.ray)(at + s * step)?)))?;
                Some((ray_offset(&ray, &other, point_m)? - error) * (sign / STEP_PX))
            };
            let jacobian = DMat2::from_cols(slope(DVec2::new(STEP_PX, 0.0))?, slope(DVec2::new(0.0, STEP_PX))?);
            let step = jacobian.inverse() * error;
            if !step.is_finite() {
                return None;
            }
            // A step across the whole image is not plausible for a smooth lens: limit it to half of it.
            let longest = self.size_px.max_element() / 2.0;
            at -= step.clamp_length_max(longest);
            at = at.clamp(DVec2::splat(-1.0), self.size_px + 1.0);
            if step.length() < EXACT_PX {
                return Some(at);
            }
        }
        None
    }
}

fn sideways() -> ChartError {
    let message = "the centre of this camera's image does not face forward, so no flat chart fills its field; use a camera without \
                a mirror, or point its lens forward";
    ChartError::Camera(message.to_owned())
}

/// Intersection of a ray with the plane z = distance, m from the axis, and true if it is near enough to the axis; farther ones
/// are clamped to the widest angle in their direction.
fn on_plane(ray: &RasterRay, distance_m: f64) -> Option<(DVec2, bool)> {
    let widest = MAX_ANGLE_DEG.to_radians();
    let across = ray.direction.truncate();
    if ray.direction.z > cos(widest) {
        let t = (distance_m - ray.origin_m.z) / ray.direction.z;
        return (t > 0.0).then(|| (ray.origin_m.truncate() + t * across, true));
    }
    Some((distance_m * tan(widest) * across.normalize_or_zero(), false))
}

/// Error of a ray's direction relative to a point: its components perpendicular to the direction in which `about` should look,
/// over its component along it. `None` for rays that look away.
fn ray_offset(reference: &RasterRay, ray: &RasterRay, point_m: DVec3) -> Option<DVec2> {
    let axis = (point_m - reference.origin_m).try_normalize()?;
    let (x, y) = axis.any_orthonormal_pair();
    let towards = (point_m - ray.origin_m).try_normalize()?;
    let (d, u) = (ray.direction, towards);
    let (along_d, along_u) = (d.dot(axis), u.dot(axis));
    (along_d > 0.0 && along_u > 0.0)
        .then(|| DVec2::new(d.dot(x), d.dot(y)) / along_d - DVec2::new(u.dot(x), u.dot(y)) / along_u)
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: DVec2 = DVec2::new(640.0, 480.0);

    /// A pinhole of 500 px with barrel distortion.
    fn barrel(at: DVec2) -> Option<RasterRay> {
        let p = (at - SIZE / 2.0) / 500.0;
        let ideal = p * (1.0 + 0.2 * p.length_squared());
        Some(RasterRay { origin_m: DVec3::ZERO, direction: ideal.extend(1.0).normalize() })
    }

    #[test]
    fn projection_inverts_the_rays() {
        let ray_camera = RayCamera { size_px: SIZE, ray: &barrel };
        let starts = ray_camera.starts();
        for (x, y) in [(0.0, 0.0), (3.25, 470.0), (320.0, 240.0), (639.9, 0.1), (100.7, 300.3)] {
            let at = DVec2::new(x, y);
            let ray = barrel(at).expect("everywhere");
            let result = ray_camera.project(&starts, ray.origin_m + 2.5 * ray.direction).expect("inside");
            assert!((result - at).length() < 1e-7, "{at} {result}");
        }
        assert_eq!(ray_camera.project(&starts, DVec3::new(3.0, 0.0, 1.0)), None);
        assert_eq!(ray_camera.project(&starts, DVec3::new(0.1, 0.0, -1.0)), None);
    }

    #[test]
    fn a_footprint_holds_the_field() {
        let ray_camera = RayCamera { size_px: SIZE, ray: &barrel };
        let footprint = ray_camera.footprint(2.0).expect("ahead");
        // The corner: p = (0.64, 0.48), r² = 0.64, ideal = 1.128 p.
        assert!((footprint.outer_mm - 4000.0 * 1.128 * DVec2::new(0.64, 0.48)).length() < 1e-9, "{footprint:?}");
        // The limiting point: the middle of the upper side, ideal y = 0.48 (1 + 0.2 · 0.2304).
        let fraction = (1.0 + 0.2 * 0.2304) / 1.128;
        assert!((footprint.inner_mm - fraction * footprint.outer_mm).length() < 1e-9);
        assert!((footprint.pixel_mm - 4.0).abs() < 1e-5 && footprint.fills);
    }

    #[test]
    fn a_wide_camera_is_limited_to_60_degrees_and_a_sideways_one_refused() {
        let equidistant = |at: DVec2| {
            let p = (at - SIZE / 2.0) / 200.0;
            let theta = p.length();
            let (s, c) = etendue_core::maths::f64::sin_cos(theta);
            let across = p.normalize_or_zero() * s;
            (theta < 1.15).then_some(RasterRay { origin_m: DVec3::ZERO, direction: across.extend(c) })
        };
        let ray_camera = RayCamera { size_px: SIZE, ray: &equidistant };
        let footprint = ray_camera.footprint(1.0).expect("ahead");
        assert!(!footprint.fills && (footprint.outer_mm.x - 2000.0 * 3.0_f64.sqrt()).abs() < 1e-6, "{footprint:?}");
        let mirrored = |_| Some(RasterRay { origin_m: DVec3::ZERO, direction: DVec3::X });
        let ray_camera = RayCamera { size_px: SIZE, ray: &mirrored };
        assert!(matches!(ray_camera.footprint(1.0), Err(ChartError::Camera(_))));
    }
}
