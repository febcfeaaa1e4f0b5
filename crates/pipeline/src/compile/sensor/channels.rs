//! Channels of the pixels, and their quantum efficiency.

use super::super::context::{Context, ErrorCode};
use super::super::spectrum::curve;
use etendue_scene::record;
use etendue_scene::record::sensor::QuantumEfficiency;
use etendue_scene::record::sensor::cfa::CfaSource;
use etendue_scene::{Place, Placed};
use etendue_sensor::{Cfa, Channel};
use etendue_spectra::{Extrapolation, Spectrum, camera};

/// The colour filter tile, with indices into the channels.
pub(super) fn cfa(source: &CfaSource, context: &mut Context<'_>) -> Option<Cfa> {
    let (columns, names) = source.tile();
    let channels = source.channels();
    let number = |name: &&str| channels.iter().position(|c| c == name).expect("channels are those of the tile");
    let numbers: Vec<usize> = names.iter().map(number).collect();
    context.accept(cfa_place(source), Cfa::tile(columns, numbers.len() / columns, numbers))
}

fn cfa_place(source: &CfaSource) -> &Place {
    match source {
        CfaSource::Named(name) => &name.place,
        CfaSource::Tile(tile) => &tile.place,
    }
}

/// The channels, in the order of [`CfaSource::channels`].
pub(super) fn channels(electronics: &record::Electronics, context: &mut Context<'_>) -> Option<Vec<Channel>> {
    let names = electronics.cfa.channels();
    let spectra: Vec<Spectrum> = match &electronics.quantum_efficiency {
        QuantumEfficiency::Same(one) => vec![curve(one, Extrapolation::Zero, context)?; names.len()],
        QuantumEfficiency::PerChannel(curves) => {
            curves.value.iter().map(|c| curve(c, Extrapolation::Zero, context)).collect::<Option<_>>()?
        }
        QuantumEfficiency::Measured { camera, peak } => measured(camera, peak.value, context)?.into(),
        QuantumEfficiency::Named(list) => {
            let of = |name: &&str| list.iter().find(|(n, _)| n.value == **name).map(|(_, curve)| curve);
            names.iter().map(|name| curve(of(name)?, Extrapolation::Zero, context)).collect::<Option<_>>()?
        }
    };
    let channel = |(name, quantum_efficiency): (&&str, _)| Channel { name: (*name).to_owned(), quantum_efficiency };
    Some(names.iter().zip(spectra).map(channel).collect())
}

/// Measured relative sensitivities (per radiant power, hence divided by the wavelength), scaled together so that the largest quantum efficiency is `peak`.
fn measured(name: &Placed<String>, peak: f64, context: &mut Context<'_>) -> Option<[Spectrum; 3]> {
    let Some(curves) = camera::by_name(&name.value) else {
        let known = camera::names().join(", ");
        context.error(
            ErrorCode::UnknownName,
            &name.place,
            format!("there is no camera \"{}\"", name.value),
            format!("give one of {known}"),
        );
        return None;
    };
    let per_photon = Spectrum::from_fn(|nm| 1.0 / nm);
    let channels = [&curves.r, &curves.g, &curves.b].map(|s| s.product(&per_photon));
    let largest = channels.iter().map(|s| f64::from(s.max_value())).fold(0.0, f64::max);
    Some(channels.map(|s| s.scaled(peak / largest)))
}
