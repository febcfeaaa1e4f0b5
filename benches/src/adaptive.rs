//! Samples where the sensor's noise asks for them, against as many everywhere: what is saved at equal quality of the raw picture.

use crate::scenes::{camera, shipped};
use etendue_bench_rays::clock::process_cpu_s;
use etendue_bench_rays::table::Table;
use etendue_pipeline::render::{LightRequest, light};
use etendue_pipeline::{NullObserver, Plan};

const NOTE: &str = "Five scenes in 320 × 200 px (the Cornell box as it is), by `noise_threshold` and by as many samples everywhere as its mean, four \
    seeds each. Left: the root of the variance of a pixel's electrons by its scatter over the seeds, over the variance that the sensor has there, mean over pixels that are not \
    white. Saved: what is left by even samples (as a variance) over what is left by the others, times the ratio of their processor times: how many times longer even samples take to the same \
    mean quality, and for 90, 95 and 99 % of the squares of 8 × 8 px to have it.";

const SEEDS: u64 = 4;
/// Side of the squares whose noise is looked at, px.
const SQUARE: usize = 8;
/// Parts of the squares.
const PARTS: [f64; 3] = [0.9, 0.95, 0.99];

/// A small picture of the street's camera.
const SMALL: [&str; 5] = [
    "cameras.0.sensor.width_px=320",
    "cameras.0.sensor.height_px=200",
    "cameras.0.sensor.pixel_pitch_um=18",
    "cameras.0.sensor.full_well_e=48000",
    "render.replicates=8",
];

/// Name, job, limit of noise, samples at least and at most, changes beside those of all.
type Row = (&'static str, &'static str, f64, [u32; 2], &'static [&'static str]);

const ROWS: [Row; 5] = [
    ("Cornell box", "cornell/cornell.toml", 8.0, [16, 512], &["render.replicates=8"]),
    ("street", "street/street.toml", 1.0, [16, 256], &["cameras.0.sensor.gain_dn_per_e=0.0825"]),
    ("sunset", "street/sunset.toml", 1.0, [16, 256], &["cameras.0.sensor.gain_dn_per_e=0.0825"]),
    ("night", "street/night.toml", 3.0, [32, 512], &["cameras.0.sensor.gain_dn_per_e=0.65"]),
    ("fog", "weather/fog.toml", 2.0, [16, 128], &["cameras.0.sensor.gain_dn_per_e=0.0825"]),
];

/// What adaptive sampling saves, scene by scene.
pub fn table() -> Table {
    let head = [
        "scene",
        "limit",
        "mean samples",
        "left, even",
        "left, adaptive",
        "saved in the mean",
        "for 90 %",
        "for 95 %",
        "for 99 %",
    ];
    let mut table = Table::new("Samples by the sensor's noise", NOTE, &head);
    ROWS.iter().for_each(|row| table.row(measured(row)));
    table
}

fn measured((name, job, limit, [least, most], changes): &Row) -> Vec<String> {
    let small: &[&str] = if job.starts_with("cornell") { &[] } else { &SMALL };
    let plan_with = |samples: &[String]| {
        let samples = samples.iter().map(String::as_str);
        shipped(job, &small.iter().chain(*changes).copied().chain(samples).collect::<Vec<_>>())
    };
    let limits =
        [("noise_threshold", limit.to_string()), ("min_spp", least.to_string()), ("max_spp", most.to_string())];
    let limits = limits.map(|(key, value)| format!("render.{key}={value}"));
    let adaptive = SeedImages::render(&mut plan_with(&[&["render.spp=null".to_owned()], &limits[..]].concat()));
    let spp = ((adaptive.mean_samples / 8.0).round() as u32 * 8).max(8);
    let uniform_samples = SeedImages::render(&mut plan_with(&[format!("render.spp={spp}")]));
    let (adaptive_left, uniform_left) = (adaptive.left(), uniform_samples.left());
    let saving = |uniform_left: f64, left: f64| uniform_left / left * uniform_samples.seconds / adaptive.seconds;
    let (even_mean, mean) = (mean_of(&uniform_left), mean_of(&adaptive_left));
    let quantiles = PARTS.map(|part| saving(quantile(&uniform_left, part), quantile(&adaptive_left, part)));
    let cells = [
        (*name).to_owned(),
        format!("{limit}"),
        format!("{:.0}", adaptive.mean_samples),
        format!("{:.2}", even_mean.sqrt()),
        format!("{:.2}", mean.sqrt()),
        format!("{:.2}", saving(even_mean, mean)),
    ];
    cells.into_iter().chain(quantiles.map(|saving| format!("{saving:.2}"))).collect()
}

