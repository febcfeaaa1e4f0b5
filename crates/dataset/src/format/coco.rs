//! COCO (Lin et al. 2014): pictures, and a JSON file of each split with boxes and masks.
//!
//! `coco/SPLIT/NNNNNN_CAMERA_FFFF.png`, `coco/annotations/instances_SPLIT.json`. An annotation is an object that has a class and is seen in a pixel; `bbox` is about the pixels that show it (left, top,
//! width, height; px), `area` their number, `segmentation` its mask. Categories are the scene's classes with their ids.

use super::writer::{Writer, write};
use crate::draw::Split;
use crate::picture::Picture;
use crate::record::{PictureRecord, SampleRecord};
use crate::records::Records;
use crate::set::Set;
use etendue::{Error, OutputFolder};
use serde_json::{Value, json};
use std::io::{self, Write};

pub(super) struct Coco;

impl Writer for Coco {
    fn picture(&self, _set: &Set, picture: &Picture<'_>, folder: &mut OutputFolder) -> Result<(), Error> {
        let (sample, split) = picture.sample;
        let name = format!("coco/{}/{}", split.name(), file_name(&picture.record, sample));
        write(folder, &name, &picture.bytes)
    }

    fn finish(&self, set: &Set, records: &Records, folder: &mut OutputFolder) -> Result<(), Error> {
        for split in Split::ALL {
            let name = format!("coco/annotations/instances_{}.json", split.name());
            folder.write_with(&name, |file| write_split(set, records, split, file)).map_err(Error::run)?;
        }
        Ok(())
    }
}

fn file_name(picture: &PictureRecord, sample: u32) -> String {
    format!("{}.{}", picture.stem(sample), picture.extension)
}

/// The pictures of a split with their ids, from 1 in the order of samples.
fn pictures(records: &Records, split: Split) -> impl Iterator<Item = io::Result<(u32, PictureRecord)>> + '_ {
    let of_split =
        move |record: &io::Result<SampleRecord>| record.as_ref().map_or(true, |record| record.split == split);
    records.each().filter(of_split).flat_map(|record| match record {
        Ok(SampleRecord { sample, pictures, .. }) => pictures.into_iter().map(|p| Ok((sample, p))).collect(),
        Err(error) => vec![Err(error)],
    })
}

/// The entries one after the other, so that none but one is in memory.
fn write_split(set: &Set, records: &Records, split: Split, file: &mut impl Write) -> io::Result<()> {
    let info = json!({ "description": "rendered by Étendue", "version": env!("CARGO_PKG_VERSION") });
    write!(file, "{{\"info\":{info},\n\"images\":[")?;
    for (index, found) in pictures(records, split).enumerate() {
        let (sample, picture) = found?;
        separate(file, index)?;
        write!(file, "{}", image(index + 1, sample, &picture))?;
    }
    write!(file, "],\n\"annotations\":[")?;
    let mut count = 0;
    for (index, found) in pictures(records, split).enumerate() {
        let (_, picture) = found?;
        for annotation in annotations(set, &picture, index + 1) {
            separate(file, count)?;
            count += 1;
            write!(file, "{}", with_id(annotation, count))?;
        }
    }
    let categories = set.classes.iter().map(|(name, id)| json!({ "id": id, "name": name })).collect::<Vec<_>>();
    writeln!(file, "],\n\"categories\":{}}}", Value::Array(categories))
}

fn separate(file: &mut impl Write, before: usize) -> io::Result<()> {
    file.write_all(if before > 0 { b",\n" } else { b"\n" })
}

fn with_id(mut annotation: Value, id: usize) -> Value {
    annotation["id"] = json!(id);
    annotation
}

fn image(id: usize, sample: u32, picture: &PictureRecord) -> Value {
    json!({
        "id": id,
        "file_name": file_name(picture, sample),
        "width": picture.width_px,
        "height": picture.height_px,
    })
}

fn annotations(set: &Set, picture: &PictureRecord, image: usize) -> Vec<Value> {
    let size = [picture.height_px, picture.width_px];
    let annotation = |(object, mask, [left, top, right, bottom]): (&crate::record::ObjectRecord, &str, [f64; 4])| {
        let category = set.class_id(object.class.as_deref())?;
        Some(json!({
            "image_id": image,
            "category_id": category,
            "bbox": [left, top, right - left, bottom - top],
            "area": object.visible_pixels,
            "segmentation": { "size": size, "counts": mask },
            "iscrowd": 0,
        }))
    };
    picture.visible().filter_map(annotation).collect()
}
