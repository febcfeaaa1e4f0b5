//! Sequential reader of numbers, from text or bytes.

use super::header::{PlyElement, PlyEncoding, PlyHeader, PlyNumber, PlyProperty, shortened};
use crate::Problem;

/// Reading position.
#[derive(Clone, Debug)]
pub(super) struct PlyInput<'a> {
    bytes: &'a [u8],
    at: usize,
    encoding: PlyEncoding,
    /// Line of the last number, counted from 1; for text only.
    line: usize,
}

impl<'a> PlyInput<'a> {
    /// Starts at the first row of the first element.
    pub(super) fn new(header: &PlyHeader, bytes: &'a [u8]) -> Self {
        Self { bytes, at: header.length, encoding: header.encoding, line: header.lines + 1 }
    }

    /// Line of the last number; `None` for binary files.
    pub(super) fn line(&self) -> Option<usize> {
        (self.encoding == PlyEncoding::Text).then_some(self.line)
    }

    /// Refuses an element of more rows than the rest of the file can hold.
    pub(super) fn check_rows(&self, element: &PlyElement) -> Result<(), Problem> {
        let min = |p: &PlyProperty| match self.encoding {
            PlyEncoding::Text => 2, // a digit and a separator
            _ => p.count.unwrap_or(p.number).bytes(),
        };
        let row: usize = element.properties.iter().map(min).sum();
        // The last number may be ended by the end of the file.
        let rest = self.bytes.len() - self.at + usize::from(self.encoding == PlyEncoding::Text);
        match element.count.checked_mul(row) {
            Some(bytes) if bytes <= rest => Ok(()),
            _ => Err(format!(
                "the header states {} × element `{}`, for which the file is too short: it is truncated, or its header is wrong; export or copy it again",
                element.count,
                shortened(&element.name)
            ).into()),
        }
    }

    /// Reads the next number, which must be finite.
    pub(super) fn number(&mut self, number: PlyNumber) -> Result<f64, Problem> {
        let value = self.number_of_any_size(number)?;
        if value.is_finite() { Ok(value) } else { Err(self.not_finite()) }
    }

    /// Reads the next number, which may be infinite or NaN.
    pub(super) fn number_of_any_size(&mut self, number: PlyNumber) -> Result<f64, Problem> {
        Ok(match self.encoding {
            PlyEncoding::Text => self.word_number(number)?,
            PlyEncoding::Little => binary(number, self.take(number.bytes())?, |b| b),
            PlyEncoding::Big => binary(number, self.take(number.bytes())?, |mut b| {
                b[..number.bytes()].reverse();
                b
            }),
        })
    }

    /// Error of a number that is not finite.
    pub(super) fn not_finite(&self) -> Problem {
        let hint = if self.encoding == PlyEncoding::Text { "" } else { self.byte_order_hint() };
        format!("a number is not finite (NaN or infinity): correct the mesh in the modelling program{hint}").into()
    }

    /// Sets the line that an error names.
    pub(super) fn set_line(&mut self, line: usize) {
        self.line = line;
    }

    /// Reads the length of the next list, which must fit into the rest of the file.
    pub(super) fn list_length(&mut self, property: &PlyProperty) -> Result<usize, Problem> {
        let Some(count) = property.count else { return Ok(1) };
        let length = self.number(count)?;
        let min = if self.encoding == PlyEncoding::Text { 2 } else { property.number.bytes() };
        let rest = (self.bytes.len() - self.at) / min + 1;
        if length >= 0.0 && length <= rest as f64 {
            return Ok(length as usize);
        }
        Err(format!(
            "the list `{}` has {length} numbers, for which the file is too short: it is truncated{}",
            shortened(&property.name),
            self.byte_order_hint()
        )
        .into())
    }

    /// Skips a property.
    pub(super) fn skip(&mut self, property: &PlyProperty) -> Result<(), Problem> {
        let length = self.list_length(property)?;
        if self.encoding == PlyEncoding::Text {
            return (0..length).try_for_each(|_| self.word().map(|_| ()));
        }
        self.advance(length.saturating_mul(property.number.bytes()))
    }

