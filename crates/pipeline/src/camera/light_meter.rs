//! Response of a camera to uniform light at the centre of its image: for exposures that are chosen before a render.
//!
//! μ = Ω ∫ L(λ) R(λ) dλ: the lens's étendue over the pixel (sr, at 587.56 nm), radiance, responsivity of the channel in its exposure. Not included: elements
//! before the lens, filters with a shifting edge, every effect of the sensor except its quantum efficiency.

use crate::plan::CameraBody;
use etendue_sensor::Sensor;
use etendue_sensor::effects::response::Response;
use etendue_spectra::Spectrum;
use glam::DVec2;

/// A camera's light meter.
#[derive(Clone, Debug)]
pub struct LightMeter<'a> {
    sensor: &'a Sensor,
    projected_solid_angle_sr: f64,
}

impl<'a> LightMeter<'a> {
    /// Light meter of a camera; `None` without electronics.
    #[must_use]
    pub fn new(body: &'a CameraBody) -> Option<Self> {
        let size = DVec2::new(body.raster.width() as f64, body.raster.height() as f64);
        let projected_solid_angle_sr = body.lens.projected_solid_angle_sr(body.raster.sensor_mm(size / 2.0));
        body.sensor.as_ref().map(|sensor| Self { sensor, projected_solid_angle_sr })
    }

    /// Mean electrons of each channel for a uniform radiance, W·m⁻²·sr⁻¹·nm⁻¹, in the described exposure.
    #[must_use]
    pub fn electrons(&self, radiance: &Spectrum) -> Vec<(String, f64)> {
        let channels = self.sensor.parameters().channels.iter().zip(self.sensor.responsivities());
        let of = |responsivity: &Spectrum| {
            self.projected_solid_angle_sr * radiance.product(responsivity).integral(300.0, 1100.0)
        };
        channels.map(|(channel, responsivity)| (channel.name.clone(), of(responsivity))).collect()
    }

    /// Electrons at which the pixel saturates, or its ADC if it does so first (for a linear response).
    #[must_use]
    pub fn saturation_e(&self) -> f64 {
        let p = self.sensor.parameters();
        let read_out = &p.read_out;
        let largest_dn = f64::from((1_u32 << read_out.bits) - 1);
        let gain_dn_e = read_out.gain_dn_e * read_out.analogue_gain * read_out.digital_gain.max(1.0);
        match read_out.response {
            Response::Linear => p.charge.full_well.capacity_e.min((largest_dn - read_out.black_level_dn) / gain_dn_e),
            Response::Knees(_) | Response::Logarithmic { .. } => p.charge.full_well.capacity_e,
        }
    }
}
