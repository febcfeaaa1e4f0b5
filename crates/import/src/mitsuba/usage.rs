//! What textures are for.

/// What a texture is for.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub(super) enum Use {
    /// Colours.
    Colours,
    /// A number for each texel, which Mitsuba takes from the colour there.
    Numbers,
    /// Numbers as they are stored, as normals.
    Data,
}
