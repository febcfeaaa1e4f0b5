//! The ovals from which pupil samples are drawn: they contain everything that passes, and little else.
//!
//! At equal steps of the distance from the axis an oval is the ellipse about the box of the region that passes at any of the wavelengths. Between
//! them its centre and semi-axes are linear, and are stretched until the oval contains the passing region at the ends of the interval and between
//! them, plus a margin.

use core::f64::consts::PI;

use glam::DVec2;

use super::sight::PupilQuery;
use crate::lens::search::{max_lit_radius, towards};

const INTERVALS: usize = 48;
/// Distances sampled per interval, including both ends.
const INTERVAL_SAMPLES: usize = 4;
const DIRECTIONS: usize = 64;
/// Margin factor for edges between the sampled points.
const MARGIN: f64 = 1.004;

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Oval {
    /// Its centre along the meridian, mm.
    pub(super) centre_mm: f64,
    /// Semi-axes along the meridian and across it, mm.
    pub(super) axes_mm: DVec2,
}

/// Ovals by the distance from the axis.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Pupils {
    /// Distance beyond which no light arrives, mm.
    pub(super) limit_mm: f64,
    ovals: Vec<Oval>,
    stretches: Vec<f64>,
}

/// A point of the pupil plane in the frame of a sensor point, and the area it represents, mm².
pub(super) struct Proposal {
    pub(super) q: DVec2,
    pub(super) area_mm2: f64,
}

impl Pupils {
    /// Determines ovals up to `reach_mm` from the axis or the end of the light; `None` if the centre of the sensor is dark.
    pub(super) fn new(sight: &PupilQuery<'_>, reach_mm: f64) -> Option<Self> {
        let limit_mm = max_lit_radius(reach_mm, 2 * INTERVALS, |radius_mm| sight.meridional(radius_mm).is_some())
            .filter(|limit_mm| *limit_mm > 0.0)?;
        let step = limit_mm / INTERVALS as f64;
        // A dark distance between lit ones may have any oval: nothing passes there.
        let next = |last: &mut Option<Oval>, i: usize| {
            *last = Oval::about(sight, step * i as f64).or(*last);
            *last
        };
        let ovals: Vec<Oval> = (0..=INTERVALS).scan(None, next).collect();
        let mut pupils = Self { limit_mm, ovals, stretches: Vec::new() };
        let stretch = |i: usize| {
            let samples =
                (0..INTERVAL_SAMPLES).map(|sample| (i as f64 + sample as f64 / (INTERVAL_SAMPLES - 1) as f64) * step);
            samples.map(|radius_mm| pupils.missing(sight, radius_mm)).fold(1.0, f64::max) * MARGIN
        };
        pupils.stretches = (pupils.ovals.len() == INTERVALS + 1).then(|| (0..INTERVALS).map(stretch).collect())?;
        Some(pupils)
    }

    /// Factor by which the oval at a distance must grow to contain everything that passes there.
    fn missing(&self, sight: &PupilQuery<'_>, radius_mm: f64) -> f64 {
        let (Some(oval), Some([low, high])) = (self.oval(radius_mm), sight.meridional(radius_mm)) else { return 1.0 };
        let within = DVec2::new(0.5 * (low + high), 0.0);
        let edge = (0..DIRECTIONS).map(|i| {
            let step = towards(i, DIRECTIONS) * oval.axes_mm;
            let q = within + step * sight.reach(radius_mm, within, step, 3.0);
            ((q - DVec2::new(oval.centre_mm, 0.0)) / oval.axes_mm).length()
        });
        edge.fold(1.0, f64::max)
    }

    fn place(&self, radius_mm: f64) -> Option<(usize, f64)> {
        let place = radius_mm / self.limit_mm * INTERVALS as f64;
        let index = (place as usize).min(INTERVALS - 1);
        (place <= INTERVALS as f64).then_some((index, place - index as f64))
    }

    /// The oval at a distance from the axis, not stretched; `None` if no light arrives.
    pub(super) fn oval(&self, radius_mm: f64) -> Option<Oval> {
        let (i, fraction) = self.place(radius_mm)?;
        let (a, b) = (self.ovals[i], self.ovals[i + 1]);
        let centre_mm = a.centre_mm + fraction * (b.centre_mm - a.centre_mm);
        Some(Oval { centre_mm, axes_mm: a.axes_mm.lerp(b.axes_mm, fraction) })
    }

    /// The proposal for a point of the unit disc.
    #[inline]
    pub(super) fn propose(&self, radius_mm: f64, disc: DVec2) -> Option<Proposal> {
        let oval = self.oval(radius_mm)?;
        let axes = oval.axes_mm * self.stretches[self.place(radius_mm)?.0];
        let q = DVec2::new(oval.centre_mm, 0.0) + axes * disc;
        Some(Proposal { q, area_mm2: PI * axes.x * axes.y })
    }
}

impl Oval {
    /// The oval about the box of everything that passes at a distance from the axis.
    pub(super) fn about(sight: &PupilQuery<'_>, radius_mm: f64) -> Option<Self> {
        let [low, high] = sight.meridional(radius_mm)?;
        let (centre, half) = (DVec2::new(0.5 * (low + high), 0.0), (0.5 * (high - low)).max(1e-9));
        let (mut minimum, mut maximum) = (centre, centre);
        for i in 0..DIRECTIONS {
            let step = towards(i, DIRECTIONS) * half;
            let q = centre + step * sight.reach(radius_mm, centre, step, 8.0);
            (minimum, maximum) = (minimum.min(q), maximum.max(q));
        }
        let across = maximum.y.max(-minimum.y).max(1e-9);
        let axes_mm = DVec2::new((0.5 * (maximum.x - minimum.x)).max(1e-9), across);
        Some(Self { centre_mm: 0.5 * (maximum.x + minimum.x), axes_mm })
    }
}
