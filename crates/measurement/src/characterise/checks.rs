//! Input that no measurement can use: images of several cameras, copies, saturated flat fields.

use std::collections::BTreeMap;

use etendue_io::failure::{Error, ErrorCode};

use super::{parameter::Kind, shot::Shot};

/// Maximum fraction of saturated pixels in a flat field; above it the frame determines the saturation level only.
const SATURATED: f64 = 0.01;
/// Errors of one kind that are reported individually.
const TOLD: usize = 5;

pub(super) fn check(shots: &[Shot]) -> Result<(), Error> {
    let faults = [mixed(shots), copies(shots), saturated(shots)].concat();
    if faults.is_empty() { Ok(()) } else { Err(Error::all_coded(ErrorCode::NotMeasurable, faults)) }
}

/// The first few, and the number of the others.
fn shortened(mut faults: Vec<String>, what: &str) -> Vec<String> {
    let more = faults.len().saturating_sub(TOLD);
    faults.truncate(TOLD);
    if more > 0 {
        faults.push(format!("{more} more {what}"));
    }
    faults
}

/// A property that all images of one camera share, as text; `None` if it is not known.
type Fact = fn(&Shot) -> Option<String>;

const OF_CAMERA: [(&str, Fact); 6] = [
    ("size", |shot| Some(format!("{} × {} pixels", shot.size_px[0], shot.size_px[1]))),
    ("maker", |shot| shot.exif.make.clone()),
    ("model", |shot| shot.exif.model.clone()),
    ("serial number", |shot| shot.exif.serial.clone()),
    ("pixel pitch", |shot| shot.side_car.pixel_pitch_um.map(|pitch| format!("{pitch} µm"))),
    ("bits of the ADC", |shot| shot.side_car.bits.map(|bits| bits.to_string())),
];

/// Properties that raw images share: one gain, and one number format.
const OF_RAW: [(&str, Fact); 4] = [
    ("sensitivity (ISO)", |shot| shot.exif.iso.map(|iso| iso.to_string())),
    ("largest number", |shot| Some(shot.full_scale.map_or("none (floats)".to_owned(), |full| full.to_string()))),
    ("colour filters", |shot| Some(shot.raw.as_ref()?.filters.channels.join(", "))),
    ("black and white level", |shot| {
        shot.raw.as_ref().map(|raw| format!("{} and {} DN", raw.black_level_dn, raw.white_level_dn))
    }),
];

fn mixed(shots: &[Shot]) -> Vec<String> {
    let all: Vec<&Shot> = shots.iter().collect();
    let raw: Vec<&Shot> = shots.iter().filter(|shot| shot.is_raw()).collect();
    let of = |shots: &[&Shot], facts: &[(&str, Fact)]| -> Vec<String> {
        facts.iter().flat_map(|(name, fact)| differing(shots, name, *fact)).collect()
    };
    shortened([of(&all, &OF_CAMERA), of(&raw, &OF_RAW)].concat(), "images differ from the others")
}

/// Images in which a property differs from that of most images.
fn differing(shots: &[&Shot], name: &str, fact: Fact) -> Vec<String> {
    let mut counts: BTreeMap<String, (usize, &Shot)> = BTreeMap::new();
    for &shot in shots {
        if let Some(said) = fact(shot) {
            counts.entry(said).or_insert((0, shot)).0 += 1;
        }
    }
    let Some((usual, (_, first))) = counts.iter().max_by_key(|(_, (count, _))| *count) else { return Vec::new() };
    let others = shots.iter().filter_map(|shot| Some((shot, fact(shot).filter(|said| said != usual)?)));
    let message = |(shot, said): (&&Shot, String)| {
        format!(
            "{}: camera or setting differs from that of {}: its {name} is {said}, not {usual}; a laboratory folder contains images of one camera at one gain",
            shot.name(),
            first.name()
        )
    };
    others.map(message).collect()
}

fn copies(shots: &[Shot]) -> Vec<String> {
    let mut seen: BTreeMap<_, &Shot> = BTreeMap::new();
    let mut faults = Vec::new();
    for shot in shots {
        let Some(mark) = shot.mark else { continue };
        match seen.get(&mark) {
            Some(first) => faults.push(format!(
                "{}: an exact copy of {}: noise cannot be measured from copies; give frames captured one after another",
                shot.name(),
                first.name()
            )),
            None => {
                seen.insert(mark, shot);
            }
        }
    }
    shortened(faults, "copies")
}

/// Flat fields with fewer than three unsaturated exposure times, or none.
fn saturated(shots: &[Shot]) -> Vec<String> {
    let of = |kind: Kind, least: usize| -> Option<String> {
        let frames: Vec<&Shot> = shots.iter().filter(|shot| shot.kind == kind).collect();
        let full: Vec<&&Shot> = frames.iter().filter(|shot| shot.saturated > SATURATED).collect();
        let left: Vec<Option<u64>> = {
            let good = frames.iter().filter(|shot| shot.saturated <= SATURATED);
            let mut times: Vec<_> = good.map(|shot| shot.exposure_s.map(f64::to_bits)).collect();
            times.sort_unstable();
            times.dedup();
            times
        };
        (full.len() > frames.len() / 2 && left.len() < least).then(|| {
            let worst = full.iter().max_by(|a, b| a.saturated.total_cmp(&b.saturated)).expect("there are some");
            format!(
                "{}/: {} of {} frames are saturated (in {}: {:.1} % of the pixels), and the others have {} exposure time(s), but \
                 {least} are needed; reduce the exposure",
                kind.folder(),
                full.len(),
                frames.len(),
                worst.name(),
                100.0 * worst.saturated,
                left.len()
            )
        })
    };
    [of(Kind::Flat, 3), of(Kind::Field, 1)].into_iter().flatten().collect()
}
