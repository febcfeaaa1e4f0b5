use core::f64::consts::PI;

use super::*;
use crate::maths::f64::sin;

// Means of waveforms compared with closed forms and with sums over moments, also far from the time 0.

fn over(start_s: f64, length_s: f64) -> TimeInterval {
    TimeInterval::new(start_s, start_s + length_s).expect("in order")
}

/// Pulses of mean 1, without edge time.
fn pwm(frequency_hz: f64, duty: f64) -> Waveform {
    Waveform::pulses(&Pulses { frequency_hz, duty, edges_s: [0.0; 2], peak: 1.0 / duty }).expect("legal")
}

/// (max − min)/(max + min) over exposures of all phases.
fn flicker_index(waveform: &Waveform, period_s: f64, exposure_s: f64) -> f64 {
    let means = (0..20_000).map(|i| waveform.mean(over(0.3 + period_s * f64::from(i) / 20_000.0, exposure_s)));
    let (low, high) = means.fold((f64::INFINITY, 0.0_f64), |(low, high), mean| (low.min(mean), high.max(mean)));
    (high - low) / (high + low)
}

/// Closed form for rectangular pulses of period T, duty d, exposure t = kT + r: of light between k d T + max(0, r − (1 − d) T) and
/// k d T + min(r, d T).
#[test]
fn the_flicker_of_pulses_is_that_of_the_closed_form() {
    for (frequency_hz, duty, exposure_s, expected) in [
        (90.0, 0.1, 1e-3, 1.0),
        (90.0, 0.1, 8e-3, 1.0),
        (90.0, 0.1, 10.5e-3, 0.379_310),
        (110.0, 0.1, 10e-3, 1.0 / 3.0),
        (200.0, 0.25, 7e-3, 1.0 / 3.0),
        (90.0, 0.3, 15e-3, 1.0 / 3.0),
        (100.0, 0.5, 10e-3, 0.0),
    ] {
        let actual = flicker_index(&pwm(frequency_hz, duty), 1.0 / frequency_hz, exposure_s);
        // The extremes lie between 20 000 phases: the error is 1/20 000 of the duty, in both.
        assert!((actual - expected).abs() < 1e-3, "{frequency_hz} Hz, {duty}, {exposure_s} s: {actual} {expected}");
    }
}

#[test]
fn an_exposure_damps_mains_light_by_the_sinc() {
    for exposure_s in [1e-3, 2e-3, 5e-3, 8e-3, 10e-3, 12e-3, 1.0 / 3.0] {
        let x = PI * 100.0 * exposure_s;
        let expected = 0.4 * (sin(x) / x).abs();
        let waveform = Waveform::mains(50.0, 0.4).expect("legal");
        let actual = flicker_index(&waveform, 0.01, exposure_s);
        // The peak of a cosine lies between 20 000 phases: 1.2e-8 of it.
        assert!((actual - expected).abs() < 1e-7, "{exposure_s}: {actual} {expected}");
    }
}

