//! Checks the decompressed size of a crate before `openusd` reads it.
//!
//! Source: AOUSD Core Specification 1.0.1, §16.3, and `pxr/usd/usd/crateFile.cpp`. A crate is a table of sections: tokens, strings (numbers of tokens), fields
//! (a token and a value each), sets of fields, paths (a tree, encoded as jumps), specs (a path and a set of fields). All integers are packed by two bits and
//! LZ4. `openusd` allocates memory for a count before it reads, decodes paths along arbitrary jumps, and follows nested values without a limit. All of that is
//! checked here first, within a memory budget.

use etendue_scene::limits;

use super::bytes::Bytes;
use super::text_bounds::{check_expression, is_balanced};

/// Maximum compression ratio of LZ4, from the length codes of its specification.
const MAX_RATIO: u64 = 256;
/// Maximum depth of prims and properties.
pub(super) const MAX_DEPTH: usize = 64;
/// Overhead of a path, a spec and a text in addition to the characters, bytes.
const OVERHEAD: u64 = 64;

/// Crate with its parsed tables.
pub(super) struct Crate<'a> {
    pub(super) bytes: &'a [u8],
    pub(super) version: [u8; 3],
    /// Lengths of tokens, bytes.
    pub(super) tokens: Vec<u64>,
    /// True for tokens that can be parts of paths.
    in_paths: Vec<bool>,
    /// Tokens of strings.
    pub(super) strings: Vec<u32>,
    /// Lengths of paths, bytes.
    pub(super) paths: Vec<u64>,
    spent: u64,
}

/// Refuses a crate that would decompress to more than `mesh-mib`, or does not terminate.
pub(super) fn check_crate(bytes: &[u8]) -> Result<(), String> {
    let mut reader = Bytes::new(bytes);
    reader.take(8)?;
    let version = [reader.u8()?, reader.u8()?, reader.u8()?];
    if version < [0, 4, 0] {
        let [a, b, c] = version;
        return Err(format!(
            "unsupported crate version {a}.{b}.{c}; expected 0.4.0 or later: save it again with usdcat"
        ));
    }
    reader.go(16)?;
    let table = reader.u64()?;
    reader.go(table)?;
    let count = reader.count(32)?;
    let mut sections = Vec::new();
    for _ in 0..count.min(64) {
        let name = reader.take(16)?;
        let name = name.split(|byte| *byte == 0).next().unwrap_or_default();
        sections.push((name, reader.u64()?));
        reader.u64()?;
    }
    let section = |name: &str| sections.iter().find(|(own, _)| *own == name.as_bytes()).map(|(_, start)| *start);
    let mut own = Crate {
        bytes,
        version,
        tokens: Vec::new(),
        in_paths: Vec::new(),
        strings: Vec::new(),
        paths: Vec::new(),
        spent: 0,
    };
    if let Some(start) = section("TOKENS") {
        own.read_tokens(start)?;
    }
    if let Some(start) = section("STRINGS") {
        own.read_strings(start)?;
    }
    if let Some(start) = section("PATHS") {
        own.read_paths(start)?;
    }
    if let Some(start) = section("FIELDSETS") {
        let mut reader = own.from(start)?;
        let count = reader.u64()?;
        own.spend(count, 16)?;
        own.integers(&mut reader, count)?;
    }
    if let Some(start) = section("SPECS") {
        let mut reader = own.from(start)?;
        let count = reader.u64()?;
        own.spend(count, 3 * OVERHEAD)?;
        for _ in 0..3 {
            own.integers(&mut reader, count)?;
        }
    }
    match section("FIELDS") {
        Some(start) => own.check_fields(start),
        None => Ok(()),
    }
}

