//! Assembly of a mesh from elements.

use std::collections::BTreeMap;

use etendue_scene::asset::{MeshAsset, SlotMaterial};

use super::faces::{PlyFace, has_uvs, is_used, polygons, strips, too_few_corners};
use super::header::{PlyElement, PlyHeader, shortened};
use super::input::PlyInput;
use crate::Problem;
use crate::mesh::polygon::{newell, triangulate};
use crate::mesh::vertex::{check_corners, check_range, middle_of_far, relative, unit};

const COLOURS: [&str; 8] =
    ["red", "green", "blue", "alpha", "diffuse_red", "diffuse_green", "diffuse_blue", "diffuse_alpha"];

/// The mesh of all elements.
pub(super) fn mesh(header: &PlyHeader, input: &mut PlyInput<'_>) -> Result<MeshAsset, Problem> {
    let mut builder = PlyMeshBuilder::default();
    for element in &header.elements {
        match &*element.name {
            "vertex" => builder.vertices(element, input)?,
            "face" => builder.faces(element, input)?,
            "tristrips" => builder.strips(element, input)?,
            _ => {
                input.skip_element(element)?;
                builder.unused_elements.push((element.name.clone(), element.count));
            }
        }
    }
    builder.check_vertices(input)?;
    builder.check_faces(input)?;
    builder.finish(header)
}

/// Mesh under construction.
#[derive(Default)]
struct PlyMeshBuilder {
    vertices: Option<Vertices>,
    mesh: MeshAsset,
    /// Index in the file of each vertex of the mesh, if corners have their own vertices.
    sources: Vec<u32>,
    corners: u64,
    has_strips: bool,
    /// Faces with fewer than three corners.
    degenerate: Vec<DegenerateFace>,
    /// Content after the last element.
    rest: Option<String>,
    unused: Vec<String>,
    unused_elements: Vec<(String, usize)>,
}

/// First of the faces with fewer than three corners, or one of them.
struct DegenerateFace {
    number: usize,
    corners: usize,
    line: Option<usize>,
}

impl PlyMeshBuilder {
    /// Refuses vertices of triangles whose coordinates are not finite; others take the place of a used vertex.
    fn check_vertices(&mut self, input: &mut PlyInput<'_>) -> Result<(), Problem> {
        let Some(vertices) = self.vertices.as_mut().filter(|vertices| !vertices.invalid.is_empty()) else {
            return Ok(());
        };
        let sources = &self.sources;
        let source = |corner: u32| sources.get(corner as usize).copied().unwrap_or(corner);
        let mut used = self.mesh.triangles.iter().flatten().map(|corner| source(*corner));
        let place = used.clone().next().and_then(|first| vertices.positions.get(first as usize).copied());
        let first_used = used.clone().filter(|vertex| vertices.invalid.contains_key(vertex)).min();
        let is_empty = used.next().is_none();
        let refused = first_used.or_else(|| vertices.invalid.keys().next().copied().filter(|_| is_empty));
        if let Some((vertex, invalid)) = refused.and_then(|vertex| Some((vertex, vertices.invalid.get(&vertex)?))) {
            invalid.line.into_iter().for_each(|line| input.set_line(line));
            return Err(invalid.problem.clone().within(format_args!("vertex {vertex}")));
        }
        for vertex in vertices.invalid.keys() {
            vertices.positions[*vertex as usize] = place.unwrap_or_default();
        }
        Ok(())
    }

    /// Refuses a mesh whose faces all have fewer than three corners, and one without faces and with further content.
    fn check_faces(&mut self, input: &mut PlyInput<'_>) -> Result<(), Problem> {
        let rest = input.rest();
        if self.mesh.triangles.is_empty() {
            if let Some(DegenerateFace { number, corners, line }) = self.degenerate.first() {
                line.iter().for_each(|line| input.set_line(*line));
                return Err(too_few_corners(*corners).within(format_args!("face {number}")));
            }
            if let Some(rest) = &rest {
                return Err(format!("{rest}{}", input.byte_order_hint()).into());
            }
        }
        self.rest = rest;
        Ok(())
    }

    fn vertices(&mut self, element: &PlyElement, input: &mut PlyInput<'_>) -> Result<(), Problem> {
        let (vertices, unused) = Vertices::read(element, input)?;
        self.vertices = Some(vertices);
        self.unused.extend(unused);
        Ok(())
    }

