//! Strength of a lamp.

use crate::place::Placed;
use crate::reader::{keyed, number};

keyed! {
    /// Strength of a lamp: total flux or greatest intensity.
    pub enum LampStrength {
        /// Luminous flux, lm, 0 or more.
        luminous_flux_lm => LuminousFlux(Placed<f64>) = number("lm").at_least(0.0);
        /// Luminous intensity in undimmed directions (for a spot within its inner angle, for a projector where the image is white), cd, 0 or more.
        intensity_cd => Intensity(Placed<f64>) = number("cd").at_least(0.0);
        /// Radiant flux, summed over 300 … 1 100 nm, W, 0 or more: of the light, not the electrical power.
        radiant_flux_w => RadiantFlux(Placed<f64>) = number("W").at_least(0.0);
    }
}

keyed! {
    /// Scale of a measured distribution.
    pub enum MeasuredStrength {
        /// Luminous flux of the whole distribution, lm, 0 or more. Default: as measured.
        luminous_flux_lm => LuminousFlux(Placed<f64>) = number("lm").at_least(0.0);
        /// Factor on the measured intensities, 0 or more: dimming, or a lamp of another power. Default: 1.
        scale => Scale(Placed<f64>) = number("").at_least(0.0);
    }
}
