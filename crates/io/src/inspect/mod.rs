//! What is in a file, with units, and a picture of it.
//!
//! Any EXR, PNG, JPEG, HDR, TIFF, DNG, OBJ, side-car JSON, CSV of spectra, refractive indices or retro-reflection, and measured lamp (IES, EULUMDAT). Statistics leave out values that are not finite and
//! count them.

mod exr;
mod lamp;
mod picture;
mod preview;
mod report;
mod statistics;
mod text;
mod tiff;

use crate::Error;
use crate::photograph::is_tiff;
use crate::picture::EXR_MAGIC;
use crate::source::read_bytes;
use std::path::Path;

pub use lamp::passing_beam;
pub use preview::Preview;
pub use report::FileReport;
pub use statistics::ChannelReport;

/// Looks into `file`.
pub fn inspect(file: &Path) -> Result<FileReport, Error> {
    let bytes = read_bytes(file, "result or asset")?;
    let extension = file.extension().unwrap_or_default().to_ascii_lowercase();
    match extension.to_str() {
        _ if bytes.starts_with(&EXR_MAGIC) => exr::report(file, &bytes),
        Some("obj") => text::mesh(file),
        Some("json") => text::sidecar(file, &bytes),
        Some("ies" | "ldt") => lamp::report(file),
        Some("csv") => text::table(file, &bytes),
        Some("toml") => {
            Err(Error::new(file, "a description, neither result nor asset; `etendue plan` says what a job describes"))
        }
        _ if is_tiff(&bytes) => tiff::report(file, &bytes),
        _ => picture::report(file, &bytes),
    }
}
