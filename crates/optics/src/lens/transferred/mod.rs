//! A camera lens given by its ray-transfer functions: each ray from the sensor is transferred in one step.
//!
//! Irradiance at a sensor point is E = τ ∫ L cos θ dω over the directions that pass; with D the distance of the pupil plane, cos θ dω = cos⁴ θ dA/D²
//! on it. Samples are drawn from an oval that contains everything that passes (`pupils.rs`). A blocked sample carries no light, so vignetting is that
//! of the functions, without bias.
//!
//! - Principal rays go through the centre of the passing region, in the meridian, at 587.56 nm. They start at their point nearest to the centre of
//!   the entrance pupil, which is the origin of the camera frame: the point where principal rays near the axis cross it.
//! - f-number: focal length over the diameter of the entrance pupil of the bundle on the axis, at the sensor position.
//! - Neither pupil is constant: each field point has the pupil of the functions.
//! - [`RayTransferLens::projected_solid_angle_sr`] holds for the wavelength nearest to 587.56 nm, by a quadrature accurate to about 1e-5.
//!
//! Left out: effects outside the functions: absorbing glass, reflecting surfaces (a transmittance stands for both), scatter, the errors of the fit.

mod near_axis;
mod pupils;
mod sight;

use core::f64::consts::TAU;

use etendue_core::{maths::f64::atan2, ray::PupilRay};
use glam::{DVec2, DVec3};

use crate::error::OpticsError;
use crate::lens::paraxial_properties::{Conjugates, ParaxialProperties};
use crate::lens::search::{GAUSS, towards};
use crate::overlap::{PRINCIPAL_NM, positive};
use crate::pupil::{MM, concentric_disc};
use crate::ray_transfer::{RayTransfer, RayTransferError, TransferRay};
use near_axis::FirstOrderProperties;
use pupils::{Oval, Pupils};
use sight::PupilQuery;

/// Position of the sensor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SensorPlace {
    /// Distance behind the last surface, mm.
    Distance(f64),
    /// Distance from the entrance pupil in focus on the axis, m; infinity is legal.
    Focus(f64),
}

/// A lens known by its ray-transfer functions, focused.
#[derive(Clone, Debug, PartialEq)]
pub struct RayTransferLens {
    transfer: RayTransfer,
    transmittance: f64,
    near: FirstOrderProperties,
    pupils: Pupils,
    /// Field angles of principal rays at equal steps of the distance from the axis, up to where they stop increasing.
    angles: Vec<f64>,
}

const KNOTS: usize = 128;
/// Principal rays are known up to this multiple of the image's radius.
const OVERSCAN: f64 = 1.02;
const HALVINGS: usize = 60;
/// Directions of the quadrature over the pupil.
const DIRECTIONS: usize = 96;

impl RayTransferLens {
    /// Creates a lens for images that reach `picture_radius_mm` from the axis; farther out it is dark.
    ///
    /// # Errors
    /// If no light reaches the centre of the sensor, no sensor position is in focus, or a number is outside its range.
    pub fn new(
        transfer: RayTransfer,
        place: SensorPlace,
        transmittance: f64,
        picture_radius_mm: f64,
    ) -> Result<Self, OpticsError> {
        let reach_mm = OVERSCAN * positive("picture_radius_mm", picture_radius_mm)?;
        let transmittance = ParaxialProperties::new(transmittance)?.transmittance;
        let near = match place {
            SensorPlace::Distance(sensor_mm) => FirstOrderProperties::at(&transfer, sensor_mm, reach_mm),
            SensorPlace::Focus(focus_m) => FirstOrderProperties::focused(&transfer, focus_m, reach_mm),
        }?;
        let sight = PupilQuery { transfer: &transfer, sensor_mm: near.sensor_mm, of: None };
        let dark = RayTransferError::Dark { sensor_mm: near.sensor_mm };
        let pupils = Pupils::new(&sight, reach_mm).ok_or(dark)?;
        let mut lens = Self { transfer, transmittance, near, pupils, angles: vec![0.0] };
        for i in 1..KNOTS {
            let angle = lens.field_angle(lens.step_mm() * i as f64);
            match angle.filter(|angle| *angle > lens.angles[i - 1]) {
                Some(angle) => lens.angles.push(angle),
                None => break,
            }
        }
        Ok(lens)
    }

    /// The functions.
    #[must_use]
    pub fn transfer(&self) -> &RayTransfer {
        &self.transfer
    }