/// Linear congruential generator of numbers in [0, 1).
fn numbers(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1;
    move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// Returns one waveform of each kind, with random parameters and delay.
fn random_waveforms(seed: u64) -> Vec<Waveform> {
    let mut next = numbers(seed);
    let count = 2 + (next() * 7.0) as usize;
    let mut time_s = next() - 0.5;
    let mut rows: Vec<(f64, f64)> = (0..count)
        .map(|_| {
            time_s += 0.01 + 0.2 * next();
            (time_s, if next() < 0.2 { 0.0 } else { 3.0 * next() + 0.01 })
        })
        .collect();
    rows.push((time_s + 0.3, 0.5));
    let length_s = rows[rows.len() - 1].0 - rows[0].0;
    let steps: Vec<(f64, f64)> = rows.iter().map(|(_, level)| (0.05 + 0.3 * next(), *level)).collect();
    let (duty, frequency_hz) = (0.05 + 0.9 * next(), 1.0 + 20.0 * next());
    let room_s = duty.min(1.0 - duty) / frequency_hz;
    let edges_s = [0; 2].map(|_| room_s * (0.2 + 0.8 * next()));
    let table = |between, period_s| Waveform::table(&rows, between, period_s);
    let all = [
        Waveform::pulses(&Pulses { frequency_hz, duty, edges_s, peak: 2.0 }),
        Waveform::mains(frequency_hz, next()),
        table(TableInterpolation::Linear, None),
        table(TableInterpolation::Steps, None),
        table(TableInterpolation::Linear, Some(length_s + next())),
        table(TableInterpolation::Linear, Some(length_s)),
        table(TableInterpolation::Steps, Some(length_s + 0.1 + next())),
        Waveform::programme(&steps, true),
        Waveform::programme(&steps, false),
    ];
    let mut later = || next() * 4.0 - 2.0;
    all.into_iter().map(|waveform| waveform.expect("legal").later(later())).collect()
}

/// Two-point Gauss–Legendre quadrature in each of many steps: accurate except where a step contains a kink or a jump.
fn summed(waveform: &Waveform, over: TimeInterval, steps: u32) -> f64 {
    let step = over.length_s() / f64::from(steps);
    let middle = |i: u32| over.start_s() + step * (f64::from(i) + 0.5);
    let aside = 0.5 * step / 3.0_f64.sqrt();
    let of = |i: u32| 0.5 * (waveform.at(middle(i) - aside) + waveform.at(middle(i) + aside));
    (0..steps).map(of).sum::<f64>() / f64::from(steps)
}

#[test]
fn means_and_greatest_levels_are_those_of_the_moments() {
    for seed in 0..40 {
        let mut next = numbers(seed + 1000);
        for waveform in random_waveforms(seed) {
            for _ in 0..4 {
                let length_s = [0.003, 0.2, 3.0][(next() * 3.0) as usize] * (0.1 + next());
                let over = over(8.0 * next() - 4.0, length_s);
                let steps = 20_000;
                // At most some 100 jumps of 3 in an interval of 3.3 s, each displaced by up to a step's length.
                let allowed = 3.0 * (2.0 + 30.0 * length_s) / f64::from(steps);
                let (mean, sum) = (waveform.mean(over), summed(&waveform, over, steps));
                assert!((mean - sum).abs() <= allowed, "{mean} {sum}: {waveform:?} {over:?}");
                let moment = |i: u32| over.start_s() + over.length_s() * f64::from(i) / f64::from(steps);
                let maximum = (0..=steps).map(|i| waveform.at(moment(i))).fold(0.0, f64::max);
                let reported = waveform.max_over(over);
                assert!(reported >= maximum * (1.0 - 1e-12) && reported <= waveform.max_level() * (1.0 + 1e-15));
                // The steepest straight line falls from its top by 60 levels in 0.01 s. Edges of pulses fall by 2 in as short a time as is sampled.
                let is_reached = reported <= maximum + 6000.0 * length_s / f64::from(steps) + 1e-9;
                assert!(is_reached, "{reported} {maximum}: {waveform:?} {over:?}");
            }
        }
    }
}

#[test]
fn what_recurs_is_the_same_after_whole_periods_and_its_mean_is_reported() {
    for seed in 0..40 {
        for waveform in random_waveforms(seed) {
            let Some(period_s) = waveform.period_s() else {
                assert!(waveform.mean_level().is_none());
                continue;
            };
            let mean_level = waveform.mean(over(0.37, 5.0 * period_s));
            assert!((mean_level - waveform.mean_level().expect("recurs")).abs() < 1e-12);
            for part in [0.0, 0.31, 0.77] {
                let interval = over(period_s * part, 0.21 * period_s);
                let later = waveform.mean(interval.later(7.0 * period_s));
                assert!((later - waveform.mean(interval)).abs() < 1e-9, "{waveform:?}");
            }
        }
    }
}

#[test]
fn the_phase_is_right_a_million_seconds_later() {
    // 1e6 s are whole periods of both. The time itself is rounded to 1.2e-10 s.
    let (pulses, mains) = (pwm(200.0, 0.25), Waveform::mains(50.0, 1.0).expect("legal"));
    for i in 0..50 {
        let near = over(1e-4 * f64::from(i), 1e-5);
        let far = near.later(1e6);
        assert!((mains.mean(far) - mains.mean(near)).abs() < 2.0 * PI * 100.0 * 2.4e-10 + 1e-12);
        // 1e-5 s, whose ends are resolved to 2.4e-10 s, at a level of 4 at most.
        assert!((pulses.mean(far) - pulses.mean(near)).abs() < 4.0 * 4.8e-5, "{i}");
    }
    // The period of 1/200 s is rounded by 1e-16, in 1e6 s by 1e-10 s.
    assert_eq!([1e-9, 1.249_999e-3, 1.250_001e-3, -1e-9].map(|t| pulses.at(1e6 + t)), [4.0, 4.0, 0.0, 0.0]);
}

#[test]
fn pulses_have_their_duty_at_half_height_and_their_mean_with_any_edges() {
    let pulses = Pulses { frequency_hz: 100.0, duty: 0.3, edges_s: [1e-3, 4e-3], peak: 1.0 };
    let waveform = Waveform::pulses(&pulses).expect("legal");
    assert!((waveform.mean_level().expect("recurs") - 0.3).abs() < 1e-15);
    for (time_s, level) in
        [(0.0, 0.5), (0.25e-3, 0.75), (0.5e-3, 1.0), (1e-3, 1.0), (3e-3, 0.5), (5e-3, 0.0), (9.75e-3, 0.25)]
    {
        assert!((waveform.at(time_s) - level).abs() < 1e-9, "{time_s}: {}", waveform.at(time_s));
    }
}

#[test]
fn a_programme_steps_at_its_durations_and_a_table_holds_its_ends() {
    let steps = [(20.0, 1.0), (3.0, 0.0), (25.0, 0.5)];
    let (again, once) = (Waveform::programme(&steps, true), Waveform::programme(&steps, false));
    let (again, once) = (again.expect("legal"), once.expect("legal").later(1.0));
    assert_eq!(
        [0.0, 19.9, 20.0, 22.9, 23.0, 47.9, 48.0, -0.1].map(|t| again.at(t)),
        [1.0, 1.0, 0.0, 0.0, 0.5, 0.5, 1.0, 0.5]
    );
    assert_eq!([-9.0, 1.0, 21.5, 24.5, 1e9].map(|t| once.at(t)), [1.0, 1.0, 0.0, 0.5, 0.5]);
    assert_eq!(again.mean(over(20.0, 3.0)), 0.0);
    assert_eq!(again.max_over(over(20.5, 2.0)), 0.0);
    let ramp = Waveform::table(&[(1.0, 0.0), (3.0, 4.0)], TableInterpolation::Linear, None).expect("legal");
    assert_eq!([0.0, 1.0, 2.5, 9.0].map(|t| ramp.at(t)), [0.0, 0.0, 3.0, 4.0]);
    assert_eq!(ramp.mean(over(0.0, 4.0)), 2.0);
    assert_eq!(ramp.mean(over(-7.0, 1.0)), 0.0);
}

#[test]
fn the_mean_over_next_to_no_time_is_the_level() {
    for waveform in random_waveforms(3) {
        for time_s in [0.1, 17.3, 1e6] {
            for length_s in [0.0, 1e-300, 1e-20] {
                let mean = waveform.mean(over(time_s, length_s));
                assert!((mean - waveform.at(time_s)).abs() < 1e-12, "{mean} {}", waveform.at(time_s));
            }
        }
    }
}

#[test]
fn what_is_no_waveform_is_refused() {
    let pulses = Pulses { frequency_hz: 100.0, duty: 0.5, edges_s: [0.0; 2], peak: 1.0 };
    let bad = [
        Pulses { frequency_hz: 0.0, ..pulses },
        Pulses { frequency_hz: f64::NAN, ..pulses },
        Pulses { duty: 1.0, ..pulses },
        Pulses { edges_s: [6e-3, 6e-3], ..pulses },
        Pulses { edges_s: [f64::NAN, 0.0], ..pulses },
        Pulses { peak: 0.0, ..pulses },
    ];
    assert!(bad.iter().all(|pulses| Waveform::pulses(pulses).is_err()));
    assert_eq!(Waveform::mains(50.0, 1.1), Err(WaveformError::Depth { depth: 1.1 }));
    let table = |rows: &[(f64, f64)], between, period_s| Waveform::table(rows, between, period_s).err();
    let linear = TableInterpolation::Linear;
    assert_eq!(table(&[], linear, None), Some(WaveformError::Empty));
    assert_eq!(table(&[(0.0, 0.0)], linear, None), Some(WaveformError::Dark));
    assert!(matches!(table(&[(0.0, 1.0), (0.0, 2.0)], linear, None), Some(WaveformError::Unordered { .. })));
    assert!(matches!(table(&[(f64::NAN, 1.0)], linear, None), Some(WaveformError::Unordered { .. })));
    assert!(matches!(table(&[(0.0, 1.0), (1.0, -2.0)], linear, None), Some(WaveformError::Level { .. })));
    let rows = [(0.0, 1.0), (1.0, 2.0)];
    assert!(table(&rows, linear, Some(1.0)).is_none() && table(&rows, TableInterpolation::Steps, Some(1.0)).is_some());
    assert!(Waveform::programme(&[(0.0, 1.0)], true).is_err() && Waveform::programme(&[(1.0, 0.0)], true).is_err());
}
