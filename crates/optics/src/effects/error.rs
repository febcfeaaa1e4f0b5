//! Errors of irradiance effects.

/// An error of an irradiance effect.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum EffectsError {
    /// A fraction of scattered light outside its range.
    #[error("the scattered fraction is {fraction}; expected 0 to {most} (clean lenses scatter 0.005 to 0.03)")]
    Scatter {
        /// Value given.
        fraction: f64,
        /// Maximum fraction.
        most: f64,
    },
    /// A length or exponent that is not a positive number.
    #[error("\"{key}\" is {value}: give a number above 0")]
    NotPositive {
        key: &'static str,
        /// Value given.
        value: f64,
    },
    /// A kernel whose integral over the plane is infinite.
    #[error(
        "light that falls off with the exponent {exponent} has no finite integral over the plane: give an exponent above 2, or the radius \
         \"reach_mm\" at which it ends"
    )]
    Endless { exponent: f64 },
    /// An invalid table of a wavefront term.
    #[error(
        "a wavefront term needs one root-mean-square value per field radius, with increasing radii; or one value and no radii"
    )]
    Table,
    /// A wavefront too steep for the lattice of the pupil.
    #[error(
        "the wavefront's slope of {slope_um:.1} µm over the pupil's radius exceeds {limit_um:.1} µm, the limit up to which its pattern is \
         computed: give smaller terms; for large blur, defocus the lens by its focus distance"
    )]
    Slope {
        /// The maximum slope, µm.
        slope_um: f64,
        /// The maximum supported slope, µm.
        limit_um: f64,
    },
    /// A diffraction pattern wider than the model can compute.
    #[error(
        "the diffraction pattern of f/{f_number:.1} is wider than can be computed with pixels of {pixel_um:.3} µm; the largest f-number is f/{most:.1}: \
         give a smaller \"f_number\" or larger pixels, or remove [effects.psf]"
    )]
    WidePattern {
        /// Working f-number.
        f_number: f64,
        /// The maximum supported f-number.
        most: f64,
        /// Pixel pitch, µm.
        pixel_um: f64,
    },
    /// A function too wide for displaced samples.
    #[error(
        "only a fraction of {core:.2} of the light falls close enough for displaced samples (all within a pixel, none beyond 2.5 px; the minimum \
         is {least}): remove \"spread_by\", so that the film applies the function"
    )]
    WideCore {
        /// The fraction of the light in the core.
        core: f64,
        /// The minimum fraction.
        least: f64,
    },
    /// An image whose samples do not fill its rows.
    #[error(
        "the point-spread image has {count} samples, which do not fill rows of {width}: give one sample or more, in full rows"
    )]
    Samples {
        /// Number of samples.
        count: usize,
        /// Samples in a row.
        width: usize,
    },
    /// A sample of an image that is not valid light.
    #[error("column {column} of row {row} of the point-spread image is {value}; expected a number of at least 0")]
    NoLight {
        /// The column, from 0.
        column: usize,
        /// The row, from 0.
        row: usize,
        value: f32,
    },
    /// An image without light.
    #[error("the point-spread image is 0 everywhere: give one with light")]
    Dark,
    /// An image whose samples are farther apart than pixels.
    #[error(
        "the point-spread image's samples are {step_um:.3} µm apart on the sensor (at 780 nm, if it scales with the wavelength), more than the \
         pixel pitch of {pixel_um:.3} µm: light would fall in separate dots; give a finer image and its \"image_pitch_um\""
    )]
    Coarse {
        /// Pitch of the samples, µm.
        step_um: f64,
        /// Pixel pitch, µm.
        pixel_um: f64,
    },
    /// An image that spreads light too far.
    #[error(
        "the point-spread image spreads light over {reach_px} px (at 780 nm, if it scales with the wavelength); the maximum is {most_px}: crop it"
    )]
    Wide {
        reach_px: usize,
        /// Maximum reach, px.
        most_px: usize,
    },
    /// A function over the field whose samples are farther apart than pixels.
    #[error(
        "the function's samples are {step_um:.3} µm apart on the sensor, more than the pixel pitch of {pixel_um:.3} µm: light would fall in \
         separate dots; export it with a smaller spacing (\"image delta\")"
    )]
    CoarseFunction {
        /// Pitch of the samples, µm.
        step_um: f64,
        /// Pixel pitch, µm.
        pixel_um: f64,
    },
    /// A function over the field that spreads light too far.
    #[error("the function spreads light over {reach_px} px; the maximum is {most_px}: export it over a smaller area")]
    WideFunction {
        reach_px: usize,
        /// Maximum reach, px.
        most_px: usize,
    },
    /// Functions over the field that do not form a table.
    #[error(
        "functions over the field need increasing distances from the axis, the same number at every wavelength, and increasing wavelengths"
    )]
    SpreadTable,
    /// A table of modulation that no lens has.
    #[error(
        "the modulation is not a sum of Gaussians: the closest fit deviates by {deviation:.3}, and the maximum is {most}; expected modulations \
         that fall from 1 with the frequency"
    )]
    Modulation {
        /// Deviation of the best fit.
        deviation: f64,
        /// Maximum deviation.
        most: f64,
    },
    /// A margin outside its range.
    #[error("the margin is {margin}; expected 0 to 1, as a fraction of the image's size")]
    Margin {
        /// Value given.
        margin: f64,
    },
    /// A margin that no effect uses.
    #[error(
        "\"margin\" has no effect without an effect that uses light from outside the image: remove it, or add [effects.glare]"
    )]
    IdleMargin,
}

/// Returns the value if it is a positive number.
pub(crate) fn positive(key: &'static str, value: f64) -> Result<f64, EffectsError> {
    if value.is_finite() && value > 0.0 { Ok(value) } else { Err(EffectsError::NotPositive { key, value }) }
}
