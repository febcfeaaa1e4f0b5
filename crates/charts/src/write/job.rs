//! The job and its cameras.

use super::Request;
use crate::camera_station::CameraStation;
use etendue_core::Integrator;
use etendue_scene::record::samples::SampleKeys;
use etendue_scene::record::sensor::charge::NonUniformity;
use etendue_scene::record::{Output, Pose, Render};
use etendue_scene::written::{File, Table};

/// The job file.
pub(super) fn job(request: &Request<'_>) -> String {
    let series = request.stations.iter().any(|station| station.exposure_s.is_some());
    let cameras: Vec<_> = request.stations.iter().map(|station| camera_entry(station, series)).collect();
    // Level "direct": flat sheets light nothing but the camera. Boxes behind holes do.
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
    let about = format!("The chart \"{name}\": etendue render job.toml -o DIR. truth.json says what is where.");
    File::new(job).head(about).to_string()
}

/// A station as a camera of the job; in a series, whose views are the same, without ground truth.
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

/// The camera file of a station. A dark frame has that of the exposure before it.
#[must_use]
pub fn camera_file(station: &CameraStation) -> String {
    match station.exposure_s {
        Some(_) => format!("{}.toml", station.name.replace("dark", "exposure")),
        None => "camera.toml".to_owned(),
    }
}

/// The camera of a station: the caller's, and what differs.
pub(super) fn camera(request: &Request<'_>, station: &CameraStation) -> String {
    let mut camera = Table::new().with("base", request.camera);
    if !request.remove.is_empty() {
        camera.put("remove", request.remove.to_vec());
    }
    if let Some(exposure_s) = station.exposure_s {
        let mut sensor = Table::new().with("exposure_s", exposure_s);
        if let Some(specimen) = request.specimen {
            let pattern = NonUniformity { seed: Some(specimen.into()), ..NonUniformity::default() };
            sensor.put("non_uniformity", pattern.to_table());
        }
        camera.put("sensor", sensor);
    }
    File::new(camera).above("sensor.non_uniformity", "One specimen for all exposures.").to_string()
}
