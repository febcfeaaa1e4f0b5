//! Images of rectified cameras.
//!
//! The image of a rectified camera is the developed one resampled, linearly between pixels, in linear light before the tone curve, as software does with an
//! image of the camera. The sensor's noise, demosaicing, vignetting and blur are therefore the camera's own. Values are not rescaled: a uniform image remains
//! uniform. Where the camera sees nothing, or the position is outside its image, the result is black.

use crate::plan::CameraBody;
use crate::plan::rectified::RectifiedCamera;
use etendue_core::Plane;
use etendue_core::quantity::{Display, LinearRgb};
use etendue_core::random::FrameAddress;
use glam::DVec2;
use rayon::prelude::*;

impl RectifiedCamera {
    /// The camera's image in the raster of the rectified camera, in linear light. Runs on the caller's pool.
    #[must_use]
    pub fn resampled(&self, camera: &CameraBody, linear: &Plane<LinearRgb>) -> Plane<LinearRgb> {
        let (width, height) = (self.body().raster.width(), self.body().raster.height());
        let value = |i: usize| {
            let centre = DVec2::new((i % width) as f64, (i / width) as f64) + 0.5;
            self.source(camera, centre).and_then(|at| between(linear, at)).unwrap_or([0.0; 3])
        };
        let samples = (0..width * height).into_par_iter().map(value).collect();
        Plane::from_samples(width, height, samples).expect("one sample a pixel")
    }

    /// The rectified image with the camera's tone curve and sharpening; `None` for a camera without processing. The address is that of the noise of the image
    /// filters.
    #[must_use]
    pub fn picture(
        &self,
        camera: &CameraBody,
        linear: &Plane<LinearRgb>,
        address: FrameAddress,
    ) -> Option<Plane<Display>> {
        let processing = &camera.development.as_ref()?.processing;
        Some(processing.displayed(&self.resampled(camera, linear), address))
    }
}

