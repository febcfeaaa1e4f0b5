//! Which rays pass: regions of a plane before the input plane, by the ray's height on the input plane.

use super::error::RayTransferError;
use glam::DVec2;

/// An ellipse that rays of a height pass, its axes along the meridian (y) and across it (x), mm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PassEllipse {
    /// Height on the input plane, mm.
    pub height_mm: f64,
    /// Centre.
    pub centre_mm: DVec2,
    /// Semi-axes.
    pub radii_mm: DVec2,
}

/// A circle that rays pass, its centre on the meridian in proportion to the height.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PassCircle {
    /// Radius, mm.
    pub radius_mm: f64,
    /// Height of its centre over the height on the input plane.
    pub sensitivity: f64,
}

/// What of the plane passes.
#[derive(Clone, Debug, PartialEq)]
pub enum PassRegion {
    /// One ellipse, its numbers linear between the heights at which it is known; nothing passes beyond the last.
    Ellipses(Vec<PassEllipse>),
    /// All of some circles.
    Circles(Vec<PassCircle>),
}

/// Which rays pass.
#[derive(Clone, Debug, PartialEq)]
pub struct RayPass {
    /// The plane, from the input plane towards the scene, mm.
    pub(super) plane_mm: f64,
    region: PassRegion,
}

impl RayPass {
    /// Of a region of the plane at `plane_mm` from the input plane.
    ///
    /// # Errors
    /// Where the heights do not rise from 0, the region is empty or a number is none.
    pub fn new(plane_mm: f64, region: PassRegion) -> Result<Self, RayTransferError> {
        let legal = match &region {
            PassRegion::Ellipses(list) => {
                let finite = |e: &PassEllipse| {
                    e.centre_mm.is_finite() && e.radii_mm.is_finite() && e.radii_mm.min_element() >= 0.0
                };
                let rising = list.windows(2).all(|pair| pair[1].height_mm > pair[0].height_mm);
                let first = list.first().is_some_and(|e| e.height_mm == 0.0 && e.radii_mm.min_element() > 0.0);
                first && rising && list.iter().all(|e| finite(e) && e.height_mm.is_finite())
            }
            PassRegion::Circles(list) => {
                let legal = |c: &PassCircle| c.radius_mm > 0.0 && c.radius_mm.is_finite() && c.sensitivity.is_finite();
                !list.is_empty() && list.iter().all(legal)
            }
        };
        if legal && plane_mm.is_finite() { Ok(Self { plane_mm, region }) } else { Err(RayTransferError::Pass) }
    }

    /// Whether a ray of a height passes that meets the plane there (y along the meridian).
    #[inline]
    pub(super) fn passes(&self, height_mm: f64, at_mm: DVec2) -> bool {
        match &self.region {
            PassRegion::Ellipses(list) => ellipse(list, height_mm)
                .is_some_and(|(centre, radii)| ((at_mm - centre) / radii).length_squared() <= 1.0),
            PassRegion::Circles(list) => list.iter().all(|circle| {
                let centre = DVec2::new(0.0, circle.sensitivity * height_mm);
                (at_mm - centre).length_squared() < circle.radius_mm * circle.radius_mm
            }),
        }
    }

    /// The height on the input plane from which on nothing passes, mm; infinite where there is none.
    #[must_use]
    pub fn greatest_height_mm(&self) -> f64 {
        match &self.region {
            PassRegion::Ellipses(list) => list.last().map_or(0.0, |last| last.height_mm),
            PassRegion::Circles(_) => f64::INFINITY,
        }
    }

    /// How far from the axis the region reaches on the axis, mm.
    pub(crate) fn radius_on_axis_mm(&self) -> f64 {
        match &self.region {
            PassRegion::Ellipses(list) => list.first().map_or(0.0, |e| e.radii_mm.max_element() + e.centre_mm.length()),
            PassRegion::Circles(list) => list.iter().map(|c| c.radius_mm).fold(f64::INFINITY, f64::min),
        }
    }
}

/// Centre and semi-axes at a height.
#[inline]
fn ellipse(list: &[PassEllipse], height_mm: f64) -> Option<(DVec2, DVec2)> {
    let after = list.partition_point(|e| e.height_mm < height_mm);
    let right = list.get(after)?;
    let Some(left) = after.checked_sub(1).map(|i| &list[i]) else { return Some((right.centre_mm, right.radii_mm)) };
    let share = (height_mm - left.height_mm) / (right.height_mm - left.height_mm);
    Some((left.centre_mm.lerp(right.centre_mm, share), left.radii_mm.lerp(right.radii_mm, share)))
}
