//! Transmittance of coated lens surfaces, and of an interference filter in front of the sensor, for unpolarised light.
//!
//! **Coatings**, without absorption:
//!
//! - [`Coating::Uncoated`]: Fresnel (1823), the mean of both polarisations.
//! - [`Coating::Constant`]: the same transmittance at all angles and wavelengths, also between equal media.
//! - [`Coating::QuarterWave`]: one layer of magnesium fluoride (n = 1.38, its dispersion left out), a quarter of the design wavelength thick at
//!   normal incidence: R = |r₁ + r₂ e^{2iδ}|²/|1 + r₁ r₂ e^{2iδ}|², δ = (π/2)(λ₀/λ) cos θ in the layer (Airy 1833). Between equal media there is no
//!   layer and no reflection. Between two denser glasses, beyond the critical angle of the layer, cos θ is imaginary: light passes the layer as an
//!   evanescent wave (frustrated total reflection).
//!
//! **[`InterferenceFilter`]**: an IR-cut filter whose edge shifts to shorter wavelengths with the angle of incidence.
//!
//! In the filter's layers light propagates at θ′ with sin θ′ = sin θ/n_eff, and the phase between layers is proportional to cos θ′/λ. At the angle θ
//! the filter therefore acts on λ as it does at normal incidence on λ/√(1 − sin²θ/n_eff²), so an edge at λ₀ shifts to λ₀ √(1 − sin²θ/n_eff²) (Macleod
//! 1986). n_eff is 1.5 to 2.2 for usual stacks. Left out: the effect of polarisation on the edge's form, and the plate's thickness (give it as two
//! plane surfaces of the prescription).

use core::f64::consts::PI;

use etendue_core::maths::f64::{cos, exp};
use etendue_spectra::Spectrum;

use crate::{error::OpticsError, overlap::finite};

/// Index of magnesium fluoride.
const LAYER: f64 = 1.38;

/// A surface's coating.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Coating {
    /// Bare glass.
    Uncoated,
    /// A transmittance, (0, 1].
    Constant(f64),
    /// A quarter-wave layer of MgF₂.
    QuarterWave {
        /// The design wavelength λ₀, nm.
        design_nm: f64,
    },
}

/// A refraction: indices and cosines (positive) on both sides.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Crossing {
    pub(crate) n: [f64; 2],
    pub(crate) cosine: [f64; 2],
}

impl Coating {
    /// Transmittance at a wavelength.
    #[inline]
    pub(crate) fn transmittance(&self, crossing: &Crossing, nm: f64) -> f64 {
        match *self {
            Self::Constant(value) => value,
            _ if crossing.n[0] == crossing.n[1] => 1.0,
            Self::Uncoated => 1.0 - crossing.reflectance(),
            Self::QuarterWave { design_nm } => 1.0 - crossing.layered_reflectance(design_nm / nm),
        }
    }
}

/// Amplitude reflection of both polarisations (s, p) between two media.
#[inline]
fn amplitudes(n: [f64; 2], cosine: [f64; 2]) -> [f64; 2] {
    let [s1, s2] = [n[0] * cosine[0], n[1] * cosine[1]];
    let [p1, p2] = [n[1] * cosine[0], n[0] * cosine[1]];
    [(s1 - s2) / (s1 + s2), (p1 - p2) / (p1 + p2)]
}

impl Crossing {
    /// The mean of both polarisations' |amplitude|², over one common denominator.
    #[inline]
    fn reflectance(&self) -> f64 {
        let ([n1, n2], [c1, c2]) = (self.n, self.cosine);
        let [s_less, s_more] = [n1 * c1 - n2 * c2, n1 * c1 + n2 * c2];
        let [p_less, p_more] = [n2 * c1 - n1 * c2, n2 * c1 + n1 * c2];
        let [a, b] = [s_less * p_more, p_less * s_more];
        let both = s_more * p_more;
        0.5 * (a * a + b * b) / (both * both)
    }

    /// Reflectance with a layer of a quarter wave at normal incidence, at λ₀/λ.
    fn layered_reflectance(&self, ratio: f64) -> f64 {
        let sine = self.n[0] / LAYER * (1.0 - self.cosine[0] * self.cosine[0]).max(0.0).sqrt();
        if sine >= 1.0 {
            return self.tunnelled_reflectance(ratio, (sine * sine - 1.0).sqrt());
        }
        let inside = (1.0 - sine * sine).sqrt();
        let turn = cos(PI * ratio * inside);
        let front = amplitudes([self.n[0], LAYER], [self.cosine[0], inside]);
        let back = amplitudes([LAYER, self.n[1]], [inside, self.cosine[1]]);
        let airy = |a: f64, b: f64| (a * a + b * b + 2.0 * a * b * turn) / (1.0 + a * a * b * b + 2.0 * a * b * turn);
        0.5 * (airy(front[0], back[0]) + airy(front[1], back[1]))
    }