    fn known_vertices(&self) -> Result<&Vertices, Problem> {
        self.vertices.as_ref().ok_or_else(|| "the faces precede the vertices; export the mesh again".into())
    }

    fn faces(&mut self, element: &PlyElement, input: &mut PlyInput<'_>) -> Result<(), Problem> {
        let count = self.known_vertices()?.positions.len();
        // Counted first, so that no list grows.
        let (mut triangles, mut corners) = (0, 0);
        peek(input, |ahead| {
            polygons(element, ahead, count, |face, _| {
                if face.corners.len() >= 3 {
                    (triangles, corners) = (triangles + face.corners.len() - 2, corners + face.corners.len());
                }
                Ok(())
            })
        })?;
        self.count(corners)?;
        self.mesh.triangles.reserve_exact(triangles);
        let own_uvs = has_uvs(element);
        if own_uvs {
            self.sources.reserve_exact(corners);
            self.mesh.uvs.reserve_exact(corners);
        }
        let mut number = 0;
        polygons(element, input, count, |face, input| {
            number += 1;
            if face.corners.len() < 3 {
                let degenerate = DegenerateFace { number: number - 1, corners: face.corners.len(), line: input.line() };
                self.degenerate.push(degenerate);
                return Ok(());
            }
            self.face(face, own_uvs)
        })?;
        self.unused.extend(element.properties.iter().filter(|p| !is_used(p)).map(|p| p.name.clone()));
        Ok(())
    }

    fn count(&mut self, corners: usize) -> Result<(), Problem> {
        self.corners += corners as u64;
        check_corners(self.corners)
    }

    fn face(&mut self, face: &PlyFace, own_uvs: bool) -> Result<(), Problem> {
        let first = self.sources.len() as u32; // no more than corners, which are counted
        if own_uvs {
            self.sources.extend(&face.corners);
            self.mesh.uvs.extend(&face.uvs);
            self.mesh.uvs.resize(self.sources.len(), [0.0; 2]);
        }
        let vertex = |corner: usize| if own_uvs { first + corner as u32 } else { face.corners[corner] };
        if face.corners.len() == 3 {
            self.mesh.triangles.push([0, 1, 2].map(vertex));
            return Ok(());
        }
        let Vertices { positions, invalid, .. } = self.vertices.as_ref().ok_or("no vertices")?;
        if let Some(corner) = face.corners.iter().position(|corner| invalid.contains_key(corner)) {
            self.mesh.triangles.push([vertex(corner); 3]); // is refused with the vertex
            return Ok(());
        }
        let polygon: Vec<[f64; 3]> = face.corners.iter().map(|i| positions[*i as usize]).collect();
        let triangles = triangulate(&polygon).map_err(|error| error.message(polygon.len()))?;
        self.mesh.triangles.extend(triangles.iter().map(|t| t.map(vertex)));
        Ok(())
    }

    fn strips(&mut self, element: &PlyElement, input: &mut PlyInput<'_>) -> Result<(), Problem> {
        let count = self.known_vertices()?.positions.len();
        let mut triangles = 0;
        peek(input, |ahead| {
            strips(element, ahead, count, |_| {
                triangles += 1;
                Ok(())
            })
        })?;
        self.count(3 * triangles)?;
        self.has_strips |= triangles > 0;
        self.mesh.triangles.reserve_exact(triangles);
        strips(element, input, count, |triangle| {
            self.mesh.triangles.push(triangle);
            Ok(())
        })
    }

    fn finish(self, header: &PlyHeader) -> Result<MeshAsset, Problem> {
        let Self { vertices, mut mesh, sources, unused, unused_elements, has_strips, degenerate, rest, .. } = self;
        if mesh.triangles.is_empty() {
            return Err("has no faces (a point cloud?); export it as a mesh".into());
        }
        let has_own = !sources.is_empty();
        if has_own && has_strips {
            return Err(
                "has faces with their own texture coordinates together with strips, which have none; export the mesh again".into()
            );
        }
        let vertices = vertices.ok_or("no vertices")?;
        mesh.origin = middle_of_far(|axis| vertices.positions.iter().map(move |p| p[axis]));
        let origin = mesh.origin;
        let place = |p: &[f64; 3]| relative(*p, origin);
        if has_own {
            mesh.positions = sources.iter().map(|i| place(&vertices.positions[*i as usize])).collect();
            mesh.normals = match vertices.normals.is_empty() {
                true => Vec::new(),
                false => sources.iter().map(|i| vertices.normals[*i as usize]).collect(),
            };
        } else {
            mesh.positions = vertices.positions.iter().map(place).collect();
            (mesh.normals, mesh.uvs) = (vertices.normals, vertices.uvs);
        }
        mesh.report.extend(vertices.notes);
        if !degenerate.is_empty() {
            mesh.report.push(format!("{} faces with fewer than 3 corners are not used", degenerate.len()));
        }
        mesh.report.extend(rest);
        fill_normals(&mut mesh);
        mesh.slots = vec![0; mesh.triangles.len()];
        mesh.slot_materials = vec![SlotMaterial { name: String::new(), surface: None }];
        mesh.report.extend(notes(header, &unused, &unused_elements));
        Ok(mesh)
    }
}

