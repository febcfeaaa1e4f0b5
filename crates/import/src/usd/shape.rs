//! Shapes.

use super::access::{number, text};
use super::bound_material::BoundMaterial;
use super::importer::{Importer, State};
use super::primvar::Primvar;
use super::solids::{about, capsule, cube, cylinder, plane, plane_about};
use crate::scenery::{AreaLight, Graphics, Triangles};
use crate::syntax::usd::UsdPrim;
use etendue_scene::record::Reflectance;
use etendue_scene::record::material::{Diffuse, Factor, Material, Surface};
use glam::{DAffine3, DVec3};
use std::rc::Rc;

impl<'a> Importer<'a> {
    /// What is drawn of a prim.
    pub(super) fn shape(&mut self, prim: &'a UsdPrim, state: &State<'a>) -> Result<(), String> {
        let told = |what: String| format!("{}: {what}", prim.path);
        let axis = text(prim, "axis");
        // Cylinders, cones and capsules stand along z where nothing is said.
        let turn = |matrix| DAffine3::from_mat3(matrix);
        let radius = |name: &str, usual: f64| number(prim, name, usual).max(0.0);
        let (mesh, turn) = match prim.kind.as_str() {
            "Mesh" => return self.polygons(prim, state).map_err(told),
            "Sphere" => return self.sphere(prim, state).map_err(told),
            "Cube" => (cube(number(prim, "size", 2.0).abs()), DAffine3::IDENTITY),
            "Plane" => {
                let size = [number(prim, "width", 2.0), number(prim, "length", 2.0)].map(f64::abs);
                (plane(size), turn(plane_about(axis)))
            }
            "Cylinder" => {
                let mesh = cylinder([radius("radius", 1.0); 2], radius("height", 2.0), true);
                (mesh, turn(about(axis)))
            }
            "Cylinder_1" => {
                let radii = [radius("radiusBottom", 1.0), radius("radiusTop", 1.0)];
                (cylinder(radii, radius("height", 2.0), true), turn(about(axis)))
            }
            "Cone" => {
                let mesh = cylinder([radius("radius", 1.0), 0.0], radius("height", 2.0), true);
                (mesh, turn(about(axis)))
            }
            "Capsule" => (capsule([radius("radius", 0.5); 2], radius("height", 1.0)), turn(about(axis))),
            "Capsule_1" => {
                let radii = [radius("radiusBottom", 0.5), radius("radiusTop", 0.5)];
                (capsule(radii, radius("height", 1.0)), turn(about(axis)))
            }
            kind => {
                super::access::leave(prim);
                self.scenery.report.note(format!("a \"{kind}\" has no shape here and is left out"));
                return Ok(());
            }
        };
        if matches!(prim.kind.as_str(), "Cylinder" | "Cylinder_1" | "Cone" | "Capsule" | "Capsule_1") {
            self.scenery.report.note("cylinders, cones and capsules are meshes of 128 sides");
        }
        let (graphics, material) = self.graphics(prim, state, state.bindings.material())?;
        if material.shows_outside(&mesh.uvs) {
            self.note_outside();
        }
        let area_light = self.light_of_shape(prim);
        let graphics = Graphics { to_world: graphics.to_world * turn, area_light, ..graphics };
        self.add(mesh, &graphics).map_err(told)
    }

    /// What holds for a shape that gives no light, with a material by its path.
    pub(super) fn graphics(
        &mut self,
        prim: &'a UsdPrim,
        state: &State<'a>,
        material: Option<&str>,
    ) -> Result<(Graphics, BoundMaterial), String> {
        let mut graphics = Graphics { to_world: state.to_world, name: Self::name(prim), ..Graphics::plain() };
        let Some(path) = material else {
            self.display(prim, &mut graphics);
            return Ok((graphics, BoundMaterial::default()));
        };
        let material = self.material(path)?;
        self.scenery.report.at(prim.path.clone());
        graphics.material = material.name.clone();
        Ok((graphics, material))
    }

    /// The light of a shape, without "normalize".
    pub(super) fn light_of_shape(&mut self, prim: &'a UsdPrim) -> Option<Rc<AreaLight>> {
        let is_light = prim.has_schema("MeshLightAPI") || prim.has_schema("LightAPI");
        if is_light { self.mesh_light(prim).map(Rc::new) } else { None }
    }

    /// The colour of a prim without a material.
    fn display(&mut self, prim: &'a UsdPrim, graphics: &mut Graphics) {
        // Only its mean is asked for: how it lies does not matter.
        let whole = super::primvar::Counts { faces: 1, points: 1, corners: 1 };
        if let Ok(Some(colour)) = Primvar::<3>::read(prim, "primvars:displayColor", "constant", whole) {
            if !colour.is_even() {
                self.scenery.report.note("a displayColor that is not the same everywhere is its mean");
            }
            // Numbers of 32 bits have seven digits.
            graphics.material = self.display_material(colour.mean().map(|v| (1e7 * v).round() / 1e7));
        }
        let opacity = super::access::numbers(prim, "primvars:displayOpacity");
        if let Some(first) = opacity.first().filter(|opacity| **opacity < 1.0) {
            let share = self.scenery.cut("primvars:displayOpacity", *first);
            graphics.opacity = Some(Factor::Number(share.into()));
        }
    }

    /// A matt surface of a colour, one for all prims that have it.
    fn display_material(&mut self, rgb: [f64; 3]) -> Rc<str> {
        let key = format!("display/{rgb:?}");
        if let Some(known) = self.scenery.known.materials.get(&key) {
            return known.clone();
        }
        let colour = self.scenery.share_of_rgb("primvars:displayColor", rgb);
        let name: Rc<str> = self.scenery.names.take("display", "display").into();
        let surface = Surface::Diffuse(Diffuse::new(Reflectance::Plain(colour)));
        self.scenery.scene.materials.push(Material::new(&*name, surface));
        self.scenery.known.materials.insert(key, name.clone());
        name
    }

    fn sphere(&mut self, prim: &'a UsdPrim, state: &State<'a>) -> Result<(), String> {
        let radius = number(prim, "radius", 1.0);
        if radius <= 0.0 {
            return Err(format!("\"radius\" of {radius}; expected a number above 0"));
        }
        let (graphics, material) = self.graphics(prim, state, state.bindings.material())?;
        if material.shows_outside(&[[0.0; 2], [1.0; 2]]) {
            self.note_outside();
        }
        let graphics = Graphics { area_light: self.light_of_shape(prim), ..graphics };
        self.round(radius, &graphics);
        self.scenery.check_size()
    }

    /// A sphere about the origin of its space.
    pub(super) fn round(&mut self, radius: f64, graphics: &Graphics) {
        self.shines |= graphics.area_light.is_some();
        for corner in [DVec3::splat(radius), DVec3::splat(-radius)] {
            self.reaches(graphics.to_world.transform_point3(corner));
        }
        self.scenery.whole_sphere(radius, graphics);
    }

    /// A mesh in its space.
    pub(super) fn add(&mut self, mesh: Triangles, graphics: &Graphics) -> Result<(), String> {
        self.shines |= graphics.area_light.is_some();
        for position in &mesh.positions {
            self.reaches(graphics.to_world.transform_point3(DVec3::from_array(*position)));
        }
        self.scenery.mesh(mesh, graphics)
    }
}
