//! The Pareto front of configurations, and three recommendations: draft, standard image and reference.

use crate::configuration::Configuration;
use crate::error::{ErrorMetrics, Estimate};
use crate::measured::ConfigurationMeasurement;
use serde::Serialize;

/// Maximum number of samples considered.
const MAX_SPP: f64 = 1_048_576.0;
/// Maximum bias as a fraction of the target's mean square, and the number of its uncertainties that are added to it.
const MAX_BIAS_FRACTION: f64 = 0.25;
const BIAS_UNCERTAINTIES: f64 = 1.0;
/// Exponents of the sample counts of a point of the front, powers of two.
const FRONT_POWERS: std::ops::RangeInclusive<u32> = 2..=14;

/// A configuration with a number of samples, and its estimated time and error.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FrontPoint {
    #[serde(rename = "way")]
    pub configuration: Configuration,
    /// Samples per pixel.
    pub spp: u32,
    /// Number of independent replicates.
    pub replicates: u32,
    /// Time of the whole run, s.
    pub seconds: Estimate,
    /// Root mean square errors, bias and noise combined.
    pub error: ErrorMetrics<Estimate>,
}

/// Required quality of an image: either limit suffices.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ErrorTarget {
    /// Its name, also that of the job file.
    pub name: &'static str,
    /// Root mean square error over the sensor's noise; `None` without electrons.
    pub sensor: Option<f64>,
    /// Relative root mean square error of the light; `None` if the sensor's noise alone decides.
    pub relative: Option<f64>,
}

/// Error over the sensor's noise; relative to the light. For a draft either limit suffices.
const TARGETS: [(&str, f64, f64); 3] = [("draft", 2.0, 0.1), ("standard", 0.5, 0.03), ("reference", 0.1, 0.01)];

/// The three targets of a study.
#[must_use]
pub(crate) fn targets(has_sensor: bool) -> [ErrorTarget; 3] {
    TARGETS.map(|(name, sensor, relative)| ErrorTarget {
        name,
        sensor: has_sensor.then_some(sensor),
        relative: (name == TARGETS[0].0 || !has_sensor).then_some(relative),
    })
}

impl ErrorTarget {
    /// Returns true if a configuration with this number of samples meets the target, with its bias a small part of the permitted error.
    fn is_reached(&self, configuration: &ConfigurationMeasurement, spp: f64, replicates: f64) -> bool {
        let (error, bias) = (configuration.error(spp, replicates), &configuration.bias_squares);
        let meets = |limit: Option<f64>, error: Option<Estimate>, bias: Option<Estimate>| {
            limit.zip(error).zip(bias).is_some_and(|((limit, error), bias)| {
                let bias = bias.value + BIAS_UNCERTAINTIES * bias.uncertainty;
                error.value <= limit * limit && bias <= MAX_BIAS_FRACTION * limit * limit
            })
        };
        meets(self.sensor, error.sensor, bias.sensor) || meets(self.relative, Some(error.relative), Some(bias.relative))
    }
}

/// Test of a recommendation on other tiles, compared with its estimate.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct RecommendationTest {
    /// Number of tiles of the test.
    pub tiles: u32,
    /// True if the study had not sampled these tiles; small images are sampled as a whole.
    pub unseen: bool,
    /// Samples of each replicate of the test: those of the recommendation, or fewer if these take longer than a study may.
    pub samples: u32,
    /// Measured time of samples over the estimate of the pilots. The recommendation's time includes this factor.
    pub seconds: Estimate,
    /// Measured noise (root mean square, without bias) over the estimate; `None` without an estimate.
    pub noise: Option<Estimate>,
}

/// Recommended settings for a target.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Recommendation {
    pub target: ErrorTarget,
    /// The estimate, with the time corrected by the test if there was one.
    pub point: FrontPoint,
    /// True if the target is reached.
    pub is_reached: bool,
    /// Result of the test; `None` for images of too few tiles.
    pub confirmation: Option<RecommendationTest>,
}

/// Time of a frame excluding its light, and the number of replicates that share the samples.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FrameOverhead {
    pub(crate) rest_s: f64,
    pub(crate) replicates: u32,
}

/// Estimated point of a configuration with a number of samples.
pub(crate) fn point(measured: &ConfigurationMeasurement, spp: u32, frame: FrameOverhead) -> FrontPoint {
    let replicates = frame.replicates.min(spp);
    FrontPoint {
        configuration: measured.configuration,
        spp,
        replicates,
        seconds: measured.seconds(f64::from(spp), frame.rest_s),
        error: measured.error(f64::from(spp), f64::from(replicates)).map(|square| square.root()),
    }
}

/// Pareto front: the points that no other configuration beats in both time and error, by the deciding metric, shortest first.
pub(crate) fn front(configurations: &[ConfigurationMeasurement], frame: FrameOverhead) -> Vec<FrontPoint> {
    let counts = FRONT_POWERS.map(|power| (1_u32 << power).next_multiple_of(frame.replicates));
    let mut points: Vec<_> = counts
        .flat_map(|spp| configurations.iter().map(move |configuration| point(configuration, spp, frame)))
        .collect();
    points.sort_by(|a, b| a.seconds.value.total_cmp(&b.seconds.value));
    let mut min_error = f64::INFINITY;
    points.retain(|point| {
        let error = point.error.main_metric().value;
        let is_better = error < 0.99 * min_error;
        min_error = min_error.min(error);
        is_better
    });
    points
}

