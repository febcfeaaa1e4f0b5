//! Values that a camera file declares for measured quantities: the same keys and units, exact.
//!
//! | measurement | declared |
//! | --- | --- |
//! | distortion | k1, k2 in half diagonals in the direction that the file states, the curve r / (c tan θ) along the half diagonal (if it was measured about the principal point) |
//! | focal, calibrate | principal distance in pixels and mm, principal point, k1 and k2 if the measured model defines them equally |
//! | vignetting | étendue of a pixel relative to the centre, the mean of the four half diagonals, with the pixels' response over angle |
//! | ptc | gain, dark noise, DSNU and PRNU of pixels, rows and columns, dark current, quantum efficiency at a wavelength (of the measured channel, with crosstalk from neighbours of other colours) |
//! | dark-current | the dark current at each temperature by the file's law, and its doubling temperature if that is the law |
//! | chromatic | no displacement, for a lens without chromatic aberration |
//! | oecf | the tone curve of raw readings or of the image, at a free scale of the light |
//! | sfr | [`response`]: pixel aperture, crosstalk between neighbours, diffraction or a point-spread image |
//!
//! Limitations: effects that the file causes but does not state (shifts by aberrations, blooming).

use std::collections::BTreeMap;

use etendue_core::maths::f64::atan;
use etendue_metrology::{Estimate, photon_transfer::temperature::ZERO_CELSIUS_K};
use etendue_pipeline::plan::CameraBody;
use etendue_projection::DistortionDirection;
use etendue_sensor::effects::temperature::{Temperature, TemperatureLaw};
use etendue_sensor::{SensorParameters, effects::dark_current::DarkCurrent};
use glam::DVec2;

use super::super::distortion::centre_words;
use super::side::{ComparisonSide, Light, Quantity, channel};
use super::{mean::Curve, response, tone};

type Quantities = BTreeMap<String, Quantity>;

/// Declared values for a measurement.
pub(crate) fn side(body: &CameraBody, measured: &ComparisonSide, light: &Light) -> Result<ComparisonSide, String> {
    let Light { wavelength_nm, illuminant } = light;
    let (wavelength_nm, illuminant) = (*wavelength_nm, illuminant.as_deref());
    if wavelength_nm.is_some() && measured.kind != "ptc" {
        return Err("`wavelength_nm` applies to photon transfer (ptc) only".to_owned());
    }
    if illuminant.is_some() && !["sfr", "oecf"].contains(&measured.kind.as_str()) {
        return Err("`illuminant` applies to the response of edges (sfr) and to tone curves (oecf) only".to_owned());
    }
    let mut quantities = Quantities::new();
    let mut add_quantity = |key: &str, value: f64, unit: &str| {
        quantities.insert(key.to_owned(), Quantity::declared(value, unit));
    };
    let curves = match measured.kind.as_str() {
        "distortion" => {
            distortion(body, &mut add_quantity);
            // The declared curve is relative to the principal point.
            let own = centre_words(body.raster.principal_px());
            let same = measured.settings.get("centre_px").is_none_or(|centre| *centre == own);
            if same { along(measured, |field| ratio(body, field)) } else { Vec::new() }
        }
        "focal" | "calibrate" => {
            intrinsics(body, measured, &mut add_quantity);
            Vec::new()
        }
        "vignetting" => {
            add_quantity("corner_percent", 100.0 * illumination(body, 1.0), "%");
            along(measured, |field| Some(100.0 * illumination(body, field)))
        }
        "ptc" => {
            electronics(body, measured, wavelength_nm, &mut add_quantity)?;
            Vec::new()
        }
        "dark-current" => growth(body, measured, &mut add_quantity)?,
        "chromatic" => {
            achromatic(body, &mut add_quantity)?;
            along(measured, |_| Some(0.0))
        }
        "oecf" => tone::declared(body, measured, illuminant.unwrap_or("D65"))?,
        "sfr" => response::declared(body, measured, illuminant.unwrap_or("D65"))?,
        kind => return Err(format!("a camera file states no quantity that measure {kind} determines")),
    };
    Ok(ComparisonSide {
        kind: measured.kind.clone(),
        settings: measured.settings.clone(),
        quantities,
        curves,
        angles_deg: measured.angles_deg.clone(),
    })
}

