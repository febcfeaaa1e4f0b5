//! How wide a path has become: the footprint of texture look-ups.
//!
//! A cone about the path (Amanatides 1984): its width grows by spread × distance. Scattering with density p widens the
//! spread to at least a quarter of √(1/(π p)), the half angle of a small cone of solid angle 1/p, taken as 1 rad where it
//! is more. A matt surface (p ≤ 1/π) thus widens it to 0.25 rad always, a mirror not at all. The quarter is a choice:
//! it leaves texture to be seen in what matt surfaces throw on each other. Curvature of mirrors is left out.

use core::f32::consts::FRAC_1_PI;
use glam::Vec3;

/// Share of the scattered cone that later look-ups average over.
const SHARE: f32 = 0.25;

/// Spread from which on the long side of a footprint is not told, rad: that of a pixel of a very wide or coarse camera.
const NARROW_RAD: f32 = 0.02;

/// Most times that a footprint is longer than wide.
const LONGEST: f32 = 1000.0;

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

    /// The long side (m, from end to end) of the ellipse that the cone cuts out of a surface of unit `normal`, about the
    /// unit `direction`: `None` where it is less than twice as long as wide. Of a cone that scattering has widened it is
    /// not told: what such a path sees is an average of many anyway, and long sides take many readings of a texture.
    pub(super) fn long_side(self, normal: Vec3, direction: Vec3) -> Option<Vec3> {
        let cos = normal.dot(direction);
        let is_long = cos.abs() < 0.5 && self.spread_rad < NARROW_RAD;
        let along = direction - normal * cos;
        is_long.then(|| along.normalize_or_zero() * (self.width_m / cos.abs().max(1.0 / LONGEST)))
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
    fn grazing_cones_cut_long_ellipses() {
        let cone = Cone { width_m: 0.1, spread_rad: 1e-3 };
        let direction = Vec3::new(0.6, 0.0, -0.8);
        assert_eq!(cone.long_side(Vec3::Z, direction), None);
        // Seen at a cosine of 0.28: 0.1 / 0.28 along x, from either side.
        let grazing = Vec3::new(0.96, 0.0, -0.28);
        for normal in [Vec3::Z, Vec3::NEG_Z] {
            let long = cone.long_side(normal, grazing).expect("long");
            assert!((long - Vec3::X * (0.1 / 0.28)).length() < 1e-6, "{long}");
        }
        assert_eq!(Cone { spread_rad: 0.25, ..cone }.long_side(Vec3::Z, grazing), None);
        assert!(cone.long_side(Vec3::Z, Vec3::X).expect("long").is_finite());
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
