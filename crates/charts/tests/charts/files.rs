//! The files of every chart: descriptions that parse, and a ground truth that agrees with a pinhole's closed form.

use etendue_charts::design::{
    Backlit, Checkerboard, ColorChecker, DeadLeaves, DepthWedge, Dots, Flare, GridSize, SlantedEdges,
};
use etendue_charts::{
    CameraResponse, CameraStation, Chart, ChartFile, ChartSpecification, Contents, Light, RasterRay, RayCamera,
    camera_stations, files,
};
use etendue_scene::{Description, Overrides};
use etendue_spectra::Spectrum;
use glam::{DVec2, DVec3};
use serde_json::Value;
use std::path::Path;

const SIZE: DVec2 = DVec2::new(640.0, 480.0);
const FOCAL_PX: f64 = 700.0;
/// The centre of a pinhole in front of the pupil from which the rays are measured.
const CAMERA: &str = "format = 1\n[lens]\ntype = \"pinhole\"\nfocal_length_mm = 4\nf_number = 4\n[sensor]\nwidth_px = \
                      640\nheight_px = 480\npixel_pitch_um = 6\nexposure_s = 0.01\ncfa = \"mono\"\nquantum_efficiency = \
                      0.5\nfull_well_e = 20000\nread_noise_e = 5\ndark_current_e_s = 0\ngain_dn_per_e = 0.2\nblack_level_dn \
                      = 50\nbits = 12\n";

fn pinhole(at: DVec2) -> Option<RasterRay> {
    let direction = ((at - SIZE / 2.0) / FOCAL_PX).extend(1.0).normalize();
    Some(RasterRay { origin_m: DVec3::ZERO, direction })
}

fn chart_files(chart: &Chart, stations: &[CameraStation]) -> Vec<ChartFile> {
    let ray_camera = RayCamera { size_px: SIZE, ray: &pinhole };
    let footprint = ray_camera.footprint(2.0).expect("it looks ahead");
    let drawing = chart.draw(&footprint, 3).expect("a legal chart");
    let electrons = |radiance: &Spectrum| vec![("mono".to_owned(), 1e6 * radiance.integral(300.0, 1100.0))];
    let response = CameraResponse { exposure_s: 0.01, longest_s: None, saturation_e: 2e4, electrons: &electrons };
    let light = Light::named("D65", 500.0).expect("an illuminant");
    files(&ChartSpecification {
        chart,
        drawing: &drawing,
        footprint,
        ray_camera: &ray_camera,
        response: Some(&response),
        light: &light,
        stations,
        camera: "base.toml",
        remove: &[],
        unit_seed: Some(1),
        seed: 3,
        changes: &[],
    })
}

fn text<'a>(files: &'a [ChartFile], name: &str) -> Option<&'a str> {
    match &files.iter().find(|file| file.name == name)?.contents {
        Contents::Text(text) => Some(text),
        Contents::Grey16(..) => None,
    }
}

fn charts() -> Vec<Chart> {
    let size = GridSize { columns: Some(6), ..GridSize::default() };
    vec![
        Chart::Dots(Dots { size, dot_ratio: 0.5 }),
        Chart::Backlit(Backlit),
        Chart::ColorChecker(ColorChecker),
        Chart::DeadLeaves(DeadLeaves { smallest_px: 8.0, largest_ratio: 0.2 }),
        Chart::Flare(Flare { size, trap_ratio: 0.2 }),
        Chart::SlantedEdges(SlantedEdges { size, angle_deg: 5.0, contrast: 4.0 }),
        Chart::DepthWedge(DepthWedge { steps: 4, far_ratio: 2.0 }),
    ]
}

#[test]
fn descriptions_parse() {
    for chart in charts() {
        let exposures: &[f64] = if matches!(chart, Chart::Backlit(_)) { &[0.001, 0.002, 0.004] } else { &[] };
        let files = chart_files(&chart, &camera_stations(2.0, 1, exposures, true));
        let read = |path: &Path| {
            let name = path.file_name().and_then(|name| name.to_str()).ok_or("a name")?;
            let base = (name == "base.toml").then_some(CAMERA);
            base.or_else(|| text(&files, name)).map(str::to_owned).ok_or_else(|| "there is no such file".into())
        };
        let description = Description::load(Path::new("job.toml"), &read, &Overrides::default());
        let description = description.unwrap_or_else(|errors| panic!("{}: {errors}", chart.name()));
        for asset in description.assets() {
            let name = asset.path.file_name().and_then(|name| name.to_str()).expect("a name").to_owned();
            assert!(files.iter().any(|file| file.name == name), "{}: {name} is not written", chart.name());
        }
    }
}

#[test]
fn positions_are_those_of_a_pinhole() {
    let chart = Chart::Checkerboard(Checkerboard { size: GridSize::default() });
    let files = chart_files(&chart, &camera_stations(2.0, 4, &[], false));
    let truth: Value = serde_json::from_str(text(&files, "truth.json").expect("a truth")).expect("JSON");
    let number = |value: &Value| value.as_f64().expect("a number");
    let features = truth["features"].as_array().expect("features");
    let cameras = truth["cameras"].as_array().expect("cameras");
    assert_eq!((cameras.len(), features.len()), (4, 11 * 8));
    for camera in cameras {
        let rows = &camera["camera_to_world"];
        let row = |i: usize| DVec3::new(number(&rows[i][0]), number(&rows[i][1]), number(&rows[i][2]));
        let origin = DVec3::new(number(&rows[0][3]), number(&rows[1][3]), number(&rows[2][3]));
        for (feature, positions_px) in features.iter().zip(camera["features_px"].as_array().expect("positions")) {
            let world = &feature["world_m"][0];
            let from = DVec3::new(number(&world[0]), number(&world[1]), number(&world[2])) - origin;
            let point = row(0) * from.x + row(1) * from.y + row(2) * from.z;
            let expected = SIZE / 2.0 + FOCAL_PX * point.truncate() / point.z;
            let actual = DVec2::new(number(&positions_px[0][0]), number(&positions_px[0][1]));
            assert!((actual - expected).length() < 1e-8, "{actual} {expected}");
        }
    }
}

#[test]
fn the_first_corner_is_at_the_top_left() {
    let chart = Chart::Checkerboard(Checkerboard { size: GridSize::default() });
    let files = chart_files(&chart, &camera_stations(2.0, 1, &[], false));
    let truth: Value = serde_json::from_str(text(&files, "truth.json").expect("a truth")).expect("JSON");
    let first = &truth["features"][0];
    assert_eq!(first["index"], serde_json::json!([0, 0]));
    assert!(first["sheet_mm"][0][0].as_f64() < Some(0.0) && first["sheet_mm"][0][1].as_f64() < Some(0.0));
    // Left in the world is +y, up is +z.
    assert!(first["world_m"][0][1].as_f64() > Some(0.0) && first["world_m"][0][2].as_f64() > Some(0.0));
}
