//! Content of a file, with units, and an image of it.
//!
//! Supports any EXR, PNG, JPEG, HDR, TIFF, DNG, PFM, optical flow (.flo, KITTI), OBJ, side-car JSON, CSV of spectra, refractive indices or retro-reflection,
//! and measured lamp (IES, EULUMDAT). Statistics exclude values that are not finite and count them separately.

mod boxes;
mod drawing;
mod exr;
mod flow;
mod lamp;
mod layer;
mod picture;
mod report;
mod text;
mod tiff;

use std::path::{Path, PathBuf};

use crate::correspondence::{is_flo, is_kitti_flow};
use crate::photograph::{is_pfm, is_tiff};
use crate::source::{read_bytes, read_description_bytes};
use crate::{Error, ErrorCode, picture::EXR_MAGIC};

pub use boxes::{Boxes, read_boxes};
pub use drawing::{ObjectBox, VIRIDIS, flow_wheel, identity_colour};
pub use lamp::passing_beam;
pub use report::{ChannelReport, FileReport, Preview};

/// Content of the preview image, if the file allows a choice.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct PreviewSelection {
    /// The layer of an EXR: a channel's full name, or the common part of several channel names before the last dot (`flow.forward`, `N`, `instance`). `None`:
    /// its colours, else depth, flow or the first channel.
    pub layer: Option<String>,
    /// File of boxes (`boxes.0000.json`) drawn over the image.
    pub boxes: Option<PathBuf>,
}

/// Inspects `file`.
///
/// # Errors
/// If it is missing, damaged, or of an unknown kind.
pub fn inspect(file: &Path) -> Result<FileReport, Error> {
    inspect_showing(file, &PreviewSelection::default())
}

/// Inspects `file`, with the requested preview.
///
/// # Errors
/// As [`inspect()`]; if there is no such layer, or the boxes do not fit the image.
pub fn inspect_showing(file: &Path, shown: &PreviewSelection) -> Result<FileReport, Error> {
    let mut report = report(file, shown.layer.as_deref())?;
    if let Some(file) = &shown.boxes {
        boxes::draw(&mut report, file)?;
    }
    Ok(report)
}

fn report(file: &Path, layer: Option<&str>) -> Result<FileReport, Error> {
    let is_json = file.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("json"));
    let bytes = match is_json {
        true => read_description_bytes(file, "side-car")?,
        false => read_bytes(file, "result or asset")?,
    };
    if bytes.starts_with(&EXR_MAGIC) {
        return exr::report(file, &bytes, layer);
    }
    if let Some(layer) = layer {
        return Err(Error::coded(
            ErrorCode::UnsupportedFile,
            file,
            format!("not an EXR file; only EXR files have layers such as \"{layer}\": omit the layer"),
        ));
    }
    let extension = file.extension().unwrap_or_default().to_ascii_lowercase();
    match extension.to_str() {
        Some("obj" | "glb" | "gltf" | "ply" | "stl") => text::mesh(file),
        Some("json") => text::sidecar(file, &bytes),
        Some("ies" | "ldt") => lamp::report(file),
        Some("csv") => text::table(file, &bytes),
        Some("toml") => Err(Error::coded(
            ErrorCode::UnsupportedFile,
            file,
            "a description, neither a result nor an asset; `etendue plan` reports what a job describes",
        )),
        _ if is_flo(&bytes) => flow::middlebury(file, &bytes),
        _ if is_kitti_flow(&bytes) => flow::kitti(file, &bytes),
        _ if is_pfm(&bytes) => flow::float_map(file, &bytes),
        _ if is_tiff(&bytes) => tiff::report(file, &bytes),
        _ => picture::report(file, &bytes),
    }
}
