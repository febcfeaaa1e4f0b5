//! The job and its cameras.

use super::Request;
use crate::station::Station;
use std::fmt::Write as _;

/// The job file.
pub(super) fn job(request: &Request<'_>) -> String {
    let mut text = format!(
        "# The chart \"{}\": etendue render job.toml -o DIR. truth.json says what is where.\nformat = 1\nscene = \"scene.toml\"\n",
        request.chart.name()
    );
    let series = request.stations.iter().any(|station| station.exposure_s.is_some());
    for station in request.stations {
        let [p, t, u] = [station.position_m, station.target_m, station.up].map(|v| v.to_array());
        let name = &station.name;
        let file = camera_file(station);
        let _ = write!(
            text,
            "\n[[cameras]]\nname = \"{name}\"\nfile = \"{file}\"\nposition_m = {p:?}\nlook_at_m = {t:?}\nup = {u:?}\n"
        );
        if series {
            text.push_str("output = { ground_truth = false }\n");
        }
    }
    // Level "direct": flat sheets light nothing but the camera. Boxes behind holes do.
    let level = if request.drawing.cavities.is_empty() { "direct" } else { "path" };
    let (spp, seed) = (request.drawing.spp, request.seed);
    let _ = write!(text, "\n[render]\nspp = {spp}\nreplicates = 1\nintegrator = \"{level}\"\nseed = {seed}\n");
    text
}

/// The camera file of a station. A dark frame has that of the exposure before it.
pub(super) fn camera_file(station: &Station) -> String {
    match station.exposure_s {
        Some(_) => format!("{}.toml", station.name.replace("dark", "exposure")),
        None => "camera.toml".to_owned(),
    }
}

/// The camera of a station: the caller's, and what differs.
pub(super) fn camera(request: &Request<'_>, station: &Station) -> String {
    let mut text = format!("format = 1\nbase = \"{}\"\n", request.camera);
    if !request.remove.is_empty() {
        let _ = writeln!(text, "remove = {:?}", request.remove);
    }
    if let Some(exposure_s) = station.exposure_s {
        let _ = write!(text, "\n[sensor]\nexposure_s = {exposure_s:e}\n");
        if let Some(specimen) = request.specimen {
            let _ = write!(text, "\n# One specimen for all exposures.\n[sensor.non_uniformity]\nseed = {specimen}\n");
        }
    }
    text
}
