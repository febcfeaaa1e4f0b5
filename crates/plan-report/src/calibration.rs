//! Calibration data with the keys of `[lens] projection`: the side-car's values can be copied into a camera file.

use etendue_pipeline::stated_projection;
use etendue_projection::Calibration;
use serde_json::{Value, json};

/// Model, coefficients, camera matrix (raster coordinates), size and limit.
pub fn keys(calibration: &Calibration) -> Value {
    let [width, height] = calibration.size_px();
    json!({
        "projection": stated_projection(calibration).to_table().to_json(),
        "convention": "as [lens] projection of a camera file; raster: the top-left corner of the image is (0, 0), pixel centres \
                       at +0.5",
        "width_px": width,
        "height_px": height,
        "greatest_angle_deg": calibration.max_angle_rad().map(f64::to_degrees),
    })
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
        let camera = camera.unwrap_or_else(|errors| panic!("{errors}\n{text}"));
        let body = compile_camera(&camera, &Assets::default()).unwrap_or_else(|errors| panic!("{errors:?}\n{text}"));
        let Lens::Calibrated(lens) = body.lens else { panic!("calibrated") };
        lens.parameters().calibration.clone()
    }

    /// Converts JSON objects of numbers, texts and lists to TOML.
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
            let camera_keys = super::keys(&camera);
            assert_eq!(calibration(&toml(&camera_keys["projection"])), camera, "{camera_keys}");
        }
    }
}
