//! The tone curve that a camera file declares, at the measured exposures.
//!
//! ```text
//! raw:      y = b + (w − b) min(s (H + H₀), 1)        b black, w white level
//! image:    y = y_max tone(min(s (H + H₀), 1))        the file's tone curve; y_max the largest number of the image
//! ```
//!
//! H₀ is the exposure that charge collects during transfer (smear), for an image as bright all over as the measured surface;
//! exposures of such a camera are in seconds. With colour filters it is that of the column's mean pixel, including the colours of
//! the light:
//! - of raw readings of one colour: s̄/L of that colour (L its response to the light, s̄ that of the mean pixel of its columns);
//! - of a developed image: the value after white balance w and colour matrix M of all colours, Σ_c M_c w_c s̄_c/Σ_c M_c w_c L_c
//!   in the row of the measured channel.
//!
//! Readings follow the curve applied to noisy light; their mean is not the curve of the mean light. The declared mean is
//! therefore that of light whose scatter gives the noise of the measured readings, less that of rounding
//! ([`noisy_mean`](etendue_metrology::oecf)). This matters in the dark, where a tone curve bends, and near saturation.
//!
//! The brightness of the surface is not a property of the camera: s is fitted to the readings between 5 % and 95 % of the range
//! (least squares of s H against the light that the declared curve assigns to them). So the form of the curve and its ends are
//! compared, not the sensitivity.

use etendue_isp::WhiteBalance;
use etendue_metrology::{Estimate, oecf::noisy_mean};
use etendue_pipeline::plan::{CameraBody, Development};
use etendue_sensor::{Sensor, effects::response::Response};
use etendue_spectra::colour::BT709;

use super::mean::Curve;
use super::side::{ComparisonSide, channel, place_of, spectrum, weighed};

/// Conversion from a fraction of saturation to a reading.
struct DeclaredTone<'a> {
    black: f64,
    white: f64,
    /// H₀, s.
    smear_s: f64,
    /// `None`: linear.
    development: Option<&'a Development>,
}

/// The curves at the measured exposures.
pub(crate) fn declared(body: &CameraBody, measured: &ComparisonSide, light: &str) -> Result<Vec<Curve>, String> {
    let tone = DeclaredTone::from_body(body, measured, light)?;
    measured.curves.iter().map(|curve| tone.at_points(curve)).collect()
}

/// The light of a column's mean pixel relative to that of the measured channel, after development if the image was developed.
fn column_light(
    sensor: &Sensor,
    development: Option<&Development>,
    measured: &ComparisonSide,
    light: &str,
) -> Result<f64, String> {
    let p = sensor.parameters();
    if p.channels.len() == 1 {
        return Ok(1.0);
    }
    let spectrum = spectrum(light)?;
    let response_of = |c: usize| weighed(spectrum, sensor.responsivity(c)).map(|(weight, _)| weight).sum::<f64>();
    let column = |x: usize| {
        let all = (0..p.cfa.height()).map(|y| response_of(sensor.channel_at(x, y)));
        all.sum::<f64>() / p.cfa.height() as f64
    };
    let name = measured.settings.get("channel").map(String::as_str);
    if let Some(development) = development {
        return developed(sensor, development, name, response_of, column);
    }
    let channel = channel(p, name)?;
    let [x, _] = place_of(p, channel);
    Ok(column(x) / response_of(channel))
}

/// The same in a channel of the developed image; without a name, in its luminance.
fn developed(
    sensor: &Sensor,
    development: &Development,
    channel: Option<&str>,
    response_of: impl Fn(usize) -> f64,
    column: impl Fn(usize) -> f64,
) -> Result<f64, String> {
    let Some(colour) = &development.processing.colour else { return Ok(1.0) };
    let mosaic = &development.mosaic;
    let (mut own, mut smeared) = (vec![0.0; mosaic.channels()], vec![0.0; mosaic.channels()]);
    let (columns, rows) = mosaic.period();
    let mut places = vec![0.0; mosaic.channels()];
    for (x, y) in (0..rows).flat_map(|y| (0..columns).map(move |x| (x, y))) {
        let c = mosaic.channel_at(x, y);
        own[c] += response_of(sensor.channel_at(x, y));
        smeared[c] += column(x);
        places[c] += 1.0;
    }
    let gain = |c: usize| match &colour.white_balance {
        WhiteBalance::Gains(gains) => gains[c] / places[c],
        WhiteBalance::GreyWorld => 1.0 / own[c],
    };
    let balanced = |light: &[f64]| (0..places.len()).map(|c| gain(c) * light[c]).collect::<Vec<f64>>();
    let [own, smeared] = [&own, &smeared].map(|light| colour.matrix.apply(&balanced(light)));
    let weighted_sum = |weights: [f64; 3]| {
        let sum = |rgb: [f64; 3]| weights.iter().zip(rgb).map(|(w, v)| w * v).sum::<f64>();
        sum(smeared) / sum(own)
    };
    match channel {
        Some("R") => Ok(weighted_sum([1.0, 0.0, 0.0])),
        Some("G") => Ok(weighted_sum([0.0, 1.0, 0.0])),
        Some("B") => Ok(weighted_sum([0.0, 0.0, 1.0])),
        Some(other) => Err(format!("the image has no channel '{other}', for which the camera file states a curve")),
        None => Ok(weighted_sum(BT709)),
    }
}

