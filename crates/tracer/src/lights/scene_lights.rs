//! All lights of a view, and the distribution of samples among them.

use etendue_core::{Spectral, WavelengthRange, Wavelengths};
use glam::{Vec2, Vec3};

use super::collect::{self, LightError};
use super::light::{Light, Primitives};
use super::light_sample::{DistantLight, LampIrradiance, LightHit, LightSample, LightSampleContext};
use super::light_sampler::{LightId, LightSampler, SampledLight, WeightedSun};
use super::tree::{TreeQuery, TreeStart};
use super::{environment::Environment, lamp::Lamp, sun::Sun};
use crate::materials::{EmissionQuery, MaterialTable};
use crate::{ALL_EFFECTS, geometry::SurfacePoint, is_optional, render_space::RenderSpace};

/// All lights of a view.
#[derive(Clone, Debug)]
pub struct Lights {
    pub(super) lights: Vec<Light>,
    pub(super) sampler: LightSampler,
    pub(super) primitives: Primitives,
    /// Indices of the lamps without an opening.
    pub(super) points: Vec<usize>,
    has_openings: bool,
    are_modulated: bool,
    pub(super) suns: Vec<Sun>,
    pub(super) environment: Option<Environment>,
}

impl Lights {
    /// The lights of a view: its emitting surfaces, and `sources`. The wavelengths of `range` determine the distribution of samples among
    /// the lights.
    ///
    /// # Errors
    /// If an instance names a material that the material_table does not have.
    pub fn new(
        view: &RenderSpace<'_>,
        material_table: &MaterialTable,
        sources: Sources,
        range: WavelengthRange,
    ) -> Result<Self, LightError> {
        let are_modulated = sources.is_modulated();
        let Sources { suns, lamps, environment } = sources;
        let mut scene_lights = collect::collect_surface_lights(view, material_table, range)?;
        for lamp in lamps {
            scene_lights.add_lamp(lamp, view, material_table, range)?;
        }
        let points = (0..scene_lights.lights.len()).filter(|i| scene_lights.lights[*i].is_point()).collect();
        let has_openings = scene_lights.lights.iter().any(Light::is_open);
        let irradiance = |sun: &Sun| sun.mean_irradiance(range.low_nm, range.high_nm) as f32;
        let weighted_suns: Vec<_> =
            suns.iter().map(|sun| WeightedSun { sun: sun.clone(), irradiance: irradiance(sun) }).collect();
        let of_suns = weighted_suns.iter().map(|sun| f64::from(sun.irradiance)).sum();
        let surroundings = environment.as_ref().map_or(0.0, |e| e.sampled_irradiance(range, of_suns)) as f32;
        let sampler = LightSampler::new(&scene_lights.bounds, weighted_suns, surroundings);
        let collect::SceneLights { lights, primitives, .. } = scene_lights;
        Ok(Self { lights, sampler, primitives, points, has_openings, are_modulated, suns, environment })
    }

    /// Number of lights of each kind.
    #[must_use]
    pub fn light_counts(&self) -> LightCounts {
        let count = |kind: fn(&Light) -> bool| self.lights.iter().filter(|l| kind(l)).count();
        LightCounts {
            triangles: self.lights.iter().map(Light::triangles).sum(),
            spheres: count(Light::is_sphere),
            lamps: count(Light::is_point),
            openings: count(Light::is_open),
            suns: self.suns.len(),
            uniform_environment: matches!(&self.environment, Some(Environment::Uniform(l)) if l.max_value() > 0.0),
            image_environment: matches!(self.environment, Some(Environment::Image(_))),
            sky: matches!(self.environment, Some(Environment::Sky(_))),
        }
    }

    /// True if the strength of any lamp changes over time; [`MaterialTable::is_modulated`] is the same for surfaces.
    #[must_use]
    pub fn are_modulated(&self) -> bool {
        self.are_modulated
    }

    /// True if any light can be sampled.
    #[must_use]
    pub fn can_sample(&self) -> bool {
        self.sampler.is_possible()
    }

    /// True if there is more than one light to choose from; otherwise [`Lights::sample`] does not use the number that chooses.
    #[must_use]
    pub fn are_many(&self) -> bool {
        self.sampler.has_choice()
    }

    /// Samples a light and a direction towards it from the `receiver`; `None` if the sampled light sends nothing there. `spread_rad` is the
    /// width of the path's cone, for the footprint of textures. Light is averaged over an interval within that of the view.
    #[must_use]
    pub fn sample<const N: usize>(
        &self,
        receiver: &LightSampleContext,
        choice: f32,
        u: Vec2,
        spread_rad: f32,
        material_table: &MaterialTable,
        query: EmissionQuery<'_, N>,
    ) -> Option<LightSample<N>> {
        self.sampler_for(receiver).sample(choice, u, spread_rad, material_table, query)
    }

