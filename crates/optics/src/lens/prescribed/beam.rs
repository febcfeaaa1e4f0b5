//! Rays of one point of the scene, or of one direction, and their landing positions.
//!
//! Rays are identified by where they cross the plane perpendicular to the principal ray through its point nearest to the entrance pupil: q.x in the
//! meridional plane, q.y across it, mm. A source at infinity lights that plane uniformly. A near one is an element of the plane in focus with the
//! same radiance in all directions: cos θ dω.

use core::f64::consts::PI;

use etendue_core::maths::f64::sin_cos;
use glam::{DVec2, DVec3};

use super::bundles::Cell;
use crate::prescription::trace::{ApertureTest, LensRay, TravelDirection};
use crate::{prescription::Prescription, prescription::indices::Media};

/// Points of the first surface that determine the box of its clear aperture: along the radius, and over half a turn.
const RADII: usize = 16;
const TURNS: usize = 48;
/// Margin of that box, relative to its size.
const MARGIN: f64 = 0.01;
/// Tolerance of rays through the centre of the stop, relative to its radius.
const STOP: f64 = 1e-12;
const STEPS: usize = 60;

/// Origin of the rays.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum BeamRaySource {
    /// A direction towards the sensor.
    Direction(DVec3),
    /// A point of the lens frame.
    Point(DVec3),
}

impl BeamRaySource {
    /// The point of the plane in focus on a principal ray (directed towards the scene), or its direction for infinity.
    pub(super) fn from_principal_ray(lens: &Prescription, principal: LensRay) -> Self {
        let plane_mm = lens.paraxial().entrance_pupil_position_mm - lens.focus_distance_m() * 1e3;
        let t = (plane_mm - principal.point.z) / principal.direction.z;
        let ahead = t.is_finite() && t > 0.0;
        if ahead {
            Self::Point(principal.point + principal.direction * t)
        } else {
            Self::Direction(-principal.direction)
        }
    }

    /// The source's ray through a point in front of the lens.
    pub(super) fn through(self, point: DVec3) -> LensRay {
        let direction = match self {
            Self::Direction(direction) => direction,
            Self::Point(source) => (point - source).normalize(),
        };
        LensRay { point, direction }
    }
}

/// The rays of a source at a wavelength.
pub(super) struct Beam<'a> {
    lens: &'a Prescription,
    media: Media,
    source: BeamRaySource,
    origin: DVec3,
    /// The principal ray's direction, towards the sensor, and the meridional direction perpendicular to it.
    ahead: DVec3,
    outward: DVec3,
}

impl<'a> Beam<'a> {
    /// Creates the beam about a principal ray, which is directed towards the scene.
    pub(super) fn new(lens: &'a Prescription, principal: LensRay, nm: f64) -> Self {
        let ahead = -principal.direction;
        let outward = DVec3::new(ahead.z, 0.0, -ahead.x);
        let nearest = DVec3::new(0.0, 0.0, lens.paraxial().entrance_pupil_position_mm);
        let origin = principal.point + ahead * (nearest - principal.point).dot(ahead);
        Self {
            lens,
            media: lens.media(nm),
            source: BeamRaySource::from_principal_ray(lens, principal),
            origin,
            ahead,
            outward,
        }
    }

    pub(super) fn ray(&self, q: DVec2) -> LensRay {
        self.source.through(self.origin + self.outward * q.x + DVec3::Y * q.y)
    }

    /// Filling of the clear apertures by a ray; see [`super::bundles`].
    pub(super) fn filling(&self, q: DVec2) -> Option<f64> {
        self.lens.filling(self.ray(q), TravelDirection::ToSensor, &self.media)
    }

    /// Light per area of the plane, relative to that on the principal ray.
    pub(super) fn light(&self, q: DVec2) -> f64 {
        let BeamRaySource::Point(source) = self.source else { return 1.0 };
        let to = self.origin - source;
        let ray = self.ray(q).direction;
        let cosine = ray.dot(self.ahead);
        // Solid angle cos α/R² with R = R₀/cos α, and the cosine at the element.
        cosine * cosine * cosine * ray.z * to.length() / to.z
    }

