//! Little-endian numbers at positions of a file.

/// Bytes, and a position in them.
pub(super) struct Bytes<'a> {
    all: &'a [u8],
    pub(super) at: usize,
}

impl<'a> Bytes<'a> {
    pub(super) fn new(all: &'a [u8]) -> Self {
        Self { all, at: 0 }
    }

    /// The same bytes at another position.
    pub(super) fn with_place(self, at: usize) -> Self {
        Self { at, ..self }
    }

    /// Bytes after the position.
    pub(super) fn remaining(&self) -> u64 {
        self.all.len().saturating_sub(self.at) as u64
    }

    pub(super) fn go(&mut self, at: u64) -> Result<(), String> {
        self.at = usize::try_from(at)
            .ok()
            .filter(|at| *at <= self.all.len())
            .ok_or("an offset is beyond the end of the file")?;
        Ok(())
    }

    pub(super) fn take(&mut self, count: u64) -> Result<&'a [u8], String> {
        let count = usize::try_from(count).ok().filter(|_| count <= self.remaining()).ok_or("the file is truncated")?;
        let slice = &self.all[self.at..self.at + count];
        self.at += count;
        Ok(slice)
    }

    fn array<const N: usize>(&mut self) -> Result<[u8; N], String> {
        let mut array = [0; N];
        array.copy_from_slice(self.take(N as u64)?);
        Ok(array)
    }

    pub(super) fn u8(&mut self) -> Result<u8, String> {
        self.array::<1>().map(|[byte]| byte)
    }

    pub(super) fn u16(&mut self) -> Result<u16, String> {
        self.array().map(u16::from_le_bytes)
    }

    pub(super) fn u32(&mut self) -> Result<u32, String> {
        self.array().map(u32::from_le_bytes)
    }

    pub(super) fn u64(&mut self) -> Result<u64, String> {
        self.array().map(u64::from_le_bytes)
    }

    /// Reads a count of items of at least `size` bytes each.
    pub(super) fn count(&mut self, size: u64) -> Result<u64, String> {
        let count = self.u64()?;
        match count.checked_mul(size.max(1)).is_some_and(|bytes| bytes <= self.remaining()) {
            true => Ok(count),
            false => Err(format!("{count} entries are stated, and {} bytes remain", self.remaining())),
        }
    }
}
