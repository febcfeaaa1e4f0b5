//! What every step of compiling shares: the assets, the faults found so far, and remarks for the plan.

use super::coded_error::CodedError;
use super::coverage::Coverage;
use crate::plan::remark::{Remark, Weight};
use etendue_core::{Epoch, ExactTime};
pub(super) use etendue_scene::ErrorCode;
use etendue_scene::asset::Assets;
use etendue_scene::{Fault, Place, Placed, stated};
use std::collections::BTreeSet;
use std::fmt::Display;

/// Assets to resolve names in, faults and remarks collected on the way.
#[derive(Debug)]
pub(super) struct Context<'a> {
    pub(super) assets: &'a Assets,
    /// The time from which all times are counted.
    pub(super) epoch: Epoch,
    pub(super) faults: Vec<Fault>,
    pub(super) remarks: Vec<Remark>,
    /// What the command line supersedes.
    pub(super) notices: Vec<String>,
    /// Wavelengths of the tables that are used.
    pub(super) coverage: Coverage,
}

impl<'a> Context<'a> {
    pub(super) fn new(assets: &'a Assets, epoch: Epoch) -> Self {
        let (faults, remarks, notices) = (Vec::new(), Vec::new(), Vec::new());
        Self { assets, epoch, faults, remarks, notices, coverage: Coverage::default() }
    }

    /// Returns a time since the epoch, s; warns if a number in the file cannot represent it to a nanosecond.
    pub(super) fn since_epoch_s(&mut self, time: &Placed<ExactTime>) -> f64 {
        let step_s = time.value.step_s();
        // A fraction of few binary digits is exact as a number.
        let is_exact = (1024.0 * time.value.fraction_s()).fract() == 0.0;
        if time.value.is_number() && !is_exact && step_s > 1e-9 {
            let text = format!(
                "a number this far from zero is rounded to a multiple of {:.1} ns; write it as text, in quotes, to keep all its digits",
                1e9 * step_s
            );
            self.warn_on(&time.place, text);
        }
        self.epoch.to(time.value)
    }

    /// Notes a fault at `place`.
    pub(super) fn fault(
        &mut self,
        code: ErrorCode,
        place: &Place,
        problem: impl Into<String>,
        remedy: impl Into<String>,
    ) {
        self.faults.push(Fault::new(code, place, problem, remedy));
    }

    /// Notes that `key`, which stands at `place`, has no effect for what stands at `cause`: a fault, but not where the
    /// command line says the cause and a file the key. What the command line says supersedes what it makes meaningless.
    pub(super) fn idle(
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
                self.notice(format!("{by} supersedes {}", stated(key, place)));
            }
            _ => self.fault(code, place, problem, remedy),
        }
    }

    /// A notice, once.
    pub(super) fn notice(&mut self, text: String) {
        if !self.notices.contains(&text) {
            self.notices.push(text);
        }
    }

    /// The value, or `None` with its error noted as a fault at `place`; the errors of the models say what to do.
    pub(super) fn accept<T, E: CodedError>(&mut self, place: &Place, result: Result<T, E>) -> Option<T> {
        result.map_err(|error| self.fault(error.code(), place, error.to_string(), "")).ok()
    }

    /// The faults found, each once: a key of the job is looked at for every camera.
    pub(super) fn into_faults(self) -> Vec<Fault> {
        let mut seen = BTreeSet::new();
        let is_new = |fault: &Fault| seen.insert((fault.place.clone(), fault.problem.clone(), fault.remedy.clone()));
        self.faults.into_iter().filter(is_new).collect()
    }

    /// A remark that the plan prints, equal ones once with their number.
    pub(super) fn remark(&mut self, text: impl Into<String>) {
        self.add(None, text.into(), Weight::Note);
    }

    /// A remark on a file, a place or a thing; the plan tells equal ones together.
    pub(super) fn remark_on(&mut self, about: impl Display, text: impl Into<String>) {
        self.add(Some(about.to_string()), text.into(), Weight::Note);
    }

    /// A remark that the picture may not be what was meant, which a rendering repeats.
    pub(super) fn warn(&mut self, text: impl Into<String>) {
        self.add(None, text.into(), Weight::Warning);
    }

    /// [`Context::warn`] on a file, a place or a thing.
    pub(super) fn warn_on(&mut self, about: impl Display, text: impl Into<String>) {
        self.add(Some(about.to_string()), text.into(), Weight::Warning);
    }

    fn add(&mut self, about: Option<String>, text: String, weight: Weight) {
        let is_same = |other: &&mut Remark| other.about == about && other.text == text && other.weight == weight;
        match self.remarks.iter_mut().find(is_same) {
            Some(same) => same.count += 1,
            None => self.remarks.push(Remark { about, text, weight, count: 1 }),
        }
    }
}
