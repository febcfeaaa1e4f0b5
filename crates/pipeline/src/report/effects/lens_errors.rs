//! Errors, in closed form, of an image without a property of its lens.

use crate::plan::CameraBody;
use etendue_core::WavelengthRange;
use glam::DVec2;

/// Number of radii at which a curve is evaluated.
const RADII: u32 = 64;

/// Maximum displacement of an image point by the radial distortion, px; `None` for a lens without it.
pub(super) fn distortion_px(body: &CameraBody) -> Option<f64> {
    let distortion = body.lens.distortion()?;
    let (reach_mm, pitch_mm) = (body.raster.max_radius_mm(), body.raster.pitch_mm().x);
    let radii = (1..=RADII).map(|i| reach_mm * f64::from(i) / f64::from(RADII));
    let shifts = radii.filter_map(|r_mm| Some((distortion.ideal_radius_mm(r_mm)? - r_mm).abs() / pitch_mm));
    Some(shifts.fold(0.0, f64::max))
}

/// Darkening of the corner farthest from the axis relative to the axis, %, under uniform illumination: cos⁴ and clipping by clear apertures. For a
/// prescription the error of the quadrature is 1e-5.
pub(super) fn vignetting_percent(body: &CameraBody) -> Option<f64> {
    let axis_sr = body.lens.projected_solid_angle_sr(DVec2::ZERO);
    let corner_sr = body.lens.projected_solid_angle_sr(farthest_corner_mm(body));
    (axis_sr > 0.0).then(|| 100.0 * (1.0 - corner_sr / axis_sr))
}

fn farthest_corner_mm(body: &CameraBody) -> DVec2 {
    let (width, height) = (body.raster.width() as f64, body.raster.height() as f64);
    let corners = [[0.0, 0.0], [width, 0.0], [0.0, height], [width, height]];
    let corners = corners.map(|px| body.raster.sensor_mm(DVec2::from(px)));
    corners.into_iter().fold(DVec2::ZERO, |far, one| if one.length() > far.length() { one } else { far })
}

/// Blur diameter of a point on the axis at a depth (m), px.
pub(super) fn blur_px(body: &CameraBody, depth_m: f64) -> f64 {
    body.lens.circle_of_confusion_mm(depth_m) / body.raster.pitch_mm().x
}

/// Range of the image size within wavelengths (nm), at the farthest corner, px; `None` if no lateral colour was added to the lens.
pub(super) fn lateral_colour_px(body: &CameraBody, range: WavelengthRange) -> Option<f64> {
    let colour = body.lens.lateral_colour()?;
    let WavelengthRange { low_nm, high_nm } = range;
    let sizes = (0..=RADII).map(|i| colour.at(low_nm + (high_nm - low_nm) * f64::from(i) / f64::from(RADII)));
    let (min, max) = sizes.fold((f64::INFINITY, 0.0_f64), |(a, b), size| (a.min(size), b.max(size)));
    Some((max - min) * body.raster.max_radius_mm() / body.raster.pitch_mm().x)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::effects::tests::plan_of;

    /// Corner of 120 × 80 px of 6 µm.
    const CORNER_MM: DVec2 = DVec2::new(0.36, 0.24);

    fn body(lens: &str) -> CameraBody {
        plan_of(lens, "", "", "").cameras[0].body.clone()
    }

    #[test]
    fn a_corner_of_a_pinhole_is_darker_by_the_fourth_power_of_a_cosine() {
        let body = body("lens = { type = \"pinhole\", focal_length_mm = 1, f_number = 8 }");
        let tangent_squared = CORNER_MM.length_squared();
        let expected = 100.0 * (1.0 - 1.0 / ((1.0 + tangent_squared) * (1.0 + tangent_squared)));
        let actual = vignetting_percent(&body).expect("light on the axis");
        assert!((actual - expected).abs() < 1e-9, "{actual} for {expected}");
    }

    #[test]
    fn a_distortion_shifts_the_corner_by_its_cube() {
        let lens = "lens = { type = \"pinhole\", focal_length_mm = 1, f_number = 8, distortion = { direction = \
                    \"observed_to_ideal\", radius_unit = \"focal_lengths\", k1 = 0.1 } }";
        let radius_mm = CORNER_MM.length();
        let actual = distortion_px(&body(lens)).expect("it has one");
        assert!((actual - 0.1 * radius_mm * CORNER_MM.length_squared() / 0.006).abs() < 1e-9, "{actual}");
        assert_eq!(distortion_px(&body("lens = { type = \"pinhole\", focal_length_mm = 1, f_number = 8 }")), None);
    }

    #[test]
    fn colours_come_apart_with_the_distance_from_the_axis() {
        let lens = "lens = { type = \"pinhole\", focal_length_mm = 1, f_number = 8, lateral_colour = { wavelength_nm = [400, \
                    700], magnification = [1.001, 1.0] } }";
        let actual = lateral_colour_px(&body(lens), WavelengthRange::new(400.0, 700.0)).expect("it has one");
        // Sizes are relative to that at 587.56 nm, which is 1.000 37.
        let expected = 1e-3 / (1.001 - 1e-3 * (587.56 - 400.0) / 300.0) * CORNER_MM.length() / 0.006;
        assert!((actual - expected).abs() < 1e-6, "{actual} for {expected}");
    }
}
