//! Water in the low parts of the ground.
//!
//! The ground's height is h · relief, h from a texture. Below the water level, water of the depth level − h · relief stands. A film over grains has
//! the roughness that the grains leave. Water deeper than the grains is flat except for the rings of falling drops. Between the two, the slopes of
//! both are mixed. Left out: the outline of the water as geometry, its absorption (a road's puddles are millimetres deep), flow.
//!
//! Rings of drops: 1 % of the drops' kinetic energy goes into waves of 0.2 rad/mm (Le Méhauté 1988; Bliven, Sobieski and Craeye, IEEE J. Oceanic Eng.
//! 24 (1999) 323), which friction damps at the rate 4 ν k² = 0.16 1/s. Rain of R mm/h brings R/3600 kg/(m² s). Drops of 6.5 m/s thus sustain waves of
//! the energy 3.6e-4 R J/m² = (ρ g + σ k²) ⟨ζ²⟩, of the mean square slope k² ⟨ζ²⟩ = 1.15e-3 R. Measured roughness increases more slowly in heavy
//! rain, and less in water shallower than the wavelength of the waves: this value is an upper bound.

use super::{error::MaterialError, parameter::Factor};

/// Mean square slope of water in rain, per mm/h.
const SLOPE2_PER_MM_H: f64 = 1.15e-3;

/// Water in low parts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Puddles {
    pub(super) height: Factor,
    relief_mm: f32,
    level_mm: f32,
    grain_mm: f32,
    film_alpha: f32,
    ripple_alpha: f32,
}

/// Heights of ground under water.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GroundRelief {
    /// Height of the highest place over the lowest, mm.
    pub relief_mm: f64,
    /// Level of the water over the lowest place, mm.
    pub level_mm: f64,
    /// Height of the grains, mm.
    pub grain_mm: f64,
}

impl Puddles {
    /// Water up to `level_mm` over the lowest place of ground whose heights are `height` (0 to 1) times `relief_mm`. Its grains are
    /// `grain_mm` high; a film on them has the roughness `film_alpha` (GGX α). It rains at `rain_mm_h`.
    ///
    /// # Errors
    /// If a length is not positive and finite (the level: not finite or negative), the roughness not in 0 to 1, or the rain not in 0 to
    /// 150.
    pub fn new(height: Factor, relief: GroundRelief, film_alpha: f64, rain_mm_h: f64) -> Result<Self, MaterialError> {
        let GroundRelief { relief_mm, level_mm, grain_mm } = relief;
        for (what, value) in [("relief", relief_mm), ("grain", grain_mm)] {
            if !(value > 0.0 && value.is_finite()) {
                return Err(MaterialError::WaterLength { what, value });
            }
        }
        if !(level_mm >= 0.0 && level_mm.is_finite()) {
            return Err(MaterialError::WaterLength { what: "water level", value: level_mm });
        }
        if !(0.0..=1.0).contains(&film_alpha) {
            return Err(MaterialError::Roughness { alpha: film_alpha });
        }
        if !(0.0..=150.0).contains(&rain_mm_h) {
            return Err(MaterialError::Rain { rain_mm_h });
        }
        let ripple_alpha = (SLOPE2_PER_MM_H * rain_mm_h).sqrt() as f32;
        let [relief_mm, level_mm, grain_mm, film_alpha] =
            [relief_mm, level_mm, grain_mm, film_alpha].map(|value| value as f32);
        Ok(Self { height, relief_mm, level_mm, grain_mm, film_alpha, ripple_alpha })
    }

    /// Roughness at the height `height`: that of a GGX distribution of the same mean square slope (α² = 2 σ²).
    pub(super) fn alpha(&self, height: f32) -> f32 {
        let depth = (self.level_mm - height * self.relief_mm) / self.grain_mm;
        let x = depth.clamp(0.0, 1.0);
        let water = x * x * (3.0 - 2.0 * x);
        let (film, ripple) = (self.film_alpha * (1.0 - water), self.ripple_alpha * water);
        (film * film + ripple * ripple).sqrt().min(1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ground(relief_mm: f64, level_mm: f64, grain_mm: f64) -> GroundRelief {
        GroundRelief { relief_mm, level_mm, grain_mm }
    }

    #[test]
    fn water_flattens_what_lies_below_it() {
        let puddles = Puddles::new(Factor::Number(0.0), ground(10.0, 4.0, 2.0), 0.3, 0.0).expect("legal");
        assert_eq!(puddles.alpha(0.9), 0.3, "dry of standing water");
        assert_eq!(puddles.alpha(0.4), 0.3, "at the water's edge");
        assert_eq!(puddles.alpha(0.1), 0.0, "3 mm deep");
        assert!(puddles.alpha(0.3) > 0.1 && puddles.alpha(0.3) < 0.2, "half a grain deep");
        let rained = Puddles::new(Factor::Number(0.0), ground(10.0, 4.0, 2.0), 0.3, 10.0).expect("legal");
        assert!((rained.alpha(0.0) - 0.0115_f32.sqrt()).abs() < 1e-6);
        assert_eq!(rained.alpha(1.0), 0.3);
        assert!(Puddles::new(Factor::Number(0.0), ground(0.0, 4.0, 2.0), 0.3, 0.0).is_err());
        assert!(Puddles::new(Factor::Number(0.0), ground(1.0, -1.0, 2.0), 0.3, 0.0).is_err());
        assert!(Puddles::new(Factor::Number(0.0), ground(1.0, 1.0, 2.0), 0.3, 151.0).is_err());
    }
}
