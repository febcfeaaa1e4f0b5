//! Shapes.
//!
//! Direction of green in normal maps on a mesh.
//!
//! Mitsuba's points along n × ∂p/∂u, whatever v does: up in an image that is not mirrored, down in a mirrored one, as on its rectangle, on PLY files (whose v
//! points down in images), and on meshes with a mirrored texture. Ours points up in the image unless stated to point down (`normal_map.y`); so a surface with a
//! normal map has a second material for meshes with mirrored images.

use std::{f64::consts::TAU, rc::Rc};

use etendue_core::maths::f64 as maths;
use etendue_io::Error;
use etendue_scene::record::material::{Green, Material, NormalMap};
use glam::{DAffine3, DVec2, DVec3};

use super::access::{find, flag, number, stated, text, vector};
use super::importer::{Importer, MAX_DEPTH};
use super::transform::transform_of;
use crate::scenery::{AreaLight, Graphics, Triangles};
use crate::syntax::mitsuba::MitsubaElement;

impl<'a> Importer<'a> {
    /// Converts a shape in the space of `outer`.
    pub(super) fn shape(&mut self, element: &'a MitsubaElement, outer: &Graphics, depth: usize) -> Result<(), Error> {
        if depth >= MAX_DEPTH {
            return Err(
                element.error(format!("instances are nested more than {MAX_DEPTH} levels deep, or form a cycle"))
            );
        }
        self.at(element);
        let located = |what: String| element.error(what);
        let kind = element.kind();
        if (kind == "instance" && depth >= 1) || (kind == "shapegroup" && depth >= 2) {
            let problem = format!(
                "the shape \"{kind}\" is in an instance, which Mitsuba does not allow; insert its shapes instead"
            );
            return Err(element.error(problem));
        }
        // A shape group is placed only by its instances.
        if kind == "shapegroup" && depth == 0 {
            return Ok(());
        }
        let own = transform_of(element, "to_world")?;
        let graphics = Graphics { to_world: outer.to_world * own, ..outer.clone() };
        match kind {
            "instance" => return self.instance(element, &graphics, depth),
            "shapegroup" => {
                return self
                    .within(element, "shape")?
                    .into_iter()
                    .try_for_each(|shape| self.shape(shape, outer, depth + 1));
            }
            "obj" | "ply" | "rectangle" | "cube" | "sphere" | "disk" | "cylinder" => {}
            other => {
                let why = match other {
                    "serialized" => "export its mesh as OBJ or PLY",
                    "bsplinecurve" | "linearcurve" => "hair is not supported",
                    _ => "this shape is not supported",
                };
                self.scenery.report.note(format!("the shape \"{other}\" is left out: {why}"));
                return Ok(());
            }
        }
        let has_picture = self.has_image(element, 0)?;
        let graphics = self.shape_state(element, graphics)?;
        self.at(element);
        match kind {
            "obj" | "ply" => self.mesh_file(element, graphics)?,
            "rectangle" if has_picture || graphics.to_world.matrix3.determinant() < 0.0 => {
                self.mesh(rectangle(), &graphics).map_err(located)?;
            }
            "rectangle" => self.scenery.quad([2.0; 2], &graphics),
            "cube" => self.mesh(cube(), &graphics).map_err(located)?,
            "cylinder" => {
                let ends = [vector(element, "p0", DVec3::ZERO)?, vector(element, "p1", DVec3::Z)?];
                let mesh = cylinder(ends, number(element, "radius", 1.0)?)
                    .ok_or_else(|| located("the cylinder has no extent".to_owned()))?;
                self.scenery.report.note("a cylinder becomes a mesh of 128 sides");
                self.mesh(mesh, &graphics).map_err(located)?;
            }
            "sphere" => {
                let (centre, radius) =
                    (vector(element, "center", DVec3::ZERO)?, stated(element, "radius")?.unwrap_or(1.0));
                if radius <= 0.0 {
                    return Err(located(format!("\"radius\" is {radius}; expected a number above 0")));
                }
                let to_world = graphics.to_world * DAffine3::from_translation(centre);
                let graphics = Graphics { to_world, ..graphics };
                if has_picture {
                    self.round(Triangles::from_sphere(radius, [-radius, radius], TAU), &graphics).map_err(located)?;
                } else {
                    self.scenery.whole_sphere(radius, &graphics);
                }
            }
            // Mitsuba's coordinates are the distance from the centre and the azimuth; ours point upwards.
            _ if has_picture => {
                let disc = Triangles::from_ring([1.0, 0.0], 0.0, TAU, |s, t| [1.0 - t, 1.0 - s]);
                self.round(disc, &graphics).map_err(located)?;
            }
            _ => self.scenery.whole_disc(1.0, 0.0, &graphics),
        }
        self.scenery.check_size().map_err(located)?;
        self.note_unused(element);
        Ok(())
    }

