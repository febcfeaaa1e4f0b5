//! All media of a view.

use etendue_core::random::{Draw, PathStream};
use etendue_core::{Ray, Spectral, TimeInterval, Wavelengths, maths::f64::exp};
use glam::{DAffine3, DVec3, Vec3};

use super::medium::{ForwardPeak, Medium, MediumOptics};
use super::{phase::Phase, shape::HollowRegion};

/// Weight of a medium relative to the part of a ray that lies in it, if light is sampled at the middles of longer parts.
const OUTSIDE_WEIGHT: f32 = 0.05;

/// Maximum number of steps of ratio tracking along one ray. If more are needed, nothing comes through.
const MAX_STEPS: u32 = 4096;

/// A ray through media.
#[derive(Clone, Copy, Debug)]
pub struct MediaRay<'r> {
    pub ray: &'r Ray,
    /// Treatment of forward peaks.
    pub peak: ForwardPeak,
}

/// Random numbers of a stream from a counter on.
#[derive(Clone, Copy, Debug)]
pub struct RandomCounter<'s> {
    pub stream: &'s PathStream,
    /// First value of the counter.
    pub counter: u32,
}

/// Start and end of a part of a ray, in lengths of its direction.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RaySpan {
    pub(crate) from: f64,
    pub(crate) to: f64,
}

/// All media of a view.
#[derive(Clone, Debug)]
pub struct Media<'a> {
    pub(super) placed: Vec<PlacedMedium<'a>>,
    origin_m: DVec3,
    interval: TimeInterval,
}

/// A medium in the world.
#[derive(Clone, Debug)]
pub(super) struct PlacedMedium<'a> {
    pub(super) medium: &'a Medium,
    /// Transform from the render frame to the medium's own, if it does not move.
    to_local: Option<DAffine3>,
    /// Parts of it that are left out near the origin of the render frame.
    pub(super) hollow: Option<HollowRegion>,
}

/// A part of a ray, in lengths of its direction.
#[derive(Clone, Copy, Debug)]
pub(super) struct RayPiece {
    pub(super) end: f64,
    /// Maximum extinction of all media in it, 1/m.
    pub(super) majorant_per_m: f64,
}

