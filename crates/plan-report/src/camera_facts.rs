//! Facts of a camera in the side-car of its results: lens and camera matrix, irradiance effects, sensor.

use crate::calibration;
use etendue_core::Shutter;
use etendue_optics::effects::PointSpread;
use etendue_optics::front::Optic;
use etendue_optics::{DepthOfField, Front, Lens};
use etendue_pipeline::plan::{CameraBody, RowExposure, RowSkipping};
use etendue_projection::DistortionDirection;
use etendue_sensor::figures::CaptureTransition;
use etendue_sensor::{DynamicRange, Sensor};
use serde_json::{Value, json};
use std::collections::BTreeMap;

/// The convention of raster coordinates.
pub const RASTER: &str = "raster: the top-left corner of the image is (0, 0), pixel centres at +0.5";

/// Depth-of-field method of the image.
pub fn depth_of_field(method: &DepthOfField) -> Value {
    match method {
        DepthOfField::None => json!("none"),
        DepthOfField::Physical => json!("physical"),
        DepthOfField::Fast(blend) => {
            let p = blend.parameters();
            let finite = |m: f64| m.is_finite().then_some(m);
            json!({ "fast": {
                "near_m": [p.blurred_near_m, p.sharp_near_m],
                "far_m": [finite(p.sharp_far_m), finite(p.blurred_far_m)],
                "blur_px": p.blur_px,
            } })
        }
    }
}

/// Lens and camera matrix.
pub fn optics(body: &CameraBody) -> Value {
    let lens = &body.lens;
    let calibration = match lens {
        Lens::Calibrated(lens) => Some(&lens.parameters().calibration),
        _ => None,
    };
    let by_lens = || body.raster.camera_matrix(lens.principal_distance_mm());
    let matrix = calibration.map_or_else(by_lens, etendue_projection::Calibration::matrix);
    let mut facts = json!({
        "model": lens.kind(),
        "focal_length_mm": lens.focal_length_mm(),
        "first_order_wavelength_nm": lens.first_order_nm(),
        "f_number": lens.f_number(),
        "t_number": lens.t_number(),
        "working_f_number": lens.working_f_number(),
        "focus_distance_m": lens.focus_distance_m().filter(|m| m.is_finite()),
        "magnification": lens.magnification(),
        "hyperfocal_m_for_1_px": lens.hyperfocal_m(body.raster.pitch_mm().x),
        "entrance_pupil_diameter_mm": 2e3 * lens.entrance_pupil_radius_m(),
        "sensor_plane_from_entrance_pupil_mm": 1e3 * lens.sensor_plane_m(),
        "principal_distance_mm": lens.principal_distance_mm(),
        "transmittance": lens.transmittance(),
        "distortion": distortion(body),
        "calibration": calibration.map(calibration::keys),
        "camera_matrix": matrix.rows(),
        "camera_matrix_convention": RASTER,
        "camera_matrix_opencv": matrix.to_opencv().rows(),
    });
    if let Some(optic) = body.front.as_ref().and_then(Front::optic) {
        facts["in_front"] = json!(format!("{}: the camera matrix is that of the lens without it", optic.name()));
    }
    facts
}

/// Irradiance effects and their margin; null without effects.
pub fn effects(body: &CameraBody) -> Option<Value> {
    let effects = Some(&body.effects).filter(|effects| !effects.is_idle())?;
    let glare = effects.glare().map(|glare| {
        let p = glare.parameters();
        json!({ "scatter": p.scatter, "core_um": p.core_um, "exponent": p.exponent, "reach_mm": p.reach_mm })
    });
    let psf = effects.psf().map(point_spread);
    let ghosts = effects.ghosts().map(|ghosts| json!({ "sensor_reflectance": ghosts.sensor_reflectance() }));
    Some(json!({ "margin_px": effects.margin_px(), "psf": psf, "glare": glare, "ghosts": ghosts }))
}

fn point_spread(spread: &PointSpread) -> Value {
    match spread {
        PointSpread::Aperture(psf) => {
            let p = psf.parameters();
            json!({
                "f_number": psf.f_number(),
                "blades": p.blades,
                "blade_curvature": p.curvature,
                "rotation_deg": p.rotation_rad.to_degrees(),
                "obstruction": p.obstruction,
                "wavefront_terms": p.wavefront.len(),
                "reach_mm": p.reach_mm,
                "patches": psf.patches(),
            })
        }
        PointSpread::Image(image) => {
            let p = image.parameters();
            json!({
                "image_px": [p.width, p.height()],
                "image_pitch_um": p.pitch_um,
                "image_wavelength_nm": p.wavelength_nm,
            })
        }
        PointSpread::Table(table) => json!({
            "field_radii_mm": table.radii_mm(),
            "wavelengths_nm": table.wavelengths_nm(),
            "patches": table.patches(),
        }),
    }
}

