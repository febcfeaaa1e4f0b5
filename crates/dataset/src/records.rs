//! Records of samples, and the writer that a format has for them.

use std::path::{Path, PathBuf};
use std::{io, ops::Range};

use etendue::{Error, OutputFolder};
use etendue_io::read_regular;
use etendue_scene::limits::DESCRIPTION;

use crate::{picture::Picture, record::SampleRecord, set::Set};

/// The folder of the samples' records.
const SAMPLES: &str = "samples";

/// The name of a sample's record.
pub(crate) fn record_name(sample: u32) -> String {
    format!("{SAMPLES}/{sample:06}.json")
}

/// The samples of a folder, in the order of their numbers; one is in memory at a time.
pub(crate) struct Records {
    root: PathBuf,
    samples: Vec<u32>,
}

impl Records {
    /// Of the folder of a data set, which may have no sample yet.
    pub(crate) fn in_folder(root: &Path) -> Result<Self, Error> {
        if root.join(SAMPLES).exists() {
            Self::of(root)
        } else {
            Ok(Self { root: root.to_path_buf(), samples: Vec::new() })
        }
    }

    /// Of the folder of a data set that has samples.
    pub(crate) fn of(root: &Path) -> Result<Self, Error> {
        let entries = std::fs::read_dir(root.join(SAMPLES)).map_err(Error::run)?;
        let mut samples = Vec::new();
        for entry in entries {
            let name = entry.map_err(Error::run)?.file_name();
            let number = name.to_str().and_then(|name| name.strip_suffix(".json")).and_then(|stem| stem.parse().ok());
            samples.extend(number.filter(|sample| record_name(*sample).ends_with(&*name.to_string_lossy())));
        }
        samples.sort_unstable();
        Ok(Self { root: root.to_path_buf(), samples })
    }

    /// The numbers of the samples.
    pub(crate) fn numbers(&self) -> &[u32] {
        &self.samples
    }

    /// One after the other.
    pub(crate) fn each(&self) -> impl Iterator<Item = io::Result<SampleRecord>> + '_ {
        self.samples.iter().map(|sample| {
            let path = self.root.join(record_name(*sample));
            self.read(*sample).map_err(|why| io::Error::other(format!("{}: {why}", path.display())))
        })
    }

    /// The record of a sample; why it cannot be used, in words.
    pub(crate) fn read(&self, sample: u32) -> Result<SampleRecord, String> {
        let bytes =
            read_regular(&self.root.join(record_name(sample)), &DESCRIPTION).map_err(|cause| cause.to_string())?;
        let record: SampleRecord =
            serde_json::from_slice(&bytes).map_err(|why| format!("this is not the record of a sample: {why}"))?;
        match (record.sample == sample, record.is_sealed()) {
            (true, true) => Ok(record),
            (false, _) => Err(format!("this is the record of sample {}", record.sample)),
            (true, false) => Err("the record was changed after it was written".to_owned()),
        }
    }
}

/// Writes one format.
pub(crate) trait Writer {
    /// Refuses to make samples anew in the place of ones that are in the folder, where what is made of them is not to be had in part.
    fn check_replaced(&self, _records: &Records, _samples: &Range<u32>, _folder: &OutputFolder) -> Result<(), Error> {
        Ok(())
    }

    /// Returns true where a file of a sample that is no longer in its place is, as it was written, part of another file of the format.
    fn holds(&self, _name: &str, _record: &SampleRecord, _records: &Records, _root: &Path) -> bool {
        false
    }

    /// The files of one picture.
    fn picture(&self, set: &Set, picture: &Picture<'_>, folder: &mut OutputFolder) -> Result<(), Error>;

    /// The files of one sample, after those of its pictures.
    fn sample(&self, _set: &Set, _record: &SampleRecord, _folder: &mut OutputFolder) -> Result<(), Error> {
        Ok(())
    }

    /// The files of all samples that are in the folder.
    fn finish(&self, set: &Set, records: &Records, folder: &mut OutputFolder) -> Result<(), Error>;

    /// Removes what is of no more use when these have their names.
    fn tidy(&self, _records: &Records, _folder: &mut OutputFolder) -> Result<(), Error> {
        Ok(())
    }
}

/// Writes a file.
pub(crate) fn write(folder: &mut OutputFolder, name: &str, bytes: &[u8]) -> Result<(), Error> {
    folder.write(name, bytes).map_err(Error::run)
}