/// Interpolated value of an image; up to half a pixel from its edge that of the outermost pixel, `None` outside.
fn between(image: &Plane<LinearRgb>, at: DVec2) -> Option<[f32; 3]> {
    let last = DVec2::new((image.width() - 1) as f64, (image.height() - 1) as f64);
    let from_centre = at - 0.5;
    if !(from_centre.cmpge(DVec2::splat(-0.5)).all() && from_centre.cmple(last + 0.5).all()) {
        return None;
    }
    let place = from_centre.clamp(DVec2::ZERO, last);
    let low = place.floor();
    let fraction = place - low;
    let [x0, y0] = [low.x as usize, low.y as usize];
    let [x1, y1] = [(x0 + 1).min(image.width() - 1), (y0 + 1).min(image.height() - 1)];
    let mix = |a: f32, b: f32, t: f64| f64::from(a) * (1.0 - t) + f64::from(b) * t;
    let (a, b, c, d) = (image.at(x0, y0), image.at(x1, y0), image.at(x0, y1), image.at(x1, y1));
    Some(core::array::from_fn(|i| {
        let (upper, lower) = (mix(a[i], b[i], fraction.x), mix(c[i], d[i], fraction.x));
        (upper * (1.0 - fraction.y) + lower * fraction.y) as f32
    }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::rays::ray_table;
    use etendue_scene::asset::Assets;
    use etendue_scene::{Overrides, load_camera};
    use glam::DVec3;
    use std::path::Path;

    fn body(lens: &str) -> CameraBody {
        let text = format!(
            "format = 1\n[sensor]\nwidth_px = 64\nheight_px = 48\npixel_pitch_um = 100\n[lens]\nf_number = 4\n{lens}"
        );
        let camera = load_camera(Path::new("camera.toml"), &|_| Ok(text.clone()), &Overrides::default());
        let camera = camera.unwrap_or_else(|errors| panic!("{errors}"));
        crate::compile_camera(&camera, &Assets::default()).unwrap_or_else(|errors| panic!("{errors:?}"))
    }

    fn calibrated(projection: &str) -> CameraBody {
        body(&format!("type = \"calibrated\"\nprojection = {{ {projection} }}\n"))
    }

    #[test]
    fn a_camera_without_distortion_is_its_own_rectified_camera() {
        for camera in [
            body("type = \"pinhole\"\nfocal_length_mm = 7\n"),
            body("type = \"thin\"\nfocal_length_mm = 7\nfocus_distance_m = 2\n"),
            calibrated("type = \"opencv\", fx_px = 70, fy_px = 71, cx_px = 30, cy_px = 25"),
        ] {
            let rectified = RectifiedCamera::new(&camera, 1.0).expect("a twin");
            assert_eq!(ray_table(rectified.body()), ray_table(&camera), "to the bit");
            let image = Plane::from_samples(64, 48, (0..64 * 48).map(|i| [i as f32, 0.5, (i % 7) as f32]).collect());
            let image = image.expect("filled");
            let same = rectified.resampled(&camera, &image);
            // Positions are recovered to 1e-12 px, over which neighbours differ by up to 64.
            let close = |(a, b): (&[f32; 3], &[f32; 3])| (0..3).all(|i| (a[i] - b[i]).abs() <= 1e-6 * (1.0 + b[i]));
            assert!(same.samples().iter().zip(image.samples()).all(close));
        }
    }

    #[test]
    fn rays_of_a_rectified_camera_are_those_of_its_matrix() {
        let cases = [
            (
                "type = \"opencv\", fx_px = 70, fy_px = 71, cx_px = 30, cy_px = 25, distortion = [-0.3, 0.1, 0.001, 0.002]",
                [70.0, 71.0],
            ),
            ("type = \"kannala_brandt\", fx_px = 40, cx_px = 31, cy_px = 25, k = [0.01, 0, 0, 0]", [40.0, 40.0]),
            // Mei's x = X/(Z + ξ): near the axis 1/(1 + ξ) of the tangent.
            ("type = \"unified\", fx_px = 90, xi = 0.8", [50.0, 50.0]),
            ("type = \"ocam\", polynomial = [-60, 0, 0.001]", [60.0, 60.0]),
        ];
        for (projection, focal) in cases {
            for scale in [1.0, 0.5] {
                let camera = calibrated(projection);
                let RectifiedCamera { matrix, body } = RectifiedCamera::new(&camera, scale).expect("a twin");
                assert!(
                    (matrix.fx / (scale * focal[0]) - 1.0).abs() < 1e-12
                        && (matrix.fy / (scale * focal[1]) - 1.0).abs() < 1e-12
                );
                assert_eq!(DVec2::new(matrix.cx, matrix.cy), camera.raster.principal_px());
                for at in [DVec2::ZERO, DVec2::new(64.0, 48.0), DVec2::new(11.5, 40.5)] {
                    let ray = body.lens.principal_ray(body.raster.sensor_mm(at)).expect("seen");
                    let expected =
                        DVec3::new((at.x - matrix.cx) / matrix.fx, (at.y - matrix.cy) / matrix.fy, 1.0).normalize();
                    assert!(ray.origin_m == DVec3::ZERO && (ray.direction - expected).length() < 1e-15, "{projection}");
                }
            }
        }
    }

    #[test]
    fn an_even_picture_stays_even_and_what_is_not_seen_is_black() {
        let camera = calibrated("type = \"opencv\", fx_px = 50, distortion = [-0.2, 0.02, 0, 0]");
        let uniform = Plane::filled(64, 48, [0.25, 0.5, 1.0]);
        // Barrel distortion is expanded: the rectified camera of the same scale shows a part of the image, that of half the scale the whole, with black
        // around it.
        let of = |scale| RectifiedCamera::new(&camera, scale).expect("a twin").resampled(&camera, &uniform);
        assert!(of(1.0).samples().iter().all(|v| *v == [0.25, 0.5, 1.0]));
        let small = of(0.5);
        assert_eq!((small.at(0, 0), small.at(32, 24)), ([0.0; 3], [0.25, 0.5, 1.0]));
        assert!(small.samples().iter().all(|v| *v == [0.0; 3] || *v == [0.25, 0.5, 1.0]));
    }

    #[test]
    fn cameras_without_a_rectified_camera_state_the_reason() {
        let reason =
            |camera: &CameraBody| RectifiedCamera::new(camera, 1.0).map(|_| ()).expect_err("no twin").to_string();
        let wide = reason(&calibrated("type = \"equidistant\", fx_px = 20"));
        assert!(wide.contains("114.6°") && wide.contains("85°"), "{wide}");
        assert!(reason(&body("type = \"telecentric\"\nfield_width_m = 1\n")).contains("telecentric"));
    }
}
