//! Shapes.

use std::f64::consts::{FRAC_PI_2, TAU};
use std::{collections::HashSet, rc::Rc};

use etendue_core::maths::f64 as maths;
use etendue_scene::record::Reflectance;
use etendue_scene::record::material::{Diffuse, Factor, Material, Surface};
use glam::{DAffine3, DMat3, DVec3};

use super::access::{indices, number, numbers, text, tuples};
use super::importer::{Importer, TraversalState};
use super::{binding::BoundMaterial, mesh::Primvar, transform::rotation};
use crate::scenery::{AreaLight, Graphics, Triangles};
use crate::syntax::usd::UsdPrim;

impl<'a> Importer<'a> {
    /// Converts the shape of a prim.
    pub(super) fn shape(&mut self, prim: &'a UsdPrim, state: &TraversalState<'a>) -> Result<(), String> {
        let message = |what: String| format!("{}: {what}", prim.path);
        let axis = text(prim, "axis");
        // Cylinders, cones and capsules are along z by default.
        let turn = |matrix| DAffine3::from_mat3(matrix);
        let radius = |name: &str, usual: f64| number(prim, name, usual).max(0.0);
        let (mesh, turn) = match prim.kind.as_str() {
            "Mesh" => return self.polygons(prim, state).map_err(message),
            "Sphere" => return self.sphere(prim, state).map_err(message),
            "Cube" => (cube(number(prim, "size", 2.0).abs()), DAffine3::IDENTITY),
            "Plane" => {
                let size = [number(prim, "width", 2.0), number(prim, "length", 2.0)].map(f64::abs);
                (plane(size), turn(plane_about(axis)))
            }
            "Cylinder" => {
                let mesh = cylinder([radius("radius", 1.0); 2], radius("height", 2.0), true);
                (mesh, turn(axis_rotation(axis)))
            }
            "Cylinder_1" => {
                let radii = [radius("radiusBottom", 1.0), radius("radiusTop", 1.0)];
                (cylinder(radii, radius("height", 2.0), true), turn(axis_rotation(axis)))
            }
            "Cone" => {
                let mesh = cylinder([radius("radius", 1.0), 0.0], radius("height", 2.0), true);
                (mesh, turn(axis_rotation(axis)))
            }
            "Capsule" => (capsule([radius("radius", 0.5); 2], radius("height", 1.0)), turn(axis_rotation(axis))),
            "Capsule_1" => {
                let radii = [radius("radiusBottom", 0.5), radius("radiusTop", 0.5)];
                (capsule(radii, radius("height", 1.0)), turn(axis_rotation(axis)))
            }
            kind => {
                super::access::mark_used(prim);
                self.scenery.report.note(format!("a \"{kind}\" is not supported and left out"));
                return Ok(());
            }
        };
        if matches!(prim.kind.as_str(), "Cylinder" | "Cylinder_1" | "Cone" | "Capsule" | "Capsule_1") {
            self.scenery.report.note("cylinders, cones and capsules become meshes of 128 sides");
        }
        let (graphics, material) = self.graphics(prim, state, state.bindings.material())?;
        if material.shows_outside(&mesh.uvs) {
            self.note_outside();
        }
        let area_light = self.light_of_shape(prim);
        let graphics = Graphics { to_world: graphics.to_world * turn, area_light, ..graphics };
        self.add(mesh, &graphics).map_err(message)
    }