    /// Adds a round shape as one mesh.
    fn round(&mut self, mesh: Triangles, graphics: &Graphics) -> Result<(), String> {
        self.scenery.report.note("spheres and disks with a texture become meshes of 256 sides");
        self.scenery.surface(mesh, graphics, 1)
    }

    fn instance(&mut self, element: &'a MitsubaElement, graphics: &Graphics, depth: usize) -> Result<(), Error> {
        let groups = self.within(element, "shape")?;
        if groups.is_empty() {
            return Err(element.error("the instance has no <ref> to a shapegroup"));
        }
        groups.into_iter().try_for_each(|group| self.shape(group, graphics, depth + 1))
    }

    /// State of a shape: its surface, its light, its medium.
    fn shape_state(&mut self, element: &'a MitsubaElement, graphics: Graphics) -> Result<Graphics, Error> {
        let mut graphics = graphics;
        graphics.reverse_orientation = flag(element, "flip_normals", false)?;
        match self.within(element, "bsdf")?.first() {
            Some(bsdf) => graphics.material = self.bsdf(bsdf, 0)?,
            // An emitter reflects nothing unless it has a surface.
            None if !self.within(element, "emitter")?.is_empty() => graphics.material = self.scenery.black(),
            None => {}
        }
        if let Some(emitter) = self.within(element, "emitter")?.first() {
            self.at(emitter);
            graphics.area_light = self.area_light(emitter)?.map(Rc::new);
            self.note_unused(emitter);
        }
        for child in element.children.iter().filter(|child| child.name() == "interior") {
            let medium = self.resolve(child)?;
            child.used.set(true);
            if medium.tag == "medium" {
                graphics.inside = self.medium(medium)?;
            }
        }
        if find(element, "exterior").is_some() {
            self.at(element);
            self.scenery
                .report
                .note("the exterior medium of a shape is ignored: the medium of the enclosing shape or camera is used");
        }
        Ok(graphics)
    }

    fn area_light(&mut self, emitter: &'a MitsubaElement) -> Result<Option<AreaLight>, Error> {
        if emitter.kind() != "area" {
            let message = format!("the emitter \"{}\" of a shape is not supported and left out", emitter.kind());
            self.scenery.report.note(message);
            return Ok(None);
        }
        let unit = self.light(emitter, "radiance")?;
        if unit.luminance <= 0.0 {
            self.scenery.report.note("an area light emits no light and is left out");
            return Ok(None);
        }
        Ok(Some(AreaLight { colour: unit.colour, luminance: unit.luminance, flux: None, two_sided: false }))
    }

    /// Returns true if an image lies on a surface. Each is examined once; circular references count as having one.
    fn has_image(&mut self, element: &'a MitsubaElement, depth: usize) -> Result<bool, Error> {
        if let Some(known) = self.has_image.get(&element.number) {
            return Ok(*known);
        }
        self.has_image.insert(element.number, true);
        let has = depth >= MAX_DEPTH || self.find_image(element, depth)?;
        self.has_image.insert(element.number, has);
        Ok(has)
    }

