//! Mirrors of lens files: unfolding, so that light travels towards +z everywhere, and planes that obscure.

use std::path::Path;

use etendue_scene::asset::{ASPHERE_TERMS, GlassAsset, LensOpening, SurfaceAsset};

use super::raw_surface::{RawSurface, SurfaceForm};
use crate::{Error, ErrorCode};

/// Unfolds mirrors: reverses z behind each, so that light travels towards +z. Fills in the media behind mirrors and coordinate breaks.
pub(super) fn unfold(file: &Path, surfaces: &mut [RawSurface]) -> Result<(), Error> {
    let (mut sign, mut before) = (1.0, GlassAsset::Air);
    for (i, surface) in surfaces.iter_mut().enumerate() {
        if surface.mirror || surface.form == SurfaceForm::CoordinateBreak {
            surface.glass = before;
        } else if let SurfaceForm::ThinLens(focal_length) = surface.form
            && (surface.glass != GlassAsset::Air
                || before != GlassAsset::Air
                || sign < 0.0
                || !focal_length.is_finite())
        {
            let what = format!(
                "surface {i} of type PARAXIAL is not an ideal lens in air, of a focal length (PARM 1) other than 0, behind an even number of mirrors; \
                 only such a lens is supported"
            );
            return Err(Error::at(file, surface.line, what).with_code(ErrorCode::UnsupportedFile));
        }
        before = surface.glass.clone();
        surface.curvature *= sign;
        surface.asphere.iter_mut().flat_map(|terms| terms.iter_mut()).for_each(|a| *a *= sign);
        sign = if surface.mirror { -sign } else { sign };
        surface.thickness *= sign;
    }
    Ok(())
}

/// Margin of the clear aperture of a plane that only obscures, relative to the largest aperture of the lens.
const WIDE: f64 = 2.0;

/// Widens planes that stop light at their centres alone: their stated size is that of the disc or of its drawing.
pub(super) fn widen_obscuring_planes(surfaces: &mut [SurfaceAsset], opening: Option<LensOpening>) {
    let pupil_mm = match opening {
        Some(LensOpening::EntrancePupil { diameter_mm }) => 0.5 * diameter_mm,
        _ => 0.0,
    };
    let others = surfaces.iter().filter(|s| s.obscured_radius_mm == 0.0 || s.clips_light);
    let widest_mm = others.filter_map(|s| s.semi_aperture_mm).fold(pupil_mm, f64::max);
    let mut before = GlassAsset::Air;
    for surface in surfaces {
        let bends = surface.mirror || surface.thin_lens_mm.is_some() || surface.glass != before;
        before = surface.glass.clone();
        if surface.obscured_radius_mm > 0.0 && !bends && !surface.stop && !surface.clips_light {
            // Its shape has no effect, and may end inside the wider aperture.
            surface.radius_mm = f64::INFINITY;
            surface.asphere = [0.0; ASPHERE_TERMS];
            let wide_mm = WIDE * widest_mm.max(surface.obscured_radius_mm);
            surface.semi_aperture_mm = (widest_mm > 0.0).then_some(wide_mm);
        }
    }
}
