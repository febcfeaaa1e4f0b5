//! A thick lens to first order: two principal planes, two pupils, two apertures.
//!
//! # Parameters (keys of `[lens]`)
//!
//! One axis carries all positions: **millimetres from the front principal plane H, positive towards the sensor.**
//!
//! | key | meaning | default |
//! | --- | --- | --- |
//! | `focal_length_mm` | f > 0 | required |
//! | `f_number` | N = f / diameter of the entrance pupil | required |
//! | `focus_distance_m` | plane in focus, from the **entrance pupil** (the camera frame's depth); infinity is legal | required |
//! | `transmittance` | τ in (0, 1] | 1 |
//! | `principal_separation_mm` | position of the rear principal plane H′; any sign | 0 |
//! | `entrance_pupil_mm` | position p of the entrance pupil | one of these three |
//! | `exit_pupil_mm` | position of the exit pupil, p′ behind H′: separation + p′ | at most; without |
//! | `pupil_magnification` | m_p = exit / entrance diameter, > 0 | any, m_p = 1 |
//! | `constant_pupil` | `"entrance"` or `"exit"`: the pupil that keeps its area over the field | required |
//! | `front_aperture`, `rear_aperture` | `{ position_mm, radius_mm }`: round clipping apertures before and behind the lens | none |
//!
//! # Consistency
//!
//! Both pupils are images of one stop, so each is the image of the other: p′ = p f/(f + p) and m_p = p′/p = f/(f + p) = 1 − p′/f. One of the three
//! keys therefore determines the others: p = f (1/m_p − 1), p′ = f (1 − m_p). Several keys are legal if they agree (to 1e-6 in m_p); a contradiction
//! is refused.
//!
//! # Light
//!
//! A point of the exit pupil is imaged to the point of the entrance pupil 1/m_p times as far from the axis; a sensor point is imaged to the plane in
//! focus; the ray joins both image points. The exit pupil is m_p c from the sensor (c of `focus.rs`), so on the axis E = π τ L / (1 + 4N²(1 −
//! m/m_p)²) with m < 0 for a real image: the classical form with the **flat-disc convention** tan θ′ = 1/(2N (1 − m/m_p)).
//!
//! Off the axis a flat disc of fixed size cannot be both pupils at once (étendue would not be conserved; the two choices differ by a factor of 1.52
//! at 30° for m_p = 2), so the lens states the pupil that keeps its area:
//! - `exit`: the exit pupil keeps its radius; irradiance falls with cos⁴ θ′ of the angle in image space.
//! - `entrance`: the entrance pupil keeps its radius; irradiance falls with cos⁴ θ of the field angle (times the area ratio of the distortion).
//!
//! The other pupil's radius is then scaled by √g or 1/√g, g = cos⁴θ · (ideal area per observed area) / cos⁴θ′, which
//! conserves étendue along the chief ray.
//!
//! The apertures clip the straight rays (object-side ray at the front aperture, image-side ray at the rear aperture). Mechanical vignetting is the
//! intersection of the pupil and the projected apertures, three circles whose centres lie on one line. An aperture that clips on the axis is refused,
//! because the f-number would not hold.
//!
//! With m_p = 1, no apertures and no distortion this is the thin lens. Left out: aberrations, dispersion, diffraction, and
//! telecentric lenses (a pupil at infinity).

use etendue_core::ray::PupilRay;
use glam::DVec2;

use super::paraxial_properties::{Conjugates, ParaxialProperties, PupilParameters, PupilSize};
use crate::error::OpticsError;
use crate::overlap::{Disc, PRINCIPAL_NM, clipped_etendue_sr, finite, open_centroid, positive};
use crate::pupil::{MM, Pencil, PupilView, concentric_disc};

