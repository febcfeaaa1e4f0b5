//! From a job file and the command line to a plan.

use crate::args;
use crate::failure::Failure;
use crate::trade::{Integrator, Quality};
use etendue_io::{load_assets, read_regular};
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
    pub spp: Option<u64>,
    /// How much of the light's ways is followed.
    pub integrator: Option<Integrator>,
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
            integrator: a.integrator,
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
        let description =
            Description::load(&self.job, &read_text, &self.overrides()).map_err(|f| Failure::inputs(f.list()))?;
        let assets = load_assets(&description.assets()).map_err(Failure::inputs)?;
        let plan = compile(&description, &assets, &self.choices()).map_err(Failure::inputs)?;
        plan.notices.iter().for_each(|notice| crate::tell(&format!("note: {notice}\n")));
        self.narrowed(plan)
    }

    /// The changes to the description: a flag goes through the same check as its key.
    fn overrides(&self) -> Overrides {
        let mut overrides = Overrides::new(&self.set);
        let mut flag = |name: &str, key, value: String, shown: &str| {
            overrides.push_render(&format!("--{name} {shown}"), key, &value);
        };
        if let Some(spp) = self.spp {
            flag("spp", "spp", spp.to_string(), &spp.to_string());
        }
        if let Some(seed) = self.seed {
            flag("seed", "seed", seed.to_string(), &seed.to_string());
        }
        if let Some(integrator) = self.integrator {
            let level = integrator.level();
            flag("integrator", "level", format!("\"{level}\""), level);
        }
        overrides
    }

    fn choices(&self) -> Choices {
        let quality = self.quality.map(|quality| match quality {
            Quality::Draft => etendue_pipeline::Quality::Draft,
            Quality::Standard => etendue_pipeline::Quality::Standard,
            Quality::Reference => etendue_pipeline::Quality::Reference,
        });
        Choices { quality }
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
    let bytes = read_regular(path).map_err(|error| match error.kind() {
        std::io::ErrorKind::NotFound => "there is no such file".to_owned(),
        std::io::ErrorKind::IsADirectory => "it is a folder; name a file in it".to_owned(),
        _ => error.to_string(),
    })?;
    String::from_utf8(bytes).map_err(|_| "it is no text (UTF-8)".to_owned())
}