/// The fastest configuration that reaches a target; the one with the smallest error if none does.
pub(crate) fn recommend(
    configurations: &[ConfigurationMeasurement],
    target: ErrorTarget,
    frame: FrameOverhead,
) -> Option<Recommendation> {
    let reaching = configurations
        .iter()
        .filter_map(|configuration| Some(point(configuration, samples_for(configuration, target, frame)?, frame)));
    let quickest = reaching.min_by(|a, b| a.seconds.value.total_cmp(&b.seconds.value));
    let best = || {
        let max_samples = MAX_SPP as u32 / frame.replicates * frame.replicates;
        let all = configurations.iter().map(|configuration| point(configuration, max_samples, frame));
        all.min_by(|a, b| a.error.main_metric().value.total_cmp(&b.error.main_metric().value))
    };
    let is_reached = quickest.is_some();
    let point = quickest.or_else(best)?;
    Some(Recommendation { target, point, is_reached, confirmation: None })
}

/// Smallest number of samples that reaches a target; `None` if no number does.
fn samples_for(configuration: &ConfigurationMeasurement, target: ErrorTarget, frame: FrameOverhead) -> Option<u32> {
    let replicates = f64::from(frame.replicates);
    let reaches = |rounds: u32| target.is_reached(configuration, f64::from(rounds) * replicates, replicates);
    let max_samples = (MAX_SPP / replicates) as u32;
    if !reaches(max_samples) {
        return None;
    }
    let (mut short, mut enough) = (0, max_samples);
    while enough - short > 1 {
        let middle = short + (enough - short) / 2;
        if reaches(middle) { enough = middle } else { short = middle }
    }
    Some(enough * frame.replicates)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measured::{PowerLaw, Role};
    use etendue::{Accelerator, Integrator, PathSettings};

    /// A configuration whose sample takes `sample_s`, with a variance and bias in the relative metric.
    fn configuration(integrator: Integrator, sample_s: f64, variance: f64, bias: f64) -> ConfigurationMeasurement {
        let exact = |value: f64| Estimate { value, uncertainty: 0.0 };
        let law = PowerLaw { samples: 1.0, value: exact(variance), exponent: exact(1.0) };
        ConfigurationMeasurement {
            configuration: Configuration {
                paths: PathSettings { integrator, max_bounces: 64, ..PathSettings::default() },
                path_reuse_px: 1,
                wavelengths: 4,
                accelerator: Accelerator::Default,
            },
            role: Role::Stated,
            load_s: 0.5,
            frame_s: 0.25,
            sample_s: exact(sample_s),
            variance: ErrorMetrics { relative: law, sensor: None, patch: law },
            bias: None,
            bias_squares: ErrorMetrics { relative: exact(bias), sensor: None, patch: exact(bias) },
        }
    }

    const FRAME: FrameOverhead = FrameOverhead { rest_s: 0.25, replicates: 4 };

    #[test]
    fn cheap_configurations_win_for_low_targets() {
        let configurations =
            [configuration(Integrator::Path, 1.0, 0.04, 0.0), configuration(Integrator::Direct, 0.25, 0.04, 1e-4)];
        let of = |error: f64| {
            recommend(&configurations, ErrorTarget { name: "draft", sensor: None, relative: Some(error) }, FRAME)
                .map(|r| (r.point.configuration.paths.integrator, r.point.spp))
        };
        // 0.04/n + 1e-4 is 0.0025 at 16.7.
        assert_eq!(of(0.05), Some((Integrator::Direct, 20)));
        // For 1e-4 the bias alone exhausts the target.
        assert_eq!(of(0.01), Some((Integrator::Path, 400)));
        let seconds =
            recommend(&configurations, ErrorTarget { name: "draft", sensor: None, relative: Some(0.01) }, FRAME)
                .map(|r| r.point.seconds.value);
        assert!(seconds.is_some_and(|s| (s - 401.0).abs() < 1e-9), "{seconds:?}");
    }

    #[test]
    fn an_unreachable_target_is_reported() {
        let configurations = [configuration(Integrator::Flat, 0.1, 0.04, 0.3)];
        let table =
            recommend(&configurations, ErrorTarget { name: "reference", sensor: None, relative: Some(0.01) }, FRAME)
                .expect("the best there is");
        assert!(!table.is_reached && table.point.error.relative.value > 0.5);
    }

    #[test]
    fn the_front_falls() {
        let configurations =
            [configuration(Integrator::Path, 1.0, 0.04, 0.0), configuration(Integrator::Direct, 0.25, 0.04, 1e-4)];
        let front = front(&configurations, FRAME);
        assert!(
            front
                .windows(2)
                .all(|p| p[0].seconds.value <= p[1].seconds.value
                    && p[0].error.relative.value > p[1].error.relative.value)
        );
        assert_eq!(front.first().map(|p| p.configuration.paths.integrator), Some(Integrator::Direct));
        assert_eq!(front.last().map(|p| p.configuration.paths.integrator), Some(Integrator::Path));
    }
}
