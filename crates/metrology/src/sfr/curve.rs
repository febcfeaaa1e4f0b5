//! A spatial frequency response by points: means of several, and where one falls to a level.

use crate::Estimate;

/// A point of the response.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SfrPoint {
    /// Cycles a pixel along the edge's normal.
    pub frequency: f64,
    /// Response, 1 at frequency 0.
    pub response: Estimate,
}

/// The mean of responses at the same frequencies.
#[must_use]
pub fn mean_curve(curves: &[&[SfrPoint]]) -> Vec<SfrPoint> {
    let count = curves.len() as f64;
    let at = |i: usize| {
        let points = || curves.iter().map(|curve| curve[i].response);
        let squares: f64 = points().map(|e| e.standard_uncertainty * e.standard_uncertainty).sum();
        let response = Estimate::new(points().map(|e| e.value).sum::<f64>() / count, squares.sqrt() / count);
        SfrPoint { frequency: curves[0][i].frequency, response }
    };
    let least = curves.iter().map(|curve| curve.len()).min().unwrap_or(0);
    (0..least).map(at).collect()
}

/// Where the curve falls to a level: midway between where the curve less its standard uncertainty does and where the curve with it does, so
/// that a noisy curve is not taken at its first dip. Half of what lies between is the uncertainty, or the uncertainty over the slope of a line
/// through the points about the place, where that is more (neighbours share their noise, a pair's slope would be mostly noise).
#[must_use]
pub fn crossing(curve: &[SfrPoint], level: f64) -> Option<Estimate> {
    const ABOUT: f64 = 0.05;
    let first = |sigmas: f64| {
        let value = |p: &SfrPoint| p.response.value + sigmas * p.response.standard_uncertainty;
        let pair = curve.windows(2).find(|pair| value(&pair[0]) > level && value(&pair[1]) <= level)?;
        let share = (value(&pair[0]) - level) / (value(&pair[0]) - value(&pair[1]));
        Some(pair[0].frequency + share * (pair[1].frequency - pair[0].frequency))
    };
    let plain = first(0.0)?;
    let (low, high) = (first(-1.0).unwrap_or(plain), first(1.0).unwrap_or(plain));
    let at = 0.5 * (low + high);
    let near: Vec<&SfrPoint> = curve.iter().filter(|p| (p.frequency - at).abs() <= ABOUT).collect();
    let mean = |f: fn(&SfrPoint) -> f64| near.iter().map(|p| f(p)).sum::<f64>() / near.len() as f64;
    let (x, y) = (mean(|p| p.frequency), mean(|p| p.response.value));
    let products = near.iter().map(|p| (p.frequency - x) * (p.response.value - y)).sum::<f64>();
    let slope = products / near.iter().map(|p| (p.frequency - x) * (p.frequency - x)).sum::<f64>();
    let u = near.iter().map(|p| p.response.standard_uncertainty).fold(0.0, f64::max);
    Some(Estimate::new(at, (u / slope.abs()).max(0.5 * (high - low))))
}
