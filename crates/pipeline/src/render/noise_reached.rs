//! How far a film that noise limits has come: samples, errors, and what is short of the limit.

use crate::render::film::Film;
use crate::sizes::tolerance::Tolerance;

/// What became of a limit of noise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NoiseReached {
    /// Mean samples of a pixel.
    pub mean_spp: f64,
    /// Fewest and most samples of a pixel.
    pub range_spp: (u32, u32),
    /// Standard error over what is tolerated: the root of the mean square over all pixels with samples. 1 at the limit.
    pub error: f64,
    /// Share of the pixels that got more than half of the most samples and whose error is still beyond the limit.
    pub short: f64,
}

impl NoiseReached {
    /// Of the pixels of a film that have samples, none of which got more than `max_spp`; `None` where nothing was watched or no pixel has
    /// samples.
    #[must_use]
    pub fn of(film: &Film, tolerance: &Tolerance, max_spp: u32) -> Option<Self> {
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
            short: short / count,
        })
    }
}
