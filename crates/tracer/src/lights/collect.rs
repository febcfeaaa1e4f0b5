//! Finding the surfaces that glow.

use etendue_core::{Motion, TimeInterval};
use glam::DAffine3;

use super::Light;
use super::carried::CarriedLamp;
use super::lamp::{Lamp, LampLight};
use super::moving::MovingLight;
use super::opening::Opening;
use super::opening_light::OpeningLight;
use super::primitives::Primitives;
use super::sphere::SphereLight;
use super::tree::LightBounds;
use super::triangle::{Facets, TriangleLight};
use super::way::Way;
use crate::MaterialId;
use crate::geometry::{Instance, Mesh, Shape};
use crate::materials::{Emission, EmissionSides, MaterialTable};
use crate::render_space::RenderSpace;

/// Why lights cannot be collected.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum LightError {
    /// An instance names a material that is not there.
    #[error("instance {instance} names material {material}, but there are {materials}; add the material first")]
    UnknownMaterial {
        /// The instance, counted from 0.
        instance: usize,
        /// The material it names.
        material: u32,
        /// Number of materials.
        materials: usize,
    },
    /// The surface of a lamp's opening is not what the opening asks for.
    #[error(
        "instance {instance} is not the surface of a lamp's opening, which its lamp takes it for; place the opening's own mesh, or a \
         sphere, of one material that does not glow"
    )]
    Opening {
        /// The instance, counted from 0.
        instance: u32,
    },
    /// More glowing triangles than can be told apart.
    #[error("the scene has more than four thousand million glowing triangles; let fewer glow")]
    TooMany,
}

/// Lights of the scene.
#[derive(Default)]
pub(super) struct Gathered {
    pub(super) lights: Vec<Light>,
    /// What the choice among them knows of each.
    pub(super) bounds: Vec<LightBounds>,
    pub(super) primitives: Primitives,
}

/// What a material's glow weighs.
struct Weigher<'a> {
    material_table: &'a MaterialTable,
    /// Mean radiance of each material that glows, W·m⁻²·sr⁻¹·nm⁻¹, as its strength over the view's interval counts in the choice
    /// among lights, and which sides do.
    glows: Vec<Option<(f64, EmissionSides)>>,
}

impl<'a> Weigher<'a> {
    fn new(material_table: &'a MaterialTable, (low_nm, high_nm): (f64, f64), interval: TimeInterval) -> Self {
        let counts = |e: &Emission| e.modulation.as_ref().map_or(1.0, |modulation| modulation.choice_level(interval));
        let weigh = |e: &Emission| (e.mean_radiance(material_table.textures(), low_nm, high_nm) * counts(e), e.sides);
        let glows = material_table.materials().iter().map(|m| m.emission.as_ref().map(weigh)).collect();
        Self { material_table, glows }
    }

    fn glow(&self, material: MaterialId) -> Option<(f64, EmissionSides)> {
        self.glows[material.0 as usize]
    }
}

pub(super) fn of_surfaces(
    view: &RenderSpace<'_>,
    material_table: &MaterialTable,
    support_nm: (f64, f64),
) -> Result<Gathered, LightError> {
    let world = view.world();
    let weigher = Weigher::new(material_table, support_nm, view.interval());
    let mut gathered = Gathered::default();
    for (index, instance) in world.instances().iter().enumerate() {
        check_materials(index, instance, &weigher)?;
        if !instance.materials.iter().any(|material| weigher.glow(*material).is_some()) {
            gathered.primitives.push([]);
            continue;
        }
        let place = Place::of(&instance.to_world, view);
        match instance.shape {
            Shape::Mesh(id) => gathered.add_mesh(world.mesh(id), instance, &place, &weigher),
            Shape::Sphere { radius_m } => gathered.add_sphere(radius_m, instance.materials[0], place, &weigher),
        }
    }
    if gathered.lights.len() >= u32::MAX as usize { Err(LightError::TooMany) } else { Ok(gathered) }
}

fn check_materials(index: usize, instance: &Instance, weigher: &Weigher<'_>) -> Result<(), LightError> {
    let materials = weigher.material_table.materials().len();
    match instance.materials.iter().find(|m| m.0 as usize >= materials) {
        Some(m) => Err(LightError::UnknownMaterial { instance: index, material: m.0, materials }),
        None => Ok(()),
    }
}

/// Where something is during the view's interval.
enum Place {
    /// To the render frame.
    Still(DAffine3),
    Moving(Way),
}

impl Place {
    fn of(to_world: &Motion, view: &RenderSpace<'_>) -> Self {
        let (origin_m, interval) = (view.origin_m(), view.interval());
        match to_world.still_over(interval) {
            Some(mut to_render) => {
                to_render.translation -= origin_m;
                Self::Still(to_render)
            }
            None => Self::Moving(Way { to_world: to_world.clone(), origin_m, interval }),
        }
    }

    /// To the render frame at the start of the interval.
    fn at_start(&self) -> DAffine3 {
        match self {
            Self::Still(to_render) => *to_render,
            Self::Moving(way) => way.at(way.interval.start_s()),
        }
    }

