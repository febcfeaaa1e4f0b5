//! Curves of photon transfer.

use etendue_metrology::photon_transfer::{Stack, TransferData, model_snr, spatial};

use super::request::PtcResults;
use crate::plot::{Axis, Mark, Plot, Series};
use crate::report::Report;

pub(super) fn draw(report: &mut Report, results: &PtcResults) {
    report.plot(transfer_plot(results));
    report.plot(snr_plot(results));
    report.plot(linearity_plot(&results.data));
    if let Some(fixed) = &results.fixed {
        report.plot(spectrogram_plot("spectrogram without light", &fixed.dark));
        report.plot(spectrogram_plot("spectrogram with light", &fixed.bright));
    }
}

fn transfer_plot(results: &PtcResults) -> Plot {
    let (data, gain) = (&results.data, results.figures.gain_dn_per_e.value);
    let excess = |i: usize| {
        let (variance, dark) = (data.bright()[i].statistics.variance_dn2, data.dark_of(i).statistics.variance_dn2);
        (data.signal_dn(i), variance.value - dark.value, 2.0 * variance.standard_uncertainty)
    };
    let end = data.signal_dn(data.sensitivity_end() - 1);
    Plot {
        title: "photon transfer (bars: 95 %)".to_owned(),
        x: Axis::linear("mean minus dark mean, DN").showing(&[0.0]),
        y: Axis::linear("temporal variance minus dark variance, DN²").showing(&[0.0]),
        series: vec![
            Series::with_errors("measured", Mark::Points, (0..data.bright().len()).map(excess)),
            Series::new("K, fitted up to 70 % of saturation", Mark::Line, [(0.0, 0.0), (end, gain * end)]),
        ],
    }
}

fn snr_plot(results: &PtcResults) -> Plot {
    let (data, f) = (&results.data, &results.figures);
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
    if let Some(fixed) = &results.fixed {
        let (dsnu, prnu) = (fixed.patterns.dsnu_e.total.value, fixed.patterns.prnu.total.value);
        series.push(Series::new("with DSNU and PRNU", Mark::Broken, (0..=60).map(light).map(model(dsnu, prnu))));
    }
    Plot { title: "signal-to-noise ratio".to_owned(), x: Axis::log("photons per pixel"), y: Axis::log("SNR"), series }
}

fn linearity_plot(data: &TransferData) -> Plot {
    let deviations = data.linearity_deviations();
    let points = data.linearity_range().map(|i| (data.bright()[i].photons, 100.0 * deviations[i]));
    Plot {
        title: "deviation from a straight line, 5 to 95 % of saturation".to_owned(),
        x: Axis::linear("photons per pixel").showing(&[0.0]),
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
        x: Axis::linear("cycles per pixel"),
        y: Axis::log("amplitude, DN"),
        series: vec![
            Series::new("along rows", Mark::Line, line(spatial::horizontal(&average, stack.width()))),
            Series::new("along columns", Mark::Line, line(spatial::vertical(&average, stack.width()))),
        ],
    }
}
