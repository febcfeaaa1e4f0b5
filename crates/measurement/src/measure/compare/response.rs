//! The edge response that a camera file declares in closed form.
//!
//! ```text
//! MTF(ν) = sinc(a ν cos θ) sinc(a ν sin θ) · neighbours(ν) · lens(ν)
//!                                     ν in cycles per pixel along the edge's normal, θ from the normal to the nearest of rows and columns
//! neighbours: Σ w_n r_n cos(2π ν n·d_n)/Σ w_n r_n       w_n light received from neighbour n at d_n (n the normal), r_n its
//! response to the light
//! lens: circular pupil: 2/π (arccos s − s √(1 − s²)), s = λ N ν w/pitch, averaged over the light that the pixel sees; w relative
//! width of
//!       the pattern at the edge's place: 1/cos³ θ′ along the radius, 1/cos θ′ across it
//!       image of a point: Σ L cos(2π ν x)/Σ L; tables over the field: |Σ L exp(2πi ν x)|/Σ L at the edge's place
//! ```
//!
//! a is the side of the photosensitive area. Frequencies are those of the image, also for one colour of a mosaic. The lens is in
//! focus; its point-spread image is evaluated along the row or column nearest to the normal.
//!
//! Refused, as this model does not describe them: lenses other than a thin one or a pinhole, glare, ghosts, glass before the
//! lens, blades, obstructions and wavefront errors, capacitance between pixels, developed images of mosaics.

use std::f64::consts::{PI, TAU};

use etendue_core::maths::f64::{acos, cos, sin, sin_cos};
use etendue_metrology::Estimate;
use etendue_optics::effects::{PointSpread, PsfParameters, SpreadImage};
use etendue_pipeline::plan::CameraBody;
use etendue_spectra::Spectrum;
use glam::DVec2;

use super::mean::Curve;
use super::side::{ComparisonSide, channel, place_of, spectrum, weighed};

/// Inputs of a camera's response curves.
struct ResponseInputs<'a> {
    body: &'a CameraBody,
    /// (weight, columns to the right, rows down) of the pixels whose light contributes to a reading; the weights sum to 1.
    neighbours: Vec<(f64, f64, f64)>,
    /// (weight, wavelength, nm); the weights sum to 1.
    light: Vec<(f64, f64)>,
}

/// The declared curves at the measured frequencies.
pub(crate) fn declared(body: &CameraBody, measured: &ComparisonSide, light: &str) -> Result<Vec<Curve>, String> {
    in_closed_form(body)?;
    let response = ResponseInputs::from_body(body, measured, light)?;
    Ok(measured.curves.iter().map(|curve| response.at_points(curve, measured)).collect())
}

fn in_closed_form(body: &CameraBody) -> Result<(), String> {
    let thin = ["thin lens", "pinhole"].contains(&body.lens.kind());
    if !thin || body.effects.glare().is_some() || body.effects.ghosts().is_some() || body.front.is_some() {
        return Err("the response of this lens has no closed form; expected a thin lens or pinhole without glare, ghosts and [external_optics]"
            .to_owned());
    }
    if body.sensor.as_ref().is_some_and(|s| s.parameters().voltage.capacitance.is_some()) {
        return Err("the response has no closed form with interpixel capacitance".to_owned());
    }
    match body.effects.psf() {
        Some(PointSpread::Aperture(psf)) if !is_plain(psf.parameters()) => {
            Err("the response of this pupil has no closed form; expected a circle without wavefront errors".to_owned())
        }
        _ => Ok(()),
    }
}

/// True for a circular pupil without errors.
fn is_plain(psf: &PsfParameters) -> bool {
    psf.blades == 0 && psf.obstruction == 0.0 && psf.wavefront.is_empty()
}

impl<'a> ResponseInputs<'a> {
    fn from_body(body: &'a CameraBody, measured: &ComparisonSide, light: &str) -> Result<Self, String> {
        let spectrum = spectrum(light)?;
        let alone = |light| Self { body, neighbours: vec![(1.0, 0.0, 0.0)], light };
        let Some(sensor) = &body.sensor else { return Ok(alone(weights(spectrum, &Spectrum::constant(1.0)))) };
        let p = sensor.parameters();
        let mosaic = p.cfa.width() * p.cfa.height() > 1;
        if mosaic && measured.settings.get("readings").is_some_and(|readings| readings != "raw") {
            return Err(
                "the response of a demosaiced image has no closed form; measure one colour of the raw image (`channel`)"
                    .to_owned(),
            );
        }
        let channel = channel(p, measured.settings.get("channel").map(String::as_str))?;
        let light = weights(spectrum, sensor.responsivity(channel));
        let response_of = |c: usize| weighed(spectrum, sensor.responsivity(c)).map(|(weight, _)| weight).sum::<f64>();
        let at = place_of(p, channel);
        let mut neighbours = Vec::new();
        for (dx, dy) in (0..9).map(|n| (n % 3, n / 3)) {
            let crosstalk_weight =
                p.light.crosstalk.map_or(f64::from(u8::from((dx, dy) == (1, 1))), |c| c.0.weight(dx, dy));
            let there = sensor.channel_at(at[0] + p.cfa.width() + dx - 1, at[1] + p.cfa.height() + dy - 1);
            neighbours.push((crosstalk_weight * response_of(there), dx as f64 - 1.0, dy as f64 - 1.0));
        }
        let sum: f64 = neighbours.iter().map(|(weight, ..)| weight).sum();
        neighbours.iter_mut().for_each(|(weight, ..)| *weight /= sum);
        Ok(Self { body, neighbours, light })
    }

