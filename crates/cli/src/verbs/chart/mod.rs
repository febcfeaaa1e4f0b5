//! `etendue chart`: a chart as a scene ready to render, with reference data. The closed list, each chart with its own options.

mod options;

use crate::console::Console;
use crate::subcommands::subcommands;
use clap::Args;
use etendue::Error;
use etendue::chart::{ChartRequest, design};
use options::{Common, Edge, RETRO_LIGHTING, Series, Size, Views};

/// `etendue chart`
#[derive(Debug, Args)]
pub struct Chart {
    #[command(subcommand)]
    pub design: Design,
}

impl Chart {
    pub fn run(&self, console: &dyn Console) -> Result<(), Error> {
        self.design.run(console)
    }
}

subcommands! {
    /// The charts.
    Design:
    /// Black dots over the whole field: focal length, distortion, chromatic displacement (ISO 17850, ISO 19084)
    Dots(Dots),
    /// A checkerboard, fully in view: calibration
    Checkerboard(Checkerboard),
    /// Circles in a square or a staggered lattice, fully in view: calibration
    Circles(Circles),
    /// A uniform white sheet in uniform illumination: vignetting, shading, photon transfer (ISO 17957, EMVA 1288)
    FlatField(FlatField),
    /// A luminous panel in the dark, with a series of exposures: tone curve, photon transfer
    Backlit(Backlit),
    /// Squares turned by a small angle over the field: spatial frequency response by position and direction (ISO 12233)
    SlantedEdges(SlantedEdges),
    /// Stars of slanted wedges: spatial frequency response in many directions (ISO 12233)
    SlantedStar(SlantedStar),
    /// A star of many cycles: modulation over spatial frequency (ISO 12233)
    SiemensStar(SiemensStar),
    /// Overlapping discs with the statistics of natural scenes: texture loss (ISO 19567-2)
    DeadLeaves(DeadLeaves),
    /// Grey steps around a ring: opto-electronic conversion function (ISO 14524)
    OecfSteps(OecfSteps),
    /// The 24 patches of the ColorChecker by their measured spectra: colour error
    Colorchecker(ColorChecker),
    /// Luminous grey patches over several decades: contrast detection probability
    ContrastPatches(ContrastPatches),
    /// A white field with light traps: veiling glare (ISO 18844)
    Flare(Flare),
    /// Pulsed lights of several frequencies and duty cycles, in the dark: LED flicker (IEEE P2020)
    LedFlicker(LedFlicker),
    /// Small lights in the dark: point-spread function, chromatic displacement
    Points(Points),
    /// A staircase and a slanted plane with texture at known distances: depth
    DepthWedge(DepthWedge),
}

/// `etendue chart dots`
#[derive(Debug, Args)]
pub struct Dots {
    #[command(flatten)]
    pub size: Size,
    /// Diameter of a dot over the distance between centres
    #[arg(long, value_name = "FRACTION", default_value_t = 0.5, allow_negative_numbers = true)]
    pub dot_ratio: f64,
    #[command(flatten)]
    pub views: Views,
    #[command(flatten)]
    pub common: Common,
}

impl Dots {
    pub fn run(&self, console: &dyn Console) -> Result<(), Error> {
        let chart = design::Dots { size: self.size.grid(), dot_ratio: self.dot_ratio };
        self.common.make(console, &self.views.apply_to(self.common.request(chart.into())))
    }
}

/// `etendue chart checkerboard`
#[derive(Debug, Args)]
pub struct Checkerboard {
    #[command(flatten)]
    pub size: Size,
    #[command(flatten)]
    pub views: Views,
    #[command(flatten)]
    pub common: Common,
}

impl Checkerboard {
    pub fn run(&self, console: &dyn Console) -> Result<(), Error> {
        let chart = design::Checkerboard { size: self.size.grid() };
        self.common.make(console, &self.views.apply_to(self.common.request(chart.into())))
    }
}

/// `etendue chart circles`
#[derive(Debug, Args)]
pub struct Circles {
    #[command(flatten)]
    pub size: Size,
    /// A staggered lattice: every other cell of each row holds a circle
    #[arg(long)]
    pub asymmetric: bool,
    #[command(flatten)]
    pub views: Views,
    #[command(flatten)]
    pub common: Common,
}

impl Circles {
    pub fn run(&self, console: &dyn Console) -> Result<(), Error> {
        let chart = design::Circles { size: self.size.grid(), asymmetric: self.asymmetric };
        self.common.make(console, &self.views.apply_to(self.common.request(chart.into())))
    }
}

