//! What is in a file, with units, and a picture of it.
//!
//! Any EXR, PNG, JPEG, HDR, TIFF, DNG, OBJ, side-car JSON, CSV of spectra, refractive indices or retro-reflection, and measured lamp (IES, EULUMDAT). Statistics leave out values that are not finite and
//! count them.

mod exr;
mod lamp;
mod picture;
mod preview;
mod statistics;
mod text;
mod tiff;

use std::fmt;
use std::path::{Path, PathBuf};

use serde::Serialize;

pub use lamp::passing_beam;
pub use preview::Preview;
pub use statistics::ChannelReport;

use crate::Error;
use crate::photograph::is_tiff;
use crate::picture::EXR_MAGIC;
use crate::source::read_bytes;

/// What is in a file.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FileReport {
    /// The file.
    pub file: PathBuf,
    /// What it is, in words.
    pub kind: String,
    /// Facts in reading order: name and value with its unit.
    pub facts: Vec<(String, String)>,
    /// Channels with their statistics.
    pub channels: Vec<ChannelReport>,
    /// What is odd, assumed or not used, in sentences.
    pub notes: Vec<String>,
    /// A picture of it, where one can be made.
    #[serde(skip)]
    pub preview: Option<Preview>,
}

impl FileReport {
    fn new(file: &Path, kind: impl Into<String>) -> Self {
        let (facts, channels, notes) = (Vec::new(), Vec::new(), Vec::new());
        Self { file: file.to_path_buf(), kind: kind.into(), facts, channels, notes, preview: None }
    }

    fn state(&mut self, name: &str, value: impl fmt::Display) {
        self.facts.push((name.to_owned(), value.to_string()));
    }
}

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

impl fmt::Display for FileReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{}: {}", self.file.display(), self.kind)?;
        let widest = self.facts.iter().map(|(name, _)| name.len()).max().unwrap_or(0);
        for (name, value) in &self.facts {
            writeln!(f, "  {name:widest$}  {value}")?;
        }
        if !self.channels.is_empty() {
            writeln!(f, "{}", statistics::heading(&self.channels))?;
        }
        for channel in &self.channels {
            writeln!(f, "{}", channel.line(statistics::widest(&self.channels)))?;
        }
        self.notes.iter().try_for_each(|note| writeln!(f, "  note: {note}"))
    }
}
