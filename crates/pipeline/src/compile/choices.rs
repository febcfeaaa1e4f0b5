//! What the caller chooses beside the description.

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

/// Presets of the trade of time for accuracy.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quality {
    /// To frame and expose.
    Draft,
    /// To look at.
    Standard,
    /// To compare with.
    Reference,
}

impl Quality {
    /// Its name.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Draft => "draft",
            Self::Standard => "standard",
            Self::Reference => "reference",
        }
    }

    /// Samples a pixel.
    #[must_use]
    pub fn spp(self) -> u32 {
        match self {
            Self::Draft => 16,
            Self::Standard => 64,
            Self::Reference => 1024,
        }
    }

    /// Greatest number of scattering events.
    #[must_use]
    pub fn max_bounces(self) -> u32 {
        match self {
            Self::Draft => 4,
            Self::Standard => 16,
            Self::Reference => 64,
        }
    }
}
