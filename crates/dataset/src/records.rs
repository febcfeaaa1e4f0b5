//! Records of samples, and the writer trait of formats.

use std::path::{Path, PathBuf};
use std::{io, ops::Range};

use etendue::{Error, OutputFolder};
use etendue_io::read_regular;
use etendue_scene::limits::DESCRIPTION;

use crate::{picture::SampleImage, record::SampleRecord, set::Set};

/// Folder of the samples' records.
const SAMPLES: &str = "samples";

/// Name of a sample's record.
pub(crate) fn record_name(sample: u32) -> String {
    format!("{SAMPLES}/{sample:06}.json")
}

/// Samples of a folder, in the order of their numbers; one is in memory at a time.
pub(crate) struct Records {
    root: PathBuf,
    samples: Vec<u32>,
}

impl Records {
    /// Returns those in the folder of a data set, which may have no sample yet.
    pub(crate) fn in_folder(root: &Path) -> Result<Self, Error> {
        if root.join(SAMPLES).exists() {
            Self::new(root)
        } else {
            Ok(Self { root: root.to_path_buf(), samples: Vec::new() })
        }
    }

    /// Returns those in the folder of a data set that has samples.
    pub(crate) fn new(root: &Path) -> Result<Self, Error> {
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

    /// Numbers of the samples.
    pub(crate) fn numbers(&self) -> &[u32] {
        &self.samples
    }

    /// Iterates over the records.
    pub(crate) fn each(&self) -> impl Iterator<Item = io::Result<SampleRecord>> + '_ {
        self.samples.iter().map(|sample| {
            let path = self.root.join(record_name(*sample));
            self.read(*sample).map_err(|why| io::Error::other(format!("{}: {why}", path.display())))
        })
    }

    /// Record of a sample, or the reason in words for which it cannot be used.
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

/// Writer of one format.
pub(crate) trait FormatWriter {
    /// Refuses to render samples again in a folder if the files made from them cannot be replaced in part.
    fn check_replaced(&self, _records: &Records, _samples: &Range<u32>, _folder: &OutputFolder) -> Result<(), Error> {
        Ok(())
    }

    /// Returns true if a file of a sample, no longer at its path, is part of another file of the format, unchanged.
    fn has_file(&self, _name: &str, _record: &SampleRecord, _records: &Records, _root: &Path) -> bool {
        false
    }

    /// Writes the files of one image.
    fn write_image(&self, set: &Set, image: &SampleImage<'_>, folder: &mut OutputFolder) -> Result<(), Error>;

    /// Writes the files of one sample, after those of its images.
    fn sample(&self, _set: &Set, _record: &SampleRecord, _folder: &mut OutputFolder) -> Result<(), Error> {
        Ok(())
    }

    /// Writes the files over all samples in the folder.
    fn finish(&self, set: &Set, records: &Records, folder: &mut OutputFolder) -> Result<(), Error>;

    /// Removes files that are no longer needed once these have their names.
    fn remove_obsolete(&self, _records: &Records, _folder: &mut OutputFolder) -> Result<(), Error> {
        Ok(())
    }
}

/// Writes a file.
pub(crate) fn write(folder: &mut OutputFolder, name: &str, bytes: &[u8]) -> Result<(), Error> {
    folder.write(name, bytes).map_err(Error::run)
}