/// The same picture by several seeds.
struct SeedImages {
    width: usize,
    /// Mean electrons of each pixel, picture by picture.
    electrons: Vec<Vec<f64>>,
    /// The sensor's variance of each pixel, e⁻²; `None` of one that is white.
    sensor_e2: Vec<Option<f64>>,
    mean_samples: f64,
    /// Processor time of all pictures, s.
    seconds: f64,
}

impl SeedImages {
    fn render(plan: &mut Plan) -> Self {
        let sensor = plan.cameras[0].body.sensor.as_ref().expect("a camera with electronics");
        let noise = sensor.temporal_noise();
        let (mut electrons, mut samples, mut width) = (Vec::new(), 0.0, 0);
        let from_s = process_cpu_s();
        for seed in 1..=SEEDS {
            plan.cameras[0].settings.seed = seed;
            let film = light(plan, camera(plan), LightRequest::default(), &NullObserver).expect("nobody cancels");
            let rate = film.electron_rate.expect("electrons are folded").mean;
            width = rate.width();
            electrons.push(rate.samples().iter().map(|e| f64::from(*e) * noise.exposure_s()).collect::<Vec<f64>>());
            let all: u64 = film.samples.samples().iter().map(|n| u64::from(*n)).sum();
            samples += all as f64 / (rate.samples().len() as f64 * SEEDS as f64);
        }
        let seconds = process_cpu_s() - from_s;
        let mean = |i: usize| electrons.iter().map(|image| image[i]).sum::<f64>() / SEEDS as f64;
        let pixel_variance =
            |i: usize| Some(mean(i)).filter(|mean| *mean < noise.white_e()).map(|mean| noise.variance_e2(mean));
        let sensor_e2 = (0..electrons[0].len()).map(pixel_variance).collect();
        Self { width, electrons, sensor_e2, mean_samples: samples, seconds }
    }

    /// What is left in each square: variance by scatter over that of the sensor, mean over its pixels that are not white.
    fn left(&self) -> Vec<f64> {
        let columns = self.width.div_ceil(SQUARE);
        let rows = (self.sensor_e2.len() / self.width).div_ceil(SQUARE);
        let mut squares = vec![(0.0, 0.0); columns * rows];
        for (i, sensor_e2) in self.sensor_e2.iter().enumerate() {
            let Some(sensor_e2) = sensor_e2 else { continue };
            let square = &mut squares[i / self.width / SQUARE * columns + i % self.width / SQUARE];
            *square = (square.0 + self.scatter_e2(i) / sensor_e2, square.1 + 1.0);
        }
        squares.into_iter().filter(|(_, count)| *count > 0.0).map(|(sum, count)| sum / count).collect()
    }

    /// The variance of a pixel over the pictures.
    fn scatter_e2(&self, i: usize) -> f64 {
        let mean = self.electrons.iter().map(|image| image[i]).sum::<f64>() / SEEDS as f64;
        let squares = self.electrons.iter().map(|image| (image[i] - mean) * (image[i] - mean));
        squares.sum::<f64>() / (SEEDS - 1) as f64
    }
}

fn mean_of(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// What this part of the values lies below.
fn quantile(values: &[f64], part: f64) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted[((sorted.len() - 1) as f64 * part).round() as usize]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_left_is_scatter_over_the_sensors_in_squares() {
        // Two squares side by side: scatter 1 over 4, and 0; white pixels are left out.
        let width = 2 * SQUARE;
        let image_of = |k: u64| {
            let electrons_at =
                |i: usize| if i % width < SQUARE { if k.is_multiple_of(2) { 9.0 } else { 11.0 } } else { 5.0 };
            (0..width * SQUARE).map(electrons_at).collect::<Vec<f64>>()
        };
        let sensor_e2 = (0..width * SQUARE).map(|i| (i != 0).then_some(4.0)).collect();
        let electrons = (0..SEEDS).map(image_of).collect();
        let images = SeedImages { width, electrons, sensor_e2, mean_samples: 1.0, seconds: 1.0 };
        // Four numbers ± 1: Σ 4/3.
        let left = images.left();
        assert!((left[0] - 1.0 / 3.0).abs() < 1e-12 && left[1] == 0.0 && left.len() == 2, "{left:?}");
        assert!((mean_of(&left) - 1.0 / 6.0).abs() < 1e-12);
        assert_eq!(quantile(&[3.0, 1.0, 2.0], 0.5), 2.0);
    }
}