impl<'a> DeclaredTone<'a> {
    fn from_body(body: &'a CameraBody, measured: &ComparisonSide, light: &str) -> Result<Self, String> {
        let sensor = body.sensor.as_ref().ok_or("the camera has no electronics, whose readings were measured")?;
        let is_picture = measured.settings.get("readings").is_some_and(|readings| readings == "picture");
        let development = body.development.as_ref().filter(|_| is_picture);
        let even_s = sensor.parameters().uniform_smear_s(body.raster.height());
        let smear_s = even_s * column_light(sensor, development, measured, light)?;
        if smear_s > 0.0 && measured.settings.get("exposure_unit").is_some_and(|unit| !unit.is_empty()) {
            return Err(
                "the camera has smear, which depends on time; give the exposures in seconds (`exposures`)".to_owned()
            );
        }
        match measured.settings.get("readings").map_or("", String::as_str) {
            "raw" if sensor.parameters().read_out.response == Response::Linear => {
                Ok(Self { black: sensor.black_level_dn(), white: sensor.white_level_dn(), smear_s, development: None })
            }
            "raw" => {
                Err("the sensor's response is not linear; for raw readings only a linear response can be compared"
                    .to_owned())
            }
            "picture" => {
                let development = body
                    .development
                    .as_ref()
                    .ok_or("the camera has no [isp], to which a developed image would be compared")?;
                let largest =
                    measured.quantities.get("full_scale").ok_or("the measurement does not state its full scale")?;
                Ok(Self { black: 0.0, white: largest.value, smear_s, development: Some(development) })
            }
            "decoded" => {
                Err("the measured readings were decoded (`encoding`), which removed the camera's curve".to_owned())
            }
            _ => {
                Err("the measurement does not state whether its readings are raw or developed; repeat the measurement"
                    .to_owned())
            }
        }
    }

    fn reading(&self, fraction: f64) -> f64 {
        let fraction = fraction.clamp(0.0, 1.0);
        let encoded = self.development.map_or(fraction, |d| f64::from(d.processing.tone.encode(fraction as f32)));
        self.black + (self.white - self.black) * encoded
    }

    /// Mean of readings with this noise at a fraction of saturation.
    fn mean_reading(&self, fraction: f64, noise: f64) -> f64 {
        noisy_mean(|fraction| self.reading(fraction), fraction, (noise * noise - 1.0 / 12.0).max(0.0).sqrt())
    }

    /// Fraction of saturation of a reading.
    fn light(&self, reading: f64) -> f64 {
        let encoded = (reading - self.black) / (self.white - self.black);
        self.development.map_or(encoded, |d| f64::from(d.processing.tone.decode(encoded as f32)))
    }

    fn at_points(&self, measured: &Curve) -> Result<Curve, String> {
        let inside = |reading: f64| (0.05..=0.95).contains(&((reading - self.black) / (self.white - self.black)));
        let used = || measured.points.iter().filter(|(_, y)| inside(y.value));
        let along: f64 = used().map(|(x, y)| (x + self.smear_s) * self.light(y.value)).sum();
        let squares: f64 = used().map(|(x, _)| (x + self.smear_s) * (x + self.smear_s)).sum();
        if squares <= 0.0 {
            return Err(
                "no exposure reads between 5 % and 95 % of the range, so the shape of the curve is not determined"
                    .to_owned(),
            );
        }
        let point = |(x, _): &(f64, Estimate)| {
            let noise = measured.noise.iter().find(|(abscissa, _)| abscissa == x).map_or(0.0, |(_, noise)| *noise);
            (*x, Estimate::new(self.mean_reading(along / squares * (x + self.smear_s), noise), 0.0))
        };
        Ok(Curve { points: measured.points.iter().map(point).collect(), ..measured.clone() })
    }
}
