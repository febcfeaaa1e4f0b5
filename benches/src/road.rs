//! The road ahead by night, dry and wet: lamps' images in a film of water are what paths find by luck.

use crate::scenes::{camera, shipped};
use etendue_bench_rays::clock::timed;
use etendue_bench_rays::runs::RunStatistics;
use etendue_bench_rays::table::Table;
use etendue_bench_rays::threads::pool;
use etendue_pipeline::render::{LightRequest, light, light_counts};
use etendue_pipeline::{NullObserver, Plan};
use rayon::ThreadPool;

const NOTE: &str = "The lane 8 to 23 m ahead in the jobs' own pictures (columns 424 to 536, rows 340 to 420), 64 samples a \
    pixel, eight seeds, one thread. Error: standard error of a pixel's electrons over the box's mean, root mean square over \
    the box, nothing left out; of the means over 16 × 16 px likewise. Brightest: the largest pixel of all seeds over the mean.";

/// What is cut out of the picture of 960 × 600 px, whose optical axis is in its middle.
const BOX: [&str; 5] = [
    "cameras.0.sensor.width_px=112",
    "cameras.0.sensor.height_px=80",
    "cameras.0.sensor.principal_point_px=[56, -40]",
    "render.replicates=1",
    "render.branches=1",
];
const WIDTH: usize = 112;
/// Side of the squares whose means are looked at, px.
const SQUARE: usize = 16;
const SPP: u32 = 64;
const SEEDS: u64 = 8;

/// Cost and error of the street by night and of the wet night.
pub fn table() -> Table {
    let head = ["job", "µs a path", "error", "of 16 × 16 px means", "brightest", "spread of times"];
    let mut table = Table::new("The road by night", NOTE, &head);
    let one = pool(1);
    for (name, job) in [("dry", "street/night.toml"), ("wet", "street/wet-night.toml")] {
        table.row(row(name, &mut shipped(job, &BOX), &one));
    }
    table
}

fn row(name: &str, plan: &mut Plan, pool: &ThreadPool) -> Vec<String> {
    let (_, start_s) = timed(|| light_counts(plan, camera(plan)));
    let (mut path_s, mut images) = (RunStatistics::default(), vec![]);
    for seed in 1..=SEEDS {
        let (image, seconds) = rendered(plan, pool, seed);
        path_s.add((seconds - start_s) / (image.len() as f64 * f64::from(SPP)));
        images.push(image);
    }
    let squares: Vec<Vec<f64>> = images.iter().map(|image| means(image)).collect();
    let mean = images.iter().flatten().sum::<f64>() / images.iter().flatten().count() as f64;
    let brightest = images.iter().flatten().copied().fold(0.0, f64::max);
    vec![
        name.to_owned(),
        format!("{:.2}", path_s.median() * 1e6),
        format!("{:.1} %", 100.0 * error(&images)),
        format!("{:.2} %", 100.0 * error(&squares)),
        format!("{:.0}", brightest / mean),
        path_s.spread_text(),
    ]
}

/// Electrons a second, and the processor time of the thread, s.
fn rendered(plan: &mut Plan, pool: &ThreadPool, seed: u64) -> (Vec<f64>, f64) {
    let settings = &mut plan.cameras[0].settings;
    (settings.spp, settings.seed) = (SPP, seed);
    let (film, seconds) = pool.install(|| timed(|| light(plan, camera(plan), LightRequest::default(), &NullObserver)));
    let electrons = film.expect("nobody cancels").electron_rate.expect("the street's camera folds electrons");
    (electrons.mean.samples().iter().map(|e| f64::from(*e)).collect(), seconds)
}

/// Root mean square of the standard errors of all values, told by the scatter of independent pictures, over their mean.
fn error(images: &[Vec<f64>]) -> f64 {
    let (n, count) = (images.len() as f64, images[0].len() as f64);
    let mean_of = |i: usize| images.iter().map(|p| p[i]).sum::<f64>() / n;
    let means: Vec<f64> = (0..images[0].len()).map(mean_of).collect();
    let square = |image: &Vec<f64>| image.iter().zip(&means).map(|(p, mean)| (p - mean) * (p - mean)).sum::<f64>();
    let variance = images.iter().map(square).sum::<f64>() / (n - 1.0) / count;
    variance.sqrt() / (means.iter().sum::<f64>() / count)
}

/// Means over the squares of a picture.
fn means(image: &[f64]) -> Vec<f64> {
    let columns = WIDTH / SQUARE;
    let mut sums = vec![0.0; columns * (image.len() / WIDTH / SQUARE)];
    for (i, value) in image.iter().enumerate() {
        let (x, y) = (i % WIDTH, i / WIDTH);
        sums[y / SQUARE * columns + x / SQUARE] += value / (SQUARE * SQUARE) as f64;
    }
    sums
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_error_is_the_root_of_the_mean_scatter_over_the_mean() {
        // Means 2 and 2, variances 2 and 0: the root of their mean, 1, over 2.
        assert_eq!(error(&[vec![1.0, 2.0], vec![3.0, 2.0]]), 0.5);
    }

    #[test]
    fn squares_keep_their_places() {
        let image: Vec<f64> = (0..80 * WIDTH).map(|i| f64::from(u8::from(i % WIDTH >= 96 && i / WIDTH < 16))).collect();
        let actual = means(&image);
        assert_eq!(actual.iter().position(|mean| *mean > 0.5), Some(6));
        assert_eq!((actual.len(), actual.iter().sum::<f64>()), (35, 1.0));
    }
}
