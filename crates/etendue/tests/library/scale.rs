//! `sensor.scale`: the same field of view, mean level and clipping with fewer, larger pixels.

use etendue::{ExistingFiles, Job, JobRequest, MemoryFiles, NullObserver, RenderOptions};
use etendue_core::Shutter;
use etendue_core::maths::f64::pow;
use etendue_pipeline::plan::CameraBody;
use etendue_sensor::effects::response::Response;
use glam::DVec3;
use std::path::Path;

const WIDTH: f64 = 64.0;
const HEIGHT: f64 = 48.0;
const GAIN: f64 = 0.25;
const BLACK_DN: f64 = 64.0;
const WHITE_DN: f64 = 4095.0;
const READ_NOISE_E: f64 = 6.0;

/// An emitting plane in focus; its left half is five times as bright as the saturation of the ADC.
fn panel(sensor: &str) -> String {
    let half = |name: &str, y: f64, luminance: f64| {
        format!(
            "[[scene.materials]]\nname = \"{name}\"\ntype = \"emitter\"\nemission = {{ luminance_cd_m2 = {luminance}, illuminant = \"D65\" }}\n\
             [[scene.objects]]\nname = \"{name}\"\nmaterial = \"{name}\"\nshape = {{ type = \"quad\", size_m = [20, 20] }}\n\
             position_m = [2, {y}, 0]\nrotation_deg = [0, -90, 0]\n"
        )
    };
    format!(
        "format = 1\n[[cameras]]\nname = \"eye\"\nposition_m = [0, 0, 0]\nlook_at_m = [1, 0, 0]\n\
         lens = {{ type = \"thin\", focal_length_mm = 6, f_number = 2, focus_distance_m = 2 }}\n\
         sensor = {{ width_px = {WIDTH}, height_px = {HEIGHT}, pixel_pitch_um = 12, exposure_s = 0.002, cfa = \"rggb\", \
         quantum_efficiency = 0.5, full_well_e = 60000, read_noise_e = {READ_NOISE_E}, dark_current_e_s = 500, gain_dn_per_e = {GAIN}, \
         black_level_dn = {BLACK_DN}, bits = 12, crosstalk = {{ horizontal = 0.01, vertical = 0.01 }}{sensor} }}\n\
         [render]\nspp = 64\nintegrator = \"flat\"\n[output]\nground_truth = false\n{}{}",
        half("bright", 10.0, 1500.0),
        half("dim", -10.0, 15.0),
    )
}

fn open_job(text: &str, scale: Option<&str>) -> Result<Job, String> {
    let mut files = MemoryFiles::new();
    files.add_text("job.toml", text);
    let request = JobRequest { scale: scale.map(str::to_owned), ..JobRequest::new("job.toml") };
    request.open_in(&files).map_err(|error| error.to_string())
}

fn body<'j>(job: &'j Job, camera: &str) -> &'j CameraBody {
    &job.plan().camera(camera).expect("a camera").body
}

/// Returns the mean level, DN, and the fraction of clipped pixels of the first frame.
fn levels(job: &Job) -> [f64; 2] {
    let folder = tempfile::tempdir().expect("a folder");
    job.save(&RenderOptions::default(), folder.path(), ExistingFiles::Refuse, &NullObserver).expect("rendered");
    let text = std::fs::read_to_string(folder.path().join("eye/camera.json")).expect("a side-car");
    let sidecar: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    let levels = &sidecar["frames"][0]["levels"];
    ["mean_dn", "clipped_fraction"].map(|key| levels[key].as_f64().unwrap_or_else(|| panic!("{key}: {sidecar}")))
}

/// Variance of the mean of the dim half, DN², with pixels of k × k. A sample of a pixel deviates from the pixel's mean by no more than half of it
/// (the spectrum of D65 over the range; the lens's weights by less), so that the mean of 64 has a standard deviation of at most 0.5/8. Photon noise,
/// read noise and rounding are added.
fn variance(dim_dn: f64, k: f64) -> f64 {
    let pixels = 0.5 * WIDTH * HEIGHT / (k * k);
    let (signal_dn, gain) = (dim_dn - BLACK_DN, GAIN / (k * k));
    let light = (0.5 / 8.0 * signal_dn) * (0.5 / 8.0 * signal_dn);
    let noise = gain * signal_dn + gain * gain * READ_NOISE_E * READ_NOISE_E + 1.0 / 12.0;
    (light + noise) / pixels
}

