//! One image of a laboratory folder, and its properties before measurement.

use std::path::{Path, PathBuf};

use etendue_io::exif::{Exif, read_exif};
use etendue_io::hash::{ContentHash, hash_bytes};
use etendue_io::photograph::{Photograph, RawFacts, read_photograph};
use etendue_io::{failure::Error, sidecar};
use serde_json::Value;

use super::parameter::ImageKind;

#[derive(Clone, Debug)]
pub(super) struct LaboratoryImage {
    pub(super) kind: ImageKind,
    pub(super) file: PathBuf,
    /// Columns and rows of the image, excluding dark ones.
    pub(super) size_px: [usize; 2],
    /// Image area within the file: left column, top row, columns, rows.
    pub(super) picture_px: [usize; 4],
    pub(super) channels: usize,
    /// Largest number that the file can hold; `None` for floats.
    pub(super) full_scale: Option<f64>,
    /// Facts of its side-car, if raw.
    pub(super) raw: Option<RawFacts>,
    /// Facts of this program's side-car.
    pub(super) side_car: SideCarFacts,
    pub(super) exif: Exif,
    /// Exposure time, s.
    pub(super) exposure_s: Option<f64>,
    /// Hash of the numbers; `None` if all numbers of a channel are equal, as in black or saturated frames.
    pub(super) content_hash: Option<ContentHash>,
    /// Fraction of saturated pixels, 0 to 1.
    pub(super) saturated: f64,
}

/// Camera facts from a side-car of this program.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct SideCarFacts {
    pub(super) pixel_pitch_um: Option<f64>,
    pub(super) bits: Option<u64>,
    pub(super) f_number: Option<f64>,
}

/// Pixels at a frame's maximum count as saturated if they are more than this fraction of it.
const MIN_SATURATED_FRACTION: f64 = 0.01;

impl LaboratoryImage {
    pub(super) fn read(kind: ImageKind, file: &Path, stated_exposure_s: Option<f64>) -> Result<Self, Error> {
        let photograph = read_photograph(file).map_err(Error::input)?;
        let exif = read_exif(file).map_err(Error::input)?.unwrap_or_default();
        let raw = photograph.raw.clone();
        let full_frame = [0, 0, photograph.width, photograph.height];
        let picture_px = raw.as_ref().and_then(|facts| Some(facts.frame.as_ref()?.picture_px)).unwrap_or(full_frame);
        let white = raw.as_ref().map(|facts| facts.white_level_dn).or(exif.white_level_dn);
        let side_car = SideCarFacts::read_beside_image(file)?;
        let own_exposure_s =
            raw.as_ref().map(|facts| facts.exposure_s).or(SideCarFacts::exposure_s(file)?).or(exif.exposure_s);
        Ok(Self {
            kind,
            file: file.to_path_buf(),
            size_px: [picture_px[2], picture_px[3]],
            picture_px,
            channels: photograph.channels.len(),
            full_scale: photograph.full_scale,
            exposure_s: stated_exposure_s.or(own_exposure_s),
            content_hash: content_hash_of(&photograph),
            saturated: saturated(&photograph, white),
            raw,
            side_car,
            exif,
        })
    }

    /// True if its numbers are those of single pixels.
    pub(super) fn is_raw(&self) -> bool {
        self.channels == 1
    }

    /// Path of the file within the laboratory folder.
    pub(super) fn name(&self) -> String {
        self.file.display().to_string()
    }
}

impl SideCarFacts {
    fn read_json(file: &Path) -> Result<Option<Value>, Error> {
        let side_car_file = file.with_file_name("camera.json");
        if !side_car_file.is_file() {
            return Ok(None);
        }
        let side_car = sidecar::read(&side_car_file).map_err(Error::input)?;
        Ok((side_car["program"] == "etendue").then_some(side_car))
    }

    fn read_beside_image(file: &Path) -> Result<Self, Error> {
        let Some(side_car) = Self::read_json(file)? else { return Ok(Self::default()) };
        let sensor = &side_car["sensor"];
        Ok(Self {
            pixel_pitch_um: sensor["pixel_pitch_um"].as_f64(),
            bits: sensor["electronics"]["bits"].as_u64(),
            f_number: side_car["optics"]["f_number"].as_f64(),
        })
    }

    /// Exposure of a developed image, whose frame is listed with its raw file.
    fn exposure_s(file: &Path) -> Result<Option<f64>, Error> {
        let side_car = Self::read_json(file)?;
        Ok(side_car.and_then(|side_car| side_car["frames"][0]["exposure_s"].as_f64()))
    }
}

fn content_hash_of(photograph: &Photograph) -> Option<ContentHash> {
    let samples = || photograph.channels.iter().flat_map(|channel| &channel.samples);
    let differ = photograph.channels.iter().any(|c| c.samples.iter().any(|s| *s != c.samples[0]));
    let bytes = || samples().flat_map(|s| s.to_le_bytes()).collect::<Vec<u8>>();
    differ.then(|| hash_bytes(&bytes()))
}

/// By the stated level, or by pixels that share the frame's maximum.
fn saturated(photograph: &Photograph, white: Option<f64>) -> f64 {
    let samples = || photograph.channels.iter().filter(|c| c.name != "A").flat_map(|channel| &channel.samples);
    let count = samples().count() as f64;
    let fraction_above = |level: f64| samples().filter(|s| f64::from(**s) >= level).count() as f64 / count;
    match white.or(photograph.full_scale.filter(|full| fraction_above(*full) > 0.0)) {
        Some(level) => fraction_above(level),
        None => {
            let max_sample = samples().copied().fold(f32::NEG_INFINITY, f32::max);
            Some(fraction_above(f64::from(max_sample)))
                .filter(|fraction| *fraction > MIN_SATURATED_FRACTION)
                .unwrap_or(0.0)
        }
    }
}
