//! A measurement of a simulated sensor must return its parameters, within the stated uncertainties.

use super::*;
use crate::{Estimate, Image};
use etendue_core::random::{NoiseDraw, NoiseStream, Pixel};
use rand_distr::{Distribution, Normal, Poisson};

/// The declared sensor.
const GAIN: f64 = 0.4;
const QUANTUM_EFFICIENCY: f64 = 0.55;
const DARK_NOISE_E: f64 = 8.0;
const DARK_CURRENT_E_PER_S: f64 = 4000.0;
const BLACK_DN: f64 = 40.0;
const FULL_WELL_E: f64 = 9000.0;
/// Patterns of rows, columns and pixels: e⁻ in the dark, fractions of the response.
const DSNU_E: [f64; 3] = [6.0, 5.0, 9.0];
const PRNU: [f64; 3] = [0.008, 0.006, 0.012];
const SIZE: usize = 32;
const STEPS: u32 = 14;
const PHOTONS_PER_S: f64 = 1.25e6;

struct DeclaredSensor {
    seed: u64,
    offset_e: Vec<f64>,
    response: Vec<f64>,
}

impl DeclaredSensor {
    fn new(seed: u64) -> Self {
        let pattern = |parts: [f64; 3], draws: [NoiseDraw; 3]| -> Vec<f64> {
            let normal = Normal::new(0.0, 1.0).expect("a width");
            let value = |x: usize, y: usize, part: usize| {
                let pixel = Pixel { x: x as u32, y: y as u32 };
                parts[part] * normal.sample(&mut NoiseStream::new(seed, 0, 0, 0, pixel, draws[part]))
            };
            let pixel = |i: usize| (i % SIZE, i / SIZE);
            (0..SIZE * SIZE).map(pixel).map(|(x, y)| value(0, y, 0) + value(x, 0, 1) + value(x, y, 2)).collect()
        };
        let offsets = [NoiseDraw::RowOffset, NoiseDraw::ColumnOffset, NoiseDraw::PixelOffset];
        let responses = [NoiseDraw::RowResponse, NoiseDraw::ColumnResponse, NoiseDraw::PixelResponse];
        Self { seed, offset_e: pattern(DSNU_E, offsets), response: pattern(PRNU, responses) }
    }

    fn frame(&self, exposure_s: f64, photons: f64, frame: u32) -> Image {
        let read = Normal::new(0.0, DARK_NOISE_E).expect("a width");
        let sample = |i: usize| {
            let pixel = Pixel { x: (i % SIZE) as u32, y: (i / SIZE) as u32 };
            let mut random = NoiseStream::new(self.seed, 1, frame, 0, pixel, NoiseDraw::Shot);
            let light = photons * QUANTUM_EFFICIENCY * (1.0 + self.response[i]);
            let mean = light + DARK_CURRENT_E_PER_S * exposure_s;
            let charge: f64 = if mean > 0.0 { Poisson::new(mean).expect("a mean").sample(&mut random) } else { 0.0 };
            let electrons = charge.min(FULL_WELL_E) + self.offset_e[i] + read.sample(&mut random);
            (BLACK_DN + GAIN * electrons).round().max(0.0) as f32
        };
        Image::from_samples(SIZE, SIZE, (0..SIZE * SIZE).map(sample).collect()).expect("a square")
    }

    fn stack(&self, exposure_s: f64, photons: f64, first: u32, frames: u32) -> Stack {
        let mut stack = Stack::new(SIZE, SIZE);
        (first..first + frames).for_each(|i| stack.push(&self.frame(exposure_s, photons, i)).expect("a frame"));
        stack
    }

    fn level(&self, exposure_s: f64, photons: f64, first: u32) -> Level {
        let statistics = self.stack(exposure_s, photons, first, 2).statistics().expect("two frames");
        Level { exposure_s, photons, statistics }
    }

    fn levels(&self) -> Vec<Level> {
        let pair = |i: u32| {
            let exposure_s = f64::from(i + 1) * 1.2e-3;
            [self.level(exposure_s, exposure_s * PHOTONS_PER_S, 4 * i), self.level(exposure_s, 0.0, 4 * i + 2)]
        };
        (0..STEPS).flat_map(pair).collect()
    }

