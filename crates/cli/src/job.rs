//! From a job file and the command line to a plan.

use crate::args::{self, Quality};
use crate::failure::Failure;
use etendue_io::load_assets;
use etendue_pipeline::{Choices, Plan, compile};
use etendue_scene::{Description, Overrides};
use std::path::{Path, PathBuf};

/// What the command line says of a job: enough to make the same plan again.
#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct JobRequest {
    /// The job file.
    pub job: PathBuf,
    /// Changes to it.
    pub set: Vec<String>,
    /// Samples a pixel.
    pub spp: Option<u32>,
    /// The preset's name.
    pub quality: Option<Quality>,
    /// The only camera.
    pub camera: Option<String>,
    /// The seed.
    pub seed: Option<u64>,
}

impl From<&args::Job> for JobRequest {
    fn from(a: &args::Job) -> Self {
        Self {
            job: a.job.clone(),
            set: a.set.clone(),
            spp: a.spp,
            quality: a.quality,
            camera: a.camera.clone(),
            seed: a.seed,
        }
    }
}

impl JobRequest {
    /// Reads, checks and compiles, on the pool's threads.
    pub fn plan(&self, pool: &rayon::ThreadPool) -> Result<Plan, Failure> {
        pool.install(|| self.compiled())
    }

    fn compiled(&self) -> Result<Plan, Failure> {
        let overrides = Overrides::new(&self.set);
        let description =
            Description::load(&self.job, &read_text, &overrides).map_err(|f| Failure::inputs(f.list()))?;
        let assets = load_assets(&description.assets()).map_err(Failure::inputs)?;
        let plan = compile(&description, &assets, &self.choices()).map_err(Failure::inputs)?;
        self.narrowed(plan)
    }

    fn choices(&self) -> Choices {
        let quality = self.quality.map(|quality| match quality {
            Quality::Draft => etendue_pipeline::Quality::Draft,
            Quality::Standard => etendue_pipeline::Quality::Standard,
            Quality::Reference => etendue_pipeline::Quality::Reference,
        });
        Choices { spp: self.spp, quality, seed: self.seed }
    }

    /// Only the camera that was asked for. Its random addresses are those it has among all.
    fn narrowed(&self, mut plan: Plan) -> Result<Plan, Failure> {
        let Some(name) = &self.camera else { return Ok(plan) };
        if plan.camera(name).is_none() {
            let known: Vec<&str> = plan.cameras.iter().map(|c| c.name.as_str()).collect();
            return Err(Failure::input(format!(
                "--camera {name}: {} has no camera of that name; give one of {}",
                self.job.display(),
                known.join(", ")
            )));
        }
        plan.cameras.retain(|camera| camera.name == *name);
        Ok(plan)
    }
}

/// The text of a file that the command line names.
pub fn text_of(path: &Path) -> Result<String, Failure> {
    read_text(path).map_err(|why| Failure::input(format!("{}: {why}", path.display())))
}

/// Reads a text file; the error says in a few words why it cannot.
pub fn read_text(path: &Path) -> Result<String, String> {
    std::fs::read_to_string(path).map_err(|error| match error.kind() {
        std::io::ErrorKind::NotFound => "there is no such file".to_owned(),
        std::io::ErrorKind::InvalidData => "it is no text (UTF-8)".to_owned(),
        std::io::ErrorKind::IsADirectory => "it is a folder; name a file in it".to_owned(),
        _ => error.to_string(),
    })
}
