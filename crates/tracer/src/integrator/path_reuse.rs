//! Paths of neighbouring pixels that share their tails.
//!
//! Neighbouring pixels see nearly the same point, so the light that one path finds behind its second surface is of use to all of them (Bekaert,
//! Sbert, Halton, "Accelerating path tracing by re-using paths", 2002). Each path of a group is traced to its second surface y. A selected part of
//! the group continues. The light L that y reflects counts for every path whose first surface x sees y:
//!
//! L_x += β_x f(x, y) cos θ_x cos θ_y / d² · L / Σ_k q p_k(y) cos θ_yk / d_k²,
//!
//! the balance heuristic over all first surfaces k that see y (Veach and Guibas 1995). Here p_k is the density (1/sr) with which the surface k
//! scatters towards y, θ_yk the angle at y's true normal, q the fraction of the group that continues. It is an unbiased estimate for each pixel, with
//! the error of many paths for the cost of few. The drawback is that errors of pixels of one group are correlated.
//!
//! Only tails that every path of the group could have found are shared. The surface y is diffuse, so that L is the same in all directions. It is hit
//! straight from x with nothing between, in air, at the same time, and under lights averaged over the same interval if the strength of any changes
//! over time. The surface x is the first that scattered the path. All other light (light hit directly, mirrors, glossy second surfaces, cut-outs and
//! panes in between) stays with its own path. Textures at y are read over the width of the path that continues.

use etendue_core::{FieldRay, Integrator, Ray, Spectral, TimeInterval, Wavelengths, random::Draw};
use glam::Vec3;

use super::PathTracer;
use super::path::{Intersection, MAX_VERTICES, Path, PathStep, Vertex};
use super::path_tracer::{Effects, SceneEffects};
use crate::materials::Bsdf;

/// Number of parts of a group. One of them continues.
const PARTS: usize = 4;

/// Minimum cosine at which a shading normal is the same for all viewers: below, it is bent towards the viewer.
const MIN_VIEW_COS: f32 = 2e-4;

/// A path up to its second surface.
struct PathPrefix<'a, const N: usize, E: Effects> {
    path: Path<'a, N, E>,
    first: Option<FirstVertex<'a, N>>,
    /// The second surface, if the light behind it may be shared.
    second: Option<Vertex<'a, N>>,
}

/// The first surface that scattered a path.
struct FirstVertex<'a, const N: usize> {
    vertex: Vertex<'a, N>,
    /// Throughput before scattering.
    throughput: Spectral<N>,
    vertex_index: u32,
}

/// The contribution of a tail to a path of the group: its weight before the balance, and its density, per area at y.
struct TailContribution<const N: usize> {
    index: usize,
    weight: Spectral<N>,
    density: f32,
}

impl<const N: usize> TailContribution<N> {
    /// `None` if the path could not have found the surface.
    fn if_valid(self) -> Option<Self> {
        (self.density > 0.0 && self.density.is_finite() && !self.weight.is_zero()).then_some(self)
    }
}

impl PathTracer<'_> {
    /// Radiance along rays whose paths share their tails.
    pub(super) fn shared_radiance<const N: usize, E: Effects>(
        &self,
        rays: &[FieldRay],
        wavelengths: &Wavelengths<N>,
        radiance: &mut Vec<Spectral<N>>,
    ) {
        let paths = rays.iter().map(|camera_ray| Path::<N, E>::new(self, camera_ray, wavelengths));
        let prefixes: Vec<_> = paths.map(PathPrefix::trace).collect();
        radiance.extend(prefixes.iter().map(|prefix| prefix.path.radiance));
        let shared = &mut radiance[..];
        let selection = TailSelection::new(rays, self.settings.samples);
        for (index, prefix) in prefixes.iter().enumerate() {
            match &prefix.second {
                Some(second) if selection.contains(index, rays.len()) => {
                    share_tail(&prefixes, index, second, selection.fraction(), shared);
                }
                _ => {}
            }
        }
    }

    /// True if paths of a group share tails.
    pub(super) fn shares_tails(&self) -> bool {
        let settings = &self.settings;
        // Between surfaces, no path can use what another has found there.
        self.effects != SceneEffects::All
            && settings.integrator == Integrator::Path
            && settings.max_bounces > 1
            && settings.branches <= 1
    }
}

