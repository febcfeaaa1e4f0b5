//! Meshes of PLY files, text and binary of either byte order, and triangles written as PLY or OBJ.
//!
//! Source: G. Turk, "The PLY Polygon File Format", 1994, with property names used by later writers. Read: positions and normals of `vertex`, texture
//! coordinates of its vertices (`u v`, `s t`, `texture_u texture_v`, `texture_s texture_t`) or of the corners of its faces (`texcoord`), polygons of `face`,
//! and `tristrips`. All other elements and properties are ignored and noted in the report. A file names no material: it has one slot, without a name.
//!
//! Refused: vertices of faces that are not finite, indices out of range, polygons that cross themselves, and elements that the bytes of the file cannot hold,
//! before memory is taken for them. Vertices of no face that are not finite, faces of fewer than three corners and bytes after the last element are noted.

mod assemble;
mod faces;
mod header;
mod input;

use std::{fmt::Write as _, path::Path};

use etendue_scene::asset::MeshAsset;

use crate::source::{name_notes, read_bytes};
use crate::{Error, Problem, hash};
use header::PlyHeader;
use input::PlyInput;

/// Returns true if the file name has the extension of PLY.
pub(crate) fn is_ply(file: &Path) -> bool {
    file.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("ply"))
}

/// Reads a PLY file.
pub(super) fn read_ply(file: &Path) -> Result<MeshAsset, Error> {
    let bytes = read_bytes(file, "mesh")?;
    let located = |line: Option<usize>, problem: Problem| match line {
        Some(line) => Error::at(file, line, problem),
        None => Error::new(file, problem),
    };
    let header = PlyHeader::read(&bytes).map_err(|(line, what)| Error::at(file, line, what))?;
    let mut input = PlyInput::new(&header, &bytes);
    let mut mesh = assemble::mesh(&header, &mut input).map_err(|what| located(input.line(), what))?;
    mesh.hash = hash::hash_bytes(&bytes);
    name_notes(file, &mut mesh.report);
    Ok(mesh)
}

/// Triangles in world coordinates.
#[derive(Clone, Debug, Default)]
pub struct PlacedTriangles {
    /// Vertices.
    pub positions: Vec<[f64; 3]>,
    /// Normals of any length; one per vertex, or none.
    pub normals: Vec<[f64; 3]>,
    /// Texture coordinates, v upwards; one per vertex, or none.
    pub uvs: Vec<[f64; 2]>,
    /// Indices of vertices, counter-clockwise as seen from the front.
    pub triangles: Vec<[u32; 3]>,
}

/// Encodes a binary little-endian PLY file: coordinates in 64 bits, normals and texture coordinates in 32.
#[must_use]
pub fn encode_ply(mesh: &PlacedTriangles) -> Vec<u8> {
    let has_normals = mesh.normals.len() == mesh.positions.len();
    let has_uvs = mesh.uvs.len() == mesh.positions.len();
    let mut head = format!("ply\nformat binary_little_endian 1.0\nelement vertex {}\n", mesh.positions.len());
    let mut add = |kind: &str, names: &[&str]| {
        names.iter().for_each(|name| writeln!(head, "property {kind} {name}").expect("writing to a String succeeds"));
    };
    add("double", &["x", "y", "z"]);
    add("float", if has_normals { &["nx", "ny", "nz"] } else { &[] });
    add("float", if has_uvs { &["u", "v"] } else { &[] });
    write!(head, "element face {}\nproperty list uchar uint vertex_indices\nend_header\n", mesh.triangles.len())
        .expect("writing to a String succeeds");
    let mut bytes = head.into_bytes();
    for (vertex, position) in mesh.positions.iter().enumerate() {
        bytes.extend(position.iter().flat_map(|v| v.to_le_bytes()));
        if has_normals {
            bytes.extend(mesh.normals[vertex].iter().flat_map(|v| (*v as f32).to_le_bytes()));
        }
        if has_uvs {
            bytes.extend(mesh.uvs[vertex].iter().flat_map(|v| (*v as f32).to_le_bytes()));
        }
    }
    for triangle in &mesh.triangles {
        bytes.push(3);
        bytes.extend(triangle.iter().flat_map(|i| i.to_le_bytes()));
    }
    bytes
}

/// Encodes a Wavefront OBJ file of positions and triangles alone.
#[must_use]
pub fn encode_obj(mesh: &PlacedTriangles) -> Vec<u8> {
    let mut text = String::new();
    for [x, y, z] in &mesh.positions {
        writeln!(text, "v {x} {y} {z}").expect("writing to a String succeeds");
    }
    for triangle in &mesh.triangles {
        let [a, b, c] = triangle.map(|i| u64::from(i) + 1);
        writeln!(text, "f {a} {b} {c}").expect("writing to a String succeeds");
    }
    text.into_bytes()
}
