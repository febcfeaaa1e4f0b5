//! Where a camera stands over time.

use glam::{DAffine3, DVec3};

use crate::{TimeInterval, frame::CameraPose, motion::Motion};

/// The pose of a camera at every time.
#[derive(Clone, Debug, PartialEq)]
pub struct CameraPath(Kind);

#[derive(Clone, Debug, PartialEq)]
enum Kind {
    Still(CameraPose),
    Moving(Motion),
}

impl CameraPath {
    /// A camera that stands still.
    #[must_use]
    pub fn still(pose: CameraPose) -> Self {
        Self(Kind::Still(pose))
    }

    /// A camera that moves: `to_world` goes from the camera frame (x right, y down, z forward; origin at the centre of the entrance
    /// pupil) to the world, and scales nothing. One that never moves stands still.
    #[must_use]
    pub fn moving(to_world: impl Into<Motion>) -> Self {
        let to_world: Motion = to_world.into();
        match to_world.as_still() {
            Some(to_world) => Self::still(pose(&to_world)),
            None => Self(Kind::Moving(to_world)),
        }
    }

    /// The pose at a simulated time, s.
    #[must_use]
    pub fn at(&self, time_s: f64) -> CameraPose {
        match &self.0 {
            Kind::Still(pose) => *pose,
            Kind::Moving(to_world) => pose(&to_world.at(time_s)),
        }
    }

    /// The pose during all of an interval; `None` where the camera moves in it.
    #[must_use]
    pub fn still_over(&self, interval: TimeInterval) -> Option<CameraPose> {
        match &self.0 {
            Kind::Still(pose) => Some(*pose),
            Kind::Moving(to_world) => to_world.still_over(interval).map(|_| self.at(interval.start_s())),
        }
    }

    /// Least and greatest coordinates, m, of a box of the world that holds the centre of the entrance pupil during an interval.
    #[must_use]
    pub fn bounds_over(&self, interval: TimeInterval) -> (DVec3, DVec3) {
        match &self.0 {
            Kind::Still(pose) => (pose.position_m, pose.position_m),
            Kind::Moving(to_world) => to_world.rough_bounds(interval, 0.0),
        }
    }

    /// From the first time at which it moves to the last; `None` where it never does.
    #[must_use]
    pub fn moves_during(&self) -> Option<TimeInterval> {
        match &self.0 {
            Kind::Still(_) => None,
            Kind::Moving(to_world) => to_world.moves_during(),
        }
    }

    /// The times, s, of all keys that it moves by, rising; none where it stands still.
    #[must_use]
    pub fn key_times_s(&self) -> Vec<f64> {
        match &self.0 {
            Kind::Still(_) => Vec::new(),
            Kind::Moving(to_world) => to_world.times_s(),
        }
    }

    /// The greatest coordinate, m and without its sign, of the centre of the entrance pupil where it stands still or at any key.
    #[must_use]
    pub fn farthest_coordinate_m(&self) -> f64 {
        let times_s = if self.is_still() { vec![0.0] } else { self.key_times_s() };
        times_s.into_iter().map(|time_s| self.at(time_s).position_m.abs().max_element()).fold(0.0, f64::max)
    }

    /// Whether it has one pose at all times.
    #[must_use]
    pub fn is_still(&self) -> bool {
        matches!(self.0, Kind::Still(_))
    }
}

fn pose(to_world: &DAffine3) -> CameraPose {
    CameraPose { position_m: to_world.translation, rotation: to_world.matrix3 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::track::{Interpolation, Key, Track};
    use glam::{DMat3, DQuat};

    #[test]
    fn a_camera_that_moves_has_the_pose_of_its_track() {
        let key = |time_s: f64| Key {
            time_s,
            position_m: DVec3::X * (2.0 * time_s),
            rotation: DQuat::IDENTITY,
            scale: DVec3::ONE,
        };
        let track = Track::new(&[key(1.0), key(3.0)], Interpolation::Linear).expect("legal");
        let path = CameraPath::moving(track);
        let pose = path.at(2.0);
        assert!((pose.position_m - DVec3::X * 4.0).length() < 1e-15 && pose.rotation == DMat3::IDENTITY);
        let over = |start, end| path.still_over(TimeInterval::new(start, end).expect("in order"));
        assert!(over(2.0, 2.5).is_none() && !path.is_still());
        assert_eq!(over(3.0, 9.0), Some(path.at(3.0)));
        assert!(CameraPath::still(pose).is_still());
    }
}