/// The declared curve at the positions of the measured one.
fn along(measured: &ComparisonSide, at: impl Fn(f64) -> Option<f64>) -> Vec<Curve> {
    measured.curves.iter().map(|c| at_points(c, |percent| at(percent / 100.0))).collect()
}

fn at_points(measured: &Curve, at: impl Fn(f64) -> Option<f64>) -> Curve {
    let point = |(x, _): &(f64, Estimate)| Some((*x, Estimate::new(at(*x)?, 0.0)));
    Curve { points: measured.points.iter().filter_map(point).collect(), ..measured.clone() }
}

/// Half the image diagonal, px.
fn half_px(body: &CameraBody) -> DVec2 {
    0.5 * DVec2::new(body.raster.width() as f64, body.raster.height() as f64)
}

/// The four positions at a radial field position about a point of the image, mm from the principal point.
fn places(body: &CameraBody, field: f64, about_px: DVec2) -> [DVec2; 4] {
    [[-1.0, -1.0], [1.0, -1.0], [-1.0, 1.0], [1.0, 1.0]]
        .map(|sign| body.raster.sensor_mm(about_px + field * half_px(body) * DVec2::from(sign)))
}

fn distortion(body: &CameraBody, add_quantity: &mut impl FnMut(&str, f64, &str)) {
    let Some(d) = body.lens.distortion() else { return };
    let direction = match d.sense() {
        DistortionDirection::IdealToObserved => "forward",
        DistortionDirection::ObservedToIdeal => "backward",
    };
    let unit = body.raster.half_diagonal_mm() / d.unit_mm();
    let [k1, k2] = d.coefficients();
    add_quantity(&format!("{direction}_k1"), k1 * unit * unit, "");
    add_quantity(&format!("{direction}_k2"), k2 * unit * unit * unit * unit, "");
    add_quantity(&format!("{direction}_centre_x_px"), body.raster.principal_px().x, "px");
    add_quantity(&format!("{direction}_centre_y_px"), body.raster.principal_px().y, "px");
}

/// Observed over ideal distance from the principal point.
fn ratio(body: &CameraBody, field: f64) -> Option<f64> {
    let relative_radius =
        |at: DVec2| Some(at.length() / (body.lens.principal_distance_mm() * body.lens.tangent(at)?.length()));
    places(body, field, body.raster.principal_px())
        .into_iter()
        .try_fold(0.0, |sum, at| Some(sum + 0.25 * relative_radius(at)?))
}

fn intrinsics(body: &CameraBody, measured: &ComparisonSide, add_quantity: &mut impl FnMut(&str, f64, &str)) {
    let matrix = body.raster.camera_matrix(body.lens.principal_distance_mm());
    let pitch = body.raster.pitch_mm();
    for (key, px, pitch) in [("fx", matrix.fx, pitch.x), ("fy", matrix.fy, pitch.y)] {
        add_quantity(&format!("{key}_px"), px, "px");
        add_quantity(&format!("{key}_mm"), px * pitch, "mm");
    }
    add_quantity("cx_px", matrix.cx, "px");
    add_quantity("cy_px", matrix.cy, "px");
    let sense = match measured.settings.get("model").map_or("", String::as_str) {
        "opencv" | "opencv5" | "radial" => DistortionDirection::IdealToObserved,
        "radial-inverse" => DistortionDirection::ObservedToIdeal,
        _ => return,
    };
    let Some(d) = body.lens.distortion().filter(|d| d.sense() == sense) else { return };
    let unit = body.lens.principal_distance_mm() / d.unit_mm();
    let [k1, k2] = d.coefficients();
    add_quantity("k1", k1 * unit * unit, "");
    add_quantity("k2", k2 * unit * unit * unit * unit, "");
}

