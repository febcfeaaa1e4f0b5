//! Point-spread functions over the field on the pixels of a film.

use super::table::SpreadTable;
use crate::effects::Canvas;
use crate::effects::convolve::Field;
use crate::effects::film_part::{FilmPart, KernelBuilder};
use crate::effects::kernel::Kernel;
use crate::effects::patches::Patches;
use crate::effects::psf::VISIBLE;
use etendue_core::WavelengthRange;
use rayon::prelude::*;
use std::borrow::Cow;

/// The functions of a film, or their tails.
#[derive(Debug)]
pub(in crate::effects) struct ReadyTable {
    table: SpreadTable,
    canvas: Canvas,
    part: FilmPart,
    places: Patches,
    /// Of each patch, where they are the same at all wavelengths.
    shared: Option<Vec<Kernel>>,
}

impl ReadyTable {
    pub(in crate::effects) fn new(table: SpreadTable, canvas: &Canvas, part: FilmPart) -> Self {
        let places = table.places(canvas);
        let mut ready = Self { table, canvas: *canvas, part, places, shared: None };
        if !ready.table.varies_by_wavelength() {
            let kernel = |patch| ready.kernel(VISIBLE, patch);
            ready.shared = Some((0..ready.places.count()).into_par_iter().map(kernel).collect());
        }
        ready
    }

    /// The film's light and variance in a band.
    pub(in crate::effects) fn apply(
        &self,
        band: WavelengthRange,
        light: &Field,
        variance: Option<&Field>,
    ) -> (Field, Option<Field>) {
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
            self.table.deposit(nm, at_mm, |offset, share| kernel.deposit(offset / pitch_mm, share));
        }
        kernel.kernel()
    }
}