    /// The same for a cosine i κ in the layer: each side shifts the phase by φ with tan(φ/2) = n_L κ/(n cos θ) (s) or n κ/(n_L cos θ) (p), and the
    /// wave decays by e^{−π κ λ₀/λ} over a round trip.
    fn tunnelled_reflectance(&self, ratio: f64, kappa: f64) -> f64 {
        let fades = exp(-PI * ratio * kappa);
        let polarised = |half: [f64; 2]| {
            let [cosine, sine] = [half.map(|t| (1.0 - t * t) / (1.0 + t * t)), half.map(|t| 2.0 * t / (1.0 + t * t))];
            let [both, across] = [cosine[0] * cosine[1], sine[0] * sine[1]];
            let apart = |turn: f64| 1.0 + fades * fades - 2.0 * fades * turn;
            if kappa > 0.0 { apart(both + across) / apart(both - across) } else { 1.0 }
        };
        let side = |i: usize| self.cosine[i] / kappa;
        let s = [0, 1].map(|i| LAYER / (self.n[i] * side(i)));
        let p = [0, 1].map(|i| self.n[i] / (LAYER * side(i)));
        0.5 * (polarised(s) + polarised(p))
    }
}

/// A filter given by its transmittance at normal incidence.
#[derive(Clone, Debug, PartialEq)]
pub struct InterferenceFilter {
    normal: Spectrum,
    effective_index: f64,
}

impl InterferenceFilter {
    /// Creates a filter from a transmittance at normal incidence and an effective index above 1.
    ///
    /// # Errors
    /// If the index is not above 1 or the transmittance leaves 0 to 1.
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

    /// Transmittance at a wavelength for light incident at an angle of this cosine (in air).
    #[must_use]
    pub fn transmittance(&self, nm: f64, cosine: f64) -> f64 {
        f64::from(self.normal.at((nm / self.shift(cosine)) as f32))
    }

    /// Wavelength of the edge at an angle of this cosine, relative to that at normal incidence.
    #[must_use]
    pub fn shift(&self, cosine: f64) -> f64 {
        let sine = (1.0 - cosine * cosine) / (self.effective_index * self.effective_index);
        (1.0 - sine).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use etendue_spectra::Extrapolation;

    use super::*;

    fn crossing(n1: f64, n2: f64, cosine: f64) -> Crossing {
        let sine = n1 / n2 * (1.0 - cosine * cosine).sqrt();
        Crossing { n: [n1, n2], cosine: [cosine, (1.0 - sine * sine).sqrt()] }
    }

    #[test]
    fn bare_glass_loses_four_per_cent_and_none_of_p_at_brewsters_angle() {
        let normal = Coating::Uncoated.transmittance(&crossing(1.0, 1.5, 1.0), 550.0);
        assert!((normal - 0.96).abs() < 1e-15);
        let brewster = crossing(1.0, 1.5, 1.0 / (1.0 + 1.5_f64 * 1.5).sqrt());
        let [s, p] = amplitudes(brewster.n, brewster.cosine);
        assert!(p.abs() < 1e-15 && (s * s - (1.25_f64 / 3.25) * (1.25 / 3.25)).abs() < 1e-14, "{s} {p}");
    }

    #[test]
    fn a_quarter_wave_has_its_closed_form() {
        let coated = |nm: f64, cosine: f64| {
            Coating::QuarterWave { design_nm: 550.0 }.transmittance(&crossing(1.0, 1.52, cosine), nm)
        };
        // ((n₁ n₂ − n²)/(n₁ n₂ + n²))² at the design wavelength: 1.3 %.
        let exact: f64 = (1.52 - LAYER * LAYER) / (1.52 + LAYER * LAYER);
        assert!((1.0 - coated(550.0, 1.0) - exact * exact).abs() < 1e-15);
        // At half the design wavelength the layer is half a wave thick and has no effect.
        assert!((coated(275.0, 1.0) - Coating::Uncoated.transmittance(&crossing(1.0, 1.52, 1.0), 275.0)).abs() < 1e-15);
        assert!(coated(400.0, 1.0) < coated(550.0, 1.0) && coated(550.0, 0.5) < coated(550.0, 1.0));
    }

    #[test]
    fn a_layer_between_denser_glasses_has_its_own_critical_angle() {
        let coating = Coating::QuarterWave { design_nm: 550.0 };
        let at = |sine: f64| coating.transmittance(&crossing(1.7, 1.72, (1.0 - sine * sine).sqrt()), 550.0);
        let critical = LAYER / 1.7;
        // Continuous there (both sides vary with the square root of the distance from it), decaying beyond.
        assert!(
            (at(critical - 1e-12) - at(critical + 1e-12)).abs() < 1e-4,
            "{} {}",
            at(critical - 1e-12),
            at(critical + 1e-12)
        );
        let [a, b, c] = [0.001, 0.05, 0.15].map(|beyond| at(critical + beyond));
        assert!(1.0 > a && a > b && b > c && c > 0.0, "{a} {b} {c}");
    }

    #[test]
    fn reflection_is_the_same_from_both_sides() {
        let there = crossing(1.0, 1.7, 0.6);
        let back = Crossing { n: [1.7, 1.0], cosine: [there.cosine[1], there.cosine[0]] };
        for coating in [Coating::Uncoated, Coating::QuarterWave { design_nm: 550.0 }] {
            let difference = coating.transmittance(&there, 600.0) - coating.transmittance(&back, 600.0);
            assert!(difference.abs() < 1e-14);
        }
        assert_eq!(Coating::Uncoated.transmittance(&crossing(1.5, 1.5, 0.3), 500.0), 1.0);
    }

    #[test]
    fn the_edge_moves_to_the_blue_with_the_angle() {
        let points = [(300.0, 1.0), (640.0, 1.0), (660.0, 0.0), (1100.0, 0.0)];
        let edge = Spectrum::from_points(&points, Extrapolation::Hold).expect("a table");
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