/// Parameters of a thick lens. Positions: mm from the front principal plane, positive towards the sensor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ThickParameters {
    pub focal_length_mm: f64,
    /// f-number N: focal length over the diameter of the entrance pupil.
    pub f_number: f64,
    /// Distance of the plane in focus from the entrance pupil, m; infinity is legal.
    pub focus_distance_m: f64,
    /// Transmittance, (0, 1].
    pub transmittance: f64,
    /// Position of the rear principal plane, mm.
    pub principal_separation_mm: f64,
    /// Statements about the pupils.
    pub pupils: PupilParameters,
    /// The pupil that keeps its area over the field.
    pub constant_pupil: ConstantPupil,
    /// Aperture before the lens.
    pub front_aperture: Option<ClippingAperture>,
    /// Aperture behind the lens.
    pub rear_aperture: Option<ClippingAperture>,
}

/// The pupil whose area does not change over the field.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ConstantPupil {
    /// The entrance pupil: irradiance falls with cos⁴ of the field angle.
    Entrance,
    /// The exit pupil: irradiance falls with cos⁴ of the angle in image space.
    Exit,
}

/// A round aperture centred on the axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClippingAperture {
    pub position_mm: f64,
    pub radius_mm: f64,
}

/// A thick lens.
#[derive(Clone, Debug, PartialEq)]
pub struct Thick {
    pub(super) properties: ParaxialProperties,
    parameters: ThickParameters,
    pub(super) conjugates: Conjugates,
    pub(super) size: PupilSize,
    pub(super) pupil_magnification: f64,
    apertures: ClippingApertures,
}

/// The front and rear apertures relative to the pupils; distances in mm.
#[derive(Clone, Copy, Debug, PartialEq)]
struct ClippingApertures {
    /// Distance from the entrance pupil towards the scene, and radius.
    front: Option<[f64; 2]>,
    /// Distance from the exit pupil towards the sensor, and radius.
    rear: Option<[f64; 2]>,
}

/// The bundle of one sensor point.
struct PointBundle {
    pencil: Pencil,
    /// The exit pupil as seen from the sensor point.
    view: PupilView,
    entrance_radius_mm: f64,
}

impl Thick {
    /// Creates a thick lens.
    ///
    /// # Errors
    /// If a parameter is outside its range, statements contradict each other, or an aperture clips on the axis.
    pub fn new(parameters: ThickParameters) -> Result<Self, OpticsError> {
        let p = &parameters;
        let size = PupilSize::new(p.focal_length_mm, p.f_number)?;
        finite("principal_separation_mm", p.principal_separation_mm)?;
        let pupil_magnification = p.pupils.magnification(p.focal_length_mm, p.principal_separation_mm)?;
        let conjugates = Conjugates::new(p.focal_length_mm, pupil_magnification, p.focus_distance_m)?;
        let properties = ParaxialProperties::new(p.transmittance)?;
        let mut lens = Self {
            properties,
            parameters,
            conjugates,
            size,
            pupil_magnification,
            apertures: ClippingApertures { front: None, rear: None },
        };
        lens.apertures.front = p.front_aperture.map(|aperture| lens.front_aperture(aperture)).transpose()?;
        lens.apertures.rear = p.rear_aperture.map(|aperture| lens.rear_aperture(aperture)).transpose()?;
        Ok(lens)
    }

    /// Construction parameters.
    #[must_use]
    pub fn parameters(&self) -> &ThickParameters {
        &self.parameters
    }

    /// Exit over entrance diameter.
    #[must_use]
    pub fn pupil_magnification(&self) -> f64 {
        self.pupil_magnification
    }

    /// Position of the entrance pupil, mm behind the front principal plane.
    #[must_use]
    pub fn entrance_pupil_position_mm(&self) -> f64 {
        self.parameters.focal_length_mm * (1.0 / self.pupil_magnification - 1.0)
    }

    /// Position of the exit pupil, mm behind the front principal plane.
    #[must_use]
    pub fn exit_pupil_position_mm(&self) -> f64 {
        self.parameters.principal_separation_mm + self.parameters.focal_length_mm * (1.0 - self.pupil_magnification)
    }

