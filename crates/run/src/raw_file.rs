//! A raw read back, with what its side-car says of it; refused where the camera file says otherwise.

use etendue_core::Plane;
use etendue_core::quantity::DigitalNumber;
use etendue_io::photograph::{FilterTile, Photograph, RawFacts, RawFrame, read_photograph};
use etendue_pipeline::plan::CameraBody;
use etendue_sensor::layout::Region;
use etendue_sensor::{FrameAddress, OperatingPoint, Raw, Sensor};
use std::path::Path;
use std::str::FromStr;

/// Black and white level of a raw without a side-car, DN.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Levels {
    /// Digital number of no light.
    pub black_dn: f64,
    /// Digital number of a saturated pixel.
    pub white_dn: f64,
}

/// `BLACK..WHITE`.
impl FromStr for Levels {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let expected = || format!("expected BLACK..WHITE with BLACK < WHITE, e.g. 64..4095, not '{text}'");
        let (black, white) = text.split_once("..").ok_or_else(expected)?;
        let number = |s: &str| s.trim().parse::<f64>().map_err(|_| expected());
        let (black_dn, white_dn) = (number(black)?, number(white)?);
        let legal = black_dn >= 0.0 && black_dn < white_dn && white_dn.is_finite();
        legal.then_some(Self { black_dn, white_dn }).ok_or_else(expected)
    }
}

/// A frame that was taken before.
#[derive(Clone, Debug)]
pub(crate) struct Taken {
    /// Its numbers and what is known of them.
    pub(crate) raw: Raw,
    /// Where it stands.
    pub(crate) address: FrameAddress,
    /// Pixels whose errors may be equal.
    pub(crate) correlated_block_px: u32,
}

/// Reads a raw of a camera. Without a side-car `levels` are needed, and the raw is frame `number`.
pub(crate) fn taken(
    file: &Path,
    levels: Option<Levels>,
    number: u32,
    body: &CameraBody,
    sensor: &Sensor,
) -> Result<Taken, String> {
    let photograph = read_photograph(file).map_err(|error| error.to_string())?;
    let found = match (&photograph.raw, levels) {
        (None, Some(levels)) => by_levels(&photograph, levels, number, sensor),
        (Some(_), Some(_)) => Err("camera.json beside it states its levels: leave `levels` out".to_owned()),
        (Some(facts), None) => by_side_car(&photograph, facts, sensor),
        (None, None) => {
            Err("no camera.json beside it lists it as raw, and nothing states its levels: put the side-car \
                             beside it, or give `levels` BLACK..WHITE"
                .to_owned())
        }
    };
    found.and_then(|taken| fitting(taken, body, sensor)).map_err(|why| format!("{}: {why}", file.display()))
}

fn by_levels(photograph: &Photograph, levels: Levels, number: u32, sensor: &Sensor) -> Result<Taken, String> {
    if sensor.parameters().hdr.companding.is_some() {
        return Err(
            "the camera's numbers are companded, and `levels` are those of numbers that are not: a raw of this \
                    camera needs its side-car"
                .to_owned(),
        );
    }
    let p = sensor.parameters();
    let point = OperatingPoint { exposure_s: p.exposure.exposure_s, analogue_gain: p.read_out.analogue_gain };
    let whole = [0, 0, photograph.width, photograph.height];
    let raw = raw(numbers(photograph)?, [levels.black_dn, levels.white_dn], whole, point, sensor);
    Ok(Taken {
        raw,
        address: FrameAddress { seed: 0, camera: 0, frame: number, capture: 0 },
        correlated_block_px: photograph.correlated_block_px,
    })
}

fn by_side_car(photograph: &Photograph, facts: &RawFacts, sensor: &Sensor) -> Result<Taken, String> {
    let former = "camera.json beside it is of a former version and does not say which frame this is: render again";
    let frame = facts.frame.as_ref().ok_or(former)?;
    same_filters(&facts.filters, sensor)?;
    same_companding(frame, sensor)?;
    let plane = numbers(photograph)?;
    if let Some(dn) = plane.samples().iter().find(|dn| u64::from(**dn) >> frame.bits.min(63) != 0) {
        return Err(format!("it holds the number {dn}, beyond the {} bits that camera.json states", frame.bits));
    }
    let point = OperatingPoint { exposure_s: facts.exposure_s, analogue_gain: 1.0 };
    let raw = raw(plane, [facts.black_level_dn, facts.white_level_dn], frame.picture_px, point, sensor);
    let RawFrame { seed, camera_index: camera, number: frame, .. } = *frame;
    Ok(Taken {
        raw,
        address: FrameAddress { seed, camera, frame, capture: 0 },
        correlated_block_px: photograph.correlated_block_px,
    })
}

