//! Modulation: variation of a light's strength over time.

use std::path::PathBuf;

use etendue_core::ExactTime;
use etendue_core::waveform::{MAX_LEVEL, Pulses, TableInterpolation, Waveform, WaveformError};

use super::placement::LampPlacement;
use crate::asset::file_list::{FileList, NamesFiles};
use crate::asset::request::AssetKind;
use crate::fault::{DescriptionErrors, ErrorCode};
use crate::place::{Place, Placed};
use crate::reader::{
    NumberRule, choice, flag, integer, keyed, list, number, path, record, time, variants, vector, words,
};

variants! {
    /// Modulation: variation of a light's strength over time. With "pwm" and "mains" the stated strength is the mean over time, as a photometer reads
    /// it; with the others it is that of level 1.
    pub enum Modulation by "type" {
        /// Pulse-width modulation with the stated mean: a pulse is 1/"duty_cycle" times stronger.
        "pwm" => Pwm(PwmModulation),
        /// Alternating current: 1 + m cos(2π · 2f t) about the stated strength.
        "mains" => Mains(MainsModulation),
        /// On at the stated strength, and off, such as an indicator.
        "blink" => Blink(BlinkModulation),
        /// Levels at stated times, from a file or inline.
        "table" => Table(TableModulation),
        /// Steps with durations from time 0, such as a traffic light.
        "programme" => Programme(ProgrammeModulation),
    }
}

record! {
    /// Pulse-width modulation.
    pub struct PwmModulation check(check_pwm) {
        /// Pulse frequency.
        required frequency_hz: Placed<f64> = number("Hz").above(0.0).at_most(1e9);
        /// Duty cycle, between half heights.
        required duty_cycle: Placed<f64> = number("").at_least(1e-6).at_most(0.999_999);
        /// Linear rise time, half of it within the pulse. Default: 0.
        optional rise_s: Placed<f64> = number("s").at_least(0.0);
        /// Fall time. Default: 0.
        optional fall_s: Placed<f64> = number("s").at_least(0.0);
        /// For a surface: panel rows pulsed in sequence, top (v = 1) to bottom. Default: all at once.
        optional multiplexed_rows: Placed<u64> = integer(2, 4096);
        /// Delay and phases.
        inside timing: ModulationTiming;
    }
}

record! {
    /// A lamp on alternating current.
    pub struct MainsModulation {
        /// Mains frequency; the light has twice that.
        required frequency_hz: Placed<f64> = number("Hz").above(0.0).at_most(1e6);
        /// Modulation depth m, (max − min)/(max + min): about 0.1 for filament lamps, 0.3 to 1 for discharge and simple LED lamps.
        required modulation_depth: Placed<f64> = number("").above(0.0).at_most(1.0);
        /// Delay and phases.
        inside timing: ModulationTiming;
    }
}

record! {
    /// On and off.
    pub struct BlinkModulation check(check_blink) {
        /// Blink frequency.
        required frequency_hz: Placed<f64> = number("Hz").above(0.0).at_most(1e9);
        /// Fraction of the period that is on, between half heights. Default: 0.5.
        optional on_fraction: Placed<f64> = number("").at_least(1e-6).at_most(0.999_999);
        /// Linear rise time, half of it within the on-time. Default: 0.
        optional rise_s: Placed<f64> = number("s").at_least(0.0);
        /// Fall time. Default: 0.
        optional fall_s: Placed<f64> = number("s").at_least(0.0);
        /// Delay and phases.
        inside timing: ModulationTiming;
    }
}

record! {
    /// Levels at stated times.
    pub struct TableModulation check(check_table) {
        /// The levels.
        inside rows: TableRows;
        /// Interpolation between rows. Default: "linear".
        optional interpolation: Placed<Interpolation> = choice();
        /// Period, at least the table's duration, more with steps. Default: no repetition, the end levels hold.
        optional period_s: Placed<f64> = number("s").above(0.0);
        /// Delay and phases.
        inside timing: ModulationTiming;
    }
}