    fn find_image(&mut self, element: &'a MitsubaElement, depth: usize) -> Result<bool, Error> {
        for child in &element.children {
            let target = match (child.tag, child.name()) {
                ("ref", "interior" | "exterior") => continue,
                ("ref", _) => self.resolve(child)?,
                _ => child,
            };
            match target.tag {
                "texture" => return Ok(true),
                "bsdf" if self.has_image(target, depth + 1)? => return Ok(true),
                _ => {}
            }
        }
        Ok(false)
    }

    fn mesh_file(&mut self, element: &'a MitsubaElement, graphics: Graphics) -> Result<(), Error> {
        let is_obj = element.kind() == "obj";
        let name = text(element, "filename")?.ok_or_else(|| element.error("the mesh has no \"filename\""))?;
        let mut mesh = Triangles::read(&self.noted_file(name)).map_err(|problem| element.error(problem))?;
        // Mitsuba's v points downwards in images.
        if !flag(element, "flip_tex_coords", is_obj)? {
            mesh.uvs.iter_mut().for_each(|uv| uv[1] = 1.0 - uv[1]);
        }
        if flag(element, "face_normals", false)? {
            mesh.normals.clear();
        } else if mesh.normals.is_empty() {
            mesh.smooth(graphics.to_world);
        }
        // Without normals the winding alone defines the front, and a mirror reverses it.
        let is_turned = mesh.normals.is_empty() && graphics.to_world.matrix3.determinant() < 0.0;
        let reverse_orientation = graphics.reverse_orientation != is_turned;
        let graphics = Graphics { reverse_orientation, ..graphics };
        self.mesh(mesh, &graphics).map_err(|problem| element.error(problem))
    }
}

impl Importer<'_> {
    /// Adds a mesh with the current material and light.
    pub(super) fn mesh(&mut self, mesh: Triangles, graphics: &Graphics) -> Result<(), String> {
        let mut graphics = graphics.clone();
        if self.normal_mapped.contains_key(&graphics.material) && self.is_mirrored(&mesh, &graphics) {
            graphics.material = self.green_down(&graphics.material);
        }
        self.scenery.mesh(mesh, &graphics)
    }

    /// Returns true if the mirrored part of the texture on a mesh is the larger one, seen in Mitsuba's world from the direction of the normals.
    fn is_mirrored(&self, mesh: &Triangles, graphics: &Graphics) -> bool {
        if mesh.uvs.len() != mesh.positions.len() {
            return false;
        }
        let placed = mesh.clone().placed(self.scenery.placement(graphics), graphics.reverse_orientation);
        // Its triangles turn anticlockwise about their normals, like images that are not mirrored.
        let turn = |triangle: &[u32; 3]| {
            let [a, b, c] = triangle.map(|i| DVec2::from_array(placed.uvs[i as usize]));
            (b - a).perp_dot(c - a)
        };
        placed.triangles.iter().map(turn).sum::<f64>() * self.scenery.to_ours.determinant() < 0.0
    }

    /// Name of the version of a material whose green points down.
    fn green_down(&mut self, name: &Rc<str>) -> Rc<str> {
        if let Some(Some(known)) = self.normal_mapped.get(name) {
            return known.clone();
        }
        let Some(base) = self.scenery.scene.materials.iter().find(|material| material.name.value == **name) else {
            return name.clone();
        };
        let normal_map = base.normal_map.clone().map(|map| NormalMap { y: Some(Green::Down.into()), ..map });
        let own = self.scenery.names.take(&format!("{name}-mirrored"), "material");
        let flipped = Material { name: own.as_str().into(), normal_map, ..base.clone() };
        self.scenery.scene.materials.push(flipped);
        let own: Rc<str> = own.as_str().into();
        self.normal_mapped.insert(name.clone(), Some(own.clone()));
        own
    }
}

