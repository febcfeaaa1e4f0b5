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

/// Where there is room.
pub trait ScratchStore: Debug + Send + Sync {
    /// Room for `bytes`.
    ///
    /// # Errors
    /// Where there cannot be any.
    fn room(&self, bytes: u64) -> Result<Arc<dyn Scratch>, String>;
}
