//! A camera defined by the viewing directions of its pixels: a calibrated or ideal projection, with the light of a lens.
//!
//! A projection maps a solid angle dΩ of the scene to an area dA of the sensor. Through a pupil of area A_p as seen from the direction, that area
//! receives E = τ L A_p dΩ/dA.
//!
//! - **f-number**: A_p on the axis is π (f/2N)² with the focal length f = √(dA/dΩ) at the principal point, so that E = π τ L/(4 N²) there
//!   (small-pupil limit, as a pinhole), for every projection.
//! - **Constant pupil**: [`PupilOrientation::Flat`] keeps the disc perpendicular to the axis, foreshortened by cos θ (a rectilinear projection then gives
//!   cos⁴ θ, and no light comes from 90° on). [`PupilOrientation::Oriented`] keeps A_p for every direction. The pupils of wide lenses nearly do so: they
//!   tilt and move towards the light (an equisolid fisheye is then uniform, an equidistant one falls off as sin θ/θ). A measured relative
//!   illumination replaces both.
//! - **Defocus**, if a focus distance is given: rays begin on the pupil's disc of radius f/2N and meet where the principal ray meets the plane in
//!   focus (flat), or at the focus distance along it (turning). Weights stay those of the principal ray. The calibration holds for the focus at which
//!   it was made: there is no focus breathing.
//!
//! Left out: everything that the projection does not describe: aberrations, colours (except [`LateralColour`]), a pupil that moves with the field
//! (all rays meet in one point), clipping.

use core::f64::consts::PI;
use core::fmt::{self, Debug, Formatter};

use etendue_core::ray::PupilRay;
use etendue_projection::{Calibration, Raster};
use glam::{DVec2, DVec3};

use super::field_angles;
use super::paraxial_properties::{Falloff, FalloffArgument, LateralColour, ParaxialProperties};
use crate::error::OpticsError;
use crate::overlap::{f_number, positive};
use crate::pupil::{MM, concentric_disc};

/// Orientation of the entrance pupil over the field.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PupilOrientation {
    /// A disc across the axis.
    Flat,
    /// Turned towards each direction.
    Oriented,
}

/// Parameters of a calibrated camera.
#[derive(Clone, Debug, PartialEq)]
pub struct CalibratedParameters {
    /// Viewing directions of the pixels.
    pub calibration: Calibration,
    pub pixel_pitch_mm: f64,
    /// f-number N.
    pub f_number: f64,
    /// Transmittance, (0, 1].
    pub transmittance: f64,
    /// Focus distance, m; infinity is legal. `None`: everything is sharp.
    pub focus_distance_m: Option<f64>,
    /// Orientation of the pupil; `None`: flat for projections that see less than 180°, else turning.
    pub pupil: Option<PupilOrientation>,
    /// Measured relative illumination.
    pub relative_illumination: Option<Falloff>,
}

/// A calibrated camera.
#[derive(Clone, PartialEq)]
pub struct CalibratedLens {
    parameters: CalibratedParameters,
    pub(super) lateral_colour: Option<LateralColour>,
    pupil: PupilOrientation,
    focal_length_mm: f64,
    /// τ A_p in mm², or (where the illumination is measured) E/L on the axis, sr.
    scale: f64,
}

/// A camera without lateral colour keeps the text (and plans keep the hashes) of versions without it.
impl Debug for CalibratedLens {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let mut text = f.debug_struct("CalibratedLens");
        text.field("parameters", &self.parameters).field("pupil", &self.pupil);
        text.field("focal_length_mm", &self.focal_length_mm).field("scale", &self.scale);
        if let Some(colour) = &self.lateral_colour {
            text.field("lateral_colour", colour);
        }
        text.finish()
    }
}

