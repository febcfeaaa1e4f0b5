//! Clear semi-apertures for a lens file that states none: as large as the light of its field points needs.
//!
//! The method of lens-design programs: chief and marginal rays of every field, real ones, aimed at the real stop. Here the rays lie in the meridional
//! plane. Each begins at its point of the stop, and its slope there is searched so that it reaches the field point; a surface's semi-aperture is the
//! largest height at which one of them crosses it. Vignetting factors remove part of the stop at its upper and lower ends, field by field. Rays
//! outside the meridional plane are not traced: where both ends of the bundle are vignetted by more than about nine tenths, they might need a little
//! more.

use core::f64::consts::PI;

use etendue_core::maths::f64::{atan2, sin_cos};
use glam::DVec3;

use super::surface::{Surface, SurfaceHit};
use super::trace::{ApertureTest, Element, LensRay, RayLossReason, SurfaceVisitor, TravelDirection, walk};
use super::{Media, Prescription, coating::Crossing};

/// A point of the field in the meridional plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FieldPoint {
    /// A direction: the angle from the axis, rad, positive where its light rises on its way to the sensor.
    Angle(f64),
    /// A point of a near plane.
    Object {
        /// Distance from the axis, mm.
        height_mm: f64,
        /// Distance of the plane before the first vertex, mm.
        distance_mm: f64,
    },
    /// Image height in the sensor plane, mm.
    Image(f64),
}

/// A field point and the lit fraction of the stop's radius.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FieldBundle {
    /// Origin of its light.
    pub point: FieldPoint,
    /// Fractions of the stop's radius from its centre to the upper and to the lower marginal ray.
    pub reach: [f64; 2],
}

/// Step of the slope search, rad, and its limit on either side of the axis.
const STEP: f64 = 0.25 * PI / 180.0;
const MAX_SLOPE_RAD: f64 = 85.0 * PI / 180.0;
/// Bisections of that step, down to rounding.
const HALVINGS: usize = 50;

/// The heights of the rays at every surface, mm; the stop's is `stop_mm`.
struct Heights {
    max_mm: Vec<f64>,
}

impl SurfaceVisitor for Heights {
    fn crosses(&mut self, index: usize, _: &Element, hit: &SurfaceHit, _: &Crossing) -> Result<(), RayLossReason> {
        let maximum = &mut self.max_mm[index];
        *maximum = maximum.max(hit.point.truncate().length());
        Ok(())
    }
}

/// The clear semi-apertures, mm, that bundles need at some wavelengths with the stop open to `stop_mm`. Clear apertures of the lens itself are
/// ignored: it may be nearly closed. For a bundle that does not pass, returns its index in the list.
///
/// # Errors
/// If a chief or marginal ray misses a surface or is totally reflected, or no ray reaches the field point.
pub fn clear_apertures_mm(
    lens: &Prescription,
    stop_mm: f64,
    bundles: &[FieldBundle],
    wavelengths_nm: &[f64],
) -> Result<Vec<f64>, usize> {
    let mut heights = Heights { max_mm: vec![0.0; lens.surfaces.len()] };
    for nm in wavelengths_nm {
        let stop = StopRays { lens, media: lens.media(*nm) };
        for (i, bundle) in bundles.iter().enumerate() {
            stop.trace(bundle, stop_mm, &mut heights).ok_or(i)?;
        }
    }
    heights.max_mm[lens.stop] = stop_mm;
    Ok(heights.max_mm)
}

/// Meridional rays from the stop, at a wavelength.
struct StopRays<'a> {
    lens: &'a Prescription,
    media: Media,
}

