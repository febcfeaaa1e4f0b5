//! By what a point-spread function spreads light: by the film's pixels, or sample by sample.

use super::error::EffectsError;
use super::spread_width::SpreadWidth;

/// Light in the core from which on samples may be displaced: its blur of the tails, which the film then spreads once more, stays unseen.
const MIN_CORE: f64 = 0.8;
/// Errors of the film's modulation that are left to it where samples cost no noise: the function is the same at all wavelengths.
const MAX_FILM_ERROR: f64 = 0.01;
/// The same where they do. Diffraction by itself reaches 0.061, at half a cycle a pixel along the diagonals.
const MAX_FILM_ERROR_OF_BANDS: f64 = 0.065;

/// By what light is spread.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SpreadBy {
    /// Pixels of the film: no noise, but contrast is lost where the function is about as narrow as a pixel or narrower.
    Film,
    /// Samples that are displaced, with the film for the tails: exact however narrow, with some more noise.
    Samples,
}

impl SpreadBy {
    /// As asked for. Where nothing is, by samples if the function is narrow and the film would be wrong by more than 0.01, or 0.065 where samples
    /// cost noise.
    pub(super) fn choose(asked: Option<Self>, width: SpreadWidth) -> Result<Self, EffectsError> {
        let is_narrow = width.core >= MIN_CORE;
        let limit = if width.scales { MAX_FILM_ERROR_OF_BANDS } else { MAX_FILM_ERROR };
        match asked {
            Some(Self::Samples) if !is_narrow => Err(EffectsError::WideCore { core: width.core, least: MIN_CORE }),
            Some(asked) => Ok(asked),
            None if is_narrow && width.film_error > limit => Ok(Self::Samples),
            None => Ok(Self::Film),
        }
    }
}
