//! `etendue measure ptc`: photon transfer after EMVA 1288.

use super::readings::Selection;
use super::report::{Cell, Report, Table, Telling};
use crate::failure::Failure;
use crate::plot::{Axis, Mark, Plot, Series};
use clap::Args;
use etendue_io::emva_descriptor::{DescribedLevel, EmvaDescriptor, read_emva_descriptor};
use etendue_metrology::Estimate;
use etendue_metrology::photon_transfer::{
    Figures, Level, Nonuniformity, Parts, Pattern, Stack, TransferData, TransferError, model_snr, nonuniformity,
    spectrogram,
};
use rayon::prelude::*;
use std::path::PathBuf;

/// `etendue measure ptc`
#[derive(Debug, Args)]
pub struct Ptc {
    /// A descriptor file of the EMVA 1288 reference program: levels of light with their pictures, two a level for the curve, more
    /// for DSNU and PRNU
    #[arg(value_name = "DESCRIPTOR.txt")]
    pub descriptor: PathBuf,
    /// The descriptor's photons are relative: leave out what needs their number
    #[arg(long)]
    pub relative_light: bool,
    #[command(flatten)]
    pub selection: Selection,
    #[command(flatten)]
    pub telling: Telling,
}

impl Ptc {
    /// A measurement that is not told by itself.
    pub(super) fn of(descriptor: PathBuf, selection: &Selection) -> Self {
        let telling = Telling { json: false, plot: None, camera_out: None };
        Self { descriptor, relative_light: true, selection: selection.clone(), telling }
    }
}

/// Everything that was found.
struct Found {
    data: TransferData,
    figures: Figures,
    fixed: Option<Fixed>,
}

/// Of the stacks.
struct Fixed {
    dark: Stack,
    bright: Stack,
    patterns: Nonuniformity,
}

pub(super) fn run(arguments: &Ptc) -> Result<(), Failure> {
    let descriptor = read_emva_descriptor(&arguments.descriptor).map_err(Failure::input)?;
    let found = measure(arguments, &descriptor)?;
    report(arguments, &found).tell(&arguments.telling)
}

/// The curve's figures.
pub(super) fn measured(arguments: &Ptc) -> Result<Figures, Failure> {
    let descriptor = read_emva_descriptor(&arguments.descriptor).map_err(Failure::input)?;
    Ok(measure(arguments, &descriptor)?.figures)
}

fn measure(arguments: &Ptc, descriptor: &EmvaDescriptor) -> Result<Found, Failure> {
    let (pairs, stacks): (Vec<_>, Vec<_>) = descriptor.levels.iter().partition(|level| level.files.len() == 2);
    let levels: Vec<(Level, Vec<u64>)> =
        pairs.par_iter().map(|level| pair(arguments, descriptor, level)).collect::<Result<_, Failure>>()?;
    let bright = |(level, marks): &(Level, Vec<u64>)| if level.photons > 0.0 { marks.clone() } else { Vec::new() };
    let mut marks: Vec<u64> = levels.iter().flat_map(bright).collect();
    marks.sort_unstable();
    if marks.windows(2).any(|pair| pair[0] == pair[1]) {
        return Err(refused(TransferError::Copies));
    }
    let levels: Vec<Level> = levels.into_iter().map(|(level, _)| level).collect();
    let data = TransferData::new(&levels).map_err(refused)?;
    let figures = data.figures().map_err(refused)?;
    let fixed = fixed_patterns(arguments, descriptor, &stacks, &data, &figures)?;
    Ok(Found { data, figures, fixed })
}

fn refused(error: TransferError) -> Failure {
    Failure::input(error)
}

fn pair(arguments: &Ptc, descriptor: &EmvaDescriptor, level: &DescribedLevel) -> Result<(Level, Vec<u64>), Failure> {
    let stack = stack(arguments, descriptor, level)?;
    let statistics = stack.statistics().map_err(refused)?;
    let marks = stack.fingerprints().to_vec();
    Ok((Level { exposure_s: level.exposure_s, photons: level.photons, statistics }, marks))
}

