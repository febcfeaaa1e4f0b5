//! Lights of known frequency, modulation and duty cycle, by sums over moments of each row's exposure, with noise.

use super::*;
use core::f64::consts::{PI, TAU};
use etendue_core::maths::f64::{cos, sin};
use etendue_core::random::{NoiseDraw, NoiseStream, Pixel};
use rand_distr::{Distribution, Normal};

const COLUMNS: usize = 24;
const BLACK: f64 = 64.0;
const LEVEL: f64 = 1000.0;

/// A sequence with a rolling shutter.
#[derive(Clone, Copy)]
struct RollingSequence {
    rows: usize,
    frames: usize,
    row_time_s: f64,
    frame_rate_hz: f64,
    exposure_s: f64,
    noise: f64,
}

const SHOT: RollingSequence =
    RollingSequence { rows: 1000, frames: 1, row_time_s: 25e-6, frame_rate_hz: 29.97, exposure_s: 2e-3, noise: 20.0 };

impl RollingSequence {
    fn timing(&self) -> FlickerTiming {
        let Self { row_time_s, frame_rate_hz, exposure_s, .. } = *self;
        FlickerTiming {
            row_time_s: Some(row_time_s),
            frame_rate_hz: (self.frames > 1).then_some(frame_rate_hz),
            exposure_s: Some(exposure_s),
        }
    }

    /// Frames of a light of mean 1: its mean over each row's exposure by 2 000 moments.
    fn frames(&self, seed: u64, light: impl Fn(f64) -> f64) -> Vec<Image> {
        let normal = Normal::new(0.0, self.noise.max(1e-300)).expect("a scatter");
        let mean = |start_s: f64| {
            let light_at_step = |i: u32| light(start_s + self.exposure_s * (f64::from(i) + 0.5) / 2000.0);
            (0..2000).map(light_at_step).sum::<f64>() / 2000.0
        };
        let frame = |n: usize| {
            let row = |y: usize| {
                let level = BLACK + LEVEL * mean(n as f64 / self.frame_rate_hz + y as f64 * self.row_time_s);
                let pixel = move |x: usize| Pixel { x: x as u32, y: y as u32 };
                let sample = move |x: usize| NoiseStream::new(seed, 0, n as u32, 0, pixel(x), NoiseDraw::Read);
                let noise = move |x: usize| if self.noise > 0.0 { normal.sample(&mut sample(x)) } else { 0.0 };
                (0..COLUMNS).map(move |x| (level + noise(x)) as f32)
            };
            let samples = (0..self.rows).flat_map(row).collect();
            Image::from_samples(COLUMNS, self.rows, samples).expect("a rectangle")
        };
        (0..self.frames).map(frame).collect()
    }

    fn measured(&self, seed: u64, light: impl Fn(f64) -> f64) -> Flicker {
        measure_flicker(&self.frames(seed, light), &self.timing(), (BLACK, Some(65_535.0))).expect("a sequence")
    }
}

fn mains_light(frequency_hz: f64, depth: f64) -> impl Fn(f64) -> f64 {
    move |time_s| 1.0 + depth * cos(TAU * frequency_hz * time_s + 0.7)
}

/// Pulses on a constant light, with a total mean of 1.
fn pulses(frequency_hz: f64, duty: f64, pulsed: f64) -> impl Fn(f64) -> f64 {
    move |time_s| {
        let phase = (frequency_hz * time_s + 0.37).rem_euclid(1.0);
        1.0 - pulsed + if phase < duty { pulsed / duty } else { 0.0 }
    }
}

fn bands(flicker: &Flicker) -> RowBands {
    flicker.rows.as_ref().and_then(|rows| rows.bands.clone()).expect("bands")
}

/// Asserts agreement within four standard uncertainties, which themselves must be small.
fn assert_knows(estimate: Estimate, expected: f64, relative: f64) {
    let Estimate { value, standard_uncertainty: u } = estimate;
    assert!((value - expected).abs() <= 4.0 * u + 1e-4 * expected, "{value} ± {u} is not {expected}");
    assert!(u <= relative * expected, "{value} ± {u}");
}

