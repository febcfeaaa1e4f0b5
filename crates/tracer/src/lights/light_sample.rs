//! Sampled lights, and lights hit by a ray.

use etendue_core::Spectral;
use glam::Vec3;

use super::ReceiverGloss;
use crate::geometry::SurfacePoint;

/// Light sampled for a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightSample<const N: usize> {
    /// Unit direction towards the light.
    pub direction: Vec3,
    /// The point of the light, moved off its surface by the error bound; `None` for light from infinity.
    pub target: Option<Vec3>,
    /// Spectral radiance towards the point; for a lamp without an opening the spectral irradiance of a surface that faces it.
    pub radiance: Spectral<N>,
    /// Density of the direction, including that of the choice, 1/sr; for a lamp without an opening the probability of the choice. Times the
    /// number of the receiver's samples ([`LightSampleContext::samples`]). Positive.
    pub pdf: f32,
    /// True for a lamp without an opening: only light sampling can find it.
    pub delta: bool,
    /// True for light of the surroundings, but not of a sun or a surface.
    pub is_environment: bool,
}

impl<const N: usize> LightSample<N> {
    /// Light of the surroundings; `None` if it has no usable density.
    pub(super) fn from_environment(direction: Vec3, radiance: Spectral<N>, pdf: f32) -> Option<Self> {
        let sample = Self { direction, target: None, radiance, pdf, delta: false, is_environment: true };
        (pdf > 0.0 && pdf.is_finite()).then_some(sample)
    }
}

/// Irradiance of a lamp at a receiver, the mean over the wavelengths of light selection, W·m⁻²·nm⁻¹.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct LampIrradiance {
    /// Irradiance of the receiver's surface, or of one facing the lamp if light counts from every side.
    pub(super) diffuse: f32,
    /// The same, increased by the receiver's gloss.
    pub(super) with_gloss: f32,
}

/// Light from infinity, hit by chance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DistantLight<const N: usize> {
    /// Spectral radiance.
    pub radiance: Spectral<N>,
    /// Density with which the receiver's light samples would have given this direction, 1/sr.
    pub pdf: f32,
    /// True for light of the surroundings, but not of a sun.
    pub is_environment: bool,
}

/// The light that a surface point belongs to, as seen along a ray that hit it.
#[derive(Clone, Copy, Debug)]
pub struct LightHit<'a> {
    /// The point that the ray came from.
    pub receiver: &'a LightSampleContext,
    /// The point hit.
    pub point: &'a SurfacePoint,
    /// The ray's unit direction.
    pub direction: Vec3,
    /// Length of the ray, m.
    pub distance_m: f32,
}

/// A point for which light is sampled. Its normal excludes lights that cannot reach it; its gloss raises the probability of lights that it
/// reflects.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightSampleContext {
    /// Position in the render frame, m.
    pub position: Vec3,
    /// The unit normal of the side from which light must come: the shading normal on the side of the viewer. Zero if light counts from
    /// every side.
    pub normal: Vec3,
    /// Narrow lobes; `None` if light selection need not consider any.
    pub gloss: Option<ReceiverGloss>,
    /// True if the camera sees the point straight or by mirrors, so that no scattering averages its error. A light is then selected with
    /// more care, at a higher cost. Without effect if there is `gloss`.
    pub in_view: bool,
    /// Number of lights that it samples, 1 or more. Densities of samples are those of all of them together.
    pub samples: u32,
    /// Time at which light is evaluated, s: as [`etendue_core::Ray::time_s`].
    pub time_s: f32,
}

impl LightSampleContext {
    /// A diffuse receiver out of view, at the start of the view's interval.
    #[must_use]
    pub fn diffuse(position: Vec3, normal: Vec3) -> Self {
        Self { position, normal, gloss: None, in_view: false, samples: 1, time_s: 0.0 }
    }

    /// A point in a medium, for which light counts from every side.
    #[must_use]
    pub(crate) fn in_medium(position: Vec3, time_s: f32) -> Self {
        Self { time_s, ..Self::diffuse(position, Vec3::ZERO) }
    }

    /// Light that the lobes reflect from a cone about a unit direction whose half angle has the sine `sin`, relative to the diffuse part
    /// under light from above.
    #[inline]
    pub(super) fn glossy(&self, direction: Vec3, sin: f32) -> f32 {
        self.gloss.as_ref().map_or(0.0, |gloss| gloss.relative(direction, sin))
    }
}
