//! A surface as a lens file states it, in the file's unit.

use etendue_scene::asset::{ASPHERE_TERMS, GlassAsset};

/// Form of a surface.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum SurfaceForm {
    /// A conic, in CODE V files with terms of even powers.
    Standard,
    /// Zemax EVENASPH: a conic with terms of even powers.
    Even,
    /// Zemax ODDASPHE: a conic with terms of all powers, of which the odd ones must be zero.
    Odd,
    /// Zemax COORDBRK: a plane without effect, in the medium of the space before it.
    CoordinateBreak,
    /// Zemax PARAXIAL: an ideal thin lens of this focal length.
    ThinLens(f64),
}

#[derive(Clone)]
pub(super) struct RawSurface {
    pub(super) line: usize,
    pub(super) form: SurfaceForm,
    /// True for a mirror; its glass is then that of the space before it.
    pub(super) mirror: bool,
    pub(super) curvature: f64,
    pub(super) conic: f64,
    /// Coefficients of r², r⁴ …; `None`: all are 0.
    pub(super) asphere: Option<Box<[f64; ASPHERE_TERMS]>>,
    pub(super) semi_aperture: Option<f64>,
    /// Radius within which the surface stops light.
    pub(super) obscured_radius: f64,
    /// True if the clear aperture stops light, and is not only a size for drawing.
    pub(super) is_clear_aperture: bool,
    pub(super) thickness: f64,
    pub(super) glass: GlassAsset,
    pub(super) stop: bool,
}

impl RawSurface {
    pub(super) fn new(line: usize) -> Self {
        let (curvature, conic) = (0.0, 0.0);
        let glass = GlassAsset::Air;
        Self {
            line,
            form: SurfaceForm::Standard,
            mirror: false,
            curvature,
            conic,
            asphere: None,
            semi_aperture: None,
            obscured_radius: 0.0,
            is_clear_aperture: false,
            thickness: 0.0,
            glass,
            stop: false,
        }
    }

    /// True if the surface neither bends nor stops light between media of this kind.
    pub(super) fn is_idle(&self, before: &GlassAsset) -> bool {
        let clips = self.is_clear_aperture && self.semi_aperture.is_some();
        let bends = self.mirror || self.glass != *before || matches!(self.form, SurfaceForm::ThinLens(_));
        !bends && !self.stop && !clips && self.obscured_radius == 0.0
    }

    /// Sets the coefficient of r² (0), r⁴ (1) …
    pub(super) fn set_coefficient(&mut self, place: usize, value: f64) {
        if value != 0.0 || self.asphere.is_some() {
            self.asphere.get_or_insert_default()[place] = value;
        }
    }
}
