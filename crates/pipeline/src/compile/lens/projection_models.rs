//! Models of calibrated cameras in `[lens] projection`, both ways: from a record to the model, and from the model to the record in a side-car or a camera
//! file.

use etendue_projection::model::{
    Division, DoubleSphere, ExtendedUnified, FTheta, FThetaSense, FieldOfView, Ideal, KannalaBrandt, ModelError, Ocam,
    Panorama, Perspective, TabulatedProjection, ThinPrismFisheye, Unified,
};
use etendue_projection::plane::{Affine, DistortionTerms};
use etendue_projection::{Calibration, CameraMatrix, DistortionDirection, Model, RadialDistortion};
use etendue_scene::Placed;
use etendue_scene::record::lens::Direction;
use etendue_scene::record::lens::projection::{self as record, Centre, Matrix, Projection};

/// Scaling of a projection's plane: in units of a camera matrix, in pixels or in mm.
pub(super) enum Scaling<'a> {
    Matrix(&'a Matrix),
    Pixels(&'a Centre),
    Millimetres(&'a Centre),
}

/// Scaling of a projection.
pub(super) fn scale(record: &Projection) -> Scaling<'_> {
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

/// Model of a projection; `points` are those of a table.
///
/// # Errors
/// Illegal numbers.
pub(super) fn model(record: &Projection, points: &[(f64, f64)]) -> Result<Model, ModelError> {
    Ok(match record {
        Projection::OpenCv(r) => Model::Perspective(Perspective::from_opencv(&numbers(r.distortion.iter().flatten()))?),
        Projection::Radial(r) => Model::Radial(radial(r)?),
        Projection::Division(r) => Model::Division(Division::new(r.k.value)?),
        Projection::FieldOfView(r) => Model::FieldOfView(FieldOfView::new(r.omega_rad.value)?),
        Projection::KannalaBrandt(r) => Model::KannalaBrandt(KannalaBrandt::new(four_numbers(&r.k))?),
        Projection::ThinPrismFisheye(r) => Model::ThinPrismFisheye(thin_prism(r)?),
        Projection::Unified(r) => Model::Unified(Unified::new(r.xi.value, mei(r.distortion.as_ref()))?),
        Projection::ExtendedUnified(r) => Model::ExtendedUnified(ExtendedUnified::new(r.alpha.value, r.beta.value)?),
        Projection::DoubleSphere(r) => Model::DoubleSphere(DoubleSphere::new(r.xi.value, r.alpha.value)?),
        Projection::Ocam(r) => Model::Ocam(Ocam::new(numbers(&r.polynomial), affine(&r.stretch))?),
        Projection::FTheta(r) => Model::FTheta(f_theta(r)?),
        Projection::Table(_) => Model::Tabulated(TabulatedProjection::new(points)?),
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

fn four_numbers(list: &Placed<[Placed<f64>; 4]>) -> [f64; 4] {
    numbers_or_zero(Some(list))
}

/// A list of N numbers; zeros if none are stated.
fn numbers_or_zero<const N: usize>(list: Option<&Placed<[Placed<f64>; N]>>) -> [f64; N] {
    list.map_or([0.0; N], |list| core::array::from_fn(|i| list.value[i].value))
}

fn thin_prism(r: &record::ThinPrismFisheye) -> Result<ThinPrismFisheye, ModelError> {
    let terms = DistortionTerms {
        numerator: numbers_or_zero(r.plane_k.as_ref()),
        tangential: numbers_or_zero(r.p.as_ref()),
        prism: numbers_or_zero(r.s.as_ref()),
        ..DistortionTerms::default()
    };
    ThinPrismFisheye::new(KannalaBrandt::long(numbers_or_zero(r.k.as_ref()))?, terms)
}

/// k1, k2, p1, p2.
fn mei(list: Option<&Placed<[Placed<f64>; 4]>>) -> DistortionTerms {
    let [k1, k2, p1, p2] = numbers_or_zero(list);
    DistortionTerms { numerator: [k1, k2, 0.0, 0.0], tangential: [p1, p2], ..DistortionTerms::default() }
}

fn affine(stretch: &record::AffineMap) -> Affine {
    let or = |v: &Option<Placed<f64>>, default: f64| v.as_ref().map_or(default, |v| v.value);
    Affine { c: or(&stretch.c, 1.0), d: or(&stretch.d, 0.0), e: or(&stretch.e, 0.0) }
}

fn radial(r: &record::Radial) -> Result<RadialDistortion, ModelError> {
    let sense = match r.direction.value {
        Direction::IdealToObserved => DistortionDirection::IdealToObserved,
        Direction::ObservedToIdeal => DistortionDirection::ObservedToIdeal,
    };
    let k2 = r.k2.as_ref().map_or(0.0, |k| k.value);
    let error = |_| ModelError { name: "k1".to_owned(), value: r.k1.value, expected: "finite coefficients" };
    RadialDistortion::new(sense, r.k1.value, k2, 1.0).map_err(error)
}

fn f_theta(r: &record::FTheta) -> Result<FTheta, ModelError> {
    let sense = match r.maps.value {
        record::FThetaSense::AngleToRadius => FThetaSense::AngleToRadius,
        record::FThetaSense::RadiusToAngle => FThetaSense::RadiusToAngle,
    };
    let coefficients = [vec![0.0], numbers(&r.polynomial)].concat();
    FTheta::new(sense, coefficients, r.greatest_angle_deg.value.to_radians(), affine(&r.stretch))
}

/// The calibration as a camera file states it.
pub fn stated_projection(calibration: &Calibration) -> Projection {
    let matrix = stated_matrix(calibration);
    let centre = matrix.centre.clone();
    match calibration.model() {
        Model::Perspective(m) => Projection::OpenCv(record::OpenCv {
            distortion: Some(list(stated_opencv(m))),
            ..record::OpenCv::new(matrix)
        }),
        Model::Radial(m) => Projection::Radial(stated_radial(m, matrix)),
        Model::Division(m) => Projection::Division(record::Division::new(matrix, m.k())),
        Model::FieldOfView(m) => Projection::FieldOfView(record::FieldOfView::new(matrix, m.omega_rad())),
        Model::KannalaBrandt(m) => {
            let [k1, k2, k3, k4, ..] = m.coefficients();
            Projection::KannalaBrandt(record::KannalaBrandt::new(matrix, [k1, k2, k3, k4].map(Placed::from)))
        }
        Model::ThinPrismFisheye(m) => Projection::ThinPrismFisheye(Box::new(stated_thin_prism(m, matrix))),
        Model::Unified(m) => {
            let DistortionTerms { numerator: [k1, k2, ..], tangential: [p1, p2], .. } = m.distortion().terms();
            let distortion = Some([k1, k2, p1, p2].map(Placed::from).into());
            Projection::Unified(record::Unified { distortion, ..record::Unified::new(matrix, m.xi()) })
        }
        Model::ExtendedUnified(m) => {
            Projection::ExtendedUnified(record::ExtendedUnified::new(matrix, m.alpha(), m.beta()))
        }
        Model::DoubleSphere(m) => Projection::DoubleSphere(record::DoubleSphere::new(matrix, m.xi(), m.alpha())),
        Model::Ocam(m) => Projection::Ocam(stated_ocam(m, centre)),
        Model::FTheta(m) => Projection::FTheta(stated_f_theta(m, centre)),
        Model::Tabulated(m) => Projection::Table(stated_table(m, centre)),
        Model::Ideal(m) => stated_ideal(*m, record::ScaledProjection::new(matrix)),
        Model::Panorama(Panorama::Cylindrical) => Projection::Cylindrical(record::ScaledProjection::new(matrix)),
        Model::Panorama(Panorama::Equirectangular) => {
            Projection::Equirectangular(record::ScaledProjection::new(matrix))
        }
    }
}

fn list<T>(values: impl IntoIterator<Item = T>) -> Vec<Placed<T>> {
    values.into_iter().map(Placed::from).collect()
}

fn stated_matrix(calibration: &Calibration) -> Matrix {
    let CameraMatrix { fx, fy, skew, cx, cy } = calibration.matrix();
    let centre = Centre { cx_px: Some(cx.into()), cy_px: Some(cy.into()), ..Centre::default() };
    let scale = record::Scale::Columns(fx.into());
    Matrix { fy_px: Some(fy.into()), skew_px: Some(skew.into()), ..Matrix::new(scale, centre) }
}

/// k1, k2, p1, p2, k3 … k6, s1 … s4, τx, τy.
fn stated_opencv(m: &Perspective) -> [f64; 14] {
    let DistortionTerms { numerator: [k1, k2, k3, _], denominator: [k4, k5, k6], tangential, prism } =
        m.distortion().terms();
    let ([p1, p2], [s1, s2, s3, s4]) = (tangential, prism);
    let [tau_x, tau_y] = m.tilt().map_or([0.0; 2], |tilt| tilt.angles_rad());
    [k1, k2, p1, p2, k3, k4, k5, k6, s1, s2, s3, s4, tau_x, tau_y]
}

fn stated_radial(m: &RadialDistortion, matrix: Matrix) -> record::Radial {
    let [k1, k2] = m.coefficients();
    let direction = match m.sense() {
        DistortionDirection::IdealToObserved => Direction::IdealToObserved,
        DistortionDirection::ObservedToIdeal => Direction::ObservedToIdeal,
    };
    record::Radial { k2: Some(k2.into()), ..record::Radial::new(matrix, k1, direction) }
}

fn stated_thin_prism(m: &ThinPrismFisheye, matrix: Matrix) -> record::ThinPrismFisheye {
    let terms = m.distortion().terms();
    record::ThinPrismFisheye {
        k: Some(m.fisheye().coefficients().map(Placed::from).into()),
        plane_k: Some(terms.numerator.map(Placed::from).into()),
        p: Some(terms.tangential.map(Placed::from).into()),
        s: Some(terms.prism.map(Placed::from).into()),
        ..record::ThinPrismFisheye::new(matrix)
    }
}

fn stated_stretch(Affine { c, d, e }: Affine) -> record::AffineMap {
    record::AffineMap { c: Some(c.into()), d: Some(d.into()), e: Some(e.into()), ..record::AffineMap::default() }
}

fn stated_ocam(m: &Ocam, centre: Centre) -> record::Ocam {
    record::Ocam::new(centre, list(m.coefficients().iter().copied()), stated_stretch(m.affine()))
}

fn stated_f_theta(m: &FTheta, centre: Centre) -> record::FTheta {
    let maps = match m.sense() {
        FThetaSense::AngleToRadius => record::FThetaSense::AngleToRadius,
        FThetaSense::RadiusToAngle => record::FThetaSense::RadiusToAngle,
    };
    let polynomial = list(m.coefficients()[1..].iter().copied());
    record::FTheta::new(centre, polynomial, maps, m.max_angle_rad().to_degrees(), stated_stretch(m.affine()))
}

/// Radii are in mm, because all tables come from camera files.
fn stated_table(m: &TabulatedProjection, centre: Centre) -> record::Table {
    let angles = list(m.points().map(|(angle, _)| angle.to_degrees()));
    let radii = list(m.points().map(|(_, radius)| radius));
    record::Table { radius_mm: Some(radii), ..record::Table::new(centre, record::TableSource::Angles(angles)) }
}

fn stated_ideal(m: Ideal, scaled: record::ScaledProjection) -> Projection {
    match m {
        Ideal::Equidistant => Projection::Equidistant(scaled),
        Ideal::Equisolid => Projection::Equisolid(scaled),
        Ideal::Stereographic => Projection::Stereographic(scaled),
        Ideal::Orthographic => Projection::Orthographic(scaled),
        Ideal::Rectilinear => Projection::Rectilinear(scaled),
    }
}
