//! Time-dependent strengths: from records to waveforms.

use super::context::{Context, ErrorCode};
use etendue_core::random::number_of_name;
use etendue_core::{ExactTime, Waveform};
use etendue_scene::record::light::Modulation;
use etendue_scene::record::light::modulation::Phases;

/// Waveform of a record with its own delay; `None` if it is invalid.
pub(super) fn waveform(record: &Modulation, context: &mut Context<'_>) -> Option<Waveform> {
    let rows = match record.file() {
        None => Vec::new(),
        Some(file) => {
            let Some(asset) = context.assets.numbers.get(&file.value) else {
                context.error(
                    ErrorCode::UnreadableFile,
                    &file.place,
                    "the table was not loaded",
                    "give a readable file",
                );
                return None;
            };
            if asset.columns != 2 {
                let problem = format!("{} has rows of {} numbers", file.value.display(), asset.columns);
                context.error(ErrorCode::UnsuitableFile, &file.place, problem, "give two columns: time in s, level");
                return None;
            }
            asset.rows().map(|row| (row[0], row[1])).collect()
        }
    };
    let place = record.file().map_or(record.place(), |file| &file.place);
    let waveform = context.accept(place, record.waveform(&rows))?;
    let delay = record.timing().delay_s.as_ref().map_or(ExactTime::default(), |delay| delay.value);
    Some(waveform.delay_by(delay - context.epoch.start()))
}

/// Returns true if every instance of the light has its own phase.
pub(super) fn has_random_phases(record: &Modulation) -> bool {
    matches!(record.timing().phases.as_ref().map(|word| word.value), Some(Phases::Random))
}

/// A random fraction of a waveform's period, s, for the instance of this name.
pub(super) fn random_delay_s(waveform: &Waveform, name: &str) -> f64 {
    waveform.period_s().map_or(0.0, |period_s| period_s * number_of_name(name))
}
