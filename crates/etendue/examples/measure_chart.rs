//! A chart, captured and measured: dots in front of a camera; its distortion with uncertainty compared with the camera file.
//!
//! `cargo run --release -p etendue --example measure_chart -- out/chart`

// A program prints; the library does not.
#![allow(clippy::print_stdout)]

use etendue::chart::design::{Dots, GridSize};
use etendue::chart::{Chart, ChartRequest, make};
use etendue::measure::{DistortionRequest, distortion};
use etendue::report::Report;
use etendue::{Error, ExistingFiles, JobRequest, NullObserver, RenderOptions};
use std::path::Path;

/// Makes the chart, captures and measures it in `out`.
pub(crate) fn run(out: &Path) -> Result<Report, Error> {
    let size = GridSize { columns: Some(33), rows: None, pitch_mm: None };
    let chart = Chart::Dots(Dots { size, dot_ratio: 0.5 });
    make(&ChartRequest::new(chart, "automotive"), &out.join("chart"), ExistingFiles::Replace)?;

    let job = JobRequest { spp: Some(4), ..JobRequest::new(out.join("chart/job.toml")) }.open()?;
    job.save(&RenderOptions::default(), &out.join("photo"), ExistingFiles::Replace, &NullObserver)?;
    distortion(&DistortionRequest::new(out.join("photo/camera/picture.0000.png")))
}

fn main() -> Result<(), Error> {
    let out = std::env::args().nth(1).unwrap_or_else(|| "out/chart".to_owned());
    let report = run(Path::new(&out))?;
    println!("{report}");
    for figure in report.figures().iter().filter(|figure| figure.stated) {
        let (value, u) = (figure.value.value, figure.value.standard_uncertainty);
        println!("{} = {value:.5} ± {u:.5} {}", figure.key, figure.unit);
    }
    Ok(())
}
