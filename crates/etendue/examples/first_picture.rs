//! A first image: the Cornell box from its job file, read in memory and written to a folder.
//!
//! `cargo run --release -p etendue --example first_picture -- out/first`

// A program prints; the library does not.
#![allow(clippy::print_stdout)]

use etendue::{Error, ExistingFiles, JobRequest, NullObserver, RenderOptions};
use std::path::{Path, PathBuf};

/// Renders 16 samples per pixel into `out` and returns the files' paths.
pub(crate) fn run(out: &Path) -> Result<Vec<PathBuf>, Error> {
    let scene = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/cornell/cornell.toml");
    let job = JobRequest { spp: Some(16), ..JobRequest::new(scene) }.open()?;
    let results = job.render(&RenderOptions::default(), &NullObserver)?;
    let front = results.camera("front").expect("the job's camera");

    // Planes are rows of samples from the top left.
    let depth = front.ground_truth().depth;
    let electrons = front.electrons().expect("the camera has electronics");
    let nearest_m = depth.samples().iter().copied().fold(f32::INFINITY, f32::min);
    let max_e = electrons.samples().iter().copied().fold(0.0, f32::max);
    println!("{} × {} px, nearest surface {nearest_m:.3} m, most electrons {max_e:.0}", depth.width(), depth.height());
    for frame in front.frames() {
        println!("raw: {} bits, black {} DN", frame.raw.bits, frame.raw.black_level_dn);
    }

    results.save(out, ExistingFiles::Replace, &NullObserver)
}

fn main() -> Result<(), Error> {
    let out = std::env::args().nth(1).unwrap_or_else(|| "out/first".to_owned());
    run(Path::new(&out))?.iter().for_each(|file| println!("{}", file.display()));
    Ok(())
}