impl<'a> Media<'a> {
    /// The media of a view whose render frame is about `origin_m` of the world, during an interval.
    #[must_use]
    pub fn new(media: &'a [Medium], origin_m: DVec3, interval: TimeInterval) -> Self {
        let place = |medium: &'a Medium| {
            let to_local = medium.to_world.constant_over(interval).map(|to_world| {
                let mut to_render = to_world;
                to_render.translation -= origin_m;
                to_render.inverse()
            });
            PlacedMedium { medium, to_local, hollow: None }
        };
        Self { placed: media.iter().map(place).collect(), origin_m, interval }
    }

    /// Leaves out parts of one medium, by its index in the list, near the origin of the render frame. Its density must be uniform.
    #[must_use]
    pub fn with_hollow(mut self, medium: usize, hollow: HollowRegion) -> Self {
        self.placed[medium].hollow = Some(hollow);
        self
    }

    /// The phase function of a medium, by its index in the list.
    #[must_use]
    pub fn phase(&self, medium: usize) -> &'a Phase {
        &self.placed[medium].medium.optics(ForwardPeak::Exact).phase
    }

    /// True if there are no media.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.placed.is_empty()
    }

    /// Start and end of a ray's part in a medium, before `end`; in lengths of the ray's direction.
    pub(super) fn span(&self, placed: &PlacedMedium<'_>, ray: &Ray, end: f64) -> Option<RaySpan> {
        let (origin, direction) = self.local(placed, ray);
        placed.medium.shape.span(origin, direction, end).map(|(from, to)| RaySpan { from, to })
    }

    /// Length of a ray inside a medium up to `end`, between its entry and its exit; in lengths of the ray's direction.
    pub(super) fn inside(&self, placed: &PlacedMedium<'_>, ray: &Ray, span: RaySpan) -> f64 {
        let Some(solid) = placed.medium.shape.gaps() else { return span.to - span.from };
        let (origin, direction) = self.local(placed, ray);
        solid.parts(origin, direction, span.to).iter().map(|(from, to)| to - from).sum()
    }

    /// A ray's origin and direction in a medium's own frame.
    #[inline]
    fn local(&self, placed: &PlacedMedium<'_>, ray: &Ray) -> (DVec3, DVec3) {
        let (origin, direction) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
        let to_local = placed.to_local.unwrap_or_else(|| {
            let mut to_render = placed.medium.to_world.at(self.interval.moment(ray.time_s));
            to_render.translation -= self.origin_m;
            to_render.inverse()
        });
        (to_local.transform_point3(origin), to_local.transform_vector3(direction))
    }

    /// Start and end, before `end`, of the part of a ray that lies in any medium; `None` if none does. In lengths of the ray's direction.
    pub(crate) fn reach(&self, ray: &Ray, end: f64) -> Option<RaySpan> {
        let spans = self.placed.iter().filter_map(|placed| self.span(placed, ray, end));
        spans.reduce(|all, one| RaySpan { from: all.from.min(one.from), to: all.to.max(one.to) })
    }

    /// Scattering coefficient at `t` along a ray for light that arrives from the unit direction `to`: Σ β albedo p, 1/(m sr).
    pub(crate) fn scattering<const N: usize>(
        &self,
        media_ray: MediaRay<'_>,
        t: f64,
        to: Vec3,
        wavelengths: &Wavelengths<N>,
    ) -> Spectral<N> {
        let MediaRay { ray, peak } = media_ray;
        let mut sum = Spectral::ZERO;
        for placed in &self.placed {
            if self.span(placed, ray, f64::INFINITY).is_some_and(|span| t >= span.from && t <= span.to) {
                let density = self.density(placed, ray, t) as f32;
                let MediumOptics { extinction, albedo, phase, .. } = placed.medium.optics(peak);
                let values = Spectral(phase.values(ray.direction, to, wavelengths));
                sum += extinction.sample(wavelengths) * albedo.sample(wavelengths) * values * density;
            }
        }
        sum
    }

    /// Approximate fraction of light arriving at `t` along a ray from the unit direction `to` that reaches the ray's start, 1/(m sr). It is
    /// the mean over the wavelengths, except for the phase function, which is that of the first, and assumes uniform densities. For
    /// importance sampling: positive all along a ray that hits anything.
    pub(crate) fn about<const N: usize>(&self, ray: &Ray, t: f64, to: Vec3, wavelengths: &Wavelengths<N>) -> f32 {
        let (mut scattered, mut depth) = (0.0, 0.0);
        for placed in &self.placed {
            let Some(RaySpan { from, to: end }) = self.span(placed, ray, f64::INFINITY) else { continue };
            let MediumOptics { extinction, albedo, phase, .. } = placed.medium.optics(ForwardPeak::Exact);
            let extinction = extinction.sample(wavelengths);
            depth += f64::from(extinction.mean()) * (t.clamp(from, end) - from);
            let density = phase.density_at(ray.direction, to, wavelengths.nm[0]);
            let counts = if t >= from && t <= end { 1.0 } else { OUTSIDE_WEIGHT };
            scattered += counts * (extinction * albedo.sample(wavelengths)).mean() * density;
        }
        scattered * exp(-depth) as f32
    }

    /// The part of a ray from `t` on that lies in the same media.
    pub(super) fn piece(&self, media_ray: MediaRay<'_>, t: f64, end: f64) -> RayPiece {
        let MediaRay { ray, peak } = media_ray;
        let mut piece = RayPiece { end, majorant_per_m: 0.0 };
        for placed in &self.placed {
            let Some(RaySpan { from, to }) = self.span(placed, ray, end) else { continue };
            if t < from {
                piece.end = piece.end.min(from);
            } else if t < to {
                piece.end = piece.end.min(to);
                piece.majorant_per_m += f64::from(placed.medium.optics(peak).max_per_m * placed.medium.max_density());
            }
        }
        piece
    }

    /// The density of a medium at `t` along a ray, over its mean.
    pub(super) fn density(&self, placed: &PlacedMedium<'_>, ray: &Ray, t: f64) -> f64 {
        if let Some(hollow) = &placed.hollow {
            return hollow.density((ray.origin.as_dvec3() + ray.direction.as_dvec3() * t).length());
        }
        if let Some(solid) = placed.medium.shape.gaps() {
            let (origin, direction) = self.local(placed, ray);
            if !solid.parts(origin, direction, f64::INFINITY).iter().any(|(from, to)| t >= *from && t < *to) {
                return 0.0;
            }
        }
        if placed.medium.unevenness.is_none() {
            return 1.0;
        }
        let point = self.origin_m + ray.origin.as_dvec3() + ray.direction.as_dvec3() * t;
        placed.medium.density(point, self.interval.moment(ray.time_s))
    }

    /// Transmittance along a ray up to its `t_max`: exact for uniform densities, else an unbiased estimate by random numbers from the
    /// sub-counter of `random` on. Estimates that are multiplied with each other need separate counters.
    #[must_use]
    pub fn transmittance<const N: usize>(
        &self,
        media_ray: MediaRay<'_>,
        random: RandomCounter<'_>,
        wavelengths: &Wavelengths<N>,
    ) -> Spectral<N> {
        let MediaRay { ray, peak } = media_ray;
        let (mut depth, mut fraction) = ([0.0_f64; N], Spectral::ONE);
        let length_m = f64::from(ray.direction.length());
        for (i, placed) in self.placed.iter().enumerate() {
            let Some(span) = self.span(placed, ray, f64::from(ray.t_max)) else { continue };
            let optics = placed.medium.optics(peak);
            let extinction = optics.extinction.sample(wavelengths);
            if let Some(hollow) = &placed.hollow {
                let length = hollow.path_length(ray.origin.as_dvec3(), ray.direction.as_dvec3(), span.from, span.to);
                (0..N).for_each(|k| depth[k] += f64::from(extinction[k]) * length * length_m);
            } else if placed.medium.unevenness.is_none() {
                let inside = self.inside(placed, ray, span);
                // Without a medium the optical depth is zero, however long the ray.
                (0..N)
                    .filter(|k| extinction[*k] > 0.0)
                    .for_each(|k| depth[k] += f64::from(extinction[k]) * inside * length_m);
            } else {
                let majorant_per_m = optics.max_per_m * placed.medium.max_density();
                let random = RandomCounter { counter: counter_of(random.counter, i), ..random };
                fraction *= self.ratio_tracked(placed, ray, span, random, extinction, majorant_per_m);
            }
        }
        fraction * Spectral(depth.map(|depth| exp(-depth) as f32))
    }

    fn ratio_tracked<const N: usize>(
        &self,
        placed: &PlacedMedium<'_>,
        ray: &Ray,
        span: RaySpan,
        random: RandomCounter<'_>,
        extinction: Spectral<N>,
        majorant_per_m: f32,
    ) -> Spectral<N> {
        let majorant = f64::from(majorant_per_m) * f64::from(ray.direction.length());
        let (mut t, mut fraction) = (span.from, Spectral::ONE);
        if majorant == 0.0 {
            return fraction;
        }
        for step in 0..MAX_STEPS {
            t += free_flight(random.stream.one(Draw::Transmittance, random.counter.wrapping_add(step))) / majorant;
            if t >= span.to {
                return fraction;
            }
            let density = self.density(placed, ray, t) as f32;
            fraction *= extinction.map(|extinction| (1.0 - extinction * density / majorant_per_m).max(0.0));
            if fraction.is_zero() {
                return fraction;
            }
        }
        Spectral::ZERO
    }
}

