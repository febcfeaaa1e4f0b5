//! Objects: placed meshes, spheres, discs, rectangles.

use etendue_io::mesh::{encode_obj, encode_ply};
use etendue_scene::record::medium::{MediumMesh, MediumShape, MediumSphere};
use etendue_scene::record::shape::{Disc, Quad, Sphere};
use etendue_scene::record::{Body, Material, Mesh, Object, Shape, Transform};
use etendue_scene::{record::material::Surface, record::mesh::Axis, record::transform::angles_deg};
use glam::{DAffine3, DMat3, DVec3};

use super::round::Triangles;
use super::stage::{Graphics, INTERFACE, SceneBuilder};
use crate::naming::rounded;

impl SceneBuilder {
    /// Transform from a shape's space to our world.
    pub(crate) fn placement(&self, graphics: &Graphics) -> DAffine3 {
        DAffine3::from_mat3(self.to_ours) * graphics.to_world
    }

    /// Adds a mesh with the current material and light.
    pub(crate) fn mesh(&mut self, mesh: Triangles, graphics: &Graphics) -> Result<(), String> {
        let count = mesh.triangles.len();
        self.surface(mesh, graphics, count)
    }

    /// Adds a mesh that represents `count` shapes of the file.
    pub(crate) fn surface(&mut self, mesh: Triangles, graphics: &Graphics, count: usize) -> Result<(), String> {
        if mesh.triangles.is_empty() {
            self.report.note("a mesh without triangles is left out");
            return Ok(());
        }
        let placed_mesh = mesh.placed(self.placement(graphics), graphics.reverse_orientation);
        let preferred = if graphics.name.is_empty() { "mesh" } else { &graphics.name };
        let file = self.file_names.take(preferred, "mesh");
        if self.is_visible(graphics) {
            let path = self.add_file(format!("meshes/{file}.ply"), encode_ply(&placed_mesh));
            let up_axis = Some(Axis::Z.into());
            self.scene.meshes.push(Mesh { up_axis, ..Mesh::new(file.as_str(), path.as_str()) });
            self.object("mesh", Body::Mesh(file.as_str().into()), Transform::default(), graphics, count);
        }
        if fills(graphics) {
            let path = self.add_file(format!("meshes/{file}-medium.obj"), encode_obj(&placed_mesh));
            let shape = MediumShape::Mesh(MediumMesh::new(path.as_str()));
            self.fill_inside(graphics, shape, Transform::default());
        }
        self.check_size()
    }

    /// Adds a sphere about the origin of a shape's space.
    pub(crate) fn whole_sphere(&mut self, radius: f64, graphics: &Graphics) {
        let Some((rotation, scale)) = orthogonal(self.placement(graphics).matrix3) else {
            self.report.note("a sheared sphere is left out");
            return;
        };
        let position = self.placement(graphics).translation;
        if graphics.reverse_orientation && graphics.area_light.is_some() {
            self.report.note("a sphere that emits inwards emits outwards here");
        }
        let is_even = (scale.max_element() - scale.min_element()).abs() <= 1e-9 * scale.max_element();
        let (radius, transform) = match is_even {
            true => (radius * scale.x, place(position, DMat3::IDENTITY, DVec3::ONE)),
            false => (radius, place(position, rotation, scale)),
        };
        let body = Body::Shape(Shape::Sphere(Sphere::new(radius)));
        if self.is_visible(graphics) {
            self.object("sphere", body, transform.clone(), graphics, 1);
        }
        if fills(graphics) {
            if !is_even {
                self.report.note("a medium in an ellipsoid is left out");
                return;
            }
            self.fill_inside(graphics, MediumShape::Sphere(MediumSphere::new(radius)), transform);
        }
    }

    /// Adds a disc in the plane z = `height` of a shape's space, with its front towards +z.
    pub(crate) fn whole_disc(&mut self, radius: f64, height: f64, graphics: &Graphics) {
        self.flat("disk", Shape::Disc(Disc::new(radius)), height, graphics);
    }

    /// Adds a rectangle of extents `size` in the plane z = 0 of a shape's space, with its front towards +z. An image on it may appear mirrored.
    pub(crate) fn quad(&mut self, size: [f64; 2], graphics: &Graphics) {
        self.flat("rectangle", Shape::Quad(Quad::new(size)), 0.0, graphics);
    }

