//! Exposure time and camera pose of each row of a film.

use crate::plan::{CameraPlan, Route, TimeDependence};
use etendue_core::{CameraPath, CameraPose, PupilRay, Ray, TimeInterval};
use glam::DVec3;

/// An image of a camera: where the world depends on time, each has its own light.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FrameCapture {
    /// The frame, from 0.
    pub frame: u32,
    /// The capture within the frame, from 0.
    pub capture: u32,
}

/// Exposure times and camera poses of the rows of a film, relative to the origin of a view of the world.
#[derive(Clone, Debug)]
pub struct FilmExposure<'a> {
    path: &'a CameraPath,
    time: TimeDependence,
    /// Interval of all rows together: that of the view.
    interval: TimeInterval,
    /// Interval of each row of the film.
    rows: Vec<TimeInterval>,
    /// The origin of the render frame in the world, m.
    origin_m: DVec3,
}

impl<'a> FilmExposure<'a> {
    /// Exposure of a camera's film.
    #[must_use]
    pub fn new(camera: &'a CameraPlan, frame_capture: FrameCapture) -> Self {
        let FrameCapture { frame, capture } = frame_capture;
        let (timing, capture) = (&camera.timing, capture as usize);
        let interval = timing.capture(frame, capture);
        let row = |row: u32| match &camera.settings.route {
            Route::Lens => {
                timing.row(frame, capture, (row as usize).saturating_sub(camera.body.effects.margin_px()[1]))
            }
            Route::Pupil(_) => interval,
        };
        let rows = match camera.time {
            TimeDependence::None => Vec::new(),
            TimeDependence::Lights | TimeDependence::Motion => (0..camera.film_size().1).map(row).collect(),
        };
        let origin_m = camera.path.at(interval.middle_s()).position_m;
        Self { path: &camera.path, time: camera.time, interval, rows, origin_m }
    }

    /// All rows at one time, from a static camera.
    #[must_use]
    pub fn still(path: &'a CameraPath) -> Self {
        let interval = TimeInterval::default();
        let origin_m = path.at(0.0).position_m;
        Self { path, time: TimeDependence::None, interval, rows: Vec::new(), origin_m }
    }

    /// Interval from the start of the first row's exposure to the end of the last row's; zero length if nothing depends on time.
    #[must_use]
    pub fn interval(&self) -> TimeInterval {
        match self.time {
            TimeDependence::None => TimeInterval::default(),
            TimeDependence::Lights | TimeDependence::Motion => self.interval,
        }
    }

    /// Origin of the render frame in the world, m: the camera's position at the middle of the interval.
    #[must_use]
    pub fn origin_m(&self) -> DVec3 {
        self.origin_m
    }

    /// Returns true if samples have individual times.
    #[must_use]
    pub fn has_sample_times(&self) -> bool {
        self.time == TimeDependence::Motion
    }

    /// Time of a sample of a row, s of simulated time, from a number `u` in [0, 1) that samples of neighbouring rows may share. The times of each row are
    /// uniform over its exposure, and equal, as far as possible, in rows with overlapping exposures.
    #[must_use]
    pub fn sample_time_s(&self, row: u32, u: f32) -> f64 {
        if self.time != TimeDependence::Motion {
            return self.interval().start_s();
        }
        let row = self.rows[row as usize];
        let length_s = row.length_s();
        if length_s == 0.0 {
            return row.start_s();
        }
        let sample_s = self.interval.start_s() + f64::from(u) * length_s;
        let turns = ((row.start_s() - sample_s) / length_s).ceil();
        (sample_s + turns * length_s).clamp(row.start_s(), row.end_s())
    }

    /// Interval over which the level of a varying light is averaged for a sample of a row: the row's exposure if nothing moves, otherwise the sample's time,
    /// as of its ray.
    #[must_use]
    pub fn light_interval(&self, row: u32, moment_s: f64) -> TimeInterval {
        match self.time {
            TimeDependence::None => TimeInterval::default(),
            TimeDependence::Lights => self.rows[row as usize],
            TimeDependence::Motion => TimeInterval::at(self.interval.moment(self.time_s(moment_s))).unwrap_or_default(),
        }
    }

    /// Pose at a time, s.
    #[must_use]
    pub fn pose(&self, moment_s: f64) -> CameraPose {
        self.path.at(moment_s)
    }

    /// Converts a ray of the camera frame at a time, s, to the render frame.
    #[must_use]
    pub fn to_render(&self, ray: &PupilRay, moment_s: f64) -> Ray {
        let pose = self.pose(moment_s);
        let origin = pose.point_to_render(ray.origin_m) + (pose.position_m - self.origin_m);
        let direction = pose.direction_to_world(ray.direction).as_vec3().normalize();
        Ray::new(origin.as_vec3(), direction, self.time_s(moment_s))
    }

    /// Ray time of a simulated time. Times of rows that differ only by rounding are equal.
    fn time_s(&self, moment_s: f64) -> f32 {
        (moment_s - self.interval().start_s()) as f32
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DMat3;

    /// Rows of 8 ms that start 1 ms after each other.
    fn rolling(path: &CameraPath) -> FilmExposure<'_> {
        let row = |i: u32| TimeInterval::new(5.0 + 1e-3 * f64::from(i), 5.008 + 1e-3 * f64::from(i)).expect("in order");
        let interval = row(0).union(&row(15));
        let rows = (0..16).map(row).collect();
        FilmExposure { interval, rows, time: TimeDependence::Motion, ..FilmExposure::still(path) }
    }

    #[test]
    fn moments_are_even_over_each_row_and_shared_where_rows_overlap() {
        let path = CameraPath::constant(CameraPose { position_m: DVec3::ONE, rotation: DMat3::IDENTITY });
        let exposure = rolling(&path);
        let n = 1024_u16;
        for row in 0..16 {
            let own = exposure.rows[row as usize];
            let mut moments: Vec<f64> =
                (0..n).map(|i| exposure.sample_time_s(row, (f32::from(i) + 0.5) / f32::from(n))).collect();
            moments.sort_by(f64::total_cmp);
            for (i, moment_s) in moments.iter().enumerate() {
                // One in each of 1024 equal parts, except for rounding at their ends.
                let even_s = own.start_s() + own.length_s() * (i as f64 + 0.5) / f64::from(n);
                assert!((moment_s - even_s).abs() < 0.5 * own.length_s() / f64::from(n) + 1e-12, "{row} {i}");
            }
        }
        // Rows 3 and 5 share 6 of their 8 ms.
        let same = (0..n).filter(|i| {
            let u = (f32::from(*i) + 0.5) / f32::from(n);
            exposure.sample_time_s(3, u).to_bits() == exposure.sample_time_s(5, u).to_bits()
        });
        assert_eq!(same.count(), usize::from(n) * 6 / 8);
    }
}
