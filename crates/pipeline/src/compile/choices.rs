//! Choices of the caller in addition to the description.

use etendue_core::Quality;

/// Choices of the caller in addition to the description. Samples and seed are not choices but keys: [`Overrides`] set them, and the description's own checks
/// apply.
///
/// [`Overrides`]: etendue_scene::Overrides
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Choices {
    /// Preset for settings that the description leaves open; `None` is standard.
    pub quality: Option<Quality>,
    /// Refinement of films pass by pass.
    pub refinement: Refinement,
}

/// Refinement of films pass by pass.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Refinement {
    /// In the passes of the description; without any, in a single one.
    #[default]
    Described,
    /// In the passes of the description; without any, in those of [`Passes::doubling`](crate::plan::Passes::doubling).
    Progressive,
    /// In passes that a given time determines during the run: until [`Plan::with_passes`](crate::Plan::with_passes) the plan has one, the smallest.
    Timed,
}

/// Samples per pixel of a preset.
pub(super) fn spp(quality: Quality) -> u32 {
    match quality {
        Quality::Draft => 16,
        Quality::Standard => 64,
        Quality::Reference => 1024,
    }
}

/// Maximum number of scattering events of a preset.
pub(super) fn max_bounces(quality: Quality) -> u32 {
    match quality {
        Quality::Draft => 4,
        Quality::Standard => 16,
        Quality::Reference => 64,
    }
}
