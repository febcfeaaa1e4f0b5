//! Conversion of tobj's polygons to triangles, and reading of a file of a mesh with moving vertices, corner by corner.

use std::{cell::LazyCell, path::Path};

use etendue_scene::asset::{MeshAsset, MeshFrameAsset, MeshFramePart, is_gltf};

use super::obj::{Obj, scan};
use super::ply::{is_ply, read_ply};
use super::polygon::{newell, triangulate};
use super::slot::{MaterialSlots, slots};
use super::stl::{is_stl, read_stl};
use super::vertex::{middle_of_far, relative, unit};
use super::{gltf::read_gltf, texture_option::UvLayout};
use crate::source::{name_notes, read_bytes};
use crate::{Error, Sandbox, hash};

/// Reads a mesh by its ending: a Wavefront OBJ file with the material libraries it names, a glTF file with its buffers and images, a PLY file,
/// or an STL file.
///
/// # Errors
/// The first fault, with its line.
pub fn read_mesh(file: &Path) -> Result<MeshAsset, Error> {
    read_mesh_in(file, &Sandbox::NONE)
}

/// Reads the same; further files must lie in `sandbox`.
pub(crate) fn read_mesh_in(file: &Path, sandbox: &Sandbox) -> Result<MeshAsset, Error> {
    if is_gltf(file) {
        return read_gltf(file, sandbox);
    }
    if is_ply(file) {
        return read_ply(file);
    }
    if is_stl(file) {
        return read_stl(file);
    }
    let bytes = read_bytes(file, "mesh")?;
    let obj = scan(file, &bytes)?;
    let MaterialSlots { materials, layouts, report, library_bytes, missing_libraries, images } =
        slots(file, &obj, sandbox)?;
    let parts = obj.parts(file)?;
    let coordinates =
        |axis| parts.iter().flat_map(move |p: &tobj::Mesh| p.positions.iter().skip(axis).step_by(3).copied());
    let mut builder = ObjMeshBuilder::new(&parts, middle_of_far(coordinates));
    for part in &parts {
        let slot = part.material_id.unwrap_or(0); // without a `usemtl`: the first slot, which has no name
        builder
            .part(part, slot as u16, &layouts[slot])
            .map_err(|problem| Error::at(file, obj.input.line_of_face(builder.faces), problem))?;
    }
    let mut mesh = builder.finish();
    mesh.hash = hash::hash_parts(std::iter::once(&bytes).chain(&library_bytes).map(Vec::as_slice));
    if !bytes.ends_with(b"\n") {
        mesh.report.push("the last line has no line end: the file may be truncated".to_owned());
    }
    mesh.report.extend(notes(&obj));
    name_notes(file, mesh.report.iter_mut().chain(&mut mesh.warnings));
    mesh.slot_materials = materials;
    mesh.embedded_images = images;
    mesh.missing_libraries = missing_libraries;
    mesh.report.extend(report);
    Ok(mesh)
}

/// Mesh under construction.
#[derive(Default)]
struct ObjMeshBuilder {
    has_normals: bool,
    has_uvs: bool,
    mesh: MeshAsset,
    faces: usize,
    /// Index in the mesh of each vertex of the current part.
    placed: Vec<Option<u32>>,
    flat_corners: usize,
    bare_corners: usize,
}

impl ObjMeshBuilder {
    fn new(parts: &[tobj::Mesh], origin: [f64; 3]) -> Self {
        Self {
            mesh: MeshAsset { origin, ..MeshAsset::default() },
            has_normals: parts.iter().any(|p| p.normals.iter().any(|v| *v != 0.0)),
            has_uvs: parts.iter().any(|p| !p.texcoords.is_empty()),
            ..Self::default()
        }
    }

    /// Adds a part of one material, whose vertices either all have a normal or none, and the same for texture coordinates.
    fn part(&mut self, part: &tobj::Mesh, slot: u16, layout: &UvLayout) -> Result<(), String> {
        self.placed = vec![None; part.positions.len() / 3];
        let mut rest = &part.indices[..];
        // tobj states the numbers of corners unless all are triangles.
        let arity = |face: usize| part.face_arities.get(face).map_or(3, |n| *n as usize);
        for corners in (0..).map(arity).map_while(|count| rest.split_off(..count)) {
            match corners {
                [a, b, c] => self.triangle(part, layout, [*a, *b, *c]),
                _ => self.polygon(part, layout, corners)?,
            }
            self.mesh.slots.resize(self.mesh.triangles.len(), slot);
            self.faces += 1;
        }
        Ok(())
    }

    fn triangle(&mut self, part: &tobj::Mesh, layout: &UvLayout, corners: [u32; 3]) {
        let positions: &[[f64; 3]] = part.positions.as_chunks().0;
        let facing = LazyCell::new(|| newell(&corners.map(|i| positions[i as usize])));
        let triangle = corners.map(|i| self.vertex(part, layout, i as usize, &facing));
        self.mesh.triangles.push(triangle);
    }

