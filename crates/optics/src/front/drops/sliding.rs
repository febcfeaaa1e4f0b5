//! How drops slide down tilted glass.
//!
//! A drop stays where it is until its weight along the glass overcomes the hysteresis of its contact angle (C. G. L. Furmidge, J. Colloid Sci. 17,
//! 1962), and slides at a speed that grows evenly with the Bond number beyond that (T. Podgorski, J.-M. Flesselles and L. Limat, Phys.
//! Rev. Lett. 87, 2001), for similar drops the square of the radius:
//!
//! v = v₁ (a² sin α − a₀²)/(a₁² − a₀²), never below 0,
//!
//! with the slope α of the glass, the radius a₀ below which a drop stays on upright glass, and the speed v₁ there of a drop of the greatest
//! radius a₁ that falls. Larger ones, which have joined, are faster. Left out: wind along the glass, trails, paths that wind.

use super::droplet::Droplet;
use crate::error::front::{FrontError, positive};
use glam::DVec2;

/// How drops slide.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sliding {
    /// Speed of a drop of the greatest radius that falls on upright glass, mm/s.
    pub speed_mm_s: f64,
    /// Radius below which a drop stays on upright glass, mm; below the greatest radius.
    pub still_radius_mm: f64,
}

impl Sliding {
    pub(super) fn check(&self, greatest_mm: f64) -> Result<(), FrontError> {
        positive("speed_mm_s", self.speed_mm_s)?;
        let (name, value) = ("still_radius_mm", self.still_radius_mm);
        let right = (0.0..greatest_mm).contains(&value);
        if right { Ok(()) } else { Err(FrontError::Number { name, value, range: "0 or more and below max_radius_mm" }) }
    }

    /// Velocity of a drop, mm/s, where `down` is gravity's direction along the glass, as long as the sine of its slope.
    pub(super) fn velocity_mm_s(&self, drop: Droplet, down: DVec2, greatest_mm: f64) -> DVec2 {
        let (sine, still) = (down.length(), self.still_radius_mm * self.still_radius_mm);
        let excess = drop.radius_mm * drop.radius_mm * sine - still;
        if !(excess > 0.0 && sine > 0.0) {
            return DVec2::ZERO;
        }
        down / sine * (self.speed_mm_s * excess / (greatest_mm * greatest_mm - still))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn speeds_are_those_of_the_law() {
        let law = Sliding { speed_mm_s: 50.0, still_radius_mm: 1.0 };
        let speed = |radius_mm, down| law.velocity_mm_s(Droplet { centre_mm: DVec2::ZERO, radius_mm }, down, 2.0);
        assert_eq!(speed(2.0, DVec2::Y), DVec2::new(0.0, 50.0));
        assert_eq!(speed(1.0, DVec2::Y), DVec2::ZERO);
        // On a slope of 30° a drop of 2 mm has 4 · 0.5 − 1 of 3 parts.
        assert!((speed(2.0, DVec2::Y * 0.5).y - 50.0 / 3.0).abs() < 1e-12);
        assert_eq!(speed(2.0, DVec2::ZERO), DVec2::ZERO);
        assert!((speed(3.0, DVec2::Y).y - 50.0 * 8.0 / 3.0).abs() < 1e-12);
    }
}
