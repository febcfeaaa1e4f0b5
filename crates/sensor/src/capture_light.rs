//! The light of a frame's captures.

use etendue_core::Plane;
use etendue_core::quantity::MeanElectrons;

/// Mean electrons of a frame's captures, each as the first capture's exposure would gather them of the light that the capture
/// sees.
#[derive(Clone, Copy, Debug)]
pub struct CaptureLight<'a> {
    /// Of the first capture.
    pub first: &'a Plane<MeanElectrons>,
    /// Of the captures after it, one each; empty where all see the same light.
    pub further: &'a [Plane<MeanElectrons>],
}

impl<'a> CaptureLight<'a> {
    /// The same light in all captures.
    #[must_use]
    pub fn steady(means: &'a Plane<MeanElectrons>) -> Self {
        Self { first: means, further: &[] }
    }

    /// That of capture `k`, from 0.
    pub(crate) fn of(&self, k: usize) -> &'a Plane<MeanElectrons> {
        k.checked_sub(1).and_then(|i| self.further.get(i)).unwrap_or(self.first)
    }
}
