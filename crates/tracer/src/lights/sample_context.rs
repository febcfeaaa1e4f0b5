//! The point that asks for light.

use glam::Vec3;

use super::ReceiverGloss;

/// A point that light is drawn for. Its normal lets lights be passed over that cannot reach it, its gloss lets those be asked
/// more often that it mirrors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightSampleContext {
    /// Where it is, render frame, m.
    pub position: Vec3,
    /// The unit normal that light must come from the side of: the shading normal on the side of the viewer. Zero where
    /// light counts from every side.
    pub normal: Vec3,
    /// Narrow lobes; `None` where the choice need not know of any.
    pub gloss: Option<ReceiverGloss>,
    /// Whether the camera sees the point itself, straight or by mirrors, so that no scattering averages its error: a light is then
    /// chosen with more care, for more time. Without effect where there is `gloss`.
    pub in_view: bool,
    /// How many lights it draws, 1 or more. Densities of what is drawn are those of all its draws together.
    pub draws: u32,
    /// When light is asked for, s: as [`etendue_core::Ray::time_s`].
    pub time_s: f32,
}

impl LightSampleContext {
    /// A matt receiver out of view, at the start of the view's interval.
    #[must_use]
    pub fn matt(position: Vec3, normal: Vec3) -> Self {
        Self { position, normal, gloss: None, in_view: false, draws: 1, time_s: 0.0 }
    }

    /// A point in a medium, which light counts for from every side.
    #[must_use]
    pub(crate) fn in_medium(position: Vec3, time_s: f32) -> Self {
        Self { time_s, ..Self::matt(position, Vec3::ZERO) }
    }

    /// What the lobes send of light from a cone about a unit direction whose half angle has the sine `sin`, relative to the
    /// matt part under light from above.
    #[inline]
    pub(super) fn glossy(&self, direction: Vec3, sin: f32) -> f32 {
        self.gloss.as_ref().map_or(0.0, |gloss| gloss.relative(direction, sin))
    }
}
