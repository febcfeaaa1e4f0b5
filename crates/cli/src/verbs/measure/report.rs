//! Output of a report, printed and as files.

use crate::console::Console;
use clap::Args;
use etendue::page::report_page;
use etendue::report::Report;
use etendue::{Error, ExistingFiles, write_file};
use etendue_arguments::{html, svg, toml};
use std::path::PathBuf;

/// Output of results.
#[derive(Debug, Args)]
pub struct ReportArgs {
    /// Print JSON
    #[arg(long)]
    pub json: bool,
    /// Draw the curves here; an existing drawing is replaced
    #[arg(long, value_name = "FILE.svg", value_parser = svg)]
    pub plot: Option<PathBuf>,
    /// Write results, tables, curves and notes as one page for a browser; an existing page is replaced
    #[arg(long, value_name = "FILE.html", value_parser = html)]
    pub html: Option<PathBuf>,
}

impl ReportArgs {
    /// Prints a report and draws its plots.
    pub fn show(&self, console: &dyn Console, report: &Report) -> Result<(), Error> {
        if let Some(file) = &self.plot {
            write_file(file, report.svg()?.as_bytes(), ExistingFiles::Replace)?;
        }
        if let Some(file) = &self.html {
            write_file(file, console.spelled(&report_page(report)).as_bytes(), ExistingFiles::Replace)?;
        }
        match self.json {
            true => console.print_json(&console.spelled(&format!("{:#}\n", report.json()))),
            false => console.print(&console.spelled(&report.to_string())),
        }
        Ok(())
    }
}

/// Camera file written from a measurement.
#[derive(Debug, Default, Args)]
pub struct CameraOut {
    /// Write the results as keys of a camera file
    #[arg(id = "camera_keys", long = "camera-out", value_name = "CAMERA.toml", value_parser = toml)]
    pub camera_out: Option<PathBuf>,
    /// Replace an existing camera file
    #[arg(long, requires = "camera_keys")]
    pub overwrite: bool,
}

impl CameraOut {
    /// Writes the keys of a camera file in a report, if requested.
    pub fn write(&self, report: &Report) -> Result<(), Error> {
        let Some((file, keys)) = self.camera_out.as_ref().zip(report.camera_keys()) else { return Ok(()) };
        let existing = if self.overwrite { ExistingFiles::Replace } else { ExistingFiles::Refuse };
        write_file(file, keys.as_bytes(), existing)
    }
}