    /// Distance from the last surface to the sensor, mm.
    #[must_use]
    pub fn sensor_distance_mm(&self) -> f64 {
        self.near.sensor_mm
    }

    /// The radius about the axis within which light arrives, mm: slightly more than the image's radius, or less if the functions end before.
    #[must_use]
    pub fn lit_radius_mm(&self) -> f64 {
        self.pupils.limit_mm
    }

    /// True if a ray depends on the wavelength.
    #[must_use]
    pub fn disperses(&self) -> bool {
        self.transfer.transfers().len() > 1
    }

    /// The wavelength of first-order quantities, nm: 587.56 or the nearest one of the functions.
    pub(super) fn first_order_nm(&self) -> f64 {
        let known = self.transfer.transfers();
        PRINCIPAL_NM.clamp(known[0].wavelength_nm, known[known.len() - 1].wavelength_nm)
    }

    pub(super) fn focal_length_mm(&self) -> f64 {
        self.near.focal_length_mm
    }

    pub(super) fn entrance_radius_mm(&self) -> f64 {
        self.near.entrance_radius_mm
    }

    pub(super) fn f_number(&self) -> f64 {
        self.near.focal_length_mm / (2.0 * self.near.entrance_radius_mm)
    }

    pub(super) fn transmittance(&self) -> f64 {
        self.transmittance
    }

    /// The focus distance; infinity if the sensor is nearer than the focus of infinity.
    pub(super) fn focus_distance_m(&self) -> f64 {
        if self.near.vergence_per_mm > 0.0 { MM / self.near.vergence_per_mm } else { f64::INFINITY }
    }

    pub(super) fn conjugates(&self) -> Conjugates {
        self.near.conjugates()
    }

    pub(super) fn exit_pupil_distance_mm(&self) -> f64 {
        self.near.exit_mm
    }

    pub(super) fn pupil_magnification(&self) -> f64 {
        self.near.exit_mm / self.near.principal_distance_mm
    }

    pub(super) fn sensor_plane_m(&self) -> f64 {
        -self.near.entrance_mm * MM
    }

    fn step_mm(&self) -> f64 {
        self.pupils.limit_mm / (KNOTS - 1) as f64
    }