#[test]
fn mains_light_is_found_in_one_frame() {
    for (frequency_hz, depth, exposure_s) in [(100.0, 0.3, 2e-3), (120.0, 0.8, 12e-3), (300.0, 0.1, 1e-3)] {
        let shot = RollingSequence { exposure_s, ..SHOT };
        let result = bands(&shot.measured(3, mains_light(frequency_hz, depth)));
        let x = PI * frequency_hz * exposure_s;
        let visible_depth = depth * (sin(x) / x).abs();
        // 24 columns with a noise of 2 %: 0.4 % per row.
        assert_knows(result.frequency_hz, frequency_hz, 0.02);
        assert_knows(result.amplitude_ratio, visible_depth, 0.1);
        assert_knows(result.modulation, visible_depth, 0.1);
        assert_knows(result.light_amplitude_ratio.expect("left"), depth, 0.1);
        assert_knows(result.period_rows, 1.0 / (frequency_hz * shot.row_time_s), 0.02);
        assert!(result.pulses.is_none() && result.harmonics == 1, "{result:?}");
    }
}

#[test]
fn pulses_have_their_duty_whether_shorter_or_longer_than_the_exposure() {
    for (frequency_hz, duty, exposure_s, pulsed) in [
        (200.0, 0.25, 0.5e-3, 1.0),
        (200.0, 0.1, 2e-3, 1.0),
        (430.0, 0.6, 1e-3, 0.4),
        (200.0, 0.25, 7e-3, 1.0),
        (150.0, 0.85, 1e-3, 1.0),
    ] {
        let result = bands(&RollingSequence { exposure_s, ..SHOT }.measured(5, pulses(frequency_hz, duty, pulsed)));
        assert_knows(result.frequency_hz, frequency_hz, 0.01);
        let light = result.pulses.expect("pulses");
        // Sums over 2 000 moments resolve edges to 5e-4 of the exposure.
        assert_knows(light.duty, duty, 0.1);
        assert_knows(light.pulsed_fraction, pulsed, 0.1);
        // The closed form of pulses over exposures.
        let periods: f64 = frequency_hz * exposure_s;
        let (full_periods, rest) = (periods.floor() * duty, periods - periods.floor());
        let [low, high] = [full_periods + (rest - 1.0 + duty).max(0.0), full_periods + rest.min(duty)]
            .map(|exposed| 1.0 - pulsed + pulsed * exposed / (periods * duty));
        assert_knows(result.modulation, (high - low) / (high + low), 0.05);
    }
}

/// With exposures of half a period, pulses of duty cycle 0.3 are equivalent to pulses of 0.7 with the same middles plus a
/// negative light.
#[test]
fn exposures_of_half_a_period_do_not_find_light_below_nothing() {
    let shot = RollingSequence { exposure_s: 1.0 / 400.0, ..SHOT };
    for duty in [0.3, 0.45] {
        let light = bands(&shot.measured(5, pulses(200.0, duty, 1.0))).pulses.expect("pulses");
        assert_knows(light.duty, duty, 0.1);
        assert_knows(light.pulsed_fraction, 1.0, 0.1);
    }
    // For a weaker fraction both are possible: nothing is stated.
    assert!(bands(&shot.measured(5, pulses(200.0, 0.3, 0.4))).pulses.is_none());
}

#[test]
fn frames_of_a_known_rate_tell_the_frequency_by_the_whole_sequence() {
    let shot = RollingSequence { rows: 200, frames: 24, row_time_s: 120e-6, ..SHOT };
    let flicker = shot.measured(7, mains_light(100.37, 0.2));
    let result = bands(&flicker);
    assert_knows(result.frequency_hz, 100.37, 2e-4);
    let frames = flicker.frames.expect("several");
    // 100.37 − 3 · 29.97.
    assert_knows(frames.beat_hz.expect("a rate"), 10.46, 2e-3);
    let each = FlickerTiming { frame_rate_hz: None, ..shot.timing() };
    let alone = measure_flicker(&shot.frames(7, mains_light(100.37, 0.2)), &each, (BLACK, None)).expect("a sequence");
    assert_knows(bands(&alone).frequency_hz, 100.37, 0.02);
}

