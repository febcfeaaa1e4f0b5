//! Paths of neighbouring pixels that share their tails.
//!
//! Neighbouring pixels see nearly the same point, so what one path finds behind its second surface is of use to all of
//! them (Bekaert, Sbert, Halton, "Accelerating path tracing by re-using paths", 2002). Each path of a group is followed to
//! its second surface y. A drawn part of the group follows its path on, and the light L that y throws back counts for every
//! path whose first surface x sees y:
//!
//! L_x += β_x f(x, y) cos θ_x cos θ_y / d² · L / Σ_k q p_k(y) cos θ_yk / d_k²,
//!
//! the balance heuristic over all first surfaces k that see y (Veach and Guibas 1995): p_k is the density (1/sr) with which
//! the surface k scatters towards y, θ_yk the angle at y's true normal, q the share of the group that is followed on. It is
//! an unbiased estimate for each pixel, with the error of many paths for the price of few. The price is that errors of
//! pixels of one group are alike.
//!
//! Shared is what every path of the group could have found: y is matt, so that L is the same in all directions, is met
//! straight from x with nothing between, in air, at the same time, under lights averaged over the same time where any goes up and down, and x is the first surface that scattered the path. All else (light
//! met directly, mirrors, glossy second surfaces, cut-outs and panes in between) stays with its own path. Textures at y are
//! read over the width of the path that is followed on.

use etendue_core::random::Draw;
use etendue_core::{FieldRay, Ray, Spectral, TimeInterval, Wavelengths};
use glam::Vec3;

use super::effects::{Effects, SceneEffects};
use super::path::{Intersection, MAX_MET, Path, PathStep, Vertex};
use super::{Level, PathTracer};
use crate::materials::Bsdf;

/// One part of so many of a group is followed on.
const PARTS: usize = 4;

/// Cosine from which on a shading normal is the same for all who look: below, it is bent towards the viewer.
const UNBENT: f32 = 2e-4;

/// A path up to its second surface.
struct Opening<'a, const N: usize, E: Effects> {
    path: Path<'a, N, E>,
    first: Option<First<'a, N>>,
    /// The second surface, where what lies behind it may be shared.
    second: Option<Vertex<'a, N>>,
}

/// The first surface that scattered a path.
struct First<'a, const N: usize> {
    vertex: Vertex<'a, N>,
    /// Before scattering.
    throughput: Spectral<N>,
    met: u32,
}

/// What a path of the group would get of a tail: its weight before the balance, and its density, per area at y.
struct Claim<const N: usize> {
    index: usize,
    weight: Spectral<N>,
    density: f32,
}

impl<const N: usize> Claim<N> {
    /// `None` where the surface could not have been found.
    fn if_sound(self) -> Option<Self> {
        (self.density > 0.0 && self.density.is_finite() && !self.weight.is_zero()).then_some(self)
    }
}

impl PathTracer<'_> {
    /// Radiance along rays whose paths share their tails.
    pub(super) fn radiance_shared<const N: usize, E: Effects>(
        &self,
        rays: &[FieldRay],
        wavelengths: &Wavelengths<N>,
        radiance: &mut Vec<Spectral<N>>,
    ) {
        let paths = rays.iter().map(|asked| Path::<N, E>::new(self, asked, wavelengths));
        let openings: Vec<_> = paths.map(Opening::of).collect();
        radiance.extend(openings.iter().map(|opening| opening.path.radiance));
        let shared = &mut radiance[..];
        let followed = Followed::of(rays, self.settings.samples);
        for (index, opening) in openings.iter().enumerate() {
            if let Some(second) = opening.second.as_ref().filter(|_| followed.holds(index, rays.len())) {
                share_tail(&openings, index, second, followed.share(), shared);
            }
        }
    }

    /// Whether paths of a group share anything.
    pub(super) fn shares(&self) -> bool {
        let settings = &self.settings;
        // Between surfaces no path sees what another has found there.
        self.effects != SceneEffects::Every
            && settings.level == Level::Path
            && settings.max_bounces > 1
            && settings.branches <= 1
    }
}