/// Reads without moving the input, except to an error, whose line it then states.
fn peek<'a>(
    input: &mut PlyInput<'a>,
    read: impl FnOnce(&mut PlyInput<'a>) -> Result<(), Problem>,
) -> Result<(), Problem> {
    let mut ahead = input.clone();
    read(&mut ahead).inspect_err(|_| *input = ahead)
}

/// Vertices without a usable normal take that of the first triangle that uses them.
fn fill_normals(mesh: &mut MeshAsset) {
    let MeshAsset { normals, triangles, positions, report, .. } = mesh;
    if normals.is_empty() {
        return;
    }
    let mut mended = 0;
    for triangle in triangles.iter() {
        for vertex in triangle.map(|i| i as usize) {
            if normals[vertex] == [0.0; 3] {
                normals[vertex] = unit(newell(&triangle.map(|i| positions[i as usize].map(f64::from))));
                mended += 1;
            }
        }
    }
    normals.iter_mut().filter(|n| **n == [0.0; 3]).for_each(|n| *n = [0.0, 0.0, 1.0]); // vertex of no triangle
    if mended > 0 {
        report.push(format!("vertices without a usable normal, which use that of a face: {mended}"));
    }
}

fn notes(header: &PlyHeader, unused: &[String], elements: &[(String, usize)]) -> Vec<String> {
    let mut notes = Vec::new();
    let (colours, others): (Vec<&String>, Vec<&String>) = unused.iter().partition(|name| COLOURS.contains(&&***name));
    if !colours.is_empty() {
        notes.push("vertex and face colours are not used: give the object a material".to_owned());
    }
    if !others.is_empty() {
        let names: Vec<String> = others.iter().map(|name| shortened(name)).collect();
        notes.push(format!("properties that are not used: {}", names.join(", ")));
    }
    if let Some(image) = &header.texture_file {
        notes.push(format!(
            "the image `{}` is not used: give it as a texture of the object's material",
            shortened(image)
        ));
    }
    let unknown = header.unknown.iter();
    notes.extend(
        unknown.map(|(line, word)| format!("line {line} of the header is no statement: it begins with `{word}`")),
    );
    notes.extend(
        elements.iter().map(|(name, count)| format!("elements `{}`, which are not used: {count}", shortened(name))),
    );
    notes
}

/// Names of texture coordinates, as used by writers.
const UV_NAMES: [[&str; 2]; 4] = [["u", "v"], ["s", "t"], ["texture_u", "texture_v"], ["texture_s", "texture_t"]];

/// Vertices of a file.
#[derive(Debug, Default)]
pub(super) struct Vertices {
    pub(super) positions: Vec<[f64; 3]>,
    /// One per vertex, or none.
    pub(super) normals: Vec<[f32; 3]>,
    /// One per vertex, or none.
    pub(super) uvs: Vec<[f32; 2]>,
    /// Vertices that no face may use.
    invalid: BTreeMap<u32, InvalidVertex>,
    notes: Vec<String>,
}

/// Vertex whose position is not finite or too large.
#[derive(Debug)]
struct InvalidVertex {
    line: Option<usize>,
    problem: Problem,
}

/// Use of a property: none, or a coordinate.
#[derive(Clone, Copy)]
enum PropertyUse {
    Nothing,
    Position(usize),
    Normal(usize),
    Uv(usize),
}

/// Uses of the properties of an element.
struct PropertyUses {
    each: Vec<PropertyUse>,
    has_normals: bool,
    has_uvs: bool,
}

