//! Meshes: triangulated polygons, with their primvars.

use std::borrow::Cow;
use std::collections::{HashMap, HashSet};

use etendue_io::mesh::polygon_triangles;
use glam::{DAffine3, DVec3};

use super::access::{indices, text, tuple, tuples};
use crate::scenery::Triangles;
use crate::syntax::usd::{UsdPrim, UsdValue};

/// Maximum corners of a polygon.
const MAX_CORNERS: usize = 65_536;

/// Meaning of a mesh's polygons: UsdGeomMesh's `subdivisionScheme`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Scheme {
    /// The surface itself, with its own normals.
    None,
    /// Control mesh of a surface that passes through it, and is flat where the mesh is.
    Bilinear,
    /// Control mesh of a smooth surface (Catmull-Clark, Loop), the default.
    Smooth,
}

/// Mesh of a prim.
pub(super) struct PolygonMesh<'a> {
    points: &'a [[f64; 3]],
    /// Start of the corners of each face; one more entry than faces.
    begins: Vec<usize>,
    /// Points of all corners.
    corners: Vec<usize>,
    normals: Option<Primvar<'a, 3>>,
    /// Normals of points, for the control mesh of a smooth surface.
    smooth: Vec<[f64; 3]>,
    holes: HashSet<usize>,
    counts: Counts,
    pub(super) scheme: Scheme,
    /// True for the left-handed winding.
    pub(super) is_left_handed: bool,
}

impl<'a> PolygonMesh<'a> {
    /// Reads a mesh. Returns an error, in words, for one that cannot be used.
    pub(super) fn read(prim: &'a UsdPrim) -> Result<Self, String> {
        let points = tuples::<3>(prim, "points");
        if points.iter().flatten().any(|v| !v.is_finite()) {
            return Err("\"points\" has a value that is not finite".to_owned());
        }
        let counts = indices(prim, "faceVertexCounts").ok_or("\"faceVertexCounts\" has a value below 0")?;
        let corners = indices(prim, "faceVertexIndices").ok_or("\"faceVertexIndices\" has a value below 0")?;
        let begins: Vec<usize> = std::iter::once(0)
            .chain(counts.iter().scan(0_usize, |sum, count| {
                *sum = sum.saturating_add(*count);
                Some(*sum)
            }))
            .collect();
        let stated = begins.last().copied().unwrap_or_default();
        if stated != corners.len() {
            return Err(format!("its faces have {stated} corners, and \"faceVertexIndices\" has {}", corners.len()));
        }
        if let Some(beyond) = corners.iter().find(|corner| **corner >= points.len()) {
            return Err(format!("a face refers to point {beyond}, and there are {} points", points.len()));
        }
        let counts = Counts { faces: counts.len(), points: points.len(), corners: corners.len() };
        let scheme = match text(prim, "subdivisionScheme") {
            "none" => Scheme::None,
            "bilinear" => Scheme::Bilinear,
            _ => Scheme::Smooth,
        };
        // Creases of a subdivision surface are not supported on its control mesh.
        for name in ["cornerIndices", "cornerSharpnesses", "creaseIndices", "creaseLengths", "creaseSharpnesses"] {
            let _ = prim.value(name);
        }
        let mut normals = Primvar::read(prim, "primvars:normals", "constant", counts)?;
        if normals.is_none() {
            normals = Primvar::read(prim, "normals", "vertex", counts)?;
        }
        let mut polygon_mesh = Self {
            points,
            begins,
            corners,
            normals: normals.filter(|_| scheme == Scheme::None),
            holes: indices(prim, "holeIndices").unwrap_or_default().into_iter().collect(),
            counts,
            scheme,
            smooth: Vec::new(),
            is_left_handed: text(prim, "orientation") == "leftHanded",
        };
        if scheme == Scheme::Smooth {
            polygon_mesh.smooth = polygon_mesh.smoothed();
        }
        Ok(polygon_mesh)
    }

    /// Mean normal of each point's faces, in the mesh's own space.
    fn smoothed(&self) -> Vec<[f64; 3]> {
        let mut plain = Triangles { positions: self.points.to_vec(), ..Triangles::default() };
        for face in self.begins.windows(2).filter(|face| face[1] - face[0] >= 3) {
            let point = |i: usize| self.corners[i] as u32;
            plain.triangles.extend((face[0] + 1..face[1] - 1).map(|i| [face[0], i, i + 1].map(point)));
        }
        plain.smooth(DAffine3::IDENTITY);
        plain.normals
    }

    pub(super) fn faces(&self) -> usize {
        self.counts.faces
    }

