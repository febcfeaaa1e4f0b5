//! Lights: where light starts, and how to ask for it from a point.
//!
//! # Contract
//! - [`Lights`] are those of one view: emissive triangles and spheres of its instances in the render frame, lamps, suns,
//!   and an environment. They are collected once and never change.
//! - [`Lights::sample`] draws a light and a direction towards it. Its `pdf` is by solid angle and includes the choice of
//!   the light. Exactly the same density is told for light that was met by chance: [`Lights::light_pdf`] for surfaces,
//!   [`Lights::distant`] for what lies beyond them, so that both can be weighed against each other.
//! - Every light but a uniform environment can be drawn with a positive probability. A uniform environment is not drawn:
//!   no direction of it is better than the one that the surface prefers; its density is told as 0.
//! - Densities belong to a [`LightSampleContext`], the point that asks.
//! - Radiance is spectral, W·m⁻²·sr⁻¹·nm⁻¹.

pub mod almanac;
mod choice;
mod collect;
mod environment;
pub mod head_lamp;
mod lamp;
mod near;
mod primitives;
mod profile;
mod sample_context;
mod sky;
mod sphere;
mod spherical;
mod sun;
mod tree;
mod triangle;

pub use collect::LightError;
pub use environment::{Environment, EnvironmentError, ImageEnvironment};
pub use lamp::{Lamp, LampError};
pub use profile::{Cone, ConeError, Masked, Profile, Slide, SlideError, Web, WebAxes, WebError};
pub use sample_context::LightSampleContext;
pub use sky::SkyEnvironment;
pub use sun::{SUN_ANGULAR_DIAMETER_DEG, Sun, SunError};

use etendue_core::{Spectral, Wavelengths};
use glam::{Vec2, Vec3};

use crate::geometry::SurfacePoint;
use crate::materials::MaterialTable;
use crate::textures::Lookup;
use crate::view::View;
use choice::{Choice, Chosen};
use lamp::LampLight;
use primitives::Primitives;
use sphere::SphereLight;
use tree::TreeQuery;
use triangle::TriangleLight;

/// The greatest radiance, irradiance or intensity of a light at any wavelength, in its unit: products of it with weights and
/// sums over many lights stay finite in f32.
pub const BRIGHTEST: f32 = 1e30;

/// A light in the scene.
#[derive(Clone, Debug)]
enum Light {
    Triangle(TriangleLight),
    Sphere(SphereLight),
    Lamp(LampLight),
}

impl Light {
    fn triangles(&self) -> usize {
        if let Self::Triangle(light) = self { light.triangles() } else { 0 }
    }
}

/// What shines but is no surface.
#[derive(Clone, Debug, Default)]
pub struct Sources {
    /// Suns.
    pub suns: Vec<Sun>,
    /// Lamps without extent.
    pub lamps: Vec<Lamp>,
    /// What surrounds the scene.
    pub environment: Option<Environment>,
}

/// All lights of a view.
#[derive(Clone, Debug)]
pub struct Lights {
    lights: Vec<Light>,
    choice: Choice,
    primitives: Primitives,
    suns: Vec<Sun>,
    environment: Option<Environment>,
}

/// What is lit by what: for the plan.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LightCensus {
    /// Emissive triangles.
    pub triangles: usize,
    /// Emissive spheres.
    pub spheres: usize,
    /// Lamps without extent.
    pub lamps: usize,
    /// Suns.
    pub suns: usize,
    /// Whether an environment of one radiance above 0 surrounds the scene.
    pub uniform_environment: bool,
    /// Whether a picture surrounds the scene.
    pub image_environment: bool,
    /// Whether a clear sky surrounds the scene.
    pub sky: bool,
}

impl LightCensus {
    /// Whether nothing gives light.
    #[must_use]
    pub fn is_dark(&self) -> bool {
        let environment = self.uniform_environment || self.image_environment || self.sky;
        self.triangles + self.spheres + self.lamps + self.suns == 0 && !environment
    }
}

/// Light drawn for a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightSample<const N: usize> {
    /// Unit direction towards the light.
    pub direction: Vec3,
    /// The point of the light, moved off its surface by the error bound; `None` for light from infinity.
    pub target: Option<Vec3>,
    /// Spectral radiance towards the point; of a lamp without extent the spectral irradiance of a surface that faces it.
    pub radiance: Spectral<N>,
    /// Density of the direction, with that of the choice, 1/sr; of a lamp without extent the probability of the choice.
    /// Positive.
    pub pdf: f32,
    /// Whether it is a lamp without extent: nothing but a draw can find it.
    pub delta: bool,
    /// Whether it is light of the surroundings, and of no sun or surface.
    pub surrounds: bool,
}