    fn at_points(&self, measured: &Curve, side: &ComparisonSide) -> Curve {
        let words = || measured.name.split(' ');
        let down = words().any(|word| word == "vertical");
        let angle_deg = words().find_map(|word| side.angles_deg.get(word)).copied().unwrap_or(0.0);
        let (sine, cosine) = sin_cos(angle_deg.to_radians());
        let place = words().find_map(place_px);
        let at = |nu: f64| {
            let aperture = nu * self.body.aperture_px;
            let pixel = sinc(aperture * cosine) * sinc(aperture * sine);
            pixel * self.exchanged(nu * cosine, nu * sine, down) * self.lens(nu, down, place)
        };
        let points = measured.points.iter().map(|(x, _)| (*x, Estimate::new(at(*x).abs(), 0.0))).collect();
        Curve { points, ..measured.clone() }
    }

    /// `across` is the frequency along the nearest of rows and columns, `along` the other. The sign of the edge's angle does not
    /// matter, as neighbours on both sides are under the same filters.
    fn exchanged(&self, across: f64, along: f64, down: bool) -> f64 {
        let wave = |x: f64, y: f64| {
            let (near, far) = if down { (y, x) } else { (x, y) };
            cos(TAU * across * near) * cos(TAU * along * far)
        };
        self.neighbours.iter().map(|(weight, x, y)| weight * wave(*x, *y)).sum()
    }

    /// Diffraction depends on the place on the sensor: the pupil looks smaller from off the axis.
    fn lens(&self, nu: f64, down: bool, place_px: Option<DVec2>) -> f64 {
        let pitch = self.body.raster.pitch_mm();
        let per_mm = nu / if down { pitch.y } else { pitch.x };
        let axis = if down { DVec2::Y } else { DVec2::X };
        let average =
            |response_at: &dyn Fn(f64) -> f64| self.light.iter().map(|(weight, nm)| weight * response_at(*nm)).sum();
        match self.body.effects.psf() {
            None => 1.0,
            Some(PointSpread::Aperture(psf)) => {
                let place = place_px.map_or(DVec2::ZERO, |at| (at - self.body.raster.principal_px()) * pitch);
                let outwards = place.try_normalize().unwrap_or(DVec2::X);
                let [along, across] = psf.stretch(place.length());
                let wider = DVec2::new(along * axis.dot(outwards), across * axis.perp_dot(outwards)).length();
                average(&|nm| diffraction(nm * 1e-6 * psf.f_number() * per_mm * wider))
            }
            Some(PointSpread::Image(image)) => average(&|nm| image_response(image, nm, per_mm, down)),
            Some(PointSpread::Table(table)) => {
                let place = place_px.map_or(DVec2::ZERO, |at| (at - self.body.raster.principal_px()) * pitch);
                // Wavelengths add before the modulus is taken.
                let weighted_transfer = |(weight, nm): &(f64, f64)| *weight * table.transfer(*nm, place, axis * per_mm);
                self.light.iter().map(weighted_transfer).sum::<DVec2>().length()
            }
        }
    }
}

/// Position from its columns and rows, as edges are named.
fn place_px(word: &str) -> Option<DVec2> {
    let (x, y) = word.split_once(',')?;
    Some(DVec2::new(x.parse().ok()?, y.parse().ok()?))
}

fn weights(light: &Spectrum, responsivity: &Spectrum) -> Vec<(f64, f64)> {
    let sum: f64 = weighed(light, responsivity).map(|(weight, _)| weight).sum();
    weighed(light, responsivity).filter(|(weight, _)| *weight > 0.0).map(|(weight, nm)| (weight / sum, nm)).collect()
}

fn sinc(x: f64) -> f64 {
    if x == 0.0 { 1.0 } else { sin(PI * x) / (PI * x) }
}

/// MTF of a circular pupil; s is the frequency relative to the cut-off.
fn diffraction(s: f64) -> f64 {
    if s >= 1.0 { 0.0 } else { 2.0 / PI * (acos(s) - s * (1.0 - s * s).sqrt()) }
}

/// MTF of a point-spread image, cycles per mm on the sensor.
fn image_response(image: &SpreadImage, nm: f64, per_mm: f64, down: bool) -> f64 {
    let p = image.parameters();
    let step_mm = 1e-3 * p.pitch_um * p.wavelength_nm.map_or(1.0, |at| nm / at);
    let middle = 0.5 * if down { p.height() as f64 } else { p.width as f64 };
    let (mut along, mut sum) = (0.0, 0.0);
    for (i, light) in p.light.iter().enumerate() {
        let index = if down { i / p.width } else { i % p.width };
        along += f64::from(*light) * cos(TAU * per_mm * step_mm * (index as f64 + 0.5 - middle));
        sum += f64::from(*light);
    }
    along / sum
}
