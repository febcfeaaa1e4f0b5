//! The layers of a file, by the readers of `etendue-io`.

mod exr;
mod facts;
mod picture;

use std::collections::BTreeMap;

use etendue::Error;
use etendue_io::correspondence::read_flow;

use crate::result_files::ResultFile;

pub(crate) use facts::{FileLayers, SideCar};

/// Reads the layers of a file; `side_car` is that of its folder.
///
/// # Errors
/// If it is damaged, or not of a kind that its name indicates.
pub(crate) fn layers(file: &ResultFile, side_car: &SideCar) -> Result<FileLayers, Error> {
    let ending = file.name.rsplit_once('.').map_or("", |(_, ending)| ending).to_ascii_lowercase();
    if ending == "exr" {
        return exr::layers(file, side_car);
    }
    let layer = match ending.as_str() {
        "json" => picture::boxes_layer(file)?,
        "flo" | "png" => match read_flow(&file.path).map_err(Error::input)? {
            Some(flow) => picture::flow_layer(file, &flow),
            None => picture::picture_layer(file, side_car)?,
        },
        _ => picture::picture_layer(file, side_car)?,
    };
    Ok(FileLayers { layers: vec![layer], facts: BTreeMap::new() })
}
