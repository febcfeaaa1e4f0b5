//! Meshes: glTF (folder `gltf`), PLY (folder `ply`), STL, and Wavefront OBJ with its material library.
//!
//! Source: B-rep and material formats of the Advanced Visualizer, Wavefront Technologies 1995, appendices B1 (OBJ) and MTL; the physically based fields (`Pr`,
//! `Pm` …) after the proposal of Exocortex (2015).
//!
//! tobj parses OBJ. Our code handles what it ignores or cannot represent (docs/decisions/obj-reading.md): each line is checked before tobj reads it,
//! so that errors name their line, and concave polygons are cut by ear clipping.
//!
//! Read: `v vt vn f o g usemtl mtllib`, polygons of any number of corners, relative indices, continued lines, all line ends, any encoding. Not read, and noted
//! in the asset's report: lines, points, faces with fewer than three corners, curves and surfaces, vertex colours, further numbers of a vertex, smoothing groups
//! of a mesh without normals. Refused with the line: vertices of faces that are not finite, indices out of range, faces of which only some corners have a
//! normal, polygons that cross themselves.
//!
//! A file of a mesh whose vertices move is read corner by corner ([`read_mesh_frame`]), so that another file of the same faces can be followed, even if its
//! exporter merged equal normals differently.
//!
//! Coordinates are read in 64 bits and stored in 32; the report states the rounding for a mesh far from its origin.

mod asset;
mod derived_image;
mod ear_clipping;
mod gltf;
mod mtl;
mod mtl_images;
mod obj;
mod ply;
mod polygon;
mod slot;
mod statement;
mod stl;
mod texture_option;
mod vertex;

pub use asset::{read_mesh, read_mesh_frame};
pub use gltf::{
    GLTF_CUBIC_KEYS, GLTF_MIN_TURN, GltfCamera, GltfLight, GltfLightKind, GltfMotion, GltfMover, GltfParts,
    GltfProjection, GltfStage, GltfTrack, read_gltf_motion, read_gltf_stage,
};
pub use ply::{PlacedTriangles, encode_obj, encode_ply};
pub use polygon::polygon_triangles;

pub(crate) use asset::read_mesh_in;
pub(crate) use ply::is_ply;
pub(crate) use stl::is_stl;
