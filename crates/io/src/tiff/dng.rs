//! Digital Negative: a raw with what raw readers need.

use super::directory::{Directory, Value};
use super::{picture, sample_bytes};
use crate::exr::EncodeError;
use etendue_core::Plane;
use etendue_core::quantity::DigitalNumber;

/// What a DNG says beside its numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct DngFacts {
    /// The camera's name.
    pub camera: String,
    /// The writing program and its version.
    pub software: String,
    /// Bits of a number.
    pub bits: u32,
    /// Digital number of no charge.
    pub black_level_dn: f64,
    /// Digital number of a saturated pixel.
    pub white_level_dn: f64,
    /// Columns of the filter tile, and its colours row by row: 0 red, 1 green, 2 blue; `None` for a mono picture.
    pub tile: Option<(u16, Vec<u8>)>,
    /// From XYZ (relative to D65) to the camera's colours.
    pub xyz_to_camera: [[f64; 3]; 3],
    /// The camera's colours of neutral, largest 1.
    pub neutral: [f64; 3],
    /// The part that light reached: first column, first row, columns, rows.
    pub active: [u32; 4],
}

/// A DNG; a mono picture is stored as linear grey.
pub fn encode_dng(raw: &Plane<DigitalNumber>, facts: &DngFacts) -> Result<Vec<u8>, EncodeError> {
    const FILTER_ARRAY: u16 = 32_803;
    const LINEAR: u16 = 34_892;
    let mut directory = Directory::default();
    let photometric = if facts.tile.is_some() { FILTER_ARRAY } else { LINEAR };
    picture(&mut directory, raw, facts.bits, photometric)?;
    directory.set(271, Value::Text("Etendue".to_owned()));
    directory.set(272, Value::Text(ascii(&facts.camera)));
    directory.set(305, Value::Text(ascii(&facts.software)));
    directory.set(50_706, Value::Byte(vec![1, 4, 0, 0])); // version
    directory.set(50_707, Value::Byte(vec![1, 1, 0, 0])); // oldest version that reads it
    directory.set(50_708, Value::Text(format!("Etendue {}", ascii(&facts.camera))));
    let [x, y, width, height] = facts.active;
    directory.set(50_829, Value::Long(vec![y, x, y + height, x + width]));
    directory.set(50_713, Value::Short(vec![1, 1])); // one black level for all
    directory.set(50_714, Value::Rational(vec![rational(facts.black_level_dn)]));
    directory.set(50_717, Value::Long(vec![facts.white_level_dn.floor() as u32]));
    if let Some((columns, colours)) = &facts.tile {
        colour(&mut directory, *columns, colours, facts);
    }
    Ok(directory.file(&sample_bytes(raw, facts.bits)))
}

fn colour(directory: &mut Directory, columns: u16, colours: &[u8], facts: &DngFacts) {
    const D65: u16 = 21;
    let rows = (colours.len() / usize::from(columns)) as u16;
    directory.set(33_421, Value::Short(vec![rows, columns]));
    directory.set(33_422, Value::Byte(colours.to_vec()));
    directory.set(50_710, Value::Byte(vec![0, 1, 2])); // planes are red, green, blue
    directory.set(50_711, Value::Short(vec![1])); // a rectangular layout
    let matrix = facts.xyz_to_camera.as_flattened().iter().map(|v| signed_rational(*v));
    directory.set(50_721, Value::SignedRational(matrix.collect()));
    directory.set(50_728, Value::Rational(facts.neutral.iter().map(|v| rational(*v)).collect()));
    directory.set(50_778, Value::Short(vec![D65]));
}

/// DNG texts are ASCII.
fn ascii(text: &str) -> String {
    text.chars().map(|c| if c.is_ascii() && !c.is_ascii_control() { c } else { '_' }).collect()
}

/// To four decimals; to two where four of a level of 20 bits and more have no room.
fn rational(v: f64) -> (u32, u32) {
    let denominator = if v < 400_000.0 { 10_000 } else { 100 };
    ((v * f64::from(denominator)).round() as u32, denominator)
}

fn signed_rational(v: f64) -> (i32, i32) {
    ((v * 10_000.0).round() as i32, 10_000)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_of_all_bits_have_their_fraction() {
        for v in [0.0, 64.25, 399_999.5, 400_000.25, 16_777_214.5] {
            let (numerator, denominator) = rational(v);
            assert_eq!(f64::from(numerator) / f64::from(denominator), v);
        }
    }

    #[test]
    fn levels_filters_and_colours_are_in_the_file() {
        let raw = Plane::from_samples(2, 2, vec![64, 100, 100, 4095]).expect("four pixels");
        let facts = DngFacts {
            camera: "front é".into(),
            software: "etendue".into(),
            bits: 12,
            black_level_dn: 64.0,
            white_level_dn: 4000.5,
            tile: Some((2, vec![0, 1, 1, 2])),
            xyz_to_camera: [[0.8, -0.1, 0.0], [-0.5, 1.3, 0.2], [0.0, 0.1, 0.6]],
            neutral: [0.5, 1.0, 0.7],
            active: [0, 0, 2, 2],
        };
        let file = encode_dng(&raw, &facts).expect("a file");
        let has = |bytes: &[u8]| file.windows(bytes.len()).any(|w| w == bytes);
        // The entry of the white level: tag, long, one, 4000; of the tile: tag, bytes, four, RGGB.
        assert!(has(&[0x1d, 0xc6, 4, 0, 1, 0, 0, 0, 0xa0, 0x0f, 0, 0]));
        assert!(has(&[0x8e, 0x82, 1, 0, 4, 0, 0, 0, 0, 1, 1, 2]));
        assert!(has(b"Etendue front _\0"));
        let mono = DngFacts { tile: None, ..facts };
        assert!(encode_dng(&raw, &mono).expect("a file").len() < file.len());
    }
}
