//! The ranges of numbers that several lenses have.

use crate::error::OpticsError;

/// `value` where it is positive and finite.
pub(crate) fn positive(name: &'static str, value: f64) -> Result<f64, OpticsError> {
    if value.is_finite() && value > 0.0 { Ok(value) } else { Err(OpticsError::NotPositive { name, value }) }
}

/// `value` where a lens can have it as its f-number.
pub(crate) fn f_number(value: f64) -> Result<f64, OpticsError> {
    let value = positive("f_number", value)?;
    if value >= FASTEST { Ok(value) } else { Err(OpticsError::Faster { value }) }
}

/// The f-number at which light on the axis comes from the whole half space: an aplanatic lens in air has 1/2N = sin θ′ ≤ 1 (Abbe).
const FASTEST: f64 = 0.5;

/// `value` where it is finite.
pub(crate) fn finite(name: &'static str, value: f64) -> Result<f64, OpticsError> {
    if value.is_finite() { Ok(value) } else { Err(OpticsError::NotFinite { name, value }) }
}
