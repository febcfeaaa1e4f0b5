//! `[effects]`: what becomes of the irradiance behind the lens.

use crate::fault::Faults;
use crate::place::Placed;
use crate::reader::{number, record};

record! {
    /// What becomes of the irradiance behind the lens, on either route. The film is rendered wider than the picture, for light
    /// that comes from beyond its edge, and spectral bands are kept.
    pub struct Effects check(check) {
        /// Light scattered in the lens. Default: none.
        optional glare: Glare = record();
        /// Width of what is rendered beyond the picture on every side, as a share of its width and height, 0 … 1. Default: as
        /// far as the effects reach, at most 0.25.
        optional margin: Placed<f64> = number("").at_least(0.0).at_most(1.0);
    }
}

record! {
    /// Light scattered over the sensor: of the light of a point the share 1 − s stays, and s is spread with a density in
    /// proportion to (r₀² + r²)^(−p/2), r the distance on the sensor.
    pub struct Glare {
        /// The share s, 0 … 0.5: 0.005 to 0.03 for clean lenses, more with dirt.
        required scatter: Placed<f64> = number("").at_least(0.0).at_most(0.5);
        /// The radius r₀ within which scattered light is even, µm, above 0.
        required core_um: Placed<f64> = number("µm").above(0.0);
        /// The exponent p, above 0; above 2 unless "reach_mm" is given.
        required exponent: Placed<f64> = number("").above(0.0);
        /// Where scattered light ends, mm, above 0. Default: nowhere.
        optional reach_mm: Placed<f64> = number("mm").above(0.0);
    }
}

fn check(effects: &Effects, faults: &mut Faults) {
    if effects.glare.is_none() {
        faults.add(&effects.place, "[effects] describes no effect", "add [effects.glare], or remove the section");
    }
}
