//! Request and results of `measure ptc`, with histograms of the deviations of pixels.

use std::path::PathBuf;

use clap::Args;
use etendue_metrology::photon_transfer::{Deviations, Figures, Nonuniformity, Stack, TransferData};

use crate::measure::readings::Selection;
use crate::plot::{Axis, Mark, Plot, Series};
use crate::report::{Cell, Report, Table};

/// `etendue measure ptc`
#[derive(Args, Clone, Debug)]
pub struct PtcRequest {
    /// Descriptor file of the EMVA 1288 reference program: light levels with their images, two per level for the curve, more for
    /// DSNU and PRNU
    #[arg(value_name = "DESCRIPTOR.txt")]
    pub descriptor: PathBuf,
    /// The descriptor's photons are relative: leave out results that need their number
    #[arg(long)]
    pub relative_light: bool,
    /// Part and channel of the images.
    #[command(flatten)]
    pub selection: Selection,
}

impl PtcRequest {
    /// Creates a request with the program's defaults.
    pub fn new(descriptor: impl Into<PathBuf>) -> Self {
        Self { descriptor: descriptor.into(), relative_light: false, selection: Selection::default() }
    }
}

impl PtcRequest {
    /// Creates a request for the figures alone.
    pub(crate) fn from_descriptor(descriptor: PathBuf, selection: &Selection) -> Self {
        Self { descriptor, relative_light: true, selection: selection.clone() }
    }
}

/// All results.
pub(crate) struct PtcResults {
    pub(crate) data: TransferData,
    pub(crate) figures: Figures,
    pub(crate) fixed: Option<FixedPatterns>,
    /// Notes of clipped images that enter the result.
    pub(crate) clippings: Vec<String>,
}

/// Fixed patterns, from the stacks.
pub(crate) struct FixedPatterns {
    pub(crate) dark: Stack,
    pub(crate) bright: Stack,
    pub(crate) patterns: Nonuniformity,
}

pub(super) fn report_patterns(report: &mut Report, fixed: &FixedPatterns) {
    let dark = Deviations::from_dark(&fixed.dark);
    let response = Deviations::from_response(&fixed.dark, &fixed.bright);
    report.fact("dsnu_sigma_dn", "deviation of most pixels without light", "DN", dark.sigma);
    report.fact("prnu_sigma_percent", "deviation of most pixels' responses", "%", response.sigma);
    let kinds = [
        (["dsnu_histogram", "dsnu_accumulated"], "without light", "deviation from the mean, DN", dark),
        (["prnu_histogram", "prnu_accumulated"], "of the response", "deviation from the mean response, %", response),
    ];
    for ([histogram, accumulated], title, axis, deviations) in kinds {
        report.table_if(false, counts(histogram, &deviations));
        report.table_if(false, fraction_table(accumulated, &deviations));
        report.plot(logarithmic(title, axis, &deviations));
        report.plot(cumulative(title, axis, &deviations));
    }
}

fn counts(key: &'static str, deviations: &Deviations) -> Table {
    let row = |(x, n): &(f64, u64)| {
        vec![Cell::Number(*x, 4), Cell::Number(*n as f64, 0), Cell::Number(deviations.normal(*x), 2)]
    };
    let columns = vec![("deviation", "deviation"), ("pixels", "pixels"), ("normal_pixels", "normal")];
    Table { key, columns, rows: deviations.bins.iter().map(row).collect() }
}

fn fraction_table(key: &'static str, deviations: &Deviations) -> Table {
    let row = |(x, fraction): &(f64, f64)| vec![Cell::Number(*x, 4), Cell::Number(100.0 * fraction, 6)];
    let columns = vec![("deviation", "deviation"), ("farther_percent", "larger deviation %")];
    Table { key, columns, rows: deviations.accumulated.iter().map(row).collect() }
}

/// Omits bins without a pixel, and the normal distribution below a tenth of a pixel.
fn logarithmic(title: &str, axis: &str, deviations: &Deviations) -> Plot {
    const MIN_COUNT: f64 = 0.1;
    let counted = deviations.bins.iter().filter(|(_, n)| *n > 0).map(|(x, n)| (*x, *n as f64));
    let steps = (-80..=80).map(|i| f64::from(i) * 0.1 * deviations.sigma);
    let normal = steps.map(|x| (x, deviations.normal(x))).filter(|(_, n)| *n > MIN_COUNT);
    Plot {
        title: format!("pixels by deviation {title}"),
        x: Axis::linear(axis).showing(&[0.0]),
        y: Axis::log("pixels per bin"),
        series: vec![Series::new("counted", Mark::Points, counted), Series::new("normal", Mark::Broken, normal)],
    }
}

fn cumulative(title: &str, axis: &str, deviations: &Deviations) -> Plot {
    let percentages = deviations
        .accumulated
        .iter()
        .filter(|(_, fraction)| *fraction > 0.0)
        .map(|(x, fraction)| (*x, 100.0 * fraction));
    Plot {
        title: format!("pixels with larger deviation {title}"),
        x: Axis::linear(axis).showing(&[0.0]),
        y: Axis::log("pixels, %"),
        series: vec![Series::new("", Mark::Line, percentages)],
    }
}
