//! YOLO as Ultralytics reads it: `yolo/data.yaml`, `yolo/images/SPLIT` and, with the same names, `yolo/labels/SPLIT`.
//!
//! A line is an object that has a class and is seen in a pixel: the place of its class among the scene's classes (from 0, in the order of their ids), and centre, width and height of the box about the pixels that
//! show it, in parts of the picture's width and height. A picture without objects has an empty file.

use super::writer::{Writer, write};
use crate::draw::Split;
use crate::picture::Picture;
use crate::record::PictureRecord;
use crate::records::Records;
use crate::set::Set;
use etendue::{Error, OutputFolder};
use std::fmt::Write as _;

pub(super) struct Yolo;

impl Writer for Yolo {
    fn picture(&self, set: &Set, picture: &Picture<'_>, folder: &mut OutputFolder) -> Result<(), Error> {
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

fn lines(set: &Set, picture: &PictureRecord) -> String {
    let (width, height) = (picture.width_px as f64, picture.height_px as f64);
    let mut text = String::new();
    for (object, _, [left, top, right, bottom]) in picture.visible() {
        let Some(class) = set.class_place(object.class.as_deref()) else { continue };
        let centre = [(left + right) / (2.0 * width), (top + bottom) / (2.0 * height)];
        let size = [(right - left) / width, (bottom - top) / height];
        let _ = writeln!(text, "{class} {:.9} {:.9} {:.9} {:.9}", centre[0], centre[1], size[0], size[1]);
    }
    text
}

/// Folders are said from that of the file, as readers take them where no `path` is stated. Both splits must be named: where a set has one of them, it serves as the other as well.
fn data(set: &Set, has: [bool; 2]) -> String {
    let folder = |split: Split| {
        let named = if has[split as usize] || !has.contains(&true) { split } else { Split::ALL[1 - split as usize] };
        format!("images/{}", named.name())
    };
    let mut text = format!("train: {}\nval: {}\nnames:\n", folder(Split::Train), folder(Split::Val));
    for (place, (name, _)) in set.classes.iter().enumerate() {
        // Names in quotes of JSON are names in quotes of YAML.
        let _ = writeln!(text, "  {place}: {}", serde_json::Value::from(name.as_str()));
    }
    text
}
