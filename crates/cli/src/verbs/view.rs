//! `etendue view`: a result's layers as a page for a browser.

use crate::browser;
use crate::console::{Console, print_paths};
use clap::Args;
use etendue::{Error, ExistingFiles};
use etendue_view::{ViewRequest, view};
use std::path::PathBuf;

/// `etendue view`
#[derive(Debug, Args)]
pub struct View {
    #[command(flatten)]
    pub request: ViewRequest,
    /// Folder for the page, or the name of one file that ends in .html and contains everything [default: the folder `view` in FOLDER, where an existing
    /// page is replaced]
    #[arg(short, long, value_name = "DIR|PAGE.html")]
    pub output: Option<PathBuf>,
    /// Replace existing files
    #[arg(long)]
    pub overwrite: bool,
    /// Write the page without opening it; this is the default without a terminal
    #[arg(long)]
    pub no_open: bool,
}

impl View {
    pub fn run(&self, console: &dyn Console) -> Result<(), Error> {
        let existing = if self.overwrite { ExistingFiles::Replace } else { ExistingFiles::Refuse };
        let page = view(&self.request, self.output.as_deref(), existing, console.observer())?;
        if !self.no_open && console.is_terminal() && !browser::open(&page) {
            console.print_message("no browser could be started; open the page manually\n");
        }
        print_paths(console, &[page]);
        Ok(())
    }
}