/// Irradiance at a pixel relative to that at the image centre.
fn illumination(body: &CameraBody, field: f64) -> f64 {
    let angles = body.sensor.as_ref().and_then(|s| s.parameters().light.angle_response.as_ref());
    let response = |at: DVec2| angles.map_or(1.0, |a| a.at(atan(at.length() / a.exit_pupil_mm).to_degrees()));
    let light = |field: f64| {
        places(body, field, half_px(body))
            .iter()
            .map(|at| body.lens.projected_solid_angle_sr(*at) * response(*at))
            .sum::<f64>()
    };
    light(field) / light(0.0)
}

fn electronics(
    body: &CameraBody,
    measured: &ComparisonSide,
    wavelength_nm: Option<f64>,
    add_quantity: &mut impl FnMut(&str, f64, &str),
) -> Result<(), String> {
    let sensor = body.sensor.as_ref().ok_or("the camera has no electronics, which photon transfer measures")?;
    let p = sensor.parameters();
    let gain = p.read_out.gain_dn_e * p.read_out.analogue_gain * p.read_out.digital_gain;
    add_quantity("gain_dn_per_e", gain, "DN/e⁻");
    add_quantity("dark_noise_e", dark_noise_e(p), "e⁻");
    add_quantity("dark_current_mean_e_per_s", p.charge.dark.mean_e_s(), "e⁻/s");
    let (offset, response) = (p.voltage.offset, p.light.photo_response);
    for (part, e, response_fraction) in [
        ("pixel", offset.white_e, response.white),
        ("row", offset.row_e, response.row),
        ("column", offset.column_e, response.column),
    ] {
        add_quantity(&format!("dsnu_e_{part}"), e, "e⁻");
        add_quantity(&format!("prnu_percent_{part}"), 100.0 * response_fraction, "%");
    }
    if let Some(nm) = wavelength_nm {
        let channel = channel(p, measured.settings.get("channel").map(String::as_str))?;
        add_quantity("quantum_efficiency", sensor.image_quantum_efficiencies(nm)[channel], "");
    }
    Ok(())
}

/// Dark current at the measured temperatures.
fn growth(
    body: &CameraBody,
    measured: &ComparisonSide,
    add_quantity: &mut impl FnMut(&str, f64, &str),
) -> Result<Vec<Curve>, String> {
    let dark = body.sensor.as_ref().map(|s| s.parameters().charge.dark);
    let (dark, stated) = dark.and_then(|dark| Some((dark, dark.temperature?))).ok_or(
        "the camera states no temperature of its dark current; give [sensor.dark] temperature_c and reference_c",
    )?;
    if let TemperatureLaw::Doubling { step_k } = stated.law {
        add_quantity("doubling_doubling_k", step_k, "K");
    }
    let sensor = |celsius: f64| Temperature { sensor_k: celsius + ZERO_CELSIUS_K, ..stated };
    let at = |celsius: f64| DarkCurrent { temperature: Some(sensor(celsius)), ..dark }.mean_e_s();
    Ok(measured.curves.iter().map(|c| at_points(c, |celsius| Some(at(celsius)))).collect())
}

/// Red and blue coincide with green.
fn achromatic(body: &CameraBody, add_quantity: &mut impl FnMut(&str, f64, &str)) -> Result<(), String> {
    if body.lens.spreads_colours() || body.front.is_some() {
        let reason = "the lateral colour of this lens has no closed form; expected a lens without lateral_colour and [external_optics]";
        return Err(reason.to_owned());
    }
    for channel in ["red", "blue"] {
        ["x", "y"].iter().for_each(|axis| add_quantity(&format!("{channel}_shift_{axis}_px"), 0.0, "px"));
    }
    Ok(())
}

/// Noise of the signal chain in a pixel without light, at exposures too short for dark current.
fn dark_noise_e(p: &SensorParameters) -> f64 {
    let noise = &p.voltage.noise;
    (noise.white_e * noise.white_e + noise.row_e * noise.row_e + noise.column_e * noise.column_e).sqrt()
}
