//! Light that is drawn for a point, and light that a ray finds.

use super::sample_context::LightSampleContext;
use crate::geometry::SurfacePoint;
use etendue_core::Spectral;
use glam::Vec3;

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
