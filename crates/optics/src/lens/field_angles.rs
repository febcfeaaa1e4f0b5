//! Interpolated field angles of chief rays over the image, and a check that a lens could form the image.

use etendue_core::maths::f64::sin_cos;
use glam::{DVec2, DVec3};

use crate::error::OpticsError;

/// Field angles (rad) at radii 0, step, 2 step, … mm.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct FieldAngles {
    pub(crate) step_mm: f64,
    pub(crate) angles: Vec<f64>,
}

impl FieldAngles {
    pub(crate) fn direction(&self, sensor_mm: DVec2) -> Option<DVec3> {
        let radius_mm = sensor_mm.length();
        let (sin, cos) = sin_cos(self.angle(radius_mm)?);
        let outwards = if radius_mm > 0.0 { sensor_mm / radius_mm } else { DVec2::ZERO };
        Some((outwards * sin).extend(cos))
    }

    /// The field angle of a radius; `None` beyond the table, which ends with the image or the lens.
    fn angle(&self, radius_mm: f64) -> Option<f64> {
        let place = radius_mm / self.step_mm;
        let last = self.angles.len().checked_sub(2)?;
        if place > (last + 1) as f64 {
            return None;
        }
        let i = (place as usize).min(last);
        Some(cubic(self.around(i), place - i as f64))
    }

    /// Four angles about the interval `i`: odd about the axis, linear beyond the end.
    fn around(&self, i: usize) -> [f64; 4] {
        let a = &self.angles;
        let before = if i == 0 { -a[1] } else { a[i - 1] };
        let after = a.get(i + 2).copied().unwrap_or(2.0 * a[i + 1] - a[i]);
        [before, a[i], a[i + 1], after]
    }
}

/// The cubic from `b` (t = 0) to `c` (t = 1) with the slopes of the neighbours' chords.
fn cubic([a, b, c, d]: [f64; 4], t: f64) -> f64 {
    let (start, end) = (0.5 * (c - a), 0.5 * (d - b));
    let rest = c - b;
    b + t * (start + t * (3.0 * rest - 2.0 * start - end + t * (start + end - 2.0 * rest)))
}

/// Maximum extent of an image from its principal point, in focal lengths: 89.994° of a lens without distortion.
const MAX_EXTENT: f64 = 1e4;
/// Maximum factor by which a distortion may stretch or shrink a distance from the principal point.
const MAX_STRETCH: f64 = 1e3;

/// Fractions of the image's extent at which a distortion is checked.
pub(super) const ALL: [f64; 3] = [1e-3, 0.1, 1.0];
/// The fractions near the principal point.
pub(super) const NEAR: [f64; 2] = [1e-4, 1e-3];

/// Checks an image that reaches `radius_mm` from the principal point of a lens. `ideal` maps an observed distance to that of a lens without
/// distortion, mm; `None` if there is no direction.
pub(super) fn check(
    radius_mm: f64,
    focal_length_mm: f64,
    parts: &[f64],
    ideal: impl Fn(f64) -> Option<f64>,
) -> Result<(), OpticsError> {
    if radius_mm > MAX_EXTENT * focal_length_mm {
        return Err(OpticsError::TooWide { radius_mm, focal_length_mm });
    }
    let at = parts.iter().map(|part| part * radius_mm).find_map(|radius_mm| {
        let ratio = ideal(radius_mm).map_or(f64::NAN, |ideal_mm| ideal_mm / radius_mm);
        let sane = (1.0 / MAX_STRETCH..=MAX_STRETCH).contains(&ratio);
        (!sane).then_some(OpticsError::WildDistortion { radius_mm, ratio })
    });
    at.map_or(Ok(()), Err)
}
