//! Point-spread functions over the field from tables, as produced by lens-design programs: samples for field positions and for wavelengths.
//!
//! A function is given for one field position and rotates with the azimuth: a lens that is symmetric about its axis has the same function at all
//! positions of one distance from it, as seen from there. With the direction e away from the axis and e⊥ across it, from x towards y, light at an
//! offset o from the point in the samples' axes falls at
//!
//! ```text
//! u (e·o) + u⊥ (e⊥·o)        u away from the axis at the place in the image, u⊥ across it
//! ```
//!
//! Samples have their rows from the top and their columns from the left as the physical image is seen against the light, and x and y run to the right
//! and to the bottom, as in the image. The captured image is that image rotated by 180° about the axis, so nothing is mirrored, and directions away
//! from the axis are kept.
//!
//! Between the two nearest distances, and between the two nearest wavelengths, the function is interpolated linearly; it is clamped at the ends. A
//! single function on the axis has no direction of its own: it takes that of the farthest.
//!
//! The image has patches (`patches`) whose functions hold on its edges and uniformly between. By default their number is the smallest that keeps
//! centroids midway between patches within a hundredth of the width and second moments within half a per cent of the table's, eleven across at most.
//!
//! Left out: lenses that are not symmetric about their axis; the change of shape between two distances (both shapes are mixed by weight); light
//! beyond the samples.

mod function;
mod table;

use std::borrow::Cow;

use etendue_core::WavelengthRange;
use rayon::prelude::*;

use super::film_part::{FilmPart, KernelBuilder};
use super::{Canvas, convolve::NumberField, kernel::Kernel, patches::Patches, psf::VISIBLE};

pub use function::FieldSpread;
pub use table::{SpreadTable, SpreadTableParameters, WavelengthTable};

/// The functions of a film, or their tails.
#[derive(Debug)]
pub(super) struct PreparedTable {
    table: SpreadTable,
    canvas: Canvas,
    part: FilmPart,
    places: Patches,
    /// Kernels of the patches, if they are the same at all wavelengths.
    shared: Option<Vec<Kernel>>,
}

impl PreparedTable {
    pub(super) fn new(table: SpreadTable, canvas: &Canvas, part: FilmPart) -> Self {
        let places = table.places(canvas);
        let mut ready = Self { table, canvas: *canvas, part, places, shared: None };
        if !ready.table.varies_by_wavelength() {
            let kernel = |patch| ready.kernel(VISIBLE, patch);
            ready.shared = Some((0..ready.places.count()).into_par_iter().map(kernel).collect());
        }
        ready
    }

    /// The film's light and variance in a band.
    pub(super) fn apply(
        &self,
        band: WavelengthRange,
        light: &NumberField,
        variance: Option<&NumberField>,
    ) -> (NumberField, Option<NumberField>) {
        let kernel = |patch: usize| match &self.shared {
            Some(kernels) => Cow::Borrowed(&kernels[patch]),
            None => Cow::Owned(self.kernel(band, patch)),
        };
        self.places.apply(light, variance, kernel)
    }

    /// The kernel of a patch, its sum one.
    fn kernel(&self, band: WavelengthRange, patch: usize) -> Kernel {
        let pitch_mm = self.canvas.pitch_mm();
        let at_mm = self.canvas.sensor_mm(self.places.middle_px(patch));
        let mut kernel = KernelBuilder::new(self.part, self.table.reach_px(pitch_mm));
        for nm in self.table.wavelengths_of(band) {
            self.table.deposit(nm, at_mm, |offset, fraction| kernel.deposit(offset / pitch_mm, fraction));
        }
        kernel.kernel()
    }
}
