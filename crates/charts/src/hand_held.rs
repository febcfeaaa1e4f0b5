//! Hand-held views: small random deviations from the regular steps of [`camera_stations`](crate::camera_stations).
//!
//! Views in regular steps meet the pixel raster, and the mosaic of a colour sensor, at the same positions every time. A
//! measurement over several such series repeats the raster's effect instead of averaging it.

use etendue_core::maths::f64::sin_cos;
use etendue_core::random::{NoiseDraw, NoiseStream, Pixel};
use glam::{DQuat, DVec3};
use rand::RngExt as _;

use crate::camera_station::CameraStation;

/// Maximum pointing error, horizontal and vertical, as a fraction of the distance.
const MAX_POINTING_ERROR: f64 = 0.005;
/// Maximum increase of the distance, as a fraction; it is never reduced.
const MAX_DISTANCE_INCREASE: f64 = 0.02;
/// Maximum roll about the axis, either way, degrees.
const MAX_ROLL_DEG: f64 = 1.5;

impl CameraStation {
    /// Returns the `nth` station of a series with random hand-held deviations from the seed: pointing off by up to 0.5 % of its
    /// distance, horizontally and vertically, up to 2 % farther away, rolled by up to 1.5 degrees.
    #[must_use]
    pub fn hand_held(self, seed: u64, nth: u32) -> Self {
        let mut random = NoiseStream::new(seed, 0, 0, 0, Pixel { x: nth, y: 2 }, NoiseDraw::Shot);
        let [across, upward, roll]: [f64; 3] = std::array::from_fn(|_| random.random_range(-1.0..1.0));
        let distance_factor = 1.0 + MAX_DISTANCE_INCREASE * random.random::<f64>();
        let axis = self.target_m - self.position_m;
        let (right, up) = (axis.cross(self.up).normalize_or_zero(), self.up.reject_from(axis).normalize_or_zero());
        let pointing_error = MAX_POINTING_ERROR * axis.length() * (across * right + upward * up);
        let (sin, cos) = sin_cos(0.5 * (roll * MAX_ROLL_DEG).to_radians());
        let rotation_axis = axis.normalize_or(DVec3::X);
        let turn = DQuat::from_vec4((rotation_axis * sin).extend(cos));
        Self {
            position_m: self.target_m - axis * distance_factor,
            target_m: self.target_m + pointing_error,
            up: turn * self.up,
            ..self
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::camera_stations;

    #[test]
    fn stations_stay_near_their_places_and_differ_by_seed() {
        for (nth, station) in (0..).zip(camera_stations(2.0, 9, &[], false)) {
            let hand_held_station = station.clone().hand_held(7, nth);
            let distance = (station.target_m - station.position_m).length();
            let distance_ratio = (hand_held_station.position_m - station.target_m).length() / distance;
            let pointing_error = (hand_held_station.target_m - station.target_m).length() / distance;
            let roll_deg = hand_held_station.up.angle_between(station.up).to_degrees();
            assert!(
                (1.0..1.02).contains(&distance_ratio) && pointing_error > 0.0 && pointing_error < 0.0071,
                "{distance_ratio} {pointing_error}"
            );
            // Up need not be perpendicular to the axis, so that the roll is at most this much.
            assert!(roll_deg > 0.0 && roll_deg < 1.5, "{roll_deg}");
            assert_eq!(hand_held_station, station.clone().hand_held(7, nth));
            assert!(
                hand_held_station != station.clone().hand_held(8, nth)
                    && hand_held_station != station.hand_held(7, nth + 1)
            );
        }
    }
}
