//! From a cube of spectral irradiance to mean electrons.

use etendue_core::quantity::{Irradiance, MeanElectrons};
use etendue_core::{Bands, Plane, SpectralCube, StoredCube};
use rayon::prelude::*;

use crate::sensor::Sensor;

/// Rows of light read at a time.
const STRIP_ROWS: usize = 16;

impl Sensor {
    /// Mean electrons of every pixel: Σ over bands of (band mean of E) × (integral of R over the band).
    ///
    /// Exact if E or R is constant within each band. Light outside the cube's bands counts as zero. The sum is computed in f64 in order of
    /// wavelength, so the result does not depend on threads; it uses the rayon pool of its caller.
    #[must_use]
    pub fn electrons(&self, irradiance: &SpectralCube<Irradiance>) -> Plane<MeanElectrons> {
        let (width, height) = (irradiance.width(), irradiance.height());
        let mut plane = Plane::new(width, height);
        let weights = self.band_weights(irradiance.bands());
        if width > 0 {
            plane.samples_mut().par_chunks_mut(width).enumerate().for_each(|(y, row)| {
                self.electrons_of_row(irradiance, &weights, y, y, row);
            });
        }
        plane
    }

    /// The same for a stored cube, of which some rows at a time are read.
    ///
    /// # Errors
    /// If they cannot be read.
    pub fn electrons_of(&self, irradiance: &StoredCube<Irradiance>) -> Result<Plane<MeanElectrons>, String> {
        let (width, height) = (irradiance.width(), irradiance.height());
        let mut plane = Plane::new(width, height);
        let weights = self.band_weights(irradiance.bands());
        if width > 0 {
            let strips = plane.samples_mut().par_chunks_mut(width * STRIP_ROWS);
            strips.enumerate().try_for_each(|(strip, samples)| {
                let first = strip * STRIP_ROWS;
                let light = irradiance.rows(first..first + samples.len() / width)?;
                for (y, row) in samples.chunks_mut(width).enumerate() {
                    self.electrons_of_row(&light, &weights, first + y, y, row);
                }
                Ok::<(), String>(())
            })?;
        }
        Ok(plane)
    }

    /// Mean electrons of row `y` of the sensor, which is row `place` of the light.
    fn electrons_of_row(
        &self,
        light: &SpectralCube<Irradiance>,
        weights: &[Vec<f64>],
        y: usize,
        stored_row: usize,
        row: &mut [f32],
    ) {
        let width = row.len();
        for (x, electrons) in row.iter_mut().enumerate() {
            *electrons = weighted_sum(light, &weights[self.channel_at(x, y)], stored_row * width + x);
        }
    }

    /// ∫ R dλ over each band, for each channel.
    fn band_weights(&self, bands: Bands) -> Vec<Vec<f64>> {
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
            let expected = sensor.responsivity(channel).integral(400.0, 700.0) * f64::from(1e-3_f32);
            // Stored as f32.
            assert!((f64::from(electrons.at(x, y)) / expected - 1.0).abs() < 1e-6);
        }
    }
}