/// The paths of a group that continue at one sample. The parts of the group take turns. Each part continues for a run of samples, in which
/// its points are stratified. The first part is random.
struct TailSelection {
    parts: usize,
    part: usize,
}

impl TailSelection {
    fn new(rays: &[FieldRay], samples: u32) -> Self {
        let parts = parts(rays.len());
        let stream = &rays[0].stream;
        let first = (stream.with_sample(0).one(Draw::Followed, 0) * parts as f32) as usize;
        let (run, place) = (stream.sample() / samples, stream.sample() % samples);
        // If a run has fewer samples than there are parts, each run begins with the next part.
        let turn = u64::from(place) * parts as u64 / u64::from(samples) + u64::from(run);
        Self { parts, part: (first + turn as usize) % parts }
    }

    /// True if the path of this index continues: neighbours in the list belong to one part.
    fn contains(&self, index: usize, paths: usize) -> bool {
        index * self.parts / paths == self.part
    }

    fn fraction(&self) -> f32 {
        1.0 / self.parts as f32
    }
}

/// The number of equal parts of a group: at most [`PARTS`].
fn parts(paths: usize) -> usize {
    (1..=PARTS).rev().find(|parts| paths.is_multiple_of(*parts)).unwrap_or(1)
}

/// Continues one path, and adds the radiance it finds to all paths that see its second surface.
fn share_tail<'a, const N: usize, E: Effects>(
    prefixes: &[PathPrefix<'a, N, E>],
    owner: usize,
    second: &Vertex<'a, N>,
    fraction: f32,
    radiance: &mut [Spectral<N>],
) {
    let tail = prefixes[owner].path.clone().tail(second);
    if tail.is_zero() {
        return;
    }
    let contributions: Vec<_> = (0..prefixes.len())
        .filter_map(|index| match index == owner {
            true => prefixes[index].contribution_of_own_tail(index, second),
            false => prefixes[index].contribution_of_tail(index, second, prefixes[owner].path.light_interval()),
        })
        .collect();
    let density = fraction * contributions.iter().map(|contribution| contribution.density).sum::<f32>();
    if density > 0.0 {
        for contribution in &contributions {
            // The quotient first: it is a bounded weight, whatever the light.
            radiance[contribution.index] += contribution.weight / density * tail;
        }
    }
}

impl<'a, const N: usize, E: Effects> Path<'a, N, E> {
    /// Light that a surface, which the path has just hit, scatters against it: the radiance of the rest of the path. Roulette goes on as if
    /// the path were not cut.
    fn tail(mut self, vertex: &Vertex<'a, N>) -> Spectral<N> {
        self.roulette.scale(self.throughput.max_value());
        self.throughput = Spectral::ONE;
        self.radiance = Spectral::ZERO;
        match self.scatter_at_surface(vertex) {
            PathStep::End => self.radiance,
            PathStep::Continue => {
                self.vertex_index += 1;
                self.trace()
            }
        }
    }
}

impl<'a, const N: usize, E: Effects> PathPrefix<'a, N, E> {
    /// Traces a path to its end, or to a second surface whose light may be shared.
    fn trace(mut path: Path<'a, N, E>) -> Self {
        let mut first: Option<FirstVertex<'a, N>> = None;
        while path.vertex_index < MAX_VERTICES {
            let step = match path.intersect() {
                Intersection::Nothing => PathStep::End,
                Intersection::Passed => PathStep::Continue,
                Intersection::Medium(..) | Intersection::Particle(..) => {
                    unreachable!("paths through media share nothing")
                }
                Intersection::Surface(point, lookup) if path.is_at_max_bounces() => path.only_pass(point, &lookup),
                Intersection::Surface(point, lookup) => {
                    let vertex = path.vertex(point, &lookup);
                    if first.as_ref().is_some_and(|first| first.leads_to(&path, &vertex)) {
                        return Self { path, first, second: Some(vertex) };
                    }
                    if may_be_first(&path, &vertex) {
                        first =
                            Some(FirstVertex { vertex, throughput: path.throughput, vertex_index: path.vertex_index });
                    }
                    path.scatter_at_surface(&vertex)
                }
            };
            if matches!(step, PathStep::End) {
                break;
            }
            path.vertex_index += 1;
        }
        Self { path, first, second: None }
    }

