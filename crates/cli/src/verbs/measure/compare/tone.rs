//! The tone curve that a camera file declares, at the exposures that were measured.
//!
//! ```text
//! raw:      y = b + (w − b) min(s (H + H₀), 1)        b black, w white level
//! picture:  y = y_max tone(min(s (H + H₀), 1))        the file's tone curve; y_max the largest number of the picture
//! ```
//!
//! H₀ is the exposure that charge collects on its way under smear, of a picture as bright all over as the surface that was measured;
//! exposures of such a camera are seconds. Under filters it is that of the column's mean pixel, colours of the light and all.
//! How bright the surface was is no fact of the camera: s is what brings the readings between 5 % and 95 % of the range nearest
//! (least squares of s H on the light that the declared curve reads from them). So the form is compared, and its ends, not the sensitivity.

use super::curve::Curve;
use super::declared::{channel, place_of};
use super::response::{spectrum, weighed};
use super::side::Side;
use etendue_metrology::Estimate;
use etendue_pipeline::plan::{CameraBody, Development};
use etendue_sensor::Sensor;
use etendue_sensor::effects::response::Response;

/// What turns a share of saturation into a reading.
struct Tone<'a> {
    black: f64,
    white: f64,
    /// H₀, s.
    smear_s: f64,
    /// `None`: a straight line.
    development: Option<&'a Development>,
}

/// The curves of the measured exposures.
pub(super) fn declared(body: &CameraBody, measured: &Side, light: &str) -> Result<Vec<Curve>, String> {
    let tone = Tone::of(body, measured, light)?;
    measured.curves.iter().map(|curve| tone.at_points(curve)).collect()
}

/// The light of the mean pixel of a column over that of the channel which was measured there.
fn of_column(sensor: &Sensor, measured: &Side, light: &str) -> Result<f64, String> {
    let p = sensor.parameters();
    if p.channels.len() == 1 {
        return Ok(1.0);
    }
    let spectrum = spectrum(light)?;
    let seen = |c: usize| weighed(spectrum, sensor.responsivity(c)).map(|(weight, _)| weight).sum::<f64>();
    let channel = channel(p, measured.settings.get("channel").map(String::as_str))?;
    let [x, _] = place_of(p, channel);
    let column = (0..p.cfa.height()).map(|y| seen(sensor.channel_at(x, y))).sum::<f64>();
    Ok(column / p.cfa.height() as f64 / seen(channel))
}

impl<'a> Tone<'a> {
    fn of(body: &'a CameraBody, measured: &Side, light: &str) -> Result<Self, String> {
        let sensor = body.sensor.as_ref().ok_or("the camera has no electronics, whose readings were measured")?;
        let smear_s = sensor.parameters().even_smear_s(body.raster.height()) * of_column(sensor, measured, light)?;
        if smear_s > 0.0 && measured.settings.get("exposure_unit").is_some_and(|unit| !unit.is_empty()) {
            return Err("of a camera with smear, whose light counts by time, give exposures in seconds (--exposures)"
                .to_owned());
        }
        match measured.settings.get("readings").map_or("", String::as_str) {
            "raw" if sensor.parameters().read_out.response == Response::Linear => {
                Ok(Self { black: sensor.black_level_dn(), white: sensor.white_level_dn(), smear_s, development: None })
            }
            "raw" => Err("the sensor's response is no straight line: of raw readings only that is declared".to_owned()),
            "picture" => {
                let development =
                    body.development.as_ref().ok_or("the camera has no [processing], of which a picture tells")?;
                let largest =
                    measured.quantities.get("full_scale").ok_or("the measurement does not say its full scale")?;
                Ok(Self { black: 0.0, white: largest.value, smear_s, development: Some(development) })
            }
            "decoded" => {
                Err("the measured readings were decoded before (--encoding): the camera's curve is no longer in them"
                    .to_owned())
            }
            _ => {
                Err("the measurement does not say whether it is of raw readings or of a picture: measure again"
                    .to_owned())
            }
        }
    }

    fn reading(&self, share: f64) -> f64 {
        let share = share.clamp(0.0, 1.0);
        let encoded = self.development.map_or(share, |d| f64::from(d.processing.tone.encode(share as f32)));
        self.black + (self.white - self.black) * encoded
    }

    /// Share of saturation of a reading.
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
            return Err("no exposure reads between 5 % and 95 % of the range: the curve's form is not seen".to_owned());
        }
        let point =
            |(x, _): &(f64, Estimate)| (*x, Estimate::new(self.reading(along / squares * (x + self.smear_s)), 0.0));
        Ok(Curve { points: measured.points.iter().map(point).collect(), ..measured.clone() })
    }
}
