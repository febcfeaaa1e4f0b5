//! How wide a path has become: the footprint of texture look-ups.
//!
//! A cone about the path (Amanatides 1984): its width grows by spread × distance. Scattering with density p widens it to
//! a quarter of the angle that a cone of solid angle 1/p has: a matt surface by about 0.14 rad, a mirror not at all.
//! Curvature of mirrors is left out.

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
