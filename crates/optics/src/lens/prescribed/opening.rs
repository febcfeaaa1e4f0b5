//! The frame of one sensor point: its meridian, and rays from it by their slopes.
//!
//! A lens of revolution is the same for all sensor points at one distance from the axis. With s that distance, a ray that leaves the sensor is
//! identified by its slopes against the axis: t.x in the meridional plane (away from the axis positive), t.y across it.
//!
//! The part of the rear pupil that is open to a sensor point, found by tracing.
//!
//! In slopes (see [`Meridian`]) the open part at one wavelength is nearly an intersection of discs: one for each clear aperture that clips. It is
//! symmetric about the meridional plane and, being nearly convex, star-shaped about the centre of its interval on that plane. Strong aberrations fold
//! it: a sensor point then sees the scene through several openings, such as a ring about the pupil. A central obscuration makes a ring of it.

use glam::{DVec2, DVec3};

use super::bundles::{Cell, bundles};
use super::quadrature::Area;
use crate::prescription::trace::{ApertureTest, LensRay, TravelDirection};
use crate::{lens::search::last_open, prescription::Prescription, prescription::indices::Media};

/// A sensor point in its meridional frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Meridian {
    /// Distance from the axis, mm.
    pub(super) s_mm: f64,
    /// The unit vector from the axis to the point, in the lens frame.
    outward: DVec2,
    sensor_mm: f64,
}

impl Meridian {
    /// The frame of a point of the upright image; the light itself falls on its negative, or on the point if it forms an erect image.
    pub(super) fn new(point_mm: DVec2, lens: &Prescription) -> Self {
        let outward = (point_mm * -lens.inversion()).normalize_or(DVec2::X);
        Self { s_mm: point_mm.length(), outward, sensor_mm: lens.sensor_position_mm() }
    }

    /// The frame of any point at a distance from the axis.
    pub(super) fn at(s_mm: f64, sensor_mm: f64) -> Self {
        Self { s_mm, outward: DVec2::X, sensor_mm }
    }

    /// The ray with slopes `t`, towards the scene.
    #[inline]
    pub(super) fn ray(&self, t: DVec2) -> LensRay {
        let slope = self.outward * t.x + self.outward.perp() * t.y;
        let point = (self.outward * self.s_mm).extend(self.sensor_mm);
        let direction = DVec3::new(slope.x, slope.y, -1.0) / (1.0 + t.length_squared()).sqrt();
        LensRay { point, direction }
    }

    /// Outward coordinate of a point of the lens frame.
    pub(super) fn height_mm(&self, point: DVec3) -> f64 {
        point.truncate().dot(self.outward)
    }

    /// cos⁴ of the angle of slopes `t`: projected solid angle per slope area, since ∫ cos θ dω = ∫ cos⁴ θ dt.
    #[inline]
    pub(super) fn cos4(t: DVec2) -> f64 {
        let secant2 = 1.0 + t.length_squared();
        1.0 / (secant2 * secant2)
    }
}

/// The opening at one sensor height and wavelength.
pub(super) struct PupilOpening<'a> {
    pub(super) lens: &'a Prescription,
    pub(super) media: &'a Media,
    pub(super) meridian: Meridian,
    pub(super) test: ApertureTest,
}

/// Steps of the search along the meridian: 1/SCAN of the rear opening is the smallest detectable pupil.
const SCAN: usize = 1024;
/// Bisections of the scan's step, and of the edge of an obscuration.
const HALVINGS: usize = 24;
const EDGE_HALVINGS: usize = 40;
/// Positions along a radius at which an opening is tested for gaps.
const GAP_SAMPLES: usize = 20;
/// Positions of the meridional plane, and of a grid across all slopes, at which separate pieces are distinguished.
const PIECES: usize = 256;
const GRID: usize = 96;
/// Margin of the box of all slopes, relative to its width.
const BOX_MARGIN: f64 = 0.01;
/// Rows of a part's first and last quadrature, and the relative change that counts as converged.
const ROWS: usize = 24;
const MAX_ROWS: usize = 192;
const CONVERGED: f64 = 1e-6;

