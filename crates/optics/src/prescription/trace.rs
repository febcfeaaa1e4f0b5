//! Rays through the surfaces of a lens, in either direction.
//!
//! Lens frame: mm, z along the axis from the scene to the sensor, origin at the vertex of the first surface. Rays are straight between surfaces. They
//! may run backwards where surfaces are so curved that the order of their vertices is not the order in which an oblique ray meets them.

use etendue_spectra::glass::Dispersion;
use glam::DVec3;

use super::coating::{Coating, Crossing};
use super::indices::{MAX_MEDIA, Media};
use super::surface::{Shape, Surface, SurfaceHit};
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
    pub(super) shape: Shape,
    /// Vertex, mm.
    pub(super) z_mm: f64,
    /// Square of the clear semi-aperture, mm².
    pub(super) open_mm2: f64,
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

    /// Squared distance of a hit from the axis over the squared radius of the clear aperture.
    #[inline]
    pub(super) fn filling(&self, hit: &SurfaceHit) -> f64 {
        hit.point.truncate().length_squared() / self.open_mm2
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

/// Treatment of clear apertures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ApertureTest {
    Clip,
    Ignore,
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

/// Clear apertures clip, coatings attenuate.
pub(super) struct TransmittanceVisitor {
    pub(super) nm: f64,
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
        inside(element, hit)?;
        self.transmittance *= element.coating.transmittance(crossing, self.nm);
        Ok(())
    }
}

/// Geometry: clear apertures only, or none.
impl SurfaceVisitor for ApertureTest {
    #[inline]
    fn crosses(&mut self, _: usize, element: &Element, hit: &SurfaceHit, _: &Crossing) -> Result<(), RayLossReason> {
        if *self == Self::Clip { inside(element, hit) } else { Ok(()) }
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

#[inline]
fn inside(element: &Element, hit: &SurfaceHit) -> Result<(), RayLossReason> {
    let r2 = hit.point.x * hit.point.x + hit.point.y * hit.point.y;
    if r2 <= element.open_mm2 { Ok(()) } else { Err(RayLossReason::Clipped) }
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
    let hit = meet(element, travel, ray)?;
    let n = element.indices(travel, media);
    let refracted = refract(ray.direction, &hit, n[0] / n[1], travel.sense());
    let (direction, cosine) = refracted.ok_or(RayLossReason::TotalReflection)?;
    journey.crosses(index, element, &hit, &Crossing { n, cosine })?;
    Ok(LensRay { point: hit.point + element.vertex(), direction })
}

/// Intersection of a ray with a surface, relative to its vertex.
#[inline]
fn meet(element: &Element, direction: TravelDirection, ray: LensRay) -> Result<SurfaceHit, RayLossReason> {
    element.shape.hit(ray.point - element.vertex(), ray.direction, direction.sense()).ok_or(RayLossReason::Missed)
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
            shape: surface.shape(),
            z_mm,
            open_mm2: surface.semi_aperture_mm * surface.semi_aperture_mm,
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
