//! How bright a light may be.

/// The greatest radiance, irradiance or intensity of a light at any wavelength, in its unit: products of it with weights and
/// sums over many lights stay finite in f32.
pub const BRIGHTEST: f32 = 1e30;
