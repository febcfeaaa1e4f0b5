//! Decompressed size of the values of a crate.

use super::bytes::Bytes;
use super::crate_bounds::{Crate, MAX_DEPTH};

const ARRAY: u64 = 1 << 63;
const INLINED: u64 = 1 << 62;
const COMPRESSED: u64 = 1 << 61;
const PAYLOAD: u64 = (1 << 48) - 1;
/// Overhead of a value in addition to its content, bytes.
const OVERHEAD: u64 = 128;

/// Table that an index of a list refers to.
#[derive(Clone, Copy)]
enum IndexedTable {
    Token,
    String,
    Path,
}

/// Bytes of an array element, by the number of its type.
fn element_size(kind: u64) -> Option<u64> {
    Some(match kind {
        1 | 2 => 1,
        3 | 4 | 8 => 4,
        5 | 6 | 9 | 56 => 8,
        7 => 2,
        // Matrices of doubles of order 2, 3 and 4.
        13 => 32,
        14 => 72,
        15 => 128,
        // Quaternions.
        16 => 32,
        17 => 16,
        18 => 8,
        // Vectors of 2, 3 and 4: doubles, floats, halves, integers.
        19..=30 => (2 + (kind - 19) / 4) * [8, 4, 2, 4][(kind - 19) as usize % 4],
        _ => return None,
    })
}

