//! Progress of a noise-limited film: samples, errors, and pixels beyond the limit.

use crate::render::film::Film;
use crate::sizes::tolerance::Tolerance;

/// Result of noise-limited sampling.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NoiseLimitResult {
    /// Mean samples per pixel.
    pub mean_spp: f64,
    /// Minimum and maximum samples of a pixel.
    pub range_spp: (u32, u32),
    /// Standard error over the permitted one: root mean square over all pixels with samples. 1 at the limit.
    pub error: f64,
    /// Fraction of the pixels that received more than half of the maximum samples and still exceed the limit.
    pub beyond_limit_fraction: f64,
}

impl NoiseLimitResult {
    /// Evaluates the pixels of a film that have samples, at most `max_spp` each; `None` without a monitored signal or without samples.
    #[must_use]
    pub fn new(film: &Film, tolerance: &Tolerance, max_spp: u32) -> Option<Self> {
        let watched = film.watched.as_ref()?;
        let (mut samples, mut range, mut squares, mut short, mut count) = (0.0, (u32::MAX, 0), 0.0, 0.0, 0.0);
        let light = watched.mean.samples().iter().zip(watched.variance.samples());
        for (n, (mean, variance)) in film.samples.samples().iter().zip(light).filter(|(n, _)| **n > 0) {
            let tolerated = tolerance.variance(f64::from(*mean));
            let excess = if *variance == 0.0 { 0.0 } else { f64::from(*variance) / tolerated };
            if !excess.is_finite() {
                continue;
            }
            (samples, count, squares) = (samples + f64::from(*n), count + 1.0, squares + excess);
            range = (range.0.min(*n), range.1.max(*n));
            short += f64::from(u8::from(2 * u64::from(*n) > u64::from(max_spp) && excess > 1.0));
        }
        (count > 0.0).then(|| Self {
            mean_spp: samples / count,
            range_spp: range,
            error: (squares / count).sqrt(),
            beyond_limit_fraction: short / count,
        })
    }
}
