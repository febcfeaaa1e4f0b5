//! Properties of a lens's image, measured with its rays, without rendering.
//!
//! Per field height, for the point of the plane in focus (or of infinity) seen by the principal ray at 587.56 nm:
//!
//! - **distortion**: height over that of a rectilinear lens, c tan θ, and of an equidistant one, c θ, less 1, with c the principal distance and θ the
//!   principal ray's angle;
//! - **relative illumination**: irradiance per radiance, over that of the axis;
//! - **spot**: the landing positions of rays that fill the open pupil uniformly in light: root-mean-square and largest distance from their centroid
//!   (see `spot.rs`; also for the converged quadrature and its error);
//! - **other bundles**: light of the same point that passes the lens elsewhere, such as through an edge zone outside the pupil;
//! - **field curvature**: the foci of narrow fans about the principal ray, positive behind the sensor: in the meridional plane (tangential) and
//!   across it (sagittal);
//! - **lateral colour**: the centroid of the spot at the F and C lines less that at d, and the chief ray's position less that at d, positive
//!   outwards. They differ where the bundle is vignetted or comatic.
//!
//! **Axial colour** is the paraxial image position at F and C less that at d.

use etendue_core::maths::f64::sin_cos;
use etendue_spectra::glass::{LINE_C_NM, LINE_F_NM};
use glam::DVec2;

use super::spot::{OtherBundle, Pupil, Spot};
use super::{PrescriptionLens, beam::Beam};
use crate::{overlap::PRINCIPAL_NM, prescription::paraxial::Paraxial};

/// The measured properties of a lens.
#[derive(Clone, Debug, PartialEq)]
pub struct LensReport {
    /// The wavelength of the first-order quantities, nm.
    pub first_order_nm: f64,
    /// First-order quantities at that wavelength.
    pub first_order: Paraxial,
    /// f-number at infinity focus.
    pub f_number: f64,
    /// Distance of the plane in focus from the entrance pupil, m.
    pub focus_distance_m: f64,
    /// Image over object size in the plane in focus.
    pub magnification: f64,
    /// Distance from the last vertex to the sensor, mm.
    pub sensor_mm: f64,
    /// Transmittance on the axis at 587.56 nm.
    pub transmittance: f64,
    /// Angle across the whole lit image, rad; `None` if its edge has no principal ray.
    pub field_of_view_rad: Option<f64>,
    /// Paraxial image at the F line less that at d, mm, positive towards the back of the sensor.
    pub axial_colour_f_mm: f64,
    /// The same for the C line.
    pub axial_colour_c_mm: f64,
    /// By field height, from the axis.
    pub fields: Vec<FieldReport>,
}

/// A field point.
#[derive(Clone, Debug, PartialEq)]
pub struct FieldReport {
    /// Distance from the axis on the sensor, mm.
    pub height_mm: f64,
    /// Irradiance over that on the axis.
    pub relative_illumination: f64,
    /// Imaging at the field point; `None` if it has no principal ray.
    pub image: Option<ImageReport>,
}

/// Imaging of a point.
#[derive(Clone, Debug, PartialEq)]
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
    /// The spot at 587.56 nm; `None` if no ray arrives.
    pub spot: Option<Spot>,
    /// Lateral colour of the F line; `None` if no light of it arrives.
    pub lateral_f: Option<LateralShift>,
    /// Lateral colour of the C line.
    pub lateral_c: Option<LateralShift>,
    /// Light of the same point through other parts of the lens, the brightest first; usually empty.
    pub other_bundles: Vec<OtherBundle>,
}

/// Outward displacement of a wavelength's image from that at 587.56 nm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LateralShift {
    /// By the centroids of the spots, mm.
    pub centroid_mm: f64,
    /// Estimated error of [`Self::centroid_mm`], mm.
    pub centroid_error_mm: f64,
    /// By the chief rays, through the centre of the stop at either wavelength, mm; `None` if there is none.
    pub chief_mm: Option<f64>,
}

