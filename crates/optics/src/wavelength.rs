//! The wavelength that stands for all.

/// The wavelength of ground truth, and of first-order quantities where a lens file names no other, nm: the helium d line.
pub const PRINCIPAL_NM: f64 = 587.56;
