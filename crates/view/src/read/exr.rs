//! The layers of an EXR: spectra, colours, and channels grouped by the part of their names before the last dot.

use std::collections::BTreeMap;

use etendue::Error;
use etendue_core::quantity::{Quantity, Variance};
use etendue_core::{Bands, Plane, SpectralCube};
use etendue_io::exr::{
    CubeWithVariance, ExrChannel, ExrFile, ExrSamples as Stored, SpectralImage, band_weights, parse_channel_name,
    read_exr, spectral_of,
};

use super::facts::{self, FileLayers, SideCar};
use crate::layer::{Layer, LayerKind, NamedPlane, Role, Samples};
use crate::result_files::ResultFile;

/// Parts of a digital number, in the order of the signal path; others follow in their own order.
const PARTS: [&str; 10] =
    ["signal", "shot", "dark", "fixed_pattern", "blooming", "smear", "transfer", "read", "quantisation", "saturated"];
/// Header entries that are not useful on the page.
const HIDDEN_ENTRIES: [&str; 3] = ["layout", "quantity", "units"];
const VARIANCE: &str = "variance.";

pub(super) fn layers(file: &ResultFile, side_car: &SideCar) -> Result<FileLayers, Error> {
    let exr = read_exr(&file.path).map_err(Error::input)?;
    let facts = facts(&exr);
    let layers = if file.stem == "signal_breakdown" {
        vec![parts(exr, facts::written(side_car.entry(&file.name)[1]))]
    } else {
        all(file, exr, side_car)?
    };
    Ok(FileLayers { layers, facts })
}

fn facts(exr: &ExrFile) -> BTreeMap<String, String> {
    let named = exr.attributes.iter().filter_map(|(name, text)| Some((name.strip_prefix("etendue:")?, text)));
    let shown = named.filter(|(name, _)| !HIDDEN_ENTRIES.contains(name));
    shown.map(|(name, text)| (name.to_owned(), text.clone())).collect()
}

/// All channels of a file as parts of one number.
fn parts(exr: ExrFile, unit: String) -> Layer {
    let size = (exr.width, exr.height);
    let rank = |name: &str| PARTS.iter().position(|part| *part == name).unwrap_or(PARTS.len());
    let mut channels = exr.channels;
    channels.sort_by_key(|channel| rank(&channel.name));
    let planes = channels.into_iter().map(|channel| NamedPlane::value(channel.name, exact(channel.samples))).collect();
    let meaning =
        "the sum of all parts but `saturated` is (DN − black) / gain; `saturated` is 1 at the white level".to_owned();
    Layer { name: "signal_breakdown".to_owned(), kind: LayerKind::Parts, unit, meaning, size, planes }
}

fn all(file: &ResultFile, exr: ExrFile, side_car: &SideCar) -> Result<Vec<Layer>, Error> {
    let is_spectral = |channel: &ExrChannel| parse_channel_name(&channel.name).is_some();
    let mut layers = Vec::new();
    let [quantity, unit] = side_car.entry(&file.name);
    let unit_prefix =
        if unit.contains(", ") && !attributed(&exr) { format!("{quantity}: {unit}") } else { String::new() };
    let stated = exr.attributes.get("etendue:units").cloned();
    let stated = stated.unwrap_or_else(|| side_car.entry(&file.name)[1].to_owned());
    let spectral = exr.channels.iter().any(is_spectral);
    if spectral {
        layers.push(spectrum(file, &exr, &stated)?);
    }
    let (size, attributes) = ((exr.width, exr.height), exr.attributes);
    // R, G and B next to spectral bands are derived from them.
    let follows = |name: &str| spectral && ["R", "G", "B"].contains(&name);
    let others = exr.channels.into_iter().filter(|channel| !is_spectral(channel)).filter(|c| !follows(&c.name));
    for (name, channels) in grouped(others) {
        let (unit, more) = facts::layer_words(&stated, &name);
        let first = name.split('.').next().unwrap_or(&name);
        let own = attributes.get(&format!("etendue:{first}")).cloned();
        let meaning = own.unwrap_or_else(|| if more.is_empty() { unit_prefix.clone() } else { more });
        let (kind, planes) = kind(&name, channels, side_car);
        layers.push(Layer { name, kind, unit, meaning, size, planes });
    }
    Ok(layers)
}

/// True if the header describes the content of the file.
fn attributed(exr: &ExrFile) -> bool {
    exr.attributes.contains_key("etendue:units")
}

