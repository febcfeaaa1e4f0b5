//! Light that is drawn for a point, and light that a ray finds.

use etendue_core::Spectral;
use glam::Vec3;

use super::ReceiverGloss;
use crate::geometry::SurfacePoint;

/// Light drawn for a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightSample<const N: usize> {
    /// Unit direction towards the light.
    pub direction: Vec3,
    /// The point of the light, moved off its surface by the error bound; `None` for light from infinity.
    pub target: Option<Vec3>,
    /// Spectral radiance towards the point; of a lamp without an opening the spectral irradiance of a surface that faces it.
    pub radiance: Spectral<N>,
    /// Density of the direction, with that of the choice, 1/sr; of a lamp without an opening the probability of the choice.
    /// Times the number of the receiver's draws ([`LightSampleContext::draws`]). Positive.
    pub pdf: f32,
    /// Whether it is a lamp without an opening: nothing but a draw can find it.
    pub delta: bool,
    /// Whether it is light of the surroundings, and of no sun or surface.
    pub surrounds: bool,
}

impl<const N: usize> LightSample<N> {
    /// Light of the surroundings; `None` where no density can be told.
    pub(super) fn of_surroundings(direction: Vec3, radiance: Spectral<N>, pdf: f32) -> Option<Self> {
        let drawn = Self { direction, target: None, radiance, pdf, delta: false, surrounds: true };
        (pdf > 0.0 && pdf.is_finite()).then_some(drawn)
    }
}

/// Irradiance of a lamp at a receiver, the mean over the wavelengths that lights are chosen by, W·m⁻²·nm⁻¹.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct LampIrradiance {
    /// That of the receiver's surface, or of one facing the lamp where light counts from every side.
    pub(super) plain: f32,
    /// The same, raised by the receiver's gloss.
    pub(super) raised: f32,
}

/// Light from infinity that was met by chance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DistantLight<const N: usize> {
    /// Spectral radiance.
    pub radiance: Spectral<N>,
    /// Density by which the receiver's draws would have given the direction for it, 1/sr.
    pub pdf: f32,
    /// Whether it is light of the surroundings, and of no sun.
    pub surrounds: bool,
}

/// The light that a surface point belongs to, as seen along a ray that met it.
#[derive(Clone, Copy, Debug)]
pub struct LightHit<'a> {
    /// The point that the ray came from.
    pub receiver: &'a LightSampleContext,
    /// The point that was met.
    pub point: &'a SurfacePoint,
    /// The ray's unit direction.
    pub direction: Vec3,
    /// Length of the way, m.
    pub distance_m: f32,
}

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
