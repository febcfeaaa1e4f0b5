//! Photon transfer from levels with random means and variances of known distribution, and dark currents over temperature.

use super::{normals, unit};
use crate::coverage::{CoverageRun, assert_coverage};
use etendue_core::maths::f64::{exp, ln};
use etendue_metrology::Estimate;
use etendue_metrology::photon_transfer::temperature::{GrowthLaw, fit};
use etendue_metrology::photon_transfer::{Level, LevelStatistics, TransferData};
use etendue_stats::normal::cdf;

const GAIN: f64 = 0.4;
const QUANTUM_EFFICIENCY: f64 = 0.55;
const DARK_NOISE_E: f64 = 8.0;
const FULL_WELL_E: f64 = 9000.0;
/// Pixels per frame.
const PIXELS: f64 = 40_000.0;

/// Mean and variance of a Gaussian of mean and variance m, clipped at the full well, e⁻.
fn clipped(m: f64) -> (f64, f64) {
    let (s, z) = (m.sqrt(), (FULL_WELL_E - m) / m.sqrt());
    let (below, density) = (cdf(z), exp(-0.5 * z * z) / core::f64::consts::TAU.sqrt());
    let mean = below * m - s * density + (1.0 - below) * FULL_WELL_E;
    let square = below * (m * m + m) - s * density * (m + FULL_WELL_E) + (1.0 - below) * FULL_WELL_E * FULL_WELL_E;
    (mean, square - mean * mean)
}

/// Light of maximum variance, photons.
fn peak_photons() -> f64 {
    let steps = (0..4000).map(|i| 7000.0 + 0.5 * f64::from(i));
    steps.max_by(|a, b| clipped(*a).1.total_cmp(&clipped(*b).1)).expect("steps") / QUANTUM_EFFICIENCY
}

fn transfer(seed: u64) -> CoverageRun {
    let mut normal = normals(seed, 0);
    let mut level = |exposure_s: f64, photons: f64| {
        let (mean_e, variance_e2) = if photons > 0.0 { clipped(QUANTUM_EFFICIENCY * photons) } else { (0.0, 0.0) };
        let variance = GAIN * GAIN * (variance_e2 + DARK_NOISE_E * DARK_NOISE_E) + 1.0 / 12.0;
        let drawn = |normal: &mut dyn FnMut() -> f64, value: f64, u: f64| Estimate::new(value + u * normal(), u);
        let statistics = LevelStatistics {
            mean_dn: drawn(&mut normal, 40.0 + GAIN * mean_e, (variance / PIXELS / 2.0).sqrt()),
            variance_dn2: drawn(&mut normal, variance, variance * (2.0 / PIXELS).sqrt()),
        };
        Level { exposure_s, photons, statistics }
    };
    // The light of the steps differs between runs, so that the peak can be anywhere between two.
    let step = (1.0 + 0.1 * unit(seed)) * 900.0 / QUANTUM_EFFICIENCY;
    let times = (1..=14).map(|i| f64::from(i) * 1e-3);
    let levels: Vec<Level> = times.flat_map(|t| [level(t, 1e3 * t * step), level(t, 0.0)]).collect();
    let data = TransferData::new(&levels).expect("levels");
    let f = data.figures().expect("figures");
    let threshold_e = (DARK_NOISE_E * DARK_NOISE_E + 1.0 / 12.0 / GAIN / GAIN).sqrt() + 0.5;
    let saturation = peak_photons();
    let saturation_e = QUANTUM_EFFICIENCY * saturation;
    vec![
        ("threshold, photons", f.threshold_photons, threshold_e / QUANTUM_EFFICIENCY),
        ("threshold, e⁻", f.threshold_e, threshold_e),
        ("dark noise, DN", f.dark_noise_dn, (threshold_e - 0.5) * GAIN),
        ("saturation, photons", f.saturation_photons, saturation),
        ("saturation, e⁻", f.saturation_e, saturation_e),
        ("largest SNR", f.snr_max, saturation_e.sqrt()),
        ("dynamic range", f.dynamic_range, saturation_e / threshold_e),
        ("SNR of a level", data.snr()[4].snr, {
            let e = QUANTUM_EFFICIENCY * data.snr()[4].photons;
            e / (e + DARK_NOISE_E * DARK_NOISE_E + 1.0 / 12.0 / GAIN / GAIN).sqrt()
        }),
    ]
}

#[test]
fn capacity_threshold_and_range() {
    assert_coverage("photon transfer, limits", transfer);
}

/// 12 e⁻/s at 30 °C, doubling every 8 K, each current with an uncertainty of 5 % and 6 e⁻/s: the coldest is often negative.
#[test]
fn dark_current_over_temperature() {
    assert_coverage("dark current over temperature", |seed| {
        let mut normal = normals(seed, 0);
        let mut current = |i: i32| {
            let celsius = 20.0 + 10.0 * f64::from(i);
            let truth = 12.0 * exp((celsius - 30.0) / 8.0 * ln(2.0));
            let u = (0.0025 * truth * truth + 36.0).sqrt();
            (celsius, Estimate::new(truth + u * normal(), u))
        };
        let series: Vec<(f64, Estimate)> = (0..6).map(&mut current).collect();
        let growth = fit(GrowthLaw::Doubling, &series, 30.0).expect("a fit");
        vec![("at the reference", growth.reference_e_per_s, 12.0), ("doubling temperature", growth.doubling_k, 8.0)]
    });
}
