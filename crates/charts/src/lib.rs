//! Test charts as scene descriptions, with ground truth.
//!
//! A chart is drawn ([`Chart::draw`]) on the part of a plane that a camera sees ([`Footprint`]): flat sheets whose pieces
//! partition the plane exactly ([`shape`]), printed with inks ([`Ink`]). [`files`] creates the meshes, the scene, the job, the
//! camera files, `truth.json` and a print in real millimetres.
//!
//! Sheet coordinates are mm, x to the right and y down as the camera sees the sheet, with the origin in its centre. The sheet is
//! in the world's plane x = distance and faces the origin, where the camera is: (x, y) mm is the point (distance, −x/1000,
//! −y/1000) m.
//!
//! This crate is independent of lens and sensor models: the caller provides the camera as a function from raster points to rays
//! ([`RayCamera`]) and one from light to electrons ([`CameraResponse`]). It reads no file and measures nothing.

mod camera_station;
pub mod design;
mod drawing;
mod error;
mod hand_held;
mod ink;
mod light;
mod ray_camera;
pub mod shape;
mod write;

pub use camera_station::{CameraStation, Exposures, Spacing, camera_stations};
pub use design::Chart;
pub use drawing::{Cavity, Drawing, Feature, FeatureKind, Patch, Texture};
pub use error::ChartError;
pub use ink::{Ink, Paint};
pub use light::{CameraResponse, Light, Panel};
pub use ray_camera::{Footprint, RasterRay, RayCamera};
pub use write::{ChartFile, ChartSpecification, Contents, camera_file, chart_image, files};
