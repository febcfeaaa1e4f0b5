//! The region of slopes from which pupil samples are drawn: it contains all that passes, and little else.
//!
//! For 40 intervals of sensor height the region is an ellipse, its centre and semi-axes linear in the height, times a radius R(φ) tabulated over half
//! a turn (the other half is its mirror image). The ellipse is that of the middle wavelength. R is raised until the region contains all passing rays
//! at the interval's ends and between them, at all of [`WAVELENGTHS_NM`], so that no light is lost; a margin covers what lies between the tabulated
//! points.
//!
//! If a sensor point sees several openings, the region is the ellipse about a box that contains them all. The region includes obscured parts.
//!
//! A point (ρ, φ) of the unit disc maps to centre + ρ R(φ) (a cos φ, b sin φ). With samples uniform in the disc, the slope area per sample is π a b
//! R², the inverse of the sampling density; it is part of the weight.

use core::f64::consts::PI;

use glam::DVec2;

use super::bundles::Cell;
use super::opening::{Meridian, PupilOpening};
use crate::lens::search::{max_lit_radius, unit};
use crate::{
    overlap::PRINCIPAL_NM, prescription::Prescription, prescription::indices::Media, prescription::trace::ApertureTest,
};

/// Wavelengths whose bundles the region contains, nm; dispersion is monotone, so bundles in between lie in between.
const WAVELENGTHS_NM: [f64; 3] = [PRINCIPAL_NM, 300.0, 1100.0];

const INTERVALS: usize = 40;
/// Heights sampled per interval, including both ends.
const INTERVAL_SAMPLES: usize = 4;
/// Tabulated directions over half a turn.
const DIRECTIONS: usize = 24;
/// Directions sampled for each tabulated one.
const FINE: usize = 3;
/// Margin factor of R for edges between the sampled points.
const MARGIN: f64 = 1.004;

/// Centre and semi-axes, in slopes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Ellipse {
    pub(super) centre: f64,
    pub(super) axes: DVec2,
}

impl Ellipse {
    fn mix(&self, other: &Self, fraction: f64) -> Self {
        Self {
            centre: self.centre + fraction * (other.centre - self.centre),
            axes: self.axes + (other.axes - self.axes) * fraction,
        }
    }

    fn at(&self, q: DVec2) -> DVec2 {
        DVec2::new(self.centre + self.axes.x * q.x, self.axes.y * q.y)
    }
}

#[derive(Clone, Debug, PartialEq)]
struct Interval {
    ends: [Ellipse; 2],
    /// R at equal steps of φ from 0 to π.
    radius: [f64; DIRECTIONS + 1],
}

/// The regions of all sensor heights.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Regions {
    /// Height beyond which no light arrives, mm.
    pub(super) limit_mm: f64,
    intervals: Vec<Interval>,
}

/// A proposal: slopes, and slope area per sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Proposal {
    pub(super) slope: DVec2,
    pub(super) area: f64,
}

impl Regions {
    /// Determines the regions by tracing, up to `picture_mm` from the axis or the end of the light. `chief` is the chief ray's slope at a height, if
    /// it exists. `None` if the centre of the sensor is dark.
    pub(super) fn new(lens: &Prescription, picture_mm: f64, chief: impl Fn(f64) -> Option<f64>) -> Option<Self> {
        let ellipse_at = |s_mm: f64| ellipse(lens, s_mm, chief(s_mm));
        let limit_mm = max_lit_radius(picture_mm, 2 * INTERVALS, |s_mm| ellipse_at(s_mm).is_some())?;
        let width = limit_mm / INTERVALS as f64;
        // A dark height between lit ones may have any ellipse: nothing passes there.
        let next = |last: &mut Option<Ellipse>, i: usize| {
            *last = ellipse_at(width * i as f64).or(*last);
            *last
        };
        let ellipses: Vec<Ellipse> = (0..=INTERVALS).scan(None, next).collect();
        let interval =
            |(i, ends): (usize, &[Ellipse])| Interval::new(lens, [ends[0], ends[1]], width * i as f64, width);
        let intervals: Vec<Interval> = ellipses.windows(2).enumerate().map(interval).collect();
        (intervals.len() == INTERVALS).then_some(Self { limit_mm, intervals })
    }

    fn interval(&self, s_mm: f64) -> Option<(&Interval, f64)> {
        let place = s_mm / self.limit_mm * INTERVALS as f64;
        let inside = place <= INTERVALS as f64;
        let index = (place as usize).min(INTERVALS - 1);
        inside.then(|| (&self.intervals[index], place - index as f64))
    }

    /// The proposal for a point of the unit disc whose unsigned angle from the meridian is `turn`.
    #[inline]
    pub(super) fn propose(&self, s_mm: f64, disc: DVec2, turn: f64) -> Option<Proposal> {
        let (interval, fraction) = self.interval(s_mm)?;
        let ellipse = interval.ends[0].mix(&interval.ends[1], fraction);
        let radius = interval.radius_at(turn * (DIRECTIONS as f64 / PI));
        let area = PI * ellipse.axes.x * ellipse.axes.y * radius * radius;
        Some(Proposal { slope: ellipse.at(disc * radius), area })
    }

    /// The ellipse at a height; `None` beyond the limit.
    pub(super) fn ellipse(&self, s_mm: f64) -> Option<Ellipse> {
        let (interval, fraction) = self.interval(s_mm)?;
        Some(interval.ends[0].mix(&interval.ends[1], fraction))
    }

