//! `measure depth`: accuracy of an estimated depth image against ground truth.

use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};

use clap::Args;
use etendue_arguments::in_range;
use etendue_io::failure::{Error, ErrorCode, check_integer};
use etendue_io::photograph::{Photograph, read_photograph};
use etendue_metrology::depth::{Alignment, DepthErrors, DepthSettings, measure_depth};
use etendue_metrology::{Estimate, Image};

use crate::plot::{Axis, Mark, Plot, Series};
use crate::report::{Cell, Report, Table};

/// The depth channel of this program's ground truth.
const DEPTH_CHANNEL: &str = "depth.Z";

/// Allowed distances from an edge that count as near, pixels.
const EDGE_RANGE_PX: RangeInclusive<u32> = 0..=100;

/// `etendue measure depth`
#[derive(Args, Clone, Debug)]
pub struct DepthRequest {
    /// Estimate: one channel of depth (EXR, PFM, TIFF of floats, PNG of 16 bits …; 0, NaN and infinity are missing)
    #[arg(value_name = "ESTIMATE")]
    pub estimate: PathBuf,
    /// Ground truth: a ground-truth EXR, or one channel of depth
    #[arg(value_name = "TRUTH")]
    pub truth: PathBuf,
    /// Channel of the estimate [default: depth.Z, or the only one]
    #[arg(long, value_name = "NAME")]
    pub estimate_channel: Option<String>,
    /// Channel of the ground truth [default: depth.Z, or the only one]
    #[arg(long, value_name = "NAME")]
    pub truth_channel: Option<String>,
    /// Metres per unit of the estimate, e.g. 0.001 for millimetres
    #[arg(long, value_name = "M", default_value_t = 1.0, allow_negative_numbers = true)]
    pub estimate_unit_m: f64,
    /// Metres per unit of the ground truth
    #[arg(long, value_name = "M", default_value_t = 1.0, allow_negative_numbers = true)]
    pub truth_unit_m: f64,
    /// Limits of the ranges, m, e.g. 0,10,30,100
    #[arg(long, value_name = "M,…", value_delimiter = ',')]
    pub ranges_m: Vec<f64>,
    /// Minimum error of an outlier as a fraction of the depth
    #[arg(long, value_name = "FRACTION", default_value_t = 0.05, allow_negative_numbers = true)]
    pub outlier_ratio: f64,
    /// … and its minimum error, m
    #[arg(long, value_name = "M", default_value_t = 0.0, allow_negative_numbers = true)]
    pub outlier_least_m: f64,
    /// Focal length in pixels times baseline in metres of a stereo rig: adds disparity errors (D1, EPE)
    #[arg(long, value_name = "PX·M", allow_negative_numbers = true)]
    pub focal_base_px_m: Option<f64>,
    /// Alignment of the estimate before the comparison: networks may estimate depth up to a factor
    #[arg(long, value_enum, default_value_t = DepthAlignment::None)]
    pub align: DepthAlignment,
    /// Minimum depth jump of the ground truth at an edge, as a fraction of the depth
    #[arg(long, value_name = "FRACTION", default_value_t = 0.1, allow_negative_numbers = true)]
    pub edge_ratio: f64,
    /// Distance, px, within which pixels near an edge are reported separately
    #[arg(long, value_name = "PX", default_value_t = 2, value_parser = in_range(EDGE_RANGE_PX))]
    pub edge_px: u32,
}

impl DepthRequest {
    /// Creates a request with the program's defaults.
    pub fn new(estimate: impl Into<PathBuf>, truth: impl Into<PathBuf>) -> Self {
        Self {
            estimate: estimate.into(),
            truth: truth.into(),
            estimate_channel: None,
            truth_channel: None,
            estimate_unit_m: 1.0,
            truth_unit_m: 1.0,
            ranges_m: Vec::new(),
            outlier_ratio: 0.05,
            outlier_least_m: 0.0,
            focal_base_px_m: None,
            align: DepthAlignment::None,
            edge_ratio: 0.1,
            edge_px: 2,
        }
    }
}

