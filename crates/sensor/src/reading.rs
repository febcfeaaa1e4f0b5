//! Response of one capture to the light of the first one: its white level and noise.

use crate::capture::{OperatingPoint, Operation};
use crate::parameters::SensorParameters;

/// One capture and its fraction of the first one's light.
pub(crate) struct CaptureReading<'a> {
    p: &'a SensorParameters,
    operation: Operation,
    /// Fraction of the light of the described exposure.
    pub(crate) light: f64,
    /// Mean dark electrons of all wells that are read together.
    dark_e: f64,
}

/// The captures of a frame that is taken at an operating point.
pub(crate) fn readings(p: &SensorParameters, point: OperatingPoint) -> Vec<CaptureReading<'_>> {
    let of = |operation: Operation| {
        let dark = &p.charge.dark;
        let dark_e = p.wells_read() * dark.current_e_s * dark.temperature_factor() * operation.exposure_s;
        CaptureReading { p, operation, light: operation.light, dark_e }
    };
    p.hdr.operations(p.operation(point)).into_iter().map(of).collect()
}

impl CaptureReading<'_> {
    /// The signal (e⁻ of the first capture) that brings this one to a fraction of its range.
    pub(crate) fn signal_e(&self, fraction: f64) -> f64 {
        let (response, converter) = (&self.p.read_out.response, self.p.converter(&self.operation));
        let white = self.p.capture_white_dn(&self.operation);
        let charge_e = response.charge_e(fraction * converter.electrons(white));
        (charge_e - self.dark_e).max(0.0) / self.light
    }

    /// Variance by rounding to digital numbers, e⁻².
    pub(crate) fn quantisation_e2(&self) -> f64 {
        let gain_dn_e = self.operation.gain_dn_e;
        1.0 / (12.0 * gain_dn_e * gain_dn_e)
    }

    /// Variance of everything but the signal's own shot noise at a charge, e⁻².
    pub(crate) fn dark_variance_e2(&self, charge_e: f64) -> f64 {
        let (read, operation) = (self.p.voltage.noise, &self.operation);
        let squares: f64 = [operation.read_noise_e, read.row_e, read.column_e].iter().map(|e| e * e).sum();
        let chain = if self.p.noise { squares } else { 0.0 };
        let slope = self.p.read_out.response.slope(charge_e);
        self.dark_e + (chain + self.quantisation_e2()) / (slope * slope)
    }

    /// Signal-to-noise ratio under a signal (e⁻ of the first capture).
    pub(crate) fn ratio(&self, signal_e: f64) -> f64 {
        let own_e = signal_e * self.light;
        own_e / (own_e + self.dark_variance_e2(own_e + self.dark_e)).sqrt()
    }
}
