//! Permitted error of a pixel's mean in noise-limited sampling.

use etendue_sensor::TemporalNoise;

/// Number of standard deviations of the mean above white from which a pixel's error is ignored.
const CLIPPED_SIGMAS: f64 = 4.0;

/// Samples until noise is below a limit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AdaptiveSampling {
    /// Maximum standard error over the noise that the sensor adds, or over the pixel's mean without a sensor.
    pub threshold: f64,
    /// Minimum samples of a pixel.
    pub min_spp: u32,
}

/// Permitted error.
#[derive(Clone, Debug, PartialEq)]
pub struct Tolerance {
    limit: AdaptiveSampling,
    /// Noise of the sensor if electrons are monitored; otherwise the pixel's own mean is the reference.
    sensor: Option<TemporalNoise>,
}

impl Tolerance {
    /// Tolerance as a fraction of the noise of a sensor, or of each pixel's mean without one.
    #[must_use]
    pub fn new(limit: AdaptiveSampling, sensor: Option<TemporalNoise>) -> Self {
        Self { limit, sensor }
    }

    /// Minimum samples of a pixel.
    #[must_use]
    pub fn min_spp(&self) -> u32 {
        self.limit.min_spp
    }

    /// Noise of the sensor, if that is the reference.
    #[must_use]
    pub fn sensor(&self) -> Option<&TemporalNoise> {
        self.sensor.as_ref()
    }

    /// Permitted variance of a pixel's mean, in the square of the mean's unit: electrons per second with a sensor.
    #[must_use]
    pub fn variance(&self, mean: f64) -> f64 {
        let factor = self.limit.threshold;
        let Some(noise) = &self.sensor else { return factor * factor * mean * mean };
        let exposure_s = noise.exposure_s();
        if exposure_s == 0.0 {
            return f64::INFINITY;
        }
        let mean_e = mean * exposure_s;
        let beyond_e = (mean_e - noise.white_e()).max(0.0) / CLIPPED_SIGMAS;
        (factor * factor * noise.variance_e2(mean_e)).max(beyond_e * beyond_e) / (exposure_s * exposure_s)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sensor_lets_more_be_the_brighter_it_is_and_all_beyond_white() {
        let noise = TemporalNoise::from_one_capture(0.5, 9.0, 1000.0);
        let tolerance = Tolerance::new(AdaptiveSampling { threshold: 0.5, min_spp: 16 }, Some(noise));
        // Electrons per second; the exposure is half a second.
        let at = |mean: f64| tolerance.variance(mean);
        assert!((at(0.0) - 0.25 * 9.0 * 4.0).abs() < 1e-9 && (at(200.0) - 0.25 * 109.0 * 4.0).abs() < 1e-9);
        let bright = 2.0 * 9000.0;
        assert!((at(bright) - 2000.0 * 2000.0 * 4.0).abs() < 1.0);
    }
}
