//! Distortion against field: the curve of the paper's figure 11.

use super::Ideal;
use crate::Estimate;
use crate::target::Node;
use etendue_core::maths::f64::sin_cos;
use glam::DVec2;
use std::collections::BTreeMap;

/// A point of the curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurvePoint {
    /// Observed distance from the centre, in half diagonals.
    pub field: f64,
    /// Observed over ideal distance, the mean over the directions in which the chart reaches there.
    pub ratio: Estimate,
    /// The share of directions in which it does.
    pub covered: f64,
    /// Standard deviation of the ratio over directions: what is not radial.
    pub spread: f64,
}

/// Steps of field, and directions of each ring.
const STEPS: i32 = 40;
const DIRECTIONS: i32 = 72;

/// How far the nearest point of the chart may be seen, in steps at the centre: half a diagonal, in tilt and distortion.
const NEAR: f64 = 1.5;

/// The curve at steps of 2.5 % of the half diagonal.
pub(super) fn curve(ideal: &Ideal, nodes: &[Node], half_diagonal_px: f64) -> Vec<CurvePoint> {
    let seen: BTreeMap<[i64; 2], DVec2> = nodes.iter().map(|n| (n.index.map(|i| i as i64), n.at)).collect();
    (1..=STEPS).filter_map(|i| point(ideal, &seen, f64::from(i) / f64::from(STEPS), half_diagonal_px)).collect()
}

fn point(ideal: &Ideal, seen: &BTreeMap<[i64; 2], DVec2>, field: f64, half_diagonal_px: f64) -> Option<CurvePoint> {
    let radius = field * half_diagonal_px;
    let place = |i: i32| {
        let (sin, cos) = sin_cos(std::f64::consts::TAU * f64::from(i) / f64::from(DIRECTIONS));
        ideal.centre() + radius * DVec2::new(cos, sin)
    };
    // Between points of the chart, or beyond them by half a step at most. Far outside the fields may fold back onto the
    // chart: the point must be seen there, too.
    let within = |at: &DVec2| {
        let chart = ideal.chart(*at).map(|c| c.to_array().map(|c| c.round() as i64));
        let point = chart.and_then(|chart| seen.get(&chart));
        point.is_some_and(|p| (*p - *at).length() < NEAR * ideal.step_px())
    };
    let places: Vec<DVec2> = (0..DIRECTIONS).map(place).filter(within).collect();
    // A direction to each corner of the picture.
    if places.len() < 4 {
        return None;
    }
    let ratio = |at: &DVec2| Some(radius / (ideal.place(*at)? - ideal.centre()).length());
    let ratios: Vec<f64> = places.iter().map(ratio).collect::<Option<_>>()?;
    let count = ratios.len() as f64;
    let mean = ratios.iter().sum::<f64>() / count;
    let spread = (ratios.iter().map(|r| (r - mean) * (r - mean)).sum::<f64>() / count).sqrt();
    let mut sum: Vec<f64> = Vec::new();
    for (at, ratio) in places.iter().zip(&ratios) {
        let row = ideal.log_distance_row(*at)?;
        sum.resize(row.len(), 0.0);
        sum.iter_mut().zip(&row).for_each(|(s, r)| *s -= ratio * r / count);
    }
    Some(CurvePoint {
        field,
        ratio: Estimate::new(mean, ideal.variance(&sum).sqrt()),
        covered: count / f64::from(DIRECTIONS),
        spread,
    })
}