    /// The sampler of a receiver: built once for all its samples.
    #[inline(always)]
    pub(crate) fn sampler_for<'a>(&'a self, receiver: &'a LightSampleContext) -> ReceiverLightSampler<'a> {
        let query = self.tree_query(receiver);
        let start = self.sampler.start(&query);
        let local = self.sampler.local_fraction(&query, &start);
        ReceiverLightSampler { lights: self, receiver, start, local }
    }

    /// Samples a direction towards a selected light.
    #[inline(always)]
    fn sample_of<const N: usize>(
        &self,
        light: SampledLight,
        receiver: &LightSampleContext,
        u: Vec2,
        spread_rad: f32,
        material_table: &MaterialTable,
        query: EmissionQuery<'_, N>,
    ) -> Option<LightSample<N>> {
        let from = receiver.position;
        let sample = if let LightId::Local(i) = light.id
            && let Light::Triangle(t) = &self.lights[i]
        {
            t.glowing(material_table).towards(&t.sample(from, u)?, from, spread_rad, query)?
        } else {
            is_optional();
            self.sample_of_other(light.id, receiver, u, spread_rad, material_table, query)?
        };
        let pdf = sample.pdf * light.probability * receiver.samples as f32;
        (pdf > 0.0).then_some(LightSample { pdf, ..sample })
    }

    /// The same for a light that is no triangle, without the probability of the choice.
    #[inline(never)]
    fn sample_of_other<const N: usize>(
        &self,
        id: LightId,
        receiver: &LightSampleContext,
        u: Vec2,
        spread_rad: f32,
        material_table: &MaterialTable,
        query: EmissionQuery<'_, N>,
    ) -> Option<LightSample<N>> {
        let from = receiver.position;
        match id {
            LightId::Local(i) => match &self.lights[i] {
                Light::Triangle(t) => t.glowing(material_table).towards(&t.sample(from, u)?, from, spread_rad, query),
                Light::Sphere(s) => s.glowing(material_table).towards(&s.sample(from, u)?, from, spread_rad, query),
                Light::Lamp(lamp) => lamp.sample(from, query),
                Light::Opening(opening) => opening.sample(from, u, query),
                Light::Moving(light) => light.sample(receiver, u, spread_rad, material_table, query),
                Light::MovingLamp(lamp) => lamp.sample(receiver, u, query),
            },
            LightId::Sun(i) => Some(self.suns[i].sample(u, query.wavelengths)),
            LightId::Environment => self.environment.as_ref()?.sample(u, query.wavelengths),
        }
    }

    pub(super) fn tree_query<'a>(
        &'a self,
        receiver: &'a LightSampleContext,
    ) -> TreeQuery<'a, impl Fn(u32) -> LampIrradiance + 'a> {
        let lamp = |i: u32| match &self.lights[i as usize] {
            Light::Lamp(lamp) => lamp.irradiance(receiver),
            Light::Opening(opening) => opening.irradiance(receiver),
            Light::MovingLamp(lamp) => lamp.irradiance(receiver),
            Light::Triangle(_) | Light::Sphere(_) | Light::Moving(_) => LampIrradiance::default(),
        };
        TreeQuery { receiver, lamp }
    }

    /// Density with which the receiver's light samples would have given the direction to a surface point that was hit, 1/sr; 0 if the
    /// surface is no light.
    #[must_use]
    pub fn light_pdf(&self, hit: &LightHit<'_>) -> f32 {
        let Some(i) = self.primitives.light(hit.point.instance, hit.point.primitive) else { return 0.0 };
        let pdf = match &self.lights[i] {
            Light::Triangle(light) => light.pdf(hit),
            _ if !ALL_EFFECTS => unreachable!("triangles alone glow"),
            Light::Sphere(light) => light.pdf(hit),
            Light::Opening(light) => light.pdf(hit),
            Light::Moving(light) => light.pdf(hit),
            Light::MovingLamp(lamp) => lamp.pdf(hit),
            Light::Lamp(_) => 0.0,
        };
        let probability = self.sampler.probability(&self.tree_query(hit.receiver), LightId::Local(i));
        pdf * probability * hit.receiver.samples as f32
    }

    /// Spectral radiance, W·m⁻²·sr⁻¹·nm⁻¹, of a lamp's opening that a ray of unit `direction` has hit at `point`; `None` if the surface is
    /// no opening, or its side does not emit.
    #[inline(always)]
    pub(crate) fn opening_radiance<const N: usize>(
        &self,
        point: &SurfacePoint,
        direction: Vec3,
        query: EmissionQuery<'_, N>,
    ) -> Option<Spectral<N>> {
        if !(ALL_EFFECTS && self.has_openings) {
            return None;
        }
        let light = self.primitives.light(point.instance, point.primitive)?;
        match &self.lights[light] {
            Light::Opening(opening) => opening.emitted(point, direction, query),
            Light::MovingLamp(lamp) => lamp.emitted(point, direction, query),
            Light::Lamp(_) | Light::Triangle(_) | Light::Sphere(_) | Light::Moving(_) => None,
        }
    }

    /// Light from infinity along the unit `direction` away from the viewer, each contribution separately. `receiver` is the origin of the
    /// ray; without one no light could have been sampled from there, and densities are 0.
    pub fn distant<'a, const N: usize>(
        &'a self,
        direction: Vec3,
        receiver: Option<&'a LightSampleContext>,
        wavelengths: &'a Wavelengths<N>,
    ) -> impl Iterator<Item = DistantLight<N>> + 'a {
        let sample_probability = move |light: LightId| {
            receiver.map_or(0.0, |receiver| {
                self.sampler.probability(&self.tree_query(receiver), light) * receiver.samples as f32
            })
        };
        let suns =
            self.suns.iter().filter(|_| ALL_EFFECTS).enumerate().filter(move |(_, sun)| sun.covers(direction)).map(
                move |(i, sun)| {
                    let pdf = sun.pdf() * sample_probability(LightId::Sun(i));
                    DistantLight { radiance: sun.radiance_from(direction, wavelengths), pdf, is_environment: false }
                },
            );
        let environment = self.environment.iter().filter(|_| ALL_EFFECTS).map(move |environment| {
            let (radiance, pdf) = environment.radiance_and_pdf(direction, receiver.is_some(), wavelengths);
            let pdf = if pdf > 0.0 { pdf * sample_probability(LightId::Environment) } else { 0.0 };
            DistantLight { radiance, pdf, is_environment: true }
        });
        suns.chain(environment)
    }
}

