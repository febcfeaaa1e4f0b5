//! The reference cameras, and where their files lie.

use crate::run::Warnings;
use etendue::chart::{Chart, ChartRequest, make};
use etendue::{Error, ExistingFiles, JobRequest, RenderOptions};
use std::path::PathBuf;

/// A reference camera and what its charts need.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ReferenceCamera {
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

pub(crate) const CAMERAS: [ReferenceCamera; 3] = [
    ReferenceCamera {
        name: "ccd-mono",
        filters: None,
        dot_columns: 30,
        transfer_exposure_s: 1e-3,
        dark_exposure_s: 40.0,
    },
    ReferenceCamera {
        name: "ccd-bayer",
        filters: Some("RGGB"),
        dot_columns: 30,
        transfer_exposure_s: 1e-3,
        dark_exposure_s: 40.0,
    },
    ReferenceCamera {
        name: "web",
        filters: Some("GRBG"),
        dot_columns: 31,
        transfer_exposure_s: 5e-4,
        dark_exposure_s: 4.0,
    },
];

/// A reference camera on the bench.
pub(crate) struct Bench {
    pub(crate) camera: ReferenceCamera,
    /// Of renders and reports.
    pub(crate) folder: PathBuf,
    /// Of plots.
    pub(crate) pictures: PathBuf,
}

impl Bench {
    /// A camera file of the reference camera: camera, quiet, middle.
    pub(crate) fn file(&self, which: &str) -> PathBuf {
        PathBuf::from(format!("charts/{}/{which}.toml", self.camera.name))
    }

    /// The channel of the raw readings of green, where pixels have colours.
    pub(crate) fn green(&self) -> Option<String> {
        self.camera.filters.map(|_| "green".to_owned())
    }

    /// A chart for a camera file of the reference camera.
    pub(crate) fn request(&self, chart: Chart, file: &str) -> ChartRequest {
        ChartRequest::new(chart, self.file(file).display().to_string())
    }

    /// A chart drawn into a folder of the bench.
    pub(crate) fn drawn(&self, name: &str, request: &ChartRequest) -> Result<PathBuf, Error> {
        let folder = self.folder.join(name);
        make(request, &folder, ExistingFiles::Refuse)?;
        Ok(folder)
    }

    /// A chart drawn and photographed: its folder; pictures are in render/camera.
    pub(crate) fn photographed(&self, name: &str, request: &ChartRequest, samples: u32) -> Result<PathBuf, Error> {
        let folder = self.drawn(name, request)?;
        let mut job = JobRequest::new(folder.join("job.toml"));
        job.set = vec![format!("render.spp={samples}"), "output.ground_truth=false".to_owned()];
        job.open()?.save(&RenderOptions::default(), &folder.join("render"), ExistingFiles::Refuse, &Warnings)?;
        Ok(folder)
    }

    /// The plot of a section, as the page names it.
    pub(crate) fn plot(&self, section: &str) -> (PathBuf, String) {
        let name = format!("validation-{}-{section}.svg", self.camera.name);
        (self.pictures.join(&name), format!("\n![{section}](pictures/{name})\n"))
    }
}
