//! The command line of `etendue chart`, as typed: a subcommand a chart, each with its own options.

use super::Output;
use super::run::seed;
use clap::{Args, Subcommand, ValueEnum};

/// `etendue chart`
#[derive(Debug, Subcommand)]
pub enum Chart {
    /// Black dots over all of the field: focal length, distortion, chromatic displacement (ISO 17850, ISO 19084)
    Dots(Dots),
    /// A checkerboard, all of it in view: calibration
    Checkerboard(Checkerboard),
    /// Circles in a square or a staggered lattice, all in view: calibration
    Circles(Circles),
    /// An even white sheet in even light: vignetting, shading, photon transfer (ISO 17957, EMVA 1288)
    FlatField(FlatField),
    /// A panel that shines by itself in the dark, with a series of exposures: tone curve, photon transfer
    Backlit(Backlit),
    /// Squares turned by a small angle over the field: spatial frequency response by place and direction (ISO 12233)
    SlantedEdges(SlantedEdges),
    /// Stars of slanted wedges: spatial frequency response in many directions (ISO 12233)
    SlantedStar(SlantedStar),
    /// A star of many cycles: modulation over spatial frequency (ISO 12233)
    SiemensStar(SiemensStar),
    /// Discs upon discs, with the statistics of natural scenes: loss of texture (ISO 19567-2)
    DeadLeaves(DeadLeaves),
    /// Grey steps around a ring: opto-electronic conversion function (ISO 14524)
    OecfSteps(OecfSteps),
    /// The 24 patches of the ColorChecker by their measured spectra: colour error
    Colorchecker(Plain),
    /// Shining grey patches over several decades: contrast detection probability
    ContrastPatches(ContrastPatches),
    /// A white field with light traps: veiling glare (ISO 18844)
    Flare(Flare),
    /// Small lamps in the dark: point-spread function, chromatic displacement
    Points(Points),
    /// A staircase and a slanted plane with texture at known distances: depth
    DepthWedge(DepthWedge),
}

/// What all charts have in common.
#[derive(Debug, Args)]
pub struct Common {
    /// The camera: a camera file (TOML), or a stand-in: web, ccd-mono, ccd-bayer, automotive, laboratory
    #[arg(long, value_name = "CAMERA.toml", default_value = "web")]
    pub camera: String,
    /// Distance of the sheet from the entrance pupil, m [default: where the camera is focused, or 1]
    #[arg(long, value_name = "M", conflicts_with = "width_mm", allow_negative_numbers = true)]
    pub distance_m: Option<f64>,
    /// Width of what the camera sees of the sheet, mm: the distance follows
    #[arg(long, value_name = "MM", allow_negative_numbers = true)]
    pub width_mm: Option<f64>,
    /// The light's spectrum: D65, A, E, LED-B3, …
    #[arg(long, value_name = "NAME", default_value = "D65")]
    pub illuminant: String,
    /// Luminance of a perfect white sheet (or of the panel), cd/m² [default: what --white asks for]
    #[arg(long, value_name = "CD_M2", conflicts_with = "white", allow_negative_numbers = true)]
    pub luminance_cd_m2: Option<f64>,
    /// The share of the sensor's saturation that a perfect white sheet (or the panel) reaches in the camera's own exposure
    #[arg(long, value_name = "SHARE", default_value_t = 0.7, allow_negative_numbers = true)]
    pub white: f64,
    /// The seed of all random numbers
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = seed)]
    pub seed: u64,
    /// Write the print as chart.png too, at this many pixels an inch
    #[arg(long, value_name = "DPI", allow_negative_numbers = true)]
    pub png: Option<f64>,
    #[command(flatten)]
    pub output: Output,
}

/// How many figures, and how far apart.
#[derive(Debug, Args)]
pub struct Size {
    /// Columns [default: as many as the field takes]
    #[arg(long, value_name = "N")]
    pub columns: Option<u32>,
    /// Rows [default: as many as the field takes]
    #[arg(long, value_name = "N")]
    pub rows: Option<u32>,
    /// Distance from centre to centre (of squares: their side), mm [default: what the columns allow]
    #[arg(long, value_name = "MM", allow_negative_numbers = true)]
    pub pitch_mm: Option<f64>,
}

/// How many cameras look at the chart.
#[derive(Debug, Args)]
pub struct Views {
    /// Views of the chart: the first square to it, the others tilted by 25 degrees all round
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=200))]
    pub views: u32,
}

