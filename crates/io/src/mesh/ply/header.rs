//! Header of a file: encoding, elements and properties.

use std::borrow::Cow;

/// Maximum length of a header, bytes.
const MAX_HEAD: usize = 1 << 16;

/// Encoding of numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum PlyEncoding {
    Text,
    Little,
    Big,
}

/// Type of a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum PlyNumber {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

/// Property of an element.
#[derive(Clone, Debug)]
pub(super) struct PlyProperty {
    pub(super) name: String,
    /// Type of its number, or of each of its numbers.
    pub(super) number: PlyNumber,
    /// Type of the count of a list; `None` for a single number.
    pub(super) count: Option<PlyNumber>,
}

/// Table: a number of rows with these properties.
#[derive(Clone, Debug)]
pub(super) struct PlyElement {
    pub(super) name: String,
    pub(super) count: usize,
    pub(super) properties: Vec<PlyProperty>,
}

/// Parsed header.
#[derive(Clone, Debug)]
pub(super) struct PlyHeader {
    pub(super) encoding: PlyEncoding,
    /// Elements in the order of the file.
    pub(super) elements: Vec<PlyElement>,
    /// Image that a comment of MeshLab names; `None` without one.
    pub(super) texture_file: Option<String>,
    /// Lines that are no statement, with their first words.
    pub(super) unknown: Vec<(usize, String)>,
    /// Bytes before the first row.
    pub(super) length: usize,
    /// Lines before the first row.
    pub(super) lines: usize,
}

/// Error with its line, counted from 1.
type HeaderError = (usize, String);

impl PlyNumber {
    fn from_word(word: &str) -> Option<Self> {
        Some(match word {
            "char" | "int8" => Self::I8,
            "uchar" | "uint8" => Self::U8,
            "short" | "int16" => Self::I16,
            "ushort" | "uint16" => Self::U16,
            "int" | "int32" => Self::I32,
            "uint" | "uint32" => Self::U32,
            "float" | "float32" => Self::F32,
            "double" | "float64" => Self::F64,
            _ => return None,
        })
    }

    /// Length in a binary file, bytes.
    pub(super) fn bytes(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }

    pub(super) fn is_integer(self) -> bool {
        !matches!(self, Self::F32 | Self::F64)
    }
}

impl PlyHeader {
    pub(super) fn read(bytes: &[u8]) -> Result<Self, HeaderError> {
        let mut lines = Lines::new(bytes)?;
        let encoding = lines.encoding()?;
        let mut header =
            Self { encoding, elements: Vec::new(), texture_file: None, unknown: Vec::new(), length: 0, lines: 0 };
        loop {
            let (number, line) = lines.next()?;
            let located = |what: String| (number, what);
            let mut words = line.split_whitespace();
            match words.next() {
                Some("end_header") => break,
                Some("element") => header.element(words.collect()).map_err(located)?,
                Some("property") => header.property(words.collect()).map_err(located)?,
                Some("comment") => header.comment(&line),
                Some("obj_info") | None => {}
                Some(other) => header.unknown.push((number, shortened(other))),
            }
        }
        (header.length, header.lines) = (lines.at, lines.number);
        Ok(header)
    }

    /// Element of this name.
    pub(super) fn find(&self, name: &str) -> Option<&PlyElement> {
        self.elements.iter().find(|e| e.name == name)
    }

    fn element(&mut self, words: Vec<&str>) -> Result<(), String> {
        let [name, count] = words[..] else {
            return Err("expected `element NAME COUNT`".to_owned());
        };
        let count = count.parse().map_err(|_| {
            format!("the element count is `{}`; expected a whole number of 0 or more", shortened(count))
        })?;
        if self.find(name).is_some() {
            return Err(format!("the element `{}` is declared twice; export the mesh again", shortened(name)));
        }
        self.elements.push(PlyElement { name: name.to_owned(), count, properties: Vec::new() });
        Ok(())
    }

