//! An interference filter in front of the sensor: an IR-cut whose edge moves towards the blue with the angle.
//!
//! In the filter's layers light runs at θ′ with sin θ′ = sin θ/n_eff, and the phase between its layers goes with cos θ′/λ: at
//! the angle θ the filter does to λ what it does at normal incidence to λ/√(1 − sin²θ/n_eff²), so an edge at λ₀ stands at
//! λ₀ √(1 − sin²θ/n_eff²) (Macleod 1986). n_eff is 1.5 to 2.2 for usual stacks. Left out: what polarisation does to the edge's
//! form, and the plate's thickness (give it as two plane surfaces of the prescription).

use crate::error::OpticsError;
use crate::range::finite;
use etendue_spectra::Spectrum;

/// A filter known by its transmittance at normal incidence.
#[derive(Clone, Debug, PartialEq)]
pub struct InterferenceFilter {
    normal: Spectrum,
    effective_index: f64,
}

impl InterferenceFilter {
    /// A filter of a transmittance at normal incidence and an effective index above 1.
    ///
    /// # Errors
    /// Where the index is not above 1 or the transmittance leaves 0 to 1.
    pub fn new(normal: Spectrum, effective_index: f64) -> Result<Self, OpticsError> {
        if finite("effective_index", effective_index)? <= 1.0 {
            return Err(OpticsError::FilterIndex { value: effective_index });
        }
        let range = [normal.min_value(), normal.max_value()];
        match range.into_iter().find(|v| !(0.0..=1.0).contains(v)) {
            Some(value) => Err(OpticsError::FilterTransmittance { value: f64::from(value) }),
            None => Ok(Self { normal, effective_index }),
        }
    }

    /// Transmittance at a wavelength for light that arrives at an angle of this cosine (in air).
    #[must_use]
    pub fn transmittance(&self, nm: f64, cosine: f64) -> f64 {
        f64::from(self.normal.at((nm / self.shift(cosine)) as f32))
    }

    /// Where the edge stands at an angle of this cosine, over where it stands at normal incidence.
    #[must_use]
    pub fn shift(&self, cosine: f64) -> f64 {
        let sine = (1.0 - cosine * cosine) / (self.effective_index * self.effective_index);
        (1.0 - sine).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use etendue_spectra::Outside;

    #[test]
    fn the_edge_moves_to_the_blue_with_the_angle() {
        let points = [(300.0, 1.0), (640.0, 1.0), (660.0, 0.0), (1100.0, 0.0)];
        let edge = Spectrum::from_points(&points, Outside::Hold).expect("a table");
        let filter = InterferenceFilter::new(edge, 1.8).expect("a filter");
        // Half transmittance at 650 nm; at 30° at 650 √(1 − 0.25/3.24) = 624.4 nm.
        assert!((filter.transmittance(650.0, 1.0) - 0.5).abs() < 1e-6);
        let cosine = 0.75_f64.sqrt();
        let at = 650.0 * (1.0 - 0.25 / 3.24_f64).sqrt();
        assert!((at - 624.4).abs() < 0.1 && (filter.transmittance(at, cosine) - 0.5).abs() < 1e-4);
        assert!(InterferenceFilter::new(Spectrum::constant(0.5), 1.0).is_err());
        assert!(InterferenceFilter::new(Spectrum::constant(1.5), 1.8).is_err());
    }
}
