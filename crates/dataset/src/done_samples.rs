//! Complete samples of a folder. A resumed run keeps them and renders all others again.
//!
//! The record of a sample states its changes, the digests of its files and a hash of itself. A sample is complete if all of that agrees with the set and with
//! the folder. For samples outside the run only the records are checked: files over all samples are made from them.

use std::{ops::Range, path::Path};

use etendue::{Error, ErrorCode, Message, Observer};

use crate::records::{Records, record_name};
use crate::{draw::SampleVariation, format::FormatWriter, record::SampleRecord, set::Set};

/// Samples of a folder, checked by a run of some of them.
pub(crate) struct CompleteSamples<'a> {
    pub(crate) set: &'a Set,
    pub(crate) writers: &'a [Box<dyn FormatWriter>],
    pub(crate) root: &'a Path,
    pub(crate) records: &'a Records,
}

impl CompleteSamples<'_> {
    /// Refuses unusable records of samples outside the run.
    pub(crate) fn check_others(&self, samples: &Range<u32>) -> Result<(), Error> {
        for sample in self.records.numbers().iter().filter(|sample| !samples.contains(sample)) {
            if let Err(why) = self.record(*sample) {
                let path = self.root.join(record_name(*sample));
                return Err(Error::coded(
                    ErrorCode::OtherRun,
                    format!("{}: {why}; make sample {sample} again by resuming in this folder", path.display()),
                ));
            }
        }
        Ok(())
    }

    /// Samples that a resumed run renders: those that are missing or incomplete. Incomplete ones are reported to the observer.
    pub(crate) fn remaining(&self, samples: &Range<u32>, observer: &dyn Observer) -> Vec<u32> {
        let is_left = |sample: &u32| {
            if self.records.numbers().binary_search(sample).is_err() {
                return true;
            }
            let Err(why) = self.check_complete(*sample) else { return false };
            let path = self.root.join(record_name(*sample));
            observer.message(Message::Note(&format!("{}: {why}; sample {sample} is made again", path.display())));
            true
        };
        samples.clone().filter(is_left).collect()
    }

    /// Record of the set.
    fn record(&self, sample: u32) -> Result<SampleRecord, String> {
        let record = self.records.read(sample)?;
        let drawn = SampleVariation::new(self.set.variations.as_ref(), self.set.seed, sample);
        match (record.seed, &record.set) == (drawn.seed, &drawn.set()) && record.split == drawn.split {
            true => Ok(record),
            false => Err("its values differ from those that this data set samples".to_owned()),
        }
    }

    /// Record whose files are unchanged.
    fn check_complete(&self, sample: u32) -> Result<(), String> {
        let record = self.record(sample)?;
        let is_there = |name: &str| {
            let digest = &record.files[name];
            digest.matches(&self.root.join(name))
                || self.writers.iter().any(|writer| writer.has_file(name, &record, self.records, self.root))
        };
        match record.files.keys().find(|name| !is_there(name)) {
            Some(name) => Err(format!("{name} is missing or was changed")),
            None => Ok(()),
        }
    }
}
