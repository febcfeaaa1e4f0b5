//! Descriptor files of EMVA 1288 measurements, as the reference program reads them.
//!
//! One statement per line; `#` begins a comment line. Exposure times are in nanoseconds, light in photons per pixel; the decimal separator may be a comma. File
//! names are relative to the descriptor, with either slash.
//!
//! ```text
//! v 4.0                    version of the standard
//! n bits width height      of all images
//! b exposure photons       a level of light, its images follow
//! d exposure               a level without light, its images follow
//! i FILE                   an image
//! ```
//!
//! Two images form a level of the photon transfer curve; more form a stack for the fixed patterns. Unknown statements are refused. Not supported: masks and the
//! extra columns of other programs.

use std::path::{Path, PathBuf};

use crate::Error;
use crate::source::{decode_text, read_description_bytes};

/// Seconds in a nanosecond.
const NANOSECOND_S: f64 = 1e-9;

/// Images of one level.
#[derive(Clone, Debug, PartialEq)]
pub struct DescribedLevel {
    /// Exposure time, s.
    pub exposure_s: f64,
    /// Photons per pixel; 0 without light.
    pub photons: f64,
    /// The images, at least two.
    pub files: Vec<PathBuf>,
}

/// A descriptor file.
#[derive(Clone, Debug, PartialEq)]
pub struct EmvaDescriptor {
    /// Bits per pixel.
    pub bits: u32,
    /// Pixels per row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Levels in the file's order.
    pub levels: Vec<DescribedLevel>,
}

/// Reads a descriptor file; image paths are relative to its folder.
///
/// # Errors
/// If the file is missing, a line is not understood, or a level has fewer than two images.
pub fn read_emva_descriptor(file: &Path) -> Result<EmvaDescriptor, Error> {
    let bytes = read_description_bytes(file, "descriptor")?;
    let text = decode_text(file, &bytes)?;
    parse_emva_descriptor(text, file)
}

/// Parses a descriptor; `file` names it in messages.
///
/// # Errors
/// As [`read_emva_descriptor`].
pub fn parse_emva_descriptor(text: &str, file: &Path) -> Result<EmvaDescriptor, Error> {
    let (mut format, mut levels) = (None, Vec::<DescribedLevel>::new());
    let folder = file.parent().unwrap_or(Path::new(""));
    for (number, line) in (1..).zip(text.lines()) {
        let words: Vec<&str> = line.split_whitespace().collect();
        let wrong = |expected: &str| Error::new(file, format!("line {number}: expected {expected}, not '{line}'"));
        match words[..] {
            [] => {}
            [word, ..] if word.starts_with('#') => {}
            ["v", _] => {}
            ["n", bits, width, height] => {
                let positive = |word: &str| word.parse::<u32>().ok().filter(|n| *n > 0);
                let all = positive(bits).zip(positive(width)).zip(positive(height));
                let ((bits, width), height) = all.ok_or_else(|| wrong("n BITS WIDTH HEIGHT, whole numbers"))?;
                if format.replace((bits, width as usize, height as usize)).is_some() {
                    return Err(wrong("only one line 'n BITS WIDTH HEIGHT'"));
                }
            }
            ["b", exposure, photons] => {
                let both = number_of(exposure).zip(number_of(photons)).filter(|(e, p)| *e >= 0.0 && *p > 0.0);
                let (exposure, photons) = both.ok_or_else(|| wrong("b EXPOSURE_NS PHOTONS, photons above zero"))?;
                levels.push(DescribedLevel { exposure_s: exposure * NANOSECOND_S, photons, files: Vec::new() });
            }
            ["d", exposure] => {
                let exposure = number_of(exposure).filter(|e| *e >= 0.0).ok_or_else(|| wrong("d EXPOSURE_NS"))?;
                levels.push(DescribedLevel { exposure_s: exposure * NANOSECOND_S, photons: 0.0, files: Vec::new() });
            }
            ["i", ..] => {
                let name = line.trim_start().trim_start_matches('i').trim();
                let level = levels.last_mut().filter(|_| !name.is_empty());
                let level = level.ok_or_else(|| wrong("i FILE, after a line 'b' or 'd'"))?;
                level.files.push(folder.join(name.replace('\\', "/")));
            }
            _ => return Err(wrong("a line that begins with v, n, b, d or i")),
        }
    }
    let (bits, width, height) =
        format.ok_or_else(|| Error::new(file, "the line 'n BITS WIDTH HEIGHT' is missing: add it"))?;
    if let Some(level) = levels.iter().find(|l| l.files.len() < 2) {
        let nanoseconds = level.exposure_s / NANOSECOND_S;
        let message = format!(
            "the level of {nanoseconds} ns and {} photons has {} image(s); expected two or more",
            level.photons,
            level.files.len()
        );
        return Err(Error::new(file, message));
    }
    Ok(EmvaDescriptor { bits, width, height, levels })
}

fn number_of(word: &str) -> Option<f64> {
    word.replace(',', ".").parse::<f64>().ok().filter(|x| x.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "v 4.0\n# light\nn 12 64 48\nb 1000000,0 250.5\ni images\\a 1.png\ni images/b.png\n\
                        d 1000000.0\ni c.png\ni d.png\ni e.png\n";

    fn parsed(text: &str) -> Result<EmvaDescriptor, Error> {
        parse_emva_descriptor(text, Path::new("stack/list.txt"))
    }

    #[test]
    fn levels_have_times_photons_and_pictures() {
        let descriptor = parsed(TEXT).expect("a descriptor");
        assert_eq!((descriptor.bits, descriptor.width, descriptor.height), (12, 64, 48));
        let [bright, dark] = &descriptor.levels[..] else { panic!("{descriptor:?}") };
        assert_eq!((bright.exposure_s, bright.photons), (1e-3, 250.5));
        assert_eq!(bright.files, [PathBuf::from("stack/images/a 1.png"), PathBuf::from("stack/images/b.png")]);
        assert_eq!((dark.photons, dark.files.len()), (0.0, 3));
    }

    #[test]
    fn what_is_not_understood_is_refused_with_its_line() {
        for (from, to, place) in [
            ("n 12 64 48", "n 12 64", "line 3"),
            ("n 12 64 48\n", "", "is missing"),
            ("i c.png\ni d.png\ni e.png\n", "i c.png\n", "1 image(s)"),
            ("250.5", "-1", "line 4"),
            ("d 1000000.0", "x 1", "line 7"),
            ("v 4.0", "i early.png", "line 1"),
        ] {
            let error = parsed(&TEXT.replace(from, to)).expect_err(place).to_string();
            assert!(error.contains(place), "{error}");
        }
    }
}
