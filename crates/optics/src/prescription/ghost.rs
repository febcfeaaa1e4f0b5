//! Ghosts: light reflected by two surfaces on its way to the sensor.
//!
//! Each of the n (n − 1)/2 pairs of n reflecting surfaces has a path: through the lens to the `rear` surface, back to the `front` one, and on to the
//! sensor. A surface reflects what its coating does not transmit (coatings do not absorb): by Fresnel's equations if uncoated, everything beyond the
//! critical angle. The sensor itself may be the rear one: a mirror in its plane. Mirrors of the lens reflect on every path; they are not among the pairs.
//!
//! **First order** (Gauss): with signed indices, negative for light that travels back, a mirror is a surface at which n becomes −n, of power −2 n c,
//! and reduced distances stay positive.
//!
//! **Left out**: four reflections and more (about R² of these), polarisation between the surfaces, light reflected by lens edges and barrel.

use etendue_core::maths::f64::sin_cos;
use glam::{DVec2, DVec3};

use super::surface::{SurfaceHit, SurfaceKind};
use super::trace::{Element, LensRay, RayLoss, RayLossReason, SurfaceVisitor, TravelDirection, bounce, walk};
use super::{Prescription, coating::Crossing, indices::Media, paraxial::Matrix, paraxial::power};

/// Two surfaces, counted from 0 at the scene, between which light is reflected.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct GhostPair {
    /// Second reflecting surface: the one nearer to the scene.
    pub front: usize,
    /// First reflecting surface: the one nearer to the sensor; the number of surfaces stands for the sensor.
    pub rear: usize,
}

/// A ray after two reflections.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GhostRay {
    /// The ray behind the last surface.
    pub ray: LensRay,
    /// The transmitted fraction of the light, ignoring clear apertures.
    pub weight: f64,
    /// Largest squared distance from the axis over that of the clear aperture: above 1 the ray is clipped.
    pub filling: f64,
}

/// First-order ghost of a source at infinity: a ray that enters the plane of the first vertex at a height h with a slope u lands at [`Self::spread`]
/// h + [`Self::throw_mm`] u.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GhostFirstOrder {
    /// Height on the sensor per height on the plane of the first vertex.
    pub spread: f64,
    /// Height on the sensor per slope of the entering ray, mm.
    pub throw_mm: f64,
    /// Focus of the ghost, mm behind the sensor.
    pub focus_mm: f64,
}

/// Records weights and the filling of clear apertures; nothing is clipped.
struct GhostVisitor {
    nm: f64,
    weight: f64,
    filling: f64,
}

impl SurfaceVisitor for GhostVisitor {
    #[inline]
    fn crosses(
        &mut self,
        _: usize,
        element: &Element,
        hit: &SurfaceHit,
        crossing: &Crossing,
    ) -> Result<(), RayLossReason> {
        self.filling = self.filling.max(element.filling(hit));
        self.weight *= element.coating.transmittance(crossing, self.nm);
        Ok(())
    }
}

impl GhostVisitor {
    fn bounce(
        &mut self,
        elements: &[Element],
        at: usize,
        direction: TravelDirection,
        media: &Media,
        ray: LensRay,
    ) -> Result<LensRay, RayLoss> {
        let bounced = bounce(&elements[at], direction, media, ray, self.nm);
        let (ray, hit, reflectance) = bounced.map_err(|loss| RayLoss { surface: at, loss })?;
        self.filling = self.filling.max(elements[at].filling(&hit));
        self.weight *= reflectance;
        Ok(ray)
    }
}

impl Prescription {
    /// All pairs of partly reflecting surfaces; with the sensor if it reflects.
    #[must_use]
    pub fn ghost_pairs(&self, with_sensor: bool) -> Vec<GhostPair> {
        let reflects = |e: &Element| e.media[0] != e.media[1];
        let mut list: Vec<usize> = (0..self.elements.len()).filter(|i| reflects(&self.elements[*i])).collect();
        list.extend(with_sensor.then_some(self.elements.len()));
        let pairs = |(i, rear): (usize, &usize)| {
            list[..i].iter().map(|front| GhostPair { front: *front, rear: *rear }).collect::<Vec<_>>()
        };
        list.iter().enumerate().flat_map(pairs).collect()
    }

    /// Traces a ray from the scene (its direction towards the sensor) through two reflections to behind the last surface. A sensor as rear surface
    /// reflects everything: the caller multiplies by its reflectance.
    ///
    /// # Errors
    /// If it misses a surface or is totally reflected where it should pass.
    pub fn ghost(&self, pair: GhostPair, ray: LensRay, nm: f64) -> Result<GhostRay, RayLoss> {
        self.ghost_in(pair, ray, nm, &self.media(nm))
    }