fn raw(
    plane: Plane<DigitalNumber>,
    [black_level_dn, white_level_dn]: [f64; 2],
    [x, y, width, height]: [usize; 4],
    operating_point: OperatingPoint,
    sensor: &Sensor,
) -> Raw {
    Raw {
        plane,
        black_level_dn,
        white_level_dn,
        bits: sensor.delivered_bits(),
        companding: sensor.parameters().hdr.companding.clone(),
        picture: Region { x, y, width, height },
        operating_point,
        accounts: Vec::new(),
        invalid: Vec::new(),
    }
}

/// The stored numbers of a grey picture.
fn numbers(photograph: &Photograph) -> Result<Plane<DigitalNumber>, String> {
    let ([channel], Some(_)) = (&photograph.channels[..], photograph.full_scale) else {
        let names = photograph.names().join(", ");
        return Err(format!("a raw is a grey picture of whole numbers (PNG, TIFF, DNG); this one has {names}"));
    };
    // Floats hold whole numbers exactly up to here.
    const LARGEST: f32 = 16_777_215.0;
    if let Some(beyond) = channel.samples.iter().find(|v| **v > LARGEST) {
        return Err(format!("it holds the number {beyond}, beyond the 24 bits of raws"));
    }
    let samples = channel.samples.iter().map(|v| *v as u32).collect();
    Ok(Plane::from_samples(photograph.width, photograph.height, samples).expect("as many samples as pixels"))
}

fn same_filters(stated: &FilterTile, sensor: &Sensor) -> Result<(), String> {
    let p = sensor.parameters();
    let names = p.cfa.channels().iter().map(|channel| p.channels[*channel].name.clone());
    let own = FilterTile { columns: p.cfa.width(), channels: names.collect() };
    let words = |tile: &FilterTile| format!("{} in {} columns", tile.channels.join(" "), tile.columns);
    if own == *stated {
        return Ok(());
    }
    let (stated, own) = (words(stated), words(&own));
    Err(format!(
        "its filters are {stated}, says camera.json, and the camera file's are {own}: give the camera that took it"
    ))
}

fn same_companding(frame: &RawFrame, sensor: &Sensor) -> Result<(), String> {
    let own = sensor.parameters().hdr.companding.as_ref().map(|companding| &companding.knees);
    if own == frame.companding_knees_dn.as_ref() && frame.bits == sensor.delivered_bits() {
        return Ok(());
    }
    Err("bits or companding differ between camera.json beside it and the camera file: give the camera that took it"
        .to_owned())
}

/// Refuses a raw that is no picture of the camera's size.
fn fitting(taken: Taken, body: &CameraBody, sensor: &Sensor) -> Result<Taken, String> {
    let (Region { x, y, width, height }, plane) = (taken.raw.picture, &taken.raw.plane);
    let inside = |from: usize, length: usize, all: usize| from.checked_add(length).is_some_and(|end| end <= all);
    if !(inside(x, width, plane.width()) && inside(y, height, plane.height())) {
        return Err(format!(
            "camera.json beside it puts a picture of {width} × {height} pixels at column {x}, row {y}, and the raw has {} × {}",
            plane.width(),
            plane.height()
        ));
    }
    let own = sensor.picture_size(body.raster.width(), body.raster.height());
    if own != (width, height) {
        return Err(format!("its picture has {width} × {height} pixels, and the camera file's {} × {}", own.0, own.1));
    }
    Ok(taken)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_are_a_range() {
        let levels = |text: &str| text.parse::<Levels>();
        assert_eq!(levels("63.5..4095"), Ok(Levels { black_dn: 63.5, white_dn: 4095.0 }));
        assert!(["64", "5..5", "-1..5", "0..inf", "a..b"].iter().all(|text| levels(text).is_err()));
    }
}