    /// Position where a ray meets the sensor plane, clipped or not, mm.
    pub(super) fn sensor_point(&self, q: DVec2) -> Option<DVec2> {
        let out = self.lens.arrives(self.ray(q), &self.media, ApertureTest::Ignore).ok()?;
        let t = (self.lens.sensor_position_mm() - out.point.z) / out.direction.z;
        Some((out.point + out.direction * t).truncate())
    }

    /// A box that contains all rays through the first surface's clear aperture, from the line of symmetry on.
    pub(super) fn bounds(&self) -> Cell {
        let surface = &self.lens.surfaces()[0];
        let height_mm = |i: usize| surface.semi_aperture_mm * i as f64 / RADII as f64;
        let point = |i: usize| {
            let (sine, cosine) = sin_cos(PI * (i % (TURNS + 1)) as f64 / TURNS as f64);
            let r = height_mm(i / (TURNS + 1));
            DVec3::new(r * cosine, r * sine, surface.shape().sag(r).unwrap_or(0.0))
        };
        let start = Cell { low: DVec2::new(f64::INFINITY, 0.0), high: DVec2::NEG_INFINITY };
        let all = (0..(RADII + 1) * (TURNS + 1)).filter_map(|i| self.crossing(point(i)));
        let held = all.fold(start, |b, q| Cell { low: b.low.min(q), high: b.high.max(q) });
        let margin = MARGIN * (held.high - held.low);
        Cell { low: DVec2::new(held.low.x - margin.x, 0.0), high: held.high + margin }
    }

    /// The crossing of the plane by the source's ray through a point.
    fn crossing(&self, point: DVec3) -> Option<DVec2> {
        let ray = self.source.through(point);
        let t = (self.origin - point).dot(self.ahead) / ray.direction.dot(self.ahead);
        let q = point + ray.direction * t - self.origin;
        q.is_finite().then(|| DVec2::new(q.dot(self.outward), q.y))
    }

    /// The meridional ray through the centre of the stop: the chief ray at this wavelength. By secant steps from the principal ray, which is the
    /// chief ray at 587.56 nm.
    pub(super) fn chief(&self) -> Option<DVec2> {
        let missed = |x: f64| {
            let at = self.lens.stop_point_from_scene(self.ray(DVec2::new(x, 0.0)), &self.media).ok()?;
            Some(at.x)
        };
        let stop_mm = self.lens.stop_mm();
        let mut x = [1e-3 * self.lens.paraxial().entrance_radius_mm, 0.0];
        let mut y = [missed(x[0])?, missed(x[1])?];
        for _ in 0..STEPS {
            let next = x[1] - y[1] * (x[1] - x[0]) / (y[1] - y[0]);
            if y[1].abs() <= STOP * stop_mm || !next.is_finite() || next == x[1] {
                break;
            }
            (x, y) = ([x[1], next], [y[1], missed(next)?]);
        }
        (y[1].abs() <= 1e-6 * stop_mm).then(|| DVec2::new(x[1], 0.0))
    }

    /// Focus of two rays next to the principal ray, in its meridional plane or across it: mm behind the sensor.
    pub(super) fn fan_focus_mm(&self, across: bool) -> Option<f64> {
        let (sideways, axis) = if across { (DVec2::Y, DVec3::Y) } else { (DVec2::X, DVec3::X) };
        let step = FAN * self.lens.paraxial().entrance_radius_mm;
        let out = |sign: f64| self.lens.arrives(self.ray(sideways * (sign * step)), &self.media, ApertureTest::Ignore);
        let (a, b) = (out(-1.0).ok()?, out(1.0).ok()?);
        // Heights and slopes across the axis, at the sensor.
        let slope = |ray: &LensRay| ray.direction.dot(axis) / ray.direction.z;
        let height = |ray: &LensRay| ray.point.dot(axis) + (self.lens.sensor_position_mm() - ray.point.z) * slope(ray);
        Some(-(height(&b) - height(&a)) / (slope(&b) - slope(&a)))
    }
}

/// Distance of a fan's rays from the principal ray, in radii of the entrance pupil.
const FAN: f64 = 1e-3;
