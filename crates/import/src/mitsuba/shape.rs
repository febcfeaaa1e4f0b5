//! Shapes.

use super::access::{find, flag, number, stated, text, vector};
use super::importer::{Importer, MAX_DEPTH};
use super::solids::{cube, cylinder, rectangle};
use super::transform::transform_of;
use crate::scenery::{AreaLight, Graphics, Triangles};
use crate::syntax::mitsuba::MitsubaElement;
use etendue_io::Error;
use glam::{DAffine3, DVec3};
use std::f64::consts::TAU;
use std::rc::Rc;

impl<'a> Importer<'a> {
    /// A shape in the space of `outer`.
    pub(super) fn shape(&mut self, element: &'a MitsubaElement, outer: &Graphics, depth: usize) -> Result<(), Error> {
        if depth >= MAX_DEPTH {
            return Err(
                element.fault(format!("instances stand more than {MAX_DEPTH} deep in one another, or in a circle"))
            );
        }
        self.at(element);
        let told = |what: String| element.fault(what);
        let kind = element.kind();
        if (kind == "instance" && depth >= 1) || (kind == "shapegroup" && depth >= 2) {
            let told =
                format!("the shape \"{kind}\" within an instance, which Mitsuba does not allow; put its shapes there");
            return Err(element.fault(told));
        }
        // What is instanced stands where its instances are.
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
                    "bsplinecurve" | "linearcurve" => "hairs have no shape here",
                    _ => "it has no shape here",
                };
                self.scenery.report.note(format!("the shape \"{other}\" is left out: {why}"));
                return Ok(());
            }
        }
        let has_picture = self.has_picture(element, 0)?;
        let graphics = self.held(element, graphics)?;
        self.at(element);
        match kind {
            "obj" | "ply" => self.mesh_file(element, graphics)?,
            "rectangle" if has_picture || graphics.to_world.matrix3.determinant() < 0.0 => {
                self.mesh(rectangle(), &graphics).map_err(told)?;
            }
            "rectangle" => self.scenery.quad([2.0; 2], &graphics),
            "cube" => self.mesh(cube(), &graphics).map_err(told)?,
            "cylinder" => {
                let ends = [vector(element, "p0", DVec3::ZERO)?, vector(element, "p1", DVec3::Z)?];
                let mesh = cylinder(ends, number(element, "radius", 1.0)?)
                    .ok_or_else(|| told("a cylinder without extent".to_owned()))?;
                self.scenery.report.note("a cylinder is a mesh of 128 sides");
                self.mesh(mesh, &graphics).map_err(told)?;
            }
            "sphere" => {
                let (centre, radius) =
                    (vector(element, "center", DVec3::ZERO)?, stated(element, "radius")?.unwrap_or(1.0));
                if radius <= 0.0 {
                    return Err(told(format!("\"radius\" of {radius}; expected a number above 0")));
                }
                let to_world = graphics.to_world * DAffine3::from_translation(centre);
                let graphics = Graphics { to_world, ..graphics };
                if has_picture {
                    self.round(Triangles::of_sphere(radius, [-radius, radius], TAU), &graphics).map_err(told)?;
                } else {
                    self.scenery.whole_sphere(radius, &graphics);
                }
            }
            // Mitsuba's coordinates are the distance from the middle and the turn; ours point upwards.
            _ if has_picture => {
                let disc = Triangles::of_ring([1.0, 0.0], 0.0, TAU, |s, t| [1.0 - t, 1.0 - s]);
                self.round(disc, &graphics).map_err(told)?;
            }
            _ => self.scenery.whole_disc(1.0, 0.0, &graphics),
        }
        self.scenery.check_size().map_err(told)?;
        self.note_unused(element);
        Ok(())
    }

    /// A round shape as one mesh.
    fn round(&mut self, mesh: Triangles, graphics: &Graphics) -> Result<(), String> {
        self.scenery.report.note("spheres and disks that carry a picture are meshes of 256 sides");
        self.scenery.surface(mesh, graphics, 1)
    }

    fn instance(&mut self, element: &'a MitsubaElement, graphics: &Graphics, depth: usize) -> Result<(), Error> {
        let groups = self.within(element, "shape")?;
        if groups.is_empty() {
            return Err(element.fault("an instance without a <ref> to a shapegroup"));
        }
        groups.into_iter().try_for_each(|group| self.shape(group, graphics, depth + 1))
    }

    /// What holds for a shape: its surface, its light, its medium.
    fn held(&mut self, element: &'a MitsubaElement, graphics: Graphics) -> Result<Graphics, Error> {
        let mut graphics = graphics;
        graphics.reverse_orientation = flag(element, "flip_normals", false)?;
        match self.within(element, "bsdf")?.first() {
            Some(bsdf) => graphics.material = self.bsdf(bsdf, 0)?,
            // What shines reflects nothing unless it is told to.
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
            self.scenery.report.note("the medium outside of a shape is that of the shape or camera about it");
        }
        Ok(graphics)
    }

    fn area_light(&mut self, emitter: &'a MitsubaElement) -> Result<Option<AreaLight>, Error> {
        if emitter.kind() != "area" {
            let told = format!("the emitter \"{}\" of a shape is not understood and left out", emitter.kind());
            self.scenery.report.note(told);
            return Ok(None);
        }
        let unit = self.light(emitter, "radiance")?;
        if unit.luminance <= 0.0 {
            self.scenery.report.note("an area light is dark and left out");
            return Ok(None);
        }
        Ok(Some(AreaLight { colour: unit.colour, luminance: unit.luminance, flux: None, two_sided: false }))
    }

    /// Whether a picture lies on a surface; each is looked at once, and what stands in a circle counts as having one.
    fn has_picture(&mut self, element: &'a MitsubaElement, depth: usize) -> Result<bool, Error> {
        if let Some(known) = self.pictured.get(&element.number) {
            return Ok(*known);
        }
        self.pictured.insert(element.number, true);
        let has = depth >= MAX_DEPTH || self.finds_picture(element, depth)?;
        self.pictured.insert(element.number, has);
        Ok(has)
    }

    fn finds_picture(&mut self, element: &'a MitsubaElement, depth: usize) -> Result<bool, Error> {
        for child in &element.children {
            let meant = match (child.tag, child.name()) {
                ("ref", "interior" | "exterior") => continue,
                ("ref", _) => self.resolve(child)?,
                _ => child,
            };
            match meant.tag {
                "texture" => return Ok(true),
                "bsdf" if self.has_picture(meant, depth + 1)? => return Ok(true),
                _ => {}
            }
        }
        Ok(false)
    }

    fn mesh_file(&mut self, element: &'a MitsubaElement, graphics: Graphics) -> Result<(), Error> {
        let is_obj = element.kind() == "obj";
        let name = text(element, "filename")?.ok_or_else(|| element.fault("a mesh without \"filename\""))?;
        let mut mesh = Triangles::read(&self.file(name)).map_err(|told| element.fault(told))?;
        // Mitsuba's v points downwards in pictures.
        if !flag(element, "flip_tex_coords", is_obj)? {
            mesh.uvs.iter_mut().for_each(|uv| uv[1] = 1.0 - uv[1]);
        }
        if flag(element, "face_normals", false)? {
            mesh.normals.clear();
        } else if mesh.normals.is_empty() {
            mesh.smooth(graphics.to_world);
        }
        // Without normals the winding alone says which side is the front, and a mirror turns it.
        let is_turned = mesh.normals.is_empty() && graphics.to_world.matrix3.determinant() < 0.0;
        let reverse_orientation = graphics.reverse_orientation != is_turned;
        let graphics = Graphics { reverse_orientation, ..graphics };
        self.mesh(mesh, &graphics).map_err(|told| element.fault(told))
    }
}
