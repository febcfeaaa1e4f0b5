//! Reflectances and transmittances over wavelength, and the emission of a surface.

use super::super::context::{Context, ErrorCode};
use super::super::modulation;
use super::super::spectrum::{emitted, from_file};
use super::compiler::ImageUse;
use super::compiler::MaterialCompiler;
use etendue_scene::record::material::Sides;
use etendue_scene::record::{self, Colour, SurfaceEmission};
use etendue_spectra::{Extrapolation, Spectrum, colour, reflectance, upsample};
use etendue_tracer::materials::{Emission, EmissionSides, Modulation, Reflectance};
use std::num::NonZeroU32;

/// A fraction of light over wavelength.
pub(in super::super) fn reflectance_spectrum(colour: &Colour, context: &mut Context<'_>) -> Option<Spectrum> {
    let rgb = |rgb: [f64; 3]| upsample::reflectance_spectrum(rgb.map(|v| v as f32));
    match colour {
        Colour::Grey(reflectance) => Some(Spectrum::constant(reflectance.value)),
        Colour::LinearSrgb(value) => Some(rgb(value.value)),
        Colour::EncodedSrgb(value) => Some(rgb(value.value.map(|v| f64::from(colour::decode(v as f32))))),
        Colour::Spectrum(file) => from_file(file, Extrapolation::Hold, context),
        Colour::Named(name) => {
            let spectrum = reflectance::by_name(&name.value).cloned();
            if spectrum.is_none() {
                let remedy = format!("give one of {}", reflectance::names().join(", "));
                context.error(
                    ErrorCode::UnknownName,
                    &name.place,
                    format!("there is no reflectance \"{}\"", name.value),
                    remedy,
                );
            }
            spectrum
        }
    }
}

impl MaterialCompiler<'_, '_> {
    pub(super) fn reflectance(&mut self, reflectance: &record::Reflectance) -> Option<Reflectance> {
        match reflectance {
            record::Reflectance::Plain(colour) => reflectance_spectrum(colour, self.context).map(Reflectance::Spectrum),
            record::Reflectance::Texture { name, scale } => {
                let scale = scale.as_ref().map_or(1.0, |s| s.value);
                self.texture(name, ImageUse::Colour, scale).map(Reflectance::Texture)
            }
        }
    }

    fn modulation(&mut self, record: &record::light::Modulation) -> Option<Modulation> {
        self.has_random_phases = modulation::has_random_phases(record);
        let waveform = modulation::waveform(record, self.context)?;
        match record.multiplexed_rows().and_then(|rows| NonZeroU32::new(rows.value as u32)) {
            None => Some(Modulation::new(waveform)),
            Some(rows) => {
                self.needs_coordinates = true;
                Modulation::in_rows(waveform, rows)
            }
        }
    }

    pub(super) fn emission(&mut self, record: &SurfaceEmission) -> Option<Emission> {
        let emission = match record.sides.as_ref().map(|s| s.value) {
            Some(Sides::Both) => EmissionSides::Both,
            Some(Sides::Front) | None => EmissionSides::Front,
        };
        let factor = match &record.texture {
            Some(name) => Some(self.texture(name, ImageUse::Colour, 1.0)?),
            None => None,
        };
        let radiance = emitted(&record.light, self.context)?;
        self.flux_sides = record.light.level.flux().map(|_| if emission == EmissionSides::Both { 2.0 } else { 1.0 });
        let modulation = match &record.modulation {
            None => None,
            Some(record) => Some(self.modulation(record)?),
        };
        Some(Emission { radiance, factor, sides: emission, modulation })
    }
}