/// `etendue chart flat-field`
#[derive(Debug, Args)]
pub struct FlatField {
    /// Reflectance of the sheet
    #[arg(long, value_name = "FRACTION", default_value_t = 0.9, allow_negative_numbers = true)]
    pub reflectance: f64,
    #[command(flatten)]
    pub series: Series,
    #[command(flatten)]
    pub common: Common,
}

impl FlatField {
    pub fn run(&self, console: &dyn Console) -> Result<(), Error> {
        let chart = design::FlatField { reflectance: self.reflectance };
        let series = self.series.requested_series(None)?;
        self.common.make(console, &ChartRequest { series, ..self.common.request(chart.into()) })
    }
}

/// `etendue chart backlit`
#[derive(Debug, Args)]
pub struct Backlit {
    #[command(flatten)]
    pub series: Series,
    /// A dark frame for each exposure
    #[arg(long)]
    pub dark: bool,
    #[command(flatten)]
    pub common: Common,
}

impl Backlit {
    pub fn run(&self, console: &dyn Console) -> Result<(), Error> {
        let series = self.series.requested_series(Some(RETRO_LIGHTING))?;
        let request = self.common.request(design::Backlit.into());
        self.common.make(console, &ChartRequest { series, dark: self.dark, ..request })
    }
}

/// `etendue chart slanted-edges`
#[derive(Debug, Args)]
pub struct SlantedEdges {
    #[command(flatten)]
    pub size: Size,
    #[command(flatten)]
    pub edge: Edge,
    #[command(flatten)]
    pub common: Common,
}

impl SlantedEdges {
    pub fn run(&self, console: &dyn Console) -> Result<(), Error> {
        let Edge { angle_deg, contrast } = self.edge;
        let chart = design::SlantedEdges { size: self.size.grid(), angle_deg, contrast };
        self.common.make(console, &self.common.request(chart.into()))
    }
}

/// `etendue chart slanted-star`
#[derive(Debug, Args)]
pub struct SlantedStar {
    #[command(flatten)]
    pub size: Size,
    /// Dark wedges of a star
    #[arg(long, value_name = "N", default_value_t = 8)]
    pub spokes: u32,
    #[command(flatten)]
    pub edge: Edge,
    #[command(flatten)]
    pub common: Common,
}

impl SlantedStar {
    pub fn run(&self, console: &dyn Console) -> Result<(), Error> {
        let Edge { angle_deg, contrast } = self.edge;
        let chart = design::SlantedStar { size: self.size.grid(), spokes: self.spokes, angle_deg, contrast };
        self.common.make(console, &self.common.request(chart.into()))
    }
}

/// `etendue chart siemens-star`
#[derive(Debug, Args)]
pub struct SiemensStar {
    /// Cycles around the centre
    #[arg(long, value_name = "N", default_value_t = 72)]
    pub cycles: u32,
    /// Black and white instead of a cosine
    #[arg(long)]
    pub binary: bool,
    #[command(flatten)]
    pub common: Common,
}

impl SiemensStar {
    pub fn run(&self, console: &dyn Console) -> Result<(), Error> {
        let chart = design::SiemensStar { cycles: self.cycles, binary: self.binary };
        self.common.make(console, &self.common.request(chart.into()))
    }
}

/// `etendue chart dead-leaves`
#[derive(Debug, Args)]
pub struct DeadLeaves {
    /// Radius of the smallest leaves, px
    #[arg(long, value_name = "PX", default_value_t = 1.0, allow_negative_numbers = true)]
    pub smallest_px: f64,
    /// Radius of the largest leaves over the side of the chart
    #[arg(long, value_name = "FRACTION", default_value_t = 0.2, allow_negative_numbers = true)]
    pub largest_ratio: f64,
    #[command(flatten)]
    pub common: Common,
}

impl DeadLeaves {
    pub fn run(&self, console: &dyn Console) -> Result<(), Error> {
        let chart = design::DeadLeaves { smallest_px: self.smallest_px, largest_ratio: self.largest_ratio };
        self.common.make(console, &self.common.request(chart.into()))
    }
}

/// `etendue chart oecf-steps`
#[derive(Debug, Args)]
pub struct OecfSteps {
    /// Number of steps
    #[arg(long, value_name = "N", default_value_t = 12)]
    pub steps: u32,
    /// Density of the darkest step [default: 2, with --backlit 3]
    #[arg(long, value_name = "D", allow_negative_numbers = true)]
    pub density: Option<f64>,
    /// A transparency on a light box in the dark instead of a print in uniform illumination
    #[arg(long)]
    pub backlit: bool,
    #[command(flatten)]
    pub common: Common,
}

