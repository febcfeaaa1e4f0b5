//! Numbered blocks of bytes that are kept outside of memory, each read by itself when it is needed.
//!
//! Who makes blocks knows what they hold; who keeps them knows where. Errors are sentences for the user that name the file.

use core::fmt::Debug;
use std::sync::Arc;

/// What blocks are kept under: a hash of everything that decides their bytes.
pub type BlockKey = [u8; 32];

/// Blocks that are complete.
pub trait Blocks: Debug + Send + Sync {
    /// Fills `bytes`, which is as long as the block, from any thread.
    ///
    /// # Errors
    /// Where the block cannot be read or is not what was written.
    fn read(&self, block: usize, bytes: &mut [u8]) -> Result<(), String>;
}

/// Takes blocks, in any order, each once.
pub trait BlockWriter {
    /// Writes a block.
    ///
    /// # Errors
    /// Where it cannot be written.
    fn write(&mut self, block: usize, bytes: &[u8]) -> Result<(), String>;
}

/// Writes all blocks to where it is told.
pub type Fill<'a> = &'a mut dyn FnMut(&mut dyn BlockWriter) -> Result<(), String>;

/// Where blocks are kept.
pub trait BlockStore: Debug + Send + Sync {
    /// The blocks of a key; `None` where there are none that are whole. `lengths` are the bytes of each.
    fn find(&self, key: &BlockKey, lengths: &[u32]) -> Option<Arc<dyn Blocks>>;

    /// Refuses blocks for which there is no room whatever is removed, before they are made.
    ///
    /// # Errors
    /// What is too much, and what to do.
    fn check_room(&self, _key: &BlockKey, _lengths: &[u32]) -> Result<(), String> {
        Ok(())
    }

    /// Keeps the blocks that `fill` writes; nobody sees them before all are there.
    ///
    /// # Errors
    /// Where they cannot be kept, or the error of `fill`; nothing is left of them then.
    fn make(&self, key: &BlockKey, lengths: &[u32], fill: Fill<'_>) -> Result<Arc<dyn Blocks>, String>;
}
