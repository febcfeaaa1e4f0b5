//! Room outside of memory for what a run needs until it ends.
//!
//! Who asks for room knows what it holds; who gives it knows where it is. Nothing is left of it when the last who holds it lets go, however the run
//! ends. Errors are sentences for the user.

use core::fmt::Debug;
use std::sync::Arc;

/// Bytes that can be written and read at any place, from any thread. What was never written reads as 0.
pub trait Scratch: Debug + Send + Sync {
    /// Writes `bytes` from the byte `offset` on.
    ///
    /// # Errors
    /// Where they cannot be written: a full disk is named.
    fn write(&self, offset: u64, bytes: &[u8]) -> Result<(), String>;

    /// Fills `bytes` from the byte `offset` on.
    ///
    /// # Errors
    /// Where they cannot be read.
    fn read(&self, offset: u64, bytes: &mut [u8]) -> Result<(), String>;
}

/// Bytes of a number.
pub const NUMBER_BYTES: usize = size_of::<f32>();
/// Numbers that are turned into bytes at a time.
const PART: usize = 1 << 18;

/// Writes numbers of 32 bits, little-endian, from the byte `offset` on.
///
/// # Errors
/// As [`Scratch::write`].
pub fn write_numbers(scratch: &dyn Scratch, offset: u64, numbers: &[f32]) -> Result<(), String> {
    for (part, numbers) in numbers.chunks(PART).enumerate() {
        let bytes: Vec<u8> = numbers.iter().flat_map(|number| number.to_le_bytes()).collect();
        scratch.write(offset + (part * PART * NUMBER_BYTES) as u64, &bytes)?;
    }
    Ok(())
}

/// Reads numbers that [`write_numbers`] wrote, with the same bits.
///
/// # Errors
/// As [`Scratch::read`].
pub fn read_numbers(scratch: &dyn Scratch, offset: u64, numbers: &mut [f32]) -> Result<(), String> {
    for (part, numbers) in numbers.chunks_mut(PART).enumerate() {
        let mut bytes = vec![0; numbers.len() * NUMBER_BYTES];
        scratch.read(offset + (part * PART * NUMBER_BYTES) as u64, &mut bytes)?;
        let (stored, _) = bytes.as_chunks::<NUMBER_BYTES>();
        numbers.iter_mut().zip(stored).for_each(|(number, stored)| *number = f32::from_le_bytes(*stored));
    }
    Ok(())
}

/// Where there is room.
pub trait ScratchStore: Debug + Send + Sync {
    /// Room for `bytes`.
    ///
    /// # Errors
    /// Where there cannot be any.
    fn room(&self, bytes: u64) -> Result<Arc<dyn Scratch>, String>;
}
