//! `etendue view`: a result's layers as a page for a browser.

use crate::args::run::{frames, whole};
use crate::browser;
use crate::console::{Console, print_paths};
use clap::Args;
use etendue::{Error, Existing};
use etendue_view::{ViewRequest, view};
use std::path::PathBuf;

/// `etendue view`
#[derive(Debug, Args)]
pub struct View {
    /// A folder of results: all cameras of a run, or one
    #[arg(value_name = "FOLDER")]
    pub folder: PathBuf,
    /// Another result, shown side by side, by a wipe, and as the difference; of the same sizes
    #[arg(long, value_name = "FOLDER")]
    pub beside: Option<PathBuf>,
    /// Frames to show, first to last (the last excluded) [default: all]
    #[arg(long, value_name = "A..B", value_parser = frames)]
    pub frames: Option<std::ops::Range<u32>>,
    /// What the numbers of one layer take at most, MB; larger layers have fewer pixels on the page, by a whole factor
    #[arg(long, value_name = "MB", default_value_t = ViewRequest::MAX_MB, value_parser = whole(1, 1000))]
    pub max_mb: u32,
    /// Folder for the page, or the name of one file that ends in .html and holds everything [default: the folder `view` in FOLDER, where an earlier page is replaced]
    #[arg(short, long, value_name = "DIR|PAGE.html")]
    pub output: Option<PathBuf>,
    /// Replace files that are already there
    #[arg(long)]
    pub overwrite: bool,
    /// Write the page and leave it closed; without a terminal that is so by itself
    #[arg(long)]
    pub no_open: bool,
}

impl From<&View> for ViewRequest {
    fn from(a: &View) -> Self {
        Self { folder: a.folder.clone(), beside: a.beside.clone(), frames: a.frames.clone(), max_mb: a.max_mb }
    }
}

impl View {
    pub fn run(&self, console: &dyn Console) -> Result<(), Error> {
        let existing = if self.overwrite { Existing::Replace } else { Existing::Refuse };
        let page = view(&ViewRequest::from(self), self.output.as_deref(), existing, console.observer())?;
        if !self.no_open && console.is_terminal() && !browser::open(&page) {
            console.tell("no browser could be started; open the page in one\n");
        }
        print_paths(console, &[page]);
        Ok(())
    }
}
