//! `quantum_efficiency`: electrons per photon.

use crate::fault::{DescriptionErrors, ErrorCode};
use crate::place::{Place, Placed};
use crate::reader::{Rule, RuleExt as _, either, exactly, keyed, keyed_by_name, known, number, record, variant};
use crate::record::curve::{Curve, curve, spectrum_file};
use etendue_spectra::camera;

/// Electrons per photon on the sensitive area.
#[derive(Clone, Debug)]
pub enum QuantumEfficiency {
    /// Equal in all pixels.
    Same(Curve),
    /// One curve each for red, green and blue.
    PerChannel(Placed<[Curve; 3]>),
    /// Measured relative sensitivities of a camera, scaled together so that the largest is `peak`.
    Measured {
        /// The camera's name.
        camera: Placed<String>,
        /// The largest quantum efficiency.
        peak: Placed<f64>,
    },
    /// One curve for each named channel.
    Named(Vec<(Placed<String>, Curve)>),
}

keyed! {
    /// Source of tabulated quantum efficiencies.
    pub enum QuantumEfficiencyTable {
        /// Two columns: wavelength in nm, quantum efficiency 0 … 1.
        spectrum => Spectrum(Placed<std::path::PathBuf>) = spectrum_file();
        /// A camera with measured relative sensitivities; needs "peak".
        camera => Camera(Placed<String>) = known("a measured camera", camera::names());
        /// Efficiency of each channel of the filter array.
        channels => Channels(Vec<(Placed<String>, Curve)>) = keyed_by_name(curve(fraction()));
    }
}

record! {
    /// A tabulated quantum efficiency.
    pub struct QuantumEfficiencySource check(check_source) {
        /// Source of the table.
        inside table: QuantumEfficiencyTable;
        /// With "camera": largest quantum efficiency of its channels.
        optional peak: Placed<f64> = number("").above(0.0).at_most(1.0);
    }
}

fn fraction() -> crate::reader::NumberRule {
    number("").at_least(0.0).at_most(1.0)
}

pub(super) fn quantum_efficiency() -> impl Rule<Out = QuantumEfficiency> {
    let same = variant!(variant!(fraction(), Curve::Constant), QuantumEfficiency::Same);
    let source = record().map(QuantumEfficiencySource::resolve, QuantumEfficiencySource::from_record);
    either(same, either(source, variant!(exactly(curve(fraction())), QuantumEfficiency::PerChannel)))
}

impl QuantumEfficiencySource {
    /// Returns the table form of an efficiency, or `None` for forms that are no table.
    fn from_record(efficiency: &QuantumEfficiency) -> Option<Self> {
        let (table, peak) = match efficiency {
            QuantumEfficiency::Same(Curve::File(file)) => (QuantumEfficiencyTable::Spectrum(file.clone()), None),
            QuantumEfficiency::Named(list) => (QuantumEfficiencyTable::Channels(list.clone()), None),
            QuantumEfficiency::Measured { camera, peak } => {
                (QuantumEfficiencyTable::Camera(camera.clone()), Some(peak.clone()))
            }
            QuantumEfficiency::Same(Curve::Constant(_)) | QuantumEfficiency::PerChannel(_) => return None,
        };
        Some(Self { peak, ..Self::new(table) })
    }

    fn resolve(self) -> QuantumEfficiency {
        match (self.table, self.peak) {
            (QuantumEfficiencyTable::Spectrum(file), _) => QuantumEfficiency::Same(Curve::File(file)),
            (QuantumEfficiencyTable::Channels(list), _) => QuantumEfficiency::Named(list),
            (QuantumEfficiencyTable::Camera(camera), peak) => {
                let peak = peak.unwrap_or_else(|| Placed::new(1.0, camera.place.clone()));
                QuantumEfficiency::Measured { camera, peak }
            }
        }
    }
}

fn check_source(source: &QuantumEfficiencySource, errors: &mut DescriptionErrors) {
    match (&source.table, &source.peak) {
        (QuantumEfficiencyTable::Spectrum(_) | QuantumEfficiencyTable::Channels(_), Some(peak)) => {
            errors.add(
                ErrorCode::NoEffect,
                &peak.place,
                "\"peak\" has no effect here, it belongs to \"camera\"",
                "remove it",
            );
        }
        (QuantumEfficiencyTable::Camera(camera), None) => errors.add(
            ErrorCode::MissingKey,
            &camera.place,
            "measured sensitivities are relative and need \"peak\"",
            "add \"peak\": the largest quantum efficiency, above 0 and at most 1",
        ),
        _ => {}
    }
}

/// Checks that the quantum efficiencies are those of the filter array's channels. Errors of an empty list are reported at `table`.
pub(super) fn check_channels(
    efficiency: &QuantumEfficiency,
    channels: &[&str],
    table: &Place,
    errors: &mut DescriptionErrors,
) {
    match efficiency {
        QuantumEfficiency::Same(_) => {}
        QuantumEfficiency::PerChannel(list) => check_colours(&list.place, channels, errors),
        QuantumEfficiency::Measured { camera, .. } => check_colours(&camera.place, channels, errors),
        QuantumEfficiency::Named(list) => check_names(table, list, channels, errors),
    }
}

fn check_colours(place: &Place, channels: &[&str], errors: &mut DescriptionErrors) {
    if channels == ["mono"] {
        let remedy = "give one number or one spectrum, or a \"cfa\" with colours";
        errors.add(
            ErrorCode::Contradiction,
            place,
            "a quantum efficiency of three channels contradicts cfa = \"mono\"",
            remedy,
        );
    } else if channels != ["red", "green", "blue"] {
        let problem =
            format!("a quantum efficiency of red, green and blue does not fit the channels {}", channels.join(", "));
        errors.add(ErrorCode::WrongCount, place, problem, "give { channels = { … } } with one for each channel");
    }
}

fn check_names(table: &Place, list: &[(Placed<String>, Curve)], channels: &[&str], errors: &mut DescriptionErrors) {
    for (name, _) in list.iter().filter(|(name, _)| !channels.contains(&name.value.as_str())) {
        let problem = format!("the filter array has no channel \"{}\"", name.value);
        errors.add(ErrorCode::UnknownName, &name.place, problem, format!("give one of {}", channels.join(", ")));
    }
    for channel in channels.iter().filter(|c| !list.iter().any(|(name, _)| name.value == **c)) {
        let place = list.first().map_or(table, |(name, _)| &name.place);
        errors.add(
            ErrorCode::MissingKey,
            place,
            format!("the channel \"{channel}\" has no quantum efficiency"),
            format!("add \"{channel}\""),
        );
    }
}
