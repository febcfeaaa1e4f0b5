//! What a lens does to its image, measured by its rays, without a picture.
//!
//! Per field height, for the point of the plane in focus (or of infinity) that the principal ray at 587.56 nm comes from:
//!
//! - **distortion**: height over that of a rectilinear lens, c tan θ, and of an equidistant one, c θ, less 1, with c the
//!   principal distance and θ the principal ray's angle;
//! - **relative illumination**: irradiance per radiance, over that of the axis;
//! - **spot**: where rays that fill the open pupil evenly in irradiance land: root-mean-square and greatest distance from
//!   their centroid;
//! - **field curvature**: where narrow fans about the principal ray come to focus, behind the sensor positive: in the
//!   meridional plane (tangential) and across it (sagittal);
//! - **lateral colour**: the centroid of the spot at the F and C lines less that at d, outwards positive.
//!
//! **Axial colour** is the paraxial image's place at F and C less that at d.

use super::Prescribed;
use super::meridian::Meridian;
use crate::error::PRINCIPAL_NM;
use crate::prescription::paraxial::Paraxial;
use crate::prescription::trace::{LensRay, Rims};
use crate::pupil::concentric;
use etendue_core::maths::f64::sin_cos;
use etendue_spectra::glass::{LINE_C_NM, LINE_F_NM};
use glam::{DVec2, DVec3};

/// The rays of a spot are a square of this side over the pupil's samples.
const SPOT_SIDE: usize = 24;
/// Distance of a fan's rays from the principal ray, in radii of the entrance pupil.
const FAN: f64 = 1e-3;

/// A lens, measured.
#[derive(Clone, Debug, PartialEq)]
pub struct LensReport {
    /// First-order quantities at 587.56 nm.
    pub first_order: Paraxial,
    /// f-number at infinity focus.
    pub f_number: f64,
    /// Distance of the plane in focus from the entrance pupil, m.
    pub focus_distance_m: f64,
    /// Image over object size in the plane in focus.
    pub magnification: f64,
    /// Sensor behind the last vertex, mm.
    pub sensor_mm: f64,
    /// Transmittance on the axis at 587.56 nm.
    pub transmittance: f64,
    /// Angle across the whole lit picture, rad; `None` where its edge has no principal ray.
    pub field_of_view_rad: Option<f64>,
    /// Paraxial image at the F line less that at d, mm, towards the sensor's back positive.
    pub axial_colour_f_mm: f64,
    /// The same for the C line.
    pub axial_colour_c_mm: f64,
    /// By field height, from the axis.
    pub fields: Vec<FieldReport>,
}

/// A field point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FieldReport {
    /// Distance from the axis on the sensor, mm.
    pub height_mm: f64,
    /// Irradiance over that on the axis.
    pub relative_illumination: f64,
    /// What its principal ray tells; `None` where it has none.
    pub image: Option<ImageReport>,
}

/// How a point is imaged.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImageReport {
    /// Angle of the principal ray from the axis, rad.
    pub angle_rad: f64,
    /// Height over c tan θ, less 1; `None` from 90° on.
    pub distortion: Option<f64>,
    /// Height over c θ, less 1.
    pub equidistant_distortion: f64,
    /// Tangential focus behind the sensor, mm.
    pub tangential_mm: f64,
    /// Sagittal focus behind the sensor, mm.
    pub sagittal_mm: f64,
    /// The spot at 587.56 nm; `None` where no ray arrives.
    pub spot: Option<Spot>,
    /// Lateral colour of the F line, mm.
    pub lateral_f_mm: Option<f64>,
    /// Lateral colour of the C line, mm.
    pub lateral_c_mm: Option<f64>,
}

/// Where the rays of a point land.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spot {
    /// Root-mean-square distance from the centroid, mm.
    pub rms_mm: f64,
    /// Greatest distance from the centroid, mm.
    pub radius_mm: f64,
    /// The centroid's distance from the axis, mm.
    pub centroid_mm: f64,
}

/// Where rays come from.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Source {
    /// A direction towards the sensor.
    Direction(DVec3),
    /// A point of the lens frame.
    Point(DVec3),
}

impl Source {
    /// Its ray through a point in front of the lens.
    fn through(self, point: DVec3) -> LensRay {
        let direction = match self {
            Self::Direction(direction) => direction,
            Self::Point(source) => (point - source).normalize(),
        };
        LensRay { point, direction }
    }
}

impl Prescribed {
    /// Measures the lens at `fields` heights (at least 2) from the axis to the edge of the lit picture.
    #[must_use]
    pub fn report(&self, fields: usize) -> LensReport {
        let lens = &self.prescription;
        let edge = fields.max(2) - 1;
        let height = |i: usize| self.regions.limit_mm * i as f64 / edge as f64;
        let axis_sr = self.etendue_sr(DVec2::ZERO);
        let image_mm = |nm: f64| lens.image_mm(nm);
        let last = self.chiefs.ray(lens, height(edge));
        LensReport {
            first_order: *lens.paraxial(),
            f_number: lens.paraxial().f_number(),
            focus_distance_m: lens.focus_distance_m(),
            magnification: lens.magnification(),
            sensor_mm: lens.sensor_mm() - lens.last_vertex_mm(),
            transmittance: self.transmittance(),
            field_of_view_rad: last.map(|ray| 2.0 * super::chief::field_angle(ray.direction)),
            axial_colour_f_mm: image_mm(LINE_F_NM) - image_mm(PRINCIPAL_NM),
            axial_colour_c_mm: image_mm(LINE_C_NM) - image_mm(PRINCIPAL_NM),
            fields: (0..=edge).map(|i| self.field(height(i), axis_sr)).collect(),
        }
    }