    /// The contribution of the tail to the path that found its surface.
    fn contribution_of_own_tail(&self, index: usize, second: &Vertex<'_, N>) -> Option<TailContribution<N>> {
        let per_area =
            second.frame.true_cos(-self.path.ray.direction) / (self.path.travelled_m * self.path.travelled_m);
        // The throughput holds f cos / p already.
        let density = self.path.direction_pdf? * per_area;
        TailContribution { index, weight: self.path.throughput * density, density }.if_valid()
    }

    /// The contribution of the tail of another path; `None` if this path could not have found its surface.
    fn contribution_of_tail(
        &self,
        index: usize,
        second: &Vertex<'_, N>,
        light_interval: &TimeInterval,
    ) -> Option<TailContribution<N>> {
        let first = self.first.as_ref()?;
        if first.vertex.point.time_s != second.point.time_s || !self.is_lit_over(light_interval) {
            return None;
        }
        let between = second.point.position - first.vertex.point.position;
        let direction = between.try_normalize()?;
        if -direction.dot(second.frame.normal()) < MIN_VIEW_COS {
            return None;
        }
        let per_area = second.frame.true_cos(-direction) / between.length_squared();
        let wi = first.vertex.frame.inward(direction)?;
        let value = self.path.evaluate(&first.vertex, wi);
        let weight = first.throughput * value.value_cos * per_area;
        let density = first.vertex.density(wi, value.pdf) * per_area;
        let contribution = TailContribution { index, weight, density }.if_valid()?;
        self.sees(first, second, direction).then_some(contribution)
    }

    /// True if the strengths of lights for this path equal their averages over `lit`.
    fn is_lit_over(&self, light_interval: &TimeInterval) -> bool {
        !self.path.tracer.is_modulated || self.path.light_interval() == light_interval
    }

    /// True if nothing stands between two surfaces.
    fn sees(&self, first: &FirstVertex<'_, N>, second: &Vertex<'_, N>, direction: Vec3) -> bool {
        let origin = first.vertex.point.spawn(direction);
        let across = second.point.spawn(-direction) - origin;
        let mut ray = Ray::new(origin, across, self.path.ray.time_s).leaving(first.vertex.point.primitive_id());
        ray.t_max = 1.0;
        !self.path.tracer.view.occluded(&ray)
    }
}

impl<const N: usize> FirstVertex<'_, N> {
    /// True if the light that the surface `second`, just hit, sends to this one may be shared.
    fn leads_to<E: Effects>(&self, path: &Path<'_, N, E>, second: &Vertex<'_, N>) -> bool {
        let straight = path.vertex_index == self.vertex_index + 1 && path.bounces == 1 && path.direction_pdf.is_some();
        straight && matches!(second.bsdf, Bsdf::Diffuse(_)) && second.frame.wo.z >= MIN_VIEW_COS
    }
}

/// True if a surface that a path has just hit is the first to scatter it, in air.
fn may_be_first<const N: usize, E: Effects>(path: &Path<'_, N, E>, vertex: &Vertex<'_, N>) -> bool {
    let scatters = !matches!(vertex.bsdf, Bsdf::Absorber);
    path.bounces == 0 && scatters && (!E::SURFACES || is_open(path, vertex))
}

/// True if a surface scatters by a finite density, in air and into air.
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

    /// Runs of 1, 2, 4 and 16 samples; runs of one or two are shorter than the number of parts.
    #[test]
    fn every_part_has_its_turns_however_short_runs_are() {
        let frame = FrameAddress { seed: 3, ..FrameAddress::default() };
        let address = PixelAddress { frame, pixel: Pixel { x: 4, y: 2 }, replicate: 1 };
        for samples in [1, 2, 4, 16] {
            let mut turns = [0; PARTS];
            for sample in 0..64 {
                let stream = PathStream::new(&address, sample);
                let ray = FieldRay {
                    ray: Ray::new(Vec3::ZERO, Vec3::Z, 0.0),
                    stream,
                    light_interval: TimeInterval::default(),
                };
                turns[TailSelection::new(&[ray; 16], samples).part] += 1;
            }
            assert_eq!(turns, [64 / PARTS; PARTS], "{samples}");
        }
    }
}