impl<'a> Crate<'a> {
    pub(super) fn from(&self, start: u64) -> Result<Bytes<'a>, String> {
        let mut reader = Bytes::new(self.bytes);
        reader.go(start)?;
        Ok(reader)
    }

    /// Charges the budget for `count` items of `size` bytes.
    pub(super) fn spend(&mut self, count: u64, size: u64) -> Result<(), String> {
        self.spent = self.spent.saturating_add(count.saturating_mul(size));
        limits::MESH.check_unpacked(self.spent).map_err(|problem| problem.words)
    }

    /// Decompresses bytes: one byte for the number of chunks, which must be one, and a block.
    fn unpacked(&mut self, reader: &mut Bytes<'_>, max: u64) -> Result<Vec<u8>, String> {
        let size = reader.count(1)?;
        let packed = reader.take(size)?;
        let [chunks, block @ ..] = packed else { return Err("a compressed block is empty".to_owned()) };
        if *chunks != 0 {
            return Err("a compressed block has more than 2 GiB, which is not supported".to_owned());
        }
        // The block cannot give more than this, so no more is allocated.
        let max_bytes = max.min((block.len() as u64).saturating_mul(MAX_RATIO));
        self.spend(max_bytes, 1)?;
        let mut unpacked = vec![0; usize::try_from(max_bytes).map_err(|_| "a compressed block is too large")?];
        let size =
            lz4_flex::block::decompress_into(block, &mut unpacked).map_err(|e| format!("a compressed block: {e}"))?;
        unpacked.truncate(size);
        Ok(unpacked)
    }

    /// Packed 32-bit integers; refuses more than possible.
    fn integers(&mut self, reader: &mut Bytes<'_>, count: u64) -> Result<Vec<u8>, String> {
        self.check_packed_count(reader, count)?;
        // `openusd` allocates the longest form and the decoded integers.
        self.spend(count, 16)?;
        self.unpacked(reader, 8 + count / 4 + 4 * count)
    }

    /// Refuses a count of packed integers, at least two bits each, that cannot come from the block that follows.
    pub(super) fn check_packed_count(&self, reader: &Bytes<'_>, count: u64) -> Result<(), String> {
        let mut reader = Bytes::new(self.bytes).with_place(reader.at);
        let size = reader.count(1)?;
        match count / 4 <= size.saturating_mul(MAX_RATIO) {
            true => Ok(()),
            false => Err(format!("{count} integers are stated in {size} bytes, which cannot contain them")),
        }
    }

    fn read_tokens(&mut self, start: u64) -> Result<(), String> {
        let mut reader = self.from(start)?;
        let (count, size) = (reader.u64()?, reader.u64()?);
        self.spend(count, OVERHEAD)?;
        let packed = Bytes::new(self.bytes).with_place(reader.at).count(1)?;
        if size > packed.saturating_mul(MAX_RATIO) {
            return Err(format!("{size} bytes of tokens are stated in {packed} bytes, which cannot contain them"));
        }
        self.spend(size, 1)?;
        let texts = self.unpacked(&mut reader, size)?;
        for token in texts.strip_suffix(&[0]).unwrap_or(&texts).split(|byte| *byte == 0) {
            check_expression(token)?;
            self.in_paths.push(is_balanced(token));
            self.tokens.push(token.len() as u64);
        }
        Ok(())
    }

    fn read_strings(&mut self, start: u64) -> Result<(), String> {
        let mut reader = self.from(start)?;
        let count = reader.count(4)?;
        self.spend(count, 16)?;
        let raw = reader.take(4 * count)?;
        self.strings = raw.as_chunks::<4>().0.iter().map(|bytes| u32::from_le_bytes(*bytes)).collect();
        Ok(())
    }

    fn read_paths(&mut self, start: u64) -> Result<(), String> {
        let mut reader = self.from(start)?;
        let paths = reader.u64()?;
        self.spend(paths, OVERHEAD)?;
        let count = reader.u64()?;
        let [indices, elements, jumps] = {
            let mut list = || self.integers(&mut reader, count).and_then(|packed| decoded(&packed, count));
            [list()?, list()?, list()?]
        };
        let max = usize::try_from(paths).map_err(|_| "too many paths")?;
        self.paths = vec![0; max];
        self.walk_paths([&indices, &elements, &jumps])
    }

    /// Walks the tree of paths like `openusd`. A jump of 0 means that a sibling follows; −1: a child follows; −2: neither; above 0: a child follows, with a
    /// sibling at that distance. No position is visited twice.
    fn walk_paths(&mut self, [indices, elements, jumps]: [&[i32]; 3]) -> Result<(), String> {
        let mut visited = vec![false; jumps.len()];
        // Positions, lengths of their parents, and depths; the root has no parent.
        let mut pending = if jumps.is_empty() { Vec::new() } else { vec![(0_usize, None, 0)] };
        while let Some((mut at, mut parent, mut depth)) = pending.pop() {
            loop {
                let error = || format!("the path tree is damaged at entry {at}");
                if std::mem::replace(visited.get_mut(at).ok_or_else(error)?, true) || depth > MAX_DEPTH {
                    return Err(error());
                }
                let length = match parent {
                    None => 1,
                    Some(parent) => {
                        let token = elements[at].unsigned_abs() as usize;
                        // Braces other than those of variants send `openusd` into a loop.
                        if self.in_paths.get(token) != Some(&true) {
                            return Err(error());
                        }
                        parent + 1 + self.tokens.get(token).ok_or_else(error)?
                    }
                };
                self.spend(1, OVERHEAD + length)?;
                let slot = if parent.is_none() { at } else { indices[at] as u32 as usize };
                *self.paths.get_mut(slot).ok_or_else(error)? = length;
                let above = parent.unwrap_or(length);
                let jump = jumps[at];
                let (has_child, has_sibling) = (jump > 0 || jump == -1, jump >= 0);
                if has_child && has_sibling {
                    pending.push((at + jump as usize, Some(above), depth));
                }
                if has_child {
                    (parent, depth) = (Some(length), depth + 1);
                } else {
                    parent = Some(above);
                }
                if !has_child && !has_sibling {
                    break;
                }
                at += 1;
            }
        }
        Ok(())
    }

    fn check_fields(&mut self, start: u64) -> Result<(), String> {
        let mut reader = self.from(start)?;
        let count = reader.u64()?;
        self.integers(&mut reader, count)?;
        self.spend(count, 16)?;
        let packed = self.unpacked(&mut reader, count.saturating_mul(8))?;
        let values: Vec<u64> = packed.as_chunks::<8>().0.iter().map(|bytes| u64::from_le_bytes(*bytes)).collect();
        values.into_iter().try_for_each(|value| self.check_value(value, 0))
    }
}

