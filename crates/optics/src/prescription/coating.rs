//! What a surface lets through: unpolarised light, no absorption.
//!
//! - [`Coating::Uncoated`]: Fresnel (1823), the mean of both polarisations.
//! - [`Coating::Constant`]: a number, whatever angle and wavelength.
//! - [`Coating::QuarterWave`]: one layer of magnesium fluoride (n = 1.38, its dispersion left out), a quarter of the design
//!   wavelength thick at normal incidence: R = |r₁ + r₂ e^{2iδ}|²/|1 + r₁ r₂ e^{2iδ}|², δ = (π/2)(λ₀/λ) cos θ in the
//!   layer (Airy 1833). Where no layer could be there (both sides alike) the surface is open. Between
//!   two denser glasses, beyond the layer's own critical angle, cos θ is imaginary and light tunnels.

use core::f64::consts::PI;
use etendue_core::maths::f64::{cos, exp};

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

    /// With a layer of a quarter wave at normal incidence, at λ₀/λ.
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

    /// The same where the cosine in the layer is i κ: each side turns the phase by φ with tan(φ/2) = n_L κ/(n cos θ) (s) or
    /// n κ/(n_L cos θ) (p), and the wave fades by e^{−π κ λ₀/λ} there and back.
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

#[cfg(test)]
mod tests {
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
        // At half the design wavelength the layer is half a wave thick and does nothing.
        assert!((coated(275.0, 1.0) - Coating::Uncoated.transmittance(&crossing(1.0, 1.52, 1.0), 275.0)).abs() < 1e-15);
        assert!(coated(400.0, 1.0) < coated(550.0, 1.0) && coated(550.0, 0.5) < coated(550.0, 1.0));
    }

    #[test]
    fn a_layer_between_denser_glasses_has_its_own_critical_angle() {
        let coating = Coating::QuarterWave { design_nm: 550.0 };
        let at = |sine: f64| coating.transmittance(&crossing(1.7, 1.72, (1.0 - sine * sine).sqrt()), 550.0);
        let critical = LAYER / 1.7;
        // Continuous there (the square root of the distance from it is what both sides go with), fading beyond.
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
}