    /// Graphics state of a shape without emission, with a material by path.
    pub(super) fn graphics(
        &mut self,
        prim: &'a UsdPrim,
        state: &TraversalState<'a>,
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

    /// Light of a shape, without "normalize".
    pub(super) fn light_of_shape(&mut self, prim: &'a UsdPrim) -> Option<Rc<AreaLight>> {
        let is_light = prim.has_schema("MeshLightAPI") || prim.has_schema("LightAPI");
        if is_light { self.mesh_light(prim).map(Rc::new) } else { None }
    }

    /// Colour of a prim without a material.
    fn display(&mut self, prim: &'a UsdPrim, graphics: &mut Graphics) {
        // Only its mean is used: the interpolation does not matter.
        let single = super::mesh::Counts { faces: 1, points: 1, corners: 1 };
        if let Ok(Some(colour)) = Primvar::<3>::read(prim, "primvars:displayColor", "constant", single) {
            if !colour.is_even() {
                self.scenery.report.note("a varying displayColor is replaced by its mean");
            }
            // 32-bit numbers have seven digits.
            graphics.material = self.display_material(colour.mean().map(|v| (1e7 * v).round() / 1e7));
        }
        let opacity = super::access::numbers(prim, "primvars:displayOpacity");
        if let Some(first) = opacity.first().filter(|opacity| **opacity < 1.0) {
            let limited = self.scenery.limit_to_unit("primvars:displayOpacity", *first);
            graphics.opacity = Some(Factor::Number(limited.into()));
        }
    }

    /// Diffuse surface of a colour, shared by all prims that have it.
    fn display_material(&mut self, rgb: [f64; 3]) -> Rc<str> {
        let key = format!("display/{rgb:?}");
        if let Some(known) = self.scenery.known.materials.get(&key) {
            return known.clone();
        }
        let colour = self.scenery.reflectance_from_rgb("primvars:displayColor", rgb);
        let name: Rc<str> = self.scenery.names.take("display", "display").into();
        let surface = Surface::Diffuse(Diffuse::new(Reflectance::Plain(colour)));
        self.scenery.scene.materials.push(Material::new(&*name, surface));
        self.scenery.known.materials.insert(key, name.clone());
        name
    }

    fn sphere(&mut self, prim: &'a UsdPrim, state: &TraversalState<'a>) -> Result<(), String> {
        let radius = number(prim, "radius", 1.0);
        if radius <= 0.0 {
            return Err(format!("\"radius\" is {radius}; expected a number above 0"));
        }
        let (graphics, material) = self.graphics(prim, state, state.bindings.material())?;
        if material.shows_outside(&[[0.0; 2], [1.0; 2]]) {
            self.note_outside();
        }
        let graphics = Graphics { area_light: self.light_of_shape(prim), ..graphics };
        self.round(radius, &graphics);
        self.scenery.check_size()
    }

    /// Adds a sphere about the origin of its space.
    pub(super) fn round(&mut self, radius: f64, graphics: &Graphics) {
        self.shines |= graphics.area_light.is_some();
        for corner in [DVec3::splat(radius), DVec3::splat(-radius)] {
            self.extend_bounds(graphics.to_world.transform_point3(corner));
        }
        self.scenery.whole_sphere(radius, graphics);
    }

    /// Adds a mesh in its space.
    pub(super) fn add(&mut self, mesh: Triangles, graphics: &Graphics) -> Result<(), String> {
        self.shines |= graphics.area_light.is_some();
        for position in &mesh.positions {
            self.extend_bounds(graphics.to_world.transform_point3(DVec3::from_array(*position)));
        }
        self.scenery.mesh(mesh, graphics)
    }
}

/// Maximum depth of instancers.
const MAX_DEPTH: usize = 8;

impl<'a> Importer<'a> {
    /// Converts an instancer. Each instance applies its scale, its orientation, its position, and the instancer's own transform.
    pub(super) fn instancer(&mut self, prim: &'a UsdPrim, state: &TraversalState<'a>) -> Result<(), String> {
        let failed = |what: String| Err(format!("{}: {what}", prim.path));
        if state.depth >= MAX_DEPTH {
            return failed(format!("instancers are nested more than {MAX_DEPTH} levels deep, or form a cycle"));
        }
        if !state.is_drawn() {
            self.note_undrawn(prim);
            return Ok(());
        }
        let Some(which) = indices(prim, "protoIndices") else {
            return failed("\"protoIndices\" has a value below 0".to_owned());
        };
        let positions = tuples::<3>(prim, "positions");
        let scales = tuples::<3>(prim, "scales");
        let precise = tuples::<4>(prim, "orientationsf");
        let turns = if precise.is_empty() { tuples::<4>(prim, "orientations") } else { precise };
        let ids = numbers(prim, "ids");
        let inactive = prim.inactive_ids.iter().map(|id| *id as f64);
        let hidden = numbers(prim, "invisibleIds").iter().copied().chain(inactive);
        let hidden: HashSet<u64> = hidden.map(f64::to_bits).collect();
        if positions.len() < which.len() {
            return failed(format!("{} positions for {} instances; expected one each", positions.len(), which.len()));
        }
        let targets = prim.relation("prototypes").map_or(&[][..], |relation| &relation.targets);
        for (number, prototype) in which.iter().enumerate() {
            let id = ids.get(number).copied().unwrap_or(number as f64);
            if hidden.contains(&id.to_bits()) {
                continue;
            }
            let Some(path) = targets.get(*prototype) else {
                return failed(format!("an instance refers to prototype {prototype}, and there are {}", targets.len()));
            };
            let Some(prototype_prim) = self.paths.prim(path) else {
                self.scenery.report.note(format!("the prototype <{path}> does not exist, or is a class or an over"));
                continue;
            };
            let [w, x, y, z] = turns.get(number).copied().unwrap_or([1.0, 0.0, 0.0, 0.0]);
            let turn = DMat3::from_quat(rotation([w, x, y, z]));
            let scale = DVec3::from_array(scales.get(number).copied().unwrap_or([1.0; 3]));
            let own = DAffine3 {
                matrix3: turn * DMat3::from_diagonal(scale),
                translation: DVec3::from_array(positions[number]),
            };
            if !own.is_finite() {
                return failed(format!("the transform of instance {number} is not finite"));
            }
            let mut inner = state.clone();
            (inner.to_world, inner.depth) = (state.to_world * own, state.depth + 1);
            self.prim(prototype_prim, &inner)?;
        }
        self.scenery.report.at(prim.path.clone());
        self.scenery.report.note("instances become copies, one mesh each");
        self.note_unused(prim);
        Ok(())
    }
}

/// Segments of round shapes.
pub(super) const SIDES: u32 = 128;
/// Rings of a hemisphere.
const RINGS: u32 = 32;

/// Rotation from a shape about z to one about another axis, as in UsdGeom: x, y, z are permuted cyclically.
pub(super) fn axis_rotation(axis: &str) -> DMat3 {
    match axis {
        "X" => DMat3::from_cols(DVec3::Y, DVec3::Z, DVec3::X),
        "Y" => DMat3::from_cols(DVec3::Z, DVec3::X, DVec3::Y),
        _ => DMat3::IDENTITY,
    }
}

/// The same for a plane, whose width is along x (for the axis x: along z).
fn plane_about(axis: &str) -> DMat3 {
    match axis {
        "X" => DMat3::from_cols(DVec3::NEG_Z, DVec3::Y, DVec3::X),
        "Y" => DMat3::from_cols(DVec3::X, DVec3::NEG_Z, DVec3::Y),
        _ => DMat3::IDENTITY,
    }
}

/// Cube about the origin.
pub(super) fn cube(size: f64) -> Triangles {
    let mut mesh = Triangles::default();
    for axis in ["X", "Y", "Z"] {
        for side in [1.0, -1.0] {
            let turn = axis_rotation(axis);
            let first = mesh.positions.len() as u32;
            for [u, v] in [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]] {
                let place = DVec3::new(side * (2.0 * u - 1.0), 2.0 * v - 1.0, side);
                mesh.positions.push((0.5 * size * (turn * place)).to_array());
                mesh.normals.push((side * (turn * DVec3::Z)).to_array());
                mesh.uvs.push([u, v]);
            }
            mesh.triangles.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
        }
    }
    mesh
}

