//! How narrow a point-spread function is.

use super::band::BandLimited;
use super::core_table::CoreBuilder;
use glam::DVec2;

/// How narrow a point-spread function is on the pixels of a film, in the middle of the picture at 555 nm; of tables over the field where they are widest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpreadWidth {
    /// Share of the light that samples can be displaced by: all of it within a pixel, none beyond 2.5 px, along rows and columns.
    pub core: f64,
    /// Modulation that a kernel on whole pixels lacks or adds, at most, at up to half a cycle a pixel.
    pub film_error: f64,
    /// Whether it is of another width at other wavelengths.
    pub scales: bool,
}

impl SpreadWidth {
    /// Of a function that adds where light lands, px, and how much.
    pub(super) fn new(reach: [usize; 2], scales: bool, deposit: impl FnOnce(&mut dyn FnMut(DVec2, f64))) -> Self {
        let mut core = CoreBuilder::default();
        let (mut all, mut band) = (0.0, BandLimited::zeros(reach));
        deposit(&mut |offset_px: DVec2, mass: f64| {
            all += mass;
            core.deposit(offset_px, mass);
            band.deposit(offset_px, mass);
        });
        Self { core: core.sum() / all, film_error: band.worst_error(), scales }
    }

    /// The wider core and the greater error of two.
    pub(super) fn worse(self, other: Self) -> Self {
        Self {
            core: self.core.min(other.core),
            film_error: self.film_error.max(other.film_error),
            scales: self.scales || other.scales,
        }
    }
}
