//! A drawing as files: the request, files in memory, the print of a texture, the job and its cameras.

use etendue_core::Integrator;
use etendue_scene::record::{Output, Pose, Render};
use etendue_scene::written::{File, Table};
use etendue_scene::{record::samples::SampleKeys, record::sensor::charge::NonUniformity};
use etendue_spectra::colour::encode;

use crate::drawing::{Drawing, Texture};
use crate::light::{CameraResponse, Light};
use crate::ray_camera::{Footprint, RayCamera};
use crate::{camera_station::CameraStation, design::Chart};

/// Everything that decides a chart's files.
pub struct ChartSpecification<'a> {
    pub chart: &'a Chart,
    pub drawing: &'a Drawing,
    /// The camera's view of its plane.
    pub footprint: Footprint,
    /// The camera's rays.
    pub ray_camera: &'a RayCamera<'a>,
    /// The camera's response to light; `None` without electronics.
    pub response: Option<&'a CameraResponse<'a>>,
    pub light: &'a Light,
    /// The cameras of the job.
    pub stations: &'a [CameraStation],
    /// Camera file that the job's cameras extend, as a path from the chart's folder.
    pub camera: &'a str,
    /// Keys to remove from it.
    pub remove: &'a [&'a str],
    /// Unit that all cameras of a series share (fixed patterns), if the camera file does not state one.
    pub unit_seed: Option<u64>,
    pub seed: u64,
    /// Changes `key=value` to the job's keys, applied after the chart is drawn.
    pub changes: &'a [String],
}

/// Contents of a file.
#[derive(Clone, Debug, PartialEq)]
pub enum Contents {
    Text(String),
    /// A grey 16-bit image: columns, rows, values row by row.
    Grey16(usize, usize, Vec<u16>),
}

/// A file and its name in the chart's folder.
#[derive(Clone, Debug, PartialEq)]
pub struct ChartFile {
    pub name: String,
    pub contents: Contents,
}

/// A texture encoded as sRGB, for the print.
pub(super) fn print_of(texture: &Texture) -> ChartFile {
    let encoded = |v: &u16| (encode(f32::from(*v) / 65_535.0) * 65_535.0).round() as u16;
    let values = texture.values.iter().map(encoded).collect();
    ChartFile { name: print_name(texture), contents: Contents::Grey16(texture.width, texture.height, values) }
}

/// File name of a texture for the print.
pub(super) fn print_name(texture: &Texture) -> String {
    format!("{}-print.png", texture.name)
}

/// The job file.
pub(super) fn job(request: &ChartSpecification<'_>) -> String {
    let series = request.stations.iter().any(|station| station.exposure_s.is_some());
    let cameras: Vec<_> = request.stations.iter().map(|station| camera_entry(station, series)).collect();
    // Level "direct": flat sheets light nothing except the camera. Boxes behind holes do.
    let integrator = if request.drawing.cavities.is_empty() { Integrator::Direct } else { Integrator::Path };
    let samples = SampleKeys {
        spp: Some(u64::from(request.drawing.spp).into()),
        replicates: Some(1.into()),
        ..SampleKeys::default()
    };
    let render =
        Render { samples, integrator: Some(integrator.into()), seed: Some(request.seed.into()), ..Render::default() };
    let job = Table::new().with("scene", "scene.toml").with("cameras", cameras).with("render", render.to_table());
    let name = request.chart.name();
    let comment = format!(
        "The chart \"{name}\": etendue render job.toml -o DIR. truth.json states the positions and properties of its features."
    );
    File::new(job).head(comment).to_string()
}

/// A station as a camera of the job; in a series, whose views are equal, without ground truth.
fn camera_entry(station: &CameraStation, series: bool) -> Table {
    let [position_m, target_m, up] = [station.position_m, station.target_m, station.up].map(|v| v.to_array());
    let pose = Pose::looking_at(position_m, target_m, up);
    let entry =
        Table::new().with("name", station.name.as_str()).with("file", camera_file(station)).and(pose.to_table());
    match series {
        true => entry.with("output", Output { ground_truth: Some(false.into()), ..Output::default() }.to_table()),
        false => entry,
    }
}

/// The camera file of a station. A dark frame uses that of the exposure before it.
#[must_use]
pub fn camera_file(station: &CameraStation) -> String {
    match station.exposure_s {
        Some(_) => format!("{}.toml", station.name.replace("dark", "exposure")),
        None => "camera.toml".to_owned(),
    }
}

/// The camera of a station: the caller's, with the differences.
pub(super) fn camera(request: &ChartSpecification<'_>, station: &CameraStation) -> String {
    let mut camera = Table::new().with("base", request.camera);
    if !request.remove.is_empty() {
        camera.put("remove", request.remove.to_vec());
    }
    if let Some(exposure_s) = station.exposure_s {
        let mut sensor = Table::new().with("exposure_s", exposure_s);
        if let Some(unit_seed) = request.unit_seed {
            let pattern = NonUniformity { seed: Some(unit_seed.into()), ..NonUniformity::default() };
            sensor.put("non_uniformity", pattern.to_table());
        }
        camera.put("sensor", sensor);
    }
    File::new(camera).above("sensor.non_uniformity", "One unit for all exposures.").to_string()
}