    fn polygon(&mut self, part: &tobj::Mesh, layout: &UvLayout, corners: &[u32]) -> Result<(), String> {
        let positions = part.positions.as_chunks().0;
        let polygon: Vec<[f64; 3]> = corners.iter().map(|&i| positions[i as usize]).collect();
        let triangles = triangulate(&polygon).map_err(|error| error.message(corners.len()))?;
        let facing = LazyCell::new(|| newell(&polygon));
        let vertices: Vec<u32> = corners.iter().map(|&i| self.vertex(part, layout, i as usize, &facing)).collect();
        self.mesh.triangles.extend(triangles.iter().map(|t| t.map(|i| vertices[i])));
        Ok(())
    }

    /// The vertex `index` of a part. Without a usable normal, if others have one, it belongs to this polygon alone, which faces `facing`.
    fn vertex<F: FnOnce() -> [f64; 3]>(
        &mut self,
        part: &tobj::Mesh,
        layout: &UvLayout,
        index: usize,
        facing: &LazyCell<[f64; 3], F>,
    ) -> u32 {
        let normal = part.normals.as_chunks().0.get(index).filter(|n| **n != [0.0; 3]);
        let is_shared = normal.is_some() || !self.has_normals;
        if let (true, Some(known)) = (is_shared, self.placed[index]) {
            return known;
        }
        let place = self.mesh.positions.len() as u32; // no more than corners, which are counted
        self.placed[index] = Some(place);
        let (place_in_file, origin): ([f64; 3], _) = (part.positions.as_chunks().0[index], self.mesh.origin);
        self.mesh.positions.push(relative(place_in_file, origin));
        if self.has_normals {
            self.flat_corners += usize::from(normal.is_none());
            self.mesh.normals.push(unit(normal.copied().unwrap_or_else(|| **facing)));
        }
        if self.has_uvs {
            let uv = part.texcoords.as_chunks().0.get(index);
            self.bare_corners += usize::from(uv.is_none());
            self.mesh.uvs.push(uv.map_or([0.0; 2], |uv| layout.apply(*uv)).map(|v| v as f32));
        }
        place
    }

    fn finish(self) -> MeshAsset {
        let mut mesh = self.mesh;
        let notes = [
            (self.flat_corners, "vertices without a usable normal, which use that of their face"),
            (self.bare_corners, "vertices without texture coordinates, which use u = v = 0"),
        ];
        mesh.report.extend(notes.iter().filter(|(n, _)| *n > 0).map(|(n, note)| format!("{note}: {n}")));
        mesh
    }
}

fn notes(obj: &Obj) -> Vec<String> {
    let mut notes: Vec<String> = obj
        .unread
        .iter()
        .map(|(keyword, (count, line))| format!("`{keyword}` is not used ({count} times, first on line {line})"))
        .collect();
    if let (Some(line), [_, _, 0]) = (obj.smoothing_line, obj.counts) {
        notes
            .push(format!("line {line}: smoothing groups are not used: export normals, otherwise the mesh is faceted"));
    }
    notes
}

/// Reads the faces of a Wavefront OBJ file unchanged. Its triangles are those of [`super::read_mesh`]. The polygons of another file of the mesh, in another
/// pose, must be cut like these.
pub fn read_mesh_frame(file: &Path) -> Result<MeshFrameAsset, Error> {
    let bytes = read_bytes(file, "mesh")?;
    let obj = scan(file, &bytes)?;
    let parts: Vec<MeshFramePart> =
        obj.parts_by_corners(file)?.into_iter().map(|part| frame_part(part, &obj.materials)).collect();
    let triangles = triangles(&parts);
    Ok(MeshFrameAsset { parts, vertices: obj.counts[0], triangles, hash: hash::hash_bytes(&bytes) })
}

fn frame_part(part: tobj::Mesh, materials: &[String]) -> MeshFramePart {
    let corners = part.indices.len();
    // tobj states the numbers of corners unless all are triangles.
    let arities = if part.face_arities.is_empty() { vec![3; corners / 3] } else { part.face_arities };
    MeshFramePart {
        material: materials.get(part.material_id.unwrap_or(0)).cloned().unwrap_or_default(),
        arities,
        vertices: part.indices,
        uvs: part.texcoord_indices,
        normal_indices: part.normal_indices,
        positions: part.positions.as_chunks().0.to_vec(),
        normals: part.normals.as_chunks().0.iter().map(normal).collect(),
    }
}

fn normal(normal: &[f64; 3]) -> [f32; 3] {
    if *normal == [0.0; 3] { [0.0; 3] } else { unit(*normal) }
}

/// Triangles of all faces. A polygon that crosses itself gives none: [`super::read_mesh`] refuses it in the file that defines the triangles; in other files it
/// does not matter.
fn triangles(parts: &[MeshFramePart]) -> Vec<[u32; 3]> {
    let (mut triangles, mut begin) = (Vec::new(), 0_u32);
    for part in parts {
        let mut rest = &part.vertices[..];
        for corners in part.arities.iter().map_while(|arity| rest.split_off(..*arity as usize)) {
            let polygon: Vec<[f64; 3]> = corners.iter().map(|v| part.positions[*v as usize]).collect();
            let cut = triangulate(&polygon).unwrap_or_default();
            triangles.extend(cut.iter().map(|triangle| triangle.map(|corner| begin + corner as u32)));
            begin += corners.len() as u32; // no more than 2³² corners, which are counted
        }
    }
    triangles
}
