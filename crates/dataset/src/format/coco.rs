//! Boxes for detectors: COCO and YOLO.
//!
//! COCO (Lin et al. 2014): images, and a JSON file per split with boxes and masks.
//!
//! `coco/SPLIT/NNNNNN_CAMERA_FFFF.png`, `coco/annotations/instances_SPLIT.json`. An annotation is an object that has a class and at least one visible pixel;
//! `bbox` bounds its visible pixels (left, top, width, height; px), `area` is their number, `segmentation` its mask. Categories are the scene's classes with
//! their ids.
//!
//! YOLO as Ultralytics reads it: `yolo/data.yaml`, `yolo/images/SPLIT` and, with the same names, `yolo/labels/SPLIT`.
//!
//! A line is an object that has a class and at least one visible pixel: the index of its class among the scene's classes (from 0, in the order of their ids),
//! and centre, width and height of the box of its visible pixels, as fractions of the image's width and height. An image without objects has an empty file.

use std::fmt::Write as _;
use std::io::{self, Write};

use etendue::{Error, OutputFolder};
use serde_json::{Value, json};

use crate::record::{ImageRecord, SampleRecord};
use crate::records::{FormatWriter, Records, write};
use crate::{draw::Split, picture::SampleImage, set::Set};

pub(super) struct Coco;

impl FormatWriter for Coco {
    fn write_image(&self, _set: &Set, image: &SampleImage<'_>, folder: &mut OutputFolder) -> Result<(), Error> {
        let (sample, split) = image.sample;
        let name = format!("coco/{}/{}", split.name(), file_name(&image.record, sample));
        write(folder, &name, &image.bytes)
    }

    fn finish(&self, set: &Set, records: &Records, folder: &mut OutputFolder) -> Result<(), Error> {
        for split in Split::ALL {
            let name = format!("coco/annotations/instances_{}.json", split.name());
            folder.write_with(&name, |file| write_split(set, records, split, file)).map_err(Error::run)?;
        }
        Ok(())
    }
}

fn file_name(image: &ImageRecord, sample: u32) -> String {
    format!("{}.{}", image.stem(sample), image.extension)
}

/// Images of a split with their ids, from 1 in the order of samples.
fn image_records(records: &Records, split: Split) -> impl Iterator<Item = io::Result<(u32, ImageRecord)>> + '_ {
    let of_split =
        move |record: &io::Result<SampleRecord>| record.as_ref().map_or(true, |record| record.split == split);
    records.each().filter(of_split).flat_map(|record| match record {
        Ok(SampleRecord { sample, pictures, .. }) => pictures.into_iter().map(|p| Ok((sample, p))).collect(),
        Err(error) => vec![Err(error)],
    })
}

/// Writes the entries one by one, so that only one is in memory.
fn write_split(set: &Set, records: &Records, split: Split, file: &mut impl Write) -> io::Result<()> {
    let info = json!({ "description": "rendered by Étendue", "version": env!("CARGO_PKG_VERSION") });
    write!(file, "{{\"info\":{info},\n\"images\":[")?;
    for (index, entry) in image_records(records, split).enumerate() {
        let (sample, picture) = entry?;
        separate(file, index)?;
        write!(file, "{}", image(index + 1, sample, &picture))?;
    }
    write!(file, "],\n\"annotations\":[")?;
    let mut count = 0;
    for (index, entry) in image_records(records, split).enumerate() {
        let (_, picture) = entry?;
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

fn image(id: usize, sample: u32, picture: &ImageRecord) -> Value {
    json!({
        "id": id,
        "file_name": file_name(picture, sample),
        "width": picture.width_px,
        "height": picture.height_px,
    })
}

fn annotations(set: &Set, picture: &ImageRecord, image: usize) -> Vec<Value> {
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

pub(super) struct Yolo;

impl FormatWriter for Yolo {
    fn write_image(&self, set: &Set, picture: &SampleImage<'_>, folder: &mut OutputFolder) -> Result<(), Error> {
        let (sample, split) = picture.sample;
        let (split, stem) = (split.name(), picture.record.stem(sample));
        let image = format!("yolo/images/{split}/{stem}.{}", picture.record.extension);
        write(folder, &image, &picture.bytes)?;
        write(folder, &format!("yolo/labels/{split}/{stem}.txt"), lines(set, &picture.record).as_bytes())
    }

    fn finish(&self, set: &Set, records: &Records, folder: &mut OutputFolder) -> Result<(), Error> {
        let mut has = Split::ALL.map(|_| false);
        for record in records.each() {
            has[record.map_err(Error::run)?.split as usize] = true;
        }
        write(folder, "yolo/data.yaml", data(set, has).as_bytes())
    }
}

fn lines(set: &Set, image: &ImageRecord) -> String {
    let (width, height) = (image.width_px as f64, image.height_px as f64);
    let mut text = String::new();
    for (object, _, [left, top, right, bottom]) in image.visible() {
        let Some(class) = set.class_place(object.class.as_deref()) else { continue };
        let centre = [(left + right) / (2.0 * width), (top + bottom) / (2.0 * height)];
        let size = [(right - left) / width, (bottom - top) / height];
        let _ = writeln!(text, "{class} {:.9} {:.9} {:.9} {:.9}", centre[0], centre[1], size[0], size[1]);
    }
    text
}

/// Paths are relative to the file, as readers expect if no `path` is stated. Both splits must be named: if a set has only one, it also serves as the other.
fn data(set: &Set, has: [bool; 2]) -> String {
    let folder = |split: Split| {
        let named = if has[split as usize] || !has.contains(&true) { split } else { Split::ALL[1 - split as usize] };
        format!("images/{}", named.name())
    };
    let mut text = format!("train: {}\nval: {}\nnames:\n", folder(Split::Train), folder(Split::Val));
    for (place, (name, _)) in set.classes.iter().enumerate() {
        // JSON string quotes are valid in YAML.
        let _ = writeln!(text, "  {place}: {}", serde_json::Value::from(name.as_str()));
    }
    text
}
