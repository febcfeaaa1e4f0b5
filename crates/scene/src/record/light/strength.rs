//! Strength of a lamp.

use crate::place::Placed;
use crate::reader::{keyed, number};

keyed! {
    /// Strength of a lamp: total flux or greatest intensity.
    pub enum LampStrength {
        /// Luminous flux.
        luminous_flux_lm => LuminousFlux(Placed<f64>) = number("lm").at_least(0.0);
        /// Intensity in undimmed directions (spot: inner angle; projector: white).
        intensity_cd => Intensity(Placed<f64>) = number("cd").at_least(0.0);
        /// Radiant flux of the light, 300 … 1 100 nm.
        radiant_flux_w => RadiantFlux(Placed<f64>) = number("W").at_least(0.0);
    }
}

keyed! {
    /// Scale of a measured distribution.
    pub enum MeasuredStrength {
        /// Luminous flux of the whole distribution. Default: as measured.
        luminous_flux_lm => LuminousFlux(Placed<f64>) = number("lm").at_least(0.0);
        /// Factor on the measured intensities. Default: 1.
        scale => Scale(Placed<f64>) = number("").at_least(0.0);
    }
}
