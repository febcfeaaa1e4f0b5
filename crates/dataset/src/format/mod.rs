//! The formats: the closed list, one file each.

mod bop;
mod cityscapes;
mod coco;
mod kitti;
mod nuscenes;
mod webdataset;
mod yolo;

use crate::draw::Split;
use crate::picture::Picture;
use crate::record::SampleRecord;
use crate::records::Records;
use crate::set::Set;
use etendue::{Error, OutputFolder};
use etendue_scene::record::variations::SetFormat;

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

/// The writers of a set.
pub(crate) fn writers(set: &Set) -> Result<Vec<Box<dyn Writer>>, Error> {
    set.formats.iter().map(|format| writer(*format, set)).collect()
}

fn writer(format: SetFormat, set: &Set) -> Result<Box<dyn Writer>, Error> {
    Ok(match format {
        SetFormat::Coco => Box::new(coco::Coco),
        SetFormat::Kitti => Box::new(kitti::Kitti),
        SetFormat::Cityscapes => Box::new(cityscapes::Cityscapes::of(set)?),
        SetFormat::Yolo => Box::new(yolo::Yolo),
        SetFormat::Bop => Box::new(bop::Bop::of(set)),
        SetFormat::WebDataset => Box::new(webdataset::WebDataset::of(set)),
        SetFormat::NuScenes => Box::new(nuscenes::NuScenes),
    })
}

/// Writes a file.
fn write(folder: &mut OutputFolder, name: &str, bytes: &[u8]) -> Result<(), Error> {
    folder.write(name, bytes).map_err(Error::run)
}