impl CalibratedLens {
    /// Creates a calibrated camera.
    ///
    /// # Errors
    /// If a number is outside its range, or the calibration has no direction at its principal point.
    pub fn new(parameters: CalibratedParameters) -> Result<Self, OpticsError> {
        let pitch_mm = positive("pixel_pitch_mm", parameters.pixel_pitch_mm)?;
        let n = f_number(parameters.f_number)?;
        let transmittance = ParaxialProperties::new(parameters.transmittance)?.transmittance;
        if let Some(focus_m) = parameters.focus_distance_m
            && (focus_m.is_nan() || focus_m <= 0.0)
        {
            return Err(OpticsError::FocusTooNear { focus_m, least_m: 0.0 });
        }
        let matrix = parameters.calibration.matrix();
        let solid_angle_per_area = parameters.calibration.solid_angle_per_area(DVec2::new(matrix.cx, matrix.cy));
        let sr_per_px2 =
            solid_angle_per_area.filter(|s| *s > 0.0).ok_or(OpticsError::BlindCentre { x: matrix.cx, y: matrix.cy })?;
        let focal_length_mm = pitch_mm / sr_per_px2.sqrt();
        let axis_sr = transmittance * PI / (4.0 * n * n);
        let measured = parameters.relative_illumination.is_some();
        let scale = if measured { axis_sr } else { axis_sr * focal_length_mm * focal_length_mm };
        let wide = parameters.calibration.model().edge().angle_rad > core::f64::consts::FRAC_PI_2;
        let by_field = if wide { PupilOrientation::Oriented } else { PupilOrientation::Flat };
        let pupil = parameters.pupil.unwrap_or(by_field);
        Ok(Self { pupil, lateral_colour: None, focal_length_mm, scale, parameters })
    }

    /// Construction parameters.
    #[must_use]
    pub fn parameters(&self) -> &CalibratedParameters {
        &self.parameters
    }

    /// Orientation of the pupil.
    #[must_use]
    pub fn pupil(&self) -> PupilOrientation {
        self.pupil
    }

    /// √(dA/dΩ) at the principal point, mm.
    #[must_use]
    pub fn focal_length_mm(&self) -> f64 {
        self.focal_length_mm
    }

    /// Radius of the pupil, mm; 0 if everything is sharp.
    #[must_use]
    pub fn pupil_radius_mm(&self) -> f64 {
        self.parameters.focus_distance_m.map_or(0.0, |_| self.focal_length_mm / (2.0 * self.parameters.f_number))
    }

    /// Refuses an image size that differs from the calibration's, a fold inside the image, and a measured illumination that ends inside it.
    pub(super) fn check(&self, raster: &Raster) -> Result<(), OpticsError> {
        let [width, height] = self.parameters.calibration.size_px();
        let (got_width, got_height) = (raster.width(), raster.height());
        if [got_width, got_height] != [width, height] {
            return Err(OpticsError::CalibratedSize { got_width, got_height, width, height });
        }
        self.parameters.calibration.check()?;
        self.check_course(raster.max_radius_mm())?;
        self.parameters
            .relative_illumination
            .as_ref()
            .map_or(Ok(()), |table| table.check(self.reach(raster, table.by())))
    }

    /// Extent of an image in the argument of a relative illumination: to its farthest corner with a direction, or to the edge of the projection if a
    /// corner has none.
    fn reach(&self, raster: &Raster, by: FalloffArgument) -> f64 {
        let [width, height] = self.parameters.calibration.size_px().map(|size| size as f64);
        let corners = [0.0, 0.5, 1.0].map(|x| [0.0, 0.5, 1.0].map(|y| DVec2::new(x * width, y * height)));
        let angle = |px: DVec2| self.parameters.calibration.unproject(px).map(field_angle_deg);
        match by {
            FalloffArgument::Radius => raster.max_radius_mm(),
            FalloffArgument::Angle => {
                let calibration = &self.parameters.calibration;
                let end = calibration.model().edge().angle_rad;
                let edge = calibration.max_angle_rad().map_or(end, |angle| angle.min(end)).to_degrees();
                corners.as_flattened().iter().map(|px| angle(*px).unwrap_or(edge)).fold(0.0, f64::max)
            }
        }
    }

    /// Checks that the model looks at about r/f near the principal point.
    fn check_course(&self, radius_mm: f64) -> Result<(), OpticsError> {
        let limited = self.parameters.calibration.max_angle_rad().is_some();
        let ideal = |r_mm: f64| {
            let direction = self.direction(DVec2::new(r_mm, 0.0));
            let angle = direction.map(|d| etendue_core::maths::f64::atan2(d.truncate().length(), d.z));
            angle.or(limited.then_some(r_mm / self.focal_length_mm)).map(|angle| angle * self.focal_length_mm)
        };
        field_angles::check(radius_mm, self.focal_length_mm, &field_angles::NEAR, ideal)
    }

