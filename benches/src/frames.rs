//! The electronics and the development of a frame of two megapixels.

use crate::scenes::{STREET, camera};
use etendue_bench_rays::clock::timed;
use etendue_bench_rays::runs::RunStatistics;
use etendue_bench_rays::table::Table;
use etendue_bench_rays::threads::pool;
use etendue_core::Plane;
use etendue_core::quantity::MeanElectrons;
use etendue_isp::{RawImage, develop};
use etendue_pipeline::plan::{CameraBody, Development};
use etendue_sensor::{FrameAddress, Raw, Sensor, SensorParameters, SensorState};

const NOTE: &str = "1920 × 1080 px of the street's camera under a ramp of light from none to the full well; shot noise, \
    read noise, full well and (raised to 5 e⁻ a pixel) dark current. One thread.";
const WIDTH: usize = 1920;
const HEIGHT: usize = 1080;

/// Time of a frame.
pub fn table() -> Table {
    let plan = STREET.plan();
    let body = &camera(&plan).body;
    let sensor = sensor(body);
    let means = ramp(sensor.parameters().charge.full_well.capacity_e);
    let development = body.development.as_ref().expect("the street's camera makes pictures");
    let raw = expose(&sensor, &means);
    let one = pool(1);
    let exposing = RunStatistics::measure(|| one.install(|| timed(|| std::hint::black_box(expose(&sensor, &means))).1));
    let developing =
        RunStatistics::measure(|| one.install(|| timed(|| std::hint::black_box(ramp_image(&raw, development))).1));
    let mut table = Table::new("A frame of two megapixels", NOTE, &["step", "ms", "ns a pixel", "spread"]);
    table.row(row("electrons to raw, all noises", &exposing));
    table.row(row("raw to picture", &developing));
    table
}

fn row(name: &str, runs: &RunStatistics) -> Vec<String> {
    let seconds = runs.median();
    let pixel_ns = seconds / (WIDTH * HEIGHT) as f64 * 1e9;
    vec![name.to_owned(), format!("{:.0}", seconds * 1e3), format!("{pixel_ns:.0}"), runs.spread_text()]
}

/// The camera's sensor, with dark current that counts.
fn sensor(body: &CameraBody) -> Sensor {
    let mut warm: SensorParameters =
        body.sensor.as_ref().expect("the street's camera has electronics").parameters().clone();
    (warm.exposure.exposure_s, warm.charge.dark.current_e_s, warm.noise) = (0.01, 500.0, true);
    Sensor::new(warm).expect("a legal sensor")
}

fn ramp(full_well_e: f64) -> Plane<MeanElectrons> {
    let mean = |i: usize| (full_well_e * (i % WIDTH) as f64 / WIDTH as f64) as f32;
    Plane::from_samples(WIDTH, HEIGHT, (0..WIDTH * HEIGHT).map(mean).collect()).expect("one mean a pixel")
}

fn expose(sensor: &Sensor, means: &Plane<MeanElectrons>) -> Raw {
    sensor.step(SensorState::default(), means, FrameAddress { seed: 1, camera: 0, frame: 0, capture: 0 }).1
}

fn ramp_image(raw: &Raw, development: &Development) -> etendue_isp::DevelopmentResult {
    let image = RawImage {
        plane: &raw.plane,
        black_level_dn: raw.black_level_dn,
        white_level_dn: raw.white_level_dn,
        mosaic: &development.mosaic,
        optical_black: None,
    };
    develop(&image, &development.processing, FrameAddress::default()).expect("the camera's own processing")
}
