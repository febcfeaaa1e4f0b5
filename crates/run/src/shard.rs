//! Shards on disk, with a manifest and one film per camera, and the merged result.
//!
//! A film's planes hold the shard's tiles; the other pixels are zero. `merge` makes the plan again from the manifest and refuses shards of another plan.

use crate::film_file::{self, FilmOrigin, film_name};
use crate::job::Job;
use crate::job_request::{JobRequest, RenderOptions};
use crate::results::writer::write_exr;
use crate::run::Run;
use crate::run::films::shots_of;
use crate::run::store::{InterruptionNote, NoStore, RunFolder, RunStore, StoredLight};
use etendue_arguments::MAX_FRAMES;
use etendue_core::observer::Observer;
use etendue_io::failure::{Error, ErrorCode};
use etendue_io::source::read_text;
use etendue_io::{ExistingFiles, OutputFolder, sidecar};
use etendue_pipeline::Plan;
use etendue_pipeline::film::Film;
use etendue_pipeline::plan::CameraPlan;
use etendue_pipeline::tile::{Shard, tiles};
use etendue_tracer::accel::Simd;
use rayon::prelude::*;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::str::FromStr;

/// A shard of a run: every tile whose number is `index` modulo `count`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ShardSpec {
    /// Index of the shard, from 0.
    pub index: u32,
    /// Number of shards.
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
        let message = || {
            Error::coded(
                ErrorCode::OutOfRange,
                format!("shard {}/{}: expected an index below the count", self.index, self.count),
            )
        };
        Shard::new(self.index, self.count).ok_or_else(message)
    }
}

/// Part of a shard that one call renders.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ShardRequest {
    /// The tiles.
    pub spec: ShardSpec,
    /// Frames of the whole run.
    pub frames: Range<u32>,
    /// Films of the shard to render, by the [names of their files](crate::Job::film_names); empty: all of them.
    pub films: Vec<String>,
}

impl ShardRequest {
    /// All films of a shard.
    #[must_use]
    pub fn all_films(spec: ShardSpec, frames: Range<u32>) -> Self {
        Self { spec, frames, films: Vec::new() }
    }
}

impl Job {
    /// Names of the films of a shard, relative to its folder: one for each group of cameras of equal light, named after the first of these; where light
    /// depends on time, one for each frame and for each capture with its own light.
    #[must_use]
    pub fn film_names(&self, frames: &Range<u32>) -> Vec<String> {
        let mut names = Vec::new();
        for group in self.plan().by_light() {
            names
                .extend(shots_of(group[0], frames).into_iter().map(|frame_capture| film_name(group[0], frame_capture)));
        }
        names
    }

    /// Renders one shard of a run, or some of its films, into a folder for [`merge`], and returns the paths of its files. Films
    /// that are rendered separately share one folder. Runs on the caller's thread pool.
    ///
    /// # Errors
    /// A film is not one of the job's, the observer cancels, light is not finite, or the folder cannot be written.
    pub fn save_shard(
        &self,
        request: &ShardRequest,
        simd: Simd,
        folder: &Path,
        existing: ExistingFiles,
        observer: &dyn Observer,
    ) -> Result<Vec<PathBuf>, Error> {
        if self.request().progressive || self.request().time_s.is_some() {
            return Err(Error::coded(
                ErrorCode::Contradiction,
                "a shard is rendered in the passes of its job: set render.passes instead of `progressive` or `time_s`",
            ));
        }
        let names = self.requested_films(request)?;
        let manifest = self.manifest(request);
        // The manifest of an earlier film of the same shard is equal.
        let is_there = !request.films.is_empty() && manifest.has_films(folder)?;
        let manifest = if is_there { None } else { Some(manifest.to_bytes()?) };
        let mut folder = OutputFolder::open(folder, existing).map_err(Error::input)?;
        folder
            .claim(names.iter().map(String::as_str).chain(manifest.as_ref().map(|_| MANIFEST)))
            .map_err(Error::input)?;
        let mut interruption = InterruptionNote::new(&folder, observer);
        let shard = request.spec.shard()?;
        self.warn(observer);
        self.check_shard_memory()?;
        let options = RenderOptions { frames: request.frames.clone(), simd };
        let is_requested = |camera: &CameraPlan, frame_capture| names.contains(&film_name(camera, frame_capture));
        let mut run = Run::for_shard(self.shared_plan(), &options, shard, is_requested, observer)?;
        while let Some((origin, film)) = run.next_film(&mut NoStore)? {
            let name = film_name(origin.camera, origin.frame_capture);
            write_exr(&mut folder, &name, film_file::image(&film, &origin.facts()))?;
        }
        if let Some(manifest) = &manifest {
            folder.write(MANIFEST, manifest).map_err(Error::run)?;
        }
        let written = folder.commit().map_err(Error::run)?;
        interruption.is_complete = true;
        Ok(written)
    }