    pub(super) fn skip_element(&mut self, element: &PlyElement) -> Result<(), Problem> {
        self.check_rows(element)?;
        let is_even = element.properties.iter().all(|p| p.count.is_none());
        if is_even && self.encoding != PlyEncoding::Text {
            let row: usize = element.properties.iter().map(|p| p.number.bytes()).sum();
            return self.advance(element.count.saturating_mul(row));
        }
        if element.properties.is_empty() {
            return Ok(());
        }
        (0..element.count).try_for_each(|_| element.properties.iter().try_for_each(|p| self.skip(p)))
    }

    /// Possible cause of an error in a binary file, as the end of a message.
    pub(super) fn byte_order_hint(&self) -> &'static str {
        match self.encoding {
            PlyEncoding::Text => "; export or copy it again",
            PlyEncoding::Little => {
                ", or its numbers are big-endian although the header states little-endian; export it again"
            }
            PlyEncoding::Big => {
                ", or its numbers are little-endian although the header states big-endian; export it again"
            }
        }
    }

    /// Sentence on numbers after the last element; `None` if the file ends there.
    pub(super) fn rest(&self) -> Option<String> {
        let rest = &self.bytes[self.at..];
        let is_end = match self.encoding {
            PlyEncoding::Text => rest.iter().all(u8::is_ascii_whitespace),
            _ => rest.is_empty() || rest == b"\n" || rest == b"\r\n",
        };
        let bytes = rest.len();
        (!is_end).then(|| format!("{bytes} bytes follow the last element: the header does not describe the whole file"))
    }

    fn advance(&mut self, bytes: usize) -> Result<(), Problem> {
        self.take(bytes).map(|_| ())
    }

    fn take(&mut self, bytes: usize) -> Result<&'a [u8], Problem> {
        let end = self.at.checked_add(bytes).filter(|end| *end <= self.bytes.len());
        let end =
            end.ok_or_else(|| format!("the file ends within its elements: it is truncated{}", self.byte_order_hint()))?;
        let slice = &self.bytes[self.at..end];
        self.at = end;
        Ok(slice)
    }

    fn word(&mut self) -> Result<&'a str, Problem> {
        let rest = &self.bytes[self.at..];
        let start = rest.iter().position(|b| !b.is_ascii_whitespace()).unwrap_or(rest.len());
        self.line += self.line_ends(&rest[..start]);
        let length = rest[start..].iter().position(u8::is_ascii_whitespace).unwrap_or(rest.len() - start);
        if length == 0 {
            return Err("the file ends within its elements: it is truncated; export or copy it again".into());
        }
        self.at += start + length;
        std::str::from_utf8(&rest[start..start + length])
            .map_err(|_| "the data is not text, although the header states `format ascii`; export it again".into())
    }

    /// Number of line ends in `blanks`, the text after a number.
    fn line_ends(&self, blanks: &[u8]) -> usize {
        let feeds = blanks.iter().filter(|b| **b == b'\n').count();
        if feeds > 0 { feeds } else { blanks.iter().filter(|b| **b == b'\r').count() }
    }

    fn word_number(&mut self, number: PlyNumber) -> Result<f64, Problem> {
        let word = self.word()?;
        let value: f64 = word.parse().map_err(|_| format!("`{}` is not a number", shortened(word)))?;
        if number.is_integer() && value.fract() != 0.0 {
            return Err(format!("`{}` is not a whole number, which the header states", shortened(word)).into());
        }
        Ok(value)
    }
}

/// Number of a type from little-endian bytes; `order` corrects their order.
fn binary(number: PlyNumber, bytes: &[u8], order: impl Fn([u8; 8]) -> [u8; 8]) -> f64 {
    let mut all = [0; 8];
    all[..bytes.len()].copy_from_slice(bytes);
    let all = order(all);
    let [a, b, c, d, ..] = all;
    match number {
        PlyNumber::I8 => f64::from(i8::from_le_bytes([a])),
        PlyNumber::U8 => f64::from(a),
        PlyNumber::I16 => f64::from(i16::from_le_bytes([a, b])),
        PlyNumber::U16 => f64::from(u16::from_le_bytes([a, b])),
        PlyNumber::I32 => f64::from(i32::from_le_bytes([a, b, c, d])),
        PlyNumber::U32 => f64::from(u32::from_le_bytes([a, b, c, d])),
        PlyNumber::F32 => f64::from(f32::from_le_bytes([a, b, c, d])),
        PlyNumber::F64 => f64::from_le_bytes(all),
    }
}
