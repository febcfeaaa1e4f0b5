//! Which part of a run a shard is.

use crate::error::Error;
use etendue_pipeline::tile::Shard;

/// A shard of a run: every tile whose number is `index` modulo `count`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ShardSpec {
    /// Which shard, from 0.
    pub index: u32,
    /// Of how many.
    pub count: u32,
}

impl ShardSpec {
    pub(crate) fn shard(self) -> Result<Shard, Error> {
        let told = || Error::input(format!("shard {}/{}: expected an index below the count", self.index, self.count));
        Shard::new(self.index, self.count).ok_or_else(told)
    }
}
