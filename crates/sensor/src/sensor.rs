//! The sensor: its parameters, checked, and its responsivity.
//!
//! Electrons of a pixel = ∫ E(λ) R(λ) dλ, with R(λ) = A f t η(λ) λ/(hc) in e⁻ per W·m⁻²: area of the pixel, fill factor,
//! exposure time, quantum efficiency with the colour filter in it, photons a joule (EMVA 1288, equation 2).

use crate::cfa::Cfa;
use crate::effects::{self, Need};
use crate::photon::photons_per_joule;
use etendue_spectra::Spectrum;

/// One kind of pixel.
#[derive(Clone, Debug, PartialEq)]
pub struct Channel {
    /// Its name in results, such as `r` or `mono`.
    pub name: String,
    /// Electrons a photon, 0 to 1, with the colour filter in it.
    pub quantum_efficiency: Spectrum,
}

/// Geometry of a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pixel {
    /// Distance between the centres of neighbours, µm; pixels are square.
    pub pitch_um: f64,
    /// Share of the pixel's square that collects light, (0, 1].
    pub fill_factor: f64,
}

/// What a sensor is, as the description says it.
#[derive(Clone, Debug, PartialEq)]
pub struct SensorParameters {
    /// Geometry of a pixel.
    pub pixel: Pixel,
    /// The kinds of pixels.
    pub channels: Vec<Channel>,
    /// Which pixel is of which kind.
    pub cfa: Cfa,
    /// Time of collection, s; zero is legal.
    pub exposure_s: f64,
    /// Mean dark current, e⁻·s⁻¹ a pixel.
    pub dark_current_e_s: f64,
    /// Electrons a pixel can hold.
    pub full_well_e: f64,
    /// Standard deviation of the read noise, e⁻.
    pub read_noise_e: f64,
    /// Digital numbers an electron (EMVA's K).
    pub gain_dn_e: f64,
    /// Digital number of no charge, DN.
    pub black_level_dn: f64,
    /// Bits of the converter, 1 to 16.
    pub bits: u32,
    /// Whether randomness is modelled. Without, a picture is the quantised mean.
    pub noise: bool,
}

/// Why a sensor cannot be.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SensorError {
    /// A number outside its range.
    #[error("{key} is {value}, but {expected} is needed")]
    Range {
        /// The parameter.
        key: &'static str,
        /// Its value.
        value: f64,
        /// What would be legal.
        expected: &'static str,
    },
    /// A quantum efficiency outside 0 to 1.
    #[error(
        "the quantum efficiency of channel {channel} runs from {low} to {high}, but must stay within 0 to 1: give it in electrons a photon"
    )]
    Efficiency {
        /// The channel's name.
        channel: String,
        /// Its smallest value.
        low: f32,
        /// Its largest value.
        high: f32,
    },
    /// The tile names a channel that does not exist.
    #[error("the colour filter tile names channel {channel}, but there are only {channels}, counted from 0")]
    NoSuchChannel {
        /// The channel's number.
        channel: usize,
        /// How many there are.
        channels: usize,
    },
    /// A channel that no pixel has.
    #[error("channel {0} has no pixel in the colour filter tile: remove it or place it")]
    UnusedChannel(String),
}

/// A sensor that can be.
#[derive(Clone, Debug, PartialEq)]
pub struct Sensor {
    parameters: SensorParameters,
    responsivities: Vec<Spectrum>,
}

impl Sensor {
    /// Checks the parameters and works out the responsivities.
    ///
    /// # Errors
    /// All contradictions found, in the order of the parameters.
    pub fn new(parameters: SensorParameters) -> Result<Self, Vec<SensorError>> {
        let errors = [range_errors(&parameters), channel_errors(&parameters)].concat();
        if !errors.is_empty() {
            return Err(errors);
        }
        let responsivities = parameters.channels.iter().map(|c| responsivity(&parameters, c)).collect();
        Ok(Self { parameters, responsivities })
    }

