//! Whether a picture is one that a lens could make: neither all of it at the edge of the field, nor bent beyond use.

use crate::error::OpticsError;

/// Focal lengths that a picture may reach from its principal point: 89.994° of a lens without distortion.
const WIDEST: f64 = 1e4;
/// By how much a distortion may stretch or shrink a distance from the principal point.
const WILD: f64 = 1e3;

/// Parts of the picture's reach at which a distortion is looked at.
pub(super) const ALL: [f64; 3] = [1e-3, 0.1, 1.0];
/// Those near the principal point.
pub(super) const NEAR: [f64; 2] = [1e-4, 1e-3];

/// Checks a picture that reaches `radius_mm` from the principal point of a lens. `ideal` is the distance at which a lens without
/// distortion would show what is seen at a distance, mm; `None` where nothing is.
pub(super) fn check(
    radius_mm: f64,
    focal_length_mm: f64,
    parts: &[f64],
    ideal: impl Fn(f64) -> Option<f64>,
) -> Result<(), OpticsError> {
    if radius_mm > WIDEST * focal_length_mm {
        return Err(OpticsError::TooWide { radius_mm, focal_length_mm });
    }
    let at = parts.iter().map(|part| part * radius_mm).find_map(|radius_mm| {
        let ratio = ideal(radius_mm).map_or(f64::NAN, |ideal_mm| ideal_mm / radius_mm);
        let sane = (1.0 / WILD..=WILD).contains(&ratio);
        (!sane).then_some(OpticsError::WildDistortion { radius_mm, ratio })
    });
    at.map_or(Ok(()), Err)
}
