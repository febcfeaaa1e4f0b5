//! A file of a mesh whose vertices move, corner by corner.

use std::path::Path;

use etendue_scene::asset::{MeshFrameAsset, MeshFramePart};

use super::obj::scan;
use super::polygon::triangulate;
use super::vertex::unit;
use crate::source::{decode_text, read_bytes};
use crate::{Error, hash};

/// Reads the faces of a Wavefront OBJ file as it says them. The triangles of the file itself are those that [`super::read_mesh`] makes
/// of it; another file's polygons, bent otherwise, are to be cut as these.
pub fn read_mesh_frame(file: &Path) -> Result<MeshFrameAsset, Error> {
    let bytes = read_bytes(file, "mesh")?;
    let obj = scan(file, decode_text(file, &bytes)?)?;
    let parts: Vec<MeshFramePart> =
        obj.parts_by_corners(file)?.into_iter().map(|part| part_of(part, &obj.materials)).collect();
    let triangles = triangles(&parts);
    Ok(MeshFrameAsset { parts, vertices: obj.counts[0], triangles, hash: hash::of_bytes(&bytes) })
}

fn part_of(part: tobj::Mesh, materials: &[String]) -> MeshFramePart {
    let corners = part.indices.len();
    // tobj tells the numbers of corners unless all are triangles.
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

/// The triangles of all faces. A polygon that crosses itself gives none: [`super::read_mesh`] refuses it in the file whose triangles are
/// those of all, and in other files it does not matter.
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
