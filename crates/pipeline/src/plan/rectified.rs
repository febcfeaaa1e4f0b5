//! Undistorted twins: the rectilinear camera with the same pose and the same centre of the entrance pupil.
//!
//! A twin has a camera matrix K without skew, the picture's size, and rays from the pupil's centre through K; its ground truth
//! and ray table are traced along them and are exact. K keeps the principal point and the focal lengths on the axis
//! (of a projection whose unit is not the tangent of the angle: times dr/dθ there), times a stated scale; a scale below 1
//! shows more of a picture that barrels.
//!
//! Left out: a twin of a telecentric camera, whose rays do not meet, and of fields beyond 85° from the axis, where tangents grow
//! without end. A prescription's twin looks from the centre of the paraxial entrance pupil, which real pupils leave with the
//! field.

use crate::plan::{CameraBody, CameraPlan};
use etendue_optics::lens::PinholeParameters;
use etendue_optics::{CalibratedParameters, Lens, OpticsError, PupilStance};
use etendue_projection::model::Perspective;
use etendue_projection::{Calibration, CalibrationError, CameraMatrix, Model, Raster, RasterError};
use glam::{DVec2, DVec3};

/// The largest angle from the axis that a camera with a twin may see, degrees: a tangent of 11.4.
const WIDEST_DEG: f64 = 85.0;

