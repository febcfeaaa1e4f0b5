//! From a projection's numbers to a calibration.

use super::super::context::{Context, ErrorCode};
use etendue_core::maths::f64::tan;
use etendue_projection::model::{
    Division, DoubleSphere, ExtendedUnified, FTheta, FThetaSense, FieldOfView, Ideal, KannalaBrandt, ModelError, Ocam,
    Panorama, Perspective, Tabulated, ThinPrismFisheye, Unified,
};
use etendue_projection::plane::{Affine, DistortionTerms};
use etendue_projection::{Calibration, CameraMatrix, Model, RadialDistortion, Raster, Sense};
use etendue_scene::asset::{LensNumbers, LensQuantity, Undistorted};
use etendue_scene::record::lens::Direction;
use etendue_scene::record::lens::projection::{self as record, Centre, Matrix, Projection, Scale, Table, TableSource};
use etendue_scene::{Place, Placed};
use glam::{DVec2, DVec3};

/// The calibration of a projection for a picture.
pub(super) fn calibration(
    record: &Projection,
    place: &Place,
    raster: &Raster,
    context: &mut Context<'_>,
) -> Option<Calibration> {
    let points = match record {
        Projection::Table(table) => points(table, context)?,
        _ => Vec::new(),
    };
    let model = context.accept(place, model(record, &points))?;
    let matrix = match scale(record) {
        Scaling::Matrix(matrix) => camera_matrix(matrix, &model, raster, context)?,
        Scaling::Pixels(centre) => in_units(centre, DVec2::ONE, raster),
        Scaling::Millimetres(centre) => in_units(centre, raster.pitch_mm(), raster),
    };
    context.accept(place, Calibration::new(model, matrix, [raster.width(), raster.height()]))
}

/// Where the projection says its principal point, where it does.
pub(super) fn stated_centre(record: &Projection) -> Option<&Place> {
    let centre = match scale(record) {
        Scaling::Matrix(matrix) => &matrix.centre,
        Scaling::Pixels(centre) | Scaling::Millimetres(centre) => centre,
    };
    centre.cx_px.as_ref().or(centre.cy_px.as_ref()).map(|c| &c.place)
}

/// Whether a projection's plane is in units of a camera matrix, in pixels or in mm.
enum Scaling<'a> {
    Matrix(&'a Matrix),
    Pixels(&'a Centre),
    Millimetres(&'a Centre),
}

fn scale(record: &Projection) -> Scaling<'_> {
    Scaling::Matrix(match record {
        Projection::Ocam(r) => return Scaling::Pixels(&r.centre),
        Projection::FTheta(r) => return Scaling::Pixels(&r.centre),
        Projection::Table(r) => return Scaling::Millimetres(&r.centre),
        Projection::OpenCv(r) => &r.matrix,
        Projection::Radial(r) => &r.matrix,
        Projection::Division(r) => &r.matrix,
        Projection::FieldOfView(r) => &r.matrix,
        Projection::KannalaBrandt(r) => &r.matrix,
        Projection::ThinPrismFisheye(r) => &r.matrix,
        Projection::Unified(r) => &r.matrix,
        Projection::ExtendedUnified(r) => &r.matrix,
        Projection::DoubleSphere(r) => &r.matrix,
        Projection::Equidistant(r)
        | Projection::Equisolid(r)
        | Projection::Stereographic(r)
        | Projection::Orthographic(r)
        | Projection::Rectilinear(r)
        | Projection::Cylindrical(r)
        | Projection::Equirectangular(r) => &r.matrix,
    })
}

/// `points` are those of a table.
fn model(record: &Projection, points: &[(f64, f64)]) -> Result<Model, ModelError> {
    Ok(match record {
        Projection::OpenCv(r) => Model::Perspective(Perspective::from_opencv(&numbers(r.distortion.iter().flatten()))?),
        Projection::Radial(r) => Model::Radial(radial(r)?),
        Projection::Division(r) => Model::Division(Division::new(r.k.value)?),
        Projection::FieldOfView(r) => Model::FieldOfView(FieldOfView::new(r.omega_rad.value)?),
        Projection::KannalaBrandt(r) => Model::KannalaBrandt(KannalaBrandt::new(four(&r.k))?),
        Projection::ThinPrismFisheye(r) => Model::ThinPrismFisheye(thin_prism(r)?),
        Projection::Unified(r) => Model::Unified(Unified::new(r.xi.value, mei(r.distortion.as_ref()))?),
        Projection::ExtendedUnified(r) => Model::ExtendedUnified(ExtendedUnified::new(r.alpha.value, r.beta.value)?),
        Projection::DoubleSphere(r) => Model::DoubleSphere(DoubleSphere::new(r.xi.value, r.alpha.value)?),
        Projection::Ocam(r) => Model::Ocam(Ocam::new(numbers(&r.polynomial), affine(&r.stretch))?),
        Projection::FTheta(r) => Model::FTheta(f_theta(r)?),
        Projection::Table(_) => Model::Tabulated(Tabulated::new(points)?),
        Projection::Equidistant(_) => Model::Ideal(Ideal::Equidistant),
        Projection::Equisolid(_) => Model::Ideal(Ideal::Equisolid),
        Projection::Stereographic(_) => Model::Ideal(Ideal::Stereographic),
        Projection::Orthographic(_) => Model::Ideal(Ideal::Orthographic),
        Projection::Rectilinear(_) => Model::Ideal(Ideal::Rectilinear),
        Projection::Cylindrical(_) => Model::Panorama(Panorama::Cylindrical),
        Projection::Equirectangular(_) => Model::Panorama(Panorama::Equirectangular),
    })
}

fn numbers<'a>(list: impl IntoIterator<Item = &'a Placed<f64>>) -> Vec<f64> {
    list.into_iter().map(|v| v.value).collect()
}