    /// The parameters.
    #[must_use]
    pub fn parameters(&self) -> &SensorParameters {
        &self.parameters
    }

    /// Responsivity of a channel, e⁻ per W·m⁻² during the exposure. Panics where there is no such channel.
    #[must_use]
    pub fn responsivity(&self, channel: usize) -> &Spectrum {
        &self.responsivities[channel]
    }

    /// Responsivities of all channels, in their order.
    #[must_use]
    pub fn responsivities(&self) -> &[Spectrum] {
        &self.responsivities
    }

    /// The channel of the pixel in column `x`, row `y`.
    #[must_use]
    pub fn channel_at(&self, x: usize, y: usize) -> usize {
        self.parameters.cfa.channel_at(x, y)
    }

    /// The narrowest range of wavelengths (nm) outside which no channel responds; `None` where none responds at all.
    #[must_use]
    pub fn support_nm(&self) -> Option<(f64, f64)> {
        let supports = self.parameters.channels.iter().filter_map(|c| c.quantum_efficiency.support_nm());
        supports.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))
    }

    /// The largest digital number of the converter.
    #[must_use]
    pub fn largest_dn(&self) -> u32 {
        (1_u32 << self.parameters.bits) - 1
    }

    /// The digital number of a saturated pixel: of a full well, or the converter's largest where that comes first.
    #[must_use]
    pub fn white_level_dn(&self) -> f64 {
        let p = &self.parameters;
        (p.black_level_dn + p.gain_dn_e * p.full_well_e).min(f64::from(self.largest_dn()))
    }

    /// What is modelled and what is not, with reasons, in physical order.
    #[must_use]
    pub fn needs(&self) -> Vec<Need> {
        effects::needs(&self.parameters)
    }
}

/// R(λ) of a channel, e⁻ per W·m⁻².
fn responsivity(p: &SensorParameters, channel: &Channel) -> Spectrum {
    let area_m2 = p.pixel.pitch_um * p.pixel.pitch_um * 1e-12 * p.pixel.fill_factor;
    Spectrum::from_fn(|nm| {
        area_m2 * p.exposure_s * f64::from(channel.quantum_efficiency.at(nm as f32)) * photons_per_joule(nm)
    })
}

fn range_errors(p: &SensorParameters) -> Vec<SensorError> {
    const POSITIVE: &str = "a finite number above 0";
    const NOT_NEGATIVE: &str = "a finite number of at least 0";
    let positive = |v: f64| v.is_finite() && v > 0.0;
    let not_negative = |v: f64| v.is_finite() && v >= 0.0;
    let largest_dn = if p.bits <= 16 { f64::from((1_u32 << p.bits) - 1) } else { f64::INFINITY };
    let checks = [
        ("pixel_pitch_um", p.pixel.pitch_um, positive(p.pixel.pitch_um), POSITIVE),
        (
            "fill_factor",
            p.pixel.fill_factor,
            p.pixel.fill_factor > 0.0 && p.pixel.fill_factor <= 1.0,
            "a share above 0 and up to 1",
        ),
        ("exposure_s", p.exposure_s, not_negative(p.exposure_s), NOT_NEGATIVE),
        ("dark_current_e_s", p.dark_current_e_s, not_negative(p.dark_current_e_s), NOT_NEGATIVE),
        ("full_well_e", p.full_well_e, positive(p.full_well_e), POSITIVE),
        ("read_noise_e", p.read_noise_e, not_negative(p.read_noise_e), NOT_NEGATIVE),
        ("gain_dn_per_e", p.gain_dn_e, positive(p.gain_dn_e), POSITIVE),
        (
            "black_level_dn",
            p.black_level_dn,
            p.black_level_dn >= 0.0 && p.black_level_dn < largest_dn,
            "a number from 0 to below the converter's largest",
        ),
        ("bits", f64::from(p.bits), (1..=16).contains(&p.bits), "a whole number from 1 to 16"),
    ];
    let wrong = checks.into_iter().filter(|(_, _, legal, _)| !legal);
    wrong.map(|(key, value, _, expected)| SensorError::Range { key, value, expected }).collect()
}