/// Why a camera has no undistorted twin.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum RectifiedCameraError {
    /// Rays that do not meet.
    #[error(
        "a telecentric camera has no undistorted twin: its rays do not meet, and are straight as they are; remove the key"
    )]
    Telecentric,
    /// A field that no plane holds.
    #[error(
        "the camera sees as far as {angle_deg:.1}° from its axis, and a rectilinear picture ends before 90°: an undistorted twin is \
         made of cameras that see less than {WIDEST_DEG}°; remove the key, or narrow the field (greatest_angle_deg, a crop)"
    )]
    Field {
        /// The largest angle seen, degrees.
        angle_deg: f64,
    },
    /// A camera that sees nothing at its principal point.
    #[error(
        "the camera sees nothing at its principal point, so that its undistorted twin has no focal length; remove the key"
    )]
    Blind,
    /// Rays that something before the lens bends.
    #[error(
        "behind a {what} no camera matrix gives the rays: a camera with one has no undistorted twin; remove the key"
    )]
    Front {
        /// What stands before the lens.
        what: &'static str,
    },
    /// A lens that cannot be.
    #[error(transparent)]
    Lens(#[from] OpticsError),
    /// A calibration that cannot be.
    #[error(transparent)]
    Calibration(#[from] CalibrationError),
    /// A raster that cannot be.
    #[error(transparent)]
    Raster(#[from] RasterError),
}

/// The rectilinear twin of a camera.
#[derive(Clone, Debug)]
pub struct RectifiedCamera {
    /// Its camera matrix, in raster coordinates.
    pub matrix: CameraMatrix,
    /// The camera with a rectilinear lens.
    pub(crate) body: CameraBody,
}

impl RectifiedCamera {
    /// The twin of a camera, its focal lengths `scale` times the camera's own.
    ///
    /// # Errors
    /// [`RectifiedCameraError`].
    pub fn of(camera: &CameraBody, scale: f64) -> Result<Self, RectifiedCameraError> {
        if let Some(optic) = camera.front.as_ref().and_then(|front| front.optic()) {
            return Err(RectifiedCameraError::Front { what: optic.name() });
        }
        let matrix = enlarged(own_matrix(camera)?, scale);
        let angle_deg = widest_deg(camera);
        if angle_deg >= WIDEST_DEG {
            return Err(RectifiedCameraError::Field { angle_deg });
        }
        let raster = &camera.raster;
        let centre = DVec2::new(matrix.cx, matrix.cy);
        let raster = Raster::new(raster.width(), raster.height(), raster.pitch_mm(), centre)?;
        let lens = rectilinear(&camera.lens, matrix, &raster, scale)?;
        Ok(Self { matrix, body: CameraBody { lens, raster, ..camera.clone() } })
    }

    /// The twin as a camera.
    #[must_use]
    pub fn body(&self) -> &CameraBody {
        &self.body
    }

    /// The plan of the twin, for its ground truth.
    #[must_use]
    pub fn plan(&self, camera: &CameraPlan) -> CameraPlan {
        CameraPlan { body: self.body.clone(), ..camera.clone() }
    }

    /// Where in the picture of `camera` (raster coordinates) a point of the twin's is; `None` where the camera does not see it.
    #[must_use]
    pub fn source(&self, camera: &CameraBody, raster_px: DVec2) -> Option<DVec2> {
        let direction = self.body.lens.direction(self.body.raster.sensor_mm(raster_px))?;
        Some(camera.raster.raster_px(camera.lens.project(direction)?))
    }
}

/// The camera's own matrix, as one of tangents.
fn own_matrix(camera: &CameraBody) -> Result<CameraMatrix, RectifiedCameraError> {
    match &camera.lens {
        Lens::Telecentric(_) => Err(RectifiedCameraError::Telecentric),
        Lens::Calibrated(lens) => of_tangents(&lens.parameters().calibration),
        lens => Ok(camera.raster.camera_matrix(lens.principal_distance_mm())),
    }
}

/// A calibration's matrix for tangents: near the axis every model is a multiple of the tangent.
fn of_tangents(calibration: &Calibration) -> Result<CameraMatrix, RectifiedCameraError> {
    let matrix = CameraMatrix { skew: 0.0, ..calibration.matrix() };
    if matches!(calibration.model(), Model::Perspective(_) | Model::Radial(_)) {
        return Ok(matrix);
    }
    let seen = calibration
        .model()
        .solid_angle_per_area(DVec2::ZERO)
        .filter(|sr| *sr > 0.0)
        .ok_or(RectifiedCameraError::Blind)?;
    Ok(enlarged(matrix, 1.0 / seen.sqrt()))
}

fn enlarged(matrix: CameraMatrix, ratio: f64) -> CameraMatrix {
    CameraMatrix { fx: matrix.fx * ratio, fy: matrix.fy * ratio, ..matrix }
}

/// The lens of the twin: of a paraxial lens a pinhole at its principal distance, else a projection by the matrix.
fn rectilinear(lens: &Lens, matrix: CameraMatrix, raster: &Raster, scale: f64) -> Result<Lens, RectifiedCameraError> {
    let (f_number, transmittance) = (lens.f_number(), lens.transmittance());
    if matches!(lens, Lens::Pinhole(_) | Lens::Thin(_) | Lens::Thick(_)) {
        let focal_length_mm = lens.principal_distance_mm() * scale;
        return Ok(Lens::pinhole(PinholeParameters { focal_length_mm, f_number, transmittance })?);
    }
    let pinhole = Model::Perspective(Perspective::pinhole());
    Ok(Lens::calibrated(CalibratedParameters {
        calibration: Calibration::new(pinhole, matrix, [raster.width(), raster.height()])?,
        pixel_pitch_mm: raster.pitch_mm().x,
        f_number,
        transmittance,
        focus_distance_m: None,
        pupil: Some(PupilStance::Flat),
        relative_illumination: None,
    })?)
}

/// The largest angle from the axis that a grid of points over the picture sees, degrees.
fn widest_deg(camera: &CameraBody) -> f64 {
    const STEPS: u32 = 16;
    let size = DVec2::new(camera.raster.width() as f64, camera.raster.height() as f64);
    let at = |i: u32| DVec2::new(f64::from(i % (STEPS + 1)), f64::from(i / (STEPS + 1))) / f64::from(STEPS) * size;
    let directions =
        (0..(STEPS + 1) * (STEPS + 1)).filter_map(|i| camera.lens.direction(camera.raster.sensor_mm(at(i))));
    directions.map(from_axis_deg).fold(0.0, f64::max)
}

fn from_axis_deg(direction: DVec3) -> f64 {
    etendue_core::maths::f64::atan2(direction.truncate().length(), direction.z).to_degrees()
}
