//! Content of one file of a mesh with moving vertices.

/// Faces of a mesh file, corner by corner, so that files with equal faces can be matched corner by corner.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MeshFrameAsset {
    /// Faces of one material and form, in the order of the mesh's.
    pub parts: Vec<MeshFramePart>,
    /// Vertices of the file.
    pub vertices: usize,
    /// Triangulation of the faces, as in the mesh: indices of corners, counted over all parts.
    pub triangles: Vec<[u32; 3]>,
    /// SHA-256 of the file.
    pub hash: [u8; 32],
}

/// Faces with one material and form.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MeshFramePart {
    /// Name of the material, empty before any.
    pub material: String,
    /// Corners of each face.
    pub arities: Vec<u32>,
    /// Vertex of each corner: an index to `positions`, which are numbered in the order of use by faces.
    pub vertices: Vec<u32>,
    /// Texture coordinates of each corner, with the same numbering; empty without.
    pub uvs: Vec<u32>,
    /// The normal of each corner: an index to `normals`; empty without.
    pub normal_indices: Vec<u32>,
    /// Positions in the file's own units.
    pub positions: Vec<[f64; 3]>,
    /// Unit normals; zero where the file's has zero length.
    pub normals: Vec<[f32; 3]>,
}

impl MeshFrameAsset {
    /// Faces of the file.
    #[must_use]
    pub fn faces(&self) -> usize {
        self.parts.iter().map(|part| part.arities.len()).sum()
    }

    /// First difference of this file from another of the same mesh in words, this file's first; `None` if both have the same faces.
    #[must_use]
    pub fn difference(&self, other: &Self) -> Option<[String; 2]> {
        let both = |describe: &dyn Fn(&Self) -> String| Some([describe(self), describe(other)]);
        if self.vertices != other.vertices {
            return both(&|frame| format!("{} vertices", frame.vertices));
        }
        if self.faces() != other.faces() {
            return both(&|frame| format!("{} faces", frame.faces()));
        }
        let form = |part: &MeshFramePart| (part.material.clone(), part.arities.len(), part.normals.is_empty());
        if !self.parts.iter().map(form).eq(other.parts.iter().map(form)) {
            let words = "material groups, or faces with and without normals, that differ from the other file's";
            return both(&|_| words.to_owned());
        }
        let faces = |frame: &Self| frame.parts.iter().flat_map(MeshFramePart::faces).collect::<Vec<_>>();
        let (own, others) = (faces(self), faces(other));
        let face = own.iter().zip(&others).position(|(a, b)| a != b)?;
        let message = |face: &(Vec<u32>, Vec<u32>)| format!("{} corners", face.0.len());
        let [a, b] = [message(&own[face]), message(&others[face])];
        let at = |text: String| format!("{text} at face {} (by material)", face + 1);
        Some(if a == b { [at(a), "different vertices there".to_owned()] } else { [at(a), format!("{b} there")] })
    }
}

impl MeshFramePart {
    /// Vertices and texture coordinates of each face.
    fn faces(&self) -> impl Iterator<Item = (Vec<u32>, Vec<u32>)> + '_ {
        let mut begin = 0;
        self.arities.iter().map(move |arity| {
            let corners = begin..begin + *arity as usize;
            begin = corners.end;
            (self.vertices[corners.clone()].to_vec(), self.uvs.get(corners).unwrap_or_default().to_vec())
        })
    }
}
