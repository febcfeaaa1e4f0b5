//! The at-the-pupil route: from stored radiance at the entrance pupil to irradiance on a sensor.
//!
//! The radiance seen from the centre of the entrance pupil is rendered once in a rectilinear projection
//! ([`PupilProjection`]); any lens and sensor whose directions it holds can then be put before it:
//!
//! 1. [`Resampling`]: distortion and raster, radiance → radiance. A uniform radiance stays uniform.
//! 2. [`irradiance()`]: times the lens's étendue at the pixel: cos⁴, finite aperture, mechanical vignetting, transmittance.
//!
//! Left out here, and exact only through the lens: defocus, parallax across the pupil, and radiance that varies within
//! the bundle of one sensor point.

mod irradiance;
mod projection;
mod resample;

pub use irradiance::irradiance;
pub use projection::PupilProjection;
pub use resample::Resampling;
