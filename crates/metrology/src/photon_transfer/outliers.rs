//! Defective pixels: hot ones, with far more dark current than most, and dead ones, which do not respond to light.
//!
//! ```text
//! hot:   I = (ȳ_long − ȳ_short)/(K (t_long − t_short)) above T = max(6 σ_I, 10 ⟨I⟩)       σ_I: 1.4826 times the median deviation
//!        m = Σ (min(I, C) − T)/n_below       fraction = n/N exp(T/m)
//! dead:  (ȳ_bright − ȳ_dark) below half of its mean
//! ```
//!
//! Additional currents are assumed to be exponentially distributed, as in `hot` of a camera file: m is the maximum-likelihood
//! estimate with currents above C (saturated pixels) censored, i.e. known to be no less (Deemer & Votaw 1955). The part below T
//! is extrapolated by the same law. Uncertainty: √n for a number n, m/√n_below for m.
//!
//! A group of adjacent pixels (in rows or columns) that contains a saturated one counts as one hot pixel with blooming, at the
//! middle one of the saturated pixels (charge overflows to both sides). Fewer than five are counted, but no fraction is reported.

use etendue_core::maths::f64::exp;

use super::Stack;
use crate::Estimate;

/// Minimum number for a fraction.
pub const MIN_OUTLIERS: usize = 5;
/// Standard deviation of a normal distribution over its median magnitude.
const MAD_TO_SIGMA: f64 = 1.482_602_2;

/// Defective pixels.
#[derive(Clone, Debug, PartialEq)]
pub struct Outliers {
    /// Columns and rows in the stack, from 0.
    pub positions: Vec<[usize; 2]>,
    /// Fraction of all pixels; `None` for fewer than [`MIN_OUTLIERS`].
    pub fraction: Option<Estimate>,
    /// Mean additional current of hot pixels, e⁻/s.
    pub mean_e_s: Option<Estimate>,
    /// Detection limit: e⁻/s, or a fraction of the mean response.
    pub limit: f64,
    /// Contribution of the hot pixels' additional currents to the mean current of all pixels, e⁻/s.
    pub added_e_s: f64,
    /// Spread of the other pixels' currents, e⁻/s, noise included: 1.4826 times their median deviation.
    pub spread_e_s: f64,
}

/// Frames without light at one exposure.
#[derive(Clone, Copy, Debug)]
pub struct DarkStack<'a> {
    pub frames: &'a Stack,
    pub exposure_s: f64,
}

/// Hot pixels, from the averages of stacks without light at a long and a short exposure, s.
#[must_use]
pub fn hot_pixels(
    long: &DarkStack<'_>,
    short: &DarkStack<'_>,
    gain_dn_per_e: f64,
    full_scale_dn: Option<f64>,
) -> Option<Outliers> {
    let per_dn = 1.0 / (gain_dn_per_e * (long.exposure_s - short.exposure_s));
    let (long, short) = (long.frames, short.frames);
    if !(per_dn.is_finite() && per_dn > 0.0) || long.width() != short.width() || long.height() != short.height() {
        return None;
    }
    let (long_dn, short_dn) = (long.average(), short.average());
    let currents: Vec<f64> = long_dn.iter().zip(&short_dn).map(|(l, s)| per_dn * (l - s)).collect();
    let mut sorted = currents.clone();
    let middle = median(&mut sorted);
    let mut off: Vec<f64> = currents.iter().map(|i| (i - middle).abs()).collect();
    let spread_e_s = MAD_TO_SIGMA * median(&mut off);
    let limit = middle + (6.0 * spread_e_s).max(10.0 * middle.max(0.0));
    let is_full = |i: usize| full_scale_dn.is_some_and(|full| long_dn[i] >= 0.98 * full);
    let above: Vec<usize> = (0..currents.len()).filter(|i| currents[*i] > limit).collect();
    let hot = without_overflow(&above, long.width(), is_full);
    let below = hot.iter().filter(|i| !is_full(**i)).count();
    let places = hot.iter().map(|i| [i % long.width(), i / long.width()]).collect();
    let added_e_s = above.iter().map(|i| currents[*i] - middle).sum::<f64>() / currents.len() as f64;
    let none = Outliers { positions: places, fraction: None, mean_e_s: None, limit, added_e_s, spread_e_s };
    if below < MIN_OUTLIERS {
        return Some(none);
    }
    let excess: f64 = hot.iter().map(|i| currents[*i] - limit).sum();
    let mean = excess / below as f64;
    let u_mean = mean / (below as f64).sqrt();
    let all = hot.len() as f64;
    // Extrapolation this far below the observed currents is not meaningful.
    if limit > mean {
        return Some(none);
    }
    let fraction = all / currents.len() as f64 * exp(limit / mean);
    let u_fraction =
        fraction * (1.0 / all + (limit * u_mean / (mean * mean)) * (limit * u_mean / (mean * mean))).sqrt();
    let (fraction, mean_e_s) = (Some(Estimate::new(fraction, u_fraction)), Some(Estimate::new(mean, u_mean)));
    Some(Outliers { fraction, mean_e_s, ..none })
}

