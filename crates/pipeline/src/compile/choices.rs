//! What the caller chooses beside the description.

use etendue_core::Quality;

/// What the caller chooses beside the description. Samples and seed are no choices but keys: [`Overrides`] set them, and the
/// description's own checks see them.
///
/// [`Overrides`]: etendue_scene::Overrides
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Choices {
    /// A preset for what the description leaves open; `None` is standard.
    pub quality: Option<Quality>,
    /// Whether films are refined pass by pass.
    pub refinement: Refinement,
}

/// Whether and how films are refined pass by pass.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Refinement {
    /// In the passes of the description; without any, in one.
    #[default]
    Described,
    /// In the passes of the description; without any, in those of [`Passes::doubling`](crate::plan::Passes::doubling).
    Progressive,
    /// In passes that a time decides while it runs: the plan has one, the least, until [`Plan::with_passes`](crate::Plan::with_passes).
    Timed,
}

/// Samples a pixel of a preset.
pub(super) fn spp(quality: Quality) -> u32 {
    match quality {
        Quality::Draft => 16,
        Quality::Standard => 64,
        Quality::Reference => 1024,
    }
}

/// Greatest number of scattering events of a preset.
pub(super) fn max_bounces(quality: Quality) -> u32 {
    match quality {
        Quality::Draft => 4,
        Quality::Standard => 16,
        Quality::Reference => 64,
    }
}
