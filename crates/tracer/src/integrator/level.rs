//! How much of light transport is followed: the user's trade of time for accuracy.

/// A level of rendering. All see the same surfaces: depth and identities do not depend on it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Level {
    /// Local shading: the light of lamps, suns and surroundings that the first surface scatters towards the camera, as
    /// if nothing else stood in its way. No shadows, nothing reflected but the surroundings, no light from other
    /// surfaces, nothing seen through solid glass.
    Flat,
    /// Direct light: as [`Level::Flat`], but what stands between a light and the surface casts its shadow, and glowing
    /// surfaces are seen in smooth ones. One scattering event: mirrors show what glows and the surroundings, and other
    /// surfaces black.
    Direct,
    /// Everything, up to the greatest number of scattering events.
    #[default]
    Path,
}