/// Alignment of an estimate before the comparison.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum DepthAlignment {
    /// Nothing
    None,
    /// Multiply by the median of ground truth over estimate
    Median,
}

/// Errors of an estimated depth image against ground truth: bias, error and outliers by range, with edges reported separately.
///
/// # Errors
/// If the images cannot be used or differ in size.
pub fn depth_errors(request: &DepthRequest) -> Result<Report, Error> {
    check_integer("edge_px", request.edge_px, EDGE_RANGE_PX)?;
    for (field, unit) in [("estimate_unit_m", request.estimate_unit_m), ("truth_unit_m", request.truth_unit_m)] {
        if !(unit > 0.0 && unit.is_finite()) {
            return Err(Error::argument(field, format!("`{field}`: expected a number above 0, not {unit}"))
                .with_code(ErrorCode::OutOfRange));
        }
    }
    let estimate = depth(&request.estimate, request.estimate_channel.as_deref(), request.estimate_unit_m)?;
    let truth = depth(&request.truth, request.truth_channel.as_deref(), request.truth_unit_m)?;
    let defaults = DepthSettings::default();
    let settings = DepthSettings {
        ranges_m: if request.ranges_m.is_empty() { defaults.ranges_m } else { request.ranges_m.clone() },
        outlier_ratio: request.outlier_ratio,
        min_outlier_m: request.outlier_least_m,
        edge_ratio: request.edge_ratio,
        edge_px: request.edge_px as usize,
        focal_baseline_px_m: request.focal_base_px_m,
        alignment: match request.align {
            DepthAlignment::None => Alignment::None,
            DepthAlignment::Median => Alignment::Median,
        },
    };
    let message = |error| {
        Error::coded(
            ErrorCode::NotComparable,
            format!("{} against {}: {error}", request.estimate.display(), request.truth.display()),
        )
    };
    let result = measure_depth(&estimate, &truth, &settings).map_err(message)?;
    let mut report =
        Report::new("depth", "depth against ground truth, pixels at edges separately (± one standard uncertainty)");
    report.figure("bias_m", "bias", "m", result.all.bias_m);
    report.figure("mean_m", "mean magnitude of the error", "m", result.all.mean_m);
    report.figure("rmse_m", "root mean square error", "m", result.all.rmse_m);
    report.figure("relative_percent", "relative error, mean magnitude", "%", result.all.relative.scaled(100.0));
    report.figure("squared_relative_m", "squared error over depth", "m", result.all.squared_relative_m);
    report.figure("rmse_log", "root mean square of logarithms", "", result.all.rmse_log);
    report.figure(
        "silog_percent",
        "their standard deviation, SILog × 100",
        "%",
        result.all.scale_invariant.scaled(100.0),
    );
    report.figure("inverse_rmse_per_km", "root mean square error of 1/depth", "1/km", result.all.inverse_rmse_per_km);
    report.figure("outliers_percent", "outliers", "%", result.all.outliers.scaled(100.0));
    if let Some([d1, disparity]) = result.all.disparity {
        report.figure("d1_percent", "disparities off by more than 3 px and 5 %, D1", "%", d1.scaled(100.0));
        report.figure("disparity_px", "mean error of disparity, EPE", "px", disparity);
    }
    let compared = (result.all.pixels + result.all.missing) as f64;
    report.fact(
        "density_percent",
        "estimated",
        "% of the pixels with ground truth",
        100.0 * result.all.pixels as f64 / compared,
    );
    report.fact("scale", "the estimate was multiplied by", "", result.scale);
    let all = ("all".to_owned(), &result.all);
    let limits =
        |low: f64, high: f64| if high.is_finite() { format!("{low}–{high} m") } else { format!("from {low} m") };
    let ranges = result.ranges.iter().map(|(low, high, errors)| (limits(*low, *high), errors));
    let edges = ("edges".to_owned(), &result.edges);
    let rows = std::iter::once(all).chain(ranges).chain([edges]);
    report.table(Table {
        key: "ranges",
        columns: vec![
            ("range", "range"),
            ("pixels", "pixels"),
            ("missing", "missing"),
            ("bias_m", "bias m"),
            ("rmse_m", "RMSE m"),
            ("relative_percent", "relative %"),
            ("outliers_percent", "outliers %"),
            ("within_1_25_percent", "δ1 %"),
            ("within_1_5625_percent", "δ2 %"),
            ("within_1_953_percent", "δ3 %"),
        ],
        rows: rows.map(|(name, errors)| row(name, errors)).collect(),
    });
    if result.ranges.iter().any(|(_, _, errors)| errors.pixels > 0) {
        report.plot(plot(&result.ranges));
    }
    Ok(report)
}

