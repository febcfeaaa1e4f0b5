//! Options shared by charts.

use crate::args::folder::Output;
use crate::console::{Console, print_paths};
use clap::Args;
use etendue::Error;
use etendue::chart::design::GridSize;
use etendue::chart::{self, Chart, ChartError, ChartRequest, Exposures, MAX_VIEWS, Spacing};
use etendue_arguments::seed;
use etendue_arguments::{Word, choice};

/// Options common to all charts.
#[derive(Debug, Args)]
pub struct Common {
    /// The camera: a camera file (TOML), or a reference camera: web, ccd-mono, ccd-bayer, automotive, laboratory
    #[arg(long, value_name = "CAMERA.toml", default_value = "web")]
    pub camera: String,
    /// Change a key of the written job, its scene or its camera, e.g. --set render.spp=16 or --set cameras.camera.lens.f_number=4: the chart is made
    /// for the changed camera, and the change is written into the files
    #[arg(long, value_name = "KEY=VALUE")]
    pub set: Vec<String>,
    /// Distance of the sheet from the entrance pupil, m [default: the camera's focus distance, or 1]
    #[arg(long, value_name = "M", conflicts_with = "width_mm", allow_negative_numbers = true)]
    pub distance_m: Option<f64>,
    /// Width of the sheet that the camera sees, mm; determines the distance
    #[arg(long, value_name = "MM", allow_negative_numbers = true)]
    pub width_mm: Option<f64>,
    /// Spectrum of the light: D65, A, E, LED-B3, …
    #[arg(long, value_name = "NAME", default_value = "D65")]
    pub illuminant: String,
    /// Luminance of a perfect white sheet (or of the panel), cd/m² [default: as required by --white]
    #[arg(long, value_name = "CD_M2", conflicts_with = "white", allow_negative_numbers = true)]
    pub luminance_cd_m2: Option<f64>,
    /// Fraction of the sensor's saturation that a perfect white sheet (or the panel) reaches in the camera's own exposure
    #[arg(long, value_name = "FRACTION", default_value_t = 0.7, allow_negative_numbers = true)]
    pub white: f64,
    /// Seed of all random numbers
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = seed)]
    pub seed: u64,
    /// Also write the print as chart.png, at this many pixels per inch
    #[arg(long, value_name = "DPI", allow_negative_numbers = true)]
    pub png: Option<f64>,
    #[command(flatten)]
    pub output: Output,
}

impl Common {
    /// Returns a chart with these options, in one view without a series.
    pub fn request(&self, chart: Chart) -> ChartRequest {
        ChartRequest {
            set: self.set.clone(),
            distance_m: self.distance_m,
            width_mm: self.width_mm,
            illuminant: self.illuminant.clone(),
            luminance_cd_m2: self.luminance_cd_m2,
            white: self.white,
            seed: self.seed,
            png_dpi: self.png,
            ..ChartRequest::new(chart, self.camera.as_str())
        }
    }

    /// Makes the requested chart, and prints its files.
    pub fn make(&self, console: &dyn Console, request: &ChartRequest) -> Result<(), Error> {
        print_paths(console, &chart::make(request, self.output.path(), self.output.existing())?);
        Ok(())
    }
}

/// Number and distance of figures.
#[derive(Debug, Args)]
pub struct Size {
    /// Columns [default: as many as fit the field]
    #[arg(long, value_name = "N")]
    pub columns: Option<u32>,
    /// Rows [default: as many as fit the field]
    #[arg(long, value_name = "N")]
    pub rows: Option<u32>,
    /// Distance between centres (of squares: their side), mm [default: as the columns allow]
    #[arg(long, value_name = "MM", allow_negative_numbers = true)]
    pub pitch_mm: Option<f64>,
}

impl Size {
    pub fn grid(&self) -> GridSize {
        GridSize { columns: self.columns, rows: self.rows, pitch_mm: self.pitch_mm }
    }
}