/// Two triangles per four corners.
fn squares(count: u32) -> Vec<[u32; 3]> {
    (0..count).map(|i| 4 * i).flat_map(|i| [[i, i + 1, i + 2], [i, i + 2, i + 3]]).collect()
}

/// The square −1 … 1 in z = 0, its front towards +z.
fn rectangle() -> Triangles {
    let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    Triangles {
        positions: corners.map(|[x, y]| [x, y, 0.0]).to_vec(),
        normals: vec![[0.0, 0.0, 1.0]; 4],
        // v is 0 at y = −1, the first row of an image.
        uvs: corners.map(|[x, y]| [0.5 * (x + 1.0), 0.5 * (1.0 - y)]).to_vec(),
        triangles: squares(1),
    }
}

/// Cube −1 … 1, with corners in Mitsuba's order.
pub(super) fn cube() -> Triangles {
    let faces: [([f64; 3], [[f64; 3]; 4]); 6] = [
        ([0., -1., 0.], [[1., -1., -1.], [1., -1., 1.], [-1., -1., 1.], [-1., -1., -1.]]),
        ([0., 1., 0.], [[1., 1., -1.], [-1., 1., -1.], [-1., 1., 1.], [1., 1., 1.]]),
        ([1., 0., 0.], [[1., -1., -1.], [1., 1., -1.], [1., 1., 1.], [1., -1., 1.]]),
        ([0., 0., 1.], [[1., -1., 1.], [1., 1., 1.], [-1., 1., 1.], [-1., -1., 1.]]),
        ([-1., 0., 0.], [[-1., -1., 1.], [-1., 1., 1.], [-1., 1., -1.], [-1., -1., -1.]]),
        ([0., 0., -1.], [[1., 1., -1.], [1., -1., -1.], [-1., -1., -1.], [-1., 1., -1.]]),
    ];
    Triangles {
        positions: faces.iter().flat_map(|(_, corners)| *corners).collect(),
        normals: faces.iter().flat_map(|(normal, _)| [*normal; 4]).collect(),
        uvs: [[0., 0.], [1., 0.], [1., 1.], [0., 1.]].repeat(6),
        triangles: squares(6),
    }
}

/// Lateral surface of a cylinder without its ends; `None` without extent.
pub(super) fn cylinder([from, to]: [DVec3; 2], radius: f64) -> Option<Triangles> {
    const SIDES: u32 = 128;
    let axis = (to - from).try_normalize().filter(|_| radius > 0.0)?;
    let x = axis.any_orthonormal_vector();
    let y = axis.cross(x);
    let mut mesh = Triangles::default();
    for i in 0..=SIDES {
        let fraction = f64::from(i) / f64::from(SIDES);
        let (sin, cos) = maths::sin_cos(fraction * TAU);
        let out = cos * x + sin * y;
        for (end, v) in [(from, 1.0), (to, 0.0)] {
            mesh.positions.push((end + radius * out).to_array());
            mesh.normals.push(out.to_array());
            mesh.uvs.push([fraction, v]);
        }
    }
    mesh.triangles = (0..SIDES).map(|i| 2 * i).flat_map(|i| [[i, i + 2, i + 3], [i, i + 3, i + 1]]).collect();
    Some(mesh)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every triangle faces the direction of its normals.
    #[test]
    fn solids_face_outwards() {
        let tube = cylinder([DVec3::ZERO, DVec3::new(0.0, 2.0, 1.0)], 0.5).expect("a cylinder");
        for mesh in [rectangle(), cube(), tube] {
            for [a, b, c] in mesh.triangles {
                let [p, q, r] = [a, b, c].map(|i| DVec3::from_array(mesh.positions[i as usize]));
                let normal = DVec3::from_array(mesh.normals[a as usize]);
                assert!((q - p).cross(r - p).dot(normal) > 0.0, "{p} {q} {r}");
            }
        }
    }
}
