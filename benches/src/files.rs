//! Writing a spectral image.

use crate::clock::timed;
use crate::runs::Runs;
use crate::scenes::{STREET, camera};
use crate::table::Table;
use etendue_core::SpectralCube;
use etendue_core::quantity::Radiance;
use etendue_io::Provenance;
use etendue_io::exr::encode_spectral;
use etendue_pipeline::Unobserved;
use etendue_pipeline::render::{Request, light};

const NOTE: &str = "Radiance of a small picture of the street (a noisy one: it compresses badly), without its variance, \
    encoded into memory. MB: floating-point numbers before compression. One thread.";

/// Speed of the encoder.
pub fn table() -> Table {
    let cube = radiance();
    let mut length = 0;
    let runs = Runs::of(|| {
        let (bytes, seconds) = timed(|| encode_spectral(&cube, None, &Provenance::default()));
        length = bytes.expect("a legal image").len();
        seconds
    });
    let mb = (cube.bands().count() * cube.width() * cube.height() * size_of::<f32>()) as f64 / 1e6;
    let mut table = Table::new("Spectral EXR", NOTE, &["bands", "MB", "MB of the file", "ms", "MB/s", "spread"]);
    table.row([
        cube.bands().count().to_string(),
        format!("{mb:.1}"),
        format!("{:.1}", length as f64 / 1e6),
        format!("{:.0}", runs.median() * 1e3),
        format!("{:.1}", mb / runs.median()),
        runs.spread_text(),
    ]);
    table
}

fn radiance() -> SpectralCube<Radiance> {
    let plan = STREET.small_plan();
    let film = light(&plan, camera(&plan), Request::default(), &Unobserved).expect("nobody cancels");
    film.radiance().expect("the street keeps radiance").mean
}
