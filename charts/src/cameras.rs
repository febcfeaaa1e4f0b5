//! The reference cameras, and where their files lie.

use crate::program::{Program, text, words};
use std::path::{Path, PathBuf};

/// A stand-in and what its charts need.
#[derive(Clone, Copy, Debug)]
pub(crate) struct StandIn {
    /// Of its folder in charts/ and of its file in scenes/cameras/.
    pub(crate) name: &'static str,
    /// Colour filters, where pixels have colours.
    pub(crate) filters: Option<&'static str>,
    /// Columns of the dot chart. Their distance must be no near multiple of the mosaic's period (or of a pixel): else the errors of
    /// neighbouring dots are alike, drift slowly over the field and pass for distortion.
    pub(crate) dot_columns: u32,
    /// The longest exposure of the photon transfer, short enough that dark current adds nothing to the offsets' pattern.
    pub(crate) transfer_exposure_s: f64,
    /// The longest exposure of the dark current's series.
    pub(crate) dark_exposure_s: f64,
}

pub(crate) const CAMERAS: [StandIn; 3] = [
    StandIn { name: "ccd-mono", filters: None, dot_columns: 30, transfer_exposure_s: 1e-3, dark_exposure_s: 40.0 },
    StandIn {
        name: "ccd-bayer",
        filters: Some("RGGB"),
        dot_columns: 30,
        transfer_exposure_s: 1e-3,
        dark_exposure_s: 40.0,
    },
    StandIn { name: "web", filters: Some("GRBG"), dot_columns: 31, transfer_exposure_s: 5e-4, dark_exposure_s: 4.0 },
];

/// A stand-in on the bench.
pub(crate) struct Bench<'a> {
    pub(crate) program: &'a Program,
    pub(crate) camera: StandIn,
    /// Of renders and reports.
    pub(crate) folder: PathBuf,
    /// Of plots.
    pub(crate) pictures: PathBuf,
}

impl Bench<'_> {
    /// A camera file of the stand-in: camera, quiet, middle.
    pub(crate) fn file(&self, which: &str) -> PathBuf {
        PathBuf::from(format!("charts/{}/{which}.toml", self.camera.name))
    }

    /// `--channel` of the raw readings of green, where pixels have colours.
    pub(crate) fn green(&self) -> Vec<String> {
        if self.camera.filters.is_some() { words("--channel green") } else { Vec::new() }
    }

    /// A chart drawn for a camera file: its folder.
    pub(crate) fn chart(&self, chart: &str, file: &str, options: &str) -> Result<PathBuf, String> {
        let to = self.folder.join(chart);
        self.drawn(&to, chart, &self.file(file), options)?;
        Ok(to)
    }

    fn drawn(&self, to: &Path, chart: &str, camera: &Path, options: &str) -> Result<(), String> {
        let camera = [words("--camera"), vec![text(camera)]].concat();
        let out = vec!["-o".to_owned(), text(to)];
        self.program.run(&[words("chart"), words(chart), camera, words(options), out].concat()).map(drop)
    }

    /// A chart drawn and photographed: its folder; pictures are in render/camera.
    pub(crate) fn photographed(&self, chart: &str, file: &str, options: &str, samples: u32) -> Result<PathBuf, String> {
        let to = self.folder.join(chart);
        self.photograph(&to, chart, &self.file(file), options, samples)?;
        Ok(to)
    }

    /// The same into a folder, by any camera file.
    pub(crate) fn photograph(
        &self,
        to: &Path,
        chart: &str,
        camera: &Path,
        options: &str,
        samples: u32,
    ) -> Result<(), String> {
        self.drawn(to, chart, camera, options)?;
        let job = vec!["render".to_owned(), text(&to.join("job.toml")), "-o".to_owned(), text(&to.join("render"))];
        let settings = words(&format!("--set render.spp={samples} --set output.ground_truth=false"));
        self.program.run(&[job, settings].concat()).map(drop)
    }

    /// The plot of a section, as the page names it.
    pub(crate) fn plot(&self, section: &str) -> (PathBuf, String) {
        let name = format!("validation-{}-{section}.svg", self.camera.name);
        (self.pictures.join(&name), format!("\n![{section}](pictures/{name})\n"))
    }
}
