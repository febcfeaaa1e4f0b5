//! Shards on disk: a manifest beside one film a camera.
//!
//! A film's planes hold the shard's tiles; the other pixels are zero. `merge` makes the plan again from the manifest
//! and refuses shards of another plan.

use crate::delivery::{check_finite, check_frames, shots_of};
use crate::exposures::Exposures;
use crate::film_file::{self, FilmOrigin};
use crate::film_names::film_name;
use crate::job::Job;
use crate::job_request::JobRequest;
use crate::results::Kept;
use crate::results::writer::write_exr;
use crate::shard_spec::{ShardRequest, ShardSpec};
use etendue_arguments::MAX_FRAMES;
use etendue_core::observer::Observer;
use etendue_io::failure::{Error, ErrorCode};
use etendue_io::source::read_text;
use etendue_io::{Existing, OutputFolder, sidecar};
use etendue_pipeline::Plan;
use etendue_pipeline::film::Film;
use etendue_pipeline::plan::CameraPlan;
use etendue_pipeline::render::Shot;
use etendue_tracer::accel::Simd;
use std::ops::Range;
use std::path::{Path, PathBuf};

impl Job {
    /// The names of the films of a shard, relative to its folder: one for each group of cameras of equal light, called after the first of these; where
    /// light depends on time, of each of the frames and of each capture that has a light of its own.
    #[must_use]
    pub fn film_names(&self, frames: &Range<u32>) -> Vec<String> {
        self.films(frames).map(|(group, shot)| film_name(group[0], shot)).collect()
    }

    /// Renders one shard of a run into a folder, or some of its films, for [`merge`](crate::merge::merge), and answers with the paths of its files. Films
    /// that were rendered each by itself go to one folder. Runs on the caller's thread pool.
    ///
    /// # Errors
    /// Where a film is none of the job's, the observer cancels, light is not finite, or the folder cannot be written.
    pub fn save_shard(
        &self,
        asked: &ShardRequest,
        simd: Simd,
        folder: &Path,
        existing: Existing,
        observer: &dyn Observer,
    ) -> Result<Vec<PathBuf>, Error> {
        if self.request().progressive || self.request().time_s.is_some() {
            return Err(Error::coded(
                ErrorCode::Contradiction,
                "a shard is rendered in the passes of its job: give them by the key render.passes in the place of `progressive` or `time_s`",
            ));
        }
        let names = self.asked_films(asked)?;
        let manifest = self.manifest(asked);
        // That of a film of the same shard before says the same.
        let is_there = !asked.films.is_empty() && manifest.is_beside(folder)?;
        let manifest = if is_there { None } else { Some(manifest.encoded()?) };
        let mut folder = OutputFolder::open(folder, existing).map_err(Error::input)?;
        folder
            .claim(names.iter().map(String::as_str).chain(manifest.as_ref().map(|_| MANIFEST)))
            .map_err(Error::input)?;
        let kept = Kept::of_run(&folder, observer);
        self.render_shard((asked, &names), simd, observer, |camera, shot, film| {
            let origin = FilmOrigin { plan: self.plan(), camera, shot, shard: asked.spec.shard()? };
            write_exr(&mut folder, &film_name(camera, shot), film_file::image(&film, &origin.facts()))
        })?;
        if let Some(manifest) = &manifest {
            folder.write(MANIFEST, manifest).map_err(Error::run)?;
        }
        let written = folder.commit().map_err(Error::run)?;
        kept.all();
        Ok(written)
    }