/// Channels by their layer, in the order of first appearance, with the variances of a layer's channels.
fn grouped(channels: impl Iterator<Item = ExrChannel>) -> Vec<(String, Vec<ExrChannel>)> {
    let mut groups: Vec<(String, Vec<ExrChannel>)> = Vec::new();
    for channel in channels {
        let base_name = channel.name.strip_prefix(VARIANCE).unwrap_or(&channel.name);
        let layer = match base_name.rsplit_once('.') {
            Some((layer, _)) => layer.to_owned(),
            None if ["R", "G", "B", "A"].contains(&base_name) => "colour".to_owned(),
            None => base_name.to_owned(),
        };
        match groups.iter_mut().find(|(name, _)| *name == layer) {
            Some((_, group)) => group.push(channel),
            None => groups.push((layer, vec![channel])),
        }
    }
    groups
}

fn kind(layer: &str, channels: Vec<ExrChannel>, side_car: &SideCar) -> (LayerKind, Vec<NamedPlane>) {
    let letters: Vec<String> =
        channels.iter().map(|c| c.name.rsplit_once('.').map_or(c.name.as_str(), |(_, last)| last).to_owned()).collect();
    let letters: Vec<&str> = letters.iter().map(String::as_str).collect();
    let kind = match (&letters[..], &channels[0].samples) {
        (["ID"], Stored::Uint(ids)) => LayerKind::Identity { names: facts::names(layer, ids, side_car) },
        (["X", "Y", "Z"], _) => LayerKind::Vector { is_unit: ["N", "direction"].contains(&layer) },
        (["X", "Y"], _) => LayerKind::Flow,
        (["Z"], _) => LayerKind::Length,
        (all, _) if ["R", "G", "B"].iter().all(|letter| all.contains(letter)) => {
            return (LayerKind::Colour, colours(channels));
        }
        _ => LayerKind::Number,
    };
    (kind, channels.into_iter().map(plane).collect())
}

/// Red, green and blue in this order.
fn colours(channels: Vec<ExrChannel>) -> Vec<NamedPlane> {
    let mut planes: Vec<NamedPlane> = channels.into_iter().map(plane).collect();
    let rank = |plane: &NamedPlane| ["R", "G", "B"].iter().position(|letter| plane.name.ends_with(letter));
    planes.retain(|plane| rank(plane).is_some());
    planes.sort_by_key(rank);
    planes
}

/// A variance is stored as the standard error.
fn plane(channel: ExrChannel) -> NamedPlane {
    match channel.name.strip_prefix(VARIANCE) {
        Some(name) => {
            let errors = channel.samples.to_floats().into_iter().map(f32::sqrt).collect();
            NamedPlane { name: name.to_owned(), role: Role::Error, samples: Samples::Exact(errors) }
        }
        None => NamedPlane::value(channel.name, exact(channel.samples)),
    }
}

fn exact(samples: Stored) -> Samples {
    match samples {
        Stored::Half(values) | Stored::Float(values) => Samples::Exact(values),
        Stored::Uint(values) => Samples::Integers(values),
    }
}

fn spectrum(file: &ResultFile, exr: &ExrFile, stated: &str) -> Result<Layer, Error> {
    let spectral = spectral_of(&file.path, exr).map_err(Error::input)?;
    let mut meaning = "means over the bands".to_owned();
    spectral.notes.iter().for_each(|note| meaning += &format!("; {note}"));
    let ((bands, planes), default_unit) = match spectral.image {
        SpectralImage::Radiance(image) => (cube(image), etendue_core::quantity::Radiance::UNIT),
        SpectralImage::Irradiance(image) => (cube(image), etendue_core::quantity::Irradiance::UNIT),
    };
    let kind = LayerKind::Spectrum {
        centres_nm: (0..bands.count()).map(|band| bands.centre_nm(band)).collect(),
        width_nm: bands.width_nm(),
        weights: band_weights(bands),
    };
    let unit = facts::written(if stated.is_empty() { default_unit } else { stated });
    Ok(Layer { name: file.stem.clone(), kind, unit, meaning, size: (exr.width, exr.height), planes })
}

fn cube<Q: Quantity<Sample = f32>>(image: CubeWithVariance<Q>) -> (Bands, Vec<NamedPlane>) {
    let bands = image.cube.bands();
    let name = |band: usize| format!("{} nm", bands.centre_nm(band));
    let values = image.cube.planes().iter().map(Plane::samples).enumerate();
    let values = values.map(|(band, plane)| NamedPlane::value(name(band), Samples::Rounded(plane.to_vec())));
    let planes = |cube: &SpectralCube<Variance>| -> Vec<NamedPlane> {
        let errors = cube.planes().iter().enumerate().map(|(band, plane)| NamedPlane {
            name: name(band),
            role: Role::Error,
            samples: Samples::Rounded(plane.samples().iter().map(|v| v.sqrt()).collect()),
        });
        errors.collect()
    };
    let errors = image.variance.as_ref().map(planes).unwrap_or_default();
    (bands, values.chain(errors).collect())
}