impl StopRays<'_> {
    /// Traces chief and marginal rays of a bundle.
    fn trace(&self, bundle: &FieldBundle, stop_mm: f64, heights: &mut Heights) -> Option<()> {
        let [upper, lower] = bundle.reach;
        let chief = self.aimed(bundle.point, 0.0, 0.0)?;
        for height_mm in [0.0, upper * stop_mm, -lower * stop_mm] {
            let angle = self.aimed(bundle.point, height_mm, chief)?;
            self.out(height_mm, angle, heights)?;
            self.image(height_mm, angle, heights)?;
        }
        Some(())
    }

    /// The ray on the scene's side of the stop, from a height at an angle to the axis.
    fn ray(&self, height_mm: f64, angle: f64) -> Option<LensRay> {
        let element = &self.lens.elements[self.lens.stop];
        let point = DVec3::new(height_mm, 0.0, element.shape.sag(height_mm.abs())?) + element.vertex();
        let (sine, cosine) = sin_cos(angle);
        Some(LensRay { point, direction: DVec3::new(-sine, 0.0, -cosine) })
    }

    /// The ray in front of the lens, towards the scene.
    fn out(&self, height_mm: f64, angle: f64, journey: &mut impl SurfaceVisitor) -> Option<LensRay> {
        let before = &self.lens.elements[..self.lens.stop];
        walk(before, 0, TravelDirection::ToScene, &self.media, self.ray(height_mm, angle)?, journey).ok()
    }

    /// Position where it meets the sensor plane, mm.
    fn image(&self, height_mm: f64, angle: f64, journey: &mut impl SurfaceVisitor) -> Option<f64> {
        let mut ray = self.ray(height_mm, angle)?;
        ray.direction = -ray.direction;
        let behind = &self.lens.elements[self.lens.stop..];
        let out = walk(behind, self.lens.stop, TravelDirection::ToSensor, &self.media, ray, journey).ok()?;
        Some(out.point.x + (self.lens.sensor_position_mm - out.point.z) * out.direction.x / out.direction.z)
    }

    /// The distance by which a ray misses its field point: an angle, or mm.
    fn missed(&self, point: FieldPoint, height_mm: f64, angle: f64) -> Option<f64> {
        let missed = match point {
            FieldPoint::Angle(rad) => {
                let direction = self.out(height_mm, angle, &mut ApertureTest::Ignore)?.direction;
                atan2(-direction.x, -direction.z) - rad
            }
            FieldPoint::Object { height_mm: wanted_mm, distance_mm } => {
                let LensRay { point, direction } = self.out(height_mm, angle, &mut ApertureTest::Ignore)?;
                point.x + (-distance_mm - point.z) * direction.x / direction.z - wanted_mm
            }
            FieldPoint::Image(wanted_mm) => self.image(height_mm, angle, &mut ApertureTest::Ignore)? - wanted_mm,
        };
        Some(missed).filter(|x| x.is_finite())
    }

    /// The angle at the stop at which a ray reaches the field point: of several the one nearest to a guess.
    fn aimed(&self, point: FieldPoint, height_mm: f64, guess: f64) -> Option<f64> {
        let missed = |angle: f64| self.missed(point, height_mm, angle);
        let at_guess = missed(guess);
        if at_guess == Some(0.0) {
            return Some(guess);
        }
        let mut last = [(guess, at_guess); 2];
        let steps = (2.0 * MAX_SLOPE_RAD / STEP) as usize;
        for i in 1..=steps {
            for (side, sign) in [1.0, -1.0].into_iter().enumerate() {
                let next = guess + sign * STEP * i as f64;
                if next.abs() > MAX_SLOPE_RAD {
                    continue;
                }
                let (before, value) = (last[side], missed(next));
                last[side] = (next, value);
                if let (Some(a), Some(b)) = (before.1, value)
                    && a * b <= 0.0
                {
                    return halved([before.0, next], b, missed);
                }
            }
        }
        None
    }
}

/// The root between two positions by bisection; `b` is the value at the second.
fn halved(mut ends: [f64; 2], b: f64, f: impl Fn(f64) -> Option<f64>) -> Option<f64> {
    for _ in 0..HALVINGS {
        let middle = 0.5 * (ends[0] + ends[1]);
        ends[usize::from(f(middle)? * b > 0.0)] = middle;
    }
    Some(ends[1])
}

/// A clear semi-aperture, mm, valid for every surface while first-order quantities are computed.
#[must_use]
pub fn provisional_mm(surfaces: &[Surface]) -> f64 {
    /// Fraction of the smallest radius of curvature, or of a millimetre.
    const PART: f64 = 0.01;
    surfaces.iter().map(|s| s.radius_mm.abs()).fold(1.0, f64::min) * PART
}