    fn measure(&self) -> (Figures, Nonuniformity) {
        let data = TransferData::new(&self.levels()).expect("levels");
        let figures = data.figures().expect("figures");
        let pattern = |photons, first| Pattern::from_stack(&self.stack(6e-3, photons, first, 8)).expect("a stack");
        let (dark, bright) = (pattern(0.0, 1000), pattern(6e-3 * PHOTONS_PER_S, 2000));
        let patterns = nonuniformity(&dark, &bright, figures.gain_dn_per_e, &data).expect("patterns");
        (figures, patterns)
    }
}

fn quadrature(parts: [f64; 3]) -> f64 {
    parts.iter().map(|p| p * p).sum::<f64>().sqrt()
}

/// (name, measured value, declared value).
fn compared(sensor: &DeclaredSensor) -> Vec<(&'static str, Estimate, f64)> {
    let (f, n) = sensor.measure();
    // The mean response is that of the simulated pixels, not of the population of sensors.
    let response = 1.0 + sensor.response.iter().sum::<f64>() / sensor.response.len() as f64;
    let current = |e: Option<Estimate>| e.expect("many exposure times");
    vec![
        ("gain", f.gain_dn_per_e, GAIN),
        ("responsivity", f.responsivity_dn_per_photon, GAIN * QUANTUM_EFFICIENCY * response),
        ("quantum efficiency", f.quantum_efficiency, QUANTUM_EFFICIENCY * response),
        ("dark noise", f.dark_noise_e, DARK_NOISE_E),
        (
            "dark level",
            f.dark_level_dn,
            BLACK_DN + GAIN * sensor.offset_e.iter().sum::<f64>() / sensor.offset_e.len() as f64,
        ),
        ("dark current of the mean", current(f.dark_current_mean_e_per_s), DARK_CURRENT_E_PER_S),
        ("dark current of the variance", current(f.dark_current_variance_e_per_s), DARK_CURRENT_E_PER_S),
        ("dsnu", n.dsnu_e.total, quadrature(DSNU_E)),
        ("dsnu of rows", n.dsnu_e.row, DSNU_E[0]),
        ("dsnu of columns", n.dsnu_e.column, DSNU_E[1]),
        ("dsnu of pixels", n.dsnu_e.pixel, DSNU_E[2]),
        ("prnu", n.prnu.total, quadrature(PRNU)),
        ("prnu of rows", n.prnu.row, PRNU[0]),
        ("prnu of columns", n.prnu.column, PRNU[1]),
        ("prnu of pixels", n.prnu.pixel, PRNU[2]),
    ]
}

#[test]
fn stated_intervals_cover_the_declared_sensor() {
    crate::coverage::assert_coverage("photon transfer", |seed| compared(&DeclaredSensor::new(seed)));
}

#[test]
fn capacity_range_and_linearity_are_those_declared() {
    let data = TransferData::new(&DeclaredSensor::new(1).levels()).expect("levels");
    assert!(data.saturation_reached());
    let figures = data.figures().expect("figures");
    // The variance is largest at the last level below full well; levels are 825 e⁻ apart.
    let saturation = figures.saturation_e;
    assert!((saturation.value - FULL_WELL_E).abs() < 2.0 * 825.0, "{saturation:?}");
    let threshold = (DARK_NOISE_E * DARK_NOISE_E + 1.0 / 12.0 / GAIN / GAIN).sqrt() + 0.5;
    assert!((figures.threshold_e.value / threshold - 1.0).abs() < 0.05, "{:?}", figures.threshold_e);
    let range = figures.dynamic_range.value * figures.threshold_e.value / saturation.value;
    assert!((range - 1.0).abs() < 1e-12 && (figures.snr_max.value - saturation.value.sqrt()).abs() < 1e-9);
    // Means have an uncertainty of σ/√(2 n) with σ up to 80 e⁻: 0.1 % at the dark end.
    assert!(figures.linearity_error < 2e-3, "{figures:?}");
    // The sensor is linear, so the error is due to noise: a mean of about ten magnitudes scatters by a quarter of itself.
    assert!((figures.linearity_error / figures.linearity_error_of_noise - 1.0).abs() < 0.75, "{figures:?}");
    assert!(figures.linearity_error_min <= 0.0 && figures.linearity_error_max >= 0.0);
    let half = data.snr()[STEPS as usize / 2];
    let model =
        model_snr(half.photons * QUANTUM_EFFICIENCY, (DARK_NOISE_E * DARK_NOISE_E + 36.0).sqrt(), GAIN, 0.0, 0.0);
    assert!((half.snr.value - model).abs() < 4.0 * half.snr.standard_uncertainty, "{half:?} {model}");
}