    fn field(&self, height_mm: f64, axis_sr: f64) -> FieldReport {
        let relative_illumination = self.etendue_sr(DVec2::new(height_mm, 0.0)) / axis_sr;
        FieldReport { height_mm, relative_illumination, image: self.image(height_mm) }
    }

    fn image(&self, height_mm: f64) -> Option<ImageReport> {
        let principal = self.chiefs.ray(&self.prescription, height_mm)?;
        let source = self.source(principal);
        let angle_rad = super::chief::field_angle(principal.direction);
        let (sine, cosine) = sin_cos(angle_rad);
        let c = self.prescription.principal_distance_mm();
        let relative = |ideal: f64| if height_mm == 0.0 { 0.0 } else { height_mm / ideal - 1.0 };
        let spot = |nm: f64| self.spot(height_mm, source, nm);
        let lateral = |nm: f64| Some(spot(nm)?.centroid_mm - spot(PRINCIPAL_NM)?.centroid_mm);
        Some(ImageReport {
            angle_rad,
            distortion: (cosine > 0.0).then(|| relative(c * sine / cosine)),
            equidistant_distortion: relative(c * angle_rad),
            tangential_mm: self.fan_focus_mm(principal, source, false)?,
            sagittal_mm: self.fan_focus_mm(principal, source, true)?,
            spot: spot(PRINCIPAL_NM),
            lateral_f_mm: lateral(LINE_F_NM),
            lateral_c_mm: lateral(LINE_C_NM),
        })
    }

    /// The point of the plane in focus on a principal ray (which runs towards the scene), or its direction for infinity.
    fn source(&self, principal: LensRay) -> Source {
        let plane_mm = self.prescription.paraxial().entrance_pupil_mm - self.prescription.focus_distance_m() * 1e3;
        let t = (plane_mm - principal.point.z) / principal.direction.z;
        let ahead = t.is_finite() && t > 0.0;
        if ahead {
            Source::Point(principal.point + principal.direction * t)
        } else {
            Source::Direction(-principal.direction)
        }
    }

    /// Rays of `source` that fill the pupil of a height: through the points at which samples leave the lens.
    fn spot(&self, height_mm: f64, source: Source, nm: f64) -> Option<Spot> {
        let landed: Vec<DVec2> = (0..SPOT_SIDE * SPOT_SIDE)
            .filter_map(|i| {
                let cell = DVec2::new((i % SPOT_SIDE) as f64, (i / SPOT_SIDE) as f64) + 0.5;
                let (disc, turn) = concentric(cell / SPOT_SIDE as f64);
                let slope = self.regions.propose(height_mm, disc, turn)?.slope;
                let meridian = Meridian::at(height_mm, self.prescription.sensor_mm());
                let front = self.prescription.to_scene(meridian.ray(slope), nm).ok()?.0;
                self.lands(source.through(front.point), nm, Rims::Clip)
            })
            .collect();
        let count = landed.len() as f64;
        let centroid = landed.iter().sum::<DVec2>() / count;
        let squares = landed.iter().map(|p| (*p - centroid).length_squared());
        (count > 0.0).then(|| Spot {
            rms_mm: (squares.clone().sum::<f64>() / count).sqrt(),
            radius_mm: squares.fold(0.0, f64::max).sqrt(),
            centroid_mm: centroid.x,
        })
    }

    /// Where a ray from the scene meets the sensor's plane, mm.
    fn lands(&self, ray: LensRay, nm: f64, rims: Rims) -> Option<DVec2> {
        let out = self.prescription.arrives(ray, &self.prescription.media(nm), rims).ok()?;
        let t = (self.prescription.sensor_mm() - out.point.z) / out.direction.z;
        Some((out.point + out.direction * t).truncate())
    }

    /// Where two rays beside the principal ray, in its meridional plane or across it, meet: mm behind the sensor.
    fn fan_focus_mm(&self, principal: LensRay, source: Source, across: bool) -> Option<f64> {
        let lens = &self.prescription;
        let media = lens.media(PRINCIPAL_NM);
        let d = principal.direction;
        // Beside the ray, square to it.
        let beside = if across { DVec3::Y } else { DVec3::new(-d.z, 0.0, d.x) };
        let step = FAN * lens.paraxial().entrance_radius_mm;
        let out =
            |sign: f64| lens.arrives(source.through(principal.point + beside * (sign * step)), &media, Rims::Ignore);
        let (a, b) = (out(-1.0).ok()?, out(1.0).ok()?);
        // Heights and slopes across the axis, at the sensor.
        let axis = if across { DVec3::Y } else { DVec3::X };
        let slope = |ray: &LensRay| ray.direction.dot(axis) / ray.direction.z;
        let height = |ray: &LensRay| ray.point.dot(axis) + (lens.sensor_mm() - ray.point.z) * slope(ray);
        Some(-(height(&b) - height(&a)) / (slope(&b) - slope(&a)))
    }
}