/// A level's pictures, one after another.
fn stack(arguments: &Ptc, descriptor: &EmvaDescriptor, level: &DescribedLevel) -> Result<Stack, Failure> {
    let mut stack: Option<Stack> = None;
    for file in &level.files {
        let image = arguments.selection.raw(file)?.image;
        let whole = arguments.selection.region.is_none() && arguments.selection.channel.is_none();
        let size = (image.width(), image.height());
        let told = (descriptor.width, descriptor.height);
        if whole && size != told {
            return Err(Failure::input(format!(
                "{}: {}",
                file.display(),
                TransferError::Size { size, expected: told }
            )));
        }
        let named = |error: TransferError| Failure::input(format!("{}: {error}", file.display()));
        stack.get_or_insert_with(|| Stack::new(image.width(), image.height())).push(&image).map_err(named)?;
    }
    Ok(stack.expect("a described level has pictures"))
}

fn fixed_patterns(
    arguments: &Ptc,
    descriptor: &EmvaDescriptor,
    stacks: &[&DescribedLevel],
    data: &TransferData,
    figures: &Figures,
) -> Result<Option<Fixed>, Failure> {
    let dark = stacks.iter().find(|level| level.photons == 0.0);
    let bright = stacks.iter().find(|level| level.photons > 0.0);
    let (dark, bright) = match (dark, bright) {
        (Some(dark), Some(bright)) => (dark, bright),
        (None, None) => return Ok(None),
        _ => {
            return Err(Failure::input(
                "stacks of more than two pictures: expected one with light and one without, of one exposure time",
            ));
        }
    };
    if stacks.len() > 2 || dark.exposure_s != bright.exposure_s {
        return Err(Failure::input("stacks of more than two pictures: expected two, of one exposure time"));
    }
    let (dark, bright) = (stack(arguments, descriptor, dark)?, stack(arguments, descriptor, bright)?);
    let pattern = |stack| Pattern::of(stack).map_err(refused);
    let patterns = nonuniformity(&pattern(&dark)?, &pattern(&bright)?, figures.gain_dn_per_e, data).map_err(refused)?;
    Ok(Some(Fixed { dark, bright, patterns }))
}

fn report(arguments: &Ptc, found: &Found) -> Report {
    let mut report = Report::new("ptc", "EMVA 1288 release 4.0 linear (± one standard uncertainty)");
    figures(&mut report, &found.figures, arguments.relative_light);
    if let Some(fixed) = &found.fixed {
        nonuniformities(&mut report, &fixed.patterns);
    } else {
        report
            .note("DSNU and PRNU need stacks of more than two pictures: one without light, one at half of saturation");
    }
    if !found.data.saturation_reached() {
        report.note("the variance does not fall at the brightest level: saturation lies at or above it; capacity, SNR and dynamic range are lower bounds");
    }
    if found.data.dark().len() < 3 {
        report.note("the dark current needs dark levels of at least three exposure times");
    }
    report.table(curve(&found.data));
    report.camera(camera(found));
    plots(&mut report, found);
    report
}

fn figures(report: &mut Report, f: &Figures, relative: bool) {
    let mut line = |key: &str, label: &str, unit, value| report.figure(key, label, unit, value);
    line("gain_dn_per_e", "gain K", "DN/e⁻", f.gain_dn_per_e);
    if !relative {
        line("quantum_efficiency", "quantum efficiency η", "", f.quantum_efficiency);
        line("responsivity_dn_per_photon", "responsivity R", "DN/photon", f.responsivity_dn_per_photon);
    }
    line("dark_noise_dn", "dark noise σ_y.dark", "DN", f.dark_noise_dn);
    line("dark_noise_e", "dark noise σ_d", "e⁻", f.dark_noise_e);
    line("dark_level_dn", "dark level", "DN", f.dark_level_dn);
    if !relative {
        line("threshold_photons", "sensitivity threshold μ_p.min", "photons", f.threshold_photons);
        line("saturation_photons", "saturation μ_p.sat", "photons", f.saturation_photons);
    }
    line("threshold_e", "sensitivity threshold μ_e.min", "e⁻", f.threshold_e);
    line("saturation_e", "saturation capacity μ_e.sat", "e⁻", f.saturation_e);
    line("snr_max", "largest SNR", "", f.snr_max);
    line("snr_max_db", "largest SNR", "dB", decibels(f.snr_max));
    line("dynamic_range", "dynamic range", "", f.dynamic_range);
    line("dynamic_range_db", "dynamic range", "dB", decibels(f.dynamic_range));
    line("linearity_error_percent", "linearity error LE", "%", f.linearity_error.scaled(100.0));
    line("linearity_error_min_percent", "linearity error, least", "%", f.linearity_error_min.scaled(100.0));
    line("linearity_error_max_percent", "linearity error, most", "%", f.linearity_error_max.scaled(100.0));
    if let (Some(mean), Some(variance)) = (f.dark_current_mean_e_per_s, f.dark_current_variance_e_per_s) {
        line("dark_current_mean_e_per_s", "dark current, from means", "e⁻/s", mean);
        line("dark_current_variance_e_per_s", "dark current, from variances", "e⁻/s", variance);
    }
}

