//! Bilinear patches: two triangles for a flat one, a grid of squares for a curved one.

use glam::DVec3;

use super::mesh_parameters::indices;
use super::parameters::Parameters;
use crate::scenery::Triangles;

/// Squares along each side of a curved patch.
pub(super) const DIVISIONS: u32 = 16;

/// Mesh of bilinear patches.
pub(super) struct PatchMesh {
    pub(super) mesh: Triangles,
    pub(super) patches: usize,
    /// True if a patch is not flat.
    pub(super) is_curved: bool,
}

impl PatchMesh {
    /// Corners of a patch are in rows: (0, 0), (1, 0), (0, 1), (1, 1).
    pub(super) fn from_parameters(parameters: Parameters<'_>) -> Result<Self, String> {
        let corners = Triangles::points(parameters)?;
        let patches = indices::<4>(parameters, corners.positions.len())?;
        let is_curved = patches.iter().any(|patch| is_curved(&corners, patch));
        let mesh = match is_curved {
            true => curved(&corners, &patches),
            false if corners.uvs.is_empty() => with_own_vertices(&corners, &patches),
            false => Triangles { triangles: patches.iter().copied().flat_map(halves).collect(), ..corners },
        };
        Ok(Self { mesh, patches: patches.len(), is_curved })
    }
}

/// Texture coordinates of the corners of a patch: pbrt's default if a file has none.
const CORNERS: [[f64; 2]; 4] = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]];

/// Two triangles of a patch.
fn halves([a, b, c, d]: [u32; 4]) -> [[u32; 3]; 2] {
    [[a, b, d], [a, d, c]]
}

/// Returns true if the corners of a patch do not lie in a plane.
fn is_curved(corners: &Triangles, patch: &[u32; 4]) -> bool {
    let [a, b, c, d] = patch.map(|i| DVec3::from_array(corners.positions[i as usize]));
    let [u, v, w] = [b - a, c - a, d - a];
    u.cross(v).dot(w).abs() > 1e-6 * u.length() * v.length() * w.length()
}

/// Flat patches with separate vertices.
fn with_own_vertices(corners: &Triangles, patches: &[[u32; 4]]) -> Triangles {
    let places = patches.iter().flatten().map(|i| *i as usize);
    Triangles {
        normals: places.clone().filter_map(|i| corners.normals.get(i)).copied().collect(),
        positions: places.map(|i| corners.positions[i]).collect(),
        uvs: CORNERS.repeat(patches.len()),
        triangles: (0..patches.len() as u32).map(|i| [0, 1, 2, 3].map(|k| 4 * i + k)).flat_map(halves).collect(),
    }
}

/// Patches as grids, with the normals of the file or of the patch.
fn curved(corners: &Triangles, patches: &[[u32; 4]]) -> Triangles {
    let mut mesh = Triangles::default();
    for patch in patches {
        let first = mesh.positions.len() as u32;
        let points = patch.map(|i| DVec3::from_array(corners.positions[i as usize]));
        let normals = corners.normals.first().map(|_| patch.map(|i| DVec3::from_array(corners.normals[i as usize])));
        let uvs = corners.uvs.first().map_or(CORNERS, |_| patch.map(|i| corners.uvs[i as usize]));
        let uvs = uvs.map(|[u, v]| DVec3::new(u, v, 0.0));
        for i in 0..(DIVISIONS + 1) * (DIVISIONS + 1) {
            let [u, v] = [i % (DIVISIONS + 1), i / (DIVISIONS + 1)].map(|k| f64::from(k) / f64::from(DIVISIONS));
            let normal = match &normals {
                Some(normals) => between(normals, u, v),
                None => {
                    let along_u = (1.0 - v) * (points[1] - points[0]) + v * (points[3] - points[2]);
                    let along_v = (1.0 - u) * (points[2] - points[0]) + u * (points[3] - points[1]);
                    along_u.cross(along_v)
                }
            };
            mesh.positions.push(between(&points, u, v).to_array());
            mesh.normals.push(normal.normalize_or(DVec3::Z).to_array());
            let uv = between(&uvs, u, v);
            mesh.uvs.push([uv.x, uv.y]);
        }
        let at = |column: u32, row: u32| first + row * (DIVISIONS + 1) + column;
        let squares = (0..DIVISIONS * DIVISIONS).map(|i| (i % DIVISIONS, i / DIVISIONS));
        let square = |(x, y)| halves([at(x, y), at(x + 1, y), at(x, y + 1), at(x + 1, y + 1)]);
        mesh.triangles.extend(squares.flat_map(square));
    }
    mesh
}

fn between(corners: &[DVec3; 4], u: f64, v: f64) -> DVec3 {
    (1.0 - v) * ((1.0 - u) * corners[0] + u * corners[1]) + v * ((1.0 - u) * corners[2] + u * corners[3])
}
