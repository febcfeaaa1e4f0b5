//! EXIF data of an image: camera, exposure, aperture, colour filters, levels.
//!
//! Read from the APP1 segment of JPEG, the eXIf chunk of PNG, and the directories of TIFF and DNG themselves (Exif 2.32, CIPA DC-008; TIFF/EP, ISO 12234-2;
//! Digital Negative 1.4, Adobe 2012). Only the first directory and the Exif directory that it names are read. Numbers beyond the end of the file, or of a type
//! that the tag does not allow, count as not stated. Not supported: maker notes, BigTIFF, directories of further images.

use std::path::Path;

use crate::{Error, png, source::read_bytes};

/// Stated data; `None` if not stated.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Exif {
    /// Camera maker.
    pub make: Option<String>,
    /// Camera model.
    pub model: Option<String>,
    /// Serial number of the body.
    pub serial: Option<String>,
    /// Exposure time, s.
    pub exposure_s: Option<f64>,
    /// The f-number.
    pub f_number: Option<f64>,
    /// Sensitivity: ISO speed.
    pub iso: Option<f64>,
    /// Columns of the colour filter tile, and its letters R, G, B row by row.
    pub filters: Option<(usize, String)>,
    /// Saturation level, DN.
    pub white_level_dn: Option<f64>,
}

/// EXIF data of an image file; `None` if it has none.
///
/// # Errors
/// If the file cannot be read.
pub fn read_exif(file: &Path) -> Result<Option<Exif>, Error> {
    Ok(exif_of(&read_bytes(file, "image")?))
}

/// EXIF data in the bytes of an image file.
#[must_use]
pub fn exif_of(bytes: &[u8]) -> Option<Exif> {
    let data = match bytes {
        [0xff, 0xd8, ..] => from_jpeg(bytes)?,
        [0x89, b'P', b'N', b'G', ..] => png::exif(bytes)?,
        _ => bytes,
    };
    Tiff::new(data).map(Tiff::exif)
}

/// TIFF data in the APP1 segment.
fn from_jpeg(bytes: &[u8]) -> Option<&[u8]> {
    const APP1: u8 = 0xe1;
    const SCAN: u8 = 0xda;
    let mut rest = bytes.get(2..)?;
    loop {
        let [0xff, marker, high, low, ..] = rest else { return None };
        let length = usize::from(u16::from_be_bytes([*high, *low]));
        let data = rest.get(4..2 + length)?;
        match (*marker, data.strip_prefix(b"Exif\0\0")) {
            (SCAN, _) => return None,
            (APP1, Some(tiff)) => return Some(tiff),
            _ => rest = rest.get(2 + length..)?,
        }
    }
}

/// Bytes of a plain TIFF.
#[derive(Clone, Copy)]
struct Tiff<'a> {
    bytes: &'a [u8],
    big: bool,
}

/// Entry of a directory: type, and bytes of the value.
struct Entry<'a> {
    kind: u16,
    data: &'a [u8],
}

impl<'a> Tiff<'a> {
    fn new(bytes: &'a [u8]) -> Option<Self> {
        match bytes {
            [b'I', b'I', 42, 0, ..] => Some(Self { bytes, big: false }),
            [b'M', b'M', 0, 42, ..] => Some(Self { bytes, big: true }),
            _ => None,
        }
    }

    fn short(self, at: usize) -> Option<u16> {
        let two: [u8; 2] = self.bytes.get(at..at.checked_add(2)?)?.try_into().ok()?;
        Some(if self.big { u16::from_be_bytes(two) } else { u16::from_le_bytes(two) })
    }

    fn long(self, at: usize) -> Option<u32> {
        let four: [u8; 4] = self.bytes.get(at..at.checked_add(4)?)?.try_into().ok()?;
        Some(if self.big { u32::from_be_bytes(four) } else { u32::from_le_bytes(four) })
    }