/// Keys of a camera file's sensor, each with its standard uncertainty.
fn camera(found: &Found) -> String {
    let f = &found.figures;
    let mut text = "# Measured photon transfer, ± one standard uncertainty: for [sensor] of a camera file.\nformat = 1\n\n[sensor]\n".to_owned();
    let mut line = |key: &str, e: Estimate| {
        text += &format!("{key} = {} # ± {:.2e}\n", e.value.max(0.0), e.standard_uncertainty);
    };
    line("gain_dn_per_e", f.gain_dn_per_e);
    line("read_noise_e", f.dark_noise_e);
    line("full_well_e", f.saturation_e);
    line("black_level_dn", f.dark_level_dn);
    if let Some(current) = f.dark_current_mean_e_per_s {
        line("dark_current_e_s", current);
    }
    if let Some(fixed) = &found.fixed {
        text += "\n[sensor.non_uniformity]\n";
        let mut line = |key: &str, e: Estimate| {
            text += &format!("{key} = {} # ± {:.2e}\n", e.value, e.standard_uncertainty);
        };
        let (dsnu, prnu) = (fixed.patterns.dsnu_e, fixed.patterns.prnu);
        line("dsnu_e", dsnu.pixel);
        line("dsnu_row_e", dsnu.row);
        line("dsnu_column_e", dsnu.column);
        line("prnu", prnu.pixel);
        line("prnu_row", prnu.row);
        line("prnu_column", prnu.column);
    }
    text
}

fn decibels(ratio: Estimate) -> Estimate {
    use etendue_core::maths::f64::log10;
    let slope = 20.0 / std::f64::consts::LN_10 / ratio.value;
    Estimate::new(20.0 * log10(ratio.value), slope * ratio.standard_uncertainty)
}

fn nonuniformities(report: &mut Report, n: &Nonuniformity) {
    let mut parts = |key: &str, label: &str, unit, parts: Parts<Estimate>| {
        let named = [("", ""), ("_row", ", rows"), ("_column", ", columns"), ("_pixel", ", pixels")];
        for ((suffix, of), value) in named.into_iter().zip([parts.total, parts.row, parts.column, parts.pixel]) {
            report.figure(&format!("{key}{suffix}"), &format!("{label}{of}"), unit, value);
        }
    };
    parts("dsnu_e", "DSNU", "e⁻", n.dsnu_e);
    parts("dsnu_dn", "DSNU", "DN", n.dsnu_dn);
    parts("prnu_percent", "PRNU", "%", n.prnu.map(|e| e.scaled(100.0)));
    let shared = |dn: f64| Estimate::new(dn, 0.0);
    report.figure("row_noise_dn", "temporal noise of rows, dark", "DN", shared(n.row_noise_dn));
    report.figure("column_noise_dn", "temporal noise of columns, dark", "DN", shared(n.column_noise_dn));
}

fn curve(data: &TransferData) -> Table {
    let (snr, deviations) = (data.snr(), data.linearity_deviations());
    let row = |i: usize| {
        let level = &data.bright()[i];
        vec![
            Cell::Number(1000.0 * level.exposure_s, 4),
            Cell::Number(level.photons, 1),
            Cell::Number(data.signal_dn(i), 3),
            Cell::Estimate(level.statistics.variance_dn2),
            Cell::Number(snr[i].snr.value, 3),
            Cell::Number(100.0 * deviations[i], 3),
            Cell::Text(if i == data.saturation() { "saturation".to_owned() } else { String::new() }),
        ]
    };
    Table {
        key: "levels",
        columns: vec![
            ("exposure_ms", "exposure ms"),
            ("photons", "photons"),
            ("signal_dn", "signal DN"),
            ("variance_dn2", "variance DN²"),
            ("snr", "SNR"),
            ("linearity_deviation_percent", "deviation %"),
            ("mark", ""),
        ],
        rows: (0..data.bright().len()).map(row).collect(),
    }
}

