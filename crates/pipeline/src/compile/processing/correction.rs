//! Black level, defects and shading.

use super::super::context::{Context, ErrorCode};
use etendue_isp::{BlackLevel, Defects, Shading};
use etendue_projection::Raster;
use etendue_scene::asset::NumbersAsset;
use etendue_scene::record::processing as description;
use etendue_scene::record::processing::correction::{BlackLevelRule, ShadingTable};
use etendue_scene::{Placed, record};
use etendue_sensor::Sensor;
use std::path::PathBuf;

pub(super) fn black_level(
    record: Option<&description::BlackLevel>,
    sensor: &Sensor,
    context: &mut Context<'_>,
) -> Option<BlackLevel> {
    match record {
        None => Some(BlackLevel::Stated),
        Some(description::BlackLevel::Dn(dn)) if dn.value < sensor.min_white_level_dn() => {
            Some(BlackLevel::Fixed(dn.value))
        }
        Some(description::BlackLevel::Dn(dn)) => {
            let white = sensor.min_white_level_dn();
            let problem = format!("found {}, but the sensor saturates at {white} DN", dn.value);
            context.error(ErrorCode::OutOfRange, &dn.place, problem, "give a number below that");
            None
        }
        Some(description::BlackLevel::Rule(rule)) => match rule.value {
            BlackLevelRule::Sensor => Some(BlackLevel::Stated),
            BlackLevelRule::OpticalBlack if has_shielded_pixels(sensor) => Some(BlackLevel::OpticalBlack),
            BlackLevelRule::OpticalBlack => {
                context.error(
                    ErrorCode::Contradiction,
                    &rule.place,
                    "the sensor has no optical-black rows or columns",
                    "give \"sensor\", or a number",
                );
                None
            }
        },
    }
}

fn has_shielded_pixels(sensor: &Sensor) -> bool {
    let dark = sensor.parameters().read_out.layout.optical_black;
    dark.rows + dark.columns > 0
}

pub(super) fn defects(
    record: &record::Processing,
    image: &DeliveredImage,
    context: &mut Context<'_>,
) -> Option<Defects> {
    let map = match &record.defect_map {
        None => Vec::new(),
        Some(file) => defect_map(file, image, context)?,
    };
    Some(Defects { map, outlier_threshold: record.defect_outlier_threshold.as_ref().map(|t| t.value) })
}

fn defect_map(file: &Placed<PathBuf>, image: &DeliveredImage, context: &mut Context<'_>) -> Option<Vec<[u32; 2]>> {
    let table = table(file, 2, "columns and rows of defective pixels", context)?;
    let k = image.scale as usize;
    let (width, height) = (image.width * k, image.height * k);
    // A larger pixel with a defective part is defective.
    let inside = |row: &[f64]| {
        let are_counts = row.iter().all(|v| *v >= 0.0 && v.fract() == 0.0);
        let is_inside = are_counts && row[0] < width as f64 && row[1] < height as f64;
        is_inside.then(|| [row[0], row[1]].map(|at| (at as usize / k) as u32))
    };
    let pixels: Option<Vec<_>> = table.rows().map(inside).collect();
    if pixels.is_none() {
        let problem = format!("the defect map has a pixel outside the image of {width} × {height}");
        context.error(
            ErrorCode::UnsuitableFile,
            &file.place,
            problem,
            "give columns and rows as whole numbers, counted from 0",
        );
    }
    let mut pixels = pixels?;
    if k > 1 {
        pixels.sort_unstable();
        pixels.dedup();
    }
    Some(pixels)
}

pub(super) fn shading(
    record: Option<&description::Shading>,
    image: &DeliveredImage,
    context: &mut Context<'_>,
) -> Option<Option<Shading>> {
    let Some(record) = record else { return Some(None) };
    let (shading, place) = match &record.table {
        ShadingTable::Radial(gains) => {
            let centre_px = record.centre_px.as_ref().map_or(image.principal_px, |c| c.value);
            (Shading::Radial { centre_px, gains: gains.iter().map(|g| g.value).collect() }, &record.place)
        }
        ShadingTable::Grid(file) => {
            let table = context.assets.numbers.get(&file.value)?;
            (Shading::Grid { columns: table.columns, gains: table.values.clone() }, &file.place)
        }
    };
    context.accept(place, shading.check()).map(|()| Some(shading))
}

/// A table with a given number of columns.
pub(super) fn table<'a>(
    file: &Placed<PathBuf>,
    columns: usize,
    of: &str,
    context: &mut Context<'a>,
) -> Option<&'a NumbersAsset> {
    let table = context.assets.numbers.get(&file.value)?;
    if table.columns == columns {
        return Some(table);
    }
    let problem = format!("the table has {} columns; expected {columns}: {of}", table.columns);
    context.error(ErrorCode::UnsuitableFile, &file.place, problem, "correct the file");
    None
}

/// Image that a sensor delivers: its region, binned.
pub(super) struct DeliveredImage {
    pub(super) width: usize,
    pub(super) height: usize,
    /// Position of the optical axis in it, px.
    pub(super) principal_px: [f64; 2],
    /// Number of pixels of the described sensor in a row and in a column of one pixel.
    pub(super) scale: u64,
}

impl DeliveredImage {
    pub(super) fn new(sensor: &Sensor, raster: &Raster, scale: u64) -> Self {
        let (width, height) = sensor.image_size(raster.width(), raster.height());
        Self { width, height, principal_px: sensor.to_image(raster.principal_px().to_array()), scale }
    }
}