    /// The region's own centroid along the meridian, as a slope.
    pub(super) fn centroid(&self, s_mm: f64) -> Option<f64> {
        let (interval, fraction) = self.interval(s_mm)?;
        let ellipse = interval.ends[0].mix(&interval.ends[1], fraction);
        let (mut area, mut moment) = (0.0, 0.0);
        for (i, r) in interval.radius.iter().enumerate() {
            let weight = if i == 0 || i == DIRECTIONS { 0.5 } else { 1.0 };
            area += weight * r * r / 2.0;
            moment += weight * r * r * r / 3.0 * unit(PI * i as f64 / DIRECTIONS as f64).x;
        }
        Some(ellipse.centre + ellipse.axes.x * moment / area)
    }

    /// Slope area of the region at a height.
    pub(super) fn area(&self, s_mm: f64) -> f64 {
        let Some((interval, fraction)) = self.interval(s_mm) else { return 0.0 };
        let ellipse = interval.ends[0].mix(&interval.ends[1], fraction);
        let squares = interval.radius.windows(2).map(|w| (w[0] * w[0] + w[0] * w[1] + w[1] * w[1]) / 3.0);
        ellipse.axes.x * ellipse.axes.y * PI * squares.sum::<f64>() / DIRECTIONS as f64
    }
}

/// The opening of the clear apertures at a height, without obscurations.
fn rim_opening<'a>(lens: &'a Prescription, media: &'a Media, s_mm: f64) -> PupilOpening<'a> {
    let meridian = Meridian::at(s_mm, lens.sensor_position_mm());
    PupilOpening { lens, media, meridian, test: ApertureTest::RimsOnly }
}

/// The passing region at one height, by its interval of the meridian and its width across, at the first wavelength that passes.
pub(super) fn ellipse(lens: &Prescription, s_mm: f64, chief: Option<f64>) -> Option<Ellipse> {
    WAVELENGTHS_NM.into_iter().find_map(|nm| {
        let media = lens.media(nm);
        let opening = rim_opening(lens, &media, s_mm);
        let [low, high] = opening.meridional(chief)?;
        let (centre, half) = (0.5 * (low + high), 0.5 * (high - low));
        let across = match opening.extent().filter(|_| !opening.is_one_piece()) {
            Some(extent) => extent.high.y,
            None => opening.reach(DVec2::new(centre, 0.0), DVec2::new(0.0, half), 8.0, 64, 12) * half,
        };
        Some(Ellipse { centre, axes: DVec2::new(half, across).max(DVec2::splat(1e-9)) })
    })
}

impl Interval {
    fn new(lens: &Prescription, ends: [Ellipse; 2], start_mm: f64, width_mm: f64) -> Self {
        let mut interval = Self { ends, radius: [0.0; DIRECTIONS + 1] };
        for sample in 0..INTERVAL_SAMPLES {
            let fraction = sample as f64 / (INTERVAL_SAMPLES - 1) as f64;
            WAVELENGTHS_NM
                .into_iter()
                .for_each(|nm| interval.include(lens, start_mm + width_mm * fraction, fraction, nm));
        }
        interval.radius.iter_mut().for_each(|r| *r *= MARGIN);
        interval
    }

    /// Raises R until the region contains all that passes at one height and wavelength: first at the tabulated directions, then between them.
    fn include(&mut self, lens: &Prescription, s_mm: f64, fraction: f64, nm: f64) {
        let media = lens.media(nm);
        let opening = rim_opening(lens, &media, s_mm);
        let ellipse = self.ends[0].mix(&self.ends[1], fraction);
        if !opening.is_one_piece() {
            if let Some(Cell { low, high }) = opening.extent() {
                self.include_box(&ellipse, low, high);
            }
            return;
        }
        let reach = |place: f64| {
            let direction = unit(PI * place / DIRECTIONS as f64) * ellipse.axes;
            opening.reach(DVec2::new(ellipse.centre, 0.0), direction, 2.0, 10, 11)
        };
        for i in 0..=DIRECTIONS {
            self.radius[i] = self.radius[i].max(reach(i as f64));
        }
        for fine in (0..DIRECTIONS * FINE).filter(|i| i % FINE != 0) {
            let place = fine as f64 / FINE as f64;
            let missing = reach(place) - self.radius_at(place);
            if missing > 0.0 {
                self.raise(place, missing);
            }
        }
    }

    /// Raises R until the region contains a box.
    fn include_box(&mut self, ellipse: &Ellipse, low: DVec2, high: DVec2) {
        let half_width = (high.x - ellipse.centre).max(ellipse.centre - low.x);
        let corner = (DVec2::new(half_width, high.y) / ellipse.axes).length();
        // Sagitta of the straight lines between the tabulated points.
        let [chord, _] = unit(0.5 * PI / DIRECTIONS as f64).to_array();
        self.radius.iter_mut().for_each(|r| *r = r.max(corner / chord));
    }

    #[inline]
    fn radius_at(&self, place: f64) -> f64 {
        let i = (place as usize).min(DIRECTIONS - 1);
        self.radius[i] + (place - i as f64) * (self.radius[i + 1] - self.radius[i])
    }

    fn raise(&mut self, place: f64, by: f64) {
        let i = (place as usize).min(DIRECTIONS - 1);
        let fraction = place - i as f64;
        // The smallest change of both neighbours that raises the line between them by `by`.
        let scale = by / (fraction * fraction + (1.0 - fraction) * (1.0 - fraction));
        self.radius[i] += scale * (1.0 - fraction);
        self.radius[i + 1] += scale * fraction;
    }
}
