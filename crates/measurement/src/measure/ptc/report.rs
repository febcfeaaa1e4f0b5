//! Results of photon transfer, as text and as keys of a camera file.

use etendue_metrology::Estimate;
use etendue_metrology::photon_transfer::{Figures, Nonuniformity, TransferData, VarianceComponents};

use super::plots;
use super::request::{self, PtcRequest, PtcResults};
use crate::report::{Cell, Report, Table};

pub(crate) fn report(request: &PtcRequest, results: &PtcResults) -> Report {
    let mut report = Report::new("ptc", "EMVA 1288 release 4.0 linear (± one standard uncertainty)");
    if let Some(channel) = &request.selection.channel {
        report.setting("channel", channel.clone());
    }
    figures(&mut report, &results.figures, request.relative_light);
    if let Some(fixed) = &results.fixed {
        nonuniformities(&mut report, &fixed.patterns);
    } else {
        report
            .note("DSNU and PRNU need stacks of more than two images: one without light and one at half of saturation");
    }
    if !results.data.saturation_reached() {
        report.note("the variance does not fall at the brightest level, so saturation is at or above it; capacity, SNR and dynamic range are lower bounds");
    }
    if results.data.dark().len() < 3 {
        report.note("the dark current needs dark levels of at least three exposure times");
    }
    results.clippings.iter().for_each(|cut| report.note(cut));
    report.table(curve(&results.data));
    report.camera(camera(results));
    plots::draw(&mut report, results);
    if let Some(fixed) = &results.fixed {
        request::report_patterns(&mut report, fixed);
    }
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
    for (key, label, value) in [
        ("linearity_error_percent", "linearity error LE", f.linearity_error),
        (
            "linearity_error_of_noise_percent",
            "linearity error of a linear sensor due to noise",
            f.linearity_error_of_noise,
        ),
        ("linearity_error_min_percent", "linearity error, minimum", f.linearity_error_min),
        ("linearity_error_max_percent", "linearity error, maximum", f.linearity_error_max),
    ] {
        report.fact(key, label, "%", 100.0 * value);
    }
    let mut line = |key: &str, label: &str, unit, value| report.figure(key, label, unit, value);
    if let (Some(mean), Some(variance)) = (f.dark_current_mean_e_per_s, f.dark_current_variance_e_per_s) {
        line("dark_current_mean_e_per_s", "dark current, from means", "e⁻/s", mean);
        line("dark_current_variance_e_per_s", "dark current, from variances", "e⁻/s", variance);
    }
}

/// Keys of a camera file's sensor, each with its standard uncertainty.
fn camera(results: &PtcResults) -> String {
    let f = &results.figures;
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
    if let Some(fixed) = &results.fixed {
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
    let mut parts = |key: &str, label: &str, unit, parts: VarianceComponents<Estimate>| {
        let named = [("", ""), ("_row", ", rows"), ("_column", ", columns"), ("_pixel", ", pixels")];
        for ((suffix, component), value) in named.into_iter().zip([parts.total, parts.row, parts.column, parts.pixel]) {
            report.figure(&format!("{key}{suffix}"), &format!("{label}{component}"), unit, value);
        }
    };
    parts("dsnu_e", "DSNU", "e⁻", n.dsnu_e);
    parts("dsnu_dn", "DSNU", "DN", n.dsnu_dn);
    parts("prnu_percent", "PRNU", "%", n.prnu.map(|e| e.scaled(100.0)));
    report.fact("row_noise_dn", "temporal noise of rows, dark", "DN", n.row_noise_dn);
    report.fact("column_noise_dn", "temporal noise of columns, dark", "DN", n.column_noise_dn);
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
