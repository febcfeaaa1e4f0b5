//! The patterns of an aperture on the pixels of a film, patch by patch.

use etendue_core::WavelengthRange;
use glam::{DMat2, DVec2};

use super::pattern::{CELLS, Pattern, Pupil};
use crate::effects::core_table::{CORE_PX, CoreBuilder, CoreTable};
use crate::effects::film_part::{FilmPart, KernelBuilder, MM_PER_NM, NM_PER_UM, mid_wavelengths};
use crate::{effects::Canvas, effects::convolve::NumberField, effects::kernel::Kernel, effects::patches::Patches};

/// A part of the image with its own function.
#[derive(Clone, Debug)]
pub(super) struct Patch {
    pub(super) stretch: DMat2,
    pub(super) max_width: f64,
    pub(super) wavefront_um: Option<Vec<f64>>,
}

/// The maximum reach of a function, px.
pub(in crate::effects) const MAX_PX: usize = 512;

/// Reach and step of patterns.
#[derive(Clone, Copy, Debug)]
pub(super) struct Extent {
    pub(super) f_number: f64,
    /// Cut-off radius; `None`: as far as it is computed.
    pub(super) reach_mm: Option<f64>,
    /// Steps of the pattern per λN.
    pub(super) fineness: f64,
}

impl Extent {
    /// A step on the axis at a wavelength.
    fn step_mm(&self, nm: f64) -> f64 {
        nm * MM_PER_NM * self.f_number / self.fineness
    }

    /// Reach of the pattern, px, where it is `stretch` times as wide as on the axis.
    pub(super) fn reach_px(&self, longest_nm: f64, pitch_mm: f64, stretch: f64) -> usize {
        let computed = 0.5 * CELLS as f64 * self.step_mm(longest_nm) * stretch;
        let reach = self.reach_mm.map_or(computed, |mm| mm.min(computed));
        ((reach / pitch_mm).ceil() as usize + 1).min(MAX_PX)
    }
}

/// The patterns of the patches of a film.
#[derive(Debug)]
pub(super) struct Patterns {
    pub(super) extent: Extent,
    pub(super) canvas: Canvas,
    pub(super) pupil: Pupil,
    /// The pattern shared by all patches and wavelengths, if there is no wavefront error.
    pub(super) shared: Option<Pattern>,
    pub(super) places: Patches,
    /// In the order of `places`.
    pub(super) patches: Vec<Patch>,
}

impl Patterns {
    /// Deposits the light of a wavelength (positions, px, and fractions); at least the part within `reach_px` along rows and columns.
    pub(super) fn deposit(&self, nm: f64, patch: &Patch, reach_px: f64, mut to: impl FnMut(DVec2, f64)) {
        let own = patch.wavefront_um.as_ref().map(|wavefront| {
            let waves: Vec<f64> = wavefront.iter().map(|um| um * NM_PER_UM / nm).collect();
            self.pupil.pattern(Some(&waves))
        });
        let Some(pattern) = own.as_ref().or(self.shared.as_ref()) else { return };
        let step = self.extent.step_mm(nm);
        let end = self.extent.reach_mm.unwrap_or(f64::INFINITY);
        let pitch = self.canvas.pitch_mm();
        // No pattern is narrower than on the axis.
        let steps = reach_px * core::f64::consts::SQRT_2 * pitch.max_element() / step;
        for (place, fraction) in pattern.points_within(steps.ceil() as usize) {
            let offset = patch.stretch * place * step;
            if offset.length_squared() <= end * end {
                to(offset / pitch, fraction);
            }
        }
    }

    /// The core of a patch at a wavelength; `None` if it holds no light.
    pub(super) fn core(&self, nm: f64, patch: &Patch) -> Option<CoreTable> {
        let mut builder = CoreBuilder::default();
        self.deposit(nm, patch, CORE_PX, |offset_px, mass| builder.deposit(offset_px, mass));
        builder.table()
    }
}

/// The function of a film, or its tails.
#[derive(Debug)]
pub(in crate::effects) struct PreparedPsf {
    pub(super) part: FilmPart,
    pub(super) patterns: Patterns,
}

impl PreparedPsf {
    /// The film's light and variance in a band.
    pub(in crate::effects) fn apply(
        &self,
        band: WavelengthRange,
        light: &NumberField,
        variance: Option<&NumberField>,
    ) -> (NumberField, Option<NumberField>) {
        let Patterns { places, patches, .. } = &self.patterns;
        places.apply(light, variance, |index| self.kernel(band, &patches[index]))
    }

    /// The kernel of a patch, its sum one.
    fn kernel(&self, band: WavelengthRange, patch: &Patch) -> Kernel {
        let Patterns { extent, canvas, .. } = &self.patterns;
        let reach = extent.reach_px(band.high_nm, canvas.pitch_mm().min_element(), patch.max_width);
        let mut kernel = KernelBuilder::new(self.part, [reach, reach]);
        for nm in mid_wavelengths(band) {
            self.patterns.deposit(nm, patch, f64::INFINITY, |offset_px, fraction| kernel.deposit(offset_px, fraction));
        }
        kernel.kernel()
    }
}
