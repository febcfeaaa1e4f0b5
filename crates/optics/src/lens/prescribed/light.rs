//! Samples, weights and special rays of a prescribed lens.

use core::f64::consts::PI;

use etendue_core::ray::PupilRay;
use glam::{DVec2, DVec3};

use super::opening::{Meridian, PupilOpening};
use super::{PrescriptionLens, region::Ellipse};
use crate::lens::search::{GAUSS, unit};
use crate::overlap::PRINCIPAL_NM;
use crate::prescription::trace::{ApertureTest, LensRay};
use crate::pupil::{MM, concentric};

/// Directions over half a turn for the étendue's quadrature.
pub(crate) const DIRECTIONS: usize = 96;

impl PrescriptionLens {
    pub(in crate::lens) fn ray(&self, sensor_mm: DVec2, pupil: DVec2, nm: f64) -> Option<PupilRay> {
        self.tested_ray(sensor_mm, pupil, nm, ApertureTest::Clip)
    }

    /// The same with another treatment of clear apertures and obscurations.
    pub(in crate::lens) fn tested_ray(
        &self,
        sensor_mm: DVec2,
        pupil: DVec2,
        nm: f64,
        test: ApertureTest,
    ) -> Option<PupilRay> {
        let meridian = Meridian::new(sensor_mm, &self.prescription);
        let (disc, turn) = concentric(pupil);
        let proposal = self.regions.propose(meridian.s_mm, disc, turn)?;
        let (ray, transmittance) = self.out(&meridian, proposal.slope, nm, test)?;
        let weight_sr = proposal.area * Meridian::cos4(proposal.slope) * transmittance;
        Some(PupilRay { origin_m: self.point_m(ray.point), direction: flip(ray.direction), weight_sr })
    }

    /// A ray with slopes `t` in front of the lens, and its transmittance through coatings and filter.
    #[inline]
    fn out(&self, meridian: &Meridian, t: DVec2, nm: f64, test: ApertureTest) -> Option<(LensRay, f64)> {
        let ray = meridian.ray(t);
        let (out, transmittance) = self.prescription.to_scene_tested(ray, nm, test).ok()?;
        let filtered = if self.filter.is_none() { 1.0 } else { self.filtered(nm, -ray.direction.z) };
        Some((out, transmittance * filtered))
    }

    pub(in crate::lens) fn principal_ray(&self, sensor_mm: DVec2) -> Option<PupilRay> {
        self.pupil_ray(sensor_mm, self.chiefs.slope(&self.prescription, sensor_mm.length())?)
    }

    /// The ray through the centroid of the open part of the pupil.
    pub(in crate::lens) fn centroid_ray(&self, sensor_mm: DVec2) -> Option<PupilRay> {
        self.pupil_ray(sensor_mm, self.regions.centroid(sensor_mm.length())?)
    }

    /// A meridional ray at 587.56 nm with the whole pupil's weight, from its point nearest to the entrance pupil's centre, obscured or not.
    fn pupil_ray(&self, sensor_mm: DVec2, slope: f64) -> Option<PupilRay> {
        let meridian = Meridian::new(sensor_mm, &self.prescription);
        let t = DVec2::new(slope, 0.0);
        let (ray, transmittance) = self.out(&meridian, t, PRINCIPAL_NM, ApertureTest::RimsOnly)?;
        let weight_sr = self.regions.area(meridian.s_mm) * Meridian::cos4(t) * transmittance;
        let (origin_m, direction) = (self.point_m(ray.point), flip(ray.direction));
        Some(PupilRay { origin_m: origin_m - direction * origin_m.dot(direction), direction, weight_sr })
    }

    /// From the lens frame (mm, z towards the sensor, from the first vertex) to the camera frame.
    fn point_m(&self, point: DVec3) -> DVec3 {
        let z = self.prescription.paraxial().entrance_pupil_position_mm - point.z;
        DVec3::new(point.x, point.y, z) * MM
    }

    pub(crate) fn projected_solid_angle_sr(&self, sensor_mm: DVec2) -> f64 {
        self.projected_solid_angle_at_sr(sensor_mm.length(), PRINCIPAL_NM, DIRECTIONS)
    }

    /// ∫ τ cos⁴ θ dt over all that passes at a wavelength and a distance from the axis: over the single opening of most lenses, or over all of
    /// several.
    pub(crate) fn projected_solid_angle_at_sr(&self, s_mm: f64, nm: f64, directions: usize) -> f64 {
        let Some(ellipse) = self.regions.ellipse(s_mm) else { return 0.0 };
        let media = self.prescription.media(nm);
        let meridian = Meridian::at(s_mm, self.prescription.sensor_position_mm());
        let opening = PupilOpening { lens: &self.prescription, media: &media, meridian, test: ApertureTest::Clip };
        let passing = |t: DVec2| self.passing(&meridian, t, nm);
        over_a_star(&opening, &ellipse, directions, &passing).unwrap_or_else(|| opening.integral(&passing))
    }

    fn passing(&self, meridian: &Meridian, t: DVec2, nm: f64) -> f64 {
        self.out(meridian, t, nm, ApertureTest::Clip)
            .map_or(0.0, |(_, transmittance)| transmittance * Meridian::cos4(t))
    }
}

/// An integral over an opening that is star-shaped about its region's centre, with or without a central obscuration: for a number of directions the
/// edges are found by bisection, then Gauss's rule along the radius and equal steps around. `None` if the opening has a gap along a direction.
fn over_a_star(
    opening: &PupilOpening<'_>,
    ellipse: &Ellipse,
    directions: usize,
    f: &impl Fn(DVec2) -> f64,
) -> Option<f64> {
    let centre = DVec2::new(ellipse.centre, 0.0);
    let edge = |direction: DVec2| {
        let edge = opening.reach(centre, direction, 3.0, 48, 40);
        Some(opening.open_way(centre, direction * edge)?.map(|fraction| fraction * edge))
    };
    for sense in [-1.0, 1.0] {
        edge(DVec2::new(sense * ellipse.axes.x, 0.0))?;
    }
    let sector = |i: usize| {
        let direction = unit(PI * (i as f64 + 0.5) / directions as f64) * ellipse.axes;
        let [inner, outer] = edge(direction)?;
        if inner == 0.0 {
            let along = |[x, w]: [f64; 2]| w * x * f(centre + direction * (outer * x));
            return Some(outer * outer * GAUSS.into_iter().map(along).sum::<f64>());
        }
        let radius = |x: f64| inner + (outer - inner) * x;
        let along = |[x, w]: [f64; 2]| w * radius(x) * f(centre + direction * radius(x));
        Some((outer - inner) * GAUSS.into_iter().map(along).sum::<f64>())
    };
    let turn = 2.0 * PI / directions as f64;
    let sum = (0..directions).map(sector).sum::<Option<f64>>()?;
    Some(ellipse.axes.x * ellipse.axes.y * turn * sum)
}

/// A direction of the lens frame in the camera frame.
fn flip(direction: DVec3) -> DVec3 {
    DVec3::new(direction.x, direction.y, -direction.z)
}
