//! What is asked for when a drawing becomes files.

use crate::camera_station::CameraStation;
use crate::design::Chart;
use crate::drawing::Drawing;
use crate::light::{Light, Meter};
use crate::ray_camera::{Footprint, RayCamera};

/// Everything that decides a chart's files.
pub struct Request<'a> {
    /// The chart.
    pub chart: &'a Chart,
    /// Its drawing.
    pub drawing: &'a Drawing,
    /// What the camera sees of its plane.
    pub seen: Footprint,
    /// The camera's rays.
    pub ray_camera: &'a RayCamera<'a>,
    /// What the camera makes of light; `None` without electronics.
    pub meter: Option<&'a Meter<'a>>,
    /// The light.
    pub light: &'a Light,
    /// The cameras of the job.
    pub stations: &'a [CameraStation],
    /// The camera file that the job's cameras build on, as a path from the chart's folder.
    pub camera: &'a str,
    /// Keys that are taken out of it.
    pub remove: &'a [&'a str],
    /// The specimen that all cameras of a series share, where the camera file does not say one.
    pub specimen: Option<u64>,
    /// The seed.
    pub seed: u64,
    /// Changes `key=value` of the job's keys that are applied after the chart is drawn.
    pub changes: &'a [String],
}
