//! How a camera of a plan projects, as one calibration in pixels of its pictures.

use etendue_optics::{Front, Lens};
use etendue_pipeline::plan::CameraBody;
use etendue_projection::model::Perspective;
use etendue_projection::plane::DistortionTerms;
use etendue_projection::{Calibration, CameraMatrix, Model, Sense};
use glam::DVec2;

/// Farthest (px) that the calibration may see a point from where the camera does.
const TOLERANCE_PX: f64 = 1e-6;
/// Places along each side of the picture at which this is checked.
const PLACES: u32 = 9;

/// The calibration that sees every direction where the camera does.
///
/// # Errors
/// The rest of a sentence that begins with the camera: why there is none.
pub(super) fn calibration(body: &CameraBody) -> Result<Calibration, String> {
    if let Some(optic) = body.front.as_ref().and_then(Front::optic) {
        return Err(format!("it looks by a {}, which no calibration file describes", optic.name()));
    }
    let layout = body.sensor.as_ref().map(|sensor| sensor.parameters().read_out.layout);
    if layout.is_some_and(|layout| !layout.is_whole()) {
        return Err(
            "its pictures are a region, or of binned or skipped pixels, whose grid is not the lens's".to_owned()
        );
    }
    let found = match &body.lens {
        Lens::Calibrated(lens) => lens.parameters().calibration.clone(),
        Lens::Pinhole(_) | Lens::Thin(_) | Lens::Thick(_) => paraxial(body)?,
        Lens::Prescription(_) => {
            return Err(
                "its lens is traced surface by surface; \"etendue calibrate\" fits a model to pictures of a chart"
                    .to_owned(),
            );
        }
        Lens::RayTransfer(_) => {
            return Err("its lens is known by ray-transfer functions; \"etendue calibrate\" fits a model to pictures of a chart".to_owned());
        }
        Lens::Telecentric(_) => return Err("its rays are parallel".to_owned()),
    };
    match farthest_px(body, &found) {
        off if off <= TOLERANCE_PX => Ok(found),
        off => Err(format!("its projection differs from every model by {off:.2e} px")),
    }
}

/// The camera matrix of a camera whose pictures are rectilinear, in raster coordinates.
///
/// # Errors
/// The rest of a sentence that begins with the camera: why there is none.
pub(super) fn pinhole(body: &CameraBody) -> Result<CameraMatrix, String> {
    let found = calibration(body)?;
    let straight = Perspective::new(DistortionTerms::default(), [0.0; 2]).map_err(|error| error.to_string())?;
    match found.model() {
        Model::Perspective(model) if *model == straight => Ok(found.matrix()),
        _ => Err("its pictures are distorted, and the format knows a camera matrix alone".to_owned()),
    }
}

/// The camera matrix of a paraxial lens, with its radial distortion.
fn paraxial(body: &CameraBody) -> Result<Calibration, String> {
    let (lens, raster) = (&body.lens, &body.raster);
    let principal_mm = lens.principal_distance_mm();
    let mut terms = DistortionTerms::default();
    if let Some(distortion) = lens.distortion() {
        if distortion.sense() == Sense::ObservedToIdeal {
            return Err(
                "its distortion is a polynomial from observed to ideal points, and calibration files have the other \
                        direction"
                    .to_owned(),
            );
        }
        let [k1, k2] = distortion.coefficients();
        let square = (principal_mm / distortion.unit_mm()) * (principal_mm / distortion.unit_mm());
        (terms.numerator[0], terms.numerator[1]) = (k1 * square, k2 * square * square);
    }
    let model = Perspective::new(terms, [0.0; 2]).map_err(|error| error.to_string())?;
    let size_px = [raster.width(), raster.height()];
    Calibration::new(Model::Perspective(model), raster.camera_matrix(principal_mm), size_px)
        .map_err(|error| error.to_string())
}

/// How far (px) the calibration sees directions from where the camera does, over a grid of the picture.
fn farthest_px(body: &CameraBody, calibration: &Calibration) -> f64 {
    let raster = &body.raster;
    let size = DVec2::new(raster.width() as f64, raster.height() as f64);
    let last = f64::from(PLACES - 1);
    let places = (0..PLACES * PLACES).map(|i| DVec2::new(f64::from(i % PLACES), f64::from(i / PLACES)) / last * size);
    let off = |at_px: DVec2| {
        let direction = body.lens.direction(raster.sensor_mm(at_px))?;
        Some(calibration.project(direction).map_or(f64::INFINITY, |seen| (seen - at_px).length()))
    };
    places.filter_map(off).fold(0.0, f64::max)
}