/// For adjacent pixels (increasing index, row by row) that include saturated ones: only the middle one of the saturated ones, as
/// the charge of the others overflowed from it, equally to both sides.
fn without_overflow(above: &[usize], width: usize, is_full: impl Fn(usize) -> bool) -> Vec<usize> {
    let mut clusters = Vec::new();
    let mut visited = vec![false; above.len()];
    for start in 0..above.len() {
        if core::mem::replace(&mut visited[start], true) {
            continue;
        }
        let (mut group, mut next) = (vec![start], 0);
        while let Some(at) = group.get(next).map(|member| above[*member]) {
            let column = at % width;
            let neighbours = [
                (column > 0).then(|| at - 1),
                (column + 1 < width).then_some(at + 1),
                at.checked_sub(width),
                Some(at + width),
            ];
            for member in neighbours.into_iter().flatten().filter_map(|place| above.binary_search(&place).ok()) {
                if !core::mem::replace(&mut visited[member], true) {
                    group.push(member);
                }
            }
            next += 1;
        }
        let places = group.into_iter().map(|member| above[member]);
        let mut full: Vec<usize> = places.clone().filter(|place| is_full(*place)).collect();
        full.sort_unstable();
        match full.get(full.len() / 2) {
            Some(source) => clusters.push(*source),
            None => clusters.extend(places),
        }
    }
    clusters.sort_unstable();
    clusters
}

/// Dead pixels, from the averages of stacks with light and without.
#[must_use]
pub fn dead_pixels(dark: &Stack, bright: &Stack) -> Outliers {
    const HALF: f64 = 0.5;
    let signal: Vec<f64> = bright.average().iter().zip(&dark.average()).map(|(b, d)| b - d).collect();
    let mean = signal.iter().sum::<f64>() / signal.len() as f64;
    let dead = (0..signal.len()).filter(|i| signal[*i] < HALF * mean);
    let places: Vec<[usize; 2]> = dead.map(|i| [i % dark.width(), i / dark.width()]).collect();
    let (count, all) = (places.len() as f64, signal.len() as f64);
    let fraction = (places.len() >= MIN_OUTLIERS).then(|| Estimate::new(count / all, count.sqrt() / all));
    Outliers { positions: places, fraction, mean_e_s: None, limit: HALF, added_e_s: 0.0, spread_e_s: 0.0 }
}

