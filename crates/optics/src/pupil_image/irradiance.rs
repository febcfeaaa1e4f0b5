//! Radiance to irradiance: the lens's étendue at each pixel.
//!
//! E = L · Ω(x), with Ω = [`Lens::projected_solid_angle_sr`] at the pixel's centre. The relative variation of Ω over a pixel of pitch p is about
//! (p/c)², so its mean over the pixel is equal to f32 rounding for pitches below a thousandth of the principal distance; at the very edge of
//! mechanical vignetting the difference is that of one pixel's width.
//!
//! A prescription's Ω is a quadrature over traced rays; it is taken from a table over the radius (`radial.rs`), and where coatings, a filter or
//! glasses make it depend on the wavelength, at the centre of each band.

use etendue_core::plane::{Plane, SpectralCube};
use etendue_core::quantity::{Irradiance, Quantity, Radiance};
use etendue_projection::Raster;
use glam::DVec2;
use rayon::prelude::*;

use super::survey::RadialEtendue;
use crate::{error::OpticsError, lens::Lens};

/// Irradiance on the sensor of a radiance image that is already in the sensor's raster.
///
/// # Errors
/// If the image's size is not the raster's.
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

/// The same for one band at a time, with the memory of that band only: the étendue is recomputed for each, row by row on the caller's threads.
#[derive(Debug)]
pub struct BandEtendue<'a> {
    lens: &'a Lens,
    raster: &'a Raster,
    /// Table of a prescription.
    table: Option<RadialEtendue>,
}

impl<'a> BandEtendue<'a> {
    /// The étendue of a lens at the pixels of a raster.
    #[must_use]
    pub fn new(lens: &'a Lens, raster: &'a Raster) -> Self {
        let table = match lens {
            Lens::Prescription(prescribed) => Some(RadialEtendue::new(prescribed, raster.max_radius_mm())),
            _ => None,
        };
        Self { lens, raster, table }
    }

    /// Irradiance of the band about `centre_nm` of a radiance in the raster; equal to [`irradiance`].
    ///
    /// # Errors
    /// If the plane's size is not the raster's.
    pub fn irradiance(&self, radiance: &Plane<Radiance>, centre_nm: f64) -> Result<Plane<Irradiance>, OpticsError> {
        let (width, height) = (self.raster.width(), self.raster.height());
        check_plane(radiance, width, height)?;
        let mut result = Plane::new(width, height);
        let of_band = match (self.lens, &self.table) {
            (Lens::Prescription(lens), Some(table)) if lens.disperses() => Some(table.at_wavelength(lens, centre_nm)),
            _ => None,
        };
        let table = of_band.as_ref().or(self.table.as_ref());
        let rows = result.samples_mut().par_chunks_exact_mut(width).zip(radiance.samples().par_chunks_exact(width));
        rows.enumerate().for_each(|(y, (to, from))| {
            let centre = |x: usize| self.raster.sensor_mm(DVec2::new(x as f64 + 0.5, y as f64 + 0.5));
            let etendue: Vec<f64> = match table {
                Some(table) => table.at_radii(&(0..width).map(|x| centre(x).length()).collect::<Vec<_>>()),
                None => (0..width).map(|x| self.lens.projected_solid_angle_sr(centre(x))).collect(),
            };
            times_samples(from, &etendue, to);
        });
        Ok(result)
    }
}

fn times(radiance: &Plane<Radiance>, projected_solid_angle_sr: &[f64], irradiance: &mut Plane<Irradiance>) {
    times_samples(radiance.samples(), projected_solid_angle_sr, irradiance.samples_mut());
}

fn times_samples(radiance: &[f32], projected_solid_angle_sr: &[f64], irradiance: &mut [f32]) {
    let pixels = radiance.iter().zip(projected_solid_angle_sr);
    for (e, (l, sr)) in irradiance.iter_mut().zip(pixels) {
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
    cube.planes().iter().try_for_each(|plane| check_plane(plane, width, height))
}

/// Refuses a plane that is not of the stated size.
pub(super) fn check_plane<Q: Quantity>(plane: &Plane<Q>, width: usize, height: usize) -> Result<(), OpticsError> {
    let (got_width, got_height) = (plane.width(), plane.height());
    if (got_width, got_height) == (width, height) {
        return Ok(());
    }
    Err(OpticsError::Size { got_width, got_height, width, height })
}
