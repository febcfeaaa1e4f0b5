//! Rays through the surfaces of a lens, in either direction.
//!
//! Lens frame: mm, z along the axis from the scene to the sensor, origin at the vertex of the first surface. Rays are straight between surfaces. They
//! may run backwards where surfaces are so curved that the order of their vertices is not the order in which an oblique ray meets them.
//!
//! The lens is unfolded: at a mirror, z of points and directions relative to its vertex is negated, after the reflection for light from the scene,
//! before it for rays from the sensor. Rays therefore meet every mirror in the sense of the light.

use etendue_spectra::glass::Dispersion;
use glam::DVec3;

use super::coating::{Coating, Crossing};
use super::indices::{MAX_MEDIA, Media};
use super::surface::{Shape, Surface, SurfaceHit, SurfaceKind};
use crate::error::PrescriptionError;

/// A ray in the lens frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LensRay {
    /// A point on the ray, mm.
    pub point: DVec3,
    /// Unit direction.
    pub direction: DVec3,
}

/// Reason for the loss of a ray.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RayLossReason {
    /// The ray misses a surface.
    Missed,
    /// The ray meets a surface outside its clear aperture.
    Clipped,
    /// The ray meets a surface within its obscured radius.
    Obscured,
    /// The ray is totally reflected.
    TotalReflection,
}

/// Surface and reason of a lost ray.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RayLoss {
    /// The surface, counted from 0 at the scene.
    pub surface: usize,
    /// Reason.
    pub loss: RayLossReason,
}

/// A surface prepared for tracing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Element {
    pub(super) kind: SurfaceKind,
    pub(super) shape: Shape,
    /// Vertex, mm.
    pub(super) z_mm: f64,
    /// Square of the clear semi-aperture, mm².
    pub(super) open_mm2: f64,
    /// Square of the obscured radius, mm².
    pub(super) obscured_mm2: f64,
    /// Indices into the table of media: the scene's side and the sensor's side.
    pub(super) media: [usize; 2],
    pub(super) coating: Coating,
}

impl Element {
    #[inline]
    pub(super) fn vertex(&self) -> DVec3 {
        DVec3::new(0.0, 0.0, self.z_mm)
    }

    /// Refractive indices before and behind the surface, for a ray in this direction.
    #[inline]
    pub(super) fn indices(&self, direction: TravelDirection, media: &Media) -> [f64; 2] {
        let [a, b] = self.media.map(|i| media[i]);
        if direction == TravelDirection::ToSensor { [a, b] } else { [b, a] }
    }

