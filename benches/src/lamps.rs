//! A street by night under more and more lamps: what a path costs, and how large its error is.

use crate::scenes::{STREET, camera};
use etendue_bench_rays::clock::timed;
use etendue_bench_rays::runs::RunStatistics;
use etendue_bench_rays::table::Table;
use etendue_bench_rays::threads::pool;
use etendue_pipeline::render::{LightRequest, light, light_counts};
use etendue_pipeline::{NullObserver, Plan};
use rayon::ThreadPool;

const NOTE: &str = "The street without sun and sky, under lamps of all directions spread over 240 × 14 m, 4 to 8 m above \
    the ground, 1 Mlm together. 160 × 100 px, 16 samples a pixel, three seeds, one thread. Error: relative mean square of \
    a pixel, without the worst 0.1 %; the floor of a dark pixel is 1 % of the picture's mean. Times beside: those of ten \
    lamps.";

const COUNTS: [u32; 4] = [10, 100, 1_000, 10_000];
const SMALL: [&str; 3] =
    ["cameras.0.sensor.width_px=160", "cameras.0.sensor.height_px=100", "cameras.0.sensor.pixel_pitch_um=36"];
const SPP: u32 = 16;
const SEEDS: u64 = 3;
const TRIMMED_FRACTION: f64 = 0.001;
const FLOOR: f64 = 0.01;

/// Cost and error against the number of lamps.
pub fn table() -> Table {
    let head = ["lamps", "start, ms", "µs a path", "beside", "relative error²", "beside", "spread of times"];
    let mut table = Table::new("Lamps", NOTE, &head);
    let one = pool(1);
    let measured: Vec<LampMeasurement> =
        COUNTS.iter().map(|count| LampMeasurement::measure(&mut plan(*count), &one)).collect();
    for (count, this) in COUNTS.iter().zip(&measured) {
        table.row(this.row(*count, &measured[0]));
    }
    table
}

/// What is measured under a number of lamps.
struct LampMeasurement {
    start_s: f64,
    path_s: RunStatistics,
    error: f64,
}

impl LampMeasurement {
    fn measure(plan: &mut Plan, pool: &ThreadPool) -> Self {
        let (_, start_s) = timed(|| light_counts(plan, camera(plan)));
        let (mut path_s, mut images) = (RunStatistics::default(), vec![]);
        for seed in 1..=SEEDS {
            let (image, seconds) = rendered(plan, pool, seed);
            path_s.add((seconds - start_s) / (image.len() as f64 * f64::from(SPP)));
            images.push(image);
        }
        Self { start_s, path_s, error: relative_error(&images) }
    }

    fn row(&self, count: u32, first: &Self) -> Vec<String> {
        vec![
            count.to_string(),
            format!("{:.1}", self.start_s * 1e3),
            format!("{:.2}", self.path_s.median() * 1e6),
            format!("{:.2}", self.path_s.median() / first.path_s.median()),
            format!("{:.4}", self.error),
            format!("{:.2}", self.error / first.error),
            self.path_s.spread_text(),
        ]
    }
}

fn plan(lamps: u32) -> Plan {
    let mut plan = STREET.with_scene(&scene(lamps), &SMALL);
    plan.cameras[0].settings.replicates = 1;
    plan
}

/// The street's scene under so many lamps instead of its own light.
fn scene(lamps: u32) -> String {
    // Points of an additive sequence (Roberts 2018): 1/g, 1/g², 1/g³ with g⁴ = g + 1 spread evenly in three dimensions.
    let place = |i: u32| {
        let at = |step: f64| (0.5 + step * f64::from(i)).fract();
        let [x, y, z] = [0.819_172_513_4, 0.671_043_606_7, 0.549_700_477_9].map(at);
        format!("{{ position_m = [{:.3}, {:.3}, {:.3}] }}", 240.0 * x - 60.0, 14.0 * y - 7.0, 4.0 * z + 4.0)
    };
    let places: Vec<String> = (0..lamps).map(place).collect();
    format!(
        "format = 1\nbase = \"scene.toml\"\n[environment]\ntype = \"uniform\"\nluminance_cd_m2 = 0\nilluminant = \"D65\"\n\
         [[lights]]\ntype = \"point\"\nname = \"lamp\"\nilluminant = \"LED-B3\"\nluminous_flux_lm = {}\ninstances = [{}]\n",
        1e6 / f64::from(lamps),
        places.join(", ")
    )
}

/// Electrons a second, and the processor time of the thread, s.
fn rendered(plan: &mut Plan, pool: &ThreadPool, seed: u64) -> (Vec<f32>, f64) {
    let settings = &mut plan.cameras[0].settings;
    (settings.spp, settings.seed) = (SPP, seed);
    let (film, seconds) = pool.install(|| timed(|| light(plan, camera(plan), LightRequest::default(), &NullObserver)));
    let electrons = film.expect("nobody cancels").electron_rate.expect("the street's camera folds electrons");
    (electrons.mean.samples().to_vec(), seconds)
}

/// Mean relative square error of a picture, told by the scatter of independent ones.
fn relative_error(images: &[Vec<f32>]) -> f64 {
    let n = images.len() as f64;
    let mean_of = |i: usize| images.iter().map(|p| f64::from(p[i])).sum::<f64>() / n;
    let means: Vec<f64> = (0..images[0].len()).map(mean_of).collect();
    let floor = FLOOR * means.iter().sum::<f64>() / means.len() as f64;
    let error = |(i, mean): (usize, &f64)| {
        let squares: f64 = images.iter().map(|p| f64::from(p[i]) - mean).map(|d| d * d).sum();
        squares / (n - 1.0) / (mean * mean + floor * floor)
    };
    let mut errors: Vec<f64> = means.iter().enumerate().map(error).collect();
    errors.sort_by(f64::total_cmp);
    let trimmed_count = (errors.len() as f64 * (1.0 - TRIMMED_FRACTION)).ceil() as usize;
    errors[..trimmed_count].iter().sum::<f64>() / trimmed_count as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_error_is_the_scatter_over_the_mean() {
        // Means 2; s² = 2 and 0.
        let error = relative_error(&[vec![1.0, 2.0], vec![3.0, 2.0]]);
        assert!((error - 0.25 / 1.0001).abs() < 1e-4, "{error}");
    }

    #[test]
    fn every_count_of_lamps_is_a_scene() {
        assert_eq!(scene(3).matches("position_m").count(), 3);
    }
}
