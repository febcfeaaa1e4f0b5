//! Triangles as files: PLY, and OBJ for what reads nothing else.

use std::fmt::Write as _;

/// Triangles in the place where they shall stand.
#[derive(Clone, Debug, Default)]
pub struct PlacedTriangles {
    /// Vertices.
    pub positions: Vec<[f64; 3]>,
    /// Normals of any length; one a vertex, or none.
    pub normals: Vec<[f64; 3]>,
    /// Texture coordinates, v upwards; one a vertex, or none.
    pub uvs: Vec<[f64; 2]>,
    /// Indices of vertices, counter-clockwise as seen from the front.
    pub triangles: Vec<[u32; 3]>,
}

/// A binary little-endian PLY file: coordinates in 64 bits, normals and texture coordinates in 32.
#[must_use]
pub fn encode_ply(mesh: &PlacedTriangles) -> Vec<u8> {
    let has_normals = mesh.normals.len() == mesh.positions.len();
    let has_uvs = mesh.uvs.len() == mesh.positions.len();
    let mut head = format!("ply\nformat binary_little_endian 1.0\nelement vertex {}\n", mesh.positions.len());
    let mut add = |kind: &str, names: &[&str]| {
        names.iter().for_each(|name| writeln!(head, "property {kind} {name}").expect("a text grows"));
    };
    add("double", &["x", "y", "z"]);
    add("float", if has_normals { &["nx", "ny", "nz"] } else { &[] });
    add("float", if has_uvs { &["u", "v"] } else { &[] });
    write!(head, "element face {}\nproperty list uchar uint vertex_indices\nend_header\n", mesh.triangles.len())
        .expect("a text grows");
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

/// A Wavefront OBJ file of places and triangles alone.
#[must_use]
pub fn encode_obj(mesh: &PlacedTriangles) -> Vec<u8> {
    let mut text = String::new();
    for [x, y, z] in &mesh.positions {
        writeln!(text, "v {x} {y} {z}").expect("a text grows");
    }
    for triangle in &mesh.triangles {
        let [a, b, c] = triangle.map(|i| u64::from(i) + 1);
        writeln!(text, "f {a} {b} {c}").expect("a text grows");
    }
    text.into_bytes()
}
