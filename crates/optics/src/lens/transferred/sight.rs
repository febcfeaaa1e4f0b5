//! The pupil of a sensor point: the points of the pupil plane that pass light, and the rays that leave through them.
//!
//! A lens of revolution is the same for all points at one distance from the axis. In the frame of such a point a point q of the pupil plane has q.x
//! along the meridian, away from the axis on the point's side, and q.y across it.

use glam::DVec2;

use crate::lens::search::last_open;
use crate::ray_transfer::{RayTransfer, TransferRay};

/// A lens with its sensor position.
#[derive(Clone, Copy)]
pub(super) struct PupilQuery<'a> {
    pub(super) transfer: &'a RayTransfer,
    /// Distance from the rear vertex to the sensor, mm.
    pub(super) sensor_mm: f64,
    /// The rays considered: of one of the wavelengths, or of any.
    pub(super) of: Option<usize>,
}

/// Slopes on either side within which the pupil is searched: 63° from the axis.
const MAX_SLOPE: f64 = 2.0;
const SCAN: i32 = 2048;
const HALVINGS: usize = 48;
/// Positions along a line at which its last open point is searched.
const LINE_SAMPLES: usize = 40;

impl PupilQuery<'_> {
    /// The distance of the pupil's plane from the sensor, mm.
    pub(super) fn distance_mm(&self) -> f64 {
        self.transfer.pupil_distance_mm(self.sensor_mm)
    }

    pub(super) fn passes(&self, radius_mm: f64, q: DVec2) -> bool {
        let entry = self.transfer.entry(DVec2::new(0.0, radius_mm), DVec2::new(q.y, q.x), self.sensor_mm);
        match self.of {
            Some(index) => self.transfer.passes(index, &entry),
            None => (0..self.transfer.transfers().len()).any(|index| self.transfer.passes(index, &entry)),
        }
    }

    /// The interval of the meridian that passes, from its first to its last point, mm; `None` if none does.
    pub(super) fn meridional(&self, radius_mm: f64) -> Option<[f64; 2]> {
        let step = MAX_SLOPE * self.distance_mm() / f64::from(SCAN);
        let at = |i: i32| radius_mm + step * f64::from(i);
        let is_open = |x: f64| self.passes(radius_mm, DVec2::new(x, 0.0));
        let first = (-SCAN..=SCAN).map(at).find(|x| is_open(*x))?;
        let last = (-SCAN..=SCAN).rev().map(at).find(|x| is_open(*x)).unwrap_or(first);
        let edge = |inside: f64, outside: f64| last_open([inside, outside], HALVINGS, is_open);
        Some([edge(first, first - step), edge(last, last + step)])
    }

    /// Extent of the pupil from a point along a step, in steps, searched up to `most` of them; 0 if nothing is open.
    pub(super) fn reach(&self, radius_mm: f64, from: DVec2, step: DVec2, maximum: f64) -> f64 {
        let at = |i: usize| maximum * i as f64 / LINE_SAMPLES as f64;
        let is_open = |t: f64| self.passes(radius_mm, from + step * t);
        let last = (0..=LINE_SAMPLES).rev().find(|i| is_open(at(*i)));
        last.map_or(0.0, |i| last_open([at(i), at(i + 1)], HALVINGS, is_open))
    }

    /// The meridional ray that leaves through a position of the meridian, as its height above the axis at a distance from the sensor, and its slope;
    /// `None` if there is none.
    pub(super) fn meridian_ray(&self, radius_mm: f64, along_mm: f64, nm: f64) -> Option<TransferRay> {
        let (point, pupil) = (DVec2::new(0.0, radius_mm), DVec2::new(0.0, along_mm));
        let entry = self.transfer.entry(point, pupil, self.sensor_mm);
        let mut ray = self.transfer.exit_ray(&entry, self.sensor_mm, nm)?;
        // The fit's component across the meridian is an error.
        (ray.point_mm.x, ray.direction.x) = (0.0, 0.0);
        ray.direction = ray.direction.normalize();
        Some(ray)
    }
}