impl PrescriptionLens {
    /// Measures the lens at `fields` heights (at least 2) from the axis to the edge of the lit image; first-order quantities at the lens's reference
    /// wavelength.
    #[must_use]
    pub fn report(&self, fields: usize) -> LensReport {
        self.report_at(fields, self.prescription.reference_nm())
    }

    /// The same with first-order quantities at another wavelength, nm.
    #[must_use]
    pub fn report_at(&self, fields: usize, first_order_nm: f64) -> LensReport {
        let lens = &self.prescription;
        let first_order = lens.paraxial_at(first_order_nm);
        let edge = fields.max(2) - 1;
        // The last height is the limit itself, without rounding.
        let height = |i: usize| self.regions.limit_mm * (i as f64 / edge as f64);
        let axis_sr = self.projected_solid_angle_sr(DVec2::ZERO);
        let image_mm = |nm: f64| lens.image_mm(nm);
        let last = self.chiefs.ray(lens, height(edge));
        LensReport {
            first_order_nm,
            first_order,
            f_number: first_order.f_number(),
            focus_distance_m: lens.focus_distance_m(),
            magnification: lens.magnification(),
            sensor_mm: lens.sensor_position_mm() - lens.last_vertex_mm(),
            transmittance: self.transmittance(),
            field_of_view_rad: last.map(|ray| 2.0 * super::chief::field_angle(ray.direction)),
            axial_colour_f_mm: image_mm(LINE_F_NM) - image_mm(PRINCIPAL_NM),
            axial_colour_c_mm: image_mm(LINE_C_NM) - image_mm(PRINCIPAL_NM),
            fields: (0..=edge).map(|i| self.field(height(i), axis_sr)).collect(),
        }
    }

    fn field(&self, height_mm: f64, axis_sr: f64) -> FieldReport {
        let relative_illumination = self.projected_solid_angle_sr(DVec2::new(height_mm, 0.0)) / axis_sr;
        FieldReport { height_mm, relative_illumination, image: self.image(height_mm) }
    }

    fn image(&self, height_mm: f64) -> Option<ImageReport> {
        let principal = self.chiefs.ray(&self.prescription, height_mm)?;
        let beam = |nm: f64| Beam::new(&self.prescription, principal, nm);
        let at_d = beam(PRINCIPAL_NM);
        let angle_rad = super::chief::field_angle(principal.direction);
        let (sine, cosine) = sin_cos(angle_rad);
        let c = self.prescription.principal_distance_mm();
        let relative = |ideal: f64| if height_mm == 0.0 { 0.0 } else { height_mm / ideal - 1.0 };
        let pupil = Pupil::new(&at_d);
        let lit = pupil.as_ref().and_then(|pupil| pupil.principal_spot(&at_d));
        let spot = lit.map(|lit| lit.spot);
        let chief_d_mm = chief_mm(&at_d);
        let lateral = |nm: f64| {
            let beam = beam(nm);
            let (spot, at) = (spot?, pupil.as_ref()?.principal_spot(&beam)?.spot);
            let chief_mm = chief_mm(&beam).zip(chief_d_mm).map(|(at, d)| at - d);
            let centroid_error_mm = at.centroid_error_mm + spot.centroid_error_mm;
            Some(LateralShift { centroid_mm: at.centroid_mm - spot.centroid_mm, centroid_error_mm, chief_mm })
        };
        Some(ImageReport {
            angle_rad,
            distortion: (cosine > 0.0).then(|| relative(c * sine / cosine)),
            equidistant_distortion: relative(c * angle_rad),
            tangential_mm: at_d.fan_focus_mm(false)?,
            sagittal_mm: at_d.fan_focus_mm(true)?,
            spot,
            lateral_f: lateral(LINE_F_NM),
            lateral_c: lateral(LINE_C_NM),
            other_bundles: pupil.zip(lit).map_or_else(Vec::new, |(pupil, lit)| pupil.other_bundles(&at_d, &lit)),
        })
    }
}

/// The landing position of the chief ray of a wavelength, mm.
fn chief_mm(beam: &Beam<'_>) -> Option<f64> {
    Some(beam.sensor_point(beam.chief()?)?.x)
}
