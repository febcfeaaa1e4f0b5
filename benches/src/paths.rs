//! Paths a second of the scenes that ship with the project: all of the way from the sensor to the film.

use crate::scenes::{ALL, Scene, camera};
use etendue_bench_rays::clock::{clock_s, timed};
use etendue_bench_rays::runs::RunStatistics;
use etendue_bench_rays::table::Table;
use etendue_bench_rays::threads::{busiest, pool};
use etendue_pipeline::render::{LightRequest, light, light_counts};
use etendue_pipeline::{NullObserver, Plan};
use rayon::ThreadPool;

const NOTE: &str = "Small pictures (320 × 200 px of the street with its own field of view, 256 × 256 px of the others). \
    Start: placing the world about the camera and collecting the lights; it is taken off the paths. Speed-up: by a \
    second thread, by the clock (wants an idle machine) and by the processor time of the busier thread.";

/// Runs, for what takes long.
const COUNT: usize = 3;

/// What is measured of a scene.
#[derive(Default)]
struct PathMeasurement {
    /// Processor time of one thread, s.
    one_cpu: RunStatistics,
    /// Time by the clock of one thread, over that of two.
    clock_ratio: RunStatistics,
    /// Processor time of one thread, over that of the busier of two.
    cpu_ratio: RunStatistics,
}

/// Paths a second of all scenes.
pub fn table() -> Table {
    let pools = [pool(1), pool(2)];
    let head = [
        "scene",
        "paths, million",
        "start, ms",
        "µs a path",
        "paths/s",
        "spread",
        "speed-up, clock",
        "speed-up, processor",
    ];
    let mut table = Table::new("Paths", NOTE, &head);
    ALL.iter().for_each(|scene| table.row(row(scene, &pools)));
    table
}

fn row(scene: &Scene, pools: &[ThreadPool; 2]) -> Vec<String> {
    let plan = scene.small_plan();
    let (_, start_s) = timed(|| light_counts(&plan, camera(&plan)));
    let measured = measured(&plan, pools, start_s);
    let (width, height) = camera(&plan).film_size();
    let paths = f64::from(width) * f64::from(height) * f64::from(scene.spp);
    let path_s = measured.one_cpu.median() / paths;
    vec![
        scene.name.to_owned(),
        format!("{:.2}", paths / 1e6),
        format!("{:.1}", start_s * 1e3),
        format!("{:.2}", path_s * 1e6),
        format!("{:.0}", 1.0 / path_s),
        measured.one_cpu.spread_text(),
        format!("{:.2}", measured.clock_ratio.median()),
        format!("{:.2}", measured.cpu_ratio.median()),
    ]
}

/// One thread and two take turns.
fn measured(plan: &Plan, [one, two]: &[ThreadPool; 2], start_s: f64) -> PathMeasurement {
    let mut measured = PathMeasurement::default();
    for _ in 0..COUNT {
        let (one_clock, one_cpu) = rendered(plan, one);
        let (two_clock, two_cpu) = rendered(plan, two);
        measured.one_cpu.add(one_cpu - start_s);
        measured.clock_ratio.add((one_clock - start_s) / (two_clock - start_s));
        // Either thread may have made the start.
        measured.cpu_ratio.add(one_cpu / two_cpu);
    }
    measured
}

/// Time by the clock, and processor time of the busiest thread, of one rendering, s.
fn rendered(plan: &Plan, pool: &ThreadPool) -> (f64, f64) {
    let start = clock_s();
    let (film, cpu) = busiest(pool, || light(plan, camera(plan), LightRequest::default(), &NullObserver));
    let clock = clock_s() - start;
    std::hint::black_box(film.expect("nobody cancels"));
    (clock, cpu)
}
