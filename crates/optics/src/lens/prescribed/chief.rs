//! Principal rays: through the centre of the real stop, at 587.56 nm.
//!
//! In the meridional plane the height at which a ray meets the stop is a smooth function of its slope at the sensor; the root is found by secant
//! steps inside a bracket. A table over the sensor heights gives the starting value and the field angle of each height, which is inverted to project
//! a direction.

use core::f64::consts::FRAC_PI_2;

use etendue_core::maths::f64::{atan2, sin_cos};
use glam::{DVec2, DVec3};

use super::opening::Meridian;
use crate::prescription::trace::{ApertureTest, LensRay};
use crate::{lens::FieldAngles, overlap::PRINCIPAL_NM, prescription::Prescription, prescription::indices::Media};

const KNOTS: usize = 128;
/// Slope tolerance of roots: rounding of the tracing itself.
const SLOPE: f64 = 1e-15;
const STEPS: usize = 100;
/// Principal rays are known up to this multiple of the image's radius.
const OVERSCAN: f64 = 1.02;

/// Slopes and field angles of principal rays by height.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct ChiefRays {
    step_mm: f64,
    /// Slope at the sensor, by height.
    slopes: Vec<f64>,
    /// Field angle in front of the lens, rad, by height; increasing.
    angles: Vec<f64>,
}

impl ChiefRays {
    /// Traces slightly beyond `picture_mm` from the axis, or as far as principal rays exist and their angle grows.
    pub(super) fn new(lens: &Prescription, picture_mm: f64) -> Self {
        Self::traced(lens, OVERSCAN * picture_mm, PRINCIPAL_NM, KNOTS)
    }

    /// Traces `knots` heights up to `reach_mm`, at a wavelength.
    pub(super) fn traced(lens: &Prescription, reach_mm: f64, nm: f64, knots: usize) -> Self {
        let media = lens.media(nm);
        let step_mm = reach_mm / (knots - 1) as f64;
        let mut chiefs = Self { step_mm, slopes: vec![0.0], angles: vec![0.0] };
        for i in 1..knots {
            let s_mm = step_mm * i as f64;
            let solved = solve(lens, &media, s_mm, chiefs.guess(s_mm, lens));
            let Some((slope, ray)) = solved.and_then(|t| Some((t, front(lens, &media, s_mm, t)?))) else { break };
            let angle = field_angle(ray.direction);
            if angle <= chiefs.angles[i - 1] {
                break;
            }
            chiefs.slopes.push(slope);
            chiefs.angles.push(angle);
        }
        chiefs
    }

    /// Field angles at equal steps of height, as a table.
    pub(super) fn into_field_angles(self) -> FieldAngles {
        FieldAngles { step_mm: self.step_mm, angles: self.angles }
    }

    /// The largest height that has a principal ray, mm.
    pub(super) fn limit_mm(&self) -> f64 {
        self.step_mm * (self.slopes.len() - 1) as f64
    }

    /// Extrapolated or interpolated slope at a height.
    fn guess(&self, s_mm: f64, lens: &Prescription) -> f64 {
        let place = s_mm / self.step_mm;
        let last = self.slopes.len() - 1;
        if last == 0 {
            // To the paraxial exit pupil.
            return -s_mm / lens.exit_distance_mm();
        }
        let i = (place as usize).min(last - 1);
        self.slopes[i] + (place - i as f64) * (self.slopes[i + 1] - self.slopes[i])
    }

    /// The principal ray's slope at a height; `None` if there is none.
    pub(super) fn slope(&self, lens: &Prescription, s_mm: f64) -> Option<f64> {
        if s_mm == 0.0 {
            return Some(0.0);
        }
        if s_mm > self.limit_mm() * (1.0 + 1e-12) {
            return None;
        }
        solve(lens, &lens.media(PRINCIPAL_NM), s_mm, self.guess(s_mm, lens))
    }

    /// The principal ray of a height in front of the lens, clipped or not.
    pub(super) fn ray(&self, lens: &Prescription, s_mm: f64) -> Option<LensRay> {
        front(lens, &lens.media(PRINCIPAL_NM), s_mm, self.slope(lens, s_mm)?)
    }

    /// The height that sees a field angle, by a bracketed secant search to rounding.
    pub(super) fn height_mm(&self, lens: &Prescription, angle: f64) -> Option<f64> {
        let above = self.angles.partition_point(|a| *a < angle);
        if above == 0 {
            return Some(0.0);
        }
        if above == self.angles.len() {
            return None;
        }
        let error = |s_mm: f64| Some(field_angle(self.ray(lens, s_mm)?.direction) - angle);
        let low = self.step_mm * (above - 1) as f64;
        let ends = [self.angles[above - 1] - angle, self.angles[above] - angle];
        bracketed([low, low + self.step_mm], ends, 1e-13 * self.limit_mm(), error)
    }
}

/// Angle from the axis of a ray towards the scene, rad.
pub(super) fn field_angle(direction: DVec3) -> f64 {
    atan2(direction.truncate().length(), -direction.z)
}

fn front(lens: &Prescription, media: &Media, s_mm: f64, slope: f64) -> Option<LensRay> {
    let ray = Meridian::at(s_mm, lens.sensor_position_mm()).ray(DVec2::new(slope, 0.0));
    lens.passes(ray, media, ApertureTest::Ignore).ok()
}

/// The slope at which a ray from a height meets the stop's centre, near a guess.
fn solve(lens: &Prescription, media: &Media, s_mm: f64, guess: f64) -> Option<f64> {
    let meridian = Meridian::at(s_mm, lens.sensor_position_mm());
    let error = |slope: f64| {
        let at = lens.stop_point(meridian.ray(DVec2::new(slope, 0.0)), media).ok()?;
        Some(meridian.height_mm(at))
    };
    // A bracket about the guess, widened until the signs differ.
    let angle = atan2(guess, 1.0);
    let mut width = 1e-3_f64;
    while width < 0.5 {
        let ends = [angle - width, angle + width].map(|a| tangent(a.clamp(-FRAC_PI_2 + 0.01, FRAC_PI_2 - 0.01)));
        if let [Some(a), Some(b)] = ends.map(error)
            && a * b <= 0.0
        {
            return bracketed(ends, [a, b], SLOPE, error);
        }
        width *= 1.6;
    }
    None
}

fn tangent(angle: f64) -> f64 {
    let (s, c) = sin_cos(angle);
    s / c
}

/// The root of a function between two points where its values `ends` have different signs: the Illinois method (Dowell and Jarratt 1971). It stays
/// inside the bracket and converges superlinearly, until a step is below `tolerance`.
fn bracketed(mut x: [f64; 2], ends: [f64; 2], tolerance: f64, f: impl Fn(f64) -> Option<f64>) -> Option<f64> {
    let mut y = ends;
    for _ in 0..STEPS {
        let step = y[1] * (x[1] - x[0]) / (y[1] - y[0]);
        let next = x[1] - step;
        if !step.is_finite() || step.abs() <= tolerance {
            return Some(if step.is_finite() { next } else { x[1] });
        }
        let value = f(next)?;
        if value * y[1] < 0.0 {
            (x[0], y[0]) = (x[1], y[1]);
        } else {
            y[0] *= 0.5;
        }
        (x[1], y[1]) = (next, value);
    }
    Some(x[1])
}
