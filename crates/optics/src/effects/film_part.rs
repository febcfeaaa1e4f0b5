//! What of a point spread the film spreads: all of it, or the tails beyond a core that samples were displaced by.

use super::band::BandLimited;
use super::core_table::core_share;
use super::kernel::Kernel;
use glam::DVec2;

/// What of a point spread a film spreads.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FilmPart {
    /// All of it.
    Whole,
    /// What lies beyond its core: the film's samples were displaced by that ([`super::SampleSpread`]).
    Tails,
}

/// A kernel while mass is added.
#[derive(Debug)]
pub(super) enum KernelBuilder {
    Whole(Box<BandLimited>),
    /// The tails are smooth: bilinear shares keep them. They are spread by the core once more, which is narrow beside them.
    Tails(Kernel),
}

impl KernelBuilder {
    pub(super) fn new(part: FilmPart, reach: [usize; 2]) -> Self {
        match part {
            FilmPart::Whole => Self::Whole(Box::new(BandLimited::zeros(reach))),
            FilmPart::Tails => Self::Tails(Kernel::zeros(reach)),
        }
    }

    /// Adds a mass at `offset_px` from the middle.
    pub(super) fn deposit(&mut self, offset_px: DVec2, mass: f64) {
        match self {
            Self::Whole(band) => band.deposit(offset_px, mass),
            Self::Tails(kernel) => {
                let core = mass * core_share(offset_px);
                kernel.add(0, 0, core);
                kernel.deposit(offset_px, mass - core);
            }
        }
    }

    /// The kernel, its sum one.
    pub(super) fn kernel(self) -> Kernel {
        match self {
            Self::Whole(band) => band.kernel(),
            Self::Tails(kernel) => {
                let sum = kernel.sum();
                kernel.scaled(1.0 / sum)
            }
        }
    }
}
