//! Lines and columns of byte offsets.

/// Bytes from one mark to the next.
const STRIDE: usize = 128;

/// Lines and columns of a text's offsets, found in a time independent of line length.
pub(crate) struct LineIndex<'t> {
    text: &'t str,
    /// Offsets of line starts.
    starts: Vec<usize>,
    /// Characters that begin before each multiple of [`STRIDE`].
    marks: Vec<usize>,
}

impl<'t> LineIndex<'t> {
    pub(crate) fn new(text: &'t str) -> Self {
        let breaks = text.bytes().enumerate().filter(|(_, b)| *b == b'\n').map(|(i, _)| i + 1);
        let marks = text.as_bytes().chunks(STRIDE).scan(0, |before, chunk| {
            let mark = *before;
            *before += characters(chunk);
            Some(mark)
        });
        Self { text, starts: std::iter::once(0).chain(breaks).collect(), marks: marks.collect() }
    }

    /// Line and column of the byte `offset`, both from 1, columns in characters.
    pub(crate) fn line_column(&self, offset: usize) -> (u32, u32) {
        let line = self.starts.partition_point(|start| *start <= offset);
        let column = self.before(offset) - self.before(self.starts[line - 1]) + 1;
        (saturating_u32(line), saturating_u32(column))
    }

    /// Number of characters that begin before the byte `offset`.
    fn before(&self, offset: usize) -> usize {
        let offset = offset.min(self.text.len());
        let nearest = (offset / STRIDE).min(self.marks.len().saturating_sub(1));
        let marked = self.marks.get(nearest).copied().unwrap_or(0);
        marked + characters(&self.text.as_bytes()[nearest * STRIDE..offset])
    }
}

/// Number of UTF-8 characters that begin in `bytes`.
fn characters(bytes: &[u8]) -> usize {
    bytes.iter().filter(|b| (**b & 0xc0) != 0x80).count()
}

fn saturating_u32(n: usize) -> u32 {
    u32::try_from(n).unwrap_or(u32::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_offset_has_the_line_and_column_that_counting_gives() {
        let text = format!("é = 1\n\n{}\nlast ☀", "ä☀x".repeat(200));
        let index = LineIndex::new(&text);
        for (offset, _) in text.char_indices().chain([(text.len(), ' ')]) {
            let before = &text[..offset];
            let line = before.matches('\n').count() + 1;
            let column = before.rsplit('\n').next().unwrap_or("").chars().count() + 1;
            assert_eq!(index.line_column(offset), (line as u32, column as u32), "offset {offset}");
        }
        assert_eq!(LineIndex::new("").line_column(0), (1, 1));
        assert_eq!(LineIndex::new("ab").line_column(99), (1, 3), "past the end is the end");
    }

    /// Counting from the start of the line would take 10¹³ steps here.
    #[test]
    fn a_long_line_is_as_quick_as_many_short_ones() {
        let text = "x".repeat(4_000_000);
        let index = LineIndex::new(&text);
        let sum: u64 = (0..text.len()).map(|offset| u64::from(index.line_column(offset).1)).sum();
        assert_eq!(sum, 4_000_000 * 4_000_001 / 2);
    }
}
