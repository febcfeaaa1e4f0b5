//! The at-the-pupil route: from stored radiance at the entrance pupil to irradiance on a sensor.
//!
//! The radiance seen from the centre of the entrance pupil is rendered once, in one rectilinear view or in six ([`PupilProjection`]). Any lens and
//! sensor within its directions can then be applied:
//!
//! 1. [`Resampling`]: projection, distortion, lateral colour and raster, radiance → radiance. A uniform radiance stays uniform.
//! 2. [`irradiance()`]: times the lens's étendue at the pixel: cos⁴, finite aperture, mechanical vignetting, transmittance.
//!
//! A prescription looks along its chief rays; their origins are all taken as the centre of the paraxial entrance pupil.
//!
//! Left out here, and exact only through the lens: defocus and aberrations, parallax across the pupil, and radiance that varies within the bundle of
//! one sensor point.

mod covering;
mod cube;
mod irradiance;
mod projection;
mod resample;
mod survey;
mod view;

pub use cube::{Cube, Window};
pub use irradiance::{BandEtendue, irradiance};
pub use projection::{MAX_RECTILINEAR_RAD, PupilProjection};
pub use resample::Resampling;
pub use view::{Face, View};