    /// Names of the films that a request selects.
    ///
    /// # Errors
    /// A name is not one of the job's films.
    fn requested_films(&self, request: &ShardRequest) -> Result<Vec<String>, Error> {
        let mut names = self.film_names(&request.frames);
        if let Some(unknown) = request.films.iter().find(|name| !names.contains(name)) {
            let some = names.iter().take(MAX_NAMED_FILMS).cloned().collect::<Vec<_>>().join(", ");
            let more = names
                .len()
                .checked_sub(MAX_NAMED_FILMS + 1)
                .map(|n| format!(" and {} more", n + 1))
                .unwrap_or_default();
            return Err(Error::argument(
                "films",
                format!("`films` {unknown}: no film of these frames; available: {some}{more}"),
            )
            .with_code(ErrorCode::UnknownName));
        }
        names.retain(|name| request.films.is_empty() || request.films.contains(name));
        Ok(names)
    }

    fn manifest(&self, request: &ShardRequest) -> Manifest {
        let ShardSpec { index, count } = request.spec;
        Manifest {
            request: self.request().clone(),
            frames: request.frames.clone(),
            index,
            count,
            plan_hash: self.plan().hash_text(),
            tile_px: tile_sides(self.plan()),
        }
    }
}

/// Maximum number of films named in a message.
const MAX_NAMED_FILMS: usize = 6;

/// File name of a shard's manifest in its folder.
const MANIFEST: &str = "shard.json";

/// Description of a shard and its run.
#[derive(Clone, Debug, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
struct Manifest {
    /// The job, from which the plan is made again.
    request: JobRequest,
    /// Frames of the whole run.
    frames: Range<u32>,
    /// Index of the shard.
    index: u32,
    /// Number of shards.
    count: u32,
    /// The plan's hash.
    plan_hash: String,
    /// Side of each camera's tiles, px: not part of the plan's hash, but it determines the pixels of each shard.
    tile_px: Vec<u32>,
}

/// Tile sides of a plan's cameras.
fn tile_sides(plan: &Plan) -> Vec<u32> {
    plan.cameras.iter().map(|camera| camera.settings.tile_px).collect()
}

impl Manifest {
    /// Reads the manifest of a shard's folder.
    fn read(folder: &Path) -> Result<Self, Error> {
        let path = folder.join(MANIFEST);
        let explain = |why: String| {
            Error::coded(
                ErrorCode::OtherRun,
                format!("{}: {why}; give folders written by render `shard`", path.display()),
            )
        };
        let text = read_text(&path).map_err(|problem| explain(problem.words).with_code(problem.code))?;
        let manifest: Self = serde_json::from_str(&text)
            .map_err(|error| explain(format!("this is not a shard manifest of this version ({error})")))?;
        match manifest.manifest_error() {
            Some(why) => Err(explain(why)),
            None => Ok(manifest),
        }
    }

    /// Describes an error that no valid manifest has.
    fn manifest_error(&self) -> Option<String> {
        let Self { index, count, frames, tile_px, .. } = self;
        if index >= count {
            return Some(format!("it states shard {index} of {count}; expected a number below the count"));
        }
        if frames.is_empty() || frames.len() > MAX_FRAMES {
            let (start, end) = (frames.start, frames.end);
            return Some(format!("it states frames {start}..{end}; expected 1 to {MAX_FRAMES} frames"));
        }
        let is_tiled = !tile_px.is_empty() && tile_px.iter().all(|side| *side > 0);
        (!is_tiled).then(|| "it states no tile sizes above 0".to_owned())
    }

    /// Returns true if films of this shard are in the folder; refuses a folder of another shard, because films that are rendered separately belong together.
    fn has_films(&self, folder: &Path) -> Result<bool, Error> {
        let path = folder.join(MANIFEST);
        if !path.exists() {
            return Ok(false);
        }
        let there = Self::read(folder)?;
        match there.index == self.index && there.is_same_run(self) {
            true => Ok(true),
            false => Err(Error::coded(
                ErrorCode::OtherRun,
                format!(
                    "{}: this folder contains films of another run or shard; choose another output folder, or render the whole shard",
                    path.display()
                ),
            )),
        }
    }

    /// Returns true if two shards are of one run: the same plan, cameras, frames and tiles.
    fn is_same_run(&self, other: &Self) -> bool {
        let run_key = |m: &Self| (m.plan_hash.clone(), m.count, m.frames.clone(), m.tile_px.clone());
        run_key(self) == run_key(other) && self.request.camera == other.request.camera
    }

    /// Bytes of the file.
    ///
    /// # Errors
    /// A path is not valid text.
    fn to_bytes(&self) -> Result<Vec<u8>, Error> {
        sidecar::encode(self).map_err(|error| {
            let job = self.request.job.display();
            Error::coded(ErrorCode::InvalidArgument, format!(
                "{job}: the manifest of a shard is text: {error}; expected paths in UTF-8: rename the folder or file"
            ))
        })
    }
}

