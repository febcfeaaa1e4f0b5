//! The way of a light through a view's interval.

use super::tree::LightBounds;
use core::f32::consts::PI;
use etendue_core::{Motion, TimeInterval};
use glam::{DAffine3, DVec3, Vec3};

/// Moments of an interval at which a light's intensity is looked at.
const MOMENTS: u32 = 16;

/// The way of an instance through a view's interval.
#[derive(Clone, Debug)]
pub(super) struct Way {
    /// That of the instance.
    pub(super) to_world: Motion,
    /// The origin of the render frame in the world, m.
    pub(super) origin_m: DVec3,
    /// The view's.
    pub(super) interval: TimeInterval,
}

impl Way {
    /// To the render frame at a simulated time, s.
    pub(super) fn at(&self, time_s: f64) -> DAffine3 {
        let mut to_render = self.to_world.at(time_s);
        to_render.translation -= self.origin_m;
        to_render
    }

    /// To the render frame at even moments of the interval, both its ends among them.
    pub(super) fn moments(&self) -> impl Iterator<Item = DAffine3> {
        let part = |i: u32| f64::from(i) / f64::from(MOMENTS);
        (0..=MOMENTS).map(move |i| self.at(self.interval.start_s() + self.interval.length_s() * part(i)))
    }

    /// Bounds from those at some moments, and the box of all the motion: intensity is the greatest, the cone that of the start
    /// opened by how far the light turns, or all directions where there is none at some of them.
    pub(super) fn bounds(&self, moments: Vec<LightBounds>, (low, high): (DVec3, DVec3)) -> Option<LightBounds> {
        let first = *moments.first()?;
        let intensity = moments.iter().map(|bounds| bounds.intensity).fold(0.0, f64::max);
        let whole = LightBounds::of_surface(&self.render_box((low, high)), intensity, None);
        let theta_o = first.theta_o + self.turning();
        if theta_o >= PI || moments.len() <= MOMENTS as usize {
            return Some(whole);
        }
        Some(LightBounds { axis: first.axis, theta_o, theta_e: first.theta_e, ..whole })
    }

    /// Least and greatest coordinates, render frame, m, of a box of the world, with room for rounding to f32.
    pub(super) fn render_box(&self, (low, high): (DVec3, DVec3)) -> [Vec3; 2] {
        let box_of = [low, high].map(|corner| (corner - self.origin_m).as_vec3());
        let room = (box_of[0].abs().max(box_of[1].abs()) + Vec3::splat(f32::MIN_POSITIVE)) * f32::EPSILON;
        [box_of[0] - room, box_of[1] + room]
    }

    /// A bound of the angle by which directions turn from where they are at the start, rad, with room for rounding.
    pub(super) fn turning(&self) -> f32 {
        self.to_world.turning_over(self.interval) as f32 * (1.0 + 1e-5) + 1e-5
    }
}
