//! `measure noise`: temporal and fixed-pattern noise of a uniform surface, or of each patch of a chart.

use std::path::{Path, PathBuf};

use clap::Args;
use etendue_charts::design::{Backlit, ContrastPatches, FlatField, OecfSteps};
use etendue_io::failure::{Error, ErrorCode};
use etendue_metrology::noise::{Noise, check_frame, measure_noise};
use etendue_metrology::{Estimate, photon_transfer::Stack};

use super::pictures::{Clipping, MeasurementInput, refused};
use super::{readings::Readings, truth::Truth, truth::place::PatchPlace};
use crate::plot::{Axis, Mark, Plot, Series};
use crate::report::{Cell, Report, Table};

/// `etendue measure noise`
#[derive(Args, Clone, Debug)]
pub struct NoiseRequest {
    /// Eight or more frames of one uniform surface, or of a chart with --truth
    #[arg(value_name = "FRAME", required = true)]
    pub frames: Vec<PathBuf>,
    /// Readings of the image, their meaning, and the chart's ground truth.
    #[command(flatten)]
    pub input: MeasurementInput,
}

impl NoiseRequest {
    /// Creates a request with the program's defaults.
    pub fn new(frames: Vec<PathBuf>) -> Self {
        Self { frames, input: MeasurementInput::default() }
    }
}

/// Charts of one uniform surface, and of many.
const UNIFORM_CHARTS: [&str; 2] = [FlatField::NAME, Backlit::NAME];
const CHARTS: [&str; 4] = [FlatField::NAME, Backlit::NAME, OecfSteps::NAME, ContrastPatches::NAME];

/// A uniform surface over the frames.
struct UniformSurface {
    /// The patch of a chart.
    patch: Option<PatchPlace>,
    /// Position; `None` for the whole frame.
    at: Option<[usize; 4]>,
    stack: Option<Stack>,
    /// Reason for leaving it out.
    error: Option<String>,
    /// The first clipped frame.
    clipping: Option<(PathBuf, Clipping)>,
}

impl UniformSurface {
    fn new(patch: Option<PatchPlace>, at: Option<[usize; 4]>) -> Self {
        Self { patch, at, stack: None, error: None, clipping: None }
    }

    /// Returns a note of the patch and the first of its frames that is clipped.
    fn cut_note(&self) -> Option<String> {
        let (file, cut) = self.clipping.as_ref()?;
        let patch = self.patch.as_ref().map_or_else(String::new, |patch| format!("{}, ", patch.name));
        let consequence = "the noise and its uncertainty do not account for it";
        Some(format!("{patch}{}: {}; {consequence}", file.display(), cut.words()))
    }

    fn add_frame(&mut self, file: &Path, readings: &Readings, full_scale: Option<f64>) -> Result<(), Error> {
        let full_image = || Ok(readings.image.clone());
        let frame = self.at.map_or_else(full_image, |at| readings.part(at, &file.display().to_string()))?;
        match check_frame(&frame, full_scale) {
            Err(failure) if self.patch.is_some() => self.error = Some(failure.to_string()),
            checked => checked.map_err(|error| refused(file, error))?,
        }
        self.clipping =
            self.clipping.take().or_else(|| Some((file.to_owned(), Clipping::from_region(&frame, full_scale)?)));
        let stack = self.stack.get_or_insert_with(|| Stack::new(frame.width(), frame.height()));
        stack.push(&frame).map_err(|error| refused(file, error))
    }
}

/// Temporal and fixed-pattern noise of a uniform surface, or of each patch of a chart (ISO 15739).
///
/// # Errors
/// If the frames are too few, saturated or not of one surface.
pub fn noise(request: &NoiseRequest) -> Result<Report, Error> {
    let input = &request.input;
    let (mut surfaces, mut black, mut encodings) = (Vec::new(), 0.0, Vec::new());
    for (i, file) in request.frames.iter().enumerate() {
        let readings = input.linear(file)?;
        let truth = input.truth(&CHARTS, file, &readings)?;
        if i == 0 {
            surfaces = find_surfaces(truth.as_ref(), file, &readings)?;
        }
        readings.independent(file, 1)?;
        encodings.push(readings.stated.clone());
        black = input.levels.black(&readings);
        let full_scale = input.levels.full_scale(&readings);
        surfaces.iter_mut().try_for_each(|surface| surface.add_frame(file, &readings, full_scale))?;
    }
    let mut report = match &surfaces[..] {
        [UniformSurface { patch: None, stack: Some(stack), .. }] => one(stack, black)?,
        many => patches(many, black).map_err(|reason| refused(&request.frames[0], reason))?,
    };
    encodings.iter().for_each(|stated| report.encoding(stated));
    surfaces
        .iter()
        .filter(|surface| surface.error.is_none())
        .filter_map(UniformSurface::cut_note)
        .for_each(|note| report.note(note));
    Ok(report)
}

