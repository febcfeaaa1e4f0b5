//! Shapes.

use super::access::{indices, number, text};
use super::bound::Bound;
use super::importer::{Importer, State};
use super::mesh::PolygonMesh;
use super::primvar::Primvar;
use super::solids::{about, capsule, cube, cylinder, plane, plane_about};
use crate::import::scenery::{AreaLight, Graphics, Triangles};
use etendue_io::usd::UsdPrim;
use etendue_scene::record::Reflectance;
use etendue_scene::record::material::{Diffuse, Factor, Material, Surface};
use glam::{DAffine3, DVec3};
use std::collections::BTreeMap;
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
        let graphics = self.graphics(prim, state, state.material)?;
        let graphics = Graphics { to_world: graphics.to_world * turn, ..graphics };
        self.add(mesh, &graphics).map_err(told)
    }

    /// What holds for a shape, with a material by its path.
    fn graphics(&mut self, prim: &'a UsdPrim, state: &State<'a>, material: Option<&str>) -> Result<Graphics, String> {
        let mut graphics = Graphics { to_world: state.to_world, name: Self::name(prim), ..Graphics::plain() };
        match material {
            Some(path) => graphics.material = self.material(path)?.name,
            None => self.display(prim, &mut graphics),
        }
        if prim.has_schema("MeshLightAPI") || prim.has_schema("LightAPI") {
            graphics.area_light = self.mesh_light(prim).map(Rc::new);
        }
        Ok(graphics)
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
        let graphics = self.graphics(prim, state, state.material)?;
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

    fn polygons(&mut self, prim: &'a UsdPrim, state: &State<'a>) -> Result<(), String> {
        // Faces by the path of their material; what no subset has is the mesh's own.
        let mut parts: BTreeMap<&str, Vec<usize>> = BTreeMap::new();
        let mut taken = vec![false; PolygonMesh::read(prim, "")?.faces()];
        for subset in prim.children.iter().filter(|child| child.kind == "GeomSubset") {
            let Some(path) = self.binding(subset) else { continue };
            if !matches!(text(subset, "elementType"), "" | "face") {
                self.scenery.report.note("a GeomSubset of other than faces is not used");
                continue;
            }
            for face in indices(subset, "indices").ok_or_else(|| format!("{}: a face below 0", subset.path))? {
                if taken.get(face) == Some(&false) {
                    taken[face] = true;
                    parts.entry(path).or_default().push(face);
                }
            }
        }
        let rest: Vec<usize> = (0..taken.len()).filter(|face| !taken[*face]).collect();
        if !rest.is_empty() || parts.is_empty() {
            self.part(prim, state, state.material, rest)?;
        }
        parts.into_iter().try_for_each(|(path, faces)| self.part(prim, state, Some(path), faces))
    }

    /// Faces of a mesh that have one material.
    fn part(
        &mut self,
        prim: &'a UsdPrim,
        state: &State<'a>,
        material: Option<&str>,
        faces: Vec<usize>,
    ) -> Result<(), String> {
        let graphics = self.graphics(prim, state, material)?;
        let uv: Bound = match material {
            Some(path) => self.material(path)?,
            None => Bound::default(),
        };
        let mesh = PolygonMesh::read(prim, uv.primvar())?;
        let (mut triangles, refused) = mesh.triangles(faces.into_iter());
        if uv.has_pictures() && triangles.uvs.is_empty() {
            let told =
                format!("a mesh without \"{}\", by which its pictures lie: all of it has their corner", uv.primvar());
            self.scenery.report.note(told);
            triangles.uvs = vec![[0.0; 2]; triangles.positions.len()];
        }
        if refused > 0 {
            self.scenery.report.note(format!("{refused} polygons that cross themselves are left out"));
        }
        if mesh.is_cage {
            self.scenery.report.note(
                "a subdivision surface is its control mesh with smooth normals: subdivide it before, or set subdivisionScheme = \"none\"",
            );
        }
        // Normals say which side is the front, and those of a cage follow its winding.
        let has_own = !triangles.normals.is_empty() && !mesh.is_cage;
        let reverse_orientation = mesh.is_left_handed && !has_own;
        let area_light = graphics.area_light.clone().map(|light| self.spread(light, &triangles, &graphics, prim));
        self.add(triangles, &Graphics { reverse_orientation, area_light, ..graphics })
    }

    /// The light of a mesh of which "normalize" holds: divided by its area in the world of the stage.
    fn spread(&self, light: Rc<AreaLight>, mesh: &Triangles, graphics: &Graphics, prim: &UsdPrim) -> Rc<AreaLight> {
        if !super::access::flag(prim, "inputs:normalize", false) {
            return light;
        }
        let at = |i: u32| graphics.to_world.transform_point3(DVec3::from_array(mesh.positions[i as usize]));
        let area_m2: f64 =
            mesh.triangles.iter().map(|t| t.map(at)).map(|[a, b, c]| 0.5 * (b - a).cross(c - a).length()).sum();
        let area = area_m2 / (self.stage.metres_per_unit * self.stage.metres_per_unit);
        if area > 0.0 { Rc::new(AreaLight { luminance: light.luminance / area, ..(*light).clone() }) } else { light }
    }
}
