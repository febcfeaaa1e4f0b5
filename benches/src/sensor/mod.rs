//! From planes of mean electrons to digital numbers in memory, two megapixels: all noises, all effects, each alone.

mod frame;
mod memory;
mod sensors;

use etendue_bench_rays::clock::{clock_s, cpu_s, timed};
use etendue_bench_rays::runs::RunStatistics;
use etendue_bench_rays::table::Table;
use etendue_bench_rays::threads::pool;
use etendue_core::Plane;
use etendue_core::quantity::MeanElectrons;
use etendue_sensor::Sensor;
use frame::{PIXELS, expose, scene};
use rayon::ThreadPool;
use sensors::{bare, kinds};

pub use memory::{CHILD, child};

const NOTE: &str = "1920 × 1080 px, a ramp of light from none to the full well with a lamp of a hundred wells (48 px wide) in it, \
    from mean electrons to digital numbers in memory. One thread: processor time. Two threads: by the clock, and the \
    processor time of the busier one. Beside: run by run, over the bare converter (one thread). Memory: most of it above \
    the means, the numbers included. \"Described, without strength\" has every effect in its description, at a strength of \
    zero or switched off.";

/// Time and memory of a frame, for all noises, all effects, and each effect alone.
pub fn table() -> Table {
    let head =
        ["sensor", "1 thread, ms", "ns a pixel", "2, clock, ms", "2, busier, ms", "over bare", "spread", "B a pixel"];
    let mut table = Table::new("The sensor", NOTE, &head);
    let pools = [pool(1), pool(2)];
    let means = scene();
    let bare_sensor = Sensor::new(bare()).expect("legal");
    for (name, parameters) in kinds() {
        let sensor = Sensor::new(parameters).expect("a legal sensor");
        table.row(row(name, &SensorMeasurement::measure(&sensor, &bare_sensor, &means, &pools)));
    }
    table
}

fn row(name: &str, m: &SensorMeasurement) -> Vec<String> {
    let ms = |runs: &RunStatistics| format!("{:.0}", runs.median() * 1e3);
    vec![
        name.to_owned(),
        ms(&m.one),
        format!("{:.1}", m.one.median() / PIXELS * 1e9),
        ms(&m.two_clock),
        ms(&m.two_busier),
        format!("{:.3}", m.relative_to_bare.median()),
        m.one.spread_text(),
        memory::bytes_a_pixel(name),
    ]
}

/// What is measured of a sensor.
#[derive(Default)]
struct SensorMeasurement {
    one: RunStatistics,
    two_clock: RunStatistics,
    two_busier: RunStatistics,
    relative_to_bare: RunStatistics,
}

impl SensorMeasurement {
    fn measure(
        sensor: &Sensor,
        bare_sensor: &Sensor,
        means: &Plane<MeanElectrons>,
        [one, two]: &[ThreadPool; 2],
    ) -> Self {
        let mut measured = Self::default();
        for _ in 0..etendue_bench_rays::runs::COUNT {
            let alone = |sensor| one.install(|| timed(|| std::hint::black_box(expose(sensor, means))).1);
            let (before, own, after) = (alone(bare_sensor), alone(sensor), alone(bare_sensor));
            measured.one.add(own);
            measured.relative_to_bare.add(own / (0.5 * (before + after)));
            let (clock, busier) = shared(sensor, means, two);
            measured.two_clock.add(clock);
            measured.two_busier.add(busier);
        }
        measured
    }
}

/// Time of a frame on a pool: by the clock, and the busiest thread's.
fn shared(sensor: &Sensor, means: &Plane<MeanElectrons>, pool: &ThreadPool) -> (f64, f64) {
    let accounts = || pool.broadcast(|_| cpu_s());
    let (start, before) = (clock_s(), accounts());
    pool.install(|| std::hint::black_box(expose(sensor, means)));
    let clock = clock_s() - start;
    let busiest = accounts().iter().zip(&before).map(|(after, before)| after - before).fold(0.0, f64::max);
    (clock, busiest)
}
