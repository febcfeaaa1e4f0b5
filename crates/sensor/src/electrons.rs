//! From a cube of spectral irradiance to mean electrons.

use crate::sensor::Sensor;
use etendue_core::quantity::{Irradiance, MeanElectrons};
use etendue_core::{Plane, SpectralCube};
use rayon::prelude::*;

impl Sensor {
    /// Mean electrons of every pixel: Σ over bands of (band mean of E) × (integral of R over the band).
    ///
    /// Exact where E or R is constant within each band. Light outside the cube's bands is not there. The sum runs in f64
    /// in order of wavelength, so the result does not depend on threads; it uses the rayon pool of its caller.
    #[must_use]
    pub fn electrons(&self, irradiance: &SpectralCube<Irradiance>) -> Plane<MeanElectrons> {
        let (width, height) = (irradiance.width(), irradiance.height());
        let mut plane = Plane::new(width, height);
        let weights = self.band_weights(irradiance);
        if width > 0 {
            plane.samples_mut().par_chunks_mut(width).enumerate().for_each(|(y, row)| {
                for (x, electrons) in row.iter_mut().enumerate() {
                    *electrons = weighted_sum(irradiance, &weights[self.channel_at(x, y)], y * width + x);
                }
            });
        }
        plane
    }

    /// ∫ R dλ over each band, for each channel.
    fn band_weights(&self, irradiance: &SpectralCube<Irradiance>) -> Vec<Vec<f64>> {
        let bands = irradiance.bands();
        let weights = |r: &etendue_spectra::Spectrum| {
            r.band_means(bands).into_iter().map(|mean| mean * bands.width_nm()).collect()
        };
        self.responsivities().iter().map(weights).collect()
    }
}

fn weighted_sum(irradiance: &SpectralCube<Irradiance>, weights: &[f64], i: usize) -> f32 {
    let terms = irradiance.planes().iter().zip(weights).map(|(plane, w)| f64::from(plane.samples()[i]) * w);
    terms.sum::<f64>() as f32
}

#[cfg(test)]
mod tests {
    use crate::Channel;
    use crate::cfa::{BayerPhase, Cfa};
    use crate::parameters::tests::ideal;
    use crate::sensor::Sensor;
    use etendue_core::{Bands, SpectralCube};
    use etendue_spectra::Spectrum;

    #[test]
    fn an_equal_energy_cube_gives_the_integral_of_the_responsivity_of_each_channel() {
        let mut p = ideal();
        p.cfa = Cfa::bayer(BayerPhase::Grbg);
        let channel = |name: &str, qe| Channel { name: name.into(), quantum_efficiency: Spectrum::constant(qe) };
        p.channels = vec![channel("r", 0.4), channel("g", 0.6), channel("b", 0.3)];
        let sensor = Sensor::new(p).expect("legal");
        let mut cube = SpectralCube::new(3, 2, Bands::covering(400.0, 700.0, 5.0).expect("bands"));
        for plane in cube.planes_mut() {
            plane.samples_mut().fill(1e-3);
        }
        let electrons = sensor.electrons(&cube);
        for (x, y, channel) in [(0, 0, 1), (1, 0, 0), (2, 0, 1), (0, 1, 2), (1, 1, 1)] {
            let want = sensor.responsivity(channel).integral(400.0, 700.0) * f64::from(1e-3_f32);
            // Stored as f32.
            assert!((f64::from(electrons.at(x, y)) / want - 1.0).abs() < 1e-6);
        }
    }
}
