//! Shapes: meshes in their places, spheres, discs.

use super::known::INTERFACE;
use super::parameters::Parameters;
use super::scenery::{Graphics, Scenery};
use crate::import::naming::rounded;
use etendue_io::mesh::{PlacedTriangles, encode_obj, encode_ply, read_mesh};
use etendue_scene::record::medium::{MediumMesh, MediumShape, MediumSphere};
use etendue_scene::record::mesh::Axis;
use etendue_scene::record::shape::{Disc, Sphere};
use etendue_scene::record::transform::angles_deg;
use etendue_scene::record::{Body, Mesh, Object, Shape, Transform};
use glam::{DAffine3, DMat3, DVec3};

/// Triangles as a file has them.
#[derive(Default)]
struct Triangles {
    positions: Vec<[f64; 3]>,
    normals: Vec<[f64; 3]>,
    uvs: Vec<[f64; 2]>,
    triangles: Vec<[u32; 3]>,
}

impl Scenery {
    pub(super) fn shape(&mut self, kind: &str, parameters: Parameters<'_>, graphics: &Graphics) -> Result<(), String> {
        let told = |what: String| format!("Shape \"{kind}\": {what}");
        if parameters.find("alpha").is_some() {
            self.report.note("\"alpha\" of a shape is not used: all of it is there");
        }
        match kind {
            "trianglemesh" => {
                let mesh = Triangles::of(parameters).map_err(told)?;
                self.mesh(mesh, graphics).map_err(told)?;
            }
            "plymesh" => {
                let mesh = self.ply(parameters).map_err(told)?;
                self.mesh(mesh, graphics).map_err(told)?;
            }
            "bilinearmesh" => {
                self.report.note("bilinear patches are two triangles each: exact where they are flat");
                let mesh = Triangles::of_patches(parameters).map_err(told)?;
                self.mesh(mesh, graphics).map_err(told)?;
            }
            "sphere" => self.sphere(parameters, graphics).map_err(told)?,
            "disk" => self.disc(parameters, graphics).map_err(told)?,
            other => {
                let why = match other {
                    "loopsubdiv" => {
                        "surfaces are not subdivided here: pbrt --format or another program makes a mesh of it"
                    }
                    "curve" => "hairs have no shape here",
                    _ => "it has no shape here",
                };
                self.report.note(format!("the shape \"{other}\" is left out: {why}"));
                return Ok(());
            }
        }
        self.note_unused(&format!("Shape \"{kind}\""), parameters);
        Ok(())
    }

    fn ply(&mut self, parameters: Parameters<'_>) -> Result<Triangles, String> {
        let name = parameters.text("filename")?.ok_or("no \"filename\"")?;
        if name.ends_with(".gz") {
            return Err(format!("`{name}`: compressed files are not read; unpack it and change the name"));
        }
        if parameters.find("displacement").is_some() {
            self.report.note("\"displacement\" of a mesh is not used");
        }
        let asset = read_mesh(&self.source_folder.join(name)).map_err(|e| e.to_string())?;
        let place = |p: &[f32; 3]| std::array::from_fn(|i| asset.origin[i] + f64::from(p[i]));
        Ok(Triangles {
            positions: asset.positions.iter().map(place).collect(),
            normals: asset.normals.iter().map(|n| n.map(f64::from)).collect(),
            uvs: asset.uvs.iter().map(|uv| uv.map(f64::from)).collect(),
            triangles: asset.triangles,
        })
    }

    /// From a shape's space to our world.
    fn placed(&self, graphics: &Graphics) -> DAffine3 {
        DAffine3::from_mat3(self.to_ours) * graphics.to_world
    }

    fn mesh(&mut self, mesh: Triangles, graphics: &Graphics) -> Result<(), String> {
        if mesh.triangles.is_empty() {
            self.report.note("a mesh without triangles is left out");
            return Ok(());
        }
        let placed = mesh.placed(self.placed(graphics), graphics.reverse_orientation);
        let count = placed.triangles.len();
        let file = self.file_names.take("mesh", "mesh");
        if self.is_seen(graphics) {
            let path = self.add_file(format!("meshes/{file}.ply"), encode_ply(&placed));
            let up_axis = Some(Axis::Z.into());
            self.scene.meshes.push(Mesh { up_axis, ..Mesh::new(file.as_str(), path.as_str()) });
            self.object("mesh", Body::Mesh(file.as_str().into()), Transform::default(), graphics, count);
        }
        if fills(graphics) {
            let path = self.add_file(format!("meshes/{file}-medium.obj"), encode_obj(&placed));
            let shape = MediumShape::Mesh(MediumMesh::new(path.as_str()));
            self.fill(&graphics.inside, shape, Transform::default());
        }
        self.check_size()
    }

