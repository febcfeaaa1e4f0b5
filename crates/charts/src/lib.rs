//! Test charts as scene descriptions, with their truth.
//!
//! A chart is drawn ([`Chart::draw`]) on the part of a plane that a camera sees ([`Footprint`]): flat sheets whose pieces
//! partition the plane exactly ([`shape`]), printed with inks ([`Ink`]). [`files`] makes of it the meshes, the scene, the job, the camera
//! files, `truth.json` and a print in real millimetres.
//!
//! Sheet coordinates are mm, x to the right and y down as the camera sees the sheet, the origin in its middle. The sheet
//! stands in the world's plane x = distance and faces the origin, where the camera stands: (x, y) mm is the point
//! (distance, −x/1000, −y/1000) m.
//!
//! This crate knows no lens and no sensor: a camera is a function from raster points to rays ([`RayCamera`]) and one from light to
//! electrons ([`Meter`]), given by the caller. It reads no file and measures nothing.

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
pub use drawing::{Cavity, Drawing, Feature, Kind, Patch, Texture};
pub use error::ChartError;
pub use ink::{Ink, Paint};
pub use light::{Light, Meter, Panel};
pub use ray_camera::{Footprint, RasterRay, RayCamera};
pub use write::{ChartFile, Contents, Request, camera_file, files, picture};
