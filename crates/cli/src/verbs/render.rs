//! `etendue render`: radiance, image, raw and ground truth of a job's cameras.

use crate::args::folder::Output;
use crate::args::job::JobArgs;
use crate::args::run::{frames, shard, whole};
use crate::machine;
use crate::output::print_paths;
use crate::progress::Terminal;
use clap::Args;
use etendue::{Error, RenderOptions, ShardSpec};

/// `etendue render`
#[derive(Debug, Args)]
pub struct Render {
    #[command(flatten)]
    pub job: JobArgs,
    #[command(flatten)]
    pub output: Output,
    /// Frames to take, first to last (the last excluded); each has its own sensor noise. The light of a still world is
    /// rendered once
    #[arg(long, value_name = "A..B", value_parser = frames, default_value = "0..1")]
    pub frames: std::ops::Range<u32>,
    /// Worker threads [default: one a processor]. The result does not depend on it
    #[arg(long, value_name = "N", value_parser = whole(1, 1024))]
    pub threads: Option<u32>,
    /// Render only the tiles whose number is I modulo N; join the shards with `etendue merge`
    #[arg(long, value_name = "I/N", value_parser = shard)]
    pub shard: Option<ShardSpec>,
}

impl Render {
    pub fn run(&self) -> Result<(), Error> {
        let simd = machine::simd()?;
        let pool = machine::pool(self.threads)?;
        let job = self.job.open(&pool)?;
        let (folder, frames) = (self.output.folder(), self.frames.clone());
        let observer = Terminal::default();
        let written = pool.install(|| match self.shard {
            None => job.save(&RenderOptions { frames, simd }, folder, &observer),
            Some(spec) => job.save_shard(spec, frames, simd, folder, &observer),
        })?;
        print_paths(&written);
        Ok(())
    }
}
