//! What a format writes, and when.

use crate::draw::Split;
use crate::picture::Picture;
use crate::record::SampleRecord;
use crate::records::Records;
use crate::set::Set;
use etendue::{Error, OutputFolder};

/// Writes one format.
pub(crate) trait Writer {
    /// The files of one picture.
    fn picture(
        &self,
        set: &Set,
        sample: (u32, Split),
        picture: &Picture<'_>,
        folder: &mut OutputFolder,
    ) -> Result<(), Error>;

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