impl<const N: usize> LightSample<N> {
    /// Light of the surroundings; `None` where no density can be told.
    fn of_surroundings(direction: Vec3, radiance: Spectral<N>, pdf: f32) -> Option<Self> {
        let drawn = Self { direction, target: None, radiance, pdf, delta: false, surrounds: true };
        (pdf > 0.0 && pdf.is_finite()).then_some(drawn)
    }
}

/// Light from infinity that was met by chance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DistantLight<const N: usize> {
    /// Spectral radiance.
    pub radiance: Spectral<N>,
    /// Density by which [`Lights::sample`] would have given the direction for it, 1/sr.
    pub pdf: f32,
    /// Whether it is light of the surroundings, and of no sun.
    pub surrounds: bool,
}

/// A point of a light's surface, drawn for a point of the scene.
struct SurfaceSample {
    /// From the point of the scene, and its length, m.
    way: Vec3,
    distance: f32,
    normal: Vec3,
    /// By solid angle, without the choice of the light.
    pdf: f32,
    uv: Vec2,
    uv_per_m: f32,
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

impl Lights {
    /// The lights of a view: its surfaces that glow, and `sources`. Wavelengths from `low_nm`
    /// to `high_nm` decide how the lights share the draws.
    ///
    /// # Errors
    /// Where an instance names a material that the material_table does not have, or moves.
    pub fn new(
        view: &View<'_>,
        material_table: &MaterialTable,
        sources: Sources,
        (low_nm, high_nm): (f64, f64),
    ) -> Result<Self, LightError> {
        let Sources { suns, lamps, environment } = sources;
        let mut gathered = collect::of_surfaces(view, material_table, (low_nm, high_nm))?;
        for lamp in lamps {
            let lamp = LampLight::new(lamp, view.origin_m(), (low_nm, high_nm));
            gathered.add(lamp.bounds(), Light::Lamp(lamp));
        }
        let weighed = suns.iter().map(|sun| (sun.clone(), sun.mean_irradiance(low_nm, high_nm) as f32)).collect();
        let surroundings = environment.as_ref().map_or(0.0, |e| e.drawn_irradiance(low_nm, high_nm)) as f32;
        let choice = Choice::new(&gathered.bounds, weighed, surroundings);
        Ok(Self { lights: gathered.lights, choice, primitives: gathered.primitives, suns, environment })
    }

    /// How many lights of each kind there are.
    #[must_use]
    pub fn census(&self) -> LightCensus {
        let count = |kind: fn(&Light) -> bool| self.lights.iter().filter(|l| kind(l)).count();
        LightCensus {
            triangles: self.lights.iter().map(Light::triangles).sum(),
            spheres: count(|l| matches!(l, Light::Sphere(_))),
            lamps: count(|l| matches!(l, Light::Lamp(_))),
            suns: self.suns.len(),
            uniform_environment: matches!(&self.environment, Some(Environment::Uniform(l)) if l.max_value() > 0.0),
            image_environment: matches!(self.environment, Some(Environment::Image(_))),
            sky: matches!(self.environment, Some(Environment::Sky(_))),
        }
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
    /// `spread_rad` is the width of the path's cone, for the footprint of textures.
    #[must_use]
    pub fn sample<const N: usize>(
        &self,
        receiver: &LightSampleContext,
        (choice, u): (f32, Vec2),
        spread_rad: f32,
        material_table: &MaterialTable,
        wavelengths: &Wavelengths<N>,
    ) -> Option<LightSample<N>> {
        // Deep in a tree more digits are needed than the one number has; the other's place on the light is not felt.
        let fine = f64::from(choice) + f64::from(u.x) * DIGIT;
        let (chosen, probability) = self.choice.pick(&self.question(receiver), fine)?;
        let from = receiver.position;
        let sample = match chosen {
            Chosen::Local(i) => match &self.lights[i] {
                Light::Triangle(t) => {
                    t.glowing(material_table).towards(&t.sample(from, u)?, from, spread_rad, wavelengths)
                }
                Light::Sphere(s) => {
                    s.glowing(material_table).towards(&s.sample(from, u)?, from, spread_rad, wavelengths)
                }
                Light::Lamp(lamp) => lamp.sample(from, wavelengths),
            },
            Chosen::Sun(i) => Some(self.suns[i].sample(u, wavelengths)),
            Chosen::Environment => self.environment.as_ref()?.sample(u, wavelengths),
        }?;
        let pdf = sample.pdf * probability;
        (pdf > 0.0).then_some(LightSample { pdf, ..sample })
    }

    fn question<'a>(&'a self, receiver: &'a LightSampleContext) -> TreeQuery<'a, impl Fn(u32) -> f32 + 'a> {
        let lamp = |i: u32| match &self.lights[i as usize] {
            Light::Lamp(lamp) => lamp.irradiance(receiver),
            Light::Triangle(_) | Light::Sphere(_) => 0.0,
        };
        TreeQuery { receiver, lamp }
    }

