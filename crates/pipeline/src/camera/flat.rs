//! Uniform illumination of the bare sensor, as in EMVA 1288: no lens, no scene, and nothing is traced.
//!
//! Light of one wavelength λ is incident along the normal, equal on all pixels. Mean electrons have a closed form, μ = E R(λ), E the irradiance (W·m⁻²) and R
//! the responsivity of the pixel's channel (e⁻ per W·m⁻²). Photons are counted on the full area of a pixel, as in the standard: μ_p = A E t λ/(hc), so that
//! its quantum efficiency includes the fill factor.
//!
//! [`photon_transfer`] is the standard's series (release 4.0 Linear, method of changing exposure time): levels in equal steps to slightly above saturation,
//! two bright and two dark frames each, then a stack of bright frames at half of saturation and one of dark frames.

use crate::plan::CameraBody;
use etendue_core::Plane;
use etendue_core::quantity::MeanElectrons;
use etendue_sensor::effects::response::Response;
use etendue_sensor::hdr::HighDynamicRange;
use etendue_sensor::photon::photons_per_joule;
use etendue_sensor::{OperatingPoint, Sensor, SensorState};
use std::ops::Range;

/// Last level relative to saturation: the largest temporal variance, which marks saturation, is within the series.
const MAX_LEVEL: f64 = 1.05;

/// Uniform illumination.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlatLight {
    pub wavelength_nm: f64,
    /// Irradiance of the sensor, W·m⁻².
    pub irradiance_w_m2: f64,
}

impl FlatLight {
    /// Light with `photons` on the full area of a pixel in the described exposure.
    ///
    /// # Errors
    /// [`FlatError::NoExposure`] if photons are requested for an exposure of zero.
    pub fn from_photons(sensor: &Sensor, wavelength_nm: f64, photons: f64) -> Result<Self, FlatError> {
        let exposure_s = sensor.parameters().exposure.exposure_s;
        let one = Self { wavelength_nm, irradiance_w_m2: 1.0 };
        match self::photons(sensor, one, exposure_s) {
            _ if photons == 0.0 => Ok(Self { wavelength_nm, irradiance_w_m2: 0.0 }),
            of_one if of_one > 0.0 => Ok(Self { wavelength_nm, irradiance_w_m2: photons / of_one }),
            _ => Err(FlatError::NoExposure),
        }
    }
}

/// The camera without the properties that affect only light through a lens (the angle response), and without exposure control; `None` for a camera without
/// electronics.
#[must_use]
pub fn bare(body: &CameraBody) -> Option<CameraBody> {
    let mut parameters = body.sensor.as_ref()?.parameters().clone();
    parameters.light.angle_response = None;
    parameters.exposure.control = None;
    let sensor = Sensor::new(parameters).expect("a valid sensor remains valid without a part");
    Some(CameraBody { sensor: Some(sensor), ..body.clone() })
}

/// Mean electrons of every pixel in the described exposure, during which the light is on: rows of a global reset that are read later receive no more of it.
/// `None` for a camera without electronics.
#[must_use]
pub fn electrons(body: &CameraBody, light: FlatLight) -> Option<Plane<MeanElectrons>> {
    let sensor = body.sensor.as_ref()?;
    let means =
        |channel| light.irradiance_w_m2 * f64::from(sensor.responsivity(channel).at(light.wavelength_nm as f32));
    let means: Vec<f32> = (0..sensor.responsivities().len()).map(|channel| means(channel) as f32).collect();
    let (width, height) = (body.raster.width(), body.raster.height());
    let pixels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    let samples = pixels.map(|(x, y)| means[sensor.channel_at(x, y)]).collect();
    Plane::from_samples(width, height, samples)
}

/// Photons on a pixel's full area in a time.
#[must_use]
pub fn photons(sensor: &Sensor, light: FlatLight, exposure_s: f64) -> f64 {
    let pitch_m = sensor.parameters().pixel.pitch_um * 1e-6;
    pitch_m * pitch_m * light.irradiance_w_m2 * exposure_s * photons_per_joule(light.wavelength_nm)
}

