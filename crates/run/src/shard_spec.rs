//! Which part of a run a shard is.

use etendue_io::failure::Error;
use etendue_pipeline::tile::Shard;
use std::ops::Range;

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

/// What one call renders of a shard.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ShardRequest {
    /// Which tiles.
    pub spec: ShardSpec,
    /// The frames of the whole run.
    pub frames: Range<u32>,
    /// The only films of the shard to render, by the [names of their files](crate::Job::film_names); empty: all of them.
    pub films: Vec<String>,
}

impl ShardRequest {
    /// All films of a shard.
    #[must_use]
    pub fn whole(spec: ShardSpec, frames: Range<u32>) -> Self {
        Self { spec, frames, films: Vec::new() }
    }
}