    /// Position of the sensor, mm behind the front principal plane.
    #[must_use]
    pub fn sensor_position_mm(&self) -> f64 {
        self.exit_pupil_position_mm() + self.exit_distance_mm()
    }

    /// Distance from exit pupil to sensor, mm.
    fn exit_distance_mm(&self) -> f64 {
        self.pupil_magnification * self.conjugates.principal_distance_mm
    }

    pub(super) fn ray(&self, sensor_mm: DVec2, pupil: DVec2, nm: f64) -> Option<PupilRay> {
        self.through(sensor_mm, concentric_disc(pupil), nm)
    }

    pub(super) fn principal_ray(&self, sensor_mm: DVec2) -> Option<PupilRay> {
        self.through(sensor_mm, DVec2::ZERO, PRINCIPAL_NM)
    }

    /// The ray through the centroid of the unvignetted part of the pupil.
    pub(super) fn centroid_ray(&self, sensor_mm: DVec2) -> Option<PupilRay> {
        let bundle = self.bundle(sensor_mm)?;
        let centroid = open_centroid(self.aperture_discs(&bundle, sensor_mm.length()))?;
        self.through(sensor_mm, sensor_mm.normalize_or(DVec2::X) * centroid, PRINCIPAL_NM)
    }

    /// The ray through the point `q` of the unit disc that maps to both pupils; `None` if an aperture stops it.
    fn through(&self, sensor_mm: DVec2, q: DVec2, nm: f64) -> Option<PupilRay> {
        let bundle = self.bundle(sensor_mm)?;
        let axis = sensor_mm.normalize_or(DVec2::X);
        let open = |disc: Disc| (q - axis * disc.centre).length_squared() <= disc.radius * disc.radius;
        if !self.aperture_discs(&bundle, sensor_mm.length()).into_iter().flatten().all(open) {
            return None;
        }
        let weight_sr = self.properties.transmittance * bundle.view.weight_sr(sensor_mm, q * bundle.view.radius_mm);
        let pencil = match &self.properties.lateral_colour {
            None => bundle.pencil,
            Some(_) => Pencil { tangent: self.tangent(sensor_mm, nm)?, ..bundle.pencil },
        };
        Some(pencil.ray(q * bundle.entrance_radius_mm, weight_sr))
    }

    pub(super) fn projected_solid_angle_sr(&self, sensor_mm: DVec2) -> f64 {
        let Some(bundle) = self.bundle(sensor_mm) else { return 0.0 };
        let discs = self.aperture_discs(&bundle, sensor_mm.length());
        let clipped = discs.into_iter().flatten().any(|disc| disc.clips_unit_disc());
        self.properties.transmittance
            * if clipped {
                clipped_etendue_sr(&bundle.view, sensor_mm.length(), discs)
            } else {
                bundle.view.projected_solid_angle_sr(sensor_mm)
            }
    }

    /// Tangents of the chief ray at a wavelength.
    fn tangent(&self, sensor_mm: DVec2, nm: f64) -> Option<DVec2> {
        Some(self.properties.ideal_at(sensor_mm, nm)? / self.conjugates.principal_distance_mm)
    }

    /// The bundle at 587.56 nm; apertures and pupils do not depend on the wavelength.
    fn bundle(&self, sensor_mm: DVec2) -> Option<PointBundle> {
        let tangent = self.tangent(sensor_mm, PRINCIPAL_NM)?;
        let entrance_mm = self.size.entrance_radius_mm;
        let exit_mm = entrance_mm * self.pupil_magnification;
        let growth = self.exit_growth(sensor_mm, tangent)?;
        let (entrance_radius_mm, radius_mm) = match self.parameters.constant_pupil {
            ConstantPupil::Entrance => (entrance_mm, exit_mm * growth),
            ConstantPupil::Exit => (entrance_mm / growth, exit_mm),
        };
        Some(PointBundle {
            pencil: Pencil { tangent, inverse_focus_per_mm: self.conjugates.inverse_focus_per_mm },
            view: PupilView { distance_mm: self.exit_distance_mm(), radius_mm },
            entrance_radius_mm,
        })
    }