impl Crate<'_> {
    /// Charges the budget for a value, and refuses one that holds more than the file, or contains itself.
    pub(super) fn check_value(&mut self, value: u64, depth: usize) -> Result<(), String> {
        self.spend(1, OVERHEAD)?;
        if depth > MAX_DEPTH {
            return Err(format!("values are nested more than {MAX_DEPTH} levels deep, or form a cycle"));
        }
        let (kind, place) = (value >> 48 & 0xff, value & PAYLOAD);
        if value & INLINED != 0 {
            return Ok(());
        }
        match kind {
            10 | 12 | 57 if value & ARRAY != 0 => self.indexed(&mut self.from(place)?, IndexedTable::String),
            11 if value & ARRAY != 0 => {
                let mut reader = self.from(place)?;
                let count = self.array_length(&mut reader, place)?;
                self.indices(&mut reader, count, IndexedTable::Token)
            }
            48 => self.array(9, value, place),
            _ if value & ARRAY != 0 => self.array(kind, value, place),
            31 => self.dictionary(&mut self.from(place)?, depth),
            46 => self.samples(place, depth),
            32..=39 | 54 | 55 => self.list_edits(kind, place, depth),
            40 => self.indexed(&mut self.from(place)?, IndexedTable::Path),
            41 => self.indexed(&mut self.from(place)?, IndexedTable::Token),
            50 => self.indexed(&mut self.from(place)?, IndexedTable::String),
            45 => self.counted(&mut self.from(place)?, 8, OVERHEAD),
            49 => self.counted(&mut self.from(place)?, 16, 16),
            58 => self.counted(&mut self.from(place)?, 8, OVERHEAD),
            _ => Ok(()),
        }
    }

    fn array_length(&self, reader: &mut Bytes<'_>, place: u64) -> Result<u64, String> {
        if place == 0 {
            return Ok(0);
        }
        if self.version < [0, 5, 0] {
            reader.u32()?;
        }
        if self.version < [0, 7, 0] { reader.u32().map(u64::from) } else { reader.u64() }
    }

    fn array(&mut self, kind: u64, value: u64, place: u64) -> Result<(), String> {
        let Some(size) = element_size(kind) else { return Ok(()) };
        let mut reader = self.from(place)?;
        let count = self.array_length(&mut reader, place)?;
        let since = match kind {
            3..=6 => Some([0, 5, 0]),
            7..=9 | 56 => Some([0, 6, 0]),
            _ => None,
        };
        let is_packed = value & COMPRESSED != 0 && count >= 4 && since.is_some_and(|since| self.version >= since);
        // Packed integers are decoded through their longest form.
        self.spend(count, if is_packed { 2 * size + 16 } else { size })?;
        if !is_packed {
            return match count.checked_mul(size).is_some_and(|bytes| bytes <= reader.remaining()) {
                true => Ok(()),
                false => Err(format!("an array of {count} elements is stated, and the file is too small for it")),
            };
        }
        if matches!(kind, 7..=9 | 56) && reader.u8()? == b't' {
            let table = u64::from(reader.u32()?);
            self.spend(table, size)?;
            reader.take(table.saturating_mul(size))?;
        }
        self.check_packed_count(&reader, count)
    }

    /// Reads a 64-bit count of entries of `size` bytes, which take `memory` bytes each.
    fn counted(&mut self, reader: &mut Bytes<'_>, size: u64, memory: u64) -> Result<(), String> {
        let count = reader.count(size)?;
        self.spend(count, memory)?;
        reader.take(count * size).map(drop)
    }

    fn indexed(&mut self, reader: &mut Bytes<'_>, of: IndexedTable) -> Result<(), String> {
        let count = reader.count(4)?;
        self.indices(reader, count, of)
    }

    /// Reads 32-bit indices into a table, whose entries are copied.
    fn indices(&mut self, reader: &mut Bytes<'_>, count: u64, of: IndexedTable) -> Result<(), String> {
        let raw = reader.take(count.checked_mul(4).ok_or("too many entries")?)?;
        for bytes in raw.as_chunks::<4>().0 {
            let index = u32::from_le_bytes(*bytes) as usize;
            let length = match of {
                IndexedTable::Token => self.tokens.get(index),
                IndexedTable::String => self.strings.get(index).and_then(|token| self.tokens.get(*token as usize)),
                IndexedTable::Path => self.paths.get(index),
            };
            let length = *length.ok_or("an index refers to a missing string, token or path")?;
            self.spend(1, OVERHEAD + length)?;
        }
        Ok(())
    }

    /// Follows an offset relative to its own position.
    fn followed(reader: &mut Bytes<'_>) -> Result<(), String> {
        let at = reader.at as i64;
        let offset = reader.u64()? as i64;
        let to = at
            .checked_add(offset)
            .and_then(|to| u64::try_from(to).ok())
            .ok_or("an offset is before the beginning of the file")?;
        reader.go(to)
    }

    fn dictionary(&mut self, reader: &mut Bytes<'_>, depth: usize) -> Result<(), String> {
        let count = reader.count(12)?;
        for _ in 0..count {
            reader.u32()?;
            Self::followed(reader)?;
            let value = reader.u64()?;
            self.check_value(value, depth + 1)?;
        }
        Ok(())
    }

    fn samples(&mut self, place: u64, depth: usize) -> Result<(), String> {
        let mut reader = self.from(place)?;
        Self::followed(&mut reader)?;
        let times = reader.u64()?;
        self.check_value(times, depth + 1)?;
        Self::followed(&mut reader)?;
        let count = reader.count(8)?;
        for _ in 0..count {
            let value = reader.u64()?;
            self.check_value(value, depth + 1)?;
        }
        Ok(())
    }

    fn list_edits(&mut self, kind: u64, place: u64, depth: usize) -> Result<(), String> {
        let mut reader = self.from(place)?;
        let header = reader.u8()?;
        // Explicit, added, deleted, ordered, prepended, appended: one list each.
        for _ in 0..(header & 0b111_1110).count_ones() {
            match kind {
                32 => self.indexed(&mut reader, IndexedTable::Token)?,
                33 | 54 => self.indexed(&mut reader, IndexedTable::String)?,
                34 => self.indexed(&mut reader, IndexedTable::Path)?,
                36 | 38 => self.counted(&mut reader, 4, 4)?,
                37 | 39 => self.counted(&mut reader, 8, 8)?,
                35 => self.references(&mut reader, depth)?,
                _ => self.counted(&mut reader, if self.version >= [0, 8, 0] { 24 } else { 8 }, OVERHEAD)?,
            }
        }
        Ok(())
    }

    fn references(&mut self, reader: &mut Bytes<'_>, depth: usize) -> Result<(), String> {
        let count = reader.count(32)?;
        self.spend(count, 2 * OVERHEAD)?;
        for _ in 0..count {
            // File, prim, offset and scale of time.
            reader.take(24)?;
            self.dictionary(reader, depth + 1)?;
        }
        Ok(())
    }
}