/// Distortion of a lens, and the closest fit of the opposite direction over the image.
fn distortion(body: &CameraBody) -> Option<Value> {
    let d = body.lens.distortion()?;
    let [k1, k2] = d.coefficients();
    let other = match d.sense() {
        DistortionDirection::IdealToObserved => DistortionDirection::ObservedToIdeal,
        DistortionDirection::ObservedToIdeal => DistortionDirection::IdealToObserved,
    };
    let fitted = d.fitted(other, body.raster.max_radius_mm()).ok().map(|fit| {
        let [k1, k2] = fit.distortion.coefficients();
        let worst_px = fit.worst_mm / body.raster.pitch_mm().x;
        json!({ "k1": k1, "k2": k2, "direction": direction(other), "largest_difference_px": worst_px })
    });
    Some(json!({
        "k1": k1,
        "k2": k2,
        "radius_unit_mm": d.unit_mm(),
        "direction": direction(d.sense()),
        "fitted_in_the_other_direction": fitted,
    }))
}

/// Direction of a distortion, as camera files spell it.
fn direction(sense: DistortionDirection) -> &'static str {
    match sense {
        DistortionDirection::IdealToObserved => "ideal_to_observed",
        DistortionDirection::ObservedToIdeal => "observed_to_ideal",
    }
}

/// Content of the layer of a camera's mirror; `None` without a mirror.
pub fn mirror(body: &CameraBody) -> Option<&'static str> {
    match body.front.as_ref().and_then(Front::optic)? {
        Optic::Windscreen(_) => None,
        Optic::Mirror(_) => Some(
            "point at which the ray hits the mirror, m, camera frame; NaN: no hit. distance.Z is measured from the \
             pupil via the mirror, and depth.Z is NaN there",
        ),
    }
}

/// Geometry of the sensor and, with electronics, its parameters.
pub fn sensor(body: &CameraBody) -> Value {
    let raster = &body.raster;
    let electronics = body.sensor.as_ref().map(|sensor| {
        let p = sensor.parameters();
        json!({
            "exposure_s": p.exposure.exposure_s,
            "gain_dn_per_e": p.read_out.gain_dn_e,
            "black_level_dn": sensor.black_level_dn(),
            "white_level_dn": sensor.white_level_dn(),
            "full_well_e": p.charge.full_well.capacity_e,
            "read_noise_e": p.voltage.noise.white_e,
            "dark_current_e_s": p.charge.dark.current_e_s,
            "bits": sensor.delivered_bits(),
            "noise": p.noise,
            "effects": sensor_effects(sensor),
            "dynamic_range": dynamic_range(&sensor.dynamic_range()),
            "cfa": {
                "columns": p.cfa.width(),
                "channels": p.cfa.channels().iter().map(|c| p.channels[*c].name.clone()).collect::<Vec<_>>(),
            },
        })
    });
    json!({
        "width_px": raster.width(),
        "height_px": raster.height(),
        "pixel_pitch_um": 1000.0 * raster.pitch_mm().x,
        "principal_point_px": raster.principal_px().to_array(),
        "shutter": shutter(&body.exposure),
        "electronics": electronics,
    })
}

/// Exposure times of the rows.
fn shutter(rows: &RowExposure) -> Value {
    let (word, timing) = match &rows.shutter {
        Shutter::Global => return json!({ "type": "global" }),
        Shutter::Rolling(timing) => ("rolling", timing),
        Shutter::GlobalReset(timing) => ("global_reset", timing),
    };
    let RowSkipping { together, pitch } = rows.skipping;
    let mut report = json!({
        "type": word,
        "row_time_s": timing.row_time_s,
        "direction": if timing.upwards { "up" } else { "down" },
        "fields": timing.fields,
        "first_row": rows.first_row,
        "rows": rows.rows,
    });
    if rows.skipping.skips() {
        report["rows_read"] = json!({ "together": together, "of": pitch });
    }
    report
}

/// Dynamic range of a frame in photo-electrons of the first capture, and the signal-to-noise ratios at the transitions between captures.
fn dynamic_range(range: &DynamicRange) -> Value {
    let switch = |s: &CaptureTransition| json!({ "at_e": s.at_e, "snr_before": s.before, "snr_after": s.after });
    json!({
        "db": range.db(),
        "least_e": range.lower_e,
        "most_e": range.upper_e,
        "switches": range.switches.iter().map(switch).collect::<Vec<_>>(),
    })
}

/// The modelled effects, as the plan words them.
fn sensor_effects(sensor: &Sensor) -> BTreeMap<&'static str, String> {
    let modelled = sensor.effects().into_iter().filter(|effect| effect.status.is_modelled());
    modelled.map(|effect| (effect.name, effect.status.reason().to_owned())).collect()
}