/// `etendue chart dots`
#[derive(Debug, Args)]
pub struct Dots {
    #[command(flatten)]
    pub size: Size,
    /// Diameter of a dot over the distance between centres
    #[arg(long, value_name = "SHARE", default_value_t = 0.5, allow_negative_numbers = true)]
    pub dot_ratio: f64,
    #[command(flatten)]
    pub views: Views,
    #[command(flatten)]
    pub common: Common,
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

/// A series of exposures.
#[derive(Debug, Args)]
pub struct Series {
    /// How many exposures, one camera each
    #[arg(long, value_name = "N", conflicts_with = "levels", value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub exposures: Option<u32>,
    /// How they are spaced from --lowest to --highest [default: log]
    #[arg(long, value_enum, conflicts_with = "levels")]
    pub spacing: Option<Spacing>,
    /// Share of saturation that white reaches in the shortest [default: 0.003]
    #[arg(long, value_name = "SHARE", conflicts_with = "levels", allow_negative_numbers = true)]
    pub lowest: Option<f64>,
    /// The same in the longest [default: 1.3]
    #[arg(long, value_name = "SHARE", conflicts_with = "levels", allow_negative_numbers = true)]
    pub highest: Option<f64>,
    /// The shares themselves, e.g. 0.01,0.1,0.5,1.2
    #[arg(long, value_name = "SHARES", value_delimiter = ',', allow_negative_numbers = true)]
    pub levels: Option<Vec<f64>>,
}

/// How exposures are spaced.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Spacing {
    /// Equal ratios
    Log,
    /// Equal steps
    Linear,
}

/// `etendue chart flat-field`
#[derive(Debug, Args)]
pub struct FlatField {
    /// Reflectance of the sheet
    #[arg(long, value_name = "SHARE", default_value_t = 0.9, allow_negative_numbers = true)]
    pub reflectance: f64,
    #[command(flatten)]
    pub series: Series,
    #[command(flatten)]
    pub common: Common,
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

/// A chart without options of its own.
#[derive(Debug, Args)]
pub struct Plain {
    #[command(flatten)]
    pub common: Common,
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

/// How a slanted edge lies between light and dark.
#[derive(Debug, Args)]
pub struct Edge {
    /// By how much it is turned clockwise, degrees: a square by 2 … 43 either way, or the first edge of a star by up to 45
    #[arg(long, value_name = "DEG", default_value_t = 5.0, allow_negative_numbers = true)]
    pub angle_deg: f64,
    /// Luminance of light over dark
    #[arg(long, value_name = "RATIO", default_value_t = 4.0, allow_negative_numbers = true)]
    pub contrast: f64,
}

/// `etendue chart siemens-star`
#[derive(Debug, Args)]
pub struct SiemensStar {
    /// Cycles around the centre
    #[arg(long, value_name = "N", default_value_t = 72)]
    pub cycles: u32,
    /// In black and white instead of a cosine
    #[arg(long)]
    pub binary: bool,
    #[command(flatten)]
    pub common: Common,
}

/// `etendue chart dead-leaves`
#[derive(Debug, Args)]
pub struct DeadLeaves {
    /// Radius of the smallest leaves, px
    #[arg(long, value_name = "PX", default_value_t = 1.0, allow_negative_numbers = true)]
    pub smallest_px: f64,
    /// Radius of the largest leaves over the side of the chart
    #[arg(long, value_name = "SHARE", default_value_t = 0.2, allow_negative_numbers = true)]
    pub largest_ratio: f64,
    #[command(flatten)]
    pub common: Common,
}

/// `etendue chart oecf-steps`
#[derive(Debug, Args)]
pub struct OecfSteps {
    /// How many steps
    #[arg(long, value_name = "N", default_value_t = 12)]
    pub steps: u32,
    /// Density of the darkest step [default: 2, with --backlit 3]
    #[arg(long, value_name = "D", allow_negative_numbers = true)]
    pub density: Option<f64>,
    /// A transparency on a light box in the dark instead of a print in even light
    #[arg(long)]
    pub backlit: bool,
    #[command(flatten)]
    pub common: Common,
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

/// `etendue chart flare`
#[derive(Debug, Args)]
pub struct Flare {
    #[command(flatten)]
    pub size: Size,
    /// Diameter of a trap's opening over the distance between traps
    #[arg(long, value_name = "SHARE", default_value_t = 0.25, allow_negative_numbers = true)]
    pub trap_ratio: f64,
    #[command(flatten)]
    pub common: Common,
}

/// `etendue chart points`
#[derive(Debug, Args)]
pub struct Points {
    #[command(flatten)]
    pub size: Size,
    /// Diameter of a lamp, px of the picture's middle
    #[arg(long, value_name = "PX", default_value_t = 0.5, allow_negative_numbers = true)]
    pub diameter_px: f64,
    #[command(flatten)]
    pub common: Common,
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