fn channel_errors(p: &SensorParameters) -> Vec<SensorError> {
    let mut errors = Vec::new();
    for (i, channel) in p.channels.iter().enumerate() {
        let (low, high) = (channel.quantum_efficiency.min_value(), channel.quantum_efficiency.max_value());
        if !(low >= 0.0 && high <= 1.0) {
            errors.push(SensorError::Efficiency { channel: channel.name.clone(), low, high });
        }
        if !p.cfa.channels().contains(&i) {
            errors.push(SensorError::UnusedChannel(channel.name.clone()));
        }
    }
    let largest = p.cfa.channels().iter().copied().max().unwrap_or(0);
    if largest >= p.channels.len() {
        errors.push(SensorError::NoSuchChannel { channel: largest, channels: p.channels.len() });
    }
    errors
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use core::f64::consts::PI;

    /// A mono sensor of quantum efficiency 1 with 5 e⁻ read noise and 0.25 DN/e⁻.
    pub(crate) fn ideal() -> SensorParameters {
        SensorParameters {
            pixel: Pixel { pitch_um: 3.0, fill_factor: 1.0 },
            channels: vec![Channel { name: "mono".into(), quantum_efficiency: Spectrum::constant(1.0) }],
            cfa: Cfa::mono(),
            exposure_s: 0.01,
            dark_current_e_s: 0.0,
            full_well_e: 60_000.0,
            read_noise_e: 5.0,
            gain_dn_e: 0.25,
            black_level_dn: 100.0,
            bits: 16,
            noise: true,
        }
    }

    #[test]
    fn photons_of_the_standard() {
        let mut p = ideal();
        p.pixel.pitch_um = 1.0;
        p.exposure_s = 1e-3;
        let sensor = Sensor::new(p).expect("legal");
        // Spectra are f32: 24 bits.
        let photons = f64::from(sensor.responsivity(0).at(1000.0)) * 1e-2;
        assert!((photons / 50.341_165_675_4 - 1.0).abs() < 1.2e-7, "{photons}");
    }

    #[test]
    fn a_hundred_candelas_through_f_2() {
        let sensor = Sensor::new(ideal()).expect("legal");
        let irradiance_w_m2 = PI * (100.0 / 683.0) / (1.0 + 4.0 * 2.0 * 2.0);
        let photons = f64::from(sensor.responsivity(0).at(555.0)) * irradiance_w_m2;
        assert!((photons - 6803.6).abs() < 0.05, "{photons}");
    }

    #[test]
    fn every_contradiction_is_told() {
        let mut p = ideal();
        p.exposure_s = -1.0;
        p.read_noise_e = f64::NAN;
        p.bits = 17;
        p.channels[0].quantum_efficiency = Spectrum::constant(1.5);
        p.channels.push(Channel { name: "r".into(), quantum_efficiency: Spectrum::constant(0.5) });
        let errors = Sensor::new(p).expect_err("five faults");
        assert_eq!(errors.len(), 5, "{errors:?}");
        assert_eq!(errors[0].to_string(), "exposure_s is -1, but a finite number of at least 0 is needed");
        let mut p = ideal();
        p.cfa = Cfa::tile(2, 1, vec![0, 3]).expect("a rectangle");
        assert_eq!(Sensor::new(p).expect_err("no channel 3").len(), 1);
    }

    #[test]
    fn white_is_the_well_or_the_converter() {
        let mut p = ideal();
        assert_eq!(Sensor::new(p.clone()).expect("legal").white_level_dn(), 15_100.0);
        p.bits = 12;
        assert_eq!(Sensor::new(p).expect("legal").white_level_dn(), 4095.0);
    }
}