    /// The light of a triangle, of two together if they are to be a pair and make up a parallelogram, with its bounds.
    fn facets(
        &self,
        mesh: &Mesh,
        (first, is_pair): (usize, bool),
        material: MaterialId,
        (radiance, both): (f64, bool),
    ) -> Option<(Light, LightBounds)> {
        let pair = is_pair.then_some([first, first + 1]);
        match self {
            Self::Still(to_render) => {
                let light = pair
                    .and_then(|pair| TriangleLight::of_two(mesh, pair, to_render, material))
                    .or_else(|| TriangleLight::new(mesh, first, to_render, material))?;
                let bounds = light.bounds(radiance, both);
                Some((Light::Triangle(light), bounds))
            }
            Self::Moving(way) => {
                let facets = pair.and_then(|pair| Facets::two(mesh, pair)).unwrap_or_else(|| Facets::one(mesh, first));
                let light = MovingLight::of_facets(facets, way.clone(), material);
                let bounds = light.bounds(radiance, both)?;
                Some((Light::Moving(Box::new(light)), bounds))
            }
        }
    }

    fn sphere(
        self,
        radius_m: f64,
        material: MaterialId,
        material_table: &MaterialTable,
        radiance: f64,
    ) -> Option<(Light, LightBounds)> {
        match self {
            Self::Still(to_render) => {
                let light = SphereLight::new(radius_m, &to_render, material, material_table);
                let bounds = light.bounds(radiance);
                Some((Light::Sphere(light), bounds))
            }
            Self::Moving(way) => {
                let light = MovingLight::of_sphere(radius_m, way, material, material_table);
                let bounds = light.bounds(radiance, true)?;
                Some((Light::Moving(Box::new(light)), bounds))
            }
        }
    }
}

impl Gathered {
    fn add_mesh(&mut self, mesh: &Mesh, instance: &Instance, place: &Place, weigher: &Weigher<'_>) {
        let material = |primitive: usize| instance.materials[usize::from(mesh.slots()[primitive])];
        let count = mesh.triangles().len();
        let mut lights: Vec<Option<u32>> = Vec::with_capacity(count);
        while lights.len() < count {
            let first = lights.len();
            let light = weigher.glow(material(first)).and_then(|(radiance, glow)| {
                let is_pair = first + 1 < count && material(first + 1) == material(first);
                let both = glow == EmissionSides::Both;
                let (light, bounds) = place.facets(mesh, (first, is_pair), material(first), (radiance, both))?;
                Some((light.triangles(), self.add(bounds, light)))
            });
            let (triangles, light) = light.map_or((1, None), |(triangles, light)| (triangles, Some(light)));
            lights.extend(core::iter::repeat_n(light, triangles));
        }
        self.primitives.push(lights);
    }

    fn add_sphere(&mut self, radius_m: f64, material: MaterialId, place: Place, weigher: &Weigher<'_>) {
        let light = weigher.glow(material).and_then(|(radiance, _)| {
            let (light, bounds) = place.sphere(radius_m, material, weigher.material_table, radiance)?;
            Some(self.add(bounds, light))
        });
        self.primitives.push([light]);
    }

    /// Adds a lamp, as a point or with the instance of the world that is its opening.
    pub(super) fn add_lamp(
        &mut self,
        lamp: Lamp,
        view: &RenderSpace<'_>,
        material_table: &MaterialTable,
        support_nm: (f64, f64),
    ) -> Result<(), LightError> {
        let opening = lamp.opening();
        let place = Place::of(lamp.to_world(), view);
        let made = LampLight::new(lamp, (&place.at_start(), view.interval()), support_nm);
        let Some((opening, instance)) = opening else {
            match place {
                Place::Still(_) => self.add(made.bounds(), Light::Lamp(made)),
                Place::Moving(way) => self.add_carried(CarriedLamp::of_point(way, made)),
            };
            return Ok(());
        };
        let light = opened(made, (opening, instance), view, material_table)?;
        let primitives = light.primitives();
        let added = match place {
            Place::Still(_) => self.add(light.bounds(), Light::Opening(light)),
            Place::Moving(way) => self.add_carried(CarriedLamp::of_opening(way, light)),
        };
        self.primitives.assign(instance, primitives, added);
        Ok(())
    }

    fn add_carried(&mut self, lamp: CarriedLamp) -> u32 {
        self.add(lamp.bounds(), Light::Carried(Box::new(lamp)))
    }

    pub(super) fn add(&mut self, bounds: LightBounds, light: Light) -> u32 {
        self.lights.push(light);
        self.bounds.push(bounds);
        (self.lights.len() - 1) as u32
    }
}

/// A lamp with the instance of the world that is its opening, at the start of the view's interval.
fn opened(
    lamp: LampLight,
    (opening, instance): (Opening, u32),
    view: &RenderSpace<'_>,
    material_table: &MaterialTable,
) -> Result<OpeningLight, LightError> {
    let fault = LightError::Opening { instance };
    let placed = view.world().instances().get(instance as usize).ok_or(fault)?;
    let [material] = placed.materials[..] else { return Err(fault) };
    let to_render = Place::of(&placed.to_world, view).at_start();
    let light = match placed.shape {
        Shape::Mesh(id) => OpeningLight::of_mesh(lamp, opening, (view.world().mesh(id), &to_render), material),
        Shape::Sphere { radius_m } => {
            let sphere = SphereLight::new(radius_m, &to_render, material, material_table);
            Some(OpeningLight::of_sphere(lamp, opening, sphere))
        }
    };
    light.filter(|_| material_table.emission(material).is_none()).ok_or(fault)
}
