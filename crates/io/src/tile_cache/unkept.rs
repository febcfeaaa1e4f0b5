//! Blocks that are made and not kept: for plans, which need the first block alone.

use std::sync::Arc;

use etendue_core::blocks::{BlockWriter, Blocks, Fill};

/// The first block of a picture.
#[derive(Debug)]
struct FirstBlock(Vec<u8>);

impl Blocks for FirstBlock {
    fn read(&self, block: usize, bytes: &mut [u8]) -> Result<(), String> {
        if block == 0 && bytes.len() == self.0.len() {
            bytes.copy_from_slice(&self.0);
            return Ok(());
        }
        Err(format!("block {block} of this texture was not kept, as its job was opened for its plan alone"))
    }
}

impl BlockWriter for FirstBlock {
    fn write(&mut self, block: usize, bytes: &[u8]) -> Result<(), String> {
        if block == 0 {
            self.0 = bytes.to_vec();
        }
        Ok(())
    }
}

/// Makes all blocks and keeps the first.
pub(super) fn make(fill: Fill<'_>) -> Result<Arc<dyn Blocks>, String> {
    let mut first = FirstBlock(Vec::new());
    fill(&mut first)?;
    Ok(Arc::new(first))
}
