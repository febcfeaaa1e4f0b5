//! Matt surfaces that draw directions by what other paths have found (`crate::guiding`).

use etendue_core::{FieldRay, Wavelengths};
use glam::{Vec2, Vec3};

use super::PathTracer;
use super::effects::{Effects, Every, Matt};
use super::path::{Intersection, MAX_MET, Path, PathStep, Vertex};
use crate::ALL_EFFECTS;
use crate::geometry::SurfacePoint;
use crate::guiding::{DirectionDistribution, GUIDED_BOUNCES, Place, Training, bin_of};
use crate::materials::{Bsdf, BsdfSample, DiffuseBsdf, Event, ShadingFrame};

impl PathTracer<'_> {
    /// Follows a path with the code for all effects: training paths are few.
    pub(super) fn train_along<const N: usize>(
        &self,
        asked: &FieldRay,
        wavelengths: &Wavelengths<N>,
        training: &Training,
    ) {
        if ALL_EFFECTS {
            Path::<N, Every>::new(self, asked, wavelengths).train(training);
        } else {
            Path::<N, Matt>::new(self, asked, wavelengths).train(training);
        }
    }
}

/// A matt surface that a path has left.
#[derive(Clone, Copy)]
struct Departure {
    place: Place,
    bin: usize,
    /// Radiance at the camera before, summed over wavelengths.
    before: f32,
    /// What radiance along the path counts at the camera from here on, likewise.
    throughput: f32,
}

impl<'a, const N: usize, E: Effects> Path<'a, N, E> {
    /// What a matt surface draws directions by.
    #[inline(always)]
    pub(super) fn guide(
        &self,
        bsdf: &Bsdf<'a, N>,
        point: &SurfacePoint,
        frame: &ShadingFrame,
    ) -> Option<&'a DirectionDistribution> {
        let guide = self.tracer.guide?;
        if self.bounces >= GUIDED_BOUNCES || !matches!(bsdf, Bsdf::Diffuse(_)) {
            return None;
        }
        guide.at(point.position, frame.normal())
    }

    /// Follows the path to its end.
    fn train(mut self, training: &Training) {
        self.branches = false;
        let mut departures = [None; GUIDED_BOUNCES as usize];
        while self.met < MAX_MET && matches!(self.train_step(&mut departures), PathStep::Goes) {
            self.met += 1;
        }
        let found = self.radiance.0.iter().sum::<f32>();
        for departure in departures.into_iter().flatten() {
            let Departure { place, bin, before, throughput } = departure;
            training.add(place, bin, (found - before) / throughput);
        }
    }

    /// To the next surface and on from it, which is noted where it is matt.
    fn train_step(&mut self, departures: &mut [Option<Departure>]) -> PathStep {
        match self.meet() {
            Intersection::Surface(point, lookup) if !self.is_spent() => {
                let (vertex, bounces) = (self.vertex(point, &lookup), self.bounces as usize);
                let step = self.scatter(&vertex);
                if let Some(noted) = departures.get_mut(bounces)
                    && matches!(step, PathStep::Goes)
                {
                    *noted = self.departure(&vertex);
                }
                step
            }
            met => self.go_on_from(met),
        }
    }

    /// How the path has left a matt surface.
    fn departure(&self, vertex: &Vertex<'a, N>) -> Option<Departure> {
        if !matches!(vertex.bsdf, Bsdf::Diffuse(_)) {
            return None;
        }
        let wi = vertex.frame.inward(self.direction())?;
        let sum = |of: &[f32; N]| of.iter().sum::<f32>();
        Some(Departure {
            place: Place::of(vertex.point.position, vertex.frame.normal()),
            bin: bin_of(wi),
            before: sum(&self.radiance.0),
            throughput: sum(&self.throughput.0),
        })
    }
}

impl<const N: usize> Vertex<'_, N> {
    /// Density with which `wi` (shading frame) is drawn, 1/sr, of a bsdf that would draw it with density `pdf`.
    #[inline(always)]
    pub(super) fn density(&self, wi: Vec3, pdf: f32) -> f32 {
        pdf * self.relative_density(wi)
    }

    /// Density with which `wi` (shading frame) is drawn over that of the bsdf. Roulette goes by the throughput times this, as if nothing
    /// led the path: a direction that is drawn often carries less, and is worth no less.
    #[inline(always)]
    pub(super) fn relative_density(&self, wi: Vec3) -> f32 {
        self.guide.map_or(1.0, |guide| guide.relative_density(wi))
    }

    /// A direction drawn by the guide; its density is told as that of the bsdf.
    #[inline(always)]
    pub(super) fn guided_sample(&self, bsdf: &DiffuseBsdf<N>, u: Vec2) -> Option<BsdfSample<N>> {
        let (wi, relative) = self.guide?.sample(u);
        let pdf = etendue_core::warp::cosine_hemisphere_pdf(wi.z);
        (pdf > 0.0).then(|| BsdfSample { wi, weight: bsdf.reflectance / relative, pdf, event: Event::Scatter })
    }
}