/// Samples lights for a receiver. It is large, so it is built in its final place.
pub(crate) struct ReceiverLightSampler<'a> {
    lights: &'a Lights,
    receiver: &'a LightSampleContext,
    start: TreeStart,
    /// The fraction of the samples for lights in the scene.
    local: f32,
}

impl ReceiverLightSampler<'_> {
    /// One sample, as [`Lights::sample`].
    #[inline(always)]
    pub(crate) fn sample<const N: usize>(
        &self,
        choice: f32,
        u: Vec2,
        spread_rad: f32,
        material_table: &MaterialTable,
        query: EmissionQuery<'_, N>,
    ) -> Option<LightSample<N>> {
        let Self { lights, receiver, start, local } = self;
        // Deep in a tree the choice needs more digits than one number has; the effect on the place on the light is negligible.
        let fine = f64::from(choice) + f64::from(u.x) * DIGIT;
        let light = lights.sampler.sample(&lights.tree_query(receiver), start, *local, fine)?;
        lights.sample_of(light, receiver, u, spread_rad, material_table, query)
    }
}

/// Weight of the digits that a second number adds to the 24 bits of the first: 2⁻²⁴.
const DIGIT: f64 = 0.5 * 1.192_092_895_507_812_5e-7;

/// Light sources other than surfaces with emitting materials.
#[derive(Clone, Debug, Default)]
pub struct Sources {
    pub suns: Vec<Sun>,
    /// Lamps, as points or with the instances of the world that are their openings.
    pub lamps: Vec<Lamp>,
    /// Surroundings of the scene.
    pub environment: Option<Environment>,
}

impl Sources {
    /// True if the strength of any of them changes over time; [`crate::materials::MaterialTable::is_modulated`] is the same for surfaces.
    #[must_use]
    pub fn is_modulated(&self) -> bool {
        self.lamps.iter().any(|lamp| lamp.modulation().is_some())
    }
}

/// Numbers of lights, for the plan.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LightCounts {
    /// Emissive triangles.
    pub triangles: usize,
    /// Emissive spheres.
    pub spheres: usize,
    /// Lamps without an opening.
    pub lamps: usize,
    /// Lamps with a luminous opening.
    pub openings: usize,
    pub suns: usize,
    /// True if an environment of one radiance above 0 surrounds the scene.
    pub uniform_environment: bool,
    /// True if an image surrounds the scene.
    pub image_environment: bool,
    /// True if a clear sky surrounds the scene.
    pub sky: bool,
}

impl LightCounts {
    /// True if there is no light.
    #[must_use]
    pub fn is_dark(&self) -> bool {
        let environment = self.uniform_environment || self.image_environment || self.sky;
        self.triangles + self.spheres + self.lamps + self.openings + self.suns == 0 && !environment
    }
}
