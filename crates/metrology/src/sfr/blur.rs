//! Blur of edges beyond the pixel aperture: a Gaussian spread, and crosstalk between neighbouring pixels.
//!
//! ```text
//! R(f) = A(f) exp(−2π² s f²) (1 − 2 a (1 − cos(2π f cos θ)))
//! ```
//!
//! A is the aperture of full square pixels, s the variance of the spread along the normal (px²), a the fraction of a pixel's
//! light that each of the two neighbours across the edge receives, θ the angle from the normal to the nearest of rows and
//! columns. s and a are fitted to the response of each edge by least squares, weighted by its uncertainties; noise can make both
//! negative. The result is their mean over edges with the standard error of the mean, widened for few edges so that twice of it
//! covers 95 % (Student's t). The standard error includes differences between edges; a spread that is not Gaussian affects only
//! [`Blur::misfit`].

use std::f64::consts::PI;

use etendue_core::maths::f64::{cos, exp, sin, sin_cos};
use etendue_stats::{Moments, normal, student};

use super::{Sfr, SfrPoint};
use crate::Estimate;

/// Maximum fitted frequency, cycles per pixel: above it the aperture leaves little signal.
const MAX_FREQUENCY: f64 = 0.8;
/// Minimum uncertainty of a response.
const MIN_UNCERTAINTY: f64 = 1e-4;

/// Blur of edges of one direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Blur {
    /// Variance of the spread, px².
    pub variance_px2: Estimate,
    /// Fraction of a pixel's light that each neighbour across the edge receives.
    pub exchange: Estimate,
    /// Maximum difference of the mean response from the model up to half a cycle per pixel.
    pub misfit: f64,
    /// Number of edges.
    pub edges: usize,
}

/// The blur of edges of one direction; `None` for fewer than three edges, or if a response does not determine it.
#[must_use]
pub fn blur(edges: &[&Sfr]) -> Option<Blur> {
    if edges.len() < 3 {
        return None;
    }
    let equations: Vec<[f64; 2]> = edges.iter().map(|edge| fitted(edge)).collect::<Option<_>>()?;
    let [variance_px2, exchange] = [0, 1].map(|k| mean(&equations, k));
    let mean = [variance_px2.value, exchange.value];
    let off = |edge: &&Sfr| {
        let near = edge.curve.iter().filter(|p| p.frequency <= 0.5);
        near.map(|p| p.response.value - model(p.frequency, edge.angle_deg, mean).0).collect::<Vec<_>>()
    };
    let differences: Vec<Vec<f64>> = edges.iter().map(off).collect();
    let shortest = differences.iter().map(Vec::len).min()?;
    let at = |i: usize| differences.iter().map(|d| d[i]).sum::<f64>() / differences.len() as f64;
    let misfit = (0..shortest).map(|i| at(i).abs()).fold(0.0, f64::max);
    Some(Blur { variance_px2, exchange, misfit, edges: edges.len() })
}

/// Mean over several edges.
fn mean(samples: &[[f64; 2]], k: usize) -> Estimate {
    let moments = Moments::from_values(samples.iter().map(|pair| pair[k]));
    let error = moments.variance_of_mean().unwrap_or(f64::INFINITY).sqrt();
    Estimate::new(moments.mean(), error * widening(samples.len() as f64 - 1.0))
}

/// Student's t at 95 % relative to the normal quantile.
fn widening(freedom: f64) -> f64 {
    student::critical(0.05, freedom) / normal::quantile(0.975)
}

/// Response and its derivatives by s and a, of the model.
fn model(f: f64, angle_deg: f64, [s, a]: [f64; 2]) -> (f64, [f64; 2]) {
    let (across, along) = sin_cos(angle_deg.to_radians());
    let aperture = (sinc(f * along) * sinc(f * across)).abs();
    let curvature = 2.0 * PI * PI * f * f;
    let spread = exp(-curvature * s);
    let ripple = 2.0 * (1.0 - cos(2.0 * PI * f * along));
    let neighbours = 1.0 - a * ripple;
    let response = aperture * spread * neighbours;
    (response, [-curvature * response, -aperture * spread * ripple])
}

fn sinc(x: f64) -> f64 {
    if x == 0.0 { 1.0 } else { sin(PI * x) / (PI * x) }
}

/// s and a of one edge, by Gauss and Newton.
fn fitted(edge: &Sfr) -> Option<[f64; 2]> {
    let mut at = [0.0; 2];
    for _ in 0..20 {
        let step = step(&edge.curve, edge.angle_deg, at)?;
        at = [at[0] + step[0], at[1] + step[1]];
        if step.iter().all(|d| d.abs() < 1e-10) {
            break;
        }
    }
    at.iter().all(|v| v.is_finite()).then_some(at)
}

fn step(curve: &[SfrPoint], angle_deg: f64, at: [f64; 2]) -> Option<[f64; 2]> {
    let mut normal = crate::linear::Normal::new(2);
    for p in curve.iter().filter(|p| p.frequency > 0.0 && p.frequency <= MAX_FREQUENCY) {
        let u = p.response.standard_uncertainty.max(MIN_UNCERTAINTY);
        let (response, slopes) = model(p.frequency, angle_deg, at);
        if u.is_finite() {
            normal.add(&slopes, p.response.value - response, 1.0 / (u * u));
        }
    }
    let step = normal.solve()?;
    Some([step[0], step[1]])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sfr::Orientation;

    fn edge(truth: [f64; 2], off: f64) -> Sfr {
        let point = |i: i32| {
            let frequency = 0.01 * f64::from(i);
            let noise = off * sin(37.0 * frequency + 1e3 * off);
            SfrPoint { frequency, response: Estimate::new(model(frequency, 5.0, truth).0 + noise, 0.002) }
        };
        Sfr {
            angle_deg: 5.0,
            orientation: Orientation::Vertical,
            levels: [10.0, 100.0],
            noise: 1.0,
            step_px: 0.25,
            curve: (0..=100).map(point).collect(),
            mtf50: None,
            mtf10: None,
            shading: 0.0,
            profile: Vec::new(),
        }
    }

    #[test]
    fn spread_and_crosstalk_are_separated() {
        for truth in [[0.0, 0.0], [0.3, 0.0], [0.0, 0.026], [0.12, 0.02]] {
            let edges = [0.001, -0.001, 0.002, -0.002, 0.0].map(|off| edge(truth, off));
            let measured = blur(&edges.iter().collect::<Vec<_>>()).expect("five edges");
            for (e, truth) in [measured.variance_px2, measured.exchange].into_iter().zip(truth) {
                assert!((e.value - truth).abs() < 3.0 * e.standard_uncertainty + 1e-9, "{e:?} {truth}");
                assert!(e.standard_uncertainty < 0.01, "{e:?}");
            }
            assert!(measured.misfit < 0.002, "{}", measured.misfit);
        }
        let two = [edge([0.0; 2], 0.0), edge([0.0; 2], 0.001)];
        assert_eq!(blur(&two.iter().collect::<Vec<_>>()), None);
    }

    #[test]
    fn few_edges_are_widened_as_student_says() {
        for (freedom, t) in [(2.0, 4.3027), (3.0, 3.1824), (8.0, 2.3060), (30.0, 2.0423)] {
            assert!((widening(freedom) * 1.959_964 / t - 1.0).abs() < 1e-3, "{freedom}");
        }
    }
}
