//! Shapes: placed meshes, spheres, discs, cylinders.

use etendue_scene::record::material::Factor;

use super::parameters::Parameters;
use super::patch::{DIVISIONS, PatchMesh};
use crate::scenery::{Graphics, SceneBuilder, TextureBase, TextureUse, Triangles, above_zero};

impl SceneBuilder {
    pub(super) fn shape(&mut self, kind: &str, parameters: Parameters<'_>, graphics: &Graphics) -> Result<(), String> {
        let message = |what: String| format!("Shape \"{kind}\": {what}");
        let image_count = self.known.placed_images.len();
        let base = self.known.texture_bases.get(&graphics.material).cloned();
        self.known.placed_images.extend(base);
        let Some(opaque) = self.with_alpha(parameters, graphics).map_err(message)? else { return Ok(()) };
        let graphics = &Graphics { texture_base: self.common_base(image_count), ..opaque };
        match kind {
            "trianglemesh" => {
                let mesh = Triangles::from_parameters(parameters).map_err(message)?;
                self.mesh(mesh.with_uvs_for(graphics), graphics).map_err(message)?;
            }
            "plymesh" => {
                let mesh = self.ply(parameters).map_err(message)?;
                self.mesh(mesh.with_uvs_for(graphics), graphics).map_err(message)?;
            }
            "bilinearmesh" => {
                let PatchMesh { mesh, patches, is_curved } = PatchMesh::from_parameters(parameters).map_err(message)?;
                if is_curved {
                    self.report.note(format!(
                        "curved bilinear patches become {DIVISIONS} by {DIVISIONS} squares of two triangles"
                    ));
                }
                if parameters.find("emissionfilename").is_some() {
                    self.report.note("\"emissionfilename\" of a mesh is not used: its emission is uniform");
                }
                self.surface(mesh.with_uvs_for(graphics), graphics, patches).map_err(message)?;
            }
            "sphere" => self.sphere(parameters, graphics).map_err(message)?,
            "disk" => self.disc(parameters, graphics).map_err(message)?,
            "cylinder" => self.cylinder(parameters, graphics).map_err(message)?,
            other => {
                let why = match other {
                    "loopsubdiv" => {
                        "subdivision is not supported; convert it to a mesh with pbrt --format or another program"
                    }
                    "curve" => "hair is not supported",
                    _ => "this shape is not supported",
                };
                self.report.note(format!("the shape \"{other}\" is left out: {why}"));
                return Ok(());
            }
        }
        self.note_unused(&format!("Shape \"{kind}\""), parameters.unused());
        Ok(())
    }

    /// State of a shape with its "alpha"; `None` if alpha makes it invisible.
    fn with_alpha(&mut self, parameters: Parameters<'_>, graphics: &Graphics) -> Result<Option<Graphics>, String> {
        let opacity = match self.factor(parameters, "alpha", 1.0, TextureUse::Numbers)? {
            Factor::Number(alpha) if alpha.value >= 1.0 => None,
            Factor::Number(alpha) if alpha.value <= 0.0 => {
                // pbrt's scenes hide lights in this way: an invisible shape still emits light.
                self.report.note(match graphics.area_light {
                    Some(_) => {
                        "an area light of alpha 0, which is an invisible light in pbrt, is left out: lights are visible here"
                    }
                    None => "a shape of alpha 0 is left out: it is invisible",
                });
                return Ok(None);
            }
            some => Some(some),
        };
        Ok(Some(Graphics { opacity, ..graphics.clone() }))
    }

    fn ply(&mut self, parameters: Parameters<'_>) -> Result<Triangles, String> {
        let name = parameters.text("filename")?.ok_or("\"filename\" is missing")?;
        if name.ends_with(".gz") {
            return Err(format!("`{name}`: compressed files are not supported; decompress it and change the name"));
        }
        if parameters.find("displacement").is_some() {
            self.report.note("\"displacement\" of a mesh is not used");
        }
        Triangles::read(&self.find_file(name))
    }

    fn sphere(&mut self, parameters: Parameters<'_>, graphics: &Graphics) -> Result<(), String> {
        let radius = above_zero("radius", parameters.number("radius", 1.0)?)?;
        let [a, b] = [parameters.number("zmin", -radius)?, parameters.number("zmax", radius)?];
        let heights = [a.min(b), a.max(b)].map(|z| z.clamp(-radius, radius));
        let turn_deg = turn_deg(parameters)?;
        if heights == [-radius, radius] && turn_deg == 360.0 && graphics.texture_base.is_none() {
            self.whole_sphere(radius, graphics);
            return Ok(());
        }
        self.round(Triangles::from_sphere(radius, heights, turn_deg.to_radians()), graphics)
    }

    fn disc(&mut self, parameters: Parameters<'_>, graphics: &Graphics) -> Result<(), String> {
        let radius = above_zero("radius", parameters.number("radius", 1.0)?)?;
        let (inner, height) = (parameters.number("innerradius", 0.0)?, parameters.number("height", 0.0)?);
        let turn_deg = turn_deg(parameters)?;
        if inner == 0.0 && turn_deg == 360.0 && graphics.texture_base.is_none() {
            self.whole_disc(radius, height, graphics);
            return Ok(());
        }
        self.round(Triangles::from_ring([radius, inner], height, turn_deg.to_radians(), |s, t| [s, t]), graphics)
    }

    fn cylinder(&mut self, parameters: Parameters<'_>, graphics: &Graphics) -> Result<(), String> {
        let radius = above_zero("radius", parameters.number("radius", 1.0)?)?;
        let [a, b] = [parameters.number("zmin", -1.0)?, parameters.number("zmax", 1.0)?];
        let turn_deg = turn_deg(parameters)?;
        self.round(Triangles::from_cylinder(radius, [a.min(b), a.max(b)], turn_deg.to_radians()), graphics)
    }

    /// Adds a round shape as one mesh.
    fn round(&mut self, mesh: Triangles, graphics: &Graphics) -> Result<(), String> {
        self.report.note("cylinders, and spheres and discs that are textured or partial, become meshes of 256 sides");
        self.surface(mesh.with_uvs_for(graphics), graphics, 1)
    }
}

/// Sweep of a round shape about its axis, 0 to 360°.
fn turn_deg(parameters: Parameters<'_>) -> Result<f64, String> {
    Ok(parameters.number("phimax", 360.0)?.clamp(0.0, 360.0))
}

impl Triangles {
    /// The same, with the texture coordinates that its images need: pbrt's default ones if it has none, or those of a projection.
    fn with_uvs_for(self, graphics: &Graphics) -> Self {
        match &graphics.texture_base {
            Some(TextureBase::Surface) if self.uvs.is_empty() => self.with_corners_as_uv(),
            Some(TextureBase::Projection(projection)) => self.with_projected_uvs(projection, graphics.to_world),
            _ => self,
        }
    }
}
