//! Finding the surfaces that glow.

use glam::DAffine3;

use super::Light;
use super::lamp::LampLight;
use super::opening::{Opening, OpeningLight};
use super::primitives::Primitives;
use super::sphere::SphereLight;
use super::tree::LightBounds;
use super::triangle::TriangleLight;
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
    /// An instance moves over time.
    #[error("instance {instance} moves, but only still instances can be lit; give it one pose")]
    Moving {
        /// The instance, counted from 0.
        instance: usize,
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
    /// Mean radiance of each material that glows, W·m⁻²·sr⁻¹·nm⁻¹, and which sides do.
    glows: Vec<Option<(f64, EmissionSides)>>,
}

impl<'a> Weigher<'a> {
    fn new(material_table: &'a MaterialTable, (low_nm, high_nm): (f64, f64)) -> Self {
        let weigh = |e: &Emission| (e.mean_radiance(material_table.textures(), low_nm, high_nm), e.sides);
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
    let weigher = Weigher::new(material_table, support_nm);
    let mut gathered = Gathered::default();
    for (index, instance) in world.instances().iter().enumerate() {
        check_materials(index, instance, &weigher)?;
        let to_render = to_render(view, index, instance)?;
        match instance.shape {
            Shape::Mesh(id) => gathered.add_mesh(world.mesh(id), instance, &to_render, &weigher),
            Shape::Sphere { radius_m } => gathered.add_sphere(radius_m, instance.materials[0], &to_render, &weigher),
        }
    }
    if gathered.lights.len() >= u32::MAX as usize { Err(LightError::TooMany) } else { Ok(gathered) }
}

/// From an instance's frame to the render frame.
fn to_render(view: &RenderSpace<'_>, index: usize, instance: &Instance) -> Result<DAffine3, LightError> {
    let mut to_render = instance.to_world.as_still().ok_or(LightError::Moving { instance: index })?;
    to_render.translation -= view.origin_m();
    Ok(to_render)
}

fn check_materials(index: usize, instance: &Instance, weigher: &Weigher<'_>) -> Result<(), LightError> {
    let materials = weigher.material_table.materials().len();
    match instance.materials.iter().find(|m| m.0 as usize >= materials) {
        Some(m) => Err(LightError::UnknownMaterial { instance: index, material: m.0, materials }),
        None => Ok(()),
    }
}

impl Gathered {
    fn add_mesh(&mut self, mesh: &Mesh, instance: &Instance, to_render: &DAffine3, weigher: &Weigher<'_>) {
        if !instance.materials.iter().any(|m| weigher.glow(*m).is_some()) {
            return self.primitives.push([]);
        }
        let material = |primitive: usize| instance.materials[usize::from(mesh.slots()[primitive])];
        let count = mesh.triangles().len();
        let mut lights: Vec<Option<u32>> = Vec::with_capacity(count);
        while lights.len() < count {
            let first = lights.len();
            let light = weigher.glow(material(first)).and_then(|(radiance, glow)| {
                let pair = (first + 1 < count && material(first + 1) == material(first)).then_some([first, first + 1]);
                let light = pair
                    .and_then(|pair| TriangleLight::of_two(mesh, pair, to_render, material(first)))
                    .or_else(|| TriangleLight::new(mesh, first, to_render, material(first)))?;
                Some((
                    light.triangles(),
                    self.add(light.bounds(radiance, glow == EmissionSides::Both), Light::Triangle(light)),
                ))
            });
            let (triangles, light) = light.map_or((1, None), |(triangles, light)| (triangles, Some(light)));
            lights.extend(core::iter::repeat_n(light, triangles));
        }
        self.primitives.push(lights);
    }

    fn add_sphere(&mut self, radius_m: f64, material: MaterialId, to_render: &DAffine3, weigher: &Weigher<'_>) {
        let Some((radiance, _)) = weigher.glow(material) else { return self.primitives.push([]) };
        let light = SphereLight::new(radius_m, to_render, material, weigher.material_table);
        let added = self.add(light.bounds(radiance), Light::Sphere(light));
        self.primitives.push([Some(added)]);
    }

    /// Adds a lamp whose opening is an instance of the world.
    pub(super) fn add_opening(
        &mut self,
        lamp: LampLight,
        (opening, instance): (Opening, u32),
        view: &RenderSpace<'_>,
        material_table: &MaterialTable,
    ) -> Result<(), LightError> {
        let fault = LightError::Opening { instance };
        let placed = view.world().instances().get(instance as usize).ok_or(fault)?;
        let [material] = placed.materials[..] else { return Err(fault) };
        let to_render = to_render(view, instance as usize, placed)?;
        let light = match placed.shape {
            Shape::Mesh(id) => OpeningLight::of_mesh(lamp, opening, (view.world().mesh(id), &to_render), material),
            Shape::Sphere { radius_m } => {
                let sphere = SphereLight::new(radius_m, &to_render, material, material_table);
                Some(OpeningLight::of_sphere(lamp, opening, sphere))
            }
        };
        let light = light.filter(|_| material_table.emission(material).is_none()).ok_or(fault)?;
        let primitives = light.primitives();
        let added = self.add(light.bounds(), Light::Opening(light));
        self.primitives.assign(instance, primitives, added);
        Ok(())
    }

    pub(super) fn add(&mut self, bounds: LightBounds, light: Light) -> u32 {
        self.lights.push(light);
        self.bounds.push(bounds);
        (self.lights.len() - 1) as u32
    }
}
