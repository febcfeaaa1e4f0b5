//! The film and the image in it, and a kernel that spreads means and, squared, variances.

use etendue_projection::Raster;
use glam::DVec2;

use super::convolve::{Convolver, NumberField, Region};
use super::kernel::Kernel;

/// The film and the image in it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Canvas {
    pub(super) film: Raster,
    pub(super) margin_px: [usize; 2],
}

impl Canvas {
    pub(crate) fn new(image: &Raster, margin_px: [usize; 2]) -> Self {
        Self { film: image.widened(margin_px), margin_px }
    }

    /// Columns and rows of the film.
    pub(crate) fn size(&self) -> [usize; 2] {
        [self.film.width(), self.film.height()]
    }

    /// The point of the sensor at a point of the film.
    pub(super) fn sensor_mm(&self, film_px: DVec2) -> DVec2 {
        self.film.sensor_mm(film_px)
    }

    /// Maximum distance from the axis to the film's edge.
    pub(super) fn max_radius_mm(&self) -> f64 {
        self.film.max_radius_mm()
    }

    pub(crate) fn pitch_mm(&self) -> DVec2 {
        self.film.pitch_mm()
    }

    /// The whole film.
    pub(super) fn film_region(&self) -> Region {
        Region { x: 0..self.film.width(), y: 0..self.film.height() }
    }

    /// The image in the film.
    pub(super) fn image_region(&self) -> Region {
        let [x, y] = self.margin_px;
        Region { x: x..self.film.width() - x, y: y..self.film.height() - y }
    }
}

/// A kernel for means and, squared, for variances.
#[derive(Debug)]
pub(super) struct KernelPair {
    pub(super) mean: Convolver,
    pub(super) variance: Convolver,
}

impl KernelPair {
    pub(super) fn new(kernel: &Kernel, canvas: &Canvas) -> Self {
        let of = |kernel: &Kernel| Convolver::new(kernel, canvas.size(), canvas.film_region());
        Self { mean: of(kernel), variance: of(&kernel.squared()) }
    }

    pub(super) fn apply(
        &self,
        light: &NumberField,
        variance: Option<&NumberField>,
    ) -> (NumberField, Option<NumberField>) {
        (self.mean.apply(light), variance.map(|variance| self.variance.apply(variance)))
    }
}
