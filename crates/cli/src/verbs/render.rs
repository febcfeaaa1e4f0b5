//! `etendue render`: radiance, image, raw and ground truth of a job's cameras.

use crate::args::folder::Output;
use crate::args::job::JobArgs;
use crate::console::{Console, print_paths};
use crate::display::{Display, DisplayObserver};
use crate::machine;
use clap::Args;
use etendue::{Error, ExistingFiles, JobRequest, RenderOptions, ShardRequest, ShardSpec};
use etendue_arguments::integer;

/// `etendue render`
#[derive(Debug, Args)]
pub struct Render {
    #[command(flatten)]
    pub job: JobArgs,
    #[command(flatten)]
    pub output: Output,
    #[command(flatten)]
    pub options: RenderOptions,
    /// Resume an interrupted run of the same plan into this folder: complete frames of time-dependent light are kept, and passes of a progressive run;
    /// everything else is rendered and replaced
    #[arg(long, conflicts_with_all = ["overwrite", "shard"])]
    pub resume: bool,
    /// Take as many samples as this rendering time allows, s, 10 or more, from the first sample on, all cameras and frames together; the passes are
    /// reported and written, and render.passes reproduces the same bytes
    #[arg(id = "time_s", long = "time", value_name = "S", conflicts_with_all = ["spp", "noise", "shard"])]
    pub time: Option<f64>,
    /// Refine the image on disk pass by pass, and store the state after each: a stopped or killed run continues with --resume, to the same bytes
    #[arg(long, conflicts_with_all = ["noise", "shard"])]
    pub progressive: bool,
    /// Show light during rendering in a viewer with tev's protocol. The result does not depend on it
    #[arg(long, value_name = "HOST:PORT")]
    pub display: Option<String>,
    /// Worker threads [default: one per processor]. The result does not depend on it
    #[arg(long, value_name = "N", value_parser = integer(1..=1024))]
    pub threads: Option<u32>,
    /// Render only the tiles whose number is I modulo N; join the shards with `etendue merge`
    #[arg(long, value_name = "I/N")]
    pub shard: Option<ShardSpec>,
    /// Of a shard only this film, by the name of its file, as front.film.exr or left.0003.0.film.exr (once or several times); `etendue merge`
    /// requires all films of a shard in its folder
    #[arg(id = "films", long = "film", value_name = "FILE", requires = "shard")]
    pub film: Vec<String>,
}

impl Render {
    fn existing(&self) -> ExistingFiles {
        if self.resume { ExistingFiles::Resume } else { self.output.existing() }
    }

    pub fn run(&self, console: &dyn Console) -> Result<(), Error> {
        let simd = machine::simd()?;
        let pool = machine::pool(self.threads)?;
        let request = JobRequest { time_s: self.time, progressive: self.progressive, ..self.job.request() };
        let request = request.into_output(&self.output.output);
        let job = JobArgs::open_request(console, request, &pool)?;
        let (folder, existing, frames) = (self.output.path(), self.existing(), self.options.frames.clone());
        let display = self.display.as_deref().map(Display::connect).transpose()?;
        let observer = DisplayObserver::new(console.observer(), display);
        let written = pool.install(|| match self.shard {
            None => job.save(&RenderOptions { frames, simd }, folder, existing, &observer),
            Some(spec) => {
                let shard = ShardRequest { spec, frames, films: self.film.clone() };
                job.save_shard(&shard, simd, folder, existing, &observer)
            }
        });
        observer.finish();
        print_paths(console, &written?);
        Ok(())
    }
}