fn four(list: &Placed<[Placed<f64>; 4]>) -> [f64; 4] {
    exact(Some(list))
}

/// So many numbers, 0 where none are given.
fn exact<const N: usize>(list: Option<&Placed<[Placed<f64>; N]>>) -> [f64; N] {
    list.map_or([0.0; N], |list| core::array::from_fn(|i| list.value[i].value))
}

fn thin_prism(r: &record::ThinPrismFisheye) -> Result<ThinPrismFisheye, ModelError> {
    let terms = DistortionTerms {
        numerator: exact(r.plane_k.as_ref()),
        tangential: exact(r.p.as_ref()),
        prism: exact(r.s.as_ref()),
        ..DistortionTerms::default()
    };
    ThinPrismFisheye::new(KannalaBrandt::long(exact(r.k.as_ref()))?, terms)
}

/// k1, k2, p1, p2.
fn mei(list: Option<&Placed<[Placed<f64>; 4]>>) -> DistortionTerms {
    let [k1, k2, p1, p2] = exact(list);
    DistortionTerms { numerator: [k1, k2, 0.0, 0.0], tangential: [p1, p2], ..DistortionTerms::default() }
}

fn affine(stretch: &record::Stretch) -> Affine {
    let or = |v: &Option<Placed<f64>>, default: f64| v.as_ref().map_or(default, |v| v.value);
    Affine { c: or(&stretch.c, 1.0), d: or(&stretch.d, 0.0), e: or(&stretch.e, 0.0) }
}

fn radial(r: &record::Radial) -> Result<RadialDistortion, ModelError> {
    let sense = match r.direction.value {
        Direction::IdealToObserved => Sense::IdealToObserved,
        Direction::ObservedToIdeal => Sense::ObservedToIdeal,
    };
    let k2 = r.k2.as_ref().map_or(0.0, |k| k.value);
    let refused = |_| ModelError { name: "k1".to_owned(), value: r.k1.value, expected: "finite coefficients" };
    RadialDistortion::new(sense, r.k1.value, k2, 1.0).map_err(refused)
}

fn f_theta(r: &record::FTheta) -> Result<FTheta, ModelError> {
    let sense = match r.maps.value {
        record::FThetaSense::AngleToRadius => FThetaSense::AngleToRadius,
        record::FThetaSense::RadiusToAngle => FThetaSense::RadiusToAngle,
    };
    let coefficients = [vec![0.0], numbers(&r.polynomial)].concat();
    FTheta::new(sense, coefficients, r.greatest_angle_deg.value.to_radians(), affine(&r.stretch))
}

