//! The wavelength that stands for all.

/// The wavelength of ground truth and of first-order quantities, nm: the helium d line.
pub const PRINCIPAL_NM: f64 = 587.56;