fn find_surfaces(truth: Option<&Truth>, file: &Path, readings: &Readings) -> Result<Vec<UniformSurface>, Error> {
    match truth {
        None => Ok(vec![UniformSurface::new(None, None)]),
        Some(truth) if UNIFORM_CHARTS.contains(&truth.chart()) => {
            Ok(vec![UniformSurface::new(None, Some(truth.middle(readings)?))])
        }
        Some(truth) => {
            let place = |patch: PatchPlace| UniformSurface::new(Some(patch.clone()), Some(patch.at));
            let (patches, _) = truth.patches(readings)?;
            truth.shown(file, &patches, readings)?;
            Ok(patches.into_iter().map(place).collect())
        }
    }
}

const METHOD: &str = "noise of a uniform surface after ISO 15739 (± one standard uncertainty)";

fn one(stack: &Stack, black: f64) -> Result<Report, Error> {
    let noise =
        measure_noise(stack, black).map_err(|error| Error::coded(ErrorCode::NotMeasurable, error.to_string()))?;
    let mut report = Report::new("noise", METHOD);
    report.figure("signal", "signal above black", "", noise.signal);
    report.figure("total_noise", "total noise", "", noise.total);
    report.figure("temporal_noise", "temporal noise", "", noise.temporal);
    report.figure("fixed_pattern_noise", "fixed-pattern noise", "", noise.fixed);
    let [total, temporal, fixed] = noise.snr();
    report.figure("snr", "signal over total noise", "", total);
    report.figure("snr_temporal", "signal over temporal noise", "", temporal);
    report.figure("snr_fixed_pattern", "signal over fixed-pattern noise", "", fixed);
    let means = stack.frame_means().iter().enumerate().map(|(i, mean)| (i as f64 + 1.0, mean - black));
    report.plot(Plot {
        title: "mean of each frame".to_owned(),
        x: Axis::linear("frame"),
        y: Axis::linear("signal above black"),
        series: vec![Series::new("", Mark::Points, means)],
    });
    Ok(report)
}

/// Noise against the luminance of a chart's patches; saturated patches are named.
fn patches(surfaces: &[UniformSurface], black: f64) -> Result<Report, String> {
    let mut report = Report::new("noise", METHOD);
    let mut measured: Vec<(&PatchPlace, Noise)> = Vec::new();
    for surface in surfaces {
        let (Some(patch), Some(stack)) = (&surface.patch, &surface.stack) else { continue };
        match &surface.error {
            Some(failure) => report.note(format!("omitted: {}: {failure}", patch.name)),
            None => measured.push((patch, measure_noise(stack, black).map_err(|error| error.to_string())?)),
        }
    }
    if measured.is_empty() {
        return Err("every patch is saturated; reduce the exposure".to_owned());
    }
    measured.sort_by(|a, b| a.0.luminance_cd_m2.total_cmp(&b.0.luminance_cd_m2));
    let row = |(patch, noise): &(&PatchPlace, Noise)| {
        let estimates = [noise.signal, noise.total, noise.temporal, noise.fixed, noise.snr()[0]];
        let names = [Cell::Text(patch.name.clone()), Cell::Number(patch.luminance_cd_m2, 3)];
        names.into_iter().chain(estimates.map(Cell::Estimate)).collect()
    };
    report.table(Table {
        key: "patches",
        columns: vec![
            ("patch", "patch"),
            ("luminance_cd_m2", "cd/m²"),
            ("signal", "signal"),
            ("total_noise", "total"),
            ("temporal_noise", "temporal"),
            ("fixed_pattern_noise", "fixed"),
            ("snr", "SNR"),
        ],
        rows: measured.iter().map(row).collect(),
    });
    report.plot(plot(&measured));
    Ok(report)
}

fn plot(measured: &[(&PatchPlace, Noise)]) -> Plot {
    let series = |name: &str, quantity: fn(&Noise) -> Estimate| {
        let points = measured
            .iter()
            .map(|(p, n)| (p.luminance_cd_m2, quantity(n).value, 2.0 * quantity(n).standard_uncertainty));
        Series::with_errors(name, Mark::Points, points)
    };
    Plot {
        title: "noise over luminance (bars: 95 %)".to_owned(),
        x: Axis::log("luminance, cd/m²"),
        y: Axis::log("noise, reading"),
        series: vec![
            series("total", |n| n.total),
            series("temporal", |n| n.temporal),
            series("fixed pattern", |n| n.fixed),
        ],
    }
}
