//! One image of a laboratory folder, and its properties before measurement.

use std::path::{Path, PathBuf};

use etendue_io::exif::{Exif, read_exif};
use etendue_io::hash::{ContentHash, of_bytes};
use etendue_io::photograph::{Photograph, RawFacts, read_photograph};
use etendue_io::{failure::Error, sidecar};
use serde_json::Value;

use super::parameter::Kind;

/// An image.
#[derive(Clone, Debug)]
pub(super) struct Shot {
    pub(super) kind: Kind,
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
    pub(super) side_car: SideCar,
    pub(super) exif: Exif,
    /// Exposure time, s.
    pub(super) exposure_s: Option<f64>,
    /// Hash of the numbers; `None` if all numbers of a channel are equal, as in black or saturated frames.
    pub(super) mark: Option<ContentHash>,
    /// Fraction of saturated pixels, 0 to 1.
    pub(super) saturated: f64,
}

/// Camera facts from a side-car of this program.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct SideCar {
    pub(super) pixel_pitch_um: Option<f64>,
    pub(super) bits: Option<u64>,
    pub(super) f_number: Option<f64>,
}

/// Pixels at a frame's maximum count as saturated if they are more than this fraction of it.
const CLIPPED: f64 = 0.01;

impl Shot {
    pub(super) fn read(kind: Kind, file: &Path, stated_exposure_s: Option<f64>) -> Result<Self, Error> {
        let photograph = read_photograph(file).map_err(Error::input)?;
        let exif = read_exif(file).map_err(Error::input)?.unwrap_or_default();
        let raw = photograph.raw.clone();
        let whole = [0, 0, photograph.width, photograph.height];
        let picture_px = raw.as_ref().and_then(|facts| Some(facts.frame.as_ref()?.picture_px)).unwrap_or(whole);
        let white = raw.as_ref().map(|facts| facts.white_level_dn).or(exif.white_level_dn);
        let side_car = SideCar::beside(file)?;
        let own_exposure_s =
            raw.as_ref().map(|facts| facts.exposure_s).or(SideCar::exposure_s(file)?).or(exif.exposure_s);
        Ok(Self {
            kind,
            file: file.to_path_buf(),
            size_px: [picture_px[2], picture_px[3]],
            picture_px,
            channels: photograph.channels.len(),
            full_scale: photograph.full_scale,
            exposure_s: stated_exposure_s.or(own_exposure_s),
            mark: mark(&photograph),
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

impl SideCar {
    fn said(file: &Path) -> Result<Option<Value>, Error> {
        let beside = file.with_file_name("camera.json");
        if !beside.is_file() {
            return Ok(None);
        }
        let said = sidecar::read(&beside).map_err(Error::input)?;
        Ok((said["program"] == "etendue").then_some(said))
    }

    fn beside(file: &Path) -> Result<Self, Error> {
        let Some(said) = Self::said(file)? else { return Ok(Self::default()) };
        let sensor = &said["sensor"];
        Ok(Self {
            pixel_pitch_um: sensor["pixel_pitch_um"].as_f64(),
            bits: sensor["electronics"]["bits"].as_u64(),
            f_number: said["optics"]["f_number"].as_f64(),
        })
    }

    /// Exposure of a developed image, whose frame is listed with its raw file.
    fn exposure_s(file: &Path) -> Result<Option<f64>, Error> {
        let said = Self::said(file)?;
        Ok(said.and_then(|said| said["frames"][0]["exposure_s"].as_f64()))
    }
}

fn mark(photograph: &Photograph) -> Option<ContentHash> {
    let samples = || photograph.channels.iter().flat_map(|channel| &channel.samples);
    let differ = photograph.channels.iter().any(|c| c.samples.iter().any(|s| *s != c.samples[0]));
    let bytes = || samples().flat_map(|s| s.to_le_bytes()).collect::<Vec<u8>>();
    differ.then(|| of_bytes(&bytes()))
}

/// By the stated level, or by pixels that share the frame's maximum.
fn saturated(photograph: &Photograph, white: Option<f64>) -> f64 {
    let samples = || photograph.channels.iter().filter(|c| c.name != "A").flat_map(|channel| &channel.samples);
    let count = samples().count() as f64;
    let beyond = |level: f64| samples().filter(|s| f64::from(**s) >= level).count() as f64 / count;
    match white.or(photograph.full_scale.filter(|full| beyond(*full) > 0.0)) {
        Some(level) => beyond(level),
        None => {
            let most = samples().copied().fold(f32::NEG_INFINITY, f32::max);
            Some(beyond(f64::from(most))).filter(|share| *share > CLIPPED).unwrap_or(0.0)
        }
    }
}
