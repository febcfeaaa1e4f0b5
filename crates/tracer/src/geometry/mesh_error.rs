//! Errors of meshes.

/// Error of a mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum MeshError {
    /// A triangle names a vertex that does not exist.
    #[error("triangle {triangle} refers to vertex {vertex}, but the mesh has {vertices} vertices; correct its indices")]
    IndexOutOfRange {
        /// Index of the triangle, from 0.
        triangle: usize,
        /// The vertex that it names.
        vertex: u32,
        /// Number of vertices of the mesh.
        vertices: usize,
    },
    /// A coordinate is NaN or infinite.
    #[error("vertex {vertex} has a coordinate that is not a finite number; correct its position")]
    NonFinitePosition {
        /// Index of the vertex, from 0.
        vertex: usize,
    },
    /// A coordinate is beyond what single precision can intersect.
    #[error(
        "vertex {vertex} is more than 1e12 m from the mesh's origin; give the mesh a smaller unit or place it by its instance"
    )]
    TooFar {
        /// Index of the vertex, from 0.
        vertex: usize,
    },
    /// A texture coordinate is NaN or infinite.
    #[error("vertex {vertex} has a texture coordinate that is not a finite number; correct it")]
    NonFiniteUv {
        /// Index of the vertex, from 0.
        vertex: usize,
    },
    /// Normals or texture coordinates do not match the vertices, or slots the triangles.
    #[error("the mesh has {actual} {what}; it must have {expected} or none")]
    Count {
        /// The counted quantity.
        what: &'static str,
        /// Number found.
        actual: usize,
        /// Number expected.
        expected: usize,
    },
    /// More triangles than the tree can index.
    #[error("the mesh has {triangles} triangles, more than the maximum of 536870911; split it")]
    TooManyTriangles {
        /// Number of triangles.
        triangles: usize,
    },
    /// Vertices that move have too few frames, or times that do not fit them.
    #[error(
        "{frames} frames of vertices have {times} times; give at least two frames and a finite, increasing time for each, and for a \
         loop one more time"
    )]
    FrameTimes {
        /// Number of frames.
        frames: usize,
        /// Number of times.
        times: usize,
    },
    /// Frames of moving vertices differ in their numbers of vertices or normals.
    #[error("frame {frame} differs from frame 0 in its number of vertices or normals; all frames must be of one mesh")]
    UnequalFrames {
        /// Index of the frame, from 0.
        frame: usize,
    },
}