fn centre(record: &Centre, raster: &Raster) -> DVec2 {
    let default = raster.principal_px();
    let or = |v: &Option<Placed<f64>>, default: f64| v.as_ref().map_or(default, |v| v.value);
    DVec2::new(or(&record.cx_px, default.x), or(&record.cy_px, default.y))
}

/// Of a plane whose unit a pixel is so large in.
fn in_units(record: &Centre, pixel: DVec2, raster: &Raster) -> CameraMatrix {
    let at = centre(record, raster);
    CameraMatrix { fx: 1.0 / pixel.x, fy: 1.0 / pixel.y, skew: 0.0, cx: at.x, cy: at.y }
}

fn camera_matrix(record: &Matrix, model: &Model, raster: &Raster, context: &mut Context<'_>) -> Option<CameraMatrix> {
    let at = centre(&record.centre, raster);
    let fx = match &record.scale {
        Scale::Columns(fx) => fx.value,
        Scale::Millimetres(mm) => mm.value / raster.pitch_mm().x,
        Scale::FieldOfView(angle) => of_field(angle, model, raster, context)?,
    };
    if let (Some(fy), false) = (&record.fy_px, matches!(record.scale, Scale::Columns(_))) {
        context.fault(
            ErrorCode::NoEffect,
            &fy.place,
            "\"fy_px\" has no effect here, it belongs to \"fx_px\"",
            "remove it",
        );
        return None;
    }
    let fy = record.fy_px.as_ref().map_or(fx, |fy| fy.value);
    let skew = record.skew_px.as_ref().map_or(0.0, |skew| skew.value);
    Some(CameraMatrix { fx, fy, skew, cx: at.x, cy: at.y })
}

/// The farthest image of the edge of the field, in units of the camera matrix: that of an angle at which the image lies at
/// infinity is beyond.
const FARTHEST: f64 = 1e4;

/// fx of a picture that sees a horizontal angle.
fn of_field(angle: &Placed<f64>, model: &Model, raster: &Raster, context: &mut Context<'_>) -> Option<f64> {
    // A whole turn ends behind the camera, where no direction has an image: 1e-12 of it is left out.
    let half = 0.5 * angle.value.to_radians() * (1.0 - 1e-12);
    let (sin, cos) = etendue_core::maths::f64::sin_cos(half);
    let reach = model.project(DVec3::new(sin, 0.0, cos)).map(|point| point.x);
    let reach = reach.filter(|x| *x > 0.0 && *x < FARTHEST);
    if reach.is_none() {
        let edge = 2.0 * model.edge().angle_rad.to_degrees();
        let problem = format!("the projection does not reach {}°", angle.value);
        context.fault(
            ErrorCode::OutOfRange,
            &angle.place,
            problem,
            format!("give less than {edge:.3}°, near which its picture has no end"),
        );
    }
    Some(0.5 * raster.width() as f64 / reach?)
}

/// Field angle, rad, and radius, mm, without the axis; of a file with what was made of it remarked.
pub(super) fn points(table: &Table, context: &mut Context<'_>) -> Option<Vec<(f64, f64)>> {
    let file = match &table.source {
        TableSource::Angles(angles) => {
            let points = angles.iter().zip(table.radius_mm.iter().flatten());
            return Some(points.map(|(angle, radius)| (angle.value.to_radians(), radius.value)).collect());
        }
        TableSource::File(file) => file,
    };
    let assets = context.assets;
    let asset = assets.lens_tables.get(&(file.value.clone(), LensQuantity::Distortion))?;
    asset.notes.iter().for_each(|note| context.remark_on(file.value.display(), note));
    let LensNumbers::Distortion { beside, focal_length_mm: own } = asset.numbers else { return None };
    let stated = table.focal_length_mm.as_ref().map(|mm| mm.value);
    let Some(f) = stated.or(own) else {
        let problem = "does not say for which focal length its distortion is stated";
        context.fault(ErrorCode::MissingKey, &file.place, problem, "add \"focal_length_mm\"");
        return None;
    };
    let ideal = |angle: f64| match beside {
        Undistorted::Tangent => f * tan(angle),
        Undistorted::Angle => f * angle,
    };
    let beyond = asset.points.iter().filter(|(field, _)| *field > 0.0);
    Some(beyond.map(|(field, ratio)| (field.to_radians(), ratio * ideal(field.to_radians()))).collect())
}
