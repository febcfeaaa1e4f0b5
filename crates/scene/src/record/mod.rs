//! Records: the keys of each table of a description. One file per table.
//!
//! Every public field is a key of the file (or, where it is a record without a key of its own, keys of the same
//! table), in the unit that its suffix names. Paths are resolved: relative to where the job's path is.

pub mod camera;
pub mod curve;
pub mod datasheet;
pub mod effects;
pub mod environment;
pub mod frame;
pub mod front;
pub mod job;
pub mod laboratory;
pub mod lens;
pub mod light;
pub mod material;
pub mod medium;
pub mod mesh;
pub mod moment;
pub mod motion;
pub mod object;
pub mod output;
pub mod paths;
pub mod pose;
pub mod precipitation;
pub mod processing;
pub mod reflectance;
pub mod render;
pub mod samples;
pub mod scene;
pub mod sensor;
pub mod sequence;
pub mod shape;
pub mod texture;
pub mod transform;
pub mod variations;
pub mod vertex_animation;
pub mod weather;

pub use camera::Camera;
pub use curve::Curve;
pub use datasheet::DataSheet;
pub use effects::Effects;
pub use environment::Environment;
pub use frame::Frame;
pub use front::ExternalOptics;
pub use job::{CameraEntry, Job};
pub use laboratory::Laboratory;
pub use lens::Lens;
pub use light::{Emission, Level, Light, LightColour, Sun, SunLevel};
pub use material::{Material, Surface, SurfaceEmission, SurfaceSource};
pub use medium::Medium;
pub use mesh::Mesh;
pub use motion::{MotionKeys, Trajectory};
pub use object::{Body, Instance, Object};
pub use output::Output;
pub use pose::Pose;
pub use precipitation::Precipitation;
pub use processing::Processing;
pub use reflectance::{Colour, Reflectance};
pub use render::Render;
pub use scene::Scene;
pub use sensor::{Electronics, Sensor};
pub use sequence::Sequence;
pub use shape::Shape;
pub use texture::Texture;
pub use transform::Transform;
pub use vertex_animation::VertexAnimation;
