//! Exponential laws of size, and what follows from them.
//!
//! N(d) = N₀ exp(−Λ d): d is a drop's diameter, or the diameter that a flake has when molten. A flake itself is larger, by its density.

use core::f64::consts::PI;
use etendue_core::maths::f64::{cbrt, exp};

use super::rain::{self, axis_ratio, marshall_palmer, terminal_speed_mps};
use super::snow::{self, Crystals, sekhon_srivastava};

/// Why a law is refused.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum SizeLawError {
    /// A rate beyond the measurements that a law was fitted to.
    #[error("a rate of {rate_mm_h} mm/h was given, but the law of sizes holds from {low} to {high} mm/h; correct it")]
    Rate {
        /// What was given, mm/h of water.
        rate_mm_h: f64,
        /// The least rate, mm/h.
        low: f64,
        /// The greatest rate, mm/h.
        high: f64,
    },
}

/// What falls.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Hydrometeor {
    Drop,
    Flake(Crystals),
}

/// How many particles of each size are in the air.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SizeLaw {
    /// N₀, 1/(m³ mm).
    pub(super) n0: f64,
    /// Λ, 1/mm.
    pub(super) lambda: f64,
    pub(super) what: Hydrometeor,
    /// The rate that was asked for, mm/h.
    pub(super) rate_mm_h: f64,
}

impl SizeLaw {
    /// Rain by Marshall and Palmer's law at a rate, mm/h. With the speeds of [`terminal_speed_mps`] it brings 5 to 18 % more water than that;
    /// [`SizeLaw::rescaled`] mends it.
    ///
    /// # Errors
    /// Where the rate is not within 0.1 to 150 mm/h.
    pub fn rain(rate_mm_h: f64) -> Result<Self, SizeLawError> {
        check_rate(rate_mm_h, rain::RATES_MM_H)?;
        let [n0, lambda] = marshall_palmer(rate_mm_h);
        Ok(Self { n0, lambda, what: Hydrometeor::Drop, rate_mm_h })
    }

    /// Snow by Sekhon and Srivastava's law at a rate, mm/h of water.
    ///
    /// # Errors
    /// Where the rate is not within 0.1 to 3 mm/h.
    pub fn snow(rate_mm_h: f64, crystals: Crystals) -> Result<Self, SizeLawError> {
        check_rate(rate_mm_h, snow::RATES_MM_H)?;
        let [n0, lambda] = sekhon_srivastava(rate_mm_h);
        Ok(Self { n0, lambda, what: Hydrometeor::Flake(crystals), rate_mm_h })
    }

    /// The same with N₀ rescaled, so that the particles with their speeds bring the rate that was asked for.
    #[must_use]
    pub fn rescaled(self) -> Self {
        Self { n0: self.n0 * self.rate_mm_h / self.carried_mm_h(), ..self }
    }

    /// The rate that was asked for, mm/h of water.
    #[must_use]
    pub fn rate_mm_h(&self) -> f64 {
        self.rate_mm_h
    }

    /// Whether it is snow.
    #[must_use]
    pub fn is_snow(&self) -> bool {
        matches!(self.what, Hydrometeor::Flake(_))
    }

    /// N₀, 1/(m³ mm).
    #[must_use]
    pub fn n0(&self) -> f64 {
        self.n0
    }

    /// Λ, 1/mm.
    #[must_use]
    pub fn lambda_per_mm(&self) -> f64 {
        self.lambda
    }

    /// The greatest size of the field, mm: drops break up beyond 6 mm; of flakes that of the water in them.
    #[must_use]
    pub fn greatest_mm(&self) -> f64 {
        if self.is_snow() { 8.0 } else { 6.0 }
    }

    /// Particles a cubic metre, of all sizes.
    #[must_use]
    pub fn number_per_m3(&self) -> f64 {
        self.n0 / self.lambda
    }

    /// What meteorologists measure over a narrow beam, 1/m: twice the cross-sections of spheres, half of it by diffraction.
    #[must_use]
    pub fn meteorological_extinction_per_m(&self) -> f64 {
        match self.what {
            Hydrometeor::Drop => PI * self.n0 / (self.lambda * self.lambda * self.lambda) * 1e-6,
            Hydrometeor::Flake(_) => {
                self.integral([0.0, self.greatest_mm()], |d| {
                    let across = self.diameter_mm(d);
                    0.5 * PI * across * across
                }) * 1e-6
            }
        }
    }

    /// The distance at which contrast falls to 2 % by [`SizeLaw::meteorological_extinction_per_m`], m.
    #[must_use]
    pub fn visibility_m(&self) -> f64 {
        -etendue_core::maths::f64::ln(0.02) / self.meteorological_extinction_per_m()
    }

    /// The water that the particles bring with their speeds, mm/h.
    #[must_use]
    pub fn carried_mm_h(&self) -> f64 {
        // mm³/m³ · m/s to mm/h.
        let volume = |d: f64| PI / 6.0 * d * d * d;
        3.6e-3 * self.integral([0.0, self.greatest_mm()], |d| volume(d) * self.speed_mps(d))
    }

    /// Diameter of the sphere of a particle's volume, mm, of the size `d` mm.
    #[must_use]
    pub fn diameter_mm(&self, d: f64) -> f64 {
        match self.what {
            Hydrometeor::Drop => d,
            Hydrometeor::Flake(crystals) => crystals.flake_mm(d),
        }
    }

    /// Speed of fall, m/s, of the size `d` mm.
    #[must_use]
    pub fn speed_mps(&self, d: f64) -> f64 {
        match self.what {
            Hydrometeor::Drop => terminal_speed_mps(d),
            Hydrometeor::Flake(crystals) => crystals.speed_mps(d),
        }
    }

    /// Height over width of the size `d` mm.
    #[must_use]
    pub fn axis_ratio(&self, d: f64) -> f64 {
        match self.what {
            Hydrometeor::Drop => axis_ratio(d),
            Hydrometeor::Flake(_) => 1.0,
        }
    }

    /// Cross-section as seen from the side, m², of the size `d` mm: that of a spheroid of the particle's volume.
    #[must_use]
    pub fn cross_section_m2(&self, d: f64) -> f64 {
        let across = self.diameter_mm(d) * 1e-3;
        0.25 * PI * across * across * cbrt(self.axis_ratio(d))
    }

    /// ∫ N(d) f(d) dd over a range of sizes, mm, by Simpson's rule.
    pub(super) fn integral(&self, [low, high]: [f64; 2], f: impl Fn(f64) -> f64) -> f64 {
        const STEPS: u32 = 400;
        let h = (high - low) / f64::from(STEPS);
        let value = |i: u32| {
            let d = low + h * f64::from(i);
            let weight = if i == 0 || i == STEPS { 1.0 } else { 2.0 + 2.0 * f64::from(i % 2) };
            weight * self.n0 * exp(-self.lambda * d) * f(d)
        };
        (0..=STEPS).map(value).sum::<f64>() * h / 3.0
    }
}

/// Checks a rate against a law's range, both mm/h.
fn check_rate(rate_mm_h: f64, [low, high]: [f64; 2]) -> Result<(), SizeLawError> {
    if rate_mm_h >= low && rate_mm_h <= high { Ok(()) } else { Err(SizeLawError::Rate { rate_mm_h, low, high }) }
}
