//! Polygons with separate indices to triangles with one index a vertex.

use std::collections::HashMap;
use std::path::Path;

use etendue_scene::asset::MeshAsset;

use super::mtl::UvLayout;
use super::obj::{Corner, Face, Obj, parse};
use super::polygon::{newell, triangulate};
use super::slot::{Slots, slots};
use crate::source::{decode_text, read_bytes};
use crate::{Error, hash};

/// Reads a Wavefront OBJ file with the material libraries it names.
pub fn read_mesh(file: &Path) -> Result<MeshAsset, Error> {
    let bytes = read_bytes(file, "mesh")?;
    let obj = parse(file, decode_text(file, &bytes)?)?;
    let slots = slots(file, &obj)?;
    let mut builder = Builder::new(&obj, &slots.layouts);
    for face in &obj.faces {
        builder.face(face).map_err(|told| Error::at(file, face.line, told))?;
    }
    let mut mesh = builder.finish();
    mesh.hash = hash::of_parts(std::iter::once(&bytes).chain(&slots.library_bytes).map(Vec::as_slice));
    if !bytes.ends_with(b"\n") {
        mesh.report.push("the last line has no end: the file may be truncated".to_owned());
    }
    mesh.report.extend(notes(&obj));
    let Slots { materials, report, .. } = slots;
    mesh.slot_materials = materials;
    mesh.report.extend(report);
    Ok(mesh)
}

/// What makes a vertex of its own: its indices, the face where the normal is the face's, the texture's layout.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
struct Key {
    position: usize,
    uv: Option<usize>,
    normal: NormalKey,
    layout: Option<u16>,
}

#[derive(Clone, Copy, PartialEq, Eq, Hash)]
enum NormalKey {
    None,
    Given(usize),
    OfFace(usize),
}

struct Builder<'a> {
    obj: &'a Obj,
    layouts: &'a [UvLayout],
    has_normals: bool,
    has_uvs: bool,
    known: HashMap<Key, u32>,
    mesh: MeshAsset,
    flat_corners: usize,
    bare_corners: usize,
}

impl<'a> Builder<'a> {
    fn new(obj: &'a Obj, layouts: &'a [UvLayout]) -> Self {
        Self {
            obj,
            layouts,
            has_normals: obj.corners.iter().any(|c| usable_normal(obj, c).is_some()),
            has_uvs: obj.corners.iter().any(|c| c.uv.is_some()),
            known: HashMap::new(),
            mesh: MeshAsset::default(),
            flat_corners: 0,
            bare_corners: 0,
        }
    }

    fn face(&mut self, face: &Face) -> Result<(), String> {
        let corners = self.obj.corners_of(face);
        let positions: Vec<[f64; 3]> = corners.iter().map(|c| self.obj.positions[c.position]).collect();
        let triangles = triangulate(&positions).map_err(|_| {
            format!("polygon of {} corners crosses itself; triangulate the mesh where it was modelled", corners.len())
        })?;
        let vertices =
            corners.iter().map(|c| self.vertex(face, c, &positions)).collect::<Result<Vec<u32>, String>>()?;
        for triangle in triangles {
            self.mesh.triangles.push(triangle.map(|i| vertices[i]));
            self.mesh.slots.push(face.material);
        }
        Ok(())
    }

    fn vertex(&mut self, face: &Face, corner: &Corner, polygon: &[[f64; 3]]) -> Result<u32, String> {
        let key = self.key(face, corner);
        if let Some(index) = self.known.get(&key) {
            return Ok(*index);
        }
        let index = u32::try_from(self.mesh.positions.len()).map_err(|_| "more than 2³² vertices; split the mesh")?;
        self.known.insert(key, index);
        self.mesh.positions.push(self.obj.positions[corner.position].map(|v| v as f32));
        if self.has_normals {
            self.push_normal(key.normal, polygon);
        }
        if self.has_uvs {
            let layout = &self.layouts[usize::from(face.material)];
            let uv = corner.uv.map_or([0.0; 2], |i| layout.apply(self.obj.uvs[i]));
            self.mesh.uvs.push(uv.map(|v| v as f32));
            self.bare_corners += usize::from(corner.uv.is_none());
        }
        Ok(index)
    }

    fn key(&self, face: &Face, corner: &Corner) -> Key {
        let normal = match usable_normal(self.obj, corner) {
            _ if !self.has_normals => NormalKey::None,
            Some(index) => NormalKey::Given(index),
            None => NormalKey::OfFace(face.first_corner),
        };
        let plain = self.layouts[usize::from(face.material)] == UvLayout::PLAIN;
        Key { position: corner.position, uv: corner.uv, normal, layout: (!plain).then_some(face.material) }
    }

    fn push_normal(&mut self, key: NormalKey, polygon: &[[f64; 3]]) {
        let normal = match key {
            NormalKey::Given(index) => self.obj.normals[index],
            NormalKey::OfFace(_) | NormalKey::None => {
                self.flat_corners += 1;
                newell(polygon)
            }
        };
        self.mesh.normals.push(unit(normal));
    }

    fn finish(self) -> MeshAsset {
        let mut mesh = self.mesh;
        if self.flat_corners > 0 {
            mesh.report.push(format!("{} vertices without a usable normal take that of their face", self.flat_corners));
        }
        if self.bare_corners > 0 {
            mesh.report.push(format!("{} vertices without texture coordinates stand at u = v = 0", self.bare_corners));
        }
        mesh
    }
}

/// The corner's normal where it is there and not zero.
fn usable_normal(obj: &Obj, corner: &Corner) -> Option<usize> {
    corner.normal.filter(|&i| obj.normals[i] != [0.0; 3])
}

/// A unit vector in 32 bits; z for a face without area, which no ray meets.
fn unit(v: [f64; 3]) -> [f32; 3] {
    let largest = v.iter().fold(0.0_f64, |m, c| m.max(c.abs()));
    if largest == 0.0 {
        return [0.0, 0.0, 1.0];
    }
    let scaled = v.map(|c| c / largest);
    let length = scaled.iter().map(|c| c * c).sum::<f64>().sqrt();
    scaled.map(|c| (c / length) as f32)
}

fn notes(obj: &Obj) -> Vec<String> {
    let mut notes: Vec<String> = obj
        .unread
        .iter()
        .map(|(keyword, (count, line))| format!("`{keyword}` is not used ({count} times, first on line {line})"))
        .collect();
    if let (Some(line), true) = (obj.smoothing_line, obj.normals.is_empty()) {
        notes.push(format!("line {line}: smoothing groups are not used: export normals, or the mesh stays faceted"));
    }
    notes.extend(far_from_origin(&obj.positions));
    notes
}

/// Says what 32 bits cost where the rounding of a coordinate exceeds a millionth of the mesh's extent.
fn far_from_origin(positions: &[[f64; 3]]) -> Option<String> {
    let bound = |axis: usize, pick: fn(f64, f64) -> f64| positions.iter().map(|p| p[axis]).reduce(pick);
    let extent = (0..3).filter_map(|a| Some(bound(a, f64::max)? - bound(a, f64::min)?)).fold(0.0, f64::max);
    let largest = positions.iter().flatten().fold(0.0_f64, |m, v| m.max(v.abs()));
    let rounding = largest * f64::from(f32::EPSILON) * 0.5;
    (rounding > 1e-6 * extent).then(|| {
        format!("coordinates of up to {largest} are rounded by up to {rounding:.1e} units, the mesh measures {extent}: move it to its origin")
    })
}
