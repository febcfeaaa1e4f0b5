//! Shapes: placed meshes, spheres, discs, cylinders.

use etendue_scene::record::material::Factor;

use super::parameters::Parameters;
use crate::scenery::{Graphics, SceneBuilder, Triangles, above_zero};

impl SceneBuilder {
    pub(super) fn shape(&mut self, kind: &str, parameters: Parameters<'_>, graphics: &Graphics) -> Result<(), String> {
        let message = |what: String| format!("Shape \"{kind}\": {what}");
        let Some(graphics) = &self.with_alpha(parameters, graphics).map_err(message)? else { return Ok(()) };
        match kind {
            "trianglemesh" => {
                let mesh = Triangles::from_parameters(parameters).map_err(message)?;
                let mesh = if self.has_image(graphics) { mesh.with_default_uvs() } else { mesh };
                self.mesh(mesh, graphics).map_err(message)?;
            }
            "plymesh" => {
                let mesh = self.ply(parameters).map_err(message)?;
                let mesh = if self.has_image(graphics) { mesh.with_default_uvs() } else { mesh };
                self.mesh(mesh, graphics).map_err(message)?;
            }
            "bilinearmesh" => {
                self.report.note("bilinear patches become two triangles each, which is exact for flat patches");
                let mesh = Triangles::from_patches(parameters).map_err(message)?;
                self.mesh(mesh, graphics).map_err(message)?;
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
        let opacity = match self.factor(parameters, "alpha", 1.0, |alpha| alpha)? {
            Factor::Number(share) if share.value >= 1.0 => None,
            Factor::Number(share) if share.value <= 0.0 => {
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
        Triangles::read(&self.source_file(name))
    }

    fn sphere(&mut self, parameters: Parameters<'_>, graphics: &Graphics) -> Result<(), String> {
        let radius = above_zero("radius", parameters.number("radius", 1.0)?)?;
        let [a, b] = [parameters.number("zmin", -radius)?, parameters.number("zmax", radius)?];
        let heights = [a.min(b), a.max(b)].map(|z| z.clamp(-radius, radius));
        let turn_deg = turn_deg(parameters)?;
        if heights == [-radius, radius] && turn_deg == 360.0 && !self.has_image(graphics) {
            self.whole_sphere(radius, graphics);
            return Ok(());
        }
        self.round(Triangles::from_sphere(radius, heights, turn_deg.to_radians()), graphics)
    }

    fn disc(&mut self, parameters: Parameters<'_>, graphics: &Graphics) -> Result<(), String> {
        let radius = above_zero("radius", parameters.number("radius", 1.0)?)?;
        let (inner, height) = (parameters.number("innerradius", 0.0)?, parameters.number("height", 0.0)?);
        let turn_deg = turn_deg(parameters)?;
        if inner == 0.0 && turn_deg == 360.0 && !self.has_image(graphics) {
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
        self.surface(mesh, graphics, 1)
    }

    /// Returns true if the texture coordinates of a shape place an image.
    fn has_image(&self, graphics: &Graphics) -> bool {
        matches!(graphics.opacity, Some(Factor::Texture(_))) || self.known.with_images.contains(&graphics.material)
    }
}

/// Sweep of a round shape about its axis, 0 to 360°.
fn turn_deg(parameters: Parameters<'_>) -> Result<f64, String> {
    Ok(parameters.number("phimax", 360.0)?.clamp(0.0, 360.0))
}

impl Triangles {
    fn from_parameters(parameters: Parameters<'_>) -> Result<Self, String> {
        let mesh = Self::points(parameters)?;
        let triangles = indices::<3>(parameters, mesh.positions.len())?;
        Ok(Self { triangles, ..mesh })
    }

    /// Corners of a patch are in rows: (0, 0), (1, 0), (0, 1), (1, 1).
    fn from_patches(parameters: Parameters<'_>) -> Result<Self, String> {
        let mesh = Self::points(parameters)?;
        let patches = indices::<4>(parameters, mesh.positions.len())?;
        if mesh.uvs.is_empty() {
            return Ok(mesh.with_own_vertices(&patches));
        }
        let triangles = patches.into_iter().flat_map(halves).collect();
        Ok(Self { triangles, ..mesh })
    }

    /// Patches with separate vertices and the texture coordinates of their corners: pbrt's default if a file has none.
    fn with_own_vertices(self, patches: &[[u32; 4]]) -> Self {
        let corners = patches.iter().flatten().map(|i| *i as usize);
        Self {
            normals: corners.clone().filter_map(|i| self.normals.get(i)).copied().collect(),
            positions: corners.map(|i| self.positions[i]).collect(),
            uvs: [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]].repeat(patches.len()),
            triangles: (0..patches.len() as u32).map(|i| [0, 1, 2, 3].map(|k| 4 * i + k)).flat_map(halves).collect(),
        }
    }

    /// The same, with pbrt's default texture coordinates if it has none.
    fn with_default_uvs(self) -> Self {
        if self.uvs.is_empty() { self.with_corners_as_uv() } else { self }
    }

    fn points(parameters: Parameters<'_>) -> Result<Self, String> {
        let positions = tuples::<3, f64>("P", parameters.numbers("P")?.ok_or("no \"P\"")?)?.to_vec();
        let normals = tuples::<3, f64>("N", parameters.numbers("N")?.unwrap_or_default())?.to_vec();
        let uvs = match parameters.numbers("uv")? {
            Some(uvs) => Some(uvs),
            None => parameters.numbers("st")?,
        };
        let uvs = tuples::<2, f64>("uv", uvs.unwrap_or_default())?.to_vec();
        for (name, count) in [("N", normals.len()), ("uv", uvs.len())] {
            if count != 0 && count != positions.len() {
                return Err(format!(
                    "{count} values of \"{name}\" for {} values of \"P\"; expected as many",
                    positions.len()
                ));
            }
        }
        Ok(Self { positions, normals, uvs, triangles: Vec::new() })
    }
}

/// Two triangles of a patch.
fn halves([a, b, c, d]: [u32; 4]) -> [[u32; 3]; 2] {
    [[a, b, d], [a, d, c]]
}

/// Corner indices of faces with `N` corners; if the file states none, those of one face in order.
fn indices<const N: usize>(parameters: Parameters<'_>, vertices: usize) -> Result<Vec<[u32; N]>, String> {
    match parameters.numbers("indices")? {
        Some(stated) => {
            let legal = stated.iter().map(|i| index(*i, vertices)).collect::<Result<Vec<u32>, _>>()?;
            tuples::<N, u32>("indices", &legal).map(<[_]>::to_vec)
        }
        None if vertices == N => Ok(vec![std::array::from_fn(|i| i as u32)]),
        None => Err("\"indices\" is missing".to_owned()),
    }
}

fn index(value: f64, vertices: usize) -> Result<u32, String> {
    match value.fract() == 0.0 && value >= 0.0 && value < vertices as f64 {
        true => Ok(value as u32),
        false => Err(format!("index {value} is out of range: there are {vertices} points")),
    }
}

fn tuples<'a, const N: usize, T>(name: &str, values: &'a [T]) -> Result<&'a [[T; N]], String> {
    match values.as_chunks::<N>() {
        (chunks, []) => Ok(chunks),
        _ => Err(format!("\"{name}\": {} numbers; expected a multiple of {N}", values.len())),
    }
}