    pub(crate) fn ghost_in(&self, pair: GhostPair, ray: LensRay, nm: f64, media: &Media) -> Result<GhostRay, RayLoss> {
        let GhostPair { front, rear } = pair;
        let elements = &self.elements;
        let mut note = GhostVisitor { nm, weight: 1.0, filling: 0.0 };
        let ray = walk(&elements[..rear], 0, TravelDirection::ToSensor, media, ray, &mut note)?;
        let ray = match rear == elements.len() {
            true => self.off_sensor(ray),
            false => note.bounce(elements, rear, TravelDirection::ToSensor, media, ray)?,
        };
        let ray = walk(&elements[front + 1..rear], front + 1, TravelDirection::ToScene, media, ray, &mut note)?;
        let ray = note.bounce(elements, front, TravelDirection::ToScene, media, ray)?;
        let ray = walk(&elements[front + 1..], front + 1, TravelDirection::ToSensor, media, ray, &mut note)?;
        Ok(GhostRay { ray, weight: note.weight, filling: note.filling })
    }

    fn off_sensor(&self, ray: LensRay) -> LensRay {
        let t = (self.sensor_position_mm - ray.point.z) / ray.direction.z;
        let LensRay { point, direction: d } = ray;
        LensRay { point: point + d * t, direction: DVec3::new(d.x, d.y, -d.z) }
    }

    /// The reflectance of both surfaces of a pair: the product of the means at normal incidence and at n sin θ = 0.6. It gives the variation of a
    /// ghost's colour with wavelength, apart from its geometry.
    pub(crate) fn ghost_colour(&self, pair: GhostPair, nm: f64) -> f64 {
        let media = self.media(nm);
        let reflects = |i: usize| self.elements.get(i).map_or(1.0, |element| typical(element, &media, nm));
        reflects(pair.front) * reflects(pair.rear)
    }

    /// A box about half of the first surface's clear aperture (v ≥ 0) as seen by light at an angle to the axis, mm from its vertex: u in the
    /// meridional plane, v across it.
    pub(crate) fn front_box(&self, angle: f64) -> [DVec2; 2] {
        let (sine, cosine) = sin_cos(angle);
        let rim_mm = self.surfaces[0].semi_aperture_mm;
        let shape = self.elements[0].shape;
        let ends = (-8..=8)
            .map(|i| rim_mm * f64::from(i) / 8.0)
            .map(|r| r * cosine - shape.sag(r.abs()).unwrap_or(0.0) * sine);
        let (low, high) = ends.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), u| (a.min(u), b.max(u)));
        [DVec2::new(low, 0.0), DVec2::new(high, rim_mm)]
    }

    /// First order of a pair's ghost at a wavelength.
    #[must_use]
    pub fn ghost_first_order(&self, pair: GhostPair, nm: f64) -> GhostFirstOrder {
        let m = self.folded_matrix(pair, &self.media(nm));
        GhostFirstOrder { spread: m.a, throw_mm: m.b, focus_mm: -m.a / m.c }
    }

    /// The matrix from the plane of the first vertex through both reflections to the sensor.
    fn folded_matrix(&self, pair: GhostPair, media: &Media) -> Matrix {
        let forward = |range: core::ops::Range<usize>| range.map(|i| (i, true));
        let mirrors_and_surfaces = forward(0..pair.rear + 1)
            .chain((pair.front + 1..pair.rear).rev().map(|i| (i, false)))
            .chain([(pair.front, false)])
            .chain(forward(pair.front + 1..self.elements.len()));
        let (mut m, mut z_mm, mut index, mut turned) = (Matrix::IDENTITY, 0.0, 1.0_f64, 0);
        for (i, to_sensor) in mirrors_and_surfaces {
            let (vertex_mm, curvature) =
                self.elements.get(i).map_or((self.sensor_position_mm, 0.0), |e| (e.z_mm, e.shape.vertex_curvature()));
            m = m.moved((vertex_mm - z_mm) / index);
            // The lens is unfolded: its own mirrors keep the index, and have their power in either direction.
            if let Some(e) = self.elements.get(i).filter(|e| e.kind != SurfaceKind::Refracting) {
                m = m.refracted(power(e, media));
                z_mm = vertex_mm;
                continue;
            }
            let mirror = (turned == 0 && i == pair.rear) || (turned == 1 && i == pair.front);
            let behind = match (mirror, self.elements.get(i)) {
                (false, Some(e)) => media[e.media[usize::from(to_sensor)]] * if to_sensor { 1.0 } else { -1.0 },
                _ => -index,
            };
            turned += u32::from(mirror);
            m = m.refracted((behind - index) * curvature);
            (z_mm, index) = (vertex_mm, behind);
        }
        m.moved((self.sensor_position_mm - z_mm) / index)
    }
}

/// Mean reflectance of a surface at normal incidence and at n sin θ = 0.6.
fn typical(element: &Element, media: &Media, nm: f64) -> f64 {
    const INVARIANT: f64 = 0.6;
    let n = element.indices(TravelDirection::ToSensor, media);
    let oblique = n.map(|n| (1.0 - (INVARIANT / n) * (INVARIANT / n)).sqrt());
    let reflectance = |cosine: [f64; 2]| 1.0 - element.coating.transmittance(&Crossing { n, cosine }, nm);
    0.5 * (reflectance([1.0; 2]) + reflectance(oblique))
}
