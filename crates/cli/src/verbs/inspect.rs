//! `etendue inspect`: content of a file, with units, also as an image.

use crate::console::Console;
use clap::Args;
use etendue::{Error, ErrorCode, ExistingFiles, PreviewSelection, inspect_showing, write_file};
use etendue_arguments::png;
use std::path::{Path, PathBuf};

/// `etendue inspect`
#[derive(Debug, Args)]
pub struct Inspect {
    /// A file that Étendue reads or writes: EXR, PNG, JPEG, HDR, TIFF, DNG, PFM, optical flow (.flo), OBJ, tables (CSV), lights (IES, EULUMDAT), JSON side-car
    #[arg(value_name = "FILE")]
    pub file: PathBuf,
    /// Write its content as an image here
    #[arg(long, value_name = "OUT.png", value_parser = png)]
    pub png: Option<PathBuf>,
    /// Layer of an EXR for the image: a channel, or the part of channel names before the last dot (depth, instance, flow.forward, N)
    #[arg(long, value_name = "NAME", requires = "png")]
    pub layer: Option<String>,
    /// Draw the boxes of a frame's objects on the image
    #[arg(long, value_name = "boxes.NNNN.json", requires = "png")]
    pub boxes: Option<PathBuf>,
}

impl Inspect {
    pub fn run(&self, console: &dyn Console) -> Result<(), Error> {
        let shown = PreviewSelection { layer: self.layer.clone(), boxes: self.boxes.clone() };
        let report = inspect_showing(&self.file, &shown).map_err(Error::input)?;
        if let Some(path) = &self.png {
            if is_same_file(path, &self.file) {
                let message = format!("`png` {}: this is the file itself; choose another name", path.display());
                return Err(Error::argument("png", message));
            }
            let Some(preview) = &report.preview else {
                return Err(Error::coded(
                    ErrorCode::UnsuitableFile,
                    format!("{}: it cannot be shown as an image", self.file.display()),
                ));
            };
            let bytes = preview.to_png().map_err(|error| Error::Run(error.to_string()))?;
            write_file(path, &bytes, ExistingFiles::Replace)?;
            console.print_message(&format!("wrote {}\n", path.display()));
        }
        console.print(&report.to_string());
        Ok(())
    }
}

/// True if two names refer to one existing file.
fn is_same_file(a: &Path, b: &Path) -> bool {
    a.canonicalize().ok().zip(b.canonicalize().ok()).is_some_and(|(a, b)| a == b)
}