/// Which paths of a group are followed on at one sample: the parts of the group take turns, and each has a run of samples,
/// in which its points are stratified. Which part begins is drawn.
struct Followed {
    parts: usize,
    part: usize,
}

impl Followed {
    fn of(rays: &[FieldRay], samples: u32) -> Self {
        let parts = parts(rays.len());
        let stream = &rays[0].stream;
        let first = (stream.with_sample(0).one(Draw::Followed, 0) * parts as f32) as usize;
        let (run, place) = (stream.sample() / samples, stream.sample() % samples);
        // Runs of fewer samples than parts begin one part on each.
        let turn = u64::from(place) * parts as u64 / u64::from(samples) + u64::from(run);
        Self { parts, part: (first + turn as usize) % parts }
    }

    /// Whether the path of this place is followed on: neighbours in the list belong to one part.
    fn holds(&self, index: usize, of: usize) -> bool {
        index * self.parts / of == self.part
    }

    fn share(&self) -> f32 {
        1.0 / self.parts as f32
    }
}

/// Into how many equal parts a group falls: at most [`PARTS`].
fn parts(of: usize) -> usize {
    (1..=PARTS).rev().find(|parts| of.is_multiple_of(*parts)).unwrap_or(1)
}

/// Follows one path on, and gives what it finds to all that see its second surface.
fn share_tail<'a, const N: usize, E: Effects>(
    openings: &[Opening<'a, N, E>],
    owner: usize,
    second: &Vertex<'a, N>,
    share: f32,
    radiance: &mut [Spectral<N>],
) {
    let tail = openings[owner].path.clone().tail(second);
    if tail.is_zero() {
        return;
    }
    let claims: Vec<_> = (0..openings.len())
        .filter_map(|index| match index == owner {
            true => openings[index].own_claim(index, second),
            false => openings[index].claim(index, second, openings[owner].path.lit()),
        })
        .collect();
    let density = share * claims.iter().map(|claim| claim.density).sum::<f32>();
    if density > 0.0 {
        // The quotient first: it is a bounded weight, whatever the light.
        claims.iter().for_each(|claim| radiance[claim.index] += claim.weight / density * tail);
    }
}

impl<'a, const N: usize, E: Effects> Opening<'a, N, E> {
    /// Follows a path to the end, or to a second surface whose light may be shared.
    fn of(mut path: Path<'a, N, E>) -> Self {
        let mut first: Option<First<'a, N>> = None;
        while path.met < MAX_MET {
            let onward = match path.meet() {
                Intersection::Nothing => PathStep::Ends,
                Intersection::Passed => PathStep::Goes,
                Intersection::Medium(..) | Intersection::Particle(..) => {
                    unreachable!("paths through media share nothing")
                }
                Intersection::Surface(point, lookup) if path.is_spent() => path.only_pass(point, &lookup),
                Intersection::Surface(point, lookup) => {
                    let vertex = path.vertex(point, &lookup);
                    if first.as_ref().is_some_and(|first| first.leads_to(&path, &vertex)) {
                        return Self { path, first, second: Some(vertex) };
                    }
                    if may_be_first(&path, &vertex) {
                        first = Some(First { vertex, throughput: path.throughput, met: path.met });
                    }
                    path.scatter(&vertex)
                }
            };
            if matches!(onward, PathStep::Ends) {
                break;
            }
            path.met += 1;
        }
        Self { path, first, second: None }
    }

    /// What the path that found the second surface would get of its tail.
    fn own_claim(&self, index: usize, second: &Vertex<'_, N>) -> Option<Claim<N>> {
        let per_area = second.frame.true_cos(-self.path.direction()) / (self.path.travelled_m * self.path.travelled_m);
        // The throughput holds f cos / p already.
        let density = self.path.scattered? * per_area;
        Claim { index, weight: self.path.throughput * density, density }.if_sound()
    }