    /// Texture coordinates of its prim by name, if present.
    pub(super) fn uvs(&self, prim: &'a UsdPrim, name: &str) -> Result<Option<Primvar<'a, 2>>, String> {
        Primvar::read(prim, &format!("primvars:{name}"), "constant", self.counts)
    }

    /// Area of all faces in the space that a transform leads to.
    pub(super) fn area(&self, to_world: DAffine3) -> f64 {
        let (all, _) = self.triangles(0..self.faces(), None);
        let at = |i: u32| to_world.transform_point3(DVec3::from_array(all.positions[i as usize]));
        all.triangles.iter().map(|t| t.map(at)).map(|[a, b, c]| 0.5 * (b - a).cross(c - a).length()).sum()
    }

    /// Triangles of some faces, with texture coordinates; the second value is the number of polygons without triangles.
    pub(super) fn triangles(
        &self,
        faces: impl Iterator<Item = usize>,
        uvs: Option<&Primvar<'a, 2>>,
    ) -> (Triangles, usize) {
        let mut mesh = Triangles::default();
        let mut known: HashMap<[usize; 3], u32> = HashMap::new();
        let mut refused = 0;
        for face in faces.filter(|face| *face < self.faces() && !self.holes.contains(face)) {
            let own = self.begins[face]..self.begins[face + 1];
            if own.len() < 3 {
                continue;
            }
            let places: Vec<[f64; 3]> = self.corners[own.clone()].iter().map(|point| self.points[*point]).collect();
            let Some(cut) = polygon_triangles(&places).filter(|_| own.len() <= MAX_CORNERS) else {
                refused += 1;
                continue;
            };
            for triangle in cut {
                let vertex = triangle.map(|i| self.vertex([face, own.start + i], uvs, &mut mesh, &mut known));
                mesh.triangles.push(vertex);
            }
        }
        (mesh, refused)
    }

    /// Index of a corner's vertex, shared by all equal corners.
    fn vertex(
        &self,
        [face, corner]: [usize; 2],
        uvs: Option<&Primvar<'a, 2>>,
        mesh: &mut Triangles,
        known: &mut HashMap<[usize; 3], u32>,
    ) -> u32 {
        let point = self.corners[corner];
        let place = [face, point, corner];
        let normal = self.normals.as_ref().map(|normals| normals.index(place));
        let uv = uvs.map(|uvs| uvs.index(place));
        *known.entry([point, normal.unwrap_or_default(), uv.unwrap_or_default()]).or_insert_with(|| {
            mesh.positions.push(self.points[point]);
            mesh.normals.extend(self.normals.iter().zip(normal).map(|(normals, index)| normals.value(index)));
            mesh.normals.extend(self.smooth.get(point));
            mesh.uvs.extend(uvs.iter().zip(uv).map(|(uvs, index)| uvs.value(index)));
            mesh.positions.len() as u32 - 1
        })
    }
}

/// Tuples of `N` numbers on a mesh.
pub(super) struct Primvar<'a, const N: usize> {
    values: Cow<'a, [[f64; N]]>,
    /// Index of the value of each element; `None`: the element's own index.
    indices: Option<Vec<usize>>,
    interpolation: Interpolation,
}

/// Domain of the values: the whole mesh, each face, point or corner.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Interpolation {
    Whole,
    Faces,
    Points,
    Corners,
}

/// Numbers of faces, points and corners of a mesh.
#[derive(Clone, Copy)]
pub(super) struct Counts {
    pub(super) faces: usize,
    pub(super) points: usize,
    pub(super) corners: usize,
}

impl<'a, const N: usize> Primvar<'a, N> {
    /// `None` if there is none; an error, in words, if it does not fit the mesh.
    pub(super) fn read(prim: &'a UsdPrim, name: &str, usual: &str, counts: Counts) -> Result<Option<Self>, String> {
        let values = match prim.value(name) {
            None => return Ok(None),
            Some(UsdValue::Tuple(_)) => Cow::Owned(tuple::<N>(prim, name).into_iter().collect()),
            Some(_) => Cow::Borrowed(tuples::<N>(prim, name)),
        };
        if values.is_empty() {
            return Ok(None);
        }
        if values.iter().flatten().any(|v| !v.is_finite()) {
            return Err(format!("\"{name}\" has a value that is not finite"));
        }
        let stated = prim.attributes.get(name).map_or("", |attribute| attribute.interpolation.as_str());
        let (interpolation, count) = match if stated.is_empty() { usual } else { stated } {
            "constant" => (Interpolation::Whole, 1),
            "uniform" => (Interpolation::Faces, counts.faces),
            "vertex" | "varying" => (Interpolation::Points, counts.points),
            "faceVarying" => (Interpolation::Corners, counts.corners),
            other => return Err(format!("\"{name}\" has an unknown interpolation \"{other}\"")),
        };
        let by = format!("{name}:indices");
        let has_indices = matches!(prim.value(&by), Some(UsdValue::Numbers(list)) if !list.is_empty());
        let indices = match has_indices {
            true => Some(indices(prim, &by).ok_or_else(|| format!("\"{by}\" has a value below 0"))?),
            false => None,
        };
        let available = indices.as_ref().map_or(values.len(), Vec::len);
        if available < count {
            return Err(format!("\"{name}\" has {available} values; the mesh needs {count}"));
        }
        if indices.iter().flatten().take(count).any(|index| *index >= values.len()) {
            return Err(format!("\"{by}\" has an index beyond the {} values", values.len()));
        }
        Ok(Some(Self { values, indices, interpolation }))
    }

    /// Index of the value at a corner, from the numbers of its face, its point and itself.
    pub(super) fn index(&self, [face, point, corner]: [usize; 3]) -> usize {
        let element = match self.interpolation {
            Interpolation::Whole => 0,
            Interpolation::Faces => face,
            Interpolation::Points => point,
            Interpolation::Corners => corner,
        };
        self.indices.as_ref().map_or(element, |indices| indices[element])
    }

    pub(super) fn value(&self, index: usize) -> [f64; N] {
        self.values[index]
    }

    /// The mean of all values.
    pub(super) fn mean(&self) -> [f64; N] {
        let sum = self.values.iter().fold([0.0; N], |sum, v| std::array::from_fn(|i| sum[i] + v[i]));
        sum.map(|v| v / self.values.len() as f64)
    }

    /// Returns true if it is constant.
    pub(super) fn is_even(&self) -> bool {
        self.values.iter().all(|v| *v == self.values[0])
    }
}