/// Reasons for which a sensor has no photon transfer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum FlatError {
    /// No channel responds to the light.
    #[error("the sensor does not respond to this wavelength; give one at which its quantum efficiency is above 0")]
    Blind,
    /// Photons are requested for an exposure of zero.
    #[error("no photons reach a pixel in the camera's \"exposure_s\", which is 0; give a longer one, or 0 photons")]
    NoExposure,
    /// The longest exposure of the series is zero.
    #[error("photon transfer uses exposures up to the camera's \"exposure_s\", which is 0; give a longer one")]
    NoTime,
    /// Digital numbers are not proportional to the charge of single pixels.
    #[error(
        "photon transfer requires digital numbers proportional to the charge of single pixels; remove \"hdr\", \
         \"companding\", \"response\" and \"binning\" from the camera's [sensor] (a file with \"base\" and \"without\" \
         does)"
    )]
    NotLinear,
}

/// Consecutive frames of the same light and exposure.
#[derive(Clone, Debug, PartialEq)]
pub struct FrameStack {
    /// Exposure time, s.
    pub exposure_s: f64,
    /// Photons per pixel; 0 in the dark.
    pub photons: f64,
    /// Frame numbers.
    pub frames: Range<u32>,
}

impl FrameStack {
    /// State of the sensor before its next frame, after one that left `state`; before the first frame an idle sensor.
    #[must_use]
    pub fn state(&self, sensor: &Sensor, state: SensorState) -> SensorState {
        let analogue_gain = sensor.parameters().read_out.analogue_gain;
        SensorState { operating_point: Some(OperatingPoint { exposure_s: self.exposure_s, analogue_gain }), ..state }
    }
}

/// Series of EMVA 1288.
#[derive(Clone, Debug, PartialEq)]
pub struct PhotonTransfer {
    /// Light of the bright frames.
    pub light: FlatLight,
    /// All stacks, in the order of capture.
    pub stacks: Vec<FrameStack>,
}

/// Series of a bare sensor: `levels` exposures up to the described one, at which the most sensitive channel is slightly above
/// saturation, and two stacks of `many` frames.
///
/// # Errors
/// [`FlatError`].
pub fn photon_transfer(
    sensor: &Sensor,
    wavelength_nm: f64,
    levels: u32,
    many: u32,
) -> Result<PhotonTransfer, FlatError> {
    let p = sensor.parameters();
    let linear = p.hdr == HighDynamicRange::default() && p.read_out.response == Response::Linear;
    if !linear || p.read_out.layout.binning.is_some() {
        return Err(FlatError::NotLinear);
    }
    if p.exposure.exposure_s <= 0.0 {
        return Err(FlatError::NoTime);
    }
    let max_response =
        sensor.responsivities().iter().map(|r| f64::from(r.at(wavelength_nm as f32))).fold(0.0, f64::max);
    if max_response <= 0.0 {
        return Err(FlatError::Blind);
    }
    let light = FlatLight { wavelength_nm, irradiance_w_m2: MAX_LEVEL * saturation_e(sensor) / max_response };
    let longest_s = p.exposure.exposure_s;
    let mut series = PhotonTransfer { light, stacks: Vec::new() };
    for level in 1..=levels {
        series.add(sensor, longest_s * f64::from(level) / f64::from(levels), 2);
    }
    series.add(sensor, 0.5 * longest_s / MAX_LEVEL, many);
    Ok(series)
}

/// Electrons at which the digital number saturates: at the full well, or at the ADC's limit if it is lower.
fn saturation_e(sensor: &Sensor) -> f64 {
    let read_out = &sensor.parameters().read_out;
    let dn = sensor.white_level_dn() - sensor.black_level_dn();
    dn / (read_out.gain_dn_e * read_out.analogue_gain * read_out.digital_gain)
}