/// Number of cameras that look at the chart.
#[derive(Debug, Args)]
pub struct Views {
    /// Views of the chart: the first perpendicular to it, the others tilted by 25 degrees in all directions
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=i64::from(MAX_VIEWS)))]
    pub views: u32,
    /// Simulate hand-held views: up to 0.5 % of the distance aside, 2 % farther away, rolled by 1.5 degrees, at random by --seed
    #[arg(long)]
    pub hand_held: bool,
}

impl Views {
    /// Returns the request with these views.
    pub fn apply_to(&self, request: ChartRequest) -> ChartRequest {
        ChartRequest { views: self.views, hand_held: self.hand_held, ..request }
    }
}

/// Angle and contrast of a slanted edge.
#[derive(Clone, Copy, Debug, Args)]
pub struct Edge {
    /// Clockwise rotation, degrees: a square by 2 … 43 in either direction, or the first edge of a star by up to 45
    #[arg(long, value_name = "DEG", default_value_t = 5.0, allow_negative_numbers = true)]
    pub angle_deg: f64,
    /// Luminance of the bright side over that of the dark side
    #[arg(long, value_name = "RATIO", default_value_t = 4.0, allow_negative_numbers = true)]
    pub contrast: f64,
}

/// Exposures of the retro-lighting chart (Gruyer and others 2012).
pub const RETRO_LIGHTING: u32 = 15;
const LOWEST: f64 = 0.003;
const HIGHEST: f64 = 1.3;

const SPACINGS: [Word<Spacing>; 2] =
    [(Spacing::Log, "log", "Equal ratios"), (Spacing::Linear, "linear", "Equal steps")];

/// A series of exposures.
#[derive(Debug, Args)]
pub struct Series {
    /// Number of exposures, one camera each
    #[arg(long, value_name = "N", conflicts_with = "levels", value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub exposures: Option<u32>,
    /// Spacing from --lowest to --highest [default: log]
    #[arg(long, value_parser = choice(SPACINGS), conflicts_with = "levels")]
    pub spacing: Option<Spacing>,
    /// Fraction of saturation that white reaches in the shortest exposure [default: 0.003]
    #[arg(long, value_name = "FRACTION", conflicts_with = "levels", allow_negative_numbers = true)]
    pub lowest: Option<f64>,
    /// The same in the longest exposure [default: 1.3]
    #[arg(long, value_name = "FRACTION", conflicts_with = "levels", allow_negative_numbers = true)]
    pub highest: Option<f64>,
    /// The fractions themselves, e.g. 0.01,0.1,0.5,1.2
    #[arg(long, value_name = "FRACTIONS", value_delimiter = ',', allow_negative_numbers = true)]
    pub levels: Option<Vec<f64>>,
}

impl Series {
    /// Returns the requested series; by default `usual` exposures, except for a camera without electronics.
    pub fn requested_series(&self, usual: Option<u32>) -> Result<Option<chart::ExposureSeries>, Error> {
        let required = self.exposures.is_some() || self.levels.is_some();
        let exposures = self.exposures(usual).map_err(chart::chart_error)?;
        Ok(exposures.map(|exposures| chart::ExposureSeries { exposures, required }))
    }

    fn exposures(&self, usual: Option<u32>) -> Result<Option<Exposures>, ChartError> {
        if let Some(levels) = &self.levels {
            return Exposures::listed(levels.clone()).map(Some);
        }
        let Some(count) = self.exposures.or(usual) else {
            return self.option_without_series().map_or(Ok(None), |(name, value)| {
                Err(ChartError::option(name, value, "has no effect without `exposures`; give their number"))
            });
        };
        let spacing = self.spacing.unwrap_or(Spacing::Log);
        let (lowest, highest) = (self.lowest.unwrap_or(LOWEST), self.highest.unwrap_or(HIGHEST));
        Exposures::spaced(count, spacing, lowest, highest).map(Some)
    }

    /// Returns an option of a series and its value, if there is no series.
    fn option_without_series(&self) -> Option<(&'static str, String)> {
        let limits = [("lowest", self.lowest), ("highest", self.highest)];
        let number = limits.into_iter().find_map(|(name, value)| Some((name, value?.to_string())));
        number.or(self.spacing.map(|_| ("spacing", String::new())))
    }
}