/// Crosstalk over the border between the halves adds the same light to the dim half, whatever the size of pixels: the fraction h/k of k² times the electrons,
/// in a column of 1/k as many pixels. Three tests at 5 σ: a false alarm in a million.
#[test]
fn mean_level_and_clipping_stay() {
    let [mean, clipped] = levels(&open_job(&panel(""), None).expect("a job"));
    assert_eq!(clipped, 0.5, "mean {mean} DN");
    let dim = |mean: f64| 2.0 * mean - WHITE_DN;
    assert!(dim(mean) > BLACK_DN + 400.0 && dim(mean) < 3000.0, "dim half {} DN", dim(mean));
    for k in [2, 4] {
        let [scaled, clipped] = levels(&open_job(&panel(""), Some(&format!("1/{k}"))).expect("a job"));
        assert_eq!(clipped, 0.5, "1/{k}");
        let tolerance = 5.0 * (variance(dim(mean), 1.0) + variance(dim(mean), f64::from(k))).sqrt();
        let difference = dim(scaled) - dim(mean);
        assert!(difference.abs() < tolerance, "1/{k}: {difference} DN of {}, tolerance {tolerance}", dim(mean));
    }
}

/// Without light the mean is black + gain × current × time; the gain is 1/k², the current k² times as large. Poisson noise of 100 e⁻ a pixel,
/// read noise and rounding.
#[test]
fn dark_current_keeps_its_mean_level() {
    let text = panel("")
        .replace("dark_current_e_s = 500", "dark_current_e_s = 50000")
        .replace("luminance_cd_m2", "radiance_scale");
    let text = text
        .replace("radiance_scale = 1500", "luminance_cd_m2 = 0")
        .replace("radiance_scale = 15", "luminance_cd_m2 = 0");
    for k in [1.0, 2.0, 4.0] {
        let job = open_job(&text, Some(&format!("1/{k}"))).unwrap_or_else(|error| panic!("{error}"));
        let gain = GAIN / (k * k);
        let electrons = 100.0 * k * k;
        let variance = gain * gain * (electrons + READ_NOISE_E * READ_NOISE_E) + 1.0 / 12.0;
        let tolerance = 5.0 * (variance / (WIDTH * HEIGHT / (k * k))).sqrt();
        let [mean, _] = levels(&job);
        let expected = BLACK_DN + GAIN * 100.0;
        assert!((mean - expected).abs() < tolerance, "1/{k}: {mean} DN for {expected}, tolerance {tolerance}");
    }
}

/// Each key follows the rule that docs/sensor.md states.
#[test]
fn keys_scale_by_their_rules() {
    let sensor = ", frame_period_s = 0.04, shutter = { type = \"rolling\", row_time_us = 20 }, dark = { hot = { fraction = 0.01, mean_e_s = 300 } }, \
                  brighter_fatter_per_e = 1e-7, inter_pixel_capacitance = { horizontal = 0.02, vertical = 0.01, corner = 0.001 }, \
                  blooming = { direction = \"column\", overflow_fraction = 0.8 }, \
                  roi_px = [8, 16, 32, 24], principal_point_px = [30.5, 23], non_uniformity = { prnu = 0.01, dsnu_e = 2, seed = 1 }, \
                  hdr = { merged_bits = 20, captures = [{ exposure_ratio = 0.05, full_well_e = 50000 }] }";
    let job = |scale| open_job(&panel(sensor), scale).unwrap_or_else(|error| panic!("{error}"));
    let (full, quarter) = (job(None), job(Some("0.25")));
    let (full, quarter) = (body(&full, "eye"), body(&quarter, "eye"));
    let [before, after] = [full, quarter].map(|body| body.sensor.as_ref().expect("electronics").parameters());
    assert_eq!((quarter.raster.width(), quarter.raster.height(), quarter.scale), (16, 12, 4));
    assert_eq!(quarter.raster.principal_px().to_array(), [30.5 / 4.0, 23.0 / 4.0]);
    let near = |actual: f64, expected: f64| assert!((actual / expected - 1.0).abs() < 1e-12, "{actual} for {expected}");
    near(after.pixel.pitch_um, 48.0);
    near(after.charge.full_well.capacity_e, 16.0 * 60_000.0);
    near(after.read_out.gain_dn_e, GAIN / 16.0);
    near(after.voltage.noise.white_e, before.voltage.noise.white_e);
    near(after.voltage.offset.white_e, before.voltage.offset.white_e);
    near(after.light.photo_response.white, before.light.photo_response.white);
    near(after.charge.brighter_fatter.shift_per_e, 1e-7 / 64.0);
    let hot = after.charge.dark.hot.expect("hot pixels");
    near(hot.fraction, 1.0 - pow(0.99, 16.0));
    near(hot.fraction * hot.mean_e_s, 16.0 * 0.01 * 300.0);
    let coupling = after.voltage.capacitance.expect("a capacitance").0;
    near(coupling.horizontal, (4.0 * 0.02 + 6.0 * 0.001) / 16.0);
    near(coupling.vertical, (4.0 * 0.01 + 6.0 * 0.001) / 16.0);
    near(coupling.corner, 0.001 / 16.0);
    let region = after.read_out.layout.region.expect("a region");
    assert_eq!([region.x, region.y, region.width, region.height], [2, 4, 8, 6]);
    near(after.hdr.captures[0].full_well_e.expect("a well"), 16.0 * 50_000.0);
    // The read-out from the first row to the last takes as long as that of the full sensor.
    let reading_s = |body: &CameraBody| match body.exposure.shutter {
        Shutter::Rolling(rows) => rows.row_time_s * body.exposure.rows as f64,
        other => panic!("{other:?}"),
    };
    near(reading_s(quarter), reading_s(full));
    near(reading_s(full), 24.0 * 20e-6);
}

