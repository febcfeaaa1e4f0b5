//! A data sheet made a camera, measured as the standard does: the sheet's figures come back.

use etendue_pipeline::datasheet::imported;
use etendue_pipeline::plan::CameraBody;
use etendue_pipeline::{compile_camera, flat};
use etendue_scene::asset::{Assets, SpectrumAsset};
use etendue_scene::{Overrides, load_camera, load_datasheet};
use etendue_sensor::{FrameAddress, SensorState};
use std::path::Path;

const SIDE: f64 = 256.0;

/// The example's camera, its dark noise stated in DN alone.
fn body() -> CameraBody {
    let sheet = include_str!("../../../scenes/datasheets/made-up-cmos.toml");
    let sheet = sheet.replace("temporal_dark_noise_e = 2.50\n", "").replace("= 0.69", "= 0.6883");
    let sheet = load_datasheet(Path::new("sheet.toml"), &|_: &Path| Ok(sheet.clone())).expect("a sheet");
    let datasheet_camera = imported(&sheet, "sheet").expect("consistent");
    let mut assets = Assets::default();
    for (name, text) in &datasheet_camera.tables {
        let row = |line: &str| line.split_once(',').and_then(|(nm, v)| Some((nm.parse().ok()?, v.parse().ok()?)));
        let points = text.lines().skip(1).map(|line| row(line).expect("two numbers")).collect();
        assets.spectra.insert(name.into(), SpectrumAsset { points, hash: [0; 32] });
    }
    let small = Overrides::new(&["sensor.width_px=256".to_owned(), "sensor.height_px=256".to_owned()]);
    let camera = load_camera(Path::new("camera.toml"), &|_: &Path| Ok(datasheet_camera.camera.clone()), &small)
        .expect("a camera");
    flat::bare(&compile_camera(&camera, &assets).expect("it compiles")).expect("electronics")
}

/// Two frames of a stack: their mean and temporal variance.
fn measured(body: &CameraBody, series: &flat::PhotonTransfer, stack: usize) -> (f64, f64) {
    let sensor = body.sensor.as_ref().expect("electronics");
    let stack = &series.stacks[stack];
    let irradiance_w_m2 = if stack.photons > 0.0 { series.light.irradiance_w_m2 } else { 0.0 };
    let electrons = flat::electrons(body, flat::FlatLight { irradiance_w_m2, ..series.light }).expect("electronics");
    let frame = |frame| {
        let start_state = stack.state(sensor, SensorState::default());
        sensor.step(start_state, &electrons, FrameAddress { seed: 1, camera: 0, frame, capture: 0 }).1.plane
    };
    let (a, b) = (frame(0), frame(1));
    let pairs = || a.samples().iter().zip(b.samples()).map(|(a, b)| (f64::from(*a), f64::from(*b)));
    let mean = pairs().map(|(a, b)| a + b).sum::<f64>() / (2.0 * SIDE * SIDE);
    (mean, pairs().map(|(a, b)| (a - b) * (a - b)).sum::<f64>() / (2.0 * SIDE * SIDE))
}

/// Variances of 65 536 pairs have an uncertainty of 0.55 %: four of them; dark current adds 0.12 e⁻ at the longest exposure.
#[test]
fn noise_gain_and_efficiency_of_the_sheet_come_back() {
    let body = body();
    let series = flat::photon_transfer(body.sensor.as_ref().expect("electronics"), 525.0, 20, 3).expect("linear");
    let (dark, dark_variance) = measured(&body, &series, 1);
    let (bright, variance) = measured(&body, &series, 20);
    let near = |actual: f64, stated: f64| assert!((actual / stated - 1.0).abs() < 0.022, "{actual}, stated {stated}");
    // The stated figure, quantisation included: it is not counted twice.
    near(dark_variance, 0.6883 * 0.6883);
    near((variance - dark_variance) / (bright - dark), 0.25);
    // Of 0.62, without the variance's uncertainty.
    let efficiency = (bright - dark) / 0.25 / series.stacks[20].photons;
    assert!((efficiency - 0.62).abs() < 1e-3, "{efficiency}");
}
