//! Radiance to irradiance: the lens's étendue at each pixel.
//!
//! E = L · Ω(x), with Ω = [`Lens::projected_solid_angle_sr`] at the pixel's centre. Ω varies over a pixel of pitch p by about (p/c)² of
//! itself, so its mean over the pixel is the same to f32 rounding for pitches below a thousandth of the principal distance;
//! at the very edge of mechanical vignetting the difference is that of one pixel's width.
//!
//! A prescription's Ω is a quadrature over traced rays; it is taken from a table over the radius (`radial.rs`), and where
//! coatings, a filter or glasses make it depend on the wavelength, by the middle of each band.

use super::radial::RadialEtendue;
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
    let mut result = SpectralCube::new(raster.width(), raster.height(), radiance.bands());
    let pairs = radiance.planes().iter().zip(result.planes_mut());
    match lens {
        Lens::Prescription(prescribed) => {
            let table = RadialEtendue::new(prescribed, raster.max_radius_mm());
            let radii = over_pixels(raster, DVec2::length);
            let bands = radiance.bands();
            let of_band = |i: usize| table.at_wavelength(prescribed, bands.centre_nm(i)).at_radii(&radii);
            let alike = (!prescribed.disperses()).then(|| table.at_radii(&radii));
            for (i, (from, to)) in pairs.enumerate() {
                match &alike {
                    Some(etendue) => times(from, etendue, to),
                    None => times(from, &of_band(i), to),
                }
            }
        }
        _ => {
            let etendue = over_pixels(raster, |at| lens.projected_solid_angle_sr(at));
            pairs.for_each(|(from, to)| times(from, &etendue, to));
        }
    }
    Ok(result)
}

fn times(radiance: &Plane<Radiance>, projected_solid_angle_sr: &[f64], irradiance: &mut Plane<Irradiance>) {
    let pixels = radiance.samples().iter().zip(projected_solid_angle_sr);
    for (e, (l, sr)) in irradiance.samples_mut().iter_mut().zip(pixels) {
        *e = (f64::from(*l) * sr) as f32;
    }
}

/// A function of the sensor point (mm) at the centre of each pixel, row by row.
fn over_pixels(raster: &Raster, of: impl Fn(DVec2) -> f64) -> Vec<f64> {
    let centre = |x: usize, y: usize| raster.sensor_mm(DVec2::new(x as f64 + 0.5, y as f64 + 0.5));
    (0..raster.height()).flat_map(|y| (0..raster.width()).map(move |x| (x, y))).map(|(x, y)| of(centre(x, y))).collect()
}

/// Refuses a cube that is not of the stated size.
pub(super) fn check_size(cube: &SpectralCube<Radiance>, width: usize, height: usize) -> Result<(), OpticsError> {
    let (got_width, got_height) = (cube.width(), cube.height());
    if (got_width, got_height) == (width, height) {
        return Ok(());
    }
    Err(OpticsError::Size { got_width, got_height, width, height })
}