/// Decodes 32-bit integers; two bits each state the encoding of the difference to the previous one.
fn decoded(packed: &[u8], count: u64) -> Result<Vec<i32>, String> {
    if count == 0 {
        return Ok(Vec::new());
    }
    let mut reader = Bytes::new(packed);
    let common = reader.u32()? as i32;
    let codes = reader.take(count.div_ceil(4))?;
    let (mut last, mut unpacked) = (0_i32, Vec::with_capacity(count as usize));
    for i in 0..count as usize {
        let difference = match codes[i / 4] >> (2 * (i % 4)) & 3 {
            0 => common,
            1 => i32::from(reader.u8()? as i8),
            2 => i32::from(reader.u16()? as i16),
            _ => reader.u32()? as i32,
        };
        last = last.wrapping_add(difference);
        unpacked.push(last);
    }
    Ok(unpacked)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn integers_are_decoded_as_the_format_packs_them() {
        // The example of `integerCoding.cpp`: 123, 124, 125, 100125, 100125, 100126, 100126.
        let packed = [1, 0, 0, 0, 0b1100_0001, 0b0001_0001, 123, 0xa0, 0x86, 1, 0, 0, 0];
        assert_eq!(decoded(&packed, 7), Ok(vec![123, 124, 125, 100_125, 100_125, 100_126, 100_126]));
        assert!(decoded(&packed[..8], 7).is_err());
    }

    #[test]
    fn paths_that_lead_round_are_refused() {
        let walked = |jumps: &[i32]| {
            let (indices, elements): (Vec<i32>, Vec<i32>) = (0..jumps.len() as i32).map(|i| (i, 0)).unzip();
            let (tokens, paths, strings) = (vec![1], vec![0; jumps.len()], Vec::new());
            let in_paths = vec![true];
            let mut own = Crate { bytes: &[], version: [0, 8, 0], tokens, in_paths, strings, paths, spent: 0 };
            own.walk_paths([&indices, &elements, jumps]).map(|()| own.paths)
        };
        // The root, a child with a child of its own, its sibling.
        assert_eq!(walked(&[-1, 2, -2, -2]), Ok(vec![1, 3, 5, 3]));
        assert!(walked(&[-1, 1, 1, -2]).is_err());
        assert!(walked(&[-1, 9, -2]).is_err());
        assert!(walked(&[-1; 100]).is_err());
    }
}
