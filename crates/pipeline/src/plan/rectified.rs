//! Rectified cameras (undistorted twins): the rectilinear camera with the same pose and the same centre of the entrance pupil.
//!
//! A rectified camera has a camera matrix K without skew, the image size of the original, and rays from the pupil's centre through K. Its ground truth and
//! ray table are traced along these rays and are exact. K keeps the principal point and the focal lengths on the axis (of a projection whose unit is not the
//! tangent of the angle: times dr/dθ there), times a stated scale. A scale below 1 shows more of an image with barrel distortion.
//!
//! Not supported: telecentric cameras, whose rays do not meet, and fields beyond 85° from the axis, where tangents diverge. Of a lens prescription the centre
//! of the paraxial entrance pupil is used; the real pupil moves with the field.

use crate::plan::{CameraBody, CameraPlan};
use etendue_optics::lens::PinholeParameters;
use etendue_optics::{CalibratedParameters, Lens, OpticsError, PupilOrientation};
use etendue_projection::model::Perspective;
use etendue_projection::{Calibration, CalibrationError, CameraMatrix, Model, Raster, RasterError};
use glam::{DVec2, DVec3};

/// Maximum angle from the axis in the field of a rectified camera, degrees: a tangent of 11.4.
const MAX_FIELD_DEG: f64 = 85.0;

/// Reasons for which a camera cannot be rectified.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum RectifiedCameraError {
    /// Rays that do not meet.
    #[error(
        "a telecentric camera has no undistorted image: its rays are parallel and already undistorted; remove the key"
    )]
    Telecentric,
    /// A field too wide for a plane.
    #[error(
        "the camera sees up to {angle_deg:.1}° from its axis, but a rectilinear image ends before 90°; an undistorted \
         twin requires less than {MAX_FIELD_DEG}°; remove the key, or narrow the field (greatest_angle_deg, a crop)"
    )]
    Field {
        /// Largest angle in the field, degrees.
        angle_deg: f64,
    },
    /// A camera without light at its principal point.
    #[error(
        "the camera sees nothing at its principal point, so its undistorted image has no focal length; remove the key"
    )]
    Blind,
    /// Rays that an element before the lens bends.
    #[error("a camera with a {what} has no undistorted image: no camera matrix describes its rays; remove the key")]
    Front {
        /// The element before the lens.
        what: &'static str,
    },
    /// An invalid lens.
    #[error(transparent)]
    Lens(#[from] OpticsError),
    /// An invalid calibration.
    #[error(transparent)]
    Calibration(#[from] CalibrationError),
    /// An invalid raster.
    #[error(transparent)]
    Raster(#[from] RasterError),
}

/// The rectified version of a camera.
#[derive(Clone, Debug)]
pub struct RectifiedCamera {
    /// Its camera matrix, in raster coordinates.
    pub matrix: CameraMatrix,
    /// The camera with a rectilinear lens.
    pub(crate) body: CameraBody,
}

impl RectifiedCamera {
    /// Rectifies a camera, with focal lengths of `scale` times the camera's own.
    ///
    /// # Errors
    /// [`RectifiedCameraError`].
    pub fn new(camera: &CameraBody, scale: f64) -> Result<Self, RectifiedCameraError> {
        if let Some(optic) = camera.front.as_ref().and_then(|front| front.optic()) {
            return Err(RectifiedCameraError::Front { what: optic.name() });
        }
        let matrix = enlarged(own_matrix(camera)?, scale);
        let angle_deg = widest_deg(camera);
        if angle_deg >= MAX_FIELD_DEG {
            return Err(RectifiedCameraError::Field { angle_deg });
        }
        let raster = &camera.raster;
        let centre = DVec2::new(matrix.cx, matrix.cy);
        let raster = Raster::new(raster.width(), raster.height(), raster.pitch_mm(), centre)?;
        let lens = rectilinear(&camera.lens, matrix, &raster, scale)?;
        Ok(Self { matrix, body: CameraBody { lens, raster, ..camera.clone() } })
    }

    /// The rectified camera as a camera body.
    #[must_use]
    pub fn body(&self) -> &CameraBody {
        &self.body
    }

    /// Plan of the rectified camera, for its ground truth.
    #[must_use]
    pub fn plan(&self, camera: &CameraPlan) -> CameraPlan {
        CameraPlan { body: self.body.clone(), ..camera.clone() }
    }

    /// Position, in the image of `camera` (raster coordinates), of a point of the rectified image; `None` where the camera does not see it.
    #[must_use]
    pub fn source(&self, camera: &CameraBody, raster_px: DVec2) -> Option<DVec2> {
        let direction = self.body.lens.direction(self.body.raster.sensor_mm(raster_px))?;
        Some(camera.raster.raster_px(camera.lens.project(direction)?))
    }
}

/// Camera matrix of the camera, in units of tangents.
fn own_matrix(camera: &CameraBody) -> Result<CameraMatrix, RectifiedCameraError> {
    match &camera.lens {
        Lens::Telecentric(_) => Err(RectifiedCameraError::Telecentric),
        Lens::Calibrated(lens) => tangent_matrix(&lens.parameters().calibration),
        lens => Ok(camera.raster.camera_matrix(lens.principal_distance_mm())),
    }
}

/// Camera matrix of a calibration, in units of tangents: near the axis every model is a multiple of the tangent.
fn tangent_matrix(calibration: &Calibration) -> Result<CameraMatrix, RectifiedCameraError> {
    let matrix = CameraMatrix { skew: 0.0, ..calibration.matrix() };
    if matches!(calibration.model(), Model::Perspective(_) | Model::Radial(_)) {
        return Ok(matrix);
    }
    let straight = calibration
        .model()
        .solid_angle_per_area(DVec2::ZERO)
        .filter(|sr| *sr > 0.0)
        .ok_or(RectifiedCameraError::Blind)?;
    Ok(enlarged(matrix, 1.0 / straight.sqrt()))
}

fn enlarged(matrix: CameraMatrix, ratio: f64) -> CameraMatrix {
    CameraMatrix { fx: matrix.fx * ratio, fy: matrix.fy * ratio, ..matrix }
}

/// Lens of the rectified camera: for a paraxial lens a pinhole at its principal distance, otherwise a projection by the matrix.
fn rectilinear(lens: &Lens, matrix: CameraMatrix, raster: &Raster, scale: f64) -> Result<Lens, RectifiedCameraError> {
    let (f_number, transmittance) = (lens.f_number(), lens.transmittance() * lens.open_fraction());
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
        pupil: Some(PupilOrientation::Flat),
        relative_illumination: None,
    })?)
}

/// Largest angle from the axis over a grid of image points, degrees.
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