fn plots(report: &mut Report, found: &Found) {
    report.plot(transfer_plot(found));
    report.plot(snr_plot(found));
    report.plot(linearity_plot(&found.data));
    if let Some(fixed) = &found.fixed {
        report.plot(spectrogram_plot("spectrogram without light", &fixed.dark));
        report.plot(spectrogram_plot("spectrogram with light", &fixed.bright));
    }
}

fn transfer_plot(found: &Found) -> Plot {
    let (data, gain) = (&found.data, found.figures.gain_dn_per_e.value);
    let excess = |i: usize| {
        let (variance, dark) = (data.bright()[i].statistics.variance_dn2, data.dark_of(i).statistics.variance_dn2);
        (data.signal_dn(i), variance.value - dark.value, 2.0 * variance.standard_uncertainty)
    };
    let end = data.signal_dn(data.sensitivity_end() - 1);
    Plot {
        title: "photon transfer (bars: 95 %)".to_owned(),
        x: Axis::linear("mean less dark mean, DN").showing(&[0.0]),
        y: Axis::linear("temporal variance less that of the dark, DN²").showing(&[0.0]),
        series: vec![
            Series::with_errors("measured", Mark::Points, (0..data.bright().len()).map(excess)),
            Series::new("K, fitted up to 70 % of saturation", Mark::Line, [(0.0, 0.0), (end, gain * end)]),
        ],
    }
}

fn snr_plot(found: &Found) -> Plot {
    let (data, f) = (&found.data, &found.figures);
    let measured = data.snr().into_iter().map(|p| (p.photons, p.snr.value, 2.0 * p.snr.standard_uncertainty));
    let (first, last) = (data.bright()[0].photons, f.saturation_photons.value);
    let light = |i: i32| first * etendue_core::maths::f64::pow(last / first, f64::from(i) / 60.0);
    let model = |dsnu_e: f64, prnu: f64| {
        move |p: f64| {
            let electrons = p * f.quantum_efficiency.value;
            (p, model_snr(electrons, f.dark_noise_e.value, f.gain_dn_per_e.value, dsnu_e, prnu))
        }
    };
    let mut series = vec![
        Series::with_errors("measured", Mark::Points, measured),
        Series::new("linear model", Mark::Line, (0..=60).map(light).map(model(0.0, 0.0))),
    ];
    if let Some(fixed) = &found.fixed {
        let (dsnu, prnu) = (fixed.patterns.dsnu_e.total.value, fixed.patterns.prnu.total.value);
        series.push(Series::new("with DSNU and PRNU", Mark::Broken, (0..=60).map(light).map(model(dsnu, prnu))));
    }
    Plot { title: "signal-to-noise ratio".to_owned(), x: Axis::log("photons a pixel"), y: Axis::log("SNR"), series }
}

fn linearity_plot(data: &TransferData) -> Plot {
    let deviations = data.linearity_deviations();
    let points = data.linearity_range().map(|i| (data.bright()[i].photons, 100.0 * deviations[i]));
    Plot {
        title: "deviation from a straight line, 5 to 95 % of saturation".to_owned(),
        x: Axis::linear("photons a pixel").showing(&[0.0]),
        y: Axis::linear("deviation, %").showing(&[0.0]),
        series: vec![Series::new("", Mark::Points, points)],
    }
}

fn spectrogram_plot(title: &str, stack: &Stack) -> Plot {
    let average = stack.average();
    let line = |power: Vec<f64>| {
        let length = 2.0 * (power.len() as f64 - 1.0);
        power.into_iter().enumerate().skip(1).map(move |(k, p)| (k as f64 / length, p.max(0.0).sqrt()))
    };
    Plot {
        title: title.to_owned(),
        x: Axis::linear("cycles a pixel"),
        y: Axis::log("amplitude, DN"),
        series: vec![
            Series::new("along rows", Mark::Line, line(spectrogram::horizontal(&average, stack.width()))),
            Series::new("along columns", Mark::Line, line(spectrogram::vertical(&average, stack.width()))),
        ],
    }
}