impl PhotonTransfer {
    /// Adds bright frames, and as many dark ones.
    fn add(&mut self, sensor: &Sensor, exposure_s: f64, count: u32) {
        for photons in [photons(sensor, self.light, exposure_s), 0.0] {
            let first = self.stacks.last().map_or(0, |stack| stack.frames.end);
            self.stacks.push(FrameStack { exposure_s, photons, frames: first..first + count });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compile_camera;
    use etendue_scene::asset::Assets;
    use etendue_scene::{Overrides, load_camera};
    use std::path::Path;

    const CAMERA: &str = "format = 1\n[lens]\ntype = \"pinhole\"\nfocal_length_mm = 5\nf_number = 8\n[sensor]\nwidth_px = 4\n\
        height_px = 2\npixel_pitch_um = 5\nfill_factor = 0.5\nexposure_s = 0.01\ncfa = \"rggb\"\nquantum_efficiency = [0.2, 0.6, 0.4]\n\
        full_well_e = 10000\nread_noise_e = 0\ndark_current_e_s = 0\ngain_dn_per_e = 0.1\nblack_level_dn = 10\nbits = 12\n\
        auto_exposure = { percentile = 50, target = 0.5, exposure_limits_s = [0.001, 0.1], gain_limits = [1, 2] }\n\
        angle_response = { table = [[0, 1], [30, 0.5]], exit_pupil_mm = 5 }\n";

    fn body(more: &str) -> CameraBody {
        body_of(&format!("{CAMERA}{more}"))
    }

    fn body_of(text: &str) -> CameraBody {
        let read = |_: &Path| Ok(text.to_owned());
        let camera = load_camera(Path::new("camera.toml"), &read, &Overrides::default()).expect("a camera");
        bare(&compile_camera(&camera, &Assets::default()).expect("it compiles")).expect("it has electronics")
    }

    #[test]
    fn even_light_gives_each_channel_its_efficiency_of_the_photons() {
        let body = body("");
        let sensor = body.sensor.as_ref().expect("electronics");
        let light = FlatLight { wavelength_nm: 550.0, irradiance_w_m2: 0.01 };
        let electrons = electrons(&body, light).expect("electronics");
        let photons = photons(sensor, light, 0.01);
        // Responsivities are f32. The fill factor is part of the standard's efficiency.
        for (x, y, efficiency) in [(0, 0, 0.2), (1, 0, 0.6), (2, 1, 0.6), (3, 1, 0.4)] {
            let actual = f64::from(electrons.at(x, y)) / photons;
            assert!((actual / (0.5 * efficiency) - 1.0).abs() < 3e-7, "{x} {y}: {actual}");
        }
        // 5 µm, 10 ms, 550 nm, 1 µW/cm²: the standard's numerical form.
        assert!((photons / (50.341_165_675_4 * 25.0 * 10.0 * 0.55) - 1.0).abs() < 1e-9, "{photons}");
    }

    #[test]
    fn the_series_passes_saturation_and_halves_it() {
        let body = body("");
        let sensor = body.sensor.as_ref().expect("electronics");
        let series = photon_transfer(sensor, 550.0, 50, 100).expect("linear");
        assert_eq!(series.stacks.len(), 102);
        let frames: Vec<u32> = series.stacks.iter().flat_map(|s| s.frames.clone()).collect();
        assert_eq!(frames, (0..400).collect::<Vec<u32>>());
        let electrons = |i: usize| 0.3 * series.stacks[i].photons;
        assert!((electrons(98) - 10_500.0).abs() < 0.01 && (electrons(100) - 5000.0).abs() < 0.01);
        assert_eq!((series.stacks[99].photons, series.stacks[98].exposure_s), (0.0, 0.01));
        assert!(sensor.parameters().exposure.control.is_none() && sensor.parameters().light.angle_response.is_none());
    }

    #[test]
    fn what_has_no_photon_transfer_is_refused() {
        let curved = body("response = { type = \"logarithmic\", from_e = 1000 }\n");
        let sensor = curved.sensor.as_ref().expect("electronics");
        assert_eq!(photon_transfer(sensor, 550.0, 50, 100), Err(FlatError::NotLinear));
        let timeless = body_of(&CAMERA.replace("exposure_s = 0.01", "exposure_s = 0").replace("auto_exposure", "#"));
        let sensor = timeless.sensor.as_ref().expect("electronics");
        assert_eq!(photon_transfer(sensor, 550.0, 50, 100), Err(FlatError::NoTime));
        let blind = body_of(&CAMERA.replace("[0.2, 0.6, 0.4]", "0"));
        let sensor = blind.sensor.as_ref().expect("electronics");
        assert_eq!(photon_transfer(sensor, 550.0, 50, 100), Err(FlatError::Blind));
    }
}