    fn sphere(&mut self, parameters: Parameters<'_>, graphics: &Graphics) -> Result<(), String> {
        let radius = above_zero("radius", parameters.number("radius", 1.0)?)?;
        let is_whole = parameters.number("zmin", -radius)? <= -radius
            && parameters.number("zmax", radius)? >= radius
            && parameters.number("phimax", 360.0)? >= 360.0;
        if !is_whole {
            self.report.note("a part of a sphere is the whole sphere");
        }
        let Some((rotation, scale)) = orthogonal(self.placed(graphics).matrix3) else {
            self.report.note("a sheared sphere is left out");
            return Ok(());
        };
        let placed = self.placed(graphics).translation;
        if graphics.reverse_orientation && graphics.area_light.is_some() {
            self.report.note("a sphere that shines inwards shines outwards");
        }
        let is_even = (scale.max_element() - scale.min_element()).abs() <= 1e-9 * scale.max_element();
        let (radius, transform) = match is_even {
            true => (radius * scale.x, place(placed, DMat3::IDENTITY, DVec3::ONE)),
            false => (radius, place(placed, rotation, scale)),
        };
        let body = Body::Shape(Shape::Sphere(Sphere::new(radius)));
        if self.is_seen(graphics) {
            self.object("sphere", body, transform.clone(), graphics, 1);
        }
        if fills(graphics) {
            if !is_even {
                self.report.note("a medium in an ellipsoid is left out");
                return Ok(());
            }
            self.fill(&graphics.inside, MediumShape::Sphere(MediumSphere::new(radius)), transform);
        }
        Ok(())
    }

    fn disc(&mut self, parameters: Parameters<'_>, graphics: &Graphics) -> Result<(), String> {
        let radius = above_zero("radius", parameters.number("radius", 1.0)?)?;
        if parameters.number("innerradius", 0.0)? > 0.0 || parameters.number("phimax", 360.0)? < 360.0 {
            self.report.note("a ring or a part of a disc is the whole disc");
        }
        let placed = self.placed(graphics);
        let Some((rotation, scale)) = orthogonal(placed.matrix3) else {
            self.report.note("a sheared disc is left out");
            return Ok(());
        };
        // `orthogonal` may have turned x round, which a disc does not show, but not its front.
        let rotation = match graphics.reverse_orientation {
            true => DMat3::from_cols(-rotation.x_axis, rotation.y_axis, -rotation.z_axis),
            false => rotation,
        };
        let centre = placed.transform_point3(DVec3::new(0.0, 0.0, parameters.number("height", 0.0)?));
        if self.is_seen(graphics) {
            let scale = DVec3::new(scale.x, scale.y, 1.0);
            let body = Body::Shape(Shape::Disc(Disc::new(radius)));
            self.object("disk", body, place(centre, rotation, scale), graphics, 1);
        }
        Ok(())
    }

    /// Whether a surface is one, and not the border of a medium alone.
    fn is_seen(&mut self, graphics: &Graphics) -> bool {
        let is_border = &*graphics.material == INTERFACE;
        if is_border && graphics.area_light.is_some() {
            self.report.note("a shape without a surface gives no light, as in pbrt");
        }
        !is_border
    }

    /// An object of the material and the light that hold now; `count` is how many shapes it is in pbrt.
    fn object(&mut self, kind: &str, body: Body, transform: Transform, graphics: &Graphics, count: usize) {
        let material = match &graphics.area_light {
            None => self.known_material(&graphics.material),
            Some(light) => {
                if light.has_flux() && count > 1 {
                    self.report.note("\"power\" of an area light holds for each triangle of a mesh, as in pbrt; triangles are taken as equally bright");
                }
                self.glowing(&graphics.material, light.emission(count))
            }
        };
        let name = self.names.take(kind, "object");
        let material = Some(material.as_str().into());
        self.scene.objects.push(Object { material, ..Object::new(name.as_str(), body, transform) });
    }
}

/// Whether a shape parts a medium within from what is outside.
fn fills(graphics: &Graphics) -> bool {
    !graphics.inside.is_empty() && graphics.inside != graphics.outside
}

fn above_zero(name: &str, value: f64) -> Result<f64, String> {
    if value > 0.0 { Ok(value) } else { Err(format!("\"{name}\" of {value}; expected a number above 0")) }
}

/// A rotation and the scales before it, which make a matrix up to a turn of x; `None` where it shears.
fn orthogonal(m: DMat3) -> Option<(DMat3, DVec3)> {
    let axes = [m.x_axis, m.y_axis, m.z_axis];
    let scale = DVec3::from_array(axes.map(DVec3::length));
    let [x, y, z] = axes.map(DVec3::normalize_or_zero);
    let square = [x.dot(y), y.dot(z), z.dot(x)].iter().all(|c| c.abs() < 1e-6);
    let x = if x.cross(y).dot(z) < 0.0 { -x } else { x };
    square.then_some((DMat3::from_cols(x, y, z), scale))
}

