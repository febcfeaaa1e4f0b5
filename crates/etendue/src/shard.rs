//! Shards on disk: a manifest beside one film a camera.
//!
//! A film's planes hold the shard's tiles; the other pixels are zero. `merge` makes the plan again from the manifest
//! and refuses shards of another plan.

use crate::camera_file::read_text;
use crate::delivery::shots_of;
use crate::error::Error;
use crate::film_file::{self, film_name};
use crate::job::{Job, JobRequest};
use crate::observer::Observer;
use crate::results::writer::write_exr;
use crate::results::{Kept, metadata};
use crate::shard_spec::ShardSpec;
use etendue_io::{Existing, OutputFolder, sidecar};
use etendue_pipeline::Plan;
use etendue_pipeline::film::Film;
use etendue_pipeline::plan::CameraPlan;
use etendue_pipeline::render::Shot;
use etendue_tracer::accel::Simd;
use std::ops::Range;
use std::path::{Path, PathBuf};

impl Job {
    /// The names of the files of a shard, relative to its folder.
    fn shard_names(&self, frames: &Range<u32>) -> Vec<String> {
        let groups = self.plan().by_light();
        let of_group = |group: &Vec<&CameraPlan>| {
            shots_of(group[0], frames).into_iter().map(|shot| film_name(group[0], shot)).collect::<Vec<_>>()
        };
        let films = groups.iter().flat_map(of_group);
        films.chain([MANIFEST.to_owned()]).collect()
    }

    /// Renders one shard of a run over `frames` into a folder, for [`merge`](crate::merge::merge), and answers with the paths of
    /// its files. Runs on the caller's thread pool.
    ///
    /// # Errors
    /// Where the observer cancels, light is not finite, or the folder cannot be written.
    pub fn save_shard(
        &self,
        spec: ShardSpec,
        frames: Range<u32>,
        simd: Simd,
        (folder, existing): (&Path, Existing),
        observer: &dyn Observer,
    ) -> Result<Vec<PathBuf>, Error> {
        if self.request().progressive || self.request().time_s.is_some() {
            return Err(Error::input(
                "a shard is rendered in the passes of its job: give them by the key render.passes in the place of --progressive or --time",
            ));
        }
        let (request, plan_hash, tile_px) = (self.request().clone(), self.plan().hash_text(), tile_sides(self.plan()));
        let ShardSpec { index, count } = spec;
        let manifest = Manifest { request, frames: frames.clone(), index, count, plan_hash, tile_px }.encoded()?;
        let mut folder = OutputFolder::open(folder, existing).map_err(Error::input)?;
        folder.claim(self.shard_names(&frames).iter().map(String::as_str)).map_err(Error::input)?;
        let kept = Kept::of_run(&folder, observer);
        self.render_shard((spec, &frames), simd, observer, |camera, shot, film| {
            let facts = metadata::provenance(self.plan(), camera, shot.frame);
            write_exr(&mut folder, &film_name(camera, shot), film_file::image(&film, &facts))
        })?;
        folder.write(MANIFEST, &manifest).map_err(Error::run)?;
        let written = folder.commit().map_err(Error::run)?;
        kept.all();
        Ok(written)
    }
}

/// The name of a shard's manifest in its folder.
const MANIFEST: &str = "shard.json";

/// What a shard is part of.
#[derive(Clone, Debug, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Manifest {
    /// The job, so that the plan can be made again.
    pub(crate) request: JobRequest,
    /// Frames to take of the whole.
    pub(crate) frames: std::ops::Range<u32>,
    /// Which shard.
    pub(crate) index: u32,
    /// Of how many.
    pub(crate) count: u32,
    /// The plan's hash.
    pub(crate) plan_hash: String,
    /// Side of each camera's tiles, px: the plan's hash leaves it out, but it says which pixels are whose.
    pub(crate) tile_px: Vec<u32>,
}

/// The sides of the tiles of a plan's cameras.
pub(crate) fn tile_sides(plan: &Plan) -> Vec<u32> {
    plan.cameras.iter().map(|camera| camera.settings.tile_px).collect()
}

impl Manifest {
    /// Reads the manifest of a shard's folder.
    pub(crate) fn read(folder: &Path) -> Result<Self, Error> {
        let path = folder.join(MANIFEST);
        let explain =
            |why: String| Error::input(format!("{}: {why}; give folders made by render --shard", path.display()));
        let text = read_text(&path).map_err(explain)?;
        serde_json::from_str(&text)
            .map_err(|error| explain(format!("this is no shard manifest of this version ({error})")))
    }

    /// The bytes of the file; refused where a path is no text.
    fn encoded(&self) -> Result<Vec<u8>, Error> {
        sidecar::encode(self).map_err(|error| {
            let job = self.request.job.display();
            Error::input(format!(
                "{job}: the manifest of a shard is text: {error}; expected paths in UTF-8: rename the folder or file"
            ))
        })
    }
}

/// The film of a camera of the plan, from a shard's folder.
pub(crate) fn read(folder: &Path, camera: &CameraPlan, shot: Shot) -> Result<Film, Error> {
    let path = folder.join(film_name(camera, shot));
    let (film, _) = film_file::read(&path, camera)?.ok_or_else(|| {
        Error::input(format!(
            "{}: this is not the film of camera {}; render the shard again",
            path.display(),
            camera.name
        ))
    })?;
    Ok(film)
}
