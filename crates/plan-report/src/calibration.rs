//! A calibration's numbers, in the words of `[lens] projection`: what the side-car says can be put into a camera file.

use etendue_projection::model::{FTheta, FThetaSense, Ideal, Ocam, Panorama, Perspective, Tabulated, ThinPrismFisheye};
use etendue_projection::plane::{Affine, DistortionTerms};
use etendue_projection::{Calibration, CameraMatrix, Model, RadialDistortion, Sense};
use etendue_scene::Placed;
use etendue_scene::record::lens::Direction;
use etendue_scene::record::lens::projection::{self as record, Projection};
use serde_json::{Value, json};

/// Model, coefficients, camera matrix (raster coordinates), size and limit.
pub fn keys(calibration: &Calibration) -> Value {
    let [width, height] = calibration.size_px();
    json!({
        "projection": projection(calibration).to_table().to_json(),
        "convention": "as [lens] projection of a camera file; raster: the top-left corner of the image is (0, 0), pixel centres \
                       at +0.5",
        "width_px": width,
        "height_px": height,
        "greatest_angle_deg": calibration.greatest_angle_rad().map(f64::to_degrees),
    })
}

/// The calibration as a camera file states it.
pub fn projection(calibration: &Calibration) -> Projection {
    let matrix = matrix(calibration);
    let centre = matrix.centre.clone();
    match calibration.model() {
        Model::Perspective(m) => {
            Projection::OpenCv(record::OpenCv { distortion: Some(list(opencv(m))), ..record::OpenCv::new(matrix) })
        }
        Model::Radial(m) => Projection::Radial(radial(m, matrix)),
        Model::Division(m) => Projection::Division(record::Division::new(matrix, m.k())),
        Model::FieldOfView(m) => Projection::FieldOfView(record::FieldOfView::new(matrix, m.omega_rad())),
        Model::KannalaBrandt(m) => {
            let [k1, k2, k3, k4, ..] = m.coefficients();
            Projection::KannalaBrandt(record::KannalaBrandt::new(matrix, [k1, k2, k3, k4].map(Placed::from)))
        }
        Model::ThinPrismFisheye(m) => Projection::ThinPrismFisheye(Box::new(thin_prism(m, matrix))),
        Model::Unified(m) => {
            let DistortionTerms { numerator: [k1, k2, ..], tangential: [p1, p2], .. } = m.distortion().terms();
            let distortion = Some([k1, k2, p1, p2].map(Placed::from).into());
            Projection::Unified(record::Unified { distortion, ..record::Unified::new(matrix, m.xi()) })
        }
        Model::ExtendedUnified(m) => {
            Projection::ExtendedUnified(record::ExtendedUnified::new(matrix, m.alpha(), m.beta()))
        }
        Model::DoubleSphere(m) => Projection::DoubleSphere(record::DoubleSphere::new(matrix, m.xi(), m.alpha())),
        Model::Ocam(m) => Projection::Ocam(ocam(m, centre)),
        Model::FTheta(m) => Projection::FTheta(f_theta(m, centre)),
        Model::Tabulated(m) => Projection::Table(table(m, centre)),
        Model::Ideal(m) => ideal(*m, record::Scaled::new(matrix)),
        Model::Panorama(Panorama::Cylindrical) => Projection::Cylindrical(record::Scaled::new(matrix)),
        Model::Panorama(Panorama::Equirectangular) => Projection::Equirectangular(record::Scaled::new(matrix)),
    }
}

fn list<T>(values: impl IntoIterator<Item = T>) -> Vec<Placed<T>> {
    values.into_iter().map(Placed::from).collect()
}

fn matrix(calibration: &Calibration) -> record::Matrix {
    let CameraMatrix { fx, fy, skew, cx, cy } = calibration.matrix();
    let centre = record::Centre { cx_px: Some(cx.into()), cy_px: Some(cy.into()), ..record::Centre::default() };
    let scale = record::Scale::Columns(fx.into());
    record::Matrix { fy_px: Some(fy.into()), skew_px: Some(skew.into()), ..record::Matrix::new(scale, centre) }
}

/// k1, k2, p1, p2, k3 … k6, s1 … s4, τx, τy.
fn opencv(m: &Perspective) -> [f64; 14] {
    let DistortionTerms { numerator: [k1, k2, k3, _], denominator: [k4, k5, k6], tangential, prism } =
        m.distortion().terms();
    let ([p1, p2], [s1, s2, s3, s4]) = (tangential, prism);
    let [tau_x, tau_y] = m.tilt().map_or([0.0; 2], |tilt| tilt.angles_rad());
    [k1, k2, p1, p2, k3, k4, k5, k6, s1, s2, s3, s4, tau_x, tau_y]
}

fn radial(m: &RadialDistortion, matrix: record::Matrix) -> record::Radial {
    let [k1, k2] = m.coefficients();
    let direction = match m.sense() {
        Sense::IdealToObserved => Direction::IdealToObserved,
        Sense::ObservedToIdeal => Direction::ObservedToIdeal,
    };
    record::Radial { k2: Some(k2.into()), ..record::Radial::new(matrix, k1, direction) }
}

fn thin_prism(m: &ThinPrismFisheye, matrix: record::Matrix) -> record::ThinPrismFisheye {
    let terms = m.distortion().terms();
    record::ThinPrismFisheye {
        k: Some(m.fisheye().coefficients().map(Placed::from).into()),
        plane_k: Some(terms.numerator.map(Placed::from).into()),
        p: Some(terms.tangential.map(Placed::from).into()),
        s: Some(terms.prism.map(Placed::from).into()),
        ..record::ThinPrismFisheye::new(matrix)
    }
}

