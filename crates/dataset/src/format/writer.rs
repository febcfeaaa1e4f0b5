//! What a format writes, and when.

use crate::picture::Picture;
use crate::record::SampleRecord;
use crate::records::Records;
use crate::set::Set;
use etendue::{Error, OutputFolder};
use std::ops::Range;
use std::path::Path;

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
pub(super) fn write(folder: &mut OutputFolder, name: &str, bytes: &[u8]) -> Result<(), Error> {
    folder.write(name, bytes).map_err(Error::run)
}