/// Errors against depth: each range at its middle, an unbounded one at its beginning.
fn plot(ranges: &[(f64, f64, DepthErrors)]) -> Plot {
    let non_empty = ranges.iter().filter(|(_, _, errors)| errors.pixels > 0);
    let at = |low: f64, high: f64| if high.is_finite() { 0.5 * (low + high) } else { low };
    let curve = |quantity: fn(&DepthErrors) -> Estimate| {
        non_empty.clone().map(move |(low, high, errors)| {
            let error = quantity(errors);
            (at(*low, *high), error.value, 2.0 * error.standard_uncertainty)
        })
    };
    Plot {
        title: "errors by range (bars: 95 %)".to_owned(),
        x: Axis::linear("depth, m: the middle of a range, or the start of an unbounded one").showing(&[0.0]),
        y: Axis::linear("error, m").showing(&[0.0]),
        series: vec![
            Series::with_errors("bias", Mark::Line, curve(|e| e.bias_m)),
            Series::with_errors("RMSE", Mark::Line, curve(|e| e.rmse_m)),
        ],
    }
}

fn row(name: String, e: &DepthErrors) -> Vec<Cell> {
    let counts = [Cell::Text(name), Cell::Number(e.pixels as f64, 0), Cell::Number(e.missing as f64, 0)];
    if e.pixels == 0 {
        return counts.into_iter().chain((0..7).map(|_| Cell::Nothing)).collect();
    }
    let percent = |fraction: Estimate| Cell::Estimate(fraction.scaled(100.0));
    let errors = [Cell::Estimate(e.bias_m), Cell::Estimate(e.rmse_m), percent(e.relative), percent(e.outliers)];
    counts.into_iter().chain(errors).chain(e.within.map(percent)).collect()
}

fn depth(file: &Path, channel: Option<&str>, unit_m: f64) -> Result<Image, Error> {
    let photograph = read_photograph(file).map_err(Error::input)?;
    let samples = chosen(file, &photograph, channel)?;
    let metres = samples.iter().map(|s| (f64::from(*s) * unit_m) as f32).collect();
    Ok(Image::from_samples(photograph.width, photograph.height, metres).expect("a photograph's channels fill it"))
}

/// Numbers of the named channel, or depth.Z, or the only one.
fn chosen<'a>(file: &Path, photograph: &'a Photograph, channel: Option<&str>) -> Result<&'a [f32], Error> {
    let named = |name: &str| photograph.channel(name).map(|c| c.samples.as_slice());
    let chosen_channel = match (channel, &photograph.channels[..]) {
        (Some(name), _) => named(name),
        (None, [only]) => Some(only.samples.as_slice()),
        (None, _) => named(DEPTH_CHANNEL),
    };
    chosen_channel.ok_or_else(|| {
        let names = photograph.names().join(", ");
        Error::coded(
            ErrorCode::NotStated,
            format!("{}: the depth channel is ambiguous; choose one of {names}", file.display()),
        )
    })
}
