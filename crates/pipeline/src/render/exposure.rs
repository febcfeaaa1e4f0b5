//! When, and from where, each row of a film is exposed.

use crate::plan::{CameraPlan, Route, TimeDependence};
use etendue_core::{CameraPath, CameraPose, PupilRay, Ray, TimeInterval};
use glam::DVec3;

/// Which picture of a camera: where the world depends on time, each has a light of its own.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Shot {
    /// The frame, from 0.
    pub frame: u32,
    /// The capture within the frame, from 0.
    pub capture: u32,
}

/// When, and from where, the rows of a film are exposed, about the origin of a view of the world.
#[derive(Clone, Debug)]
pub struct FilmExposure<'a> {
    path: &'a CameraPath,
    time: TimeDependence,
    /// Of all rows together: that of the view.
    interval: TimeInterval,
    /// Of each row of the film.
    rows: Vec<TimeInterval>,
    /// The origin of the render frame in the world, m.
    origin_m: DVec3,
}

impl<'a> FilmExposure<'a> {
    /// The exposure of a camera's film.
    #[must_use]
    pub fn of(camera: &'a CameraPlan, shot: Shot) -> Self {
        let Shot { frame, capture } = shot;
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

    /// All rows at one moment, from a camera that stands still.
    #[must_use]
    pub fn still(path: &'a CameraPath) -> Self {
        let interval = TimeInterval::default();
        let origin_m = path.at(0.0).position_m;
        Self { path, time: TimeDependence::None, interval, rows: Vec::new(), origin_m }
    }

    /// The time from the beginning of the first row's exposure to the end of the last one's; a single moment where nothing depends
    /// on time.
    #[must_use]
    pub fn interval(&self) -> TimeInterval {
        match self.time {
            TimeDependence::None => TimeInterval::default(),
            TimeDependence::Lights | TimeDependence::Motion => self.interval,
        }
    }

    /// The origin of the render frame in the world, m: where the camera is half-way.
    #[must_use]
    pub fn origin_m(&self) -> DVec3 {
        self.origin_m
    }

    /// Whether samples have moments of their own.
    #[must_use]
    pub fn has_moments(&self) -> bool {
        self.time == TimeDependence::Motion
    }

    /// The moment of a sample of a row, s of simulated time, for a number `u` in [0, 1) that samples of neighbouring rows may share: each
    /// row's moments are spread evenly over its exposure, and equal in rows whose exposures overlap as far as they do.
    #[must_use]
    pub fn moment_s(&self, row: u32, u: f32) -> f64 {
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

    /// Over what time the level of a light that changes is averaged for a sample of a row: over the row's exposure where nothing
    /// moves, else at the sample's moment, as its ray has it.
    #[must_use]
    pub fn lit(&self, row: u32, moment_s: f64) -> TimeInterval {
        match self.time {
            TimeDependence::None => TimeInterval::default(),
            TimeDependence::Lights => self.rows[row as usize],
            TimeDependence::Motion => TimeInterval::at(self.interval.moment(self.time_s(moment_s))).unwrap_or_default(),
        }
    }

    /// The pose at a moment, s.
    #[must_use]
    pub fn pose(&self, moment_s: f64) -> CameraPose {
        self.path.at(moment_s)
    }

    /// A ray of the camera frame at a moment, s, in the render frame.
    #[must_use]
    pub fn to_render(&self, ray: &PupilRay, moment_s: f64) -> Ray {
        let pose = self.pose(moment_s);
        let origin = pose.point_to_render(ray.origin_m) + (pose.position_m - self.origin_m);
        let direction = pose.direction_to_world(ray.direction).as_vec3().normalize();
        Ray::new(origin.as_vec3(), direction, self.time_s(moment_s))
    }

    /// A moment as the time of a ray. Moments of rows that differ by rounding alone are one time.
    fn time_s(&self, moment_s: f64) -> f32 {
        (moment_s - self.interval().start_s()) as f32
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DMat3;

    /// Rows of 8 ms that begin 1 ms after each other.
    fn rolling(path: &CameraPath) -> FilmExposure<'_> {
        let row = |i: u32| TimeInterval::new(5.0 + 1e-3 * f64::from(i), 5.008 + 1e-3 * f64::from(i)).expect("in order");
        let interval = row(0).union(&row(15));
        let rows = (0..16).map(row).collect();
        FilmExposure { interval, rows, time: TimeDependence::Motion, ..FilmExposure::still(path) }
    }

    #[test]
    fn moments_are_even_over_each_row_and_shared_where_rows_overlap() {
        let path = CameraPath::still(CameraPose { position_m: DVec3::ONE, rotation: DMat3::IDENTITY });
        let exposure = rolling(&path);
        let n = 1024_u16;
        for row in 0..16 {
            let own = exposure.rows[row as usize];
            let mut moments: Vec<f64> =
                (0..n).map(|i| exposure.moment_s(row, (f32::from(i) + 0.5) / f32::from(n))).collect();
            moments.sort_by(f64::total_cmp);
            for (i, moment_s) in moments.iter().enumerate() {
                // One in each of 1024 equal parts, but for rounding at their ends.
                let even_s = own.start_s() + own.length_s() * (i as f64 + 0.5) / f64::from(n);
                assert!((moment_s - even_s).abs() < 0.5 * own.length_s() / f64::from(n) + 1e-12, "{row} {i}");
            }
        }
        // Rows 3 and 5 have 6 of their 8 ms in common.
        let same = (0..n).filter(|i| {
            let u = (f32::from(*i) + 0.5) / f32::from(n);
            exposure.moment_s(3, u).to_bits() == exposure.moment_s(5, u).to_bits()
        });
        assert_eq!(same.count(), usize::from(n) * 6 / 8);
    }
}