    /// Squared distance of a hit from the axis over the squared radius of the clear aperture. Within the obscured radius o it is 2 − r²/o², which is
    /// above 1 as well and continuous at the edge.
    #[inline]
    pub(super) fn filling(&self, hit: &SurfaceHit) -> f64 {
        let r2 = hit.point.truncate().length_squared();
        let filling = r2 / self.open_mm2;
        if self.obscured_mm2 > 0.0 { filling.max(2.0 - r2 / self.obscured_mm2) } else { filling }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum TravelDirection {
    ToSensor,
    ToScene,
}

impl TravelDirection {
    #[inline]
    fn sense(self) -> f64 {
        if self == Self::ToSensor { 1.0 } else { -1.0 }
    }
}

/// Treatment of clear apertures and obscurations.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ApertureTest {
    /// Both stop rays.
    Clip,
    /// Clear apertures stop rays, obscurations do not.
    RimsOnly,
    /// Obscurations stop rays, clear apertures do not.
    ObscurationsOnly,
    /// Neither stops rays.
    Ignore,
}

impl ApertureTest {
    #[inline]
    fn check(self, element: &Element, hit: &SurfaceHit) -> Result<(), RayLossReason> {
        let r2 = hit.point.x * hit.point.x + hit.point.y * hit.point.y;
        let (rims, obscurations) = match self {
            Self::Clip => (true, true),
            Self::RimsOnly => (true, false),
            Self::ObscurationsOnly => (false, true),
            Self::Ignore => (false, false),
        };
        let within = r2 <= element.open_mm2;
        if rims && !within {
            Err(RayLossReason::Clipped)
        } else if obscurations && r2 < element.obscured_mm2 {
            Err(RayLossReason::Obscured)
        } else {
            Ok(())
        }
    }
}

/// Visitor of a ray's surface crossings; may stop the ray.
pub(super) trait SurfaceVisitor {
    /// The ray crosses `element` at `hit` with these indices and cosines; false stops it.
    fn crosses(
        &mut self,
        index: usize,
        element: &Element,
        hit: &SurfaceHit,
        crossing: &Crossing,
    ) -> Result<(), RayLossReason>;
}

/// Clear apertures clip as `test` states, coatings attenuate.
pub(super) struct TransmittanceVisitor {
    pub(super) nm: f64,
    pub(super) test: ApertureTest,
    pub(super) transmittance: f64,
}

impl SurfaceVisitor for TransmittanceVisitor {
    #[inline]
    fn crosses(
        &mut self,
        _: usize,
        element: &Element,
        hit: &SurfaceHit,
        crossing: &Crossing,
    ) -> Result<(), RayLossReason> {
        self.test.check(element, hit)?;
        self.transmittance *= element.coating.transmittance(crossing, self.nm);
        Ok(())
    }
}

/// Geometry only.
impl SurfaceVisitor for ApertureTest {
    #[inline]
    fn crosses(&mut self, _: usize, element: &Element, hit: &SurfaceHit, _: &Crossing) -> Result<(), RayLossReason> {
        self.check(element, hit)
    }
}

/// The largest filling of the clear apertures on the way; nothing is clipped.
pub(super) struct ApertureFillingVisitor {
    /// Largest squared distance from the axis over that of the clear aperture; above 1 the ray is clipped.
    pub(super) max_filling: f64,
}

impl SurfaceVisitor for ApertureFillingVisitor {
    #[inline]
    fn crosses(&mut self, _: usize, element: &Element, hit: &SurfaceHit, _: &Crossing) -> Result<(), RayLossReason> {
        self.max_filling = self.max_filling.max(element.filling(hit));
        Ok(())
    }
}

/// Traces `ray` through the surfaces `elements` (numbered from `first`), in the order of its direction.
#[inline]
pub(super) fn walk(
    elements: &[Element],
    first: usize,
    direction: TravelDirection,
    media: &Media,
    mut ray: LensRay,
    journey: &mut impl SurfaceVisitor,
) -> Result<LensRay, RayLoss> {
    let count = elements.len();
    for step in 0..count {
        let index = if direction == TravelDirection::ToSensor { step } else { count - 1 - step };
        let lost = |loss| RayLoss { surface: first + index, loss };
        ray = cross(&elements[index], first + index, direction, media, ray, journey).map_err(lost)?;
    }
    Ok(ray)
}

#[inline]
fn cross(
    element: &Element,
    index: usize,
    travel: TravelDirection,
    media: &Media,
    ray: LensRay,
    journey: &mut impl SurfaceVisitor,
) -> Result<LensRay, RayLossReason> {
    if element.kind == SurfaceKind::Mirror {
        return reflect(element, index, travel, media, ray, journey);
    }
    let hit = meet(element, travel, ray)?;
    let n = element.indices(travel, media);
    let (direction, cosine) = match element.kind {
        SurfaceKind::ThinLens { focal_length_mm } => thin_lens(ray.direction, &hit, focal_length_mm, travel.sense()),
        _ => refract(ray.direction, &hit, n[0] / n[1], travel.sense()).ok_or(RayLossReason::TotalReflection)?,
    };
    journey.crosses(index, element, &hit, &Crossing { n, cosine })?;
    Ok(LensRay { point: hit.point + element.vertex(), direction })
}

/// Intersection of a ray with a surface, relative to its vertex: for a mirror in the space before it.
#[inline]
pub(super) fn meet(element: &Element, travel: TravelDirection, ray: LensRay) -> Result<SurfaceHit, RayLossReason> {
    let from_vertex = ray.point - element.vertex();
    let hit = if element.kind == SurfaceKind::Mirror && travel == TravelDirection::ToScene {
        element.shape.hit(reversed(from_vertex), reversed(ray.direction), 1.0)
    } else {
        element.shape.hit(from_vertex, ray.direction, travel.sense())
    };
    hit.ok_or(RayLossReason::Missed)
}

/// A vector with its z negated.
#[inline]
fn reversed(v: DVec3) -> DVec3 {
    DVec3::new(v.x, v.y, -v.z)
}

/// Reflection by a mirror, d′ = d − 2 (d·n) n, and the reversal of z.
#[inline]
fn reflect(
    element: &Element,
    index: usize,
    travel: TravelDirection,
    media: &Media,
    ray: LensRay,
    journey: &mut impl SurfaceVisitor,
) -> Result<LensRay, RayLossReason> {
    let hit = meet(element, travel, ray)?;
    let to_sensor = travel == TravelDirection::ToSensor;
    let incident = if to_sensor { ray.direction } else { reversed(ray.direction) };
    let along = incident.dot(hit.normal);
    let crossing = Crossing { n: [media[element.media[0]]; 2], cosine: [along.abs(); 2] };
    journey.crosses(index, element, &hit, &crossing)?;
    let reflected = incident - hit.normal * (2.0 * along);
    let (point, direction) =
        if to_sensor { (reversed(hit.point), reversed(reflected)) } else { (hit.point, reflected) };
    Ok(LensRay { point: point + element.vertex(), direction })
}

/// A thin lens of focal length f maps a slope t, along +z, at the point r to t − r/f; and back. Returns the direction and both cosines.
#[inline]
fn thin_lens(d: DVec3, hit: &SurfaceHit, focal_length_mm: f64, sense: f64) -> (DVec3, [f64; 2]) {
    let slope = DVec3::new(d.x / d.z, d.y / d.z, 1.0);
    let direction = (slope - hit.point * (sense / focal_length_mm)).normalize() * sense;
    (direction, [d.z.abs(), direction.z.abs()])
}

/// A ray in direction `way` reflected by a surface: d′ = d − 2 (d·n) n; with the reflectance.
#[inline]
pub(super) fn bounce(
    element: &Element,
    travel: TravelDirection,
    media: &Media,
    ray: LensRay,
    nm: f64,
) -> Result<(LensRay, SurfaceHit, f64), RayLossReason> {
    let hit = meet(element, travel, ray)?;
    let n = element.indices(travel, media);
    let reflectance = match refract(ray.direction, &hit, n[0] / n[1], travel.sense()) {
        Some((_, cosine)) => 1.0 - element.coating.transmittance(&Crossing { n, cosine }, nm),
        None => 1.0,
    };
    let direction = ray.direction - hit.normal * (2.0 * ray.direction.dot(hit.normal));
    Ok((LensRay { point: hit.point + element.vertex(), direction }, hit, reflectance))
}

/// Snell's law: d′ = μ d + (± √(1 − μ²(1 − (d·n)²)) − μ d·n) n with μ = n₁/n₂; and both cosines. `None` for total
/// reflection.
#[inline]
pub(super) fn refract(d: DVec3, hit: &SurfaceHit, mu: f64, sense: f64) -> Option<(DVec3, [f64; 2])> {
    let along = d.dot(hit.normal);
    if mu == 1.0 {
        return Some((d, [along.abs(); 2]));
    }
    let square = 1.0 - mu * mu * (1.0 - along * along);
    if square <= 0.0 {
        return None;
    }
    let beyond = square.sqrt();
    Some((d * mu + hit.normal * (sense * beyond - mu * along), [along.abs(), beyond]))
}

/// The different media of a lens, air first, and for each surface its indices in that list: before it, and behind it.
pub(super) fn media(surfaces: &[Surface]) -> Result<(Vec<Dispersion>, Vec<[usize; 2]>), PrescriptionError> {
    let mut list = vec![Dispersion::AIR];
    let mut before = 0;
    let places = surfaces
        .iter()
        .map(|surface| {
            let known = list.iter().position(|medium| *medium == surface.glass);
            let after = known.unwrap_or_else(|| {
                list.push(surface.glass);
                list.len() - 1
            });
            [core::mem::replace(&mut before, after), after]
        })
        .collect();
    if list.len() > MAX_MEDIA {
        return Err(PrescriptionError::Media { count: list.len(), most: MAX_MEDIA });
    }
    if before == 0 { Ok((list, places)) } else { Err(PrescriptionError::LastMedium) }
}

/// Surfaces prepared for tracing.
pub(super) fn elements(surfaces: &[Surface], places: &[[usize; 2]]) -> Vec<Element> {
    let mut z_mm = 0.0;
    let element = |(surface, media): (&Surface, &[usize; 2])| {
        let element = Element {
            kind: surface.kind,
            shape: surface.shape(),
            z_mm,
            open_mm2: surface.semi_aperture_mm * surface.semi_aperture_mm,
            obscured_mm2: surface.obscured_radius_mm * surface.obscured_radius_mm,
            media: *media,
            coating: surface.coating,
        };
        z_mm += surface.thickness_mm;
        element
    };
    surfaces.iter().zip(places).map(element).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn refraction_keeps_n_sine_and_the_plane_of_incidence() {
        let hit = SurfaceHit { point: DVec3::ZERO, normal: DVec3::new(0.1, -0.2, 1.0).normalize() };
        let d = DVec3::new(0.3, 0.1, 1.0).normalize();
        let (out, cosine) = refract(d, &hit, 1.0 / 1.5, 1.0).expect("into glass");
        let sines = [d, out].map(|v| v.cross(hit.normal).length());
        // Rounding.
        assert!((sines[0] - 1.5 * sines[1]).abs() < 1e-15 && (out.length() - 1.0).abs() < 1e-15);
        assert!(out.cross(hit.normal).normalize().dot(d.cross(hit.normal).normalize()) > 1.0 - 1e-14);
        assert!((cosine[1] - out.dot(hit.normal)).abs() < 1e-15);
        let (back, _) = refract(-out, &hit, 1.5, -1.0).expect("out again");
        assert!((back + d).length() < 1e-15);
    }

    #[test]
    fn beyond_the_critical_angle_nothing_comes_through() {
        let hit = SurfaceHit { point: DVec3::ZERO, normal: DVec3::Z };
        let at = |sine: f64| refract(DVec3::new(sine, 0.0, (1.0 - sine * sine).sqrt()), &hit, 1.5, 1.0);
        assert!(at(1.0 / 1.5 + 1e-9).is_none() && at(1.0 / 1.5 - 1e-9).is_some());
    }
}
