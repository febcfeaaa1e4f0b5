//! What is told of one file, and its lines of text.

use super::preview::Preview;
use super::statistics;
use super::statistics::ChannelReport;
use serde::Serialize;
use std::fmt;
use std::path::{Path, PathBuf};

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
    pub(super) fn new(file: &Path, kind: impl Into<String>) -> Self {
        let (facts, channels, notes) = (Vec::new(), Vec::new(), Vec::new());
        Self { file: file.to_path_buf(), kind: kind.into(), facts, channels, notes, preview: None }
    }

    pub(super) fn state(&mut self, name: &str, value: impl fmt::Display) {
        self.facts.push((name.to_owned(), value.to_string()));
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
