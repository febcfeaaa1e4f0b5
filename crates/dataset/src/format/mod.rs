//! Formats: the closed list, one file each.

mod bop;
mod cityscapes;
mod coco;
mod cryptomatte;
mod kitti;
mod mcap;
mod nuscenes;
mod openlabel;
mod osi;
mod ros;
mod webdataset;

use etendue::Error;
use etendue_scene::record::variations::SetFormat;

use crate::set::Set;

pub(crate) use crate::records::FormatWriter;

/// The writers of a set.
pub(crate) fn writers(set: &Set) -> Result<Vec<Box<dyn FormatWriter>>, Error> {
    set.formats.iter().map(|format| writer(*format, set)).collect()
}

fn writer(format: SetFormat, set: &Set) -> Result<Box<dyn FormatWriter>, Error> {
    Ok(match format {
        SetFormat::Coco => Box::new(coco::Coco),
        SetFormat::Kitti => Box::new(kitti::Kitti),
        SetFormat::Cityscapes => Box::new(cityscapes::Cityscapes::new(set)?),
        SetFormat::Yolo => Box::new(coco::Yolo),
        SetFormat::Bop => Box::new(bop::Bop::new(set)),
        SetFormat::WebDataset => Box::new(webdataset::WebDataset::new(set)),
        SetFormat::NuScenes => Box::new(nuscenes::NuScenes),
        SetFormat::Cryptomatte => Box::new(cryptomatte::Cryptomatte),
        SetFormat::Mcap => Box::new(mcap::Mcap::default()),
        SetFormat::OpenLabel => Box::new(openlabel::OpenLabel),
        SetFormat::Osi => Box::new(osi::Osi::default()),
    })
}
