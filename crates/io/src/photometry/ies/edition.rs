//! The edition of the standard that a file names in its line of identification.
//!
//! The standard specifies `IESNA91`, `IESNA:LM-63-1995`, `IESNA:LM-63-2002` and `IES:LM-63-2019` as the first line. Files also spell it with blanks, other
//! capitals, another society or a two-digit year, or below other lines. Only letters and digits are compared, in any line before TILT; a spelling other than
//! the standard's is noted. The edition matters because the number after the ballast factor is a factor up to 1995 and none from 2002 on: a line without a year
//! is refused if that number would change the light.

use std::path::Path;

use crate::Error;

/// Editions of the standard.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Edition {
    Of1986,
    Of1991,
    Of1995,
    Of2002,
    Of2019,
}

impl Edition {
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Of1986 => "edition of 1986, or none stated",
            Self::Of1991 => "edition of 1991",
            Self::Of1995 => "edition of 1995",
            Self::Of2002 => "edition of 2002",
            Self::Of2019 => "edition of 2019",
        }
    }

    /// Edition in force in a year.
    fn in_force(year: u32) -> Self {
        match year {
            ..=1990 => Self::Of1986,
            1991..=1994 => Self::Of1991,
            1995..=2001 => Self::Of1995,
            2002..=2018 => Self::Of2002,
            _ => Self::Of2019,
        }
    }
}

/// Edition statement of a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Identification {
    /// None, as in files of 1986.
    None,
    /// Line in the standard's spelling.
    Standard(Edition),
    /// Line in another spelling, or not the first line.
    Otherwise { text: String, line: usize, edition: Edition },
    /// Line without a year.
    WithoutYear { text: String, line: usize },
}

impl Identification {
    /// Parses a line of identification; `None` for other lines.
    pub(super) fn read(text: &str, line: usize) -> Option<Self> {
        let text = text.trim();
        let known = match text {
            "IESNA91" | "IESNA:LM-63-1991" => Some(Edition::Of1991),
            "IESNA86" | "IESNA:LM-63-1986" => Some(Edition::Of1986),
            "IESNA:LM-63-1995" => Some(Edition::Of1995),
            "IESNA:LM-63-2002" => Some(Edition::Of2002),
            "IES:LM-63-2019" => Some(Edition::Of2019),
            _ => None,
        };
        if let Some(edition) = known.filter(|_| line == 1) {
            return Some(Self::Standard(edition));
        }
        let plain: String = text.chars().filter(char::is_ascii_alphanumeric).collect::<String>().to_ascii_uppercase();
        let plain = plain.strip_prefix("ANSI").unwrap_or(&plain);
        let after = plain.strip_prefix("IESNA").or_else(|| plain.strip_prefix("IES"));
        let (after, standard) = match after {
            Some(after) => after.strip_prefix("LM63").map_or((after, false), |year| (year, true)),
            None => (plain.strip_prefix("LM63")?, true),
        };
        let text = text.to_owned();
        match year(after) {
            Some(year) => Some(Self::Otherwise { text, line, edition: Edition::in_force(year) }),
            None if standard => Some(Self::WithoutYear { text, line }),
            None => None,
        }
    }

    /// Edition, for a number after the ballast factor.
    pub(super) fn edition(&self, file: &Path, further: f64) -> Result<Edition, Error> {
        match self {
            Self::None => Ok(Edition::Of1986),
            Self::Standard(edition) | Self::Otherwise { edition, .. } => Ok(*edition),
            Self::WithoutYear { .. } if further == 1.0 => Ok(Edition::Of2002),
            Self::WithoutYear { text, line } => Err(Error::at(
                file,
                *line,
                format!(
                    "`{text}` states no edition, and the number {further} after the ballast factor is a factor in editions up to 1995, but not from \
                     2002 on; write IESNA:LM-63-1995, IESNA:LM-63-2002 or IES:LM-63-2019"
                ),
            )),
        }
    }

    /// Note on the spelling.
    pub(super) fn note(&self) -> Option<String> {
        match self {
            Self::None | Self::Standard(_) => None,
            Self::Otherwise { text, line, edition } => Some(format!(
                "line {line}, `{text}`, is not the standard's identification in the first line; read as the {}",
                edition.name()
            )),
            Self::WithoutYear { text, line } => Some(format!("line {line}, `{text}`, states no edition")),
        }
    }
}

/// Year of four digits, or of two from 1986 on; letters may follow.
fn year(text: &str) -> Option<u32> {
    let digits: &str = &text[..text.bytes().take_while(u8::is_ascii_digit).count()];
    let number = digits.parse::<u32>().ok()?;
    match digits.len() {
        4 => (1986..=2100).contains(&number).then_some(number),
        2 if number >= 86 => Some(1900 + number),
        2 => Some(2000 + number),
        _ => None,
    }
}
