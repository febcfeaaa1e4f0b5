//! The rectilinear (perspective, gnomonic) projection, in which straight lines stay straight, and the errors of models.
//!
//! x = c · X / Z, y = c · Y / Z, with c the principal distance: the focal length of a lens focused at infinity, longer at nearer focus. Covers less
//! than 180°: directions with Z ≤ 0 have no image.

use glam::{DVec2, DVec3};

/// The rectilinear projection of a camera with one principal distance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rectilinear {
    /// Principal distance c, mm.
    pub principal_distance_mm: f64,
}

impl Rectilinear {
    /// The ideal point (mm) at which a direction of the camera frame (any length) is seen; `None` at 90° and beyond.
    #[must_use]
    pub fn project(&self, direction: DVec3) -> Option<DVec2> {
        let point = direction.truncate() * (self.principal_distance_mm / direction.z);
        (direction.z > 0.0 && point.is_finite()).then_some(point)
    }

    /// The unit direction of the camera frame seen at an ideal point (mm).
    #[must_use]
    pub fn direction(&self, ideal_mm: DVec2) -> DVec3 {
        (ideal_mm / self.principal_distance_mm).extend(1.0).normalize()
    }
}

/// An illegal number in a model.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{name} = {value}; expected {expected}")]
pub struct ModelError {
    /// The parameter's name.
    pub name: String,
    /// Value given.
    pub value: f64,
    /// The legal range.
    pub expected: &'static str,
}

impl ModelError {
    pub(crate) fn value(name: &str, value: f64, expected: &'static str) -> Self {
        Self { name: name.to_owned(), value, expected }
    }
}

/// Largest magnitude of a parameter: larger squares overflow, and no camera has it.
const LARGEST: f64 = 1e30;

/// Refuses values that are not finite or too large for computation.
pub(crate) fn finite<'a>(values: impl IntoIterator<Item = (&'a str, f64)>) -> Result<(), ModelError> {
    match values.into_iter().find(|(_, value)| value.is_nan() || value.abs() > LARGEST) {
        Some((name, value)) if value.is_finite() => {
            Err(ModelError::value(name, value, "a number of at most 1e30 in size"))
        }
        Some((name, value)) => Err(ModelError::value(name, value, "a finite number")),
        None => Ok(()),
    }
}

/// Refuses a value for which `legal` does not hold.
pub(crate) fn legal(name: &str, value: f64, legal: bool, expected: &'static str) -> Result<(), ModelError> {
    if legal && value.is_finite() { Ok(()) } else { Err(ModelError::value(name, value, expected)) }
}

/// Names for the coefficients of a list, from `first`.
fn numbered<'a>(letter: &str, first: usize, values: &'a [f64]) -> Vec<(String, &'a f64)> {
    values.iter().enumerate().map(|(i, value)| (format!("{letter}{}", i + first), value)).collect()
}

/// Refuses a list in which a coefficient is not finite.
pub(crate) fn finite_list(letter: &str, first: usize, values: &[f64]) -> Result<(), ModelError> {
    let named = numbered(letter, first, values);
    finite(named.iter().map(|(name, value)| (name.as_str(), **value)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_direction_comes_back() {
        let view = Rectilinear { principal_distance_mm: 12.5 };
        for p in [DVec2::ZERO, DVec2::new(3.0, -4.0), DVec2::new(-90.0, 0.5)] {
            let back = view.project(view.direction(p) * 7.0).expect("in front");
            // Two divisions and a normalisation: a few units in the last place.
            assert!((back - p).length() <= 1e-14 * (1.0 + p.length()));
        }
        assert!(view.project(DVec3::X).is_none() && view.project(DVec3::NEG_Z).is_none());
    }
}