    fn flat(&mut self, kind: &str, shape: Shape, height: f64, graphics: &Graphics) {
        let to_scene = self.placement(graphics);
        let Some((rotation, scale)) = orthogonal(to_scene.matrix3) else {
            self.report.note(format!("a sheared {kind} is left out"));
            return;
        };
        // `orthogonal` may have rotated x, which does not affect a flat shape, except for its front.
        let rotation = match graphics.reverse_orientation {
            true => DMat3::from_cols(-rotation.x_axis, rotation.y_axis, -rotation.z_axis),
            false => rotation,
        };
        let centre = to_scene.transform_point3(DVec3::new(0.0, 0.0, height));
        if self.is_visible(graphics) {
            let scale = DVec3::new(scale.x, scale.y, 1.0);
            self.object(kind, Body::Shape(shape), place(centre, rotation, scale), graphics, 1);
        }
    }

    /// Fills the inside of a shape with its medium, except inside glass: a solid displaces media here.
    fn fill_inside(&mut self, graphics: &Graphics, shape: MediumShape, transform: Transform) {
        let is_glass =
            |m: &Material| *m.name.value == *graphics.material && matches!(m.surface.0, Surface::Dielectric(_));
        if self.scene.materials.iter().any(is_glass) {
            let medium = &graphics.inside;
            self.report.note(format!(
                "warning: the medium \"{medium}\" in a dielectric is left out: light is neither scattered nor absorbed in it"
            ));
            return;
        }
        self.fill(&graphics.inside, shape, transform);
    }

    /// Returns true for a visible surface, false for a mere medium boundary.
    fn is_visible(&mut self, graphics: &Graphics) -> bool {
        let is_border = &*graphics.material == INTERFACE;
        if is_border && graphics.area_light.is_some() {
            self.report.note("a shape that is only the interface of a medium emits no light here");
        }
        !is_border
    }

    /// Adds an object with the current material and light; `count` is the number of pbrt shapes in it.
    fn object(&mut self, kind: &str, body: Body, transform: Transform, graphics: &Graphics, count: usize) {
        let material = match &graphics.area_light {
            None => self.known_material(&graphics.material),
            Some(light) => {
                if light.has_flux() && count > 1 {
                    self.report.note("\"power\" of an area light applies to each triangle of a mesh, as in pbrt; all triangles are assumed equally bright");
                }
                self.emissive_copy(&graphics.material, light.emission(count))
            }
        };
        let material = match &graphics.opacity {
            None => material,
            Some(opacity) => self.translucent_copy(&material, opacity.clone()),
        };
        let preferred = if graphics.name.is_empty() { kind } else { &graphics.name };
        let name = self.names.take(preferred, "object");
        let material = Some(material.as_str().into());
        self.scene.objects.push(Object { material, ..Object::new(name.as_str(), body, transform) });
    }
}

/// Returns true if a shape separates a medium inside from the outside.
fn fills(graphics: &Graphics) -> bool {
    !graphics.inside.is_empty() && graphics.inside != graphics.outside
}

/// Checks that a number is above 0.
pub(crate) fn above_zero(name: &str, value: f64) -> Result<f64, String> {
    if value > 0.0 { Ok(value) } else { Err(format!("\"{name}\" is {value}; expected a number above 0")) }
}

/// Rotation and the scales before it, equal to a matrix up to a rotation of x; `None` if it shears.
fn orthogonal(m: DMat3) -> Option<(DMat3, DVec3)> {
    let axes = [m.x_axis, m.y_axis, m.z_axis];
    let scale = DVec3::from_array(axes.map(DVec3::length));
    let [x, y, z] = axes.map(DVec3::normalize_or_zero);
    let square = [x.dot(y), y.dot(z), z.dot(x)].iter().all(|c| c.abs() < 1e-6);
    let x = if x.cross(y).dot(z) < 0.0 { -x } else { x };
    square.then_some((DMat3::from_cols(x, y, z), scale))
}

/// Our transform, without default values.
fn place(position: DVec3, rotation: DMat3, scale: DVec3) -> Transform {
    let angles = rounded(angles_deg(rotation));
    Transform {
        position_m: Some(position.to_array().into()),
        rotation_deg: Some(angles).filter(|a| *a != [0.0; 3]).map(Into::into),
        scale: Some(scale).filter(|s| *s != DVec3::ONE).map(|s| s.to_array().into()),
        ..Transform::default()
    }
}