/// The first of [`MAX_STEPS`] counters of a medium's random numbers at a vertex: those of 256 media and 4096 vertices are distinct.
fn counter_of(vertex: u32, medium: usize) -> u32 {
    vertex.wrapping_mul(256).wrapping_add(medium as u32 & 255).wrapping_mul(MAX_STEPS)
}

/// The optical depth that a flight exceeds with the probability 1 − u.
pub(super) fn free_flight(u: f32) -> f64 {
    -etendue_core::maths::f64::ln_1p(-f64::from(u))
}

/// Maximum number of steps of the quadrature along one ray.
const MAX_QUADRATURE_STEPS: f64 = 8192.0;

/// Steps per smallest eddy.
const STEPS_PER_EDDY: f64 = 6.0;

impl Media<'_> {
    /// ∫ density dt up to a ray's `t_max`, m, of each medium: the length of mean density with the same attenuation. Infinite for an
    /// infinite length. Non-uniform densities are summed at the middles of at least six steps per smallest eddy, but of at most 8 192
    /// steps.
    #[must_use]
    pub fn columns_m(&self, ray: &Ray) -> Vec<f64> {
        self.placed.iter().map(|placed| self.column_m(placed, ray)).collect()
    }

    fn column_m(&self, placed: &PlacedMedium<'_>, ray: &Ray) -> f64 {
        let Some(span) = self.span(placed, ray, f64::from(ray.t_max)) else { return 0.0 };
        let RaySpan { from, to } = span;
        let length_m = (to - from) * f64::from(ray.direction.length());
        if let Some(hollow) = &placed.hollow {
            let length = hollow.path_length(ray.origin.as_dvec3(), ray.direction.as_dvec3(), from, to);
            return length * f64::from(ray.direction.length());
        }
        let Some(unevenness) = placed.medium.unevenness.filter(|_| length_m.is_finite()) else {
            return self.inside(placed, ray, span) * f64::from(ray.direction.length());
        };
        let steps = (length_m / unevenness.noise.smallest_m() * STEPS_PER_EDDY).ceil().clamp(1.0, MAX_QUADRATURE_STEPS);
        let middles = (0..steps as u32).map(|i| from + (f64::from(i) + 0.5) / steps * (to - from));
        length_m * middles.map(|t| self.density(placed, ray, t)).sum::<f64>() / steps
    }
}
