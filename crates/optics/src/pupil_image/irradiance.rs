//! Radiance to irradiance: the lens's étendue at each pixel.
//!
//! E = L · Ω(x), with Ω = [`Lens::etendue_sr`] at the pixel's centre. Ω varies over a pixel of pitch p by about (p/c)² of
//! itself, so its mean over the pixel is the same to f32 rounding for pitches below a thousandth of the principal distance;
//! at the very edge of mechanical vignetting the difference is that of one pixel's width.

use crate::error::OpticsError;
use crate::lens::Lens;
use etendue_core::plane::{Plane, SpectralCube};
use etendue_core::quantity::{Irradiance, Radiance};
use etendue_projection::Raster;
use glam::DVec2;

/// Irradiance on the sensor of a radiance image that already is in the sensor's raster.
///
/// # Errors
/// Where the image's size is not the raster's.
pub fn irradiance(
    radiance: &SpectralCube<Radiance>,
    lens: &Lens,
    raster: &Raster,
) -> Result<SpectralCube<Irradiance>, OpticsError> {
    check_size(radiance, raster.width(), raster.height())?;
    let etendue = etendue_sr(lens, raster);
    let mut result = SpectralCube::new(raster.width(), raster.height(), radiance.bands());
    for (from, to) in radiance.planes().iter().zip(result.planes_mut()) {
        times(from, &etendue, to);
    }
    Ok(result)
}

fn times(radiance: &Plane<Radiance>, etendue_sr: &[f64], irradiance: &mut Plane<Irradiance>) {
    let pixels = radiance.samples().iter().zip(etendue_sr);
    for (e, (l, sr)) in irradiance.samples_mut().iter_mut().zip(pixels) {
        *e = (f64::from(*l) * sr) as f32;
    }
}

/// Étendue at the centre of each pixel, sr, row by row.
fn etendue_sr(lens: &Lens, raster: &Raster) -> Vec<f64> {
    let centre = |x: usize, y: usize| raster.sensor_mm(DVec2::new(x as f64 + 0.5, y as f64 + 0.5));
    let row = |y: usize| (0..raster.width()).map(move |x| lens.etendue_sr(centre(x, y)));
    (0..raster.height()).flat_map(row).collect()
}

/// Refuses a cube that is not of the stated size.
pub(super) fn check_size(cube: &SpectralCube<Radiance>, width: usize, height: usize) -> Result<(), OpticsError> {
    let (got_width, got_height) = (cube.width(), cube.height());
    if (got_width, got_height) == (width, height) {
        return Ok(());
    }
    Err(OpticsError::Size { got_width, got_height, width, height })
}
