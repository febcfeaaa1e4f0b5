//! Geometry of the world: triangle meshes and analytic spheres, instances of them, and points on their surfaces.
//!
//! A mesh keeps its own f32 frame; an instance places it in the world by an f64 transform. Two instances of one mesh share its vertices and its tree.

mod instance;
mod mesh;
mod mesh_error;
mod mesh_pose;
mod placement;
mod repeats;
pub(crate) mod sphere;
mod surface;
mod vertex_animation;

pub use instance::{Instance, MeshId, Shape};
pub use mesh::{DroppedTriangles, Mesh};
pub use mesh_error::MeshError;
pub use mesh_pose::MeshPose;
pub use surface::{Footprint, Hit, SurfacePoint};
pub use vertex_animation::{Repeat, VertexAnimation, VertexFrame};

pub(crate) use instance::{InstanceTransform, uniform_scale};
pub(crate) use placement::Placement;