impl OecfSteps {
    pub fn run(&self, console: &dyn Console) -> Result<(), Error> {
        let density = self.density.unwrap_or(if self.backlit { 3.0 } else { 2.0 });
        let chart = design::OecfSteps { steps: self.steps, density, backlit: self.backlit };
        self.common.make(console, &self.common.request(chart.into()))
    }
}

/// `etendue chart colorchecker`
#[derive(Debug, Args)]
pub struct ColorChecker {
    #[command(flatten)]
    pub common: Common,
}

impl ColorChecker {
    pub fn run(&self, console: &dyn Console) -> Result<(), Error> {
        let chart = design::ColorChecker;
        self.common.make(console, &self.common.request(chart.into()))
    }
}

/// `etendue chart contrast-patches`
#[derive(Debug, Args)]
pub struct ContrastPatches {
    #[command(flatten)]
    pub size: Size,
    /// Decades of luminance from the brightest patch to the darkest
    #[arg(long, value_name = "N", default_value_t = 3.0, allow_negative_numbers = true)]
    pub decades: f64,
    #[command(flatten)]
    pub common: Common,
}

impl ContrastPatches {
    pub fn run(&self, console: &dyn Console) -> Result<(), Error> {
        let chart = design::ContrastPatches { size: self.size.grid(), decades: self.decades };
        self.common.make(console, &self.common.request(chart.into()))
    }
}

/// `etendue chart flare`
#[derive(Debug, Args)]
pub struct Flare {
    #[command(flatten)]
    pub size: Size,
    /// Diameter of a trap's opening over the distance between traps
    #[arg(long, value_name = "FRACTION", default_value_t = 0.25, allow_negative_numbers = true)]
    pub trap_ratio: f64,
    #[command(flatten)]
    pub common: Common,
}

impl Flare {
    pub fn run(&self, console: &dyn Console) -> Result<(), Error> {
        let chart = design::Flare { size: self.size.grid(), trap_ratio: self.trap_ratio };
        self.common.make(console, &self.common.request(chart.into()))
    }
}

/// `etendue chart led-flicker`
#[derive(Debug, Args)]
pub struct LedFlicker {
    /// Frequencies of the columns, Hz
    #[arg(long, value_name = "HZ,…", value_delimiter = ',', default_values_t = [90.0, 110.0, 200.0, 400.0], allow_negative_numbers = true)]
    pub frequencies_hz: Vec<f64>,
    /// Duty cycles of the rows: fractions of the period that a pulse lasts
    #[arg(long, value_name = "FRACTION,…", value_delimiter = ',', default_values_t = [0.1, 0.25, 0.5], allow_negative_numbers = true)]
    pub duty_cycles: Vec<f64>,
    #[command(flatten)]
    pub common: Common,
}

impl LedFlicker {
    pub fn run(&self, console: &dyn Console) -> Result<(), Error> {
        let Self { frequencies_hz, duty_cycles, .. } = self;
        let chart = design::LedFlicker { frequencies_hz: frequencies_hz.clone(), duty_cycles: duty_cycles.clone() };
        self.common.make(console, &self.common.request(chart.into()))
    }
}

/// `etendue chart points`
#[derive(Debug, Args)]
pub struct Points {
    #[command(flatten)]
    pub size: Size,
    /// Diameter of a light, px at the image centre
    #[arg(long, value_name = "PX", default_value_t = 0.5, allow_negative_numbers = true)]
    pub diameter_px: f64,
    #[command(flatten)]
    pub common: Common,
}

impl Points {
    pub fn run(&self, console: &dyn Console) -> Result<(), Error> {
        let chart = design::Points { size: self.size.grid(), diameter_px: self.diameter_px };
        self.common.make(console, &self.common.request(chart.into()))
    }
}

/// `etendue chart depth-wedge`
#[derive(Debug, Args)]
pub struct DepthWedge {
    /// Steps of the staircase
    #[arg(long, value_name = "N", default_value_t = 8)]
    pub steps: u32,
    /// Distance of the farthest panel over that of the nearest
    #[arg(long, value_name = "RATIO", default_value_t = 3.0, allow_negative_numbers = true)]
    pub far_ratio: f64,
    #[command(flatten)]
    pub common: Common,
}

impl DepthWedge {
    pub fn run(&self, console: &dyn Console) -> Result<(), Error> {
        let chart = design::DepthWedge { steps: self.steps, far_ratio: self.far_ratio };
        self.common.make(console, &self.common.request(chart.into()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::Subcommand;

    #[test]
    fn the_charts_are_those_of_the_library() {
        let command = Design::augment_subcommands(clap::Command::new("chart"));
        let named: Vec<&str> = command.get_subcommands().map(clap::Command::get_name).collect();
        assert_eq!(named, etendue::chart::Chart::NAMES);
    }
}
