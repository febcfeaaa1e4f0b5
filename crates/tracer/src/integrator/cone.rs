//! How wide a path has become: the footprint of texture look-ups.
//!
//! A cone about the path (Amanatides 1984): its width grows by spread × distance. Scattering with density p widens the
//! spread to at least a quarter of √(1/(π p)), the half angle of a small cone of solid angle 1/p, taken as 1 rad where it
//! is more. A matt surface (p ≤ 1/π) thus widens it to 0.25 rad always, a mirror not at all. The quarter is a choice:
//! it leaves texture to be seen in what matt surfaces throw on each other. Curvature of mirrors is left out.

use core::f32::consts::FRAC_1_PI;

/// Share of the scattered cone that later look-ups average over.
const SHARE: f32 = 0.25;

/// Width and growth of a path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Cone {
    pub(super) width_m: f32,
    pub(super) spread_rad: f32,
}

impl Cone {
    pub(super) fn new(spread_rad: f32) -> Self {
        Self { width_m: 0.0, spread_rad }
    }

    pub(super) fn travel(&mut self, distance_m: f32) {
        self.width_m += self.spread_rad * distance_m;
    }

    /// After scattering into a direction of density `pdf`, 1/sr.
    pub(super) fn scatter(&mut self, pdf: f32) {
        self.spread_rad = self.spread_rad.max(SHARE * (FRAC_1_PI / pdf).sqrt().min(1.0));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn after(spread_rad: f32, pdf: f32) -> f32 {
        let mut cone = Cone::new(spread_rad);
        cone.scatter(pdf);
        cone.spread_rad
    }

    #[test]
    fn scattering_widens_as_stated() {
        for cos in [1.0, 0.5, 1e-6] {
            assert_eq!(after(1e-3, cos * FRAC_1_PI), SHARE, "Lambert's law at cosine {cos}");
        }
        // A lobe of a hundredth of a matt surface's solid angle is a tenth as wide; four roundings of 6e-8.
        assert!((after(1e-3, 100.0 * FRAC_1_PI) - 0.1 * SHARE).abs() < 1e-8);
        assert_eq!(after(1e-3, 1e12), 1e-3, "a lobe narrower than the cone leaves it");
        assert_eq!(after(0.5, FRAC_1_PI), 0.5, "nothing narrows it");
    }

    #[test]
    fn width_grows_with_the_way() {
        let mut cone = Cone::new(0.5);
        cone.travel(2.0);
        cone.scatter(1e12);
        cone.travel(4.0);
        assert_eq!(cone.width_m, 3.0);
    }
}
