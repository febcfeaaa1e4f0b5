//! The sensor: its checked parameters, and its responsivity.
//!
//! Electrons of a pixel = ∫ E(λ) R(λ) dλ, with R(λ) = A f t η(λ) λ/(hc) in e⁻ per W·m⁻²: area of the pixel, fill factor, exposure time, quantum
//! efficiency including the colour filter, photons per joule (EMVA 1288, equation 2).

use std::borrow::Cow;

use etendue_spectra::Spectrum;

use crate::effect::{SensorEffect, SignalLevels};
use crate::parameters::{Channel, SensorParameters};
use crate::{capture::OperatingPoint, check::SensorError, photon::photons_per_joule, validity};

/// A sensor with valid parameters.
#[derive(Clone, Debug, PartialEq)]
pub struct Sensor {
    parameters: SensorParameters,
    responsivities: Vec<Spectrum>,
}

impl Sensor {
    /// Checks the parameters and computes the responsivities.
    ///
    /// # Errors
    /// All contradictions found, in the order of the parameters.
    pub fn new(parameters: SensorParameters) -> Result<Self, Vec<SensorError>> {
        let errors = validity::errors(&parameters);
        if !errors.is_empty() {
            return Err(errors);
        }
        let responsivities = responsivities(&parameters, parameters.exposure.exposure_s);
        Ok(Self { parameters, responsivities })
    }

    #[must_use]
    pub fn parameters(&self) -> &SensorParameters {
        &self.parameters
    }

    /// Responsivity of a channel, e⁻ per W·m⁻² during the exposure. Panics if there is no such channel.
    #[must_use]
    pub fn responsivity(&self, channel: usize) -> &Spectrum {
        &self.responsivities[channel]
    }

    /// Responsivities of all channels, in their order.
    #[must_use]
    pub fn responsivities(&self) -> &[Spectrum] {
        &self.responsivities
    }

    /// Electrons per second: responsivities of all channels for one second of light, e⁻·s⁻¹ per W·m⁻². They do not depend on the exposure.
    #[must_use]
    pub fn rate_responsivities(&self) -> Vec<Spectrum> {
        responsivities(&self.parameters, 1.0)
    }