/// A small lamp: in each frame, 40 rows of 30 µs cover a tenth of a period of 83 Hz.
#[test]
fn few_rows_of_many_frames_tell_a_slow_frequency() {
    let shot = RollingSequence { rows: 40, frames: 40, row_time_s: 30e-6, exposure_s: 1e-3, ..SHOT };
    let result = bands(&shot.measured(11, pulses(83.0, 0.3, 1.0)));
    assert_knows(result.frequency_hz, 83.0, 1e-3);
    assert_knows(result.pulses.expect("pulses").duty, 0.3, 0.05);
}

/// Few rows of few frames do not distinguish 110 Hz from 70 Hz, which have opposite phases in frames at 30.03 Hz: the frequency
/// is reported correctly or not at all.
#[test]
fn aliased_frequencies_are_not_mistaken() {
    let shot = RollingSequence {
        rows: 24,
        frames: 4,
        row_time_s: 60e-6,
        frame_rate_hz: 30.03,
        exposure_s: 10e-3,
        noise: 40.0,
    };
    let mut count = 0;
    for seed in 0..40 {
        let flicker = shot.measured(seed, pulses(110.0, 0.25, 1.0));
        let Some(result) = flicker.rows.and_then(|rows| rows.bands) else { continue };
        assert_knows(result.frequency_hz, 110.0, 0.02);
        count += 1;
    }
    assert!(count < 40, "all of them told");
}

#[test]
fn frames_alone_give_a_frequency_and_its_aliases() {
    let shot = RollingSequence { rows: 20, frames: 60, row_time_s: 1e-12, frame_rate_hz: 30.0, ..SHOT };
    let timing = FlickerTiming { row_time_s: None, ..shot.timing() };
    let flicker = measure_flicker(&shot.frames(13, mains_light(100.0, 0.3)), &timing, (BLACK, None)).expect("frames");
    assert!(flicker.rows.is_none());
    let frames = flicker.frames.expect("several");
    let frequency = frames.frequency.clone().expect("a frequency");
    assert_knows(frequency.apparent_hz, 10.0, 0.01);
    let aliases_hz: Vec<f64> = frequency.aliases(7).into_iter().map(|(_, f)| (f * 10.0).round() / 10.0).collect();
    assert_eq!(aliases_hz, [10.0, 20.0, 40.0, 50.0, 70.0, 80.0, 100.0]);
    // Phases of thirds of a period: 0.7 rad, and ± 120° from it, of 0.3 · sinc(0.2).
    let left = 0.3 * sin(PI * 0.2) / (PI * 0.2);
    let at = [0.0, TAU / 3.0, 2.0 * TAU / 3.0].map(|p| left * cos(p + 0.7 + PI * 0.2));
    let (low, high) = (at.iter().copied().fold(1.0, f64::min), at.iter().copied().fold(-1.0, f64::max));
    assert_knows(frames.modulation, (high - low) / (2.0 + high + low), 0.05);
}

/// Lens shading over the rows is not reported as flicker, and does not hide it.
#[test]
fn shading_is_distinguished_from_bands() {
    let vignetted = |seed, light: &dyn Fn(f64) -> f64| {
        let mut frame = SHOT.frames(seed, light).remove(0);
        for y in 0..SHOT.rows {
            let u = y as f64 / 500.0 - 1.0;
            let factor = (1.0 - 0.2 * u * u + 0.05 * u) as f32;
            (0..COLUMNS).for_each(|x| frame.set(x, y, BLACK as f32 + factor * (frame.at(x, y) - BLACK as f32)));
        }
        measure_flicker(&[frame], &SHOT.timing(), (BLACK, None)).expect("a frame")
    };
    let result = bands(&vignetted(17, &mains_light(300.0, 0.2)));
    assert!(result.shading && (result.frequency_hz.value - 300.0).abs() < 0.5, "{result:?}");
}

#[test]
fn steady_light_has_no_bands() {
    for seed in 0..40 {
        let shot = RollingSequence { rows: 300, ..SHOT };
        let flicker = shot.measured(seed, |_| 1.0);
        assert_eq!(flicker.rows.as_ref().map(|rows| rows.bands.is_none()), Some(true), "{seed}: {flicker:?}");
        let frames = RollingSequence { rows: 40, frames: 20, ..SHOT }.measured(seed, |_| 1.0).frames.expect("several");
        assert!(frames.frequency.is_none() && frames.modulation.value < 0.01, "{frames:?}");
    }
}