    /// What the path would get of the tail of another; `None` where it could not have found its second surface.
    fn claim(&self, index: usize, second: &Vertex<'_, N>, lit: &TimeInterval) -> Option<Claim<N>> {
        let first = self.first.as_ref()?;
        if first.vertex.point.time_s != second.point.time_s || !self.is_lit_over(lit) {
            return None;
        }
        let between = second.point.position - first.vertex.point.position;
        let direction = between.try_normalize()?;
        if -direction.dot(second.frame.normal()) < UNBENT {
            return None;
        }
        let per_area = second.frame.true_cos(-direction) / between.length_squared();
        let wi = first.vertex.frame.inward(direction)?;
        let value = self.path.evaluate(&first.vertex, wi);
        let weight = first.throughput * value.value_cos * per_area;
        let density = first.vertex.density(wi, value.pdf) * per_area;
        let claim = Claim { index, weight, density }.if_sound()?;
        self.sees(first, second, direction).then_some(claim)
    }

    /// Whether the path sees lights as strong as one that averages them over `lit`.
    fn is_lit_over(&self, lit: &TimeInterval) -> bool {
        !self.path.tracer.is_modulated || self.path.lit() == lit
    }

    /// Whether nothing stands between two surfaces.
    fn sees(&self, first: &First<'_, N>, second: &Vertex<'_, N>, direction: Vec3) -> bool {
        let origin = first.vertex.point.spawn(direction);
        let across = second.point.spawn(-direction) - origin;
        let mut ray = Ray::new(origin, across, self.path.time_s()).leaving(first.vertex.point.primitive_id());
        ray.t_max = 1.0;
        !self.path.tracer.view.occluded(&ray)
    }
}

impl<const N: usize> First<'_, N> {
    /// Whether light that the surface `second`, just met, throws on this one may be shared.
    fn leads_to<E: Effects>(&self, path: &Path<'_, N, E>, second: &Vertex<'_, N>) -> bool {
        let straight = path.met == self.met + 1 && path.bounces == 1 && path.scattered.is_some();
        straight && matches!(second.bsdf, Bsdf::Diffuse(_)) && second.frame.wo.z >= UNBENT
    }
}

/// Whether a surface that a path has just met is the first to scatter it, in air.
fn may_be_first<const N: usize, E: Effects>(path: &Path<'_, N, E>, vertex: &Vertex<'_, N>) -> bool {
    let scatters = !matches!(vertex.bsdf, Bsdf::Absorber);
    path.bounces == 0 && scatters && (!E::SURFACES || is_open(path, vertex))
}

/// Whether a surface scatters by a finite density, in air and into air.
fn is_open<const N: usize, E: Effects>(path: &Path<'_, N, E>, vertex: &Vertex<'_, N>) -> bool {
    let in_air = path.medium.is_clear() && path.tracer.material_table.solid(vertex.material).is_none();
    in_air && !vertex.bsdf.is_delta()
}

#[cfg(test)]
mod tests {
    use super::*;
    use etendue_core::random::{FrameAddress, PathStream, Pixel, PixelAddress};
    use etendue_core::{Ray, TimeInterval};
    use glam::Vec3;

    /// Runs of 1, 2, 4 and 16 samples, of which those of one or two are shorter than the number of parts.
    #[test]
    fn every_part_has_its_turns_however_short_runs_are() {
        let frame = FrameAddress { seed: 3, ..FrameAddress::default() };
        let address = PixelAddress { frame, pixel: Pixel { x: 4, y: 2 }, replicate: 1 };
        for samples in [1, 2, 4, 16] {
            let mut turns = [0; PARTS];
            for sample in 0..64 {
                let stream = PathStream::new(&address, sample);
                let ray = FieldRay { ray: Ray::new(Vec3::ZERO, Vec3::Z, 0.0), stream, lit: TimeInterval::default() };
                turns[Followed::of(&[ray; 16], samples).part] += 1;
            }
            assert_eq!(turns, [64 / PARTS; PARTS], "{samples}");
        }
    }
}