    /// √g: the radius of the exit pupil over its radius on the axis, where the entrance pupil is constant.
    fn exit_growth(&self, sensor_mm: DVec2, tangent: DVec2) -> Option<f64> {
        let image_tangent = sensor_mm / self.exit_distance_mm();
        let secants = (1.0 + image_tangent.length_squared()) / (1.0 + tangent.length_squared());
        Some(secants * self.properties.ideal_area_per_observed(sensor_mm)?.sqrt())
    }

    /// The apertures as discs in the plane of the unit disc, centres along the direction of the sensor point.
    fn aperture_discs(&self, bundle: &PointBundle, sensor_radius_mm: f64) -> [Option<Disc>; 2] {
        let front = self.apertures.front.map(|[towards_scene, radius]| {
            let scale = bundle.entrance_radius_mm * (1.0 - towards_scene * self.conjugates.inverse_focus_per_mm);
            Disc { centre: -towards_scene * bundle.pencil.tangent.length() / scale, radius: radius / scale }
        });
        let rear = self.apertures.rear.map(|[towards_sensor, radius]| {
            let fraction = towards_sensor / bundle.view.distance_mm;
            let scale = bundle.view.radius_mm * (1.0 - fraction);
            Disc { centre: sensor_radius_mm * fraction / scale, radius: radius / scale }
        });
        [front, rear]
    }

    fn front_aperture(&self, aperture: ClippingAperture) -> Result<[f64; 2], OpticsError> {
        let position_mm = finite("front_aperture.position_mm", aperture.position_mm)?;
        let radius_mm = positive("front_aperture.radius_mm", aperture.radius_mm)?;
        let ahead_mm = self.entrance_pupil_position_mm() - position_mm;
        let left = 1.0 - ahead_mm * self.conjugates.inverse_focus_per_mm;
        if left <= 0.0 {
            let plane_mm = self.entrance_pupil_position_mm() - self.parameters.focus_distance_m / MM;
            return Err(OpticsError::RimMisplaced {
                rim: "front_aperture",
                position_mm,
                plane: "plane in focus",
                plane_mm,
            });
        }
        check_aperture_width("front_aperture", radius_mm, self.size.entrance_radius_mm * left)?;
        Ok([ahead_mm, radius_mm])
    }

    fn rear_aperture(&self, aperture: ClippingAperture) -> Result<[f64; 2], OpticsError> {
        let position_mm = finite("rear_aperture.position_mm", aperture.position_mm)?;
        let radius_mm = positive("rear_aperture.radius_mm", aperture.radius_mm)?;
        let behind_mm = position_mm - self.exit_pupil_position_mm();
        let left = 1.0 - behind_mm / self.exit_distance_mm();
        if left <= 0.0 {
            let plane_mm = self.sensor_position_mm();
            return Err(OpticsError::RimMisplaced { rim: "rear_aperture", position_mm, plane: "sensor", plane_mm });
        }
        let exit_radius_mm = self.size.entrance_radius_mm * self.pupil_magnification;
        check_aperture_width("rear_aperture", radius_mm, exit_radius_mm * left)?;
        Ok([behind_mm, radius_mm])
    }
}

/// Tolerance for an aperture as wide as the bundle.
const RIM_ROUNDING: f64 = 1e-12;

fn check_aperture_width(aperture: &'static str, radius_mm: f64, needed_mm: f64) -> Result<(), OpticsError> {
    if radius_mm * (1.0 + RIM_ROUNDING) >= needed_mm {
        return Ok(());
    }
    Err(OpticsError::RimIsStop { rim: aperture, radius_mm, needed_mm })
}