/// The knees of a response are at the same illumination.
#[test]
fn knees_are_at_the_same_illumination() {
    let sensor = ", response = { type = \"knees\", knees = [[20000, 0.5]] }";
    let job = open_job(&panel(sensor), Some("1/2")).unwrap_or_else(|error| panic!("{error}"));
    let sensor = body(&job, "eye").sensor.as_ref().expect("electronics");
    let Response::Knees(knees) = &sensor.parameters().read_out.response else { panic!("no straight lines") };
    assert_eq!((knees[0].at_e, knees[0].slope), (80_000.0, 0.5));
}

/// A larger row is exposed when the first of its original rows is, in any order of read-out: the skew from top to bottom is that of the full sensor.
#[test]
fn rows_are_exposed_when_their_first_row_is() {
    for rows in ["row_time_us = 25", "row_time_us = 25, fields = 2", "row_time_us = 25, direction = \"up\""] {
        for kind in ["rolling", "global_reset"] {
            let text = panel(&format!(", shutter = {{ type = \"{kind}\", {rows} }}"));
            let job = |scale| open_job(&text, scale).unwrap_or_else(|error| panic!("{error}"));
            let (full, quarter) = (job(None), job(Some("1/4")));
            let (full, quarter) = (&body(&full, "eye").exposure, &body(&quarter, "eye").exposure);
            // A field has every other row; in the direction "up" the first of four rows is the lowest.
            let first = |row: usize| match rows {
                field if field.contains("fields") => 8 * (row / 2) + row % 2,
                up if up.contains("up") => 4 * row + 3,
                _ => 4 * row,
            };
            for row in 0..12 {
                let (actual, expected) = (quarter.row(0, row), full.row(0, first(row)));
                let near = |a: f64, b: f64| (a - b).abs() < 1e-12;
                let is_same = near(actual.start_s(), expected.start_s()) && near(actual.end_s(), expected.end_s());
                assert!(is_same, "{kind}, {rows}, row {row}: {actual:?} for {expected:?}");
            }
            assert!((quarter.reading_s() / full.reading_s() - 1.0).abs() < 1e-9, "{kind}, {rows}");
        }
    }
}