fn stretch(Affine { c, d, e }: Affine) -> record::Stretch {
    record::Stretch { c: Some(c.into()), d: Some(d.into()), e: Some(e.into()), ..record::Stretch::default() }
}

fn ocam(m: &Ocam, centre: record::Centre) -> record::Ocam {
    record::Ocam::new(centre, list(m.coefficients().iter().copied()), stretch(m.affine()))
}

fn f_theta(m: &FTheta, centre: record::Centre) -> record::FTheta {
    let maps = match m.sense() {
        FThetaSense::AngleToRadius => record::FThetaSense::AngleToRadius,
        FThetaSense::RadiusToAngle => record::FThetaSense::RadiusToAngle,
    };
    let polynomial = list(m.coefficients()[1..].iter().copied());
    record::FTheta::new(centre, polynomial, maps, m.greatest_angle_rad().to_degrees(), stretch(m.affine()))
}

/// Its radii are in mm, as all tables come from camera files.
fn table(m: &Tabulated, centre: record::Centre) -> record::Table {
    let angles = list(m.points().map(|(angle, _)| angle.to_degrees()));
    let radii = list(m.points().map(|(_, radius)| radius));
    record::Table { radius_mm: Some(radii), ..record::Table::new(centre, record::TableSource::Angles(angles)) }
}

fn ideal(m: Ideal, scaled: record::Scaled) -> Projection {
    match m {
        Ideal::Equidistant => Projection::Equidistant(scaled),
        Ideal::Equisolid => Projection::Equisolid(scaled),
        Ideal::Stereographic => Projection::Stereographic(scaled),
        Ideal::Orthographic => Projection::Orthographic(scaled),
        Ideal::Rectilinear => Projection::Rectilinear(scaled),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use etendue_optics::Lens;
    use etendue_pipeline::compile_camera;
    use etendue_scene::asset::Assets;
    use etendue_scene::{Overrides, load_camera};
    use std::path::Path;

    fn calibration(projection: &str) -> Calibration {
        let text = format!(
            "format = 1\n[sensor]\nwidth_px = 64\nheight_px = 48\npixel_pitch_um = 6\n[lens]\ntype = \"calibrated\"\n\
             f_number = 4\nprojection = {projection}\n"
        );
        let camera = load_camera(Path::new("camera.toml"), &|_| Ok(text.clone()), &Overrides::default());
        let camera = camera.unwrap_or_else(|faults| panic!("{faults}\n{text}"));
        let body = compile_camera(&camera, &Assets::default()).unwrap_or_else(|faults| panic!("{faults:?}\n{text}"));
        let Lens::Calibrated(lens) = body.lens else { panic!("calibrated") };
        lens.parameters().calibration.clone()
    }

    /// JSON's objects of numbers, texts and lists as TOML's.
    fn toml(value: &Value) -> String {
        let keys = value.as_object().expect("an object").iter();
        format!("{{ {} }}", keys.map(|(key, value)| format!("{key} = {value}")).collect::<Vec<_>>().join(", "))
    }

    #[test]
    fn what_it_says_is_the_same_camera_in_a_camera_file() {
        let matrix = "fx_px = 50, fy_px = 51, skew_px = 0.25, cx_px = 31.5, cy_px = 24.25";
        let stretch = "cx_px = 31.5, cy_px = 24.25, c = 1.01, d = 0.001, e = -0.002";
        let of_matrix = [
            "\"opencv\", distortion = [-0.1, 0.02, 0.001, -0.002, 0.003, 0.01, 0.02, 0.001, 1e-3, 2e-3, 3e-3, 4e-3, 0.01, 0.02]",
            "\"radial\", k1 = -0.1, k2 = 0.01, direction = \"ideal_to_observed\"",
            "\"radial\", k1 = 0.1, direction = \"observed_to_ideal\"",
            "\"division\", k = -0.1",
            "\"field_of_view\", omega_rad = 0.9",
            "\"kannala_brandt\", k = [0.01, 0.002, -0.001, 0.0001]",
            "\"thin_prism_fisheye\", k = [0.01, 0.002, -0.001, 0.0001, 0, 1e-5], p = [1e-3, 2e-3], s = [1e-3, 2e-3, 3e-3, 4e-3]",
            "\"thin_prism_fisheye\", plane_k = [0.01, 0.002, 0.001, 0.0001]",
            "\"unified\", xi = 0.8, distortion = [-0.1, 0.02, 0.001, -0.002]",
            "\"extended_unified\", alpha = 0.6, beta = 1.1",
            "\"double_sphere\", xi = -0.2, alpha = 0.55",
            "\"equidistant\"",
            "\"equisolid\"",
            "\"stereographic\"",
            "\"orthographic\"",
            "\"rectilinear\"",
            "\"cylindrical\"",
            "\"equirectangular\"",
        ];
        let of_pixels = [
            "\"ocam\", polynomial = [-50, 0, 0.002]",
            "\"f_theta\", polynomial = [50, 1, -2], maps = \"angle_to_radius\", greatest_angle_deg = 60",
            "\"f_theta\", polynomial = [0.02, 1e-5], maps = \"radius_to_angle\", greatest_angle_deg = 120",
        ];
        let cases = of_matrix.map(|keys| (keys, matrix)).into_iter().chain(of_pixels.map(|keys| (keys, stretch)));
        for (keys, rest) in cases {
            let camera = calibration(&format!("{{ type = {keys}, {rest} }}"));
            let said = super::keys(&camera);
            assert_eq!(calibration(&toml(&said["projection"])), camera, "{said}");
        }
    }
}