/// No frequency is reported for light with less than one and a half periods over the rows.
#[test]
fn a_frequency_of_too_few_periods_is_not_reported() {
    let shot = RollingSequence { rows: 200, row_time_s: 80e-6, ..SHOT };
    for seed in 0..10 {
        let rows = shot.measured(seed, mains_light(30.0, 0.5)).rows.expect("a rolling shutter");
        assert!((rows.lowest_hz - 93.75).abs() < 1e-9 && rows.bands.is_none(), "{rows:?}");
    }
}

#[test]
fn what_cannot_be_measured_is_refused() {
    let frames = RollingSequence { rows: 20, ..SHOT }.frames(1, |_| 1.0);
    let measure = |frames: &[Image], timing, full| measure_flicker(frames, &timing, (BLACK, full)).err();
    let timing = SHOT.timing();
    let none = FlickerTiming::default();
    assert_eq!(measure(&frames, none, None), Some(FlickerError::NoTime));
    assert_eq!(measure(&[], timing, None), Some(FlickerError::NoTime));
    let wrong = FlickerTiming { exposure_s: Some(-1.0), ..timing };
    assert!(matches!(measure(&frames, wrong, None), Some(FlickerError::Timing { .. })));
    assert_eq!(
        measure(&[frames[0].part(0, 0, 4, 10)], timing, None),
        Some(FlickerError::FewRows { rows: 10, least: 16 })
    );
    assert_eq!(measure(&[frames[0].part(0, 0, 1, 20)], timing, None), Some(FlickerError::Narrow { columns: 1 }));
    assert_eq!(measure(&[frames[0].clone(), frames[0].part(0, 0, 4, 20)], timing, None), Some(FlickerError::Sizes));
    assert!(matches!(measure(&frames, timing, Some(1000.0)), Some(FlickerError::Saturated { .. })));
    let dark = measure_flicker(&frames, &timing, (2000.0, None)).err();
    assert!(matches!(dark, Some(FlickerError::Dark { .. })));
}

/// 95 of 100 seeds are expected within 1.96 standard uncertainties, with a standard deviation of 2.2.
#[test]
fn uncertainties_cover_the_truth() {
    let shot = RollingSequence { rows: 400, noise: 60.0, ..SHOT };
    let light = pulses(400.0, 0.3, 0.8);
    let noiseless = RollingSequence { noise: 0.0, ..shot }.frames(0, light).remove(0);
    let normal = Normal::new(0.0, shot.noise).expect("a scatter");
    let noisy = |seed: u64| {
        let mut frame = noiseless.clone();
        for (i, sample) in frame.samples_mut().iter_mut().enumerate() {
            let pixel = Pixel { x: i as u32, y: 7 };
            *sample += normal.sample(&mut NoiseStream::new(seed, 0, 0, 0, pixel, NoiseDraw::Read)) as f32;
        }
        bands(&measure_flicker(&[frame], &shot.timing(), (BLACK, None)).expect("a frame"))
    };
    let results: Vec<RowBands> = (0..100).map(noisy).collect();
    let x = PI * 400.0 * shot.exposure_s;
    // Fundamental of pulses: 2 sin(πd)/(πd) of their mean.
    let visible_depth = 0.8 * 2.0 * sin(PI * 0.3) / (PI * 0.3) * (sin(x) / x).abs();
    let covered = |quantity: &dyn Fn(&RowBands) -> Option<Estimate>, truth: f64| {
        let known: Vec<Estimate> = results.iter().filter_map(quantity).collect();
        let inside = known.iter().filter(|e| (e.value - truth).abs() <= 1.96 * e.standard_uncertainty).count();
        assert!(known.len() >= 95, "{}", known.len());
        (inside + 100 - known.len(), known.len())
    };
    for (inside, _) in [
        covered(&|bands| Some(bands.frequency_hz), 400.0),
        covered(&|bands| Some(bands.amplitude_ratio), visible_depth),
        covered(&|bands| bands.pulses.map(|pulses| pulses.duty), 0.3),
        covered(&|bands| bands.pulses.map(|pulses| pulses.pulsed_fraction), 0.8),
    ] {
        assert!((85..=100).contains(&inside), "{inside} of 100");
    }
}