    fn raster_px(&self, sensor_mm: DVec2) -> DVec2 {
        let matrix = self.parameters.calibration.matrix();
        sensor_mm / self.parameters.pixel_pitch_mm + DVec2::new(matrix.cx, matrix.cy)
    }

    pub(super) fn direction(&self, sensor_mm: DVec2) -> Option<DVec3> {
        self.parameters.calibration.unproject(self.raster_px(sensor_mm))
    }

    pub(super) fn direction_at(&self, sensor_mm: DVec2, nm: f64) -> Option<DVec3> {
        self.direction(self.lateral_colour.as_ref().map_or(sensor_mm, |colour| sensor_mm / colour.at(nm)))
    }

    pub(super) fn project(&self, direction: DVec3) -> Option<DVec2> {
        let matrix = self.parameters.calibration.matrix();
        let px = self.parameters.calibration.project(direction)?;
        Some((px - DVec2::new(matrix.cx, matrix.cy)) * self.parameters.pixel_pitch_mm)
    }

    pub(super) fn principal_ray(&self, sensor_mm: DVec2) -> Option<PupilRay> {
        let at_px = self.raster_px(sensor_mm);
        if let Some(table) = &self.parameters.relative_illumination {
            let direction = self.parameters.calibration.unproject(at_px)?;
            self.foreshortening(direction)?;
            let field = match table.by() {
                FalloffArgument::Radius => sensor_mm.length(),
                FalloffArgument::Angle => field_angle_deg(direction),
            };
            return Some(at_the_centre(direction, self.scale * table.at(field)));
        }
        let sight = self.parameters.calibration.sight(at_px)?;
        let pitch = self.parameters.pixel_pitch_mm;
        let weight_sr = self.scale * self.foreshortening(sight.direction)? * sight.sr_per_area / (pitch * pitch);
        Some(at_the_centre(sight.direction, weight_sr))
    }

    pub(super) fn projected_solid_angle_sr(&self, sensor_mm: DVec2) -> f64 {
        self.principal_ray(sensor_mm).map_or(0.0, |ray| ray.weight_sr)
    }

    /// The fraction of the pupil's area seen from a direction; `None` if no light comes from it.
    fn foreshortening(&self, direction: DVec3) -> Option<f64> {
        match self.pupil {
            PupilOrientation::Flat => (direction.z > 0.0).then_some(direction.z),
            PupilOrientation::Oriented => Some(1.0),
        }
    }

    pub(super) fn ray(&self, sensor_mm: DVec2, pupil: DVec2, nm: f64) -> Option<PupilRay> {
        let mut principal = self.principal_ray(sensor_mm)?;
        if self.lateral_colour.is_some() {
            principal.direction = self.direction_at(sensor_mm, nm)?;
        }
        match self.parameters.focus_distance_m {
            None => Some(principal),
            Some(focus_m) => Some(self.through(principal, concentric_disc(pupil), focus_m)),
        }
    }

    /// The ray through the point `q` of the unit disc that meets the principal ray at the focus distance.
    fn through(&self, principal: PupilRay, q: DVec2, focus_m: f64) -> PupilRay {
        let ahead = principal.direction;
        let at = q * (self.pupil_radius_mm() * MM);
        let (origin_m, sharp) = match self.pupil {
            PupilOrientation::Flat => (at.extend(0.0), ahead / ahead.z),
            PupilOrientation::Oriented => {
                let (x, y) = ahead.any_orthonormal_pair();
                (x * at.x + y * at.y, ahead)
            }
        };
        let direction = (sharp - origin_m / focus_m).normalize();
        PupilRay { origin_m, direction, ..principal }
    }
}

fn field_angle_deg(direction: DVec3) -> f64 {
    etendue_core::maths::f64::atan2(direction.truncate().length(), direction.z).to_degrees()
}

fn at_the_centre(direction: DVec3, weight_sr: f64) -> PupilRay {
    PupilRay { origin_m: DVec3::ZERO, direction, weight_sr }
}