impl PupilOpening<'_> {
    pub(super) fn passes(&self, t: DVec2) -> bool {
        self.lens.passes(self.meridian.ray(t), self.media, self.test).is_ok()
    }

    /// The interval of meridional slopes that passes, from its first to its last point; `None` if none passes. `seed` is a slope likely to be inside
    /// (the chief ray's).
    pub(super) fn meridional(&self, seed: Option<f64>) -> Option<[f64; 2]> {
        let along = |x: f64| self.passes(DVec2::new(x, 0.0));
        let [low, high] = rear_slopes(self.lens, self.meridian.s_mm);
        let at = |i: usize| low + (high - low) * i as f64 / SCAN as f64;
        let scanned = (0..=SCAN).find(|i| along(at(*i))).map(at);
        let first = scanned.or_else(|| seed.filter(|x| along(*x)))?;
        let last = (0..=SCAN).rev().find(|i| along(at(*i))).map_or(first, at);
        let step = (high - low) / SCAN as f64;
        let edge = |inside: f64, sign: f64| last_open([inside, inside + sign * step], HALVINGS, along);
        Some([edge(first, -1.0), edge(last, 1.0)])
    }

    /// The outermost slope that passes from `centre` along `direction`, as a multiple of `direction`: searched inwards from `far` in `steps`, then
    /// refined by `halvings`. 0 if none passes.
    pub(super) fn reach(&self, centre: DVec2, direction: DVec2, far: f64, steps: usize, halvings: usize) -> f64 {
        let along = |r: f64| self.passes(centre + direction * r);
        let step = far / steps as f64;
        let Some(inside) = (0..steps).rev().map(|i| step * i as f64).find(|r| along(*r)) else { return 0.0 };
        last_open([inside, inside + step], halvings, along)
    }

    /// True if the open part of the meridional plane is one piece.
    pub(super) fn is_one_piece(&self) -> bool {
        let [low, high] = rear_slopes(self.lens, self.meridian.s_mm);
        let at = |i: usize| self.passes(DVec2::new(low + (high - low) * i as f64 / PIECES as f64, 0.0));
        let mut begun = [false; 2];
        (0..=PIECES).all(|i| match (at(i), begun) {
            (true, [_, ended]) => {
                begun[0] = true;
                !ended
            }
            (false, [one, _]) => {
                begun[1] = one;
                true
            }
        })
    }

    /// A box of slopes about all pieces, from the meridional plane on, by a grid; enlarged by the grid step. `None` if nothing passes.
    pub(super) fn extent(&self) -> Option<Cell> {
        let Cell { low, high } = self.bounds();
        let step = (high - low) / GRID as f64;
        let column = |i: usize| {
            let x = low.x + step.x * i as f64;
            let y = (0..=GRID).rev().map(|j| step.y * j as f64).find(|y| self.passes(DVec2::new(x, *y)))?;
            Some(DVec2::new(x, y))
        };
        let start = Cell { low: DVec2::INFINITY, high: DVec2::NEG_INFINITY };
        let held = (0..=GRID).filter_map(column);
        let held = held.fold(start, |b, q| Cell { low: b.low.min(q), high: b.high.max(q) });
        held.high.is_finite().then(|| Cell { low: DVec2::new(held.low.x - step.x, 0.0), high: held.high + step })
    }

    /// The interval that passes on the way from `centre` to an edge, as fractions of the way: from 0, or from the edge of an obscuration that hides the
    /// centre. `None` if it has gaps.
    pub(super) fn open_way(&self, centre: DVec2, edge: DVec2) -> Option<[f64; 2]> {
        let at = |i: usize| i as f64 / GAP_SAMPLES as f64;
        let along = |fraction: f64| self.passes(centre + edge * fraction);
        let first = if self.lens.is_obscured() { (0..GAP_SAMPLES).find(|i| along(at(*i)))? } else { 0 };
        if !(first..GAP_SAMPLES).all(|i| along(at(i))) {
            return None;
        }
        let inner = if first == 0 { 0.0 } else { last_open([at(first), at(first - 1)], EDGE_HALVINGS, along) };
        Some([inner, 1.0])
    }

    /// The integral of a function over all that passes, summed over the separate parts.
    pub(super) fn integral(&self, f: &impl Fn(DVec2) -> f64) -> f64 {
        let filling = |t: DVec2| self.lens.filling(self.meridian.ray(t), TravelDirection::ToScene, self.media);
        let parts = bundles(self.bounds(), &filling);
        (0..parts.len()).map(|own| converged(&mut Area::new(&parts, own, filling), f)).sum()
    }

    /// A box of all slopes at which the rear opening can be reached, from the meridional plane on.
    fn bounds(&self) -> Cell {
        let [low, high] = rear_slopes(self.lens, self.meridian.s_mm);
        let [near, _] = self.lens.rear_distances_mm();
        let across = self.lens.surfaces().last().map_or(0.0, |surface| surface.semi_aperture_mm) / near;
        let margin = BOX_MARGIN * (high - low);
        Cell { low: DVec2::new(low - margin, 0.0), high: DVec2::new(high + margin, across + margin) }
    }
}

/// An integral over a part; its rows are doubled until it converges.
fn converged<F: Fn(DVec2) -> Option<f64>>(area: &mut Area<'_, F>, f: &impl Fn(DVec2) -> f64) -> f64 {
    let mut sum = |rows: usize| area.nodes(rows).iter().map(|node| node.area * f(node.q)).sum::<f64>();
    let (mut rows, mut last) = (ROWS, sum(ROWS));
    loop {
        rows *= 2;
        let next = sum(rows);
        if (next - last).abs() <= CONVERGED * next || rows >= MAX_ROWS {
            return next;
        }
        last = next;
    }
}

/// Slopes in the meridional plane at which the rear opening can be reached.
fn rear_slopes(lens: &Prescription, s_mm: f64) -> [f64; 2] {
    let [near, far] = lens.rear_distances_mm();
    let radius = lens.surfaces().last().map_or(0.0, |surface| surface.semi_aperture_mm);
    let corners = [radius - s_mm, -radius - s_mm].map(|y| [y / near, y / far]);
    let all = corners.into_iter().flatten();
    [all.clone().fold(f64::INFINITY, f64::min), all.fold(f64::NEG_INFINITY, f64::max)]
}
