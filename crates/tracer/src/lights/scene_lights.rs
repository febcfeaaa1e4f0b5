//! All lights of a view, and how they share the draws.

use super::choice::{Choice, Chosen};
use super::collect;
use super::collect::LightError;
use super::environment::Environment;
use super::light::Light;
use super::light_counts::LightCounts;
use super::light_sample::LampIrradiance;
use super::light_sample::{DistantLight, LightHit, LightSample};
use super::primitives::Primitives;
use super::sample_context::LightSampleContext;
use super::sources::Sources;
use super::sun::Sun;
use super::tree::{Start, TreeQuery};
use crate::geometry::SurfacePoint;
use crate::materials::MaterialTable;
use crate::render_space::RenderSpace;
use crate::{ALL_EFFECTS, is_optional};
use etendue_core::{Spectral, TimeInterval, Wavelengths};
use glam::{Vec2, Vec3};

/// All lights of a view.
#[derive(Clone, Debug)]
pub struct Lights {
    pub(super) lights: Vec<Light>,
    pub(super) choice: Choice,
    pub(super) primitives: Primitives,
    /// Lamps without an opening, by their places.
    pub(super) points: Vec<usize>,
    has_openings: bool,
    are_modulated: bool,
    pub(super) suns: Vec<Sun>,
    pub(super) environment: Option<Environment>,
}

impl Lights {
    /// The lights of a view: its surfaces that glow, and `sources`. Wavelengths from `low_nm`
    /// to `high_nm` decide how the lights share the draws.
    ///
    /// # Errors
    /// Where an instance names a material that the material_table does not have.
    pub fn new(
        view: &RenderSpace<'_>,
        material_table: &MaterialTable,
        sources: Sources,
        (low_nm, high_nm): (f64, f64),
    ) -> Result<Self, LightError> {
        let are_modulated = sources.is_modulated();
        let Sources { suns, lamps, environment } = sources;
        let mut gathered = collect::of_surfaces(view, material_table, (low_nm, high_nm))?;
        for lamp in lamps {
            gathered.add_lamp(lamp, view, material_table, (low_nm, high_nm))?;
        }
        let points = (0..gathered.lights.len()).filter(|i| gathered.lights[*i].is_point()).collect();
        let has_openings = gathered.lights.iter().any(Light::is_open);
        let weighed: Vec<_> =
            suns.iter().map(|sun| (sun.clone(), sun.mean_irradiance(low_nm, high_nm) as f32)).collect();
        let of_suns = weighed.iter().map(|(_, irradiance)| f64::from(*irradiance)).sum();
        let surroundings = environment.as_ref().map_or(0.0, |e| e.drawn_irradiance((low_nm, high_nm), of_suns)) as f32;
        let choice = Choice::new(&gathered.bounds, weighed, surroundings);
        let collect::Gathered { lights, primitives, .. } = gathered;
        Ok(Self { lights, choice, primitives, points, has_openings, are_modulated, suns, environment })
    }

    /// How many lights of each kind there are.
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

    /// Whether the strength of any lamp changes over time; [`MaterialTable::is_modulated`] tells it of surfaces.
    #[must_use]
    pub fn are_modulated(&self) -> bool {
        self.are_modulated
    }

    /// Whether any light can be drawn.
    #[must_use]
    pub fn can_be_drawn(&self) -> bool {
        self.choice.is_possible()
    }

    /// Whether there is more than one light to choose from; [`Lights::sample`] does not look at the number that chooses
    /// where there is not.
    #[must_use]
    pub fn are_many(&self) -> bool {
        self.choice.is_open()
    }

    /// A light and a direction towards it from the `receiver`; `None` where the light drawn sends nothing there.
    /// `spread_rad` is the width of the path's cone, for the footprint of textures. Light is asked for at wavelengths, and averaged
    /// over a time within the view's interval.
    #[must_use]
    pub fn sample<const N: usize>(
        &self,
        receiver: &LightSampleContext,
        u: (f32, Vec2),
        spread_rad: f32,
        material_table: &MaterialTable,
        asked: (&Wavelengths<N>, &TimeInterval),
    ) -> Option<LightSample<N>> {
        self.drawing(receiver).sample(u, spread_rad, material_table, asked)
    }

