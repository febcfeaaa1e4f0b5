//! One side of a comparison: measured or declared facts about a camera, the channel and the light.

use std::collections::BTreeMap;

use etendue_sensor::SensorParameters;
use etendue_spectra::{Spectrum, illuminant};

use super::mean::Curve;

/// A number with its unit; without an uncertainty if the measurement states none.
#[derive(Clone, Debug)]
pub(crate) struct Quantity {
    pub value: f64,
    pub standard_uncertainty: Option<f64>,
    pub unit: String,
}

impl Quantity {
    /// A value of a camera file: exact by definition.
    pub(crate) fn declared(value: f64, unit: &str) -> Self {
        Self { value, standard_uncertainty: Some(0.0), unit: unit.to_owned() }
    }
}

/// Facts about a camera on one side.
#[derive(Clone, Debug)]
pub(crate) struct ComparisonSide {
    pub kind: String,
    pub settings: BTreeMap<String, String>,
    pub quantities: BTreeMap<String, Quantity>,
    pub curves: Vec<Curve>,
    /// Angles of slanted edges to rows or columns, degrees, by position.
    pub angles_deg: BTreeMap<String, f64>,
}

/// The measured channel, by its name or its first letter.
pub(crate) fn channel(p: &SensorParameters, measured: Option<&str>) -> Result<usize, String> {
    let names = || p.channels.iter().map(|c| c.name.as_str()).collect::<Vec<_>>().join(", ");
    let Some(name) = measured else {
        let several_colours = || format!("the pixels have colour filters ({}); choose one with `channel`", names());
        return if p.channels.len() == 1 { Ok(0) } else { Err(several_colours()) };
    };
    let matches =
        |own: &str| own.eq_ignore_ascii_case(name) || (name.len() == 1 && own[..1].eq_ignore_ascii_case(name));
    let position = p.channels.iter().position(|c| matches(&c.name));
    position.ok_or_else(|| {
        format!("the measurement is of channel '{name}', but the channels of the camera file are {}", names())
    })
}

/// The first place of a channel in the tile, which measurements use.
pub(crate) fn place_of(p: &SensorParameters, channel: usize) -> [usize; 2] {
    let at = p.cfa.channels().iter().position(|c| *c == channel).unwrap_or(0);
    [at % p.cfa.width(), at / p.cfa.width()]
}

/// Wavelength step of averages, nm.
const STEP_NM: usize = 5;

/// Light of the measurement, as stated.
pub(crate) struct Light {
    pub wavelength_nm: Option<f64>,
    pub illuminant: Option<String>,
}

/// The light's spectrum.
pub(crate) fn spectrum(light: &str) -> Result<&'static Spectrum, String> {
    let unknown = || format!("`illuminant` {light}: expected one of {}", illuminant::names().join(", "));
    illuminant::by_name(light).ok_or_else(unknown)
}

/// Light of a spectrum that a pixel sees, by wavelength, nm.
pub(crate) fn weighed(light: &Spectrum, responsivity: &Spectrum) -> impl Iterator<Item = (f64, f64)> {
    (300..=1100)
        .step_by(STEP_NM)
        .map(move |nm| (f64::from(light.at(nm as f32) * responsivity.at(nm as f32)), f64::from(nm)))
}