    /// The films of a run: cameras of equal light, and which of their pictures.
    fn films<'a>(&'a self, frames: &'a Range<u32>) -> impl Iterator<Item = (Vec<&'a CameraPlan>, Shot)> {
        let groups = self.plan().by_light().into_iter();
        groups.flat_map(|group| shots_of(group[0], frames).into_iter().map(move |shot| (group.clone(), shot)))
    }

    /// The names of the films that a request asks for; refused where one is none of the job's.
    fn asked_films(&self, asked: &ShardRequest) -> Result<Vec<String>, Error> {
        let mut names = self.film_names(&asked.frames);
        if let Some(unknown) = asked.films.iter().find(|name| !names.contains(name)) {
            let some = names.iter().take(MAX_TOLD).cloned().collect::<Vec<_>>().join(", ");
            let more =
                names.len().checked_sub(MAX_TOLD + 1).map(|n| format!(" and {} more", n + 1)).unwrap_or_default();
            return Err(Error::argument(
                "films",
                format!("`films` {unknown}: no film of these frames; there are {some}{more}"),
            )
            .with_code(ErrorCode::UnknownName));
        }
        names.retain(|name| asked.films.is_empty() || asked.films.contains(name));
        Ok(names)
    }

    fn manifest(&self, asked: &ShardRequest) -> Manifest {
        let ShardSpec { index, count } = asked.spec;
        Manifest {
            request: self.request().clone(),
            frames: asked.frames.clone(),
            index,
            count,
            plan_hash: self.plan().hash_text(),
            tile_px: tile_sides(self.plan()),
        }
    }

    /// Renders the tiles of one shard: the films of these names, each with the first camera of its group.
    fn render_shard(
        &self,
        (asked, names): (&ShardRequest, &[String]),
        simd: Simd,
        observer: &dyn Observer,
        mut take: impl FnMut(&CameraPlan, Shot, Film) -> Result<(), Error>,
    ) -> Result<(), Error> {
        let (plan, frames, shard) = (self.plan(), &asked.frames, asked.spec.shard()?);
        self.warn(observer);
        self.check_shard_memory()?;
        check_frames(plan, frames)?;
        let films: Vec<_> =
            self.films(frames).filter(|(group, shot)| names.contains(&film_name(group[0], *shot))).collect();
        let cameras = films.iter().map(|(group, _)| group[0]);
        let mut exposures = Exposures::new((plan, frames), cameras, (shard, simd), observer);
        for (group, shot) in &films {
            let film = exposures.film((group, *shot), None, |_, _| Ok(()))?;
            check_finite(group[0], &film)?;
            take(group[0], *shot, film)?;
        }
        Ok(())
    }
}

/// Films that a message names at most.
const MAX_TOLD: usize = 6;

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
        let explain = |why: String| {
            Error::coded(ErrorCode::OtherRun, format!("{}: {why}; give folders made by render `shard`", path.display()))
        };
        let text = read_text(&path).map_err(|problem| explain(problem.words))?;
        let manifest: Self = serde_json::from_str(&text)
            .map_err(|error| explain(format!("this is no shard manifest of this version ({error})")))?;
        match manifest.fault() {
            Some(why) => Err(explain(why)),
            None => Ok(manifest),
        }
    }

    /// What no shard that was rendered states, in words.
    fn fault(&self) -> Option<String> {
        let Self { index, count, frames, tile_px, .. } = self;
        if index >= count {
            return Some(format!("it states shard {index} of {count}, where a number below the count is expected"));
        }
        if frames.is_empty() || frames.len() > MAX_FRAMES {
            let (start, end) = (frames.start, frames.end);
            return Some(format!("it states frames {start}..{end}, where 1 to {MAX_FRAMES} frames are expected"));
        }
        let is_tiled = !tile_px.is_empty() && tile_px.iter().all(|side| *side > 0);
        (!is_tiled).then(|| "it states no sides of tiles above 0".to_owned())
    }

    /// Whether films of this shard are there; refuses a folder of another: films that were rendered each by itself belong together.
    fn is_beside(&self, folder: &Path) -> Result<bool, Error> {
        let path = folder.join(MANIFEST);
        if !path.exists() {
            return Ok(false);
        }
        let there = Self::read(folder)?;
        match there.index == self.index && there.is_of_run(self) {
            true => Ok(true),
            false => Err(Error::coded(
                ErrorCode::OtherRun,
                format!(
                    "{}: films of another run or shard are here; choose another output folder, or render the whole shard",
                    path.display()
                ),
            )),
        }
    }

    /// Whether two shards were cut from one run: the same plan, cameras, frames and tiles.
    pub(crate) fn is_of_run(&self, other: &Self) -> bool {
        let cut = |m: &Self| (m.plan_hash.clone(), m.count, m.frames.clone(), m.tile_px.clone());
        cut(self) == cut(other) && self.request.camera == other.request.camera
    }

    /// The bytes of the file; refused where a path is no text.
    fn encoded(&self) -> Result<Vec<u8>, Error> {
        sidecar::encode(self).map_err(|error| {
            let job = self.request.job.display();
            Error::coded(ErrorCode::InvalidArgument, format!(
                "{job}: the manifest of a shard is text: {error}; expected paths in UTF-8: rename the folder or file"
            ))
        })
    }
}

/// A film of a shard, from its folder.
pub(crate) fn read(folder: &Path, origin: &FilmOrigin<'_>) -> Result<Film, Error> {
    let path = folder.join(film_name(origin.camera, origin.shot));
    film_file::read(&path, origin, "render the shard again").map(|(film, _)| film)
}