/// Every projection images a point at 1/k of its raster coordinates: (u + 0.5)/k − 0.5 in those of OpenCV.
#[test]
fn calibrations_project_points_to_scaled_coordinates() {
    let rig = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/oracles/figures/rig/rig.toml");
    let open = |scale: Option<&str>| {
        let request = JobRequest { scale: scale.map(str::to_owned), ..JobRequest::new(&rig) };
        request.open().unwrap_or_else(|error| panic!("{error}"))
    };
    let (full, half) = (open(None), open(Some("1/4")));
    for name in ["left", "side", "five", "rear", "globe"] {
        assert_same_projection(body(&full, name), body(&half, name), 4.0);
    }
    let folders = [0, 1].map(|_| tempfile::tempdir().expect("a folder"));
    let [before, after] = [(&full, &folders[0]), (&half, &folders[1])].map(|(job, folder)| {
        job.save_calibration_files(&(0..1), folder.path(), ExistingFiles::Refuse, &NullObserver).expect("written");
        std::fs::read_to_string(folder.path().join("calibration/ros/five.yaml")).expect("a calibration")
    });
    let [before, after] = [before, after].map(|text| matrix(&text));
    for axis in [0, 1] {
        let (f, c) = (4 * axis, 3 * axis + 2);
        assert!((after[f] - before[f] / 4.0).abs() < 1e-9, "{after:?}");
        assert!((after[c] - ((before[c] + 0.5) / 4.0 - 0.5)).abs() < 1e-9, "{after:?} of {before:?}");
    }
}

/// A calibration file of another program describes the full image.
#[test]
fn calibration_files_describe_the_full_image() {
    let camera = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/cameras/calibrated.toml");
    let text = format!(
        "format = 1\nscene = {{}}\n[[cameras]]\nname = \"eye\"\nfile = {camera:?}\nposition_m = [0, 0, 0]\nrotation_deg = [0, 0, 0]\n"
    );
    let open = |scale| open_job(&text, scale).unwrap_or_else(|error| panic!("{error}"));
    let (full, half) = (open(None), open(Some("1/2")));
    assert_same_projection(body(&full, "eye"), body(&half, "eye"), 2.0);
}

/// Compares the images of three points in view, given by their directions in the camera frame.
fn assert_same_projection(full: &CameraBody, scaled: &CameraBody, k: f64) {
    let image_px = |body: &CameraBody, to: DVec3| body.raster.raster_px(body.lens.project(to).expect("in the field"));
    for to in [[0.0, 0.0, 1.0], [0.2, -0.1, 1.0], [-0.3, 0.25, 1.0]].map(DVec3::from_array) {
        let (expected, actual) = (image_px(full, to) / k, image_px(scaled, to));
        assert!((actual - expected).length() < 1e-9, "{to}: {actual} for {expected}");
    }
}

/// The camera matrix of ROS's camera_info.
fn matrix(text: &str) -> Vec<f64> {
    let rest = &text[text.find("camera_matrix").expect("a matrix")..];
    let inside = &rest[rest.find('[').expect("a list") + 1..rest.find(']').expect("its end")];
    inside.split(',').map(|number| number.trim().parse().expect("a number")).collect()
}

#[test]
fn sizes_that_do_not_divide_are_refused_with_those_that_do() {
    let error = open_job(&panel(""), Some("1/5")).expect_err("64 × 48 px are no multiple of 5");
    let (problem, remedy) = ("64 × 48 px are not a multiple of 5 × 5 pixels", "give one of 1/2, 1/4, 1/8, 1/16");
    assert!(error.contains("`scale` 1/5") && error.contains(problem) && error.contains(remedy), "{error}");
    let error = open_job(&panel(", roi_px = [2, 0, 32, 24]"), Some("1/4")).expect_err("a region at column 2");
    assert!(error.contains("roi_px = [2, 0, 32, 24]") && error.contains("give one of 1/2"), "{error}");
    let error = open_job(&panel(""), Some("2")).expect_err("larger than the sensor");
    assert!(error.contains("`scale` 2") && error.contains("\"1/4\" or 0.25"), "{error}");
    let error = open_job(&panel(", scale = \"3/4\""), None).expect_err("no part of a pixel");
    assert!(error.contains("sensor.scale"), "{error}");
}

#[test]
fn the_plan_states_the_scale() {
    let job = open_job(&panel(", scale = \"1/2\""), None).expect("a key of the file");
    assert!(job.summary().contains("32 × 24 px of 24 µm (scale 1/2 of 64 × 48 px)"), "{}", job.summary());
    let job = open_job(&panel(", scale = \"1/2\""), Some("0.25")).expect("the flag counts");
    assert!(job.summary().contains("16 × 12 px of 48 µm (scale 1/4 of 64 × 48 px)"), "{}", job.summary());
    let report = serde_json::to_value(job.report()).expect("JSON");
    assert_eq!((&report["cameras"][0]["scale"], &report["cameras"][0]["sensor_px"][0]), (&0.25.into(), &16.into()));
}
