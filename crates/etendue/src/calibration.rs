//! A calibration's numbers, in the words of `[lens] projection`: what the side-car says can be put into a camera file.

use etendue_projection::model::{FTheta, FThetaSense, Ideal, Ocam, Panorama, Perspective, ThinPrismFisheye};
use etendue_projection::plane::{Affine, DistortionTerms};
use etendue_projection::{Calibration, Model, RadialDistortion, Sense};
use serde_json::{Value, json};

/// Model, coefficients, camera matrix (raster coordinates), size and limit.
pub(crate) fn keys(calibration: &Calibration) -> Value {
    let [width, height] = calibration.size_px();
    let matrix = calibration.matrix();
    let mut projection = projection(calibration.model());
    let entries = projection.as_object_mut().expect("a projection is an object");
    if !in_pixels(calibration.model()) {
        entries.extend([("fx_px", matrix.fx), ("fy_px", matrix.fy), ("skew_px", matrix.skew)].map(entry));
    }
    entries.extend([("cx_px", matrix.cx), ("cy_px", matrix.cy)].map(entry));
    json!({
        "projection": projection,
        "convention": "as [lens] projection of a camera file; raster: the top-left corner of the image is (0, 0), pixel centres \
                       at +0.5",
        "width_px": width,
        "height_px": height,
        "greatest_angle_deg": calibration.greatest_angle_rad().map(f64::to_degrees),
    })
}

fn entry((key, value): (&str, f64)) -> (String, Value) {
    (key.to_owned(), json!(value))
}

/// Whether the model's own numbers are in pixels.
fn in_pixels(model: &Model) -> bool {
    matches!(model, Model::Ocam(_) | Model::FTheta(_))
}

fn projection(model: &Model) -> Value {
    match model {
        Model::Perspective(m) => json!({ "type": "opencv", "distortion": opencv(m) }),
        Model::Radial(m) => radial(m),
        Model::Division(m) => json!({ "type": "division", "k": m.k() }),
        Model::FieldOfView(m) => json!({ "type": "field_of_view", "omega_rad": m.omega_rad() }),
        Model::KannalaBrandt(m) => json!({ "type": "kannala_brandt", "k": m.coefficients()[..4] }),
        Model::ThinPrismFisheye(m) => thin_prism(m),
        Model::Unified(m) => {
            let DistortionTerms { numerator: [k1, k2, ..], tangential: [p1, p2], .. } = m.distortion().terms();
            json!({ "type": "unified", "xi": m.xi(), "distortion": [k1, k2, p1, p2] })
        }
        Model::ExtendedUnified(m) => json!({ "type": "extended_unified", "alpha": m.alpha(), "beta": m.beta() }),
        Model::DoubleSphere(m) => json!({ "type": "double_sphere", "xi": m.xi(), "alpha": m.alpha() }),
        Model::Ocam(m) => ocam(m),
        Model::FTheta(m) => f_theta(m),
        Model::Ideal(m) => json!({ "type": ideal(*m) }),
        Model::Panorama(Panorama::Cylindrical) => json!({ "type": "cylindrical" }),
        Model::Panorama(Panorama::Equirectangular) => json!({ "type": "equirectangular" }),
    }
}

/// k1, k2, p1, p2, k3 … k6, s1 … s4, τx, τy.
fn opencv(m: &Perspective) -> [f64; 14] {
    let DistortionTerms { numerator: [k1, k2, k3, _], denominator: [k4, k5, k6], tangential, prism } =
        m.distortion().terms();
    let ([p1, p2], [s1, s2, s3, s4]) = (tangential, prism);
    let [tau_x, tau_y] = m.tilt().map_or([0.0; 2], |tilt| tilt.angles_rad());
    [k1, k2, p1, p2, k3, k4, k5, k6, s1, s2, s3, s4, tau_x, tau_y]
}

fn radial(m: &RadialDistortion) -> Value {
    let [k1, k2] = m.coefficients();
    let direction = match m.sense() {
        Sense::IdealToObserved => "ideal_to_observed",
        Sense::ObservedToIdeal => "observed_to_ideal",
    };
    json!({ "type": "radial", "k1": k1, "k2": k2, "direction": direction })
}

fn thin_prism(m: &ThinPrismFisheye) -> Value {
    let terms = m.distortion().terms();
    json!({
        "type": "thin_prism_fisheye",
        "k": m.fisheye().coefficients(),
        "plane_k": terms.numerator,
        "p": terms.tangential,
        "s": terms.prism,
    })
}

fn ocam(m: &Ocam) -> Value {
    let Affine { c, d, e } = m.affine();
    json!({ "type": "ocam", "polynomial": m.coefficients(), "c": c, "d": d, "e": e })
}

fn f_theta(m: &FTheta) -> Value {
    let Affine { c, d, e } = m.affine();
    let maps = match m.sense() {
        FThetaSense::AngleToRadius => "angle_to_radius",
        FThetaSense::RadiusToAngle => "radius_to_angle",
    };
    json!({
        "type": "f_theta",
        "polynomial": m.coefficients()[1..],
        "maps": maps,
        "greatest_angle_deg": m.greatest_angle_rad().to_degrees(),
        "c": c,
        "d": d,
        "e": e,
    })
}

fn ideal(m: Ideal) -> &'static str {
    match m {
        Ideal::Equidistant => "equidistant",
        Ideal::Equisolid => "equisolid",
        Ideal::Stereographic => "stereographic",
        Ideal::Orthographic => "orthographic",
        Ideal::Rectilinear => "rectilinear",
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