keyed! {
    /// Source of the levels.
    pub enum TableRows {
        /// Rows of increasing time (s) and level (0 … 1 000 000).
        points => Points(Vec<Placed<[f64; 2]>>) = list(vector::<2>(number("")), 2);
        /// Two columns: increasing time in s, level (0 … 1 000 000).
        file => File(Placed<PathBuf>) = path(&["csv"]);
    }
}

words! {
    /// Interpolation between the rows of a table.
    pub enum Interpolation {
        /// Linear.
        "linear" => Linear,
        /// The level of the preceding row.
        "steps" => Steps,
    }
}

record! {
    /// Steps with durations.
    pub struct ProgrammeModulation check(check_programme) {
        /// The steps.
        many steps: Step = list(record(), 1);
        /// Repeats after the last step; otherwise the end levels hold. Default: true.
        optional repeats: Placed<bool> = flag();
        /// Delay and phases.
        inside timing: ModulationTiming;
    }
}

record! {
    /// One step of a programme.
    pub struct Step {
        /// Factor on the stated strength.
        required level: Placed<f64> = level();
        /// Duration.
        required duration_s: Placed<f64> = number("s").above(0.0);
    }
}

record! {
    /// Delay and phases of a modulation.
    pub struct ModulationTiming {
        /// Delay. Default: 0.
        optional delay_s: Placed<ExactTime> = time();
        /// Phases of the instances. Default: "common".
        optional phases: Placed<Phases> = choice();
    }
}

words! {
    /// Phases of a light's instances.
    pub enum Phases {
        /// Equal.
        "common" => Common,
        /// Each instance is delayed by a random part of the period, derived from its name and number, independent of any seed.
        "random" => Random,
    }
}

const fn level() -> NumberRule {
    number("").at_least(0.0).at_most(MAX_LEVEL)
}

impl Modulation {
    /// Place in the description.
    #[must_use]
    pub fn place(&self) -> &Place {
        match self {
            Self::Pwm(record) => &record.place,
            Self::Mains(record) => &record.place,
            Self::Blink(record) => &record.place,
            Self::Table(record) => &record.place,
            Self::Programme(record) => &record.place,
        }
    }

    /// Delay and phases.
    #[must_use]
    pub fn timing(&self) -> &ModulationTiming {
        match self {
            Self::Pwm(record) => &record.timing,
            Self::Mains(record) => &record.timing,
            Self::Blink(record) => &record.timing,
            Self::Table(record) => &record.timing,
            Self::Programme(record) => &record.timing,
        }
    }

    /// Rows of a panel that are lit in sequence.
    #[must_use]
    pub fn multiplexed_rows(&self) -> Option<&Placed<u64>> {
        match self {
            Self::Pwm(record) => record.multiplexed_rows.as_ref(),
            _ => None,
        }
    }

    /// File of the levels.
    #[must_use]
    pub fn file(&self) -> Option<&Placed<PathBuf>> {
        match self {
            Self::Table(TableModulation { rows: TableRows::File(file), .. }) => Some(file),
            _ => None,
        }
    }

    /// The waveform, without any delay; `rows` are those of its file, where it has one.
    ///
    /// # Errors
    /// A number is out of its range.
    pub fn waveform(&self, rows: &[(f64, f64)]) -> Result<Waveform, WaveformError> {
        match self {
            Self::Pwm(record) => record.waveform(),
            Self::Mains(record) => Waveform::mains(record.frequency_hz.value, record.modulation_depth.value),
            Self::Blink(record) => record.waveform(),
            Self::Table(record) => record.waveform(rows),
            Self::Programme(record) => record.waveform(),
        }
    }
}

impl PwmModulation {
    fn waveform(&self) -> Result<Waveform, WaveformError> {
        let (frequency_hz, duty) = (self.frequency_hz.value, self.duty_cycle.value);
        Waveform::pulses(&Pulses { frequency_hz, duty, edges_s: edges_s(&self.rise_s, &self.fall_s), peak: 1.0 / duty })
    }
}

impl BlinkModulation {
    fn waveform(&self) -> Result<Waveform, WaveformError> {
        let duty = self.on_fraction.as_ref().map_or(0.5, |fraction| fraction.value);
        let edges_s = edges_s(&self.rise_s, &self.fall_s);
        Waveform::pulses(&Pulses { frequency_hz: self.frequency_hz.value, duty, edges_s, peak: 1.0 })
    }
}

