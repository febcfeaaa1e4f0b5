//! Shared state of all compile steps: the assets, the errors found so far, and notes and warnings for the plan.

use super::coded_error::CodedError;
use super::coverage::SpectralCoverage;
use crate::plan::note::{Note, Severity};
use etendue_core::{Epoch, ExactTime};
pub(super) use etendue_scene::ErrorCode;
use etendue_scene::asset::Assets;
use etendue_scene::{DescriptionError, Place, Placed, key_with_place};
use std::collections::BTreeSet;
use std::fmt::Display;

/// Assets for name resolution, and the errors and notes collected so far.
#[derive(Debug)]
pub(super) struct Context<'a> {
    pub(super) assets: &'a Assets,
    /// Origin of all times.
    pub(super) epoch: Epoch,
    pub(super) errors: Vec<DescriptionError>,
    pub(super) notes: Vec<Note>,
    /// Settings overridden by the command line.
    pub(super) overridden_keys: Vec<String>,
    /// Wavelength ranges of the tables in use.
    pub(super) coverage: SpectralCoverage,
}

impl<'a> Context<'a> {
    pub(super) fn new(assets: &'a Assets, epoch: Epoch) -> Self {
        let (errors, notes, overridden_keys) = (Vec::new(), Vec::new(), Vec::new());
        Self { assets, epoch, errors, notes, overridden_keys, coverage: SpectralCoverage::default() }
    }

    /// Returns a time since the epoch, s; warns if a number in the file cannot represent it to a nanosecond.
    pub(super) fn since_epoch_s(&mut self, time: &Placed<ExactTime>) -> f64 {
        let step_s = time.value.step_s();
        // A fraction of few binary digits is exactly representable.
        let is_exact = (1024.0 * time.value.fraction_s()).fract() == 0.0;
        if time.value.is_number() && !is_exact && step_s > 1e-9 {
            let text = format!(
                "a number this far from zero is rounded to a multiple of {:.1} ns; write it as a string, in quotes, to \
                 preserve all its digits",
                1e9 * step_s
            );
            self.warn_on(&time.place, text);
        }
        self.epoch.to(time.value)
    }

    /// Records an error at `place`.
    pub(super) fn error(
        &mut self,
        code: ErrorCode,
        place: &Place,
        problem: impl Into<String>,
        remedy: impl Into<String>,
    ) {
        self.errors.push(DescriptionError::new(code, place, problem, remedy));
    }

    /// Records that `key` at `place` has no effect because of the setting at `cause`: an error, unless the command line states the cause and a file the key.
    /// A command-line setting overrides the keys that it makes meaningless.
    pub(super) fn error_without_effect(
        &mut self,
        code: ErrorCode,
        key: &str,
        place: &Place,
        cause: Option<&Place>,
        problem: impl Into<String>,
        remedy: &str,
    ) {
        match cause {
            Some(by) if by.is_command_line() && !place.is_command_line() => {
                self.overridden(format!("{by} overrides {}", key_with_place(key, place)));
            }
            _ => self.error(code, place, problem, remedy),
        }
    }

    /// Records a notice, without duplicates.
    pub(super) fn overridden(&mut self, text: String) {
        if !self.overridden_keys.contains(&text) {
            self.overridden_keys.push(text);
        }
    }

    /// Returns the value, or `None` with its error recorded at `place`; the errors of the models state the remedy.
    pub(super) fn accept<T, E: CodedError>(&mut self, place: &Place, result: Result<T, E>) -> Option<T> {
        result.map_err(|error| self.error(error.code(), place, error.to_string(), "")).ok()
    }

    /// Returns the recorded errors without duplicates: a key of the job is checked for every camera.
    pub(super) fn into_errors(self) -> Vec<DescriptionError> {
        let mut known = BTreeSet::new();
        let is_new =
            |error: &DescriptionError| known.insert((error.place.clone(), error.problem.clone(), error.remedy.clone()));
        self.errors.into_iter().filter(is_new).collect()
    }

    /// Records a note for the plan, which prints equal ones once with their number.
    pub(super) fn note(&mut self, text: impl Into<String>) {
        self.add(None, text.into(), Severity::Note);
    }

    /// Records a note on a file, a place or an object; the plan prints equal ones together.
    pub(super) fn note_on(&mut self, subject: impl Display, text: impl Into<String>) {
        self.add(Some(subject.to_string()), text.into(), Severity::Note);
    }

    /// Records a warning that the image may differ from the user's intent; a render repeats it.
    pub(super) fn warn(&mut self, text: impl Into<String>) {
        self.add(None, text.into(), Severity::Warning);
    }

    /// Does the same as [`Context::warn`] for a file, a place or an object.
    pub(super) fn warn_on(&mut self, subject: impl Display, text: impl Into<String>) {
        self.add(Some(subject.to_string()), text.into(), Severity::Warning);
    }

    fn add(&mut self, subject: Option<String>, text: String, weight: Severity) {
        let is_same = |other: &&mut Note| other.subject == subject && other.text == text && other.weight == weight;
        match self.notes.iter_mut().find(is_same) {
            Some(same) => same.count += 1,
            None => self.notes.push(Note { subject, text, weight, count: 1 }),
        }
    }
}
