//! What of the rear pupil is open to a sensor point, found by tracing.
//!
//! In slopes (see `meridian.rs`) the open part at one wavelength is nearly an intersection of discs: one for each rim that
//! clips. It is symmetric about the meridional plane and, being nearly convex, star-shaped about the middle of the interval
//! in which it meets that plane.

use super::meridian::Meridian;
use crate::prescription::Prescription;
use crate::prescription::indices::Media;
use crate::prescription::trace::Rims;
use etendue_core::maths::f64::sin_cos;
use glam::DVec2;

/// One sensor height and wavelength.
pub(super) struct Opening<'a> {
    pub(super) lens: &'a Prescription,
    pub(super) media: &'a Media,
    pub(super) meridian: Meridian,
}

/// Steps of the search along the meridian: the smallest pupil found is this part of the rear opening.
const SCAN: usize = 1024;
/// Bisections of the scan's step.
const HALVINGS: usize = 24;

impl Opening<'_> {
    pub(super) fn passes(&self, t: DVec2) -> bool {
        self.lens.passes(self.meridian.ray(t), self.media, Rims::Clip).is_ok()
    }

    /// The interval of meridional slopes that passes, from its first to its last point; `None` where none does. `seed`
    /// is a slope likely to be inside (the chief ray's).
    pub(super) fn meridional(&self, seed: Option<f64>) -> Option<[f64; 2]> {
        let along = |x: f64| self.passes(DVec2::new(x, 0.0));
        let [low, high] = rear_slopes(self.lens, self.meridian.s_mm);
        let at = |i: usize| low + (high - low) * i as f64 / SCAN as f64;
        let scanned = (0..=SCAN).find(|i| along(at(*i))).map(at);
        let first = scanned.or_else(|| seed.filter(|x| along(*x)))?;
        let last = (0..=SCAN).rev().find(|i| along(at(*i))).map_or(first, at);
        let step = (high - low) / SCAN as f64;
        let edge = |inside: f64, sign: f64| {
            let mut bracket = [inside, inside + sign * step];
            for _ in 0..HALVINGS {
                let middle = 0.5 * (bracket[0] + bracket[1]);
                bracket[usize::from(!along(middle))] = middle;
            }
            bracket[0]
        };
        Some([edge(first, -1.0), edge(last, 1.0)])
    }

    /// The outermost slope that passes from `centre` along `direction`, as a multiple of it: searched inwards from `far`
    /// in `steps`, then by `halvings` to the last place that passes. 0 where none does.
    pub(super) fn reach(&self, centre: DVec2, direction: DVec2, far: f64, steps: usize, halvings: usize) -> f64 {
        let along = |r: f64| self.passes(centre + direction * r);
        let step = far / steps as f64;
        let Some(inside) = (0..steps).rev().map(|i| step * i as f64).find(|r| along(*r)) else { return 0.0 };
        let mut bracket = [inside, inside + step];
        for _ in 0..halvings {
            let middle = 0.5 * (bracket[0] + bracket[1]);
            bracket[usize::from(!along(middle))] = middle;
        }
        bracket[0]
    }
}

/// Slopes in the meridional plane at which the rear opening can be reached at all.
fn rear_slopes(lens: &Prescription, s_mm: f64) -> [f64; 2] {
    let [near, far] = lens.rear_distances_mm();
    let radius = lens.surfaces().last().map_or(0.0, |surface| surface.semi_aperture_mm);
    let corners = [radius - s_mm, -radius - s_mm].map(|y| [y / near, y / far]);
    let all = corners.into_iter().flatten();
    [all.clone().fold(f64::INFINITY, f64::min), all.fold(f64::NEG_INFINITY, f64::max)]
}

/// The unit vector at an angle from the meridian.
pub(super) fn unit(angle: f64) -> DVec2 {
    let (s, c) = sin_cos(angle);
    DVec2::new(c, s)
}