    /// What the receiver draws lights from: made once for all its draws.
    #[inline(always)]
    pub(crate) fn drawing<'a>(&'a self, receiver: &'a LightSampleContext) -> LightDrawing<'a> {
        let question = self.question(receiver);
        let start = self.choice.start(&question);
        let local = self.choice.local_share(&question, &start);
        LightDrawing { lights: self, receiver, start, local }
    }

    /// A drawn light and a direction towards it.
    #[inline(always)]
    fn sample_of<const N: usize>(
        &self,
        (chosen, probability): (Chosen, f32),
        receiver: &LightSampleContext,
        u: Vec2,
        spread_rad: f32,
        (material_table, asked): (&MaterialTable, (&Wavelengths<N>, &TimeInterval)),
    ) -> Option<LightSample<N>> {
        let from = receiver.position;
        let sample = if let Chosen::Local(i) = chosen
            && let Light::Triangle(t) = &self.lights[i]
        {
            t.glowing(material_table).towards(&t.sample(from, u)?, from, spread_rad, asked)?
        } else {
            is_optional();
            self.sample_of_other(chosen, receiver, u, spread_rad, (material_table, asked))?
        };
        let pdf = sample.pdf * probability * receiver.draws as f32;
        (pdf > 0.0).then_some(LightSample { pdf, ..sample })
    }

    /// The same of a light that is no triangle, without the choice's probability.
    #[inline(never)]
    fn sample_of_other<const N: usize>(
        &self,
        chosen: Chosen,
        receiver: &LightSampleContext,
        u: Vec2,
        spread_rad: f32,
        (material_table, asked): (&MaterialTable, (&Wavelengths<N>, &TimeInterval)),
    ) -> Option<LightSample<N>> {
        let from = receiver.position;
        match chosen {
            Chosen::Local(i) => match &self.lights[i] {
                Light::Triangle(t) => t.glowing(material_table).towards(&t.sample(from, u)?, from, spread_rad, asked),
                Light::Sphere(s) => s.glowing(material_table).towards(&s.sample(from, u)?, from, spread_rad, asked),
                Light::Lamp(lamp) => lamp.sample(from, asked),
                Light::Opening(opening) => opening.sample(from, u, asked),
                Light::Moving(light) => light.sample(receiver, u, spread_rad, material_table, asked),
                Light::Carried(lamp) => lamp.sample(receiver, u, asked),
            },
            Chosen::Sun(i) => Some(self.suns[i].sample(u, asked.0)),
            Chosen::Environment => self.environment.as_ref()?.sample(u, asked.0),
        }
    }