/// Rectangle with the normal z.
fn plane([width, length]: [f64; 2]) -> Triangles {
    let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    Triangles {
        positions: corners.map(|[u, v]| [width * (u - 0.5), length * (v - 0.5), 0.0]).to_vec(),
        normals: vec![[0.0, 0.0, 1.0]; 4],
        uvs: corners.to_vec(),
        triangles: vec![[0, 1, 2], [0, 2, 3]],
    }
}

/// Surface of revolution about z: rings with radius, height, and the normal's radial and axial components, from bottom to top.
fn revolved(rings: &[[f64; 4]]) -> Triangles {
    let mut mesh = Triangles::default();
    let rows = rings.len() as u32;
    for i in 0..=SIDES {
        let fraction = f64::from(i) / f64::from(SIDES);
        let (sin, cos) = maths::sin_cos(fraction * TAU);
        for (row, [radius, height, out, up]) in rings.iter().enumerate() {
            mesh.positions.push([radius * cos, radius * sin, *height]);
            mesh.normals.push([out * cos, out * sin, *up]);
            mesh.uvs.push([fraction, row as f64 / (rings.len() - 1) as f64]);
        }
    }
    for side in 0..SIDES {
        for row in (0..rows - 1).filter(|row| rings[*row as usize][..2] != rings[*row as usize + 1][..2]) {
            let (here, next) = (side * rows + row, (side + 1) * rows + row);
            let at_pole = |row: u32| rings[row as usize][0] == 0.0;
            mesh.triangles.extend((!at_pole(row)).then_some([here, next, next + 1]));
            mesh.triangles.extend((!at_pole(row + 1)).then_some([here, next + 1, here + 1]));
        }
    }
    mesh
}

