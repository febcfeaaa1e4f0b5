//! Collects the emitting surfaces of a scene.

use etendue_core::{Motion, TimeInterval, WavelengthRange};
use glam::DAffine3;

use super::lamp::{Lamp, LampLight};
use super::moving::{LightMotion, MovingLamp, MovingLight};
use super::triangle::{FlatShape, TriangleLight};
use super::{
    Light, light::Primitives, opening::Opening, opening_light::OpeningLight, sphere::SphereLight, tree::LightBounds,
};
use crate::geometry::{Instance, Mesh, Shape};
use crate::materials::{Emission, EmissionSides, MaterialTable};
use crate::{MaterialId, render_space::RenderSpace};

/// Error in the collection of lights.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum LightError {
    /// An instance names a material that does not exist.
    #[error(
        "instance {instance} refers to material {material}, but there are {materials} materials; add the material first"
    )]
    UnknownMaterial {
        /// Index of the instance, from 0.
        instance: usize,
        /// The material that it names.
        material: u32,
        /// Number of materials.
        materials: usize,
    },
    /// The surface of a lamp's opening does not match the opening.
    #[error(
        "instance {instance} does not match the opening of its light; place the opening's mesh, or a sphere, with one material \
         that does not emit"
    )]
    Opening {
        /// Index of the instance, from 0.
        instance: u32,
    },
    /// More emitting triangles than can be indexed.
    #[error("the scene has more than 4 294 967 294 emitting triangles; use fewer")]
    TooMany,
}

#[derive(Default)]
pub(super) struct SceneLights {
    pub(super) lights: Vec<Light>,
    /// Bounds of each light, for light selection.
    pub(super) bounds: Vec<LightBounds>,
    pub(super) primitives: Primitives,
}

/// The emission of the materials, for light selection.
struct EmissionWeights<'a> {
    material_table: &'a MaterialTable,
    /// Of each material that emits.
    emissions: Vec<Option<MeanEmission>>,
}

/// The emission of a material, for light selection.
#[derive(Clone, Copy)]
struct MeanEmission {
    /// Mean radiance, W·m⁻²·sr⁻¹·nm⁻¹, with its strength over the view's interval.
    radiance: f64,
    is_two_sided: bool,
}

impl<'a> EmissionWeights<'a> {
    fn new(material_table: &'a MaterialTable, range: WavelengthRange, interval: TimeInterval) -> Self {
        let counts =
            |e: &Emission| e.modulation.as_ref().map_or(1.0, |modulation| modulation.selection_level(interval));
        let weigh = |e: &Emission| MeanEmission {
            radiance: e.mean_radiance(material_table.textures(), range.low_nm, range.high_nm) * counts(e),
            is_two_sided: e.sides == EmissionSides::Both,
        };
        let emissions = material_table.materials().iter().map(|m| m.emission.as_ref().map(weigh)).collect();
        Self { material_table, emissions }
    }

    fn emission(&self, material: MaterialId) -> Option<MeanEmission> {
        self.emissions[material.0 as usize]
    }
}

pub(super) fn collect_surface_lights(
    view: &RenderSpace<'_>,
    material_table: &MaterialTable,
    range: WavelengthRange,
) -> Result<SceneLights, LightError> {
    let world = view.world();
    let weights = EmissionWeights::new(material_table, range, view.interval());
    let mut scene_lights = SceneLights::default();
    for (index, instance) in world.instances().iter().enumerate() {
        check_materials(index, instance, &weights)?;
        if !instance.materials.iter().any(|material| weights.emission(*material).is_some()) {
            scene_lights.primitives.push([]);
            continue;
        }
        let place = LightPlacement::new(&instance.to_world, view);
        match instance.shape {
            Shape::Mesh(id) => scene_lights.add_mesh(world.mesh(id), instance, &place, &weights),
            Shape::Sphere { radius_m } => scene_lights.add_sphere(radius_m, instance.materials[0], place, &weights),
        }
    }
    if scene_lights.lights.len() >= u32::MAX as usize { Err(LightError::TooMany) } else { Ok(scene_lights) }
}

fn check_materials(index: usize, instance: &Instance, weights: &EmissionWeights<'_>) -> Result<(), LightError> {
    let materials = weights.material_table.materials().len();
    match instance.materials.iter().find(|m| m.0 as usize >= materials) {
        Some(m) => Err(LightError::UnknownMaterial { instance: index, material: m.0, materials }),
        None => Ok(()),
    }
}

/// Placement of an object during the view's interval.
enum LightPlacement {
    /// Static: transform to the render frame.
    Static(DAffine3),
    Moving(LightMotion),
}

impl LightPlacement {
    fn new(to_world: &Motion, view: &RenderSpace<'_>) -> Self {
        let (origin_m, interval) = (view.origin_m(), view.interval());
        match to_world.constant_over(interval) {
            Some(mut to_render) => {
                to_render.translation -= origin_m;
                Self::Static(to_render)
            }
            None => Self::Moving(LightMotion { to_world: to_world.clone(), origin_m, interval }),
        }
    }

    /// Transform to the render frame at the start of the interval.
    fn at_start(&self) -> DAffine3 {
        match self {
            Self::Static(to_render) => *to_render,
            Self::Moving(motion) => motion.at(motion.interval.start_s()),
        }
    }