    /// Responsivities of all channels for uses that accept any common scale, such as white balance: those of a second if the exposure is zero.
    #[must_use]
    pub(crate) fn colour_responsivities(&self) -> Cow<'_, [Spectrum]> {
        if self.parameters.exposure.exposure_s > 0.0 {
            return Cow::Borrowed(&self.responsivities);
        }
        Cow::Owned(self.rate_responsivities())
    }

    /// True if light of a pixel changes the numbers of others: by blooming, smear or crosstalk.
    #[must_use]
    pub fn has_spatial_coupling(&self) -> bool {
        let p = &self.parameters;
        p.charge.full_well.blooming.is_some() || p.light.smear.is_some() || p.light.crosstalk.is_some()
    }

    /// The channel of the pixel in column `x`, row `y`.
    #[must_use]
    pub fn channel_at(&self, x: usize, y: usize) -> usize {
        self.parameters.cfa.channel_at(x, y)
    }

    /// The narrowest range of wavelengths (nm) outside which no channel responds; `None` if none responds at all.
    #[must_use]
    pub fn support_nm(&self) -> Option<(f64, f64)> {
        let supports = self.parameters.channels.iter().filter_map(|c| c.quantum_efficiency.support_nm());
        supports.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))
    }

    /// Errors for an image of `width` × `height` pixels: tile, binning, skipping and region must fit it.
    #[must_use]
    pub fn image_size_errors(&self, width: usize, height: usize) -> Vec<SensorError> {
        self.parameters.read_out.layout.errors(&self.parameters.cfa, width, height)
    }

    /// Columns and rows of the delivered image of a sensor of `width` × `height` pixels: those of its region that are read, binned.
    #[must_use]
    pub fn image_size(&self, width: usize, height: usize) -> (usize, usize) {
        self.parameters.read_out.layout.image_size(width, height)
    }

    /// Maps a point of the sensor to the delivered image; raster coordinates of both, px.
    #[must_use]
    pub fn to_image(&self, raster_px: [f64; 2]) -> [f64; 2] {
        self.parameters.read_out.layout.image_point(&self.parameters.cfa, raster_px)
    }

    /// Bits of the delivered numbers: those of the ADC, or those after merging and companding.
    #[must_use]
    pub fn delivered_bits(&self) -> u32 {
        let hdr = &self.parameters.hdr;
        hdr.companding.as_ref().map_or(hdr.bits.unwrap_or(self.parameters.read_out.bits), |c| c.bits)
    }

    /// The delivered digital number of zero charge.
    #[must_use]
    pub fn black_level_dn(&self) -> f64 {
        self.delivered(self.parameters.read_out.black_level_dn)
    }

    /// The delivered digital number of a saturated pixel as described: of a full well, or the ADC's maximum if that is reached first.
    #[must_use]
    pub fn white_level_dn(&self) -> f64 {
        self.white_level_at(self.parameters.described_point())
    }

    /// The same at the smallest gain that exposure control can reach.
    #[must_use]
    pub fn min_white_level_dn(&self) -> f64 {
        self.white_level_at(self.parameters.min_operating_point())
    }

    /// The same at another exposure and gain.
    pub(crate) fn white_level_at(&self, point: OperatingPoint) -> f64 {
        let p = &self.parameters;
        let largest = f64::from((1_u32 << p.hdr.bits.unwrap_or(p.read_out.bits)) - 1);
        self.delivered(p.merged_white_dn(point).min(largest))
    }

    fn delivered(&self, linear_dn: f64) -> f64 {
        self.parameters.hdr.companding.as_ref().map_or(linear_dn, |c| c.companded(linear_dn))
    }

    /// True if a frame depends on the frames before it: by exposure control, lag, or pixels that jump between two levels.
    #[must_use]
    pub fn has_memory(&self) -> bool {
        let p = &self.parameters;
        let jumps = p.charge.dark.dark_current_rts.is_some() || p.voltage.rts_noise.is_some();
        p.exposure.control.is_some() || !p.charge.lag.traps.is_empty() || jumps
    }

    /// All effects of the first capture as described, in physical order.
    #[must_use]
    pub fn effects(&self) -> Vec<SensorEffect> {
        let range = self.dynamic_range();
        // For the smallest signal, ½ (1 + √(1 + 4 σ²)).
        let dark_variance_e2 = range.lower_e * (range.lower_e - 1.0);
        self.parameters.effects(SignalLevels { grey_e: GREY * range.upper_e, dark_variance_e2 })
    }
}

/// Reflectance of a grey card: its fraction of the largest signal in a well-exposed image.
const GREY: f64 = 0.18;

/// R(λ) of all channels for an exposure, e⁻ per W·m⁻².
fn responsivities(p: &SensorParameters, exposure_s: f64) -> Vec<Spectrum> {
    let area_m2 = p.pixel.pitch_um * p.pixel.pitch_um * 1e-12 * p.pixel.fill_factor;
    let of = |channel: &Channel| {
        Spectrum::from_fn(|nm| {
            let quantum_efficiency = f64::from(channel.quantum_efficiency.at(nm as f32));
            area_m2 * exposure_s * quantum_efficiency * photons_per_joule(nm)
        })
    };
    p.channels.iter().map(of).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parameters::tests::ideal;
    use core::f64::consts::PI;

    #[test]
    fn photons_of_the_standard() {
        let mut p = ideal();
        p.pixel.pitch_um = 1.0;
        p.exposure.exposure_s = 1e-3;
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
    fn colours_do_not_depend_on_the_exposure() {
        let mut p = ideal();
        p.exposure.exposure_s = 0.0;
        let dark = Sensor::new(p.clone()).expect("legal");
        p.exposure.exposure_s = 1.0;
        let illuminated = Sensor::new(p).expect("legal");
        assert_eq!(dark.responsivity(0).max_value(), 0.0);
        assert_eq!(dark.colour_responsivities(), illuminated.colour_responsivities());
    }

    #[test]
    fn white_is_the_well_or_the_converter() {
        let mut p = ideal();
        assert_eq!(Sensor::new(p.clone()).expect("legal").white_level_dn(), 15_100.0);
        p.read_out.bits = 12;
        assert_eq!(Sensor::new(p).expect("legal").white_level_dn(), 4095.0);
    }
}