    /// The rays that pass at a wavelength, or at any.
    fn query(&self, of: Option<usize>) -> PupilQuery<'_> {
        PupilQuery { transfer: &self.transfer, sensor_mm: self.near.sensor_mm, of }
    }

    pub(super) fn ray(&self, sensor_mm: DVec2, pupil: DVec2, nm: f64) -> Option<PupilRay> {
        let at = film_point(sensor_mm);
        let proposal = self.pupils.propose(at.length(), concentric_disc(pupil))?;
        let meridian = at.normalize_or(DVec2::Y);
        // Across as in `Sight`, where the meridian is the y axis.
        let q = meridian * proposal.q.x + DVec2::new(meridian.y, -meridian.x) * proposal.q.y;
        let entry = self.transfer.entry(at, q, self.near.sensor_mm);
        if !self.transfer.passes(self.transfer.nearest(nm), &entry) {
            return None;
        }
        let ray = self.transfer.exit_ray(&entry, self.near.sensor_mm, nm)?;
        let weight_sr = self.transmittance * proposal.area_mm2 * self.per_area(entry.direction.z);
        Some(PupilRay { origin_m: self.point_m(ray.point_mm), direction: flipped(ray.direction), weight_sr })
    }

    /// cos⁴ θ/D², sr per mm² of the pupil's plane.
    fn per_area(&self, cosine: f64) -> f64 {
        let distance_mm = self.transfer.pupil_distance_mm(self.near.sensor_mm);
        let c2 = cosine * cosine;
        c2 * c2 / (distance_mm * distance_mm)
    }

    /// The principal ray of a distance from the axis, in the plane x = 0 of the lens.
    fn meridian_ray(&self, radius_mm: f64) -> Option<(TransferRay, Oval)> {
        let oval = self.pupils.oval(radius_mm)?;
        Some((self.query(None).meridian_ray(radius_mm, oval.centre_mm, PRINCIPAL_NM)?, oval))
    }

    /// The angle from the axis seen at a distance from it, rad, towards the opposite side of the point.
    fn field_angle(&self, radius_mm: f64) -> Option<f64> {
        if radius_mm == 0.0 {
            return Some(0.0);
        }
        let (ray, _) = self.meridian_ray(radius_mm)?;
        Some(atan2(-ray.direction.y, ray.direction.z))
    }

    pub(super) fn principal_ray(&self, sensor_mm: DVec2) -> Option<PupilRay> {
        let radius_mm = sensor_mm.length();
        let (ray, oval) = self.meridian_ray(radius_mm)?;
        let distance_mm = self.transfer.pupil_distance_mm(self.near.sensor_mm);
        let cosine = distance_mm / DVec2::new(distance_mm, oval.centre_mm - radius_mm).length();
        let area_mm2 = core::f64::consts::PI * oval.axes_mm.x * oval.axes_mm.y;
        let direction = self.direction(sensor_mm)?;
        // On the axis the fit's own errors are not a field angle: the ray is the axis.
        let origin_m = if radius_mm > 0.0 {
            let outwards = sensor_mm / radius_mm;
            let point = self.point_m(ray.point_mm);
            // The plane x = 0 of the lens holds the sensor point (0, radius) of its frame, which is at its negative in the image.
            (outwards * -(ray.point_mm.y * MM)).extend(point.z)
        } else {
            DVec3::ZERO
        };
        let weight_sr = self.transmittance * area_mm2 * self.per_area(cosine);
        Some(PupilRay { origin_m: origin_m - direction * origin_m.dot(direction), direction, weight_sr })
    }

    /// The principal ray's direction in the camera frame.
    pub(super) fn direction(&self, sensor_mm: DVec2) -> Option<DVec3> {
        let radius_mm = sensor_mm.length();
        if radius_mm == 0.0 {
            return Some(DVec3::Z);
        }
        let (ray, _) = self.meridian_ray(radius_mm)?;
        Some((sensor_mm / radius_mm * -ray.direction.y).extend(ray.direction.z))
    }

    /// The sensor point of a direction of the camera frame, mm.
    pub(super) fn project(&self, direction: DVec3) -> Option<DVec2> {
        let across = direction.truncate();
        let angle = atan2(across.length(), direction.z);
        let above = self.angles.partition_point(|a| *a < angle);
        if above == 0 {
            return Some(DVec2::ZERO);
        }
        if above == self.angles.len() {
            return None;
        }
        let mut bracket = [above - 1, above].map(|i| self.step_mm() * i as f64);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (bracket[0] + bracket[1]);
            bracket[usize::from(self.field_angle(middle)? >= angle)] = middle;
        }
        Some(across.normalize_or_zero() * (0.5 * (bracket[0] + bracket[1])))
    }

    pub(super) fn projected_solid_angle_sr(&self, sensor_mm: DVec2) -> f64 {
        let radius_mm = sensor_mm.length();
        let sight = self.query(Some(self.transfer.nearest(PRINCIPAL_NM)));
        let Some(oval) = Oval::about(&sight, radius_mm) else { return 0.0 };
        let (centre, distance_mm) = (DVec2::new(oval.centre_mm, 0.0), sight.distance_mm());
        let along = |i: usize| {
            let step = towards(i, DIRECTIONS) * oval.axes_mm;
            let edge = sight.reach(radius_mm, centre, step, 1.6);
            let at = |t: f64| {
                let off = centre + step * t - DVec2::new(radius_mm, 0.0);
                self.per_area(distance_mm / (distance_mm * distance_mm + off.length_squared()).sqrt()) * t
            };
            GAUSS.iter().map(|[x, weight]| weight * edge * at(x * edge)).sum::<f64>()
        };
        let turn = TAU / DIRECTIONS as f64;
        self.transmittance * oval.axes_mm.x * oval.axes_mm.y * turn * (0..DIRECTIONS).map(along).sum::<f64>()
    }

    /// From the lens's frame (mm, y up, z from the sensor) to the camera frame.
    fn point_m(&self, point: DVec3) -> DVec3 {
        DVec3::new(point.x, -point.y, point.z - self.near.entrance_mm) * MM
    }
}

/// The point of the lens frame that receives the light of a point of the erect image.
fn film_point(sensor_mm: DVec2) -> DVec2 {
    DVec2::new(-sensor_mm.x, sensor_mm.y)
}

/// A direction of the lens's frame in the camera frame.
fn flipped(direction: DVec3) -> DVec3 {
    DVec3::new(direction.x, -direction.y, direction.z)
}