    /// The light of a triangle, with its bounds; of two triangles together if they are to be a pair and form a parallelogram.
    fn facets(
        &self,
        mesh: &Mesh,
        first: usize,
        is_pair: bool,
        material: MaterialId,
        emission: MeanEmission,
    ) -> Option<(Light, LightBounds)> {
        let MeanEmission { radiance, is_two_sided } = emission;
        let pair = is_pair.then_some([first, first + 1]);
        match self {
            Self::Static(to_render) => {
                let parallelogram = match pair {
                    Some(pair) => TriangleLight::from_parallelogram(mesh, pair, to_render, material),
                    None => None,
                };
                let light = match parallelogram {
                    Some(light) => light,
                    None => TriangleLight::new(mesh, first, to_render, material)?,
                };
                let bounds = light.bounds(radiance, is_two_sided);
                Some((Light::Triangle(light), bounds))
            }
            Self::Moving(motion) => {
                let parallelogram = match pair {
                    Some(pair) => FlatShape::two(mesh, pair),
                    None => None,
                };
                let facets = match parallelogram {
                    Some(facets) => facets,
                    None => FlatShape::one(mesh, first),
                };
                let light = MovingLight::from_facets(facets, motion.clone(), material);
                let bounds = light.bounds(radiance, is_two_sided)?;
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
            Self::Static(to_render) => {
                let light = SphereLight::new(radius_m, &to_render, material, material_table);
                let bounds = light.bounds(radiance);
                Some((Light::Sphere(light), bounds))
            }
            Self::Moving(motion) => {
                let light = MovingLight::from_sphere(radius_m, motion, material, material_table);
                let bounds = light.bounds(radiance, true)?;
                Some((Light::Moving(Box::new(light)), bounds))
            }
        }
    }
}

impl SceneLights {
    fn add_mesh(&mut self, mesh: &Mesh, instance: &Instance, place: &LightPlacement, weights: &EmissionWeights<'_>) {
        let material = |primitive: usize| instance.materials[usize::from(mesh.slots()[primitive])];
        let count = mesh.triangles().len();
        let mut lights: Vec<Option<u32>> = Vec::with_capacity(count);
        while lights.len() < count {
            let first = lights.len();
            let light = weights.emission(material(first)).and_then(|emission| {
                let is_pair = first + 1 < count && material(first + 1) == material(first);
                let (light, bounds) = place.facets(mesh, first, is_pair, material(first), emission)?;
                Some((light.triangles(), self.add(bounds, light)))
            });
            let (triangles, light) = light.map_or((1, None), |(triangles, light)| (triangles, Some(light)));
            lights.extend(core::iter::repeat_n(light, triangles));
        }
        self.primitives.push(lights);
    }

    fn add_sphere(
        &mut self,
        radius_m: f64,
        material: MaterialId,
        place: LightPlacement,
        weights: &EmissionWeights<'_>,
    ) {
        let light = weights.emission(material).and_then(|emission| {
            let (light, bounds) = place.sphere(radius_m, material, weights.material_table, emission.radiance)?;
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
        range: WavelengthRange,
    ) -> Result<(), LightError> {
        let opening = lamp.opening();
        let place = LightPlacement::new(lamp.to_world(), view);
        let light = LampLight::new(lamp, &place.at_start(), view.interval(), range);
        let Some((opening, instance)) = opening else {
            match place {
                LightPlacement::Static(_) => self.add(light.bounds(), Light::Lamp(light)),
                LightPlacement::Moving(motion) => self.add_moving_lamp(MovingLamp::from_point(motion, light)),
            };
            return Ok(());
        };
        let light = opening_light(light, opening, instance, view, material_table)?;
        let primitives = light.primitives();
        let added = match place {
            LightPlacement::Static(_) => self.add(light.bounds(), Light::Opening(light)),
            LightPlacement::Moving(motion) => self.add_moving_lamp(MovingLamp::from_opening(motion, light)),
        };
        self.primitives.assign(instance, primitives, added);
        Ok(())
    }

    fn add_moving_lamp(&mut self, lamp: MovingLamp) -> u32 {
        self.add(lamp.bounds(), Light::MovingLamp(Box::new(lamp)))
    }

    pub(super) fn add(&mut self, bounds: LightBounds, light: Light) -> u32 {
        self.lights.push(light);
        self.bounds.push(bounds);
        (self.lights.len() - 1) as u32
    }
}

/// A lamp with the instance of the world that is its opening, at the start of the view's interval.
fn opening_light(
    lamp: LampLight,
    opening: Opening,
    instance: u32,
    view: &RenderSpace<'_>,
    material_table: &MaterialTable,
) -> Result<OpeningLight, LightError> {
    let error = LightError::Opening { instance };
    let placed = view.world().instances().get(instance as usize).ok_or(error)?;
    let [material] = placed.materials[..] else { return Err(error) };
    let to_render = LightPlacement::new(&placed.to_world, view).at_start();
    let light = match placed.shape {
        Shape::Mesh(id) => OpeningLight::from_mesh(lamp, opening, view.world().mesh(id), &to_render, material),
        Shape::Sphere { radius_m } => {
            let sphere = SphereLight::new(radius_m, &to_render, material, material_table);
            Some(OpeningLight::from_sphere(lamp, opening, sphere))
        }
    };
    match light {
        Some(light) if material_table.emission(material).is_none() => Ok(light),
        _ => Err(error),
    }
}
