//! Illuminants and lamps by name, the Sun, and the black body.
//!
//! CIE illuminants and measured lamps are **relative** powers: scale them with [`observer::with_luminance`](crate::observer::with_luminance). The Sun
//! and the black body are absolute.

use std::sync::LazyLock;

use etendue_core::maths;

use crate::{Extrapolation, Spectrum, spectrum::embedded};

macro_rules! tables {
    ($($name:literal $file:literal;)*) => {
        const NAMES: &[&str] = &[$($name),*];
        static TABLES: LazyLock<Vec<Spectrum>> = LazyLock::new(|| {
            [$(include_str!(concat!("../data/", $file, ".csv"))),*].into_iter().map(relative_power).collect()
        });
    };
}

tables! {
    "A" "illuminant_a";
    "D50" "illuminant_d50";
    "D65" "illuminant_d65";
    "E" "illuminant_e";
    "FL2" "illuminant_fl2";
    "FL11" "illuminant_fl11";
    "HP1" "illuminant_hp1";
    "LED-B3" "illuminant_led_b3";
    "LED-B5" "illuminant_led_b5";
    "LED-RGB1" "illuminant_led_rgb1";
    "LED-V1" "illuminant_led_v1";
    "incandescent" "lamp_incandescent";
    "led-white-yag" "lamp_white_led_yag";
    "mercury" "lamp_mercury";
    "metal-halide" "lamp_metal_halide";
    "sodium-high-pressure" "lamp_high_pressure_sodium";
    "sodium-low-pressure" "lamp_low_pressure_sodium";
}

fn relative_power(text: &str) -> Spectrum {
    embedded::<2>(text, Extrapolation::Zero).swap_remove(0)
}

/// The relative spectral power of an illuminant or lamp; zero outside its table. `None` for a name not in [`names`].
#[must_use]
pub fn by_name(name: &str) -> Option<&'static Spectrum> {
    NAMES.iter().position(|n| *n == name).map(|i| &TABLES[i])
}

/// The names accepted by [`by_name`]: CIE illuminants (A, D50, D65, E, FL2, FL11, HP1, LED-B3, LED-B5, LED-RGB1, LED-V1) and measured lamps
/// (incandescent, led-white-yag, mercury, metal-halide, sodium-high-pressure, sodium-low-pressure).
#[must_use]
pub fn names() -> &'static [&'static str] {
    NAMES
}

/// CIE standard illuminant D65, relative power.
#[must_use]
pub fn d65() -> &'static Spectrum {
    by_name("D65").expect("D65 is in the list")
}

/// Solar spectral irradiance of ASTM G-173, W·m⁻²·nm⁻¹.
#[derive(Clone, Debug, PartialEq)]
pub struct SolarIrradiance {
    /// Above the atmosphere.
    pub extraterrestrial: Spectrum,
    /// At the ground through 1.5 air masses, on a plane tilted 37° to the Sun, sky and ground included.
    pub global_tilt: Spectrum,
    /// At the ground through 1.5 air masses, from the Sun's disc and the 2.5° about it, on a plane facing the Sun.
    pub direct: Spectrum,
}

/// Solar spectral irradiance of ASTM G-173, W·m⁻²·nm⁻¹.
#[must_use]
pub fn solar() -> &'static SolarIrradiance {
    static SOLAR: LazyLock<SolarIrradiance> = LazyLock::new(|| {
        let table = embedded::<4>(include_str!("../data/astm_g173_solar.csv"), Extrapolation::Zero);
        let [extraterrestrial, global_tilt, direct] = table.try_into().expect("three columns");
        SolarIrradiance { extraterrestrial, global_tilt, direct }
    });
    &SOLAR
}

/// Planck constant, J·s.
const PLANCK_J_S: f64 = 6.626_070_15e-34;
/// Speed of light, m/s.
const LIGHT_M_S: f64 = 299_792_458.0;
/// Boltzmann constant, J/K.
const BOLTZMANN_J_K: f64 = 1.380_649e-23;

