//! Undistorted twins: the rectilinear camera with the same pose and the same centre of the entrance pupil.
//!
//! A twin has a camera matrix K without skew, the picture's size, and rays from the pupil's centre through K; its ground truth
//! and ray table are traced along them and are exact. K keeps the principal point and the focal lengths on the axis
//! (of a projection whose unit is not the tangent of the angle: times dr/dθ there), times a stated scale; a scale below 1
//! shows more of a picture that barrels.
//!
//! Its picture is the developed one resampled, linearly between pixels, in linear light before the tone curve: what software
//! does with a picture of the camera, so that the sensor's noise, demosaicing, vignetting and blur are the camera's own.
//! Values are those of the place they come from, unscaled: an even picture stays even. Where the camera sees nothing, or the
//! place lies outside its picture, the twin is black.
//!
//! Left out: a twin of a telecentric camera, whose rays do not meet, and of fields beyond 85° from the axis, where tangents grow
//! without end. A prescription's twin looks from the centre of the paraxial entrance pupil, which real pupils leave with the
//! field.

use crate::plan::{CameraBody, CameraPlan};
use etendue_core::Plane;
use etendue_core::quantity::{Display, LinearRgb};
use etendue_core::random::FrameAddress;
use etendue_optics::lens::PinholeParameters;
use etendue_optics::{CalibratedParameters, Lens, OpticsError, PupilStance};
use etendue_projection::model::Perspective;
use etendue_projection::{Calibration, CalibrationError, CameraMatrix, Model, Raster, RasterError};
use glam::{DVec2, DVec3};
use rayon::prelude::*;

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
    body: CameraBody,
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

    /// The camera's picture in the twin's raster, in linear light. Runs on the caller's pool.
    #[must_use]
    pub fn resampled(&self, camera: &CameraBody, linear: &Plane<LinearRgb>) -> Plane<LinearRgb> {
        let (width, height) = (self.body.raster.width(), self.body.raster.height());
        let value = |i: usize| {
            let centre = DVec2::new((i % width) as f64, (i / width) as f64) + 0.5;
            self.source(camera, centre).and_then(|at| between(linear, at)).unwrap_or([0.0; 3])
        };
        let samples = (0..width * height).into_par_iter().map(value).collect();
        Plane::from_samples(width, height, samples).expect("one sample a pixel")
    }

    /// The same with the camera's tone curve and sharpening; `None` where it makes no picture. The address is that of the
    /// paper's noises.
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

/// A picture's value between its pixels' centres; at its rim that of the outermost centre, `None` outside.
fn between(picture: &Plane<LinearRgb>, at: DVec2) -> Option<[f32; 3]> {
    let last = DVec2::new((picture.width() - 1) as f64, (picture.height() - 1) as f64);
    let from_centre = at - 0.5;
    if !(from_centre.cmpge(DVec2::splat(-0.5)).all() && from_centre.cmple(last + 0.5).all()) {
        return None;
    }
    let place = from_centre.clamp(DVec2::ZERO, last);
    let low = place.floor();
    let share = place - low;
    let [x0, y0] = [low.x as usize, low.y as usize];
    let [x1, y1] = [(x0 + 1).min(picture.width() - 1), (y0 + 1).min(picture.height() - 1)];
    let mix = |a: f32, b: f32, t: f64| f64::from(a) * (1.0 - t) + f64::from(b) * t;
    let (a, b, c, d) = (picture.at(x0, y0), picture.at(x1, y0), picture.at(x0, y1), picture.at(x1, y1));
    Some(core::array::from_fn(|i| {
        let (upper, lower) = (mix(a[i], b[i], share.x), mix(c[i], d[i], share.x));
        (upper * (1.0 - share.y) + lower * share.y) as f32
    }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::rays::ray_table;
    use etendue_scene::asset::Assets;
    use etendue_scene::{Overrides, load_camera};
    use std::path::Path;

    fn body(lens: &str) -> CameraBody {
        let text = format!(
            "format = 1\n[sensor]\nwidth_px = 64\nheight_px = 48\npixel_pitch_um = 100\n[lens]\nf_number = 4\n{lens}"
        );
        let camera = load_camera(Path::new("camera.toml"), &|_| Ok(text.clone()), &Overrides::default());
        let camera = camera.unwrap_or_else(|faults| panic!("{faults}"));
        crate::compile_camera(&camera, &Assets::default()).unwrap_or_else(|faults| panic!("{faults:?}"))
    }

    fn calibrated(projection: &str) -> CameraBody {
        body(&format!("type = \"calibrated\"\nprojection = {{ {projection} }}\n"))
    }

    #[test]
    fn the_twin_of_a_camera_without_distortion_is_itself() {
        for camera in [
            body("type = \"pinhole\"\nfocal_length_mm = 7\n"),
            body("type = \"thin\"\nfocal_length_mm = 7\nfocus_distance_m = 2\n"),
            calibrated("type = \"opencv\", fx_px = 70, fy_px = 71, cx_px = 30, cy_px = 25"),
        ] {
            let twin = RectifiedCamera::of(&camera, 1.0).expect("a twin");
            assert_eq!(ray_table(twin.body()), ray_table(&camera), "to the bit");
            let picture = Plane::from_samples(64, 48, (0..64 * 48).map(|i| [i as f32, 0.5, (i % 7) as f32]).collect());
            let picture = picture.expect("filled");
            let same = twin.resampled(&camera, &picture);
            // Points are found again to 1e-12 px, over which neighbours differ by up to 64.
            let close = |(a, b): (&[f32; 3], &[f32; 3])| (0..3).all(|i| (a[i] - b[i]).abs() <= 1e-6 * (1.0 + b[i]));
            assert!(same.samples().iter().zip(picture.samples()).all(close));
        }
    }

    #[test]
    fn a_twin_s_rays_are_those_of_its_matrix() {
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
                let RectifiedCamera { matrix, body } = RectifiedCamera::of(&camera, scale).expect("a twin");
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
        let even = Plane::filled(64, 48, [0.25, 0.5, 1.0]);
        // A barrel is drawn out: the twin of the same scale shows a part of it, one of half the scale all, and black around.
        let of = |scale| RectifiedCamera::of(&camera, scale).expect("a twin").resampled(&camera, &even);
        assert!(of(1.0).samples().iter().all(|v| *v == [0.25, 0.5, 1.0]));
        let small = of(0.5);
        assert_eq!((small.at(0, 0), small.at(32, 24)), ([0.0; 3], [0.25, 0.5, 1.0]));
        assert!(small.samples().iter().all(|v| *v == [0.0; 3] || *v == [0.25, 0.5, 1.0]));
    }

    #[test]
    fn cameras_without_a_twin_say_why() {
        let refused =
            |camera: &CameraBody| RectifiedCamera::of(camera, 1.0).map(|_| ()).expect_err("no twin").to_string();
        let wide = refused(&calibrated("type = \"equidistant\", fx_px = 20"));
        assert!(wide.contains("114.6°") && wide.contains("85°"), "{wide}");
        assert!(refused(&body("type = \"telecentric\"\nfield_width_m = 1\n")).contains("telecentric"));
    }
}