fn edges_s(rise_s: &Option<Placed<f64>>, fall_s: &Option<Placed<f64>>) -> [f64; 2] {
    [rise_s, fall_s].map(|edge| edge.as_ref().map_or(0.0, |edge| edge.value))
}

impl TableModulation {
    fn waveform(&self, of_file: &[(f64, f64)]) -> Result<Waveform, WaveformError> {
        let between = match self.interpolation.as_ref().map(|word| word.value) {
            None | Some(Interpolation::Linear) => TableInterpolation::Linear,
            Some(Interpolation::Steps) => TableInterpolation::Steps,
        };
        let period_s = self.period_s.as_ref().map(|period| period.value);
        match &self.rows {
            TableRows::File(_) => Waveform::table(of_file, between, period_s),
            TableRows::Points(points) => {
                let rows: Vec<_> = points.iter().map(|point| (point.value[0], point.value[1])).collect();
                Waveform::table(&rows, between, period_s)
            }
        }
    }
}

impl ProgrammeModulation {
    fn waveform(&self) -> Result<Waveform, WaveformError> {
        let steps: Vec<_> = self.steps.iter().map(|step| (step.duration_s.value, step.level.value)).collect();
        Waveform::programme(&steps, self.repeats.as_ref().is_none_or(|repeats| repeats.value))
    }
}

impl NamesFiles for Modulation {
    fn name_files(&self, files: &mut FileList) {
        self.file().into_iter().for_each(|file| files.add(AssetKind::Numbers, file));
    }
}

fn check_pwm(record: &PwmModulation, errors: &mut DescriptionErrors) {
    accept(record.waveform(), &record.place, errors);
}

fn check_blink(record: &BlinkModulation, errors: &mut DescriptionErrors) {
    accept(record.waveform(), &record.place, errors);
}

fn check_table(record: &TableModulation, errors: &mut DescriptionErrors) {
    if let TableRows::Points(_) = &record.rows {
        accept(record.waveform(&[]), &record.place, errors);
    }
    check_phases(&record.timing, record.period_s.is_some(), "add \"period_s\"", errors);
}

fn check_programme(record: &ProgrammeModulation, errors: &mut DescriptionErrors) {
    if record.steps.is_empty() {
        errors.add(
            ErrorCode::MissingKey,
            &record.place,
            "the programme has no steps",
            "add \"steps\": a list of { level = …, duration_s = … }",
        );
        return;
    }
    accept(record.waveform(), &record.place, errors);
    let repeats = record.repeats.as_ref().is_none_or(|repeats| repeats.value);
    check_phases(&record.timing, repeats, "let it repeat", errors);
}

fn accept(waveform: Result<Waveform, WaveformError>, place: &Place, errors: &mut DescriptionErrors) {
    if let Err(error) = waveform {
        errors.add(ErrorCode::OutOfRange, place, error.to_string(), "");
    }
}

/// Refuses phases of a modulation that does not recur.
fn check_phases(timing: &ModulationTiming, recurs: bool, otherwise: &str, errors: &mut DescriptionErrors) {
    if let (Some(phases), false) = (&timing.phases, recurs) {
        let problem = "\"phases\" has no effect on a modulation that does not repeat";
        errors.add(ErrorCode::NoEffect, &phases.place, problem, format!("remove it, or {otherwise}"));
    }
}

/// Reports contradictions of a lamp's modulation.
pub(super) fn check(modulation: Option<&Modulation>, placement: &LampPlacement, errors: &mut DescriptionErrors) {
    if let Some(rows) = modulation.and_then(Modulation::multiplexed_rows) {
        errors.add(
            ErrorCode::NoEffect,
            &rows.place,
            "this light has no rows to light one after the other",
            "remove it, or give the modulation to an emissive surface",
        );
    }
    if modulation.is_none() {
        let delays = placement.instances.iter().filter_map(|instance| instance.modulation_delay_s.as_ref());
        for delay in delays {
            let problem = "\"modulation_delay_s\" has no effect on an unmodulated light";
            errors.add(ErrorCode::NoEffect, &delay.place, problem, "remove it, or add \"modulation\" to the light");
        }
    }
}
