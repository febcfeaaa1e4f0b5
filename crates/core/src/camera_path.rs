//! Pose of a camera over time.

use glam::{DAffine3, DVec3};

use crate::{TimeInterval, frame::CameraPose, motion::Motion};

/// Pose of a camera at every time.
#[derive(Clone, Debug, PartialEq)]
pub struct CameraPath(PoseSource);

#[derive(Clone, Debug, PartialEq)]
enum PoseSource {
    Static(CameraPose),
    Moving(Motion),
}

impl CameraPath {
    /// Returns a stationary camera.
    #[must_use]
    pub fn constant(pose: CameraPose) -> Self {
        Self(PoseSource::Static(pose))
    }

    /// Returns a moving camera. `to_world` is the transform from the camera frame (x right, y down, z forward; origin at the centre of the entrance pupil) to
    /// the world, without scale. A motion that never changes gives a stationary camera.
    #[must_use]
    pub fn moving(to_world: impl Into<Motion>) -> Self {
        let to_world: Motion = to_world.into();
        match to_world.as_constant() {
            Some(to_world) => Self::constant(pose(&to_world)),
            None => Self(PoseSource::Moving(to_world)),
        }
    }

    /// Returns the pose at a simulated time, s.
    #[must_use]
    pub fn at(&self, time_s: f64) -> CameraPose {
        match &self.0 {
            PoseSource::Static(pose) => *pose,
            PoseSource::Moving(to_world) => pose(&to_world.at(time_s)),
        }
    }

    /// Returns the pose during all of an interval; `None` if the camera moves in it.
    #[must_use]
    pub fn constant_over(&self, interval: TimeInterval) -> Option<CameraPose> {
        match &self.0 {
            PoseSource::Static(pose) => Some(*pose),
            PoseSource::Moving(to_world) => to_world.constant_over(interval).map(|_| self.at(interval.start_s())),
        }
    }

    /// Returns the minimum and maximum coordinates, m, of a box of the world that holds the centre of the entrance pupil during an interval.
    #[must_use]
    pub fn bounds_over(&self, interval: TimeInterval) -> (DVec3, DVec3) {
        match &self.0 {
            PoseSource::Static(pose) => (pose.position_m, pose.position_m),
            PoseSource::Moving(to_world) => to_world.rough_bounds(interval, 0.0),
        }
    }

    /// Returns the interval from the first time at which the camera moves to the last; `None` if it never moves.
    #[must_use]
    pub fn motion_interval(&self) -> Option<TimeInterval> {
        match &self.0 {
            PoseSource::Static(_) => None,
            PoseSource::Moving(to_world) => to_world.motion_interval(),
        }
    }

    /// Returns the times, s, of all keys of the motion in increasing order; none for a stationary camera.
    #[must_use]
    pub fn key_times_s(&self) -> Vec<f64> {
        match &self.0 {
            PoseSource::Static(_) => Vec::new(),
            PoseSource::Moving(to_world) => to_world.times_s(),
        }
    }

    /// Returns the largest absolute coordinate, m, of the centre of the entrance pupil: of a stationary camera, or at any key.
    #[must_use]
    pub fn max_coordinate_m(&self) -> f64 {
        let times_s = if self.is_stationary() { vec![0.0] } else { self.key_times_s() };
        times_s.into_iter().map(|time_s| self.at(time_s).position_m.abs().max_element()).fold(0.0, f64::max)
    }

    /// Returns true if the pose is the same at all times.
    #[must_use]
    pub fn is_stationary(&self) -> bool {
        matches!(self.0, PoseSource::Static(_))
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
        let over = |start, end| path.constant_over(TimeInterval::new(start, end).expect("in order"));
        assert!(over(2.0, 2.5).is_none() && !path.is_stationary());
        assert_eq!(over(3.0, 9.0), Some(path.at(3.0)));
        assert!(CameraPath::constant(pose).is_stationary());
    }
}
