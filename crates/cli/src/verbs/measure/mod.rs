//! `etendue measure`: the closed list of measurements.

mod compare;
mod lens;
pub mod report;

use crate::console::Console;
use crate::machine;
use crate::subcommands::subcommands;
use clap::Args;
use etendue::measure::*;
use etendue::report::Report;
use etendue::{Error, Observer, measure};
use report::{CameraOut, ReportArgs};

/// `etendue measure`
#[derive(Debug, Args)]
pub struct Measure {
    #[command(subcommand)]
    pub measurement: Measurement,
}

impl Measure {
    pub fn run(&self, console: &dyn Console) -> Result<(), Error> {
        machine::pool(None)?.install(|| self.measurement.run(console))
    }
}

subcommands! {
    /// The measurements.
    Measurement:
    /// Focal lengths, principal planes, pupils and field of view; by field: distortion, illumination, spots, field
    /// curvature, colour
    Lens(lens::LensArgs),
    /// Distortion from one image of a plane chart, without a model: the curve over the field, line distortion, k1 and k2 (ISO 17850)
    Distortion(StorableMeasurementArgs<DistortionRequest>),
    /// Focal length and principal point, from one image of a chart at a known distance or from several
    #[command(
        after_help = "One image needs --distance-mm; its principal point is assumed at the image centre unless \
        --principal-px states another. The result is the principal distance (camera constant): the focal length for \
        a lens focused at infinity; at a distance D it is longer, f D/(D − f)."
    )]
    Focal(StorableMeasurementArgs<FocalRequest>),
    /// Lateral chromatic displacement of red and blue against green (ISO 19084)
    Chromatic(MeasurementArgs<ChromaticRequest>),
    /// Photon transfer after EMVA 1288: gain, quantum efficiency, dark noise, saturation, linearity, DSNU, PRNU
    Ptc(StorableMeasurementArgs<PtcRequest>),
    /// Slanted edges: the spatial frequency response with MTF50 and MTF10 (ISO 12233)
    Sfr(MeasurementArgs<SfrRequest>),
    /// Tone curve from a series of exposures or from steps, with linearity and dynamic range (ISO 14524); camera response from a scene at exposures
    /// with known ratios
    Oecf(MeasurementArgs<OecfRequest>),
    /// Fall-off of a flat field over the radial field position
    Vignetting(StorableMeasurementArgs<VignettingRequest>),
    /// Fall-off of a flat field as a map, and its colour shading (ISO 17957)
    Shading(MeasurementArgs<ShadingRequest>),
    /// Temporal and fixed-pattern noise of a uniform surface (ISO 15739)
    Noise(MeasurementArgs<NoiseRequest>),
    /// Flare: light in the image of light traps (ISO 18844)
    Flare(MeasurementArgs<FlareRequest>),
    /// Flicker of a light: frequency, modulation over rows and frames, duty cycle of pulses (IEEE P2020)
    Flicker(MeasurementArgs<FlickerRequest>),
    /// Colours of a ColorChecker after a fitted matrix, CIEDE2000
    Colour(MeasurementArgs<ColourRequest>),
    /// Contrast detection probability of pairs of patches (IEEE P2020)
    Cdp(MeasurementArgs<CdpRequest>),
    /// An estimated depth image against ground truth: bias, error and outliers by range, edges separately
    Depth(MeasurementArgs<DepthRequest>),
    /// Increase of the dark current with temperature, by three laws
    DarkCurrent(MeasurementArgs<DarkCurrentRequest>),
    /// A Siemens star: response over frequency (ISO 12233)
    Star(MeasurementArgs<StarRequest>),
    /// Texture such as dead leaves against its reference: response, artefacts, coherence
    Texture(MeasurementArgs<TextureRequest>),
    /// Measurements of two cameras side by side, or a camera file against its measurements; exit status 1 if they differ
    Compare(compare::CompareArgs),
}

/// A request answered by a report.
pub trait MeasurementRequest: Args {
    /// Measures; with `camera_keys` the report contains the results as keys of a camera file.
    fn measure(&self, camera_keys: bool, observer: &dyn Observer) -> Result<Report, Error>;
}

/// Requests and the functions that answer them.
macro_rules! measured {
    ($($Request:ident: $measure:expr,)*) => {
        $(impl MeasurementRequest for $Request {
            fn measure(&self, camera_keys: bool, observer: &dyn Observer) -> Result<Report, Error> {
                let measure: fn(&Self, bool, &dyn Observer) -> Result<Report, Error> = $measure;
                measure(self, camera_keys, observer)
            }
        })*
    };
}

measured! {
    CdpRequest: |request, _, _| measure::cdp(request),
    ChromaticRequest: |request, _, _| measure::chromatic(request),
    ColourRequest: |request, _, _| measure::colour(request),
    DarkCurrentRequest: |request, _, observer| measure::dark_current(request, observer),
    DepthRequest: |request, _, _| measure::depth_errors(request),
    DistortionRequest: |request, _, _| measure::distortion(request),
    FlareRequest: |request, _, _| measure::flare(request),
    FlickerRequest: |request, _, _| measure::flicker(request),
    FocalRequest: |request, camera_keys, observer| measure::focal(&FocalRequest { camera_keys, ..request.clone() }, observer),
    NoiseRequest: |request, _, _| measure::noise(request),
    OecfRequest: |request, _, _| measure::oecf(request),
    PtcRequest: |request, _, observer| measure::ptc(request, observer),
    SfrRequest: |request, _, _| measure::sfr(request),
    ShadingRequest: |request, _, _| measure::shading(request),
    StarRequest: |request, _, _| measure::star(request),
    TextureRequest: |request, _, _| measure::texture(request),
    VignettingRequest: |request, camera_keys, _| measure::vignetting(&VignettingRequest { camera_keys, ..request.clone() }),
}

/// A measurement and the output of its report.
#[derive(Debug, Args)]
pub struct MeasurementArgs<R: MeasurementRequest> {
    #[command(flatten)]
    request: R,
    #[command(flatten)]
    report: ReportArgs,
}

impl<R: MeasurementRequest> MeasurementArgs<R> {
    pub fn run(&self, console: &dyn Console) -> Result<(), Error> {
        self.report.show(console, &self.request.measure(false, console.observer())?)
    }
}

/// A measurement of properties that a camera file states.
#[derive(Debug, Args)]
pub struct StorableMeasurementArgs<R: MeasurementRequest> {
    #[command(flatten)]
    request: R,
    #[command(flatten)]
    report: ReportArgs,
    #[command(flatten)]
    out: CameraOut,
}

impl<R: MeasurementRequest> StorableMeasurementArgs<R> {
    pub fn run(&self, console: &dyn Console) -> Result<(), Error> {
        let report = self.request.measure(self.out.camera_out.is_some(), console.observer())?;
        self.out.write(&report)?;
        self.report.show(console, &report)
    }
}
