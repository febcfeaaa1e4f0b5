//! A surface of a lens file as one of a prescription.

use etendue_optics::prescription::Surface;
use etendue_scene::asset::{GlassAsset, SurfaceAsset};
use etendue_spectra::glass::{self, Dispersion, GlassError};

/// A surface of a file.
///
/// # Errors
/// Where its glass is none.
pub(super) fn of_file(surface: &SurfaceAsset, semi_aperture_mm: f64) -> Result<Surface, GlassError> {
    let glass = match &surface.glass {
        GlassAsset::Air => Dispersion::AIR,
        GlassAsset::Named(name) => glass::named(name)?.dispersion,
        GlassAsset::Index(n) => Dispersion::Constant { n: *n }.checked()?,
        GlassAsset::Abbe { index, abbe } => Dispersion::of_abbe(*index, *abbe)?,
    };
    Ok(Surface {
        conic: surface.conic,
        asphere: surface.asphere,
        stop: surface.stop,
        ..Surface::sphere(surface.radius_mm, surface.thickness_mm, glass, semi_aperture_mm)
    })
}