/// Spectral radiance of a black body, W·m⁻²·sr⁻¹·nm⁻¹, by Planck's law (constants of the SI of 2019); in vacuum. Zero at 0 K and below (which has no
/// meaning).
#[must_use]
pub fn blackbody(kelvin: f64) -> Spectrum {
    Spectrum::from_fn(|nm| planck(nm, kelvin))
}

/// Planck's spectral radiance at one wavelength (nm), W·m⁻²·sr⁻¹·nm⁻¹: 2hc²/λ⁵ · 1/(exp(hc/λkT) − 1).
#[must_use]
pub fn planck(nm: f64, kelvin: f64) -> f64 {
    if kelvin <= 0.0 {
        return 0.0;
    }
    let metres = nm * 1e-9;
    let metres_5 = metres * metres * metres * metres * metres;
    let exponent = PLANCK_J_S * LIGHT_M_S / (metres * BOLTZMANN_J_K * kelvin);
    2.0 * PLANCK_J_S * LIGHT_M_S * LIGHT_M_S / metres_5 / maths::f64::exp_m1(exponent) * 1e-9
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::f64::consts::PI;

    #[test]
    fn every_name_has_a_light() {
        for name in names() {
            let light = by_name(name).expect("a name of the list");
            assert!(light.min_value() >= 0.0 && light.max_value() > 0.0, "{name}");
            assert_eq!((light.at(1000.0), light.at(840.0)), (0.0, 0.0), "{name} is zero outside its table");
        }
        assert!(by_name("d65").is_none());
    }

    /// π ∫ B dλ = σT⁴, by Simpson's rule in ln λ from 100 nm to 20 mm.
    #[test]
    fn stefan_and_boltzmann() {
        let kelvin = 3000.0;
        let (low, steps, step) = (maths::f64::ln(100.0), 4000, maths::f64::ln(2e5) / 4000.0);
        let term = |i: i32| {
            let nm = maths::f64::exp(low + step * f64::from(i));
            planck(nm, kelvin) * nm
        };
        let weight = |i: i32| {
            if i == 0 || i == steps {
                1.0
            } else if i % 2 == 1 {
                4.0
            } else {
                2.0
            }
        };
        let exitance = PI * step / 3.0 * (0..=steps).map(|i| weight(i) * term(i)).sum::<f64>();
        let expected = 5.670_374_419e-8 * 3000.0_f64 * 3000.0 * 3000.0 * 3000.0;
        // Beyond 20 mm the fraction is 15/π⁴ · x³/3 = 7e-13 for x = hc/λkT = 2.4e-4; σ has ten digits; Simpson's error is less.
        assert!((exitance / expected - 1.0).abs() < 1e-9, "{exitance} against {expected}");
    }

    #[test]
    fn wien() {
        // b = 2.897771955e6 nm·K; the peak of a table of 1 nm lies within half a node.
        for kelvin in [3000.0, 4000.0, 5772.0, 9000.0] {
            let body = blackbody(kelvin);
            let peak = body.nodes().iter().position(|v| *v == body.max_value()).expect("a peak");
            assert!((300.0 + peak as f64 - 2.897_771_955e6 / kelvin).abs() <= 0.51, "{kelvin} K");
        }
        assert_eq!(blackbody(0.0).max_value(), 0.0);
        assert_eq!(blackbody(2.0).max_value(), 0.0, "no light of 300 to 1 100 nm, and no NaN");
    }

    #[test]
    fn the_sun_is_nearly_a_black_body() {
        let sun = solar();
        // Effective temperature 5 772 K, 6.794e-5 sr from the Earth (IAU 2015). Its lines and the infrared of its deeper layers change the result by
        // a few per cent.
        let disc = blackbody(5772.0).scaled(6.794e-5).integral(300.0, 1100.0);
        let above = sun.extraterrestrial.integral(300.0, 1100.0);
        assert!((above / disc - 1.0).abs() < 0.04, "{above} W/m² against {disc}");
        let ground = sun.global_tilt.integral(300.0, 1100.0);
        assert!(sun.direct.integral(300.0, 1100.0) < ground && ground < above);
    }
}
