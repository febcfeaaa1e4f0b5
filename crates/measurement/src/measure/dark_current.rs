//! `measure dark-current`: growth of dark current with temperature.

use std::path::PathBuf;

use clap::Args;
use etendue_core::observer::Observer;
use etendue_io::failure::{Error, ErrorCode};
use etendue_metrology::Estimate;
use etendue_metrology::photon_transfer::temperature::{DarkCurrentFit, GrowthLaw, fit};
use etendue_stats::chi_square;

use super::ptc::{PtcRequest, measured};
use super::readings::Selection;
use crate::plot::{Axis, Mark, Plot, Series};
use crate::report::{Cell, Report, Table};

/// `etendue measure dark-current`
#[derive(Args, Clone, Debug)]
pub struct DarkCurrentRequest {
    /// Photon-transfer descriptors at several sensor temperatures in °C, three or more
    #[arg(value_name = "CELSIUS:DESCRIPTOR.txt", required = true, value_parser = series)]
    pub series: Vec<(f64, PathBuf)>,
    /// Temperature at which the dark current is reported, °C
    #[arg(long, value_name = "CELSIUS", default_value_t = 25.0, allow_negative_numbers = true)]
    pub reference_c: f64,
    /// Part and channel of the images.
    #[command(flatten)]
    pub selection: Selection,
}

/// Parses a temperature and its descriptor.
fn series(text: &str) -> Result<(f64, PathBuf), String> {
    let both = text.split_once(':').and_then(|(celsius, file)| Some((celsius.parse().ok()?, PathBuf::from(file))));
    both.ok_or_else(|| format!("expected CELSIUS:DESCRIPTOR.txt, e.g. 45:warm/list.txt, not '{text}'"))
}

impl DarkCurrentRequest {
    /// Creates a request with the program's defaults.
    pub fn new(series: Vec<(f64, PathBuf)>) -> Self {
        Self { series, reference_c: 25.0, selection: Selection::default() }
    }
}

fn name(law: GrowthLaw) -> (&'static str, &'static str) {
    match law {
        GrowthLaw::Doubling => ("doubling", "doubling at a fixed temperature interval"),
        GrowthLaw::Generation => ("generation", "generation in depleted silicon"),
        GrowthLaw::Diffusion => ("diffusion", "diffusion in silicon"),
    }
}

/// Growth of dark current with temperature, by three laws.
///
/// # Errors
/// If a descriptor cannot be used or there are too few temperatures.
pub fn dark_current(request: &DarkCurrentRequest, observer: &dyn Observer) -> Result<Report, Error> {
    let mut encodings = Vec::new();
    let current = |(celsius, descriptor): &(f64, PathBuf)| {
        let (figures, stated) =
            measured(&PtcRequest::from_descriptor(descriptor.clone(), &request.selection), observer)?;
        encodings.push(stated);
        let current = figures.dark_current_mean_e_per_s.ok_or_else(|| {
            Error::coded(
                ErrorCode::NotMeasurable,
                format!("{}: expected dark levels of at least three exposure times", descriptor.display()),
            )
        })?;
        Ok((*celsius, current))
    };
    let currents = request.series.iter().map(current).collect::<Result<Vec<_>, Error>>()?;
    let fits = GrowthLaw::ALL
        .into_iter()
        .map(|law| {
            fit(law, &currents, request.reference_c)
                .map_err(|error| Error::coded(ErrorCode::NotMeasurable, error.to_string()))
        })
        .collect::<Result<Vec<_>, _>>()?;
    if let Some(pair) = copies(&currents) {
        let [a, b] = pair.map(|i| request.series[i].1.display());
        return Err(Error::coded(
            ErrorCode::NotComparable,
            format!("{a} and {b} contain the same measurement; give a separate one for each temperature"),
        ));
    }
    let mut report = report(&currents, &fits, request.reference_c);
    encodings.iter().for_each(|stated| report.encoding(stated));
    Ok(report)
}

/// Returns two measurements that are bit-identical.
fn copies(currents: &[(f64, Estimate)]) -> Option<[usize; 2]> {
    let pairs = (0..currents.len()).flat_map(|i| (0..i).map(move |j| [j, i]));
    pairs.into_iter().find(|[j, i]| currents[*j].1 == currents[*i].1)
}

fn report(currents: &[(f64, Estimate)], fits: &[DarkCurrentFit], reference_c: f64) -> Report {
    let method = "dark current over temperature, EMVA 1288 section 7 and physical models of silicon (± one standard uncertainty)";
    let mut report = Report::new("dark-current", method);
    for growth in fits {
        let (key, label) = name(growth.law);
        let at = format!("at {reference_c} °C: {label}");
        report.figure(&format!("{key}_reference_e_per_s"), &at, "e⁻/s", growth.reference_e_per_s);
        report.figure(&format!("{key}_doubling_k"), "  doubles within", "K", growth.doubling_k);
        let p = chi_square::p_value(growth.chi_square, growth.degrees_of_freedom as f64);
        report.fact(&format!("{key}_p_value"), "  p-value of the fit (χ²)", "", p);
    }
    report.table(Table {
        key: "temperatures",
        columns: vec![("celsius", "°C"), ("dark_current_e_per_s", "dark current e⁻/s")],
        rows: currents.iter().map(|(t, e)| vec![Cell::Number(*t, 2), Cell::Estimate(*e)]).collect(),
    });
    let points = currents.iter().map(|(t, e)| (*t, e.value, 2.0 * e.standard_uncertainty));
    report.plot(Plot {
        title: "dark current (bars: 95 %)".to_owned(),
        x: Axis::linear("temperature, °C"),
        y: Axis::log("dark current, e⁻/s"),
        series: vec![Series::with_errors("measured", Mark::Points, points)],
    });
    report
}
