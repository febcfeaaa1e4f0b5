//! A file whose head is another than the one that is written to it.

use std::io::{Result, Seek, SeekFrom, Write};

/// Passes on what is written, but for its first bytes, in whose place stands a head of its own.
pub(super) struct HeadReplaced<W> {
    sink: W,
    head: Vec<u8>,
    position: u64,
}

impl<W: Write + Seek> HeadReplaced<W> {
    /// In the place of as many bytes stands `head`.
    pub(super) fn new(sink: W, head: Vec<u8>) -> Self {
        Self { sink, head, position: 0 }
    }
}

impl<W: Write> Write for HeadReplaced<W> {
    fn write(&mut self, bytes: &[u8]) -> Result<usize> {
        let rest = usize::try_from(self.position).ok().and_then(|at| self.head.get(at..)).unwrap_or_default();
        let count = match rest.len().min(bytes.len()) {
            0 => self.sink.write(bytes)?,
            count => self.sink.write(&rest[..count])?,
        };
        self.position += count as u64;
        Ok(count)
    }

    fn flush(&mut self) -> Result<()> {
        self.sink.flush()
    }
}

impl<W: Seek> Seek for HeadReplaced<W> {
    fn seek(&mut self, to: SeekFrom) -> Result<u64> {
        self.position = self.sink.seek(to)?;
        Ok(self.position)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Cursor;

    #[test]
    fn the_head_stands_whatever_is_written_there() {
        let mut sink = Cursor::new(Vec::new());
        let mut file = HeadReplaced::new(&mut sink, b"HEAD".to_vec());
        file.write_all(b"abcdefg").expect("memory");
        file.seek(SeekFrom::Start(2)).expect("memory");
        file.write_all(b"xyz").expect("memory");
        assert_eq!(sink.into_inner(), b"HEADzfg");
    }
}
