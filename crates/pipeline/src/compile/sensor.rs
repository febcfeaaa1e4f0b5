//! `[sensor]`: from the record to the sensor's model.

use super::context::Context;
use super::spectrum::curve;
use etendue_scene::Placed;
use etendue_scene::record;
use etendue_scene::record::sensor::{self as description, QuantumEfficiency};
use etendue_sensor::hdr::HighDynamicRange;
use etendue_sensor::{
    BayerPhase, Cfa, Channel, Charge, Exposure, FixedPattern, Optics, Pixel, ReadOut, Sensor, SensorParameters,
};
use etendue_spectra::{Outside, Spectrum, camera};

/// The sensor with its electronics; `None` where the record has none or they are faulty.
pub(super) fn sensor(record: &record::Sensor, context: &mut Context<'_>) -> Option<Sensor> {
    let electronics = record.electronics.as_ref()?;
    let parameters = SensorParameters {
        pixel: Pixel { pitch_um: record.pixel_pitch_um.value, fill_factor: fill_factor(record) },
        channels: channels(electronics, context)?,
        cfa: cfa(electronics.cfa.value),
        exposure: Exposure { exposure_s: electronics.exposure_s.value, frame_period_s: None, control: None },
        optics: Optics::default(),
        pattern: FixedPattern::default(),
        charge: Charge::plain(electronics.full_well_e.value, electronics.dark_current_e_s.value),
        read_out: ReadOut::linear(
            electronics.gain_dn_per_e.value,
            electronics.black_level_dn.value,
            electronics.bits.value as u32,
            electronics.read_noise_e.value,
        ),
        hdr: HighDynamicRange::default(),
        noise: electronics.noise.as_ref().is_none_or(|n| n.value),
    };
    match Sensor::new(parameters) {
        Ok(sensor) => Some(sensor),
        Err(errors) => {
            errors.iter().for_each(|e| context.fault(&record.place, e.to_string(), ""));
            None
        }
    }
}

/// Share of a pixel's area that is sensitive.
pub(super) fn fill_factor(record: &record::Sensor) -> f64 {
    record.fill_factor.as_ref().map_or(1.0, |f| f.value)
}

fn cfa(cfa: description::Cfa) -> Cfa {
    match cfa {
        description::Cfa::Mono => Cfa::mono(),
        description::Cfa::Rggb => Cfa::bayer(BayerPhase::Rggb),
        description::Cfa::Bggr => Cfa::bayer(BayerPhase::Bggr),
        description::Cfa::Grbg => Cfa::bayer(BayerPhase::Grbg),
        description::Cfa::Gbrg => Cfa::bayer(BayerPhase::Gbrg),
    }
}

/// One channel of a monochrome sensor, or red, green and blue.
fn channels(electronics: &record::Electronics, context: &mut Context<'_>) -> Option<Vec<Channel>> {
    let names: &[&str] = match electronics.cfa.value {
        description::Cfa::Mono => &["mono"],
        _ => &["red", "green", "blue"],
    };
    let spectra: Vec<Spectrum> = match &electronics.quantum_efficiency {
        QuantumEfficiency::Same(one) => vec![curve(one, Outside::Zero, context)?; names.len()],
        QuantumEfficiency::PerChannel(curves) => {
            curves.iter().map(|c| curve(c, Outside::Zero, context)).collect::<Option<_>>()?
        }
        QuantumEfficiency::Measured { camera, peak } => measured(camera, peak.value, context)?.into(),
    };
    let channel = |(name, quantum_efficiency): (&&str, _)| Channel { name: (*name).to_owned(), quantum_efficiency };
    Some(names.iter().zip(spectra).map(channel).collect())
}

/// Measured relative sensitivities (per radiant power, so divided by the wavelength), scaled together so that the
/// largest quantum efficiency is `peak`.
fn measured(name: &Placed<String>, peak: f64, context: &mut Context<'_>) -> Option<[Spectrum; 3]> {
    let Some(found) = camera::named(&name.value) else {
        let known = camera::names().join(", ");
        context.fault(&name.place, format!("there is no camera \"{}\"", name.value), format!("give one of {known}"));
        return None;
    };
    let per_photon = Spectrum::from_fn(|nm| 1.0 / nm);
    let channels = [&found.r, &found.g, &found.b].map(|s| s.product(&per_photon));
    let largest = channels.iter().map(|s| f64::from(s.max_value())).fold(0.0, f64::max);
    Some(channels.map(|s| s.scaled(peak / largest)))
}
