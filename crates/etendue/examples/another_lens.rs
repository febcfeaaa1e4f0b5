//! Another lens on a stored radiance: the light at the entrance pupil is rendered once, then captured with two apertures.
//!
//! `cargo run --release -p etendue --example another_lens -- out/lenses`

// A program prints; the library does not.
#![allow(clippy::print_stdout)]

use etendue::{Error, ExistingFiles, ExposeRequest, JobRequest, NullObserver, RenderOptions, expose};
use std::path::{Path, PathBuf};

/// Writes the radiance and two captures of it into `out`; returns the captures' files.
pub(crate) fn run(out: &Path) -> Result<Vec<PathBuf>, Error> {
    let scenes = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes");
    let mut request = JobRequest { spp: Some(16), ..JobRequest::new(format!("{scenes}/cornell/cornell.toml")) };
    let changes = ["render.route=\"pupil\"", "render.overscan=0.5", "output.radiance=true", "render.band_width_nm=20"];
    request.set = changes.map(str::to_owned).to_vec();
    request.open()?.save(&RenderOptions::default(), &out.join("pupil"), ExistingFiles::Replace, &NullObserver)?;

    let mut captures = Vec::new();
    for f_number in ["2.8", "11"] {
        let radiance = out.join("pupil/front/radiance.exr");
        let mut request = ExposeRequest::new(radiance, format!("{scenes}/cameras/web.toml"));
        request.set = vec![format!("lens.f_number={f_number}"), "sensor.exposure_s=0.02".to_owned()];
        let folder = out.join(format!("f{f_number}"));
        captures.extend(expose(&request, &folder, ExistingFiles::Replace, &NullObserver)?);
    }
    Ok(captures)
}

fn main() -> Result<(), Error> {
    let out = std::env::args().nth(1).unwrap_or_else(|| "out/lenses".to_owned());
    run(Path::new(&out))?.iter().for_each(|file| println!("{}", file.display()));
    Ok(())
}
