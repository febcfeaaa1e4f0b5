//! Writing a spectral image.

use crate::scenes::{STREET, camera};
use etendue_bench_rays::runs::{COUNT, RunStatistics};
use etendue_bench_rays::table::Table;
use etendue_bench_rays::threads::{busiest, pool};
use etendue_core::SpectralCube;
use etendue_core::quantity::Radiance;
use etendue_io::Provenance;
use etendue_io::exr::encode_spectral;
use etendue_pipeline::NullObserver;
use etendue_pipeline::render::{LightRequest, light};

const NOTE: &str = "Radiance of a small picture of the street (a noisy one: it compresses badly), without its variance, \
    encoded into memory. MB: floating-point numbers before compression. Processor time of one thread, and of the busier of two.";

/// Speed of the encoder.
pub fn table() -> Table {
    let cube = radiance();
    let encoded = || encode_spectral(&cube, None, &Provenance::default()).expect("a legal image").len();
    let [mut one, mut two] = [RunStatistics::default(), RunStatistics::default()];
    let pools = [pool(1), pool(2)];
    let mut length = 0;
    for _ in 0..COUNT {
        for (runs, pool) in [&mut one, &mut two].into_iter().zip(&pools) {
            let (bytes, seconds) = busiest(pool, encoded);
            length = bytes;
            runs.add(seconds);
        }
    }
    let mb = (cube.bands().count() * cube.width() * cube.height() * size_of::<f32>()) as f64 / 1e6;
    let head = ["bands", "MB", "MB of the file", "1 thread, ms", "MB/s", "2, busier, ms", "spread"];
    let mut table = Table::new("Spectral EXR", NOTE, &head);
    table.row([
        cube.bands().count().to_string(),
        format!("{mb:.1}"),
        format!("{:.1}", length as f64 / 1e6),
        format!("{:.0}", one.median() * 1e3),
        format!("{:.1}", mb / one.median()),
        format!("{:.0}", two.median() * 1e3),
        one.spread_text(),
    ]);
    table
}

fn radiance() -> SpectralCube<Radiance> {
    let plan = STREET.small_plan();
    let film = light(&plan, camera(&plan), LightRequest::default(), &NullObserver).expect("nobody cancels");
    film.radiance().expect("the street keeps radiance").mean
}