/// The median; sorts the values.
fn median(values: &mut [f64]) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Image;
    use etendue_core::maths::f64::ln;

    fn stack(values: &[f64], width: usize) -> Stack {
        let image = Image::from_samples(width, values.len() / width, values.iter().map(|v| *v as f32).collect());
        let mut stack = Stack::new(width, values.len() / width);
        stack.push(&image.expect("a rectangle")).expect("a frame");
        stack
    }

    fn dark(frames: &Stack, exposure_s: f64) -> DarkStack<'_> {
        DarkStack { frames, exposure_s }
    }

    #[test]
    fn hot_pixels_have_their_fraction_and_mean_although_some_are_saturated() {
        const COUNT: usize = 40_000;
        const HOT: usize = 400;
        // Hot ones, a hundred apart, are not adjacent.
        const WIDTH: usize = 160;
        // 1 e⁻/s with some scatter, and an exponential of 2 000 e⁻/s by its quantiles; 2 s at 0.5 DN/e⁻ are 1 DN for 1 e⁻/s.
        let quantile = |i: usize| -2000.0 * ln(1.0 - (i as f64 + 0.5) / HOT as f64);
        let current = |i: usize| {
            let usual_level = 1.0 + 0.1 * ((i * 7919 % 101) as f64 / 50.0 - 1.0);
            if i.is_multiple_of(100) { usual_level + quantile(i / 100) } else { usual_level }
        };
        let long: Vec<f64> = (0..COUNT).map(|i| (64.0 + current(i)).min(4095.0)).collect();
        let hot =
            hot_pixels(&dark(&stack(&long, WIDTH), 2.5), &dark(&stack(&[64.0; COUNT], WIDTH), 0.5), 0.5, Some(4095.0));
        let hot = hot.expect("two exposures");
        // Those below the limit of about 10 e⁻/s are added: 0.5 % of 400.
        assert!((390..=HOT).contains(&hot.positions.len()) && hot.positions[0] == [40, 1], "{:?}", &hot.positions[..2]);
        let (fraction, mean) = (hot.fraction.expect("many"), hot.mean_e_s.expect("many"));
        assert!((fraction.value / 0.01 - 1.0).abs() < 0.01, "{fraction:?}");
        // A hundredth of the pixels adds 20 e⁻/s; saturation limits it.
        assert!((15.0..20.0).contains(&hot.added_e_s) && hot.spread_e_s < 0.2, "{hot:?}");
        assert!((mean.value / 2000.0 - 1.0).abs() < 0.02 && mean.standard_uncertainty < 120.0, "{mean:?}");
    }

    #[test]
    fn charge_that_ran_over_is_one_hot_pixel() {
        let mut long = vec![65.0; 2000];
        // Five single ones, and one that filled its column: three full pixels, two half full ones above them and one below.
        [5, 99, 430, 931, 1900].iter().for_each(|i| long[*i] = 800.0);
        [990, 1010, 1030].iter().for_each(|i| long[*i] = 4095.0);
        [(950, 700.0), (970, 1500.0), (1050, 2300.0)].iter().for_each(|(i, v)| long[*i] = *v);
        let hot = hot_pixels(&dark(&stack(&long, 20), 2.5), &dark(&stack(&[64.0; 2000], 20), 0.5), 0.5, Some(4095.0));
        let hot = hot.expect("two exposures");
        assert_eq!(hot.positions, [[5, 0], [19, 4], [10, 21], [11, 46], [10, 50], [0, 95]]);
        // The charge is counted, wherever it was generated.
        let added = (5.0 * 735.0 + 3.0 * 4030.0 + 635.0 + 1435.0 + 2235.0) / 2000.0;
        assert!((hot.added_e_s - added).abs() < 1e-9, "{}", hot.added_e_s);
    }

    #[test]
    fn dead_pixels_are_found_by_their_places() {
        let mut bright = [100.0; 600];
        [3, 77, 78, 200, 599].iter().for_each(|i| bright[*i] = 20.0);
        let dead = dead_pixels(&stack(&[10.0; 600], 30), &stack(&bright, 30));
        assert_eq!(dead.positions, [[3, 0], [17, 2], [18, 2], [20, 6], [29, 19]]);
        assert!((dead.fraction.expect("five").value - 5.0 / 600.0).abs() < 1e-15);
        assert_eq!(dead_pixels(&stack(&[10.0; 600], 30), &stack(&[100.0; 600], 30)).fraction, None);
    }
}
