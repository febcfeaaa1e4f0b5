//! Why an effect cannot be.

/// Why an irradiance effect cannot be.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum EffectsError {
    /// A share of scattered light outside of its range.
    #[error("a scattered share of {share} is not within 0 to {most}; clean lenses scatter 0.005 to 0.03")]
    Scatter {
        /// What was given.
        share: f64,
        /// The largest share.
        most: f64,
    },
    /// A length or exponent that is not a positive number.
    #[error("\"{key}\" is {value}: give a number above 0")]
    NotPositive {
        /// The key.
        key: &'static str,
        /// What was given.
        value: f64,
    },
    /// A kernel whose integral over the plane is infinite.
    #[error(
        "light that falls off with the exponent {exponent} has no finite sum over the plane: give an exponent above 2, or \
         \"reach_mm\", where it ends"
    )]
    Endless {
        /// The exponent.
        exponent: f64,
    },
    /// A table of a wavefront term that is none.
    #[error("a wavefront term needs as many root mean squares as field radii, which must rise; or one, and no radii")]
    Table,
    /// A wavefront too steep for the pupil's lattice.
    #[error(
        "the wavefront's slope of {slope_um:.1} µm over the pupil's radius is beyond {limit_um:.1} µm, where its pattern is no \
         longer held: give smaller terms; large blurs are defocus, which the lens's own focus makes"
    )]
    Slope {
        /// The steepest slope, µm.
        slope_um: f64,
        /// The steepest that is held, µm.
        limit_um: f64,
    },
    /// A margin that is no share.
    #[error("a margin of {margin} is not within 0 to 1 of the picture's size")]
    Margin {
        /// What was given.
        margin: f64,
    },
    /// A margin that nothing needs.
    #[error(
        "\"margin\" has no effect without an effect that takes light from outside the picture: remove it, or add \
         [effects.glare]"
    )]
    IdleMargin,
}

/// The value, if it is a positive number.
pub(crate) fn positive(key: &'static str, value: f64) -> Result<f64, EffectsError> {
    if value.is_finite() && value > 0.0 { Ok(value) } else { Err(EffectsError::NotPositive { key, value }) }
}