impl PropertyUses {
    fn new(element: &PlyElement) -> Result<Self, Problem> {
        let has = |name: &str| element.properties.iter().any(|p| p.name == name && p.count.is_none());
        if let Some(missing) = ["x", "y", "z"].into_iter().find(|name| !has(name)) {
            return Err(format!("the element `vertex` has no property `{missing}`; export the mesh again").into());
        }
        let has_normals = ["nx", "ny", "nz"].into_iter().all(has);
        let uv = UV_NAMES.into_iter().find(|pair| pair.iter().all(|name| has(name)));
        let place = |names: &[&str], name: &str| names.iter().position(|n| *n == name);
        let use_of = |name: &str| {
            place(&["x", "y", "z"], name)
                .map(PropertyUse::Position)
                .or_else(|| place(&["nx", "ny", "nz"], name).filter(|_| has_normals).map(PropertyUse::Normal))
                .or_else(|| uv.and_then(|pair| place(&pair, name)).map(PropertyUse::Uv))
                .unwrap_or(PropertyUse::Nothing)
        };
        let each = element.properties.iter().map(|p| use_of(&p.name)).collect();
        Ok(Self { each, has_normals, has_uvs: uv.is_some() })
    }
}

impl Vertices {
    /// Reads the element; also returns the names of unused properties.
    pub(super) fn read(element: &PlyElement, input: &mut PlyInput<'_>) -> Result<(Self, Vec<String>), Problem> {
        input.check_rows(element)?;
        if element.count > u32::MAX as usize {
            return Err(format!("the mesh has {} vertices; at most {} are supported", element.count, u32::MAX).into());
        }
        let uses = PropertyUses::new(element)?;
        let capacity = |has: bool| if has { element.count } else { 0 };
        let mut vertices = Self {
            positions: Vec::with_capacity(element.count),
            normals: Vec::with_capacity(capacity(uses.has_normals)),
            uvs: Vec::with_capacity(capacity(uses.has_uvs)),
            invalid: BTreeMap::new(),
            notes: Vec::new(),
        };
        let mut bare = 0;
        for number in 0..element.count {
            let is_bare = vertices.row(element, &uses, input).map_err(|what| format!("vertex {number}: {what}"))?;
            bare += usize::from(is_bare);
        }
        if bare > 0 {
            let note = format!("{bare} vertices whose texture coordinates are not finite use u = v = 0");
            vertices.notes.push(note);
        }
        if !vertices.invalid.is_empty() {
            let note = format!("{} vertices that are not finite belong to no face", vertices.invalid.len());
            vertices.notes.push(note);
        }
        let unused = element.properties.iter().zip(&uses.each).filter(|(_, used)| matches!(used, PropertyUse::Nothing));
        Ok((vertices, unused.map(|(p, _)| p.name.clone()).collect()))
    }

    /// Reads a vertex; returns true if its texture coordinates are not finite.
    fn row(&mut self, element: &PlyElement, uses: &PropertyUses, input: &mut PlyInput<'_>) -> Result<bool, Problem> {
        let (mut position, mut normal, mut uv) = ([0.0; 3], [0.0_f64; 3], [0.0_f64; 2]);
        for (property, used) in element.properties.iter().zip(&uses.each) {
            match used {
                PropertyUse::Nothing => input.skip(property)?,
                PropertyUse::Position(axis) => position[*axis] = input.number_of_any_size(property.number)?,
                PropertyUse::Normal(axis) => normal[*axis] = input.number_of_any_size(property.number)?,
                PropertyUse::Uv(axis) => uv[*axis] = input.number_of_any_size(property.number)?,
            }
        }
        let problem = match position.iter().all(|v| v.is_finite()) {
            true => check_range(&position).err().map(Problem::from),
            false => Some(input.not_finite()),
        };
        if let Some(problem) = problem {
            let place = self.positions.len() as u32; // fewer than 2³², which are counted
            self.invalid.insert(place, InvalidVertex { line: input.line(), problem });
            position = [0.0; 3];
        }
        self.positions.push(position);
        if uses.has_normals {
            let is_usable = normal != [0.0; 3] && normal.iter().all(|v| v.is_finite());
            self.normals.push(if is_usable { unit(normal) } else { [0.0; 3] });
        }
        let is_bare = uses.has_uvs && !uv.iter().all(|v| v.is_finite());
        if uses.has_uvs {
            uv = if is_bare { [0.0; 2] } else { uv };
            check_range(&uv)?;
            self.uvs.push(uv.map(|v| v as f32));
        }
        Ok(is_bare)
    }
}
