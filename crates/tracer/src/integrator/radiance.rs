//! Entry points of the path tracer: radiance along rays, alone and in groups, and the training of a guide (`crate::guiding`). Each runs the code
//! compiled for the scene's effects.

use etendue_core::{FieldRay, RadianceField, Spectral, Wavelengths};

use super::path::{Intersection, MAX_VERTICES, Path, PathStep, Vertex};
use super::path_tracer::{AllEffects, DiffuseOnly, Effects, NoMedia, PathTracer, SceneEffects};
use crate::guiding::{GUIDED_BOUNCES, GuideCell, Training, bin_of};
use crate::{ALL_EFFECTS, materials::Bsdf};

/// Paths of `N` wavelengths, where `N` is 1, 4 or 8.
pub trait SpectralPaths<const N: usize>: RadianceField<N> {
    /// Traces a path and adds the radiance that it finds behind its first diffuse surfaces to `training`. The tracer must have no guide.
    fn train(&self, camera_ray: &FieldRay, wavelengths: &Wavelengths<N>, training: &Training);
}

/// Implements paths of `N` wavelengths. The implementations are not generic, so that this crate compiles them once and no other crate does.
macro_rules! spectral_paths {
    ($($n:literal)*) => {$(
        impl RadianceField<$n> for PathTracer<'_> {
            fn radiance(&self, camera_ray: &FieldRay, wavelengths: &Wavelengths<$n>) -> Spectral<$n> {
                self.radiance_along(camera_ray, wavelengths)
            }

            fn radiance_of_group(
                &self,
                rays: &[FieldRay],
                wavelengths: &Wavelengths<$n>,
                radiance: &mut Vec<Spectral<$n>>,
            ) {
                self.radiance_along_group(rays, wavelengths, radiance);
            }
        }

        impl SpectralPaths<$n> for PathTracer<'_> {
            fn train(&self, camera_ray: &FieldRay, wavelengths: &Wavelengths<$n>, training: &Training) {
                self.train_along(camera_ray, wavelengths, training);
            }
        }
    )*};
}

spectral_paths!(1 4 8);

impl PathTracer<'_> {
    fn radiance_along<const N: usize>(&self, camera_ray: &FieldRay, wavelengths: &Wavelengths<N>) -> Spectral<N> {
        match self.effects {
            SceneEffects::DiffuseOnly => self.radiance_with::<N, DiffuseOnly>(camera_ray, wavelengths),
            _ if !ALL_EFFECTS => unreachable!("a scene without optional effects"),
            SceneEffects::NoMedia => self.radiance_with::<N, NoMedia>(camera_ray, wavelengths),
            SceneEffects::All => self.radiance_with::<N, AllEffects>(camera_ray, wavelengths),
        }
    }

    fn radiance_with<const N: usize, E: Effects>(
        &self,
        camera_ray: &FieldRay,
        wavelengths: &Wavelengths<N>,
    ) -> Spectral<N> {
        Path::<N, E>::new(self, camera_ray, wavelengths).trace()
    }

    fn radiance_along_group<const N: usize>(
        &self,
        rays: &[FieldRay],
        wavelengths: &Wavelengths<N>,
        radiance: &mut Vec<Spectral<N>>,
    ) {
        if rays.len() < 2 || !self.shares_tails() {
            radiance.extend(rays.iter().map(|camera_ray| self.radiance_along(camera_ray, wavelengths)));
            return;
        }
        match self.effects {
            SceneEffects::DiffuseOnly => self.shared_radiance::<N, DiffuseOnly>(rays, wavelengths, radiance),
            // With media, paths share nothing.
            SceneEffects::NoMedia | SceneEffects::All => {
                self.shared_radiance::<N, NoMedia>(rays, wavelengths, radiance);
            }
        }
    }

    /// Traces a path with the code for all effects: training paths are few.
    fn train_along<const N: usize>(&self, camera_ray: &FieldRay, wavelengths: &Wavelengths<N>, training: &Training) {
        if ALL_EFFECTS {
            Path::<N, AllEffects>::new(self, camera_ray, wavelengths).train(training);
        } else {
            Path::<N, DiffuseOnly>::new(self, camera_ray, wavelengths).train(training);
        }
    }
}

/// The direction in which a training path has left a diffuse surface.
#[derive(Clone, Copy)]
struct TrainingVertex {
    place: GuideCell,
    bin: usize,
    /// Radiance at the camera before, summed over wavelengths.
    radiance_before: f32,
    /// Weight at the camera of radiance along the path from here on, summed over wavelengths.
    throughput: f32,
}

impl<'a, const N: usize, E: Effects> Path<'a, N, E> {
    /// Traces the path to its end and adds the radiance found behind its first diffuse surfaces.
    fn train(mut self, training: &Training) {
        self.branches = false;
        let mut vertices = [None; GUIDED_BOUNCES as usize];
        while self.vertex_index < MAX_VERTICES && matches!(self.train_step(&mut vertices), PathStep::Continue) {
            self.vertex_index += 1;
        }
        let radiance = self.radiance.0.iter().sum::<f32>();
        for vertex in vertices.into_iter().flatten() {
            let TrainingVertex { place, bin, radiance_before, throughput } = vertex;
            training.add(place, bin, (radiance - radiance_before) / throughput);
        }
    }

    /// Moves to the next surface and on from it; stores the vertex if the surface is diffuse.
    fn train_step(&mut self, vertices: &mut [Option<TrainingVertex>]) -> PathStep {
        match self.intersect() {
            Intersection::Surface(point, lookup) if !self.is_at_max_bounces() => {
                let (vertex, bounces) = (self.vertex(point, &lookup), self.bounces as usize);
                let step = self.scatter_at_surface(&vertex);
                if let Some(noted) = vertices.get_mut(bounces)
                    && matches!(step, PathStep::Continue)
                {
                    *noted = self.training_vertex(&vertex);
                }
                step
            }
            intersection => self.scatter(intersection),
        }
    }

    /// The direction in which the path has left a surface; `None` if the surface is not diffuse.
    fn training_vertex(&self, vertex: &Vertex<'a, N>) -> Option<TrainingVertex> {
        if !matches!(vertex.bsdf, Bsdf::Diffuse(_)) {
            return None;
        }
        let wi = vertex.frame.inward(self.ray.direction)?;
        let sum = |values: &[f32; N]| values.iter().sum::<f32>();
        Some(TrainingVertex {
            place: GuideCell::new(vertex.point.position, vertex.frame.normal()),
            bin: bin_of(wi),
            radiance_before: sum(&self.radiance.0),
            throughput: sum(&self.throughput.0),
        })
    }
}