/// Cylinder with its caps; radii at its lower and its upper end.
pub(super) fn cylinder([lower, upper]: [f64; 2], height: f64, has_caps: bool) -> Triangles {
    let half = 0.5 * height;
    let slope = DVec3::new(height, lower - upper, 0.0).normalize_or(DVec3::X);
    let wall = [[lower, -half, slope.x, slope.y], [upper, half, slope.x, slope.y]];
    if !has_caps {
        return revolved(&wall);
    }
    let floor = [[0.0, -half, 0.0, -1.0], [lower, -half, 0.0, -1.0]];
    let ceiling = [[upper, half, 0.0, 1.0], [0.0, half, 0.0, 1.0]];
    revolved(&[floor, wall, ceiling].concat())
}

/// Cylinder of this height between two hemispheres.
fn capsule([lower, upper]: [f64; 2], height: f64) -> Triangles {
    let ring = |radius: f64, at: f64, i: u32| {
        let (sin, cos) = maths::sin_cos(FRAC_PI_2 * f64::from(i) / f64::from(RINGS));
        [radius * cos, at + radius * sin, cos, sin]
    };
    let below = (0..=RINGS).rev().map(|i| {
        let [radius, z, out, up] = ring(lower, 0.5 * height, i);
        [radius, -z, out, -up]
    });
    let above = (0..=RINGS).map(|i| ring(upper, 0.5 * height, i));
    revolved(&below.chain(above).collect::<Vec<_>>())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Enclosed volume; checks that triangles face the direction of their normals.
    fn volume(mesh: &Triangles) -> f64 {
        let mut sum = 0.0;
        for corners in &mesh.triangles {
            let [a, b, c] = corners.map(|i| DVec3::from_array(mesh.positions[i as usize]));
            let normal: DVec3 = corners.iter().map(|i| DVec3::from_array(mesh.normals[*i as usize])).sum();
            assert!((b - a).cross(c - a).dot(normal) >= 0.0, "{a} {b} {c}");
            sum += a.dot(b.cross(c)) / 6.0;
        }
        sum
    }

    #[test]
    fn solids_hold_what_they_should() {
        use std::f64::consts::PI;
        assert!((volume(&cube(3.0)) - 27.0).abs() < 1e-9);
        // A polygon of 128 sides has 0.9996 of the circle's area.
        let near = |actual: f64, expected: f64| assert!((actual / expected - 1.0).abs() < 2e-3, "{actual} {expected}");
        near(volume(&cylinder([2.0, 2.0], 3.0, true)), 12.0 * PI);
        near(volume(&cylinder([2.0, 0.0], 3.0, true)), 4.0 * PI);
        near(volume(&capsule([1.0, 1.0], 3.0)), 3.0 * PI + 4.0 / 3.0 * PI);
        assert!((axis_rotation("X") * DVec3::Z - DVec3::X).length() < 1e-12);
        assert!((axis_rotation("Y") * DVec3::Z - DVec3::Y).length() < 1e-12);
    }
}