/// A transform of ours; what is as by default is not stated.
fn place(position: DVec3, rotation: DMat3, scale: DVec3) -> Transform {
    let angles = rounded(angles_deg(rotation));
    Transform {
        position_m: Some(position.to_array().into()),
        rotation_deg: Some(angles).filter(|a| *a != [0.0; 3]).map(Into::into),
        scale: Some(scale).filter(|s| *s != DVec3::ONE).map(|s| s.to_array().into()),
        ..Transform::default()
    }
}

impl Triangles {
    fn of(parameters: Parameters<'_>) -> Result<Self, String> {
        let mesh = Self::points(parameters)?;
        let triangles = indices::<3>(parameters, mesh.positions.len())?;
        Ok(Self { triangles, ..mesh })
    }

    /// Corners of a patch stand in rows: (0, 0), (1, 0), (0, 1), (1, 1).
    fn of_patches(parameters: Parameters<'_>) -> Result<Self, String> {
        let mesh = Self::points(parameters)?;
        let patches = indices::<4>(parameters, mesh.positions.len())?;
        let triangles = patches.into_iter().flat_map(|[a, b, c, d]| [[a, b, d], [a, d, c]]).collect();
        Ok(Self { triangles, ..mesh })
    }

    fn points(parameters: Parameters<'_>) -> Result<Self, String> {
        let positions = whole::<3, f64>("P", parameters.numbers("P")?.ok_or("no \"P\"")?)?.to_vec();
        let normals = whole::<3, f64>("N", parameters.numbers("N")?.unwrap_or_default())?.to_vec();
        let uvs = match parameters.numbers("uv")? {
            Some(uvs) => Some(uvs),
            None => parameters.numbers("st")?,
        };
        let uvs = whole::<2, f64>("uv", uvs.unwrap_or_default())?.to_vec();
        for (name, found) in [("N", normals.len()), ("uv", uvs.len())] {
            if found != 0 && found != positions.len() {
                return Err(format!("{found} of \"{name}\" for {} of \"P\"", positions.len()));
            }
        }
        Ok(Self { positions, normals, uvs, triangles: Vec::new() })
    }

    /// The same in our world. Winding is that of the normal, which a mirror does not turn.
    fn placed(self, to_ours: DAffine3, reversed: bool) -> PlacedTriangles {
        let inverse = to_ours.matrix3.inverse().transpose();
        let side = if reversed { -1.0 } else { 1.0 };
        let positions: Vec<DVec3> =
            self.positions.iter().map(|p| to_ours.transform_point3(DVec3::from_array(*p))).collect();
        let normals: Vec<DVec3> =
            self.normals.iter().map(|n| (inverse * DVec3::from_array(*n)).normalize_or_zero() * side).collect();
        let turned = (to_ours.matrix3.determinant() < 0.0) != reversed;
        let wind = |[a, b, c]: [u32; 3]| {
            let facing = |[a, b, c]: [usize; 3]| (positions[b] - positions[a]).cross(positions[c] - positions[a]);
            let own = [a, b, c].map(|i| i as usize);
            let turn = match normals.is_empty() {
                true => turned,
                false => own.iter().map(|i| normals[*i]).sum::<DVec3>().dot(facing(own)) < 0.0,
            };
            if turn { [a, c, b] } else { [a, b, c] }
        };
        PlacedTriangles {
            triangles: self.triangles.into_iter().map(wind).collect(),
            normals: normals.iter().map(|n| n.to_array()).collect(),
            uvs: self.uvs,
            positions: positions.iter().map(|p| p.to_array()).collect(),
        }
    }
}

/// The corners of faces of `N`: of one face, in their order, where the file does not say them.
fn indices<const N: usize>(parameters: Parameters<'_>, vertices: usize) -> Result<Vec<[u32; N]>, String> {
    match parameters.numbers("indices")? {
        Some(stated) => {
            let legal = stated.iter().map(|i| index(*i, vertices)).collect::<Result<Vec<u32>, _>>()?;
            whole::<N, u32>("indices", &legal).map(<[_]>::to_vec)
        }
        None if vertices == N => Ok(vec![std::array::from_fn(|i| i as u32)]),
        None => Err("no \"indices\"".to_owned()),
    }
}

fn index(value: f64, vertices: usize) -> Result<u32, String> {
    match value.fract() == 0.0 && value >= 0.0 && value < vertices as f64 {
        true => Ok(value as u32),
        false => Err(format!("index {value} is out of range: there are {vertices} points")),
    }
}

fn whole<'a, const N: usize, T>(name: &str, values: &'a [T]) -> Result<&'a [[T; N]], String> {
    match values.as_chunks::<N>() {
        (chunks, []) => Ok(chunks),
        _ => Err(format!("\"{name}\": {} numbers, which is no multiple of {N}", values.len())),
    }
}