    /// Density by which [`Lights::sample`] would have given the direction to a surface point that was met, 1/sr; 0
    /// where the surface is no light.
    #[must_use]
    pub fn light_pdf(&self, met: &LightHit<'_>) -> f32 {
        let Some(i) = self.primitives.light(met.point.instance, met.point.primitive) else { return 0.0 };
        let pdf = match &self.lights[i] {
            Light::Triangle(light) => light.pdf(met),
            Light::Sphere(light) => light.pdf(met),
            Light::Lamp(_) => 0.0,
        };
        pdf * self.choice.probability(&self.question(met.receiver), Chosen::Local(i))
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
            receiver.map_or(0.0, |receiver| self.choice.probability(&self.question(receiver), light))
        };
        let suns = self.suns.iter().enumerate().filter(move |(_, sun)| sun.covers(direction)).map(move |(i, sun)| {
            let pdf = sun.pdf() * drawn(Chosen::Sun(i));
            DistantLight { radiance: sun.radiance_from(direction, wavelengths), pdf, surrounds: false }
        });
        let environment = self.environment.iter().map(move |environment| {
            let (radiance, pdf) = environment.seen(direction, receiver.is_some(), wavelengths);
            let pdf = if pdf > 0.0 { pdf * drawn(Chosen::Environment) } else { 0.0 };
            DistantLight { radiance, pdf, surrounds: true }
        });
        suns.chain(environment)
    }
}

/// Weight of the digits that a second number adds to the 24 bits of the first: 2⁻²⁴.
const DIGIT: f64 = 0.5 * 1.192_092_895_507_812_5e-7;

/// What surface lights have in common.
struct Glowing<'a> {
    material: crate::MaterialId,
    error_m: f32,
    /// How far before the point, along the ray to it, the accelerator may already meet the surface.
    early_m: f32,
    material_table: &'a MaterialTable,
}

impl Glowing<'_> {
    /// The light sample of a surface sample seen from `from`; `None` where the side seen does not glow.
    #[inline(always)]
    fn towards<const N: usize>(
        &self,
        surface: &SurfaceSample,
        from: Vec3,
        spread_rad: f32,
        wavelengths: &Wavelengths<N>,
    ) -> Option<LightSample<N>> {
        let distance = surface.distance;
        let direction = (distance > 0.0).then(|| surface.way * (1.0 / distance))?;
        let emission = self.material_table.emission(self.material).filter(|e| e.leaves(surface.normal, -direction))?;
        let lookup = Lookup { width: spread_rad * distance * surface.uv_per_m, ..Lookup::point(surface.uv) };
        let side = -1.0_f32.copysign(surface.normal.dot(direction));
        Some(LightSample {
            direction,
            target: Some(
                from + (surface.way - direction * self.early_m.min(0.5 * distance))
                    + surface.normal * (side * (self.error_m + ROUNDING * distance)),
            ),
            radiance: self.material_table.radiance(self.material, emission, &lookup, wavelengths),
            pdf: surface.pdf,
            delta: false,
            surrounds: false,
        })
    }
}

/// Relative error allowed for a point on a light and a ray to it: sixteen roundings of f32.
const ROUNDING: f32 = 16.0 * 0.5 * f32::EPSILON;

/// Density by solid angle of a point drawn with density `per_area` (1/m²) on a surface of unit `normal`, seen from
/// a point at the far end of `way` of length `distance`; 0 where it is seen edge-on.
fn solid_angle_pdf(per_area: f32, way: Vec3, distance: f32, normal: Vec3) -> f32 {
    let height = normal.dot(way).abs();
    if height > 0.0 { per_area * (distance * distance) * (distance / height) } else { 0.0 }
}