/// Merges the folders of all shards of one run into the files of an unsharded run, byte for byte, and returns their paths. `job` is the current path of the
/// job file, if the shards were rendered elsewhere. Runs on the caller's thread pool.
///
/// # Errors
/// Shards are missing, given twice or of different runs, the job has changed, or the folder cannot be written.
pub fn merge(
    shards: &[PathBuf],
    job: Option<&Path>,
    simd: Simd,
    folder: &Path,
    existing: ExistingFiles,
    observer: &dyn Observer,
) -> Result<Vec<PathBuf>, Error> {
    let mut shards = MergedShards::read(shards)?;
    let mut manifest = shards.shards[0].manifest.clone();
    if let Some(job) = job {
        manifest.request.job = job.to_path_buf();
    }
    let job = manifest.request.clone().into_output(folder).open()?;
    check_same_plan(job.plan(), &manifest)?;
    let options = RenderOptions { frames: manifest.frames, simd };
    let mut folder = RunFolder::for_shards(job.shared_plan(), &options, folder, existing, observer)?;
    let mut run = Run::new(job.shared_plan(), &options, None, observer)?;
    while let Some(results) = run.next_camera_results(&mut shards)? {
        folder.write(&results)?;
    }
    folder.finish()
}

/// The folder of a shard.
struct ShardFolder<'a> {
    manifest: Manifest,
    path: &'a Path,
}

impl ShardFolder<'_> {
    fn error(&self, why: &str) -> Error {
        Error::coded(ErrorCode::OtherRun, format!("{}: {why}", self.path.display()))
    }

    /// Reads the shard's part of a film.
    fn film(&self, expected: &FilmOrigin<'_>) -> Result<(Shard, Film), Error> {
        let shard = Shard::new(self.manifest.index, self.manifest.count);
        let shard = shard.ok_or_else(|| self.error("its manifest is damaged; render the shard again"))?;
        let path = self.path.join(film_name(expected.camera, expected.frame_capture));
        let (film, _) = film_file::read(&path, &FilmOrigin { shard, ..*expected }, "render the shard again")?;
        Ok((shard, film))
    }
}

/// All shards of one run, each once, in order: the light of a run that merges them.
struct MergedShards<'a> {
    shards: Vec<ShardFolder<'a>>,
}

/// Number of shards read in parallel: each takes the memory of the whole film.
const PARALLEL_SHARDS: usize = 4;

impl<'a> MergedShards<'a> {
    /// Reads the manifests of shards.
    ///
    /// # Errors
    /// A manifest cannot be read, or a shard is missing, given twice or of another run.
    fn read(folders: &'a [PathBuf]) -> Result<Self, Error> {
        let read = |path: &'a PathBuf| Ok(ShardFolder { manifest: Manifest::read(path)?, path });
        let mut shards: Vec<ShardFolder<'_>> = folders.iter().map(read).collect::<Result<_, Error>>()?;
        shards.sort_by_key(|shard| shard.manifest.index);
        let (Some(first), Some(last)) = (shards.first(), shards.last()) else {
            return Err(Error::coded(ErrorCode::MissingArgument, "no shards: give the folders of all shards"));
        };
        if let Some(other) = shards.iter().find(|shard| !shard.manifest.is_same_run(&first.manifest)) {
            return Err(other.error("it is a shard of another run; give the shards of one run"));
        }
        let count = first.manifest.count;
        for (expected, shard) in shards.iter().enumerate() {
            if shard.manifest.index as usize != expected {
                let missing = format!("shard {expected} of {count} is missing or given twice; give each once");
                return Err(shard.error(&missing));
            }
        }
        if shards.len() != count as usize {
            let problem = format!("{} of {count} shards are given; give the folders of all shards", shards.len());
            return Err(last.error(&problem));
        }
        Ok(Self { shards })
    }
}

impl RunStore for MergedShards<'_> {
    /// Returns the film with the tiles of all shards.
    fn light(&self, expected: &FilmOrigin<'_>) -> Result<StoredLight, Error> {
        let camera = expected.camera;
        let (width, height) = camera.film_size();
        let settings = &camera.settings;
        let mut film = Film::new(width as usize, height as usize, &camera.film_layout(), settings.replicates);
        for some in self.shards.chunks(PARALLEL_SHARDS) {
            let parts: Vec<Result<_, Error>> = some.par_iter().map(|shard| shard.film(expected)).collect();
            for part in parts {
                let (shard, part) = part?;
                tiles(width, height, settings.tile_px, shard).into_iter().for_each(|tile| film.copy_tile(tile, &part));
            }
        }
        Ok(StoredLight::Complete(film))
    }
}

fn check_same_plan(plan: &Plan, manifest: &Manifest) -> Result<(), Error> {
    if plan.hash_text() == manifest.plan_hash && tile_sides(plan) == manifest.tile_px {
        return Ok(());
    }
    let job = manifest.request.job.display();
    Err(Error::coded(
        ErrorCode::OtherRun,
        format!("{job} or a file that it names has changed since the shards were rendered; render them again"),
    ))
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