    fn property(&mut self, words: Vec<&str>) -> Result<(), String> {
        const TYPES: &str = "char, uchar, short, ushort, int, uint, float, double, or int8 … float64";
        let number = |word: &str| {
            PlyNumber::from_word(word).ok_or_else(|| format!("unknown type `{}`; expected {TYPES}", shortened(word)))
        };
        let property = match words[..] {
            ["list", count, item, name] => {
                let count = number(count)?;
                if !count.is_integer() {
                    return Err(
                        "the count type of a list is not an integer type; expected a type such as uchar".to_owned()
                    );
                }
                PlyProperty { name: name.to_owned(), number: number(item)?, count: Some(count) }
            }
            [item, name] => PlyProperty { name: name.to_owned(), number: number(item)?, count: None },
            _ => return Err("expected `property TYPE NAME` or `property list TYPE TYPE NAME`".to_owned()),
        };
        let element = self.elements.last_mut().ok_or("a property precedes the first element")?;
        if element.properties.iter().any(|p| p.name == property.name) {
            return Err(format!("the property `{}` is declared twice in one element", shortened(&property.name)));
        }
        element.properties.push(property);
        Ok(())
    }

    fn comment(&mut self, line: &str) {
        let rest = line.trim_start().strip_prefix("comment").unwrap_or_default().trim();
        if let Some(image) = rest.strip_prefix("TextureFile") {
            self.texture_file = Some(image.trim().to_owned());
        }
    }
}

/// Word of a file, shortened for a message.
pub(super) fn shortened(word: &str) -> String {
    const MAX: usize = 40;
    match word.char_indices().nth(MAX) {
        Some((end, _)) => format!("{} …", &word[..end]),
        None => word.to_owned(),
    }
}

/// Lines of the header, which end with LF, CR LF or CR.
struct Lines<'a> {
    bytes: &'a [u8],
    end: &'static [u8],
    at: usize,
    number: usize,
}

impl<'a> Lines<'a> {
    fn new(bytes: &'a [u8]) -> Result<Self, HeaderError> {
        let no_ply = || (1, "not a PLY file: the first line is not `ply`".to_owned());
        let rest = bytes.strip_prefix(b"ply").ok_or_else(no_ply)?;
        let blanks = rest.iter().take_while(|b| matches!(b, b' ' | b'\t')).count();
        let end: &[u8] = match &rest[blanks..] {
            [b'\r', b'\n', ..] => b"\r\n",
            [b'\r', ..] => b"\r",
            [b'\n', ..] => b"\n",
            _ => return Err(no_ply()),
        };
        Ok(Self { bytes: &bytes[..bytes.len().min(MAX_HEAD)], end, at: 3 + blanks + end.len(), number: 1 })
    }

    /// Next line; one that is not UTF-8, as comments may be, is read byte by byte.
    fn next(&mut self) -> Result<(usize, Cow<'a, str>), HeaderError> {
        self.number += 1;
        let rest = &self.bytes[self.at..];
        let length = rest.windows(self.end.len()).position(|w| w == self.end).ok_or_else(|| {
            (
                self.number,
                format!("the header has no `end_header` within {} bytes: the file may be truncated", self.bytes.len()),
            )
        })?;
        self.at += length + self.end.len();
        let line = match std::str::from_utf8(&rest[..length]) {
            Ok(line) => Cow::Borrowed(line),
            Err(_) => Cow::Owned(rest[..length].iter().map(|byte| char::from(*byte)).collect()),
        };
        Ok((self.number, line))
    }

    fn encoding(&mut self) -> Result<PlyEncoding, HeaderError> {
        let (number, line) = self.next()?;
        let words: Vec<&str> = line.split_whitespace().collect();
        match words[..] {
            ["format", "ascii", "1.0"] => Ok(PlyEncoding::Text),
            ["format", "binary_little_endian", "1.0"] => Ok(PlyEncoding::Little),
            ["format", "binary_big_endian", "1.0"] => Ok(PlyEncoding::Big),
            _ => Err((
                number,
                format!(
                    "found `{}`; expected `format ascii 1.0`, `format binary_little_endian 1.0` or `format binary_big_endian 1.0`",
                    shortened(&line)
                ),
            )),
        }
    }
}
