//! Input that no measurement can use: images of several cameras, copies, saturated flat fields.

use std::collections::BTreeMap;

use etendue_io::failure::{Error, ErrorCode};

use super::{parameter::ImageKind, shot::LaboratoryImage};

/// Maximum fraction of saturated pixels in a flat field; above it the frame determines the saturation level only.
const MAX_SATURATED_FRACTION: f64 = 0.01;
/// Errors of one kind that are reported individually.
const MAX_REPORTED: usize = 5;

pub(super) fn check(shots: &[LaboratoryImage]) -> Result<(), Error> {
    let errors = [mixed(shots), copies(shots), saturated(shots)].concat();
    if errors.is_empty() { Ok(()) } else { Err(Error::all_coded(ErrorCode::NotMeasurable, errors)) }
}

/// The first few, and the number of the others.
fn shortened(mut errors: Vec<String>, subject: &str) -> Vec<String> {
    let more = errors.len().saturating_sub(MAX_REPORTED);
    errors.truncate(MAX_REPORTED);
    if more > 0 {
        errors.push(format!("{more} more {subject}"));
    }
    errors
}

/// A property that all images of one camera share, as text; `None` if it is not known.
type ShotProperty = fn(&LaboratoryImage) -> Option<String>;

const CAMERA_PROPERTIES: [(&str, ShotProperty); 6] = [
    ("size", |shot| Some(format!("{} × {} pixels", shot.size_px[0], shot.size_px[1]))),
    ("maker", |shot| shot.exif.make.clone()),
    ("model", |shot| shot.exif.model.clone()),
    ("serial number", |shot| shot.exif.serial.clone()),
    ("pixel pitch", |shot| shot.side_car.pixel_pitch_um.map(|pitch| format!("{pitch} µm"))),
    ("bits of the ADC", |shot| shot.side_car.bits.map(|bits| bits.to_string())),
];

/// Properties that raw images share: one gain, and one number format.
const RAW_PROPERTIES: [(&str, ShotProperty); 4] = [
    ("sensitivity (ISO)", |shot| shot.exif.iso.map(|iso| iso.to_string())),
    ("largest number", |shot| Some(shot.full_scale.map_or("none (floats)".to_owned(), |full| full.to_string()))),
    ("colour filters", |shot| Some(shot.raw.as_ref()?.filters.channels.join(", "))),
    ("black and white level", |shot| {
        shot.raw.as_ref().map(|raw| format!("{} and {} DN", raw.black_level_dn, raw.white_level_dn))
    }),
];

fn mixed(shots: &[LaboratoryImage]) -> Vec<String> {
    let all: Vec<&LaboratoryImage> = shots.iter().collect();
    let raw: Vec<&LaboratoryImage> = shots.iter().filter(|shot| shot.is_raw()).collect();
    let differences = |shots: &[&LaboratoryImage], facts: &[(&str, ShotProperty)]| -> Vec<String> {
        facts.iter().flat_map(|(name, fact)| differing(shots, name, *fact)).collect()
    };
    shortened(
        [differences(&all, &CAMERA_PROPERTIES), differences(&raw, &RAW_PROPERTIES)].concat(),
        "images differ from the others",
    )
}

/// Images in which a property differs from that of most images.
fn differing(shots: &[&LaboratoryImage], name: &str, fact: ShotProperty) -> Vec<String> {
    let mut counts: BTreeMap<String, (usize, &LaboratoryImage)> = BTreeMap::new();
    for &shot in shots {
        if let Some(value) = fact(shot) {
            counts.entry(value).or_insert((0, shot)).0 += 1;
        }
    }
    let Some((most_common, (_, first))) = counts.iter().max_by_key(|(_, (count, _))| *count) else { return Vec::new() };
    let others = shots.iter().filter_map(|shot| Some((shot, fact(shot).filter(|value| value != most_common)?)));
    let message = |(shot, value): (&&LaboratoryImage, String)| {
        format!(
            "{}: camera or setting differs from that of {}: its {name} is {value}, not {most_common}; a laboratory folder contains images of one camera at one gain",
            shot.name(),
            first.name()
        )
    };
    others.map(message).collect()
}

fn copies(shots: &[LaboratoryImage]) -> Vec<String> {
    let mut first_by_hash: BTreeMap<_, &LaboratoryImage> = BTreeMap::new();
    let mut errors = Vec::new();
    for shot in shots {
        let Some(mark) = shot.content_hash else { continue };
        match first_by_hash.get(&mark) {
            Some(first) => errors.push(format!(
                "{}: an exact copy of {}: noise cannot be measured from copies; give frames captured one after another",
                shot.name(),
                first.name()
            )),
            None => {
                first_by_hash.insert(mark, shot);
            }
        }
    }
    shortened(errors, "copies")
}

/// Flat fields with fewer than three unsaturated exposure times, or none.
fn saturated(shots: &[LaboratoryImage]) -> Vec<String> {
    let saturation_error = |kind: ImageKind, min_frames: usize| -> Option<String> {
        let frames: Vec<&LaboratoryImage> = shots.iter().filter(|shot| shot.kind == kind).collect();
        let full: Vec<&&LaboratoryImage> =
            frames.iter().filter(|shot| shot.saturated > MAX_SATURATED_FRACTION).collect();
        let left: Vec<Option<u64>> = {
            let good = frames.iter().filter(|shot| shot.saturated <= MAX_SATURATED_FRACTION);
            let mut times: Vec<_> = good.map(|shot| shot.exposure_s.map(f64::to_bits)).collect();
            times.sort_unstable();
            times.dedup();
            times
        };
        (full.len() > frames.len() / 2 && left.len() < min_frames).then(|| {
            let worst = full.iter().max_by(|a, b| a.saturated.total_cmp(&b.saturated)).expect("there are some");
            format!(
                "{}/: {} of {} frames are saturated (in {}: {:.1} % of the pixels), and the others have {} exposure time(s), but \
                 {min_frames} are needed; reduce the exposure",
                kind.folder(),
                full.len(),
                frames.len(),
                worst.name(),
                100.0 * worst.saturated,
                left.len()
            )
        })
    };
    [saturation_error(ImageKind::Flat, 3), saturation_error(ImageKind::Field, 1)].into_iter().flatten().collect()
}
