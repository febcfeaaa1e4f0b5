//! The surfaces of a prescription along its axis, and the media between them.

use super::indices::MAX_MEDIA;
use super::surface::Surface;
use super::trace::Element;
use crate::error::PrescriptionError;
use etendue_spectra::glass::Dispersion;

/// The different media of a lens, air first, and for each surface its places in that list: before it, and behind it.
pub(super) fn media(surfaces: &[Surface]) -> Result<(Vec<Dispersion>, Vec<[usize; 2]>), PrescriptionError> {
    let mut list = vec![Dispersion::AIR];
    let mut before = 0;
    let places = surfaces
        .iter()
        .map(|surface| {
            let known = list.iter().position(|medium| *medium == surface.glass);
            let after = known.unwrap_or_else(|| {
                list.push(surface.glass);
                list.len() - 1
            });
            [core::mem::replace(&mut before, after), after]
        })
        .collect();
    if list.len() > MAX_MEDIA {
        return Err(PrescriptionError::Media { found: list.len(), most: MAX_MEDIA });
    }
    if before == 0 { Ok((list, places)) } else { Err(PrescriptionError::LastMedium) }
}

/// Surfaces ready to be traced.
pub(super) fn elements(surfaces: &[Surface], places: &[[usize; 2]]) -> Vec<Element> {
    let mut z_mm = 0.0;
    let element = |(surface, media): (&Surface, &[usize; 2])| {
        let element = Element {
            shape: surface.shape(),
            z_mm,
            open_mm2: surface.semi_aperture_mm * surface.semi_aperture_mm,
            media: *media,
            coating: surface.coating,
        };
        z_mm += surface.thickness_mm;
        element
    };
    surfaces.iter().zip(places).map(element).collect()
}
