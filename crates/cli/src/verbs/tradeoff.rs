//! `etendue tradeoff`: time against error for a job of one's own, with settings for drafts, standard pictures and references.

use crate::args::folder::Output;
use crate::args::job::JobArgs;
use crate::machine;
use crate::output::{print, print_paths};
use crate::progress::Terminal;
use clap::Args;
use etendue::{Error, JobRequest, write_file};
use etendue_study::{Clock, Request, Study, job_file, pictures, plot, study, table};
use std::path::{Path, PathBuf};
use std::time::Instant;

/// `etendue tradeoff`
#[derive(Debug, Args)]
pub struct Tradeoff {
    #[command(flatten)]
    pub job: JobArgs,
    #[command(flatten)]
    pub output: Output,
    /// About how long the study may take, seconds (10 or more): the longer, the surer
    #[arg(long, value_name = "S", default_value_t = 120.0, value_parser = seconds)]
    pub time: f64,
    /// Worker threads [default: one a processor]. Times are those of as many
    #[arg(long, value_name = "N", value_parser = crate::args::run::whole(1, 1024))]
    pub threads: Option<u32>,
    /// Print the study as JSON instead of as tables
    #[arg(long)]
    pub json: bool,
}

/// Seconds of a study.
fn seconds(text: &str) -> Result<f64, String> {
    let seconds = text.parse().ok().filter(|s: &f64| (10.0..=1e6).contains(s));
    seconds.ok_or_else(|| format!("expected seconds from 10 to 1000000, not '{text}'"))
}

/// Seconds since the program asked first.
struct Stopwatch(Instant);

impl Clock for Stopwatch {
    fn seconds(&self) -> f64 {
        self.0.elapsed().as_secs_f64()
    }
}

impl Tradeoff {
    pub fn run(&self) -> Result<(), Error> {
        let simd = machine::simd()?;
        let pool = machine::pool(self.threads)?;
        let job = JobRequest::from(&self.job);
        // Its faults, and what the command line supersedes, before anything is written.
        self.job.open(&pool)?;
        let (folder, existing) = self.output.folder();
        let names = ["tradeoff.json", "tradeoff.txt", "tradeoff.svg", "draft.toml", "standard.toml", "reference.toml"];
        if let Some(name) =
            names.iter().find(|name| existing == etendue::Existing::Refuse && folder.join(name).exists())
        {
            let path = folder.join(name);
            return Err(Error::input(format!(
                "{}: is there already; give another folder, or --overwrite",
                path.display()
            )));
        }
        let request = Request { job: job.clone(), camera: self.job.camera.clone(), budget_s: self.time, simd };
        let scratch = folder.join("pilot");
        let stopwatch = Stopwatch(Instant::now());
        let observer = Terminal::default();
        let found = pool.install(|| study(&request, &scratch, &stopwatch, &observer))?;
        let compared = pool.install(|| pictures(&found, &request, &observer))?;
        let json = to_json(&found)?;
        let mut files = vec![
            ("tradeoff.json".to_owned(), json.clone().into_bytes()),
            ("tradeoff.txt".to_owned(), table(&found).into_bytes()),
            ("tradeoff.svg".to_owned(), plot(&found).into_bytes()),
        ];
        for recommendation in &found.recommendations {
            let text = job_file(recommendation, (&job, &found.camera), folder)?;
            files.push((format!("{}.toml", recommendation.target.name), text.into_bytes()));
        }
        files.extend(compared.into_iter().map(|compared| (format!("pictures/{}", compared.file), compared.png)));
        let write = |(name, bytes): &(String, Vec<u8>)| -> Result<PathBuf, Error> {
            let path: PathBuf = Path::new(folder).join(name);
            write_file(&path, bytes, existing)?;
            Ok(path)
        };
        let written = files.iter().map(write).collect::<Result<Vec<_>, _>>()?;
        if self.json {
            print(&json);
        } else {
            print(&table(&found));
            print("\n");
            print_paths(&written);
        }
        Ok(())
    }
}

fn to_json(study: &Study) -> Result<String, Error> {
    let text = serde_json::to_string_pretty(study).map_err(|error| Error::Run(error.to_string()))?;
    Ok(text + "\n")
}