    pub(super) fn question<'a>(
        &'a self,
        receiver: &'a LightSampleContext,
    ) -> TreeQuery<'a, impl Fn(u32) -> LampIrradiance + 'a> {
        let lamp = |i: u32| match &self.lights[i as usize] {
            Light::Lamp(lamp) => lamp.irradiance(receiver),
            Light::Opening(opening) => opening.irradiance(receiver),
            Light::Carried(lamp) => lamp.irradiance(receiver),
            Light::Triangle(_) | Light::Sphere(_) | Light::Moving(_) => LampIrradiance::default(),
        };
        TreeQuery { receiver, lamp }
    }

    /// Density by which the receiver's draws would have given the direction to a surface point that was met, 1/sr; 0
    /// where the surface is no light.
    #[must_use]
    pub fn light_pdf(&self, met: &LightHit<'_>) -> f32 {
        let Some(i) = self.primitives.light(met.point.instance, met.point.primitive) else { return 0.0 };
        let pdf = match &self.lights[i] {
            Light::Triangle(light) => light.pdf(met),
            _ if !ALL_EFFECTS => unreachable!("triangles alone glow"),
            Light::Sphere(light) => light.pdf(met),
            Light::Opening(light) => light.pdf(met),
            Light::Moving(light) => light.pdf(met),
            Light::Carried(lamp) => lamp.pdf(met),
            Light::Lamp(_) => 0.0,
        };
        let probability = self.choice.probability(&self.question(met.receiver), Chosen::Local(i));
        pdf * probability * met.receiver.draws as f32
    }

    /// Spectral radiance, W·m⁻²·sr⁻¹·nm⁻¹, of a lamp's opening that a ray of unit `direction` has met at `point`; `None` where
    /// the surface is none, or its side does not shine.
    #[inline(always)]
    pub(crate) fn of_opening<const N: usize>(
        &self,
        point: &SurfacePoint,
        direction: Vec3,
        asked: (&Wavelengths<N>, &TimeInterval),
    ) -> Option<Spectral<N>> {
        let light =
            (ALL_EFFECTS && self.has_openings).then(|| self.primitives.light(point.instance, point.primitive))??;
        match &self.lights[light] {
            Light::Opening(opening) => opening.met(point, direction, asked),
            Light::Carried(lamp) => lamp.met(point, direction, asked),
            Light::Lamp(_) | Light::Triangle(_) | Light::Sphere(_) | Light::Moving(_) => None,
        }
    }

    /// Light from infinity along the unit `direction` away from the viewer, each contribution by itself. `receiver` is
    /// where the ray came from; without one nothing could have been drawn from there, and densities are 0.
    pub fn distant<'a, const N: usize>(
        &'a self,
        direction: Vec3,
        receiver: Option<&'a LightSampleContext>,
        wavelengths: &'a Wavelengths<N>,
    ) -> impl Iterator<Item = DistantLight<N>> + 'a {
        let drawn = move |light: Chosen| {
            receiver.map_or(0.0, |receiver| {
                self.choice.probability(&self.question(receiver), light) * receiver.draws as f32
            })
        };
        let suns =
            self.suns.iter().filter(|_| ALL_EFFECTS).enumerate().filter(move |(_, sun)| sun.covers(direction)).map(
                move |(i, sun)| {
                    let pdf = sun.pdf() * drawn(Chosen::Sun(i));
                    DistantLight { radiance: sun.radiance_from(direction, wavelengths), pdf, surrounds: false }
                },
            );
        let environment = self.environment.iter().filter(|_| ALL_EFFECTS).map(move |environment| {
            let (radiance, pdf) = environment.seen(direction, receiver.is_some(), wavelengths);
            let pdf = if pdf > 0.0 { pdf * drawn(Chosen::Environment) } else { 0.0 };
            DistantLight { radiance, pdf, surrounds: true }
        });
        suns.chain(environment)
    }
}

/// A receiver with what it draws lights from. Large: it stays where it is made.
pub(crate) struct LightDrawing<'a> {
    lights: &'a Lights,
    receiver: &'a LightSampleContext,
    start: Start,
    /// The share of the draws that lights in the scene get.
    local: f32,
}

impl LightDrawing<'_> {
    /// One draw, as [`Lights::sample`].
    #[inline(always)]
    pub(crate) fn sample<const N: usize>(
        &self,
        (choice, u): (f32, Vec2),
        spread_rad: f32,
        material_table: &MaterialTable,
        asked: (&Wavelengths<N>, &TimeInterval),
    ) -> Option<LightSample<N>> {
        let Self { lights, receiver, start, local } = self;
        // Deep in a tree more digits are needed than the one number has; the other's place on the light is not felt.
        let fine = f64::from(choice) + f64::from(u.x) * DIGIT;
        let chosen = lights.choice.pick(&lights.question(receiver), (start, *local), fine)?;
        lights.sample_of(chosen, receiver, u, spread_rad, (material_table, asked))
    }
}

/// Weight of the digits that a second number adds to the 24 bits of the first: 2⁻²⁴.
pub(super) const DIGIT: f64 = 0.5 * 1.192_092_895_507_812_5e-7;