#[test]
fn rows_that_jump_are_no_fixed_pattern() {
    let normal = Normal::new(0.0, 1.0).expect("a width");
    let mut stack = Stack::new(64, 64);
    for frame in 0..16 {
        let noise_at =
            |x: u32, y: u32, purpose| normal.sample(&mut NoiseStream::new(7, 0, frame, 0, Pixel { x, y }, purpose));
        let sample =
            |i: u32| 100.0 + 3.0 * noise_at(0, i / 64, NoiseDraw::RowRead) + noise_at(i % 64, i / 64, NoiseDraw::Read);
        let samples = (0..64 * 64).map(|i| sample(i) as f32).collect();
        stack.push(&Image::from_samples(64, 64, samples).expect("a square")).expect("a frame");
    }
    let pattern = Pattern::from_stack(&stack).expect("a pattern");
    let row = pattern.variances_dn2().row;
    // The standard's subtraction would leave 9/16 DN².
    assert!(row.value.abs() < 3.0 * row.standard_uncertainty && row.standard_uncertainty < 0.2, "{row:?}");
    let (shared, columns) = pattern.shared_temporal_dn2();
    // 64 · 15 numbers: 5 %.
    assert!((shared / 9.0 - 1.0).abs() < 0.15 && columns < 0.02, "{shared} {columns}");
}

#[test]
fn nonsense_is_refused() {
    let sensor = DeclaredSensor::new(3);
    let levels = sensor.levels();
    assert_eq!(TransferData::new(&levels[..2]), Err(TransferError::TooFewLevels { levels: 1 }));
    let bright: Vec<Level> = levels.iter().copied().filter(|l| l.photons > 0.0).collect();
    assert!(matches!(TransferData::new(&bright), Err(TransferError::NoDark { .. })));
    // The same reading for every light level.
    let stuck: Vec<Level> = levels.iter().map(|l| Level { statistics: levels[1].statistics, ..*l }).collect();
    assert_eq!(TransferData::new(&stuck), Err(TransferError::NoResponse));
    // Averaged frames: the noise does not increase.
    let replaced_statistics = |l: &Level| {
        let statistics = LevelStatistics { variance_dn2: Estimate::new(1.0, 0.01), ..l.statistics };
        Level { statistics, ..*l }
    };
    let averaged = TransferData::new(&levels.iter().map(replaced_statistics).collect::<Vec<_>>()).expect("levels");
    assert_eq!(averaged.figures(), Err(TransferError::NoShotNoise));
    let data = TransferData::new(&levels).expect("levels");
    let pattern = |photons, first| Pattern::from_stack(&sensor.stack(6e-3, photons, first, 4)).expect("a stack");
    let (dark, white) = (pattern(0.0, 5000), pattern(1e6, 6000));
    let gain = Estimate::new(GAIN, 0.0);
    assert!(matches!(nonuniformity(&dark, &white, gain, &data), Err(TransferError::SaturatedStack { .. })));
    assert_eq!(nonuniformity(&dark, &dark, gain, &data), Err(TransferError::NotBrighter));
}

/// The light is varied, not the time: four dark levels of one exposure are merged, and give no dark current.
#[test]
fn dark_levels_of_one_exposure_are_one() {
    let sensor = DeclaredSensor::new(7);
    let exposure_s = 6e-3;
    let bright = (1..=STEPS).map(|i| sensor.level(exposure_s, f64::from(i) * 1.2e-3 * PHOTONS_PER_S, 2 * i));
    let dark = (0..4).map(|i| sensor.level(exposure_s, 0.0, 500 + 2 * i));
    let data = TransferData::new(&bright.chain(dark).collect::<Vec<_>>()).expect("levels");
    assert_eq!(data.dark().len(), 1);
    let figures = data.figures().expect("figures");
    assert_eq!(figures.dark_current_mean_e_per_s, None);
    // It includes the shot noise of the dark current within the exposure.
    let expected = (DARK_NOISE_E * DARK_NOISE_E + DARK_CURRENT_E_PER_S * exposure_s).sqrt();
    let e_n = figures.dark_noise_e.normalised_error(Estimate::new(expected, 0.0));
    assert!(e_n.abs() < 1.5, "{:?}, expected {expected}", figures.dark_noise_e);
}
