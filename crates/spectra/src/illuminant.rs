//! Illuminants and lamps by name, the Sun, and the black body.
//!
//! CIE illuminants and measured lamps are **relative** powers: scale them with
//! [`observer::with_luminance`](crate::observer::with_luminance). The Sun and the black body are absolute.

use crate::table::embedded;
use crate::{Outside, Spectrum};
use etendue_core::maths;
use std::sync::LazyLock;

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
    embedded::<2>(text, Outside::Zero).swap_remove(0)
}

/// The relative spectral power of an illuminant or lamp; zero outside its table. `None` for a name not in [`names`].
#[must_use]
pub fn named(name: &str) -> Option<&'static Spectrum> {
    NAMES.iter().position(|n| *n == name).map(|i| &TABLES[i])
}

/// The names that [`named`] knows: CIE illuminants (A, D50, D65, E, FL2, FL11, HP1, LED-B3, LED-B5, LED-RGB1, LED-V1)
/// and measured lamps (incandescent, led-white-yag, mercury, metal-halide, sodium-high-pressure, sodium-low-pressure).
#[must_use]
pub fn names() -> &'static [&'static str] {
    NAMES
}

/// CIE standard illuminant D65, relative power.
#[must_use]
pub fn d65() -> &'static Spectrum {
    named("D65").expect("D65 is in the list")
}

/// Solar spectral irradiance of ASTM G-173, W·m⁻²·nm⁻¹.
#[derive(Clone, Debug, PartialEq)]
pub struct SolarIrradiance {
    /// Above the atmosphere.
    pub extraterrestrial: Spectrum,
    /// At the ground through 1.5 air masses, on a plane tilted 37° to the Sun, sky and ground included.
    pub global_tilt: Spectrum,
    /// At the ground through 1.5 air masses, from the Sun's disc and the 2.5° about it, on a plane facing it.
    pub direct: Spectrum,
}

/// Solar spectral irradiance of ASTM G-173, W·m⁻²·nm⁻¹.
#[must_use]
pub fn solar() -> &'static SolarIrradiance {
    static SOLAR: LazyLock<SolarIrradiance> = LazyLock::new(|| {
        let table = embedded::<4>(include_str!("../data/astm_g173_solar.csv"), Outside::Zero);
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

/// Spectral radiance of a black body, W·m⁻²·sr⁻¹·nm⁻¹, by Planck's law (constants of the SI of 2019); in vacuum.
/// At 0 K (and below, which has no meaning) it is zero.
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
