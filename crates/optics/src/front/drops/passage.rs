//! A ray from the glass through drops into open air, against the light.

use glam::DVec3;

use super::{DropBody, Drops};
use crate::front::MemberRay;
use crate::prescription::coating::{Coating, Crossing};

/// Maximum number of water surfaces met by a ray; longer paths are dark.
const MAX_SURFACES: usize = 16;

/// Search distance for drops along a ray nearly parallel to the glass, mm.
const MAX_SEARCH_MM: f64 = 1e4;

/// The next water surface on a ray.
struct WaterHit {
    drop: usize,
    distance_mm: f64,
}

impl Drops {
    /// The water's index at a wavelength, nm.
    pub(in crate::front) fn index(&self, nm: f64) -> f64 {
        self.parameters.index.at(nm)
    }

    /// The drop that wets a point of the glass.
    pub(in crate::front) fn wetting(&self, point_mm: DVec3) -> Option<usize> {
        let near = self.grid.at(point_mm.truncate()).iter().map(|i| *i as usize);
        near.into_iter().find(|i| {
            let body = &self.bodies[*i];
            point_mm.distance_squared(body.centre_mm) < body.radius_mm * body.radius_mm
        })
    }

    /// Traces a ray that has left the glass into the drop `inside`, or into air, to the open air; returns it with the transmitted fraction. `None` if
    /// it ends in the glass or exceeds the maximum number of surfaces. `normal` is the outward normal of the glass where the ray left it.
    pub(in crate::front) fn leave(
        &self,
        mut line: MemberRay,
        normal: DVec3,
        mut inside: Option<usize>,
        nm: f64,
    ) -> Option<(MemberRay, f64)> {
        let mut left = None;
        let mut fraction = 1.0;
        for _ in 0..MAX_SURFACES {
            match inside {
                Some(drop) => {
                    let body = &self.bodies[drop];
                    line.point_mm = body.surface_from_within(&line)?;
                    let outward = (line.point_mm - body.centre_mm) / body.radius_mm;
                    match refract(&mut line, -outward, [self.index(nm), 1.0], nm) {
                        Some(passed) => {
                            fraction *= passed;
                            // Towards the glass: it sees the region behind it.
                            if line.direction.dot(body.normal) <= 0.0 {
                                return None;
                            }
                            (inside, left) = (None, Some(drop));
                        }
                        None => line.direction -= outward * (2.0 * line.direction.dot(outward)),
                    }
                }
                None => {
                    let Some(hit) = self.ahead(&line, normal, left) else { return Some((line, fraction)) };
                    let body = &self.bodies[hit.drop];
                    line.point_mm += line.direction * hit.distance_mm;
                    let outward = (line.point_mm - body.centre_mm) / body.radius_mm;
                    fraction *= refract(&mut line, outward, [1.0, self.index(nm)], nm)?;
                    inside = Some(hit.drop);
                }
            }
        }
        None
    }

    /// The first drop met by a ray in air, except the one that it has just left: spheres are convex.
    fn ahead(&self, line: &MemberRay, normal: DVec3, left: Option<usize>) -> Option<WaterHit> {
        // Beyond this distance it is higher than all drops: the glass curves away from its tangent plane.
        let rise = line.direction.dot(normal);
        let far_mm = if rise > 0.0 { (self.height_mm / rise).min(MAX_SEARCH_MM) } else { MAX_SEARCH_MM };
        let mut first: Option<WaterHit> = None;
        let end_mm = line.point_mm + line.direction * far_mm;
        self.grid.along(line.point_mm.truncate(), end_mm.truncate(), |drops| {
            for drop in drops.iter().map(|i| *i as usize).filter(|i| Some(*i) != left) {
                let Some(way_mm) = self.bodies[drop].surface_from_outside(line) else { continue };
                if first.as_ref().is_none_or(|hit| way_mm < hit.distance_mm) {
                    first = Some(WaterHit { drop, distance_mm: way_mm });
                }
            }
        });
        first
    }
}

impl DropBody {
    /// The point where a ray from within meets the sphere above the glass; `None` if it meets the glass first.
    fn surface_from_within(&self, line: &MemberRay) -> Option<DVec3> {
        let from = line.point_mm - self.centre_mm;
        let along = from.dot(line.direction);
        let square = along * along - from.length_squared() + self.radius_mm * self.radius_mm;
        let way_mm = square.max(0.0).sqrt() - along;
        let point_mm = line.point_mm + line.direction * way_mm;
        (self.height(point_mm) > 0.0).then_some(point_mm)
    }

    /// Distance of a ray from outside to the sphere above the glass.
    fn surface_from_outside(&self, line: &MemberRay) -> Option<f64> {
        let from = line.point_mm - self.centre_mm;
        let along = from.dot(line.direction);
        let square = along * along - from.length_squared() + self.radius_mm * self.radius_mm;
        let way_mm = -along - square.max(0.0).sqrt();
        let right = square > 0.0 && way_mm > 0.0 && self.height(line.point_mm + line.direction * way_mm) > 0.0;
        right.then_some(way_mm)
    }

    /// Height over the plane of the base, mm.
    fn height(&self, point_mm: DVec3) -> f64 {
        (point_mm - self.foot_mm).dot(self.normal)
    }
}

/// Refracts a ray at a surface whose normal is against it; returns the transmitted fraction, `None` for total reflection.
fn refract(line: &mut MemberRay, against: DVec3, n: [f64; 2], nm: f64) -> Option<f64> {
    let along = -line.direction.dot(against);
    let ratio = n[0] / n[1];
    let square = 1.0 - ratio * ratio * (1.0 - along * along);
    if !(along > 0.0 && square > 0.0) {
        return None;
    }
    let beyond = square.sqrt();
    let direction = line.direction * ratio - against * (beyond - ratio * along);
    line.direction = direction.normalize();
    Some(Coating::Uncoated.transmittance(&Crossing { n, cosine: [along, beyond] }, nm))
}
