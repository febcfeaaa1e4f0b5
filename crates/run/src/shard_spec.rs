//! Which part of a run a shard is.

use etendue_io::failure::{Error, ErrorCode};
use etendue_pipeline::tile::Shard;
use std::ops::Range;
use std::str::FromStr;

/// A shard of a run: every tile whose number is `index` modulo `count`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ShardSpec {
    /// Which shard, from 0.
    pub index: u32,
    /// Of how many.
    pub count: u32,
}

/// `I/N`.
impl FromStr for ShardSpec {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let expected = || format!("expected I/N with I < N, e.g. 0/3, not '{text}'");
        let (index, count) = text.split_once('/').ok_or_else(expected)?;
        let number = |s: &str| s.trim().parse::<u32>().map_err(|_| expected());
        let (index, count) = (number(index)?, number(count)?);
        if index < count { Ok(Self { index, count }) } else { Err(expected()) }
    }
}

impl ShardSpec {
    pub(crate) fn shard(self) -> Result<Shard, Error> {
        let told = || {
            Error::coded(
                ErrorCode::OutOfRange,
                format!("shard {}/{}: expected an index below the count", self.index, self.count),
            )
        };
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_shard_is_one_of_many() {
        let shard = |text: &str| text.parse::<ShardSpec>();
        assert_eq!(shard("1/3"), Ok(ShardSpec { index: 1, count: 3 }));
        assert!(shard("3/3").is_err() && shard("1").is_err());
    }
}