    fn entry(self, directory: usize, tag: u16) -> Option<Entry<'a>> {
        const ENTRY: usize = 12;
        let entries = usize::from(self.short(directory)?);
        let at = (0..entries).map(|i| directory + 2 + ENTRY * i).find(|at| self.short(*at) == Some(tag))?;
        let kind = self.short(at + 2)?;
        let size = match kind {
            1 | 2 | 6 | 7 => 1,
            3 | 8 => 2,
            4 | 9 | 11 => 4,
            5 | 10 | 12 => 8,
            _ => return None,
        };
        let length = usize::try_from(self.long(at + 4)?).ok()?.checked_mul(size)?;
        let start = if length <= 4 { at + 8 } else { self.long(at + 8)? as usize };
        Some(Entry { kind, data: self.bytes.get(start..start.checked_add(length)?)? })
    }

    fn text(self, directory: usize, tag: u16) -> Option<String> {
        let entry = self.entry(directory, tag).filter(|entry| entry.kind == 2)?;
        let text = String::from_utf8_lossy(entry.data);
        let text: String = text.trim_end_matches('\0').trim().chars().filter(|c| !c.is_control()).collect();
        (!text.is_empty()).then_some(text)
    }

    /// First number of an entry.
    fn number(self, directory: usize, tag: u16) -> Option<f64> {
        let entry = self.entry(directory, tag)?;
        let value = Self { bytes: entry.data, ..self };
        let number = match entry.kind {
            1 => f64::from(*entry.data.first()?),
            3 => f64::from(value.short(0)?),
            4 => f64::from(value.long(0)?),
            5 => f64::from(value.long(0)?) / f64::from(value.long(4)?),
            _ => return None,
        };
        number.is_finite().then_some(number)
    }

    fn exif(self) -> Exif {
        const EXIF: u16 = 34_665;
        let first = self.long(4).map_or(0, |at| at as usize);
        // A file without an Exif directory may have the entries in the first directory (TIFF/EP).
        let further = self.number(first, EXIF).map_or(first, |at| at as usize);
        let number = |tag: u16| self.number(further, tag).or_else(|| self.number(first, tag));
        let above_zero = |tag: u16| number(tag).filter(|n| *n > 0.0);
        Exif {
            make: self.text(first, 271),
            model: self.text(first, 272),
            serial: self.text(further, 42_033).or_else(|| self.text(first, 50_735)),
            exposure_s: above_zero(33_434),
            f_number: above_zero(33_437),
            iso: above_zero(34_855),
            filters: self.filters(first),
            white_level_dn: above_zero(50_717),
        }
    }

    /// Colour filter tile of TIFF/EP.
    fn filters(self, directory: usize) -> Option<(usize, String)> {
        let columns = self.entry(directory, 33_421).filter(|e| e.kind == 3 && e.data.len() == 4)?;
        let columns = usize::from(Self { bytes: columns.data, ..self }.short(2)?);
        let tile = self.entry(directory, 33_422)?.data;
        let letters: String =
            tile.iter().map(|c| Some(*b"RGB".get(usize::from(*c))? as char)).collect::<Option<_>>()?;
        (columns > 0 && !letters.is_empty() && letters.len().is_multiple_of(columns)).then_some((columns, letters))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Directory with a model, and Exif directory with an exposure of 1/250 s, in either byte order.
    fn tiff(big: bool) -> Vec<u8> {
        let short = |v: u16| if big { v.to_be_bytes() } else { v.to_le_bytes() }.to_vec();
        let long = |v: u32| if big { v.to_be_bytes() } else { v.to_le_bytes() }.to_vec();
        let entry =
            |tag: u16, kind: u16, count: u32, value: Vec<u8>| [short(tag), short(kind), long(count), value].concat();
        let head = if big { b"MM\0\x2a".to_vec() } else { b"II\x2a\0".to_vec() };
        [
            head,
            long(8),
            short(2),
            entry(272, 2, 3, b"X1\0\0".to_vec()),
            entry(34_665, 4, 1, long(38)),
            long(0),
            short(1),
            entry(33_434, 5, 1, long(56)),
            long(0),
            long(1),
            long(250),
        ]
        .concat()
    }

    #[test]
    fn exposures_are_read_from_every_kind_of_file() {
        for big in [false, true] {
            let plain = tiff(big);
            let jpeg =
                [&b"\xff\xd8\xff\xe1"[..], &(8 + plain.len() as u16).to_be_bytes(), b"Exif\0\0", &plain].concat();
            let length = (plain.len() as u32).to_be_bytes();
            let png = [&b"\x89PNG\r\n\x1a\n"[..], &length, b"eXIf", &plain, &[0; 4]].concat();
            for file in [&plain, &jpeg, &png] {
                let exif = exif_of(file).expect("data");
                assert_eq!((exif.model.as_deref(), exif.exposure_s), (Some("X1"), Some(0.004)));
                assert_eq!((exif.make, exif.iso), (None, None));
            }
        }
    }

    #[test]
    fn cut_files_state_less_and_do_not_fail() {
        let complete = tiff(true);
        for length in 0..complete.len() {
            assert!(exif_of(&complete[..length]).is_none_or(|exif| exif.exposure_s.is_none()), "{length}");
        }
        assert_eq!(exif_of(b"\xff\xd8\xff\xda\0\x02"), None);
        assert_eq!(exif_of(b"no picture"), None);
    }
}
