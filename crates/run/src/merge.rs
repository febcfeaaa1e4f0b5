//! The shards of one job to the result of an unsharded run.

use crate::delivery::{SoFar, deliver};
use crate::film_file::FilmOrigin;
use crate::render_options::RenderOptions;
use crate::results::{DoneFrames, Kept, Sequence};
use crate::rig;
use crate::shard::{self, Manifest};
use etendue_core::observer::Observer;
use etendue_io::failure::{Error, ErrorCode};
use etendue_io::{Existing, OutputFolder};
use etendue_pipeline::Plan;
use etendue_pipeline::film::Film;
use etendue_pipeline::plan::CameraPlan;
use etendue_pipeline::render::Shot;
use etendue_pipeline::tile::{Shard, tiles};
use etendue_tracer::accel::Simd;
use rayon::prelude::*;
use std::path::{Path, PathBuf};

/// Joins the folders of all shards of one run to the files of an unsharded one, byte for byte, and answers with their paths. `job` is where the job
/// file is now, where the shards were rendered from another place. Runs on the caller's thread pool.
///
/// # Errors
/// Where shards are missing, given twice or of different runs, the job has changed since, or the folder cannot be written.
pub fn merge(
    shards: &[PathBuf],
    job: Option<&Path>,
    simd: Simd,
    folder: &Path,
    existing: Existing,
    observer: &dyn Observer,
) -> Result<Vec<PathBuf>, Error> {
    let mut shards: Vec<(Manifest, &PathBuf)> =
        shards.iter().map(|folder| Ok((Manifest::read(folder)?, folder))).collect::<Result<_, Error>>()?;
    shards.sort_by_key(|(manifest, _)| manifest.index);
    check_complete(&shards)?;
    let mut manifest = shards[0].0.clone();
    if let Some(job) = job {
        manifest.request.job = job.to_path_buf();
    }
    let job = manifest.request.clone().into_output(folder).open()?;
    check_same_plan(job.plan(), &manifest)?;
    let mut folder = OutputFolder::open(folder, existing).map_err(Error::input)?;
    folder.claim(job.file_names(&manifest.frames).iter().map(String::as_str)).map_err(Error::input)?;
    let kept = Kept::of_run(&folder, observer);
    let options = RenderOptions { frames: manifest.frames.clone(), simd };
    let mut sequence = Sequence::default();
    let film_of = |group: &[&CameraPlan], shot, _: SoFar<'_>| joined(job.plan(), group[0], shot, &shards);
    deliver(job.shared_plan(), &options, &DoneFrames::default(), film_of, |camera| {
        sequence.write(&camera, &mut folder, observer)
    })?;
    sequence.finish(&mut folder, observer)?;
    rig::write(&rig::asked_files(job.plan(), &manifest.frames), &mut folder, observer)?;
    let written = folder.commit().map_err(Error::run)?;
    kept.all();
    Ok(written)
}

/// Every shard of one run, each once.
fn check_complete(shards: &[(Manifest, &PathBuf)]) -> Result<(), Error> {
    let Some((first, _)) = shards.first() else {
        return Err(Error::coded(ErrorCode::MissingArgument, "no shards: give the folders of all"));
    };
    for (manifest, folder) in shards {
        if !manifest.is_of_run(first) {
            return Err(refuse(folder, "it is a shard of another run; give the shards of one run"));
        }
    }
    for (expected, (manifest, folder)) in shards.iter().enumerate() {
        if manifest.index as usize != expected {
            let found = format!("shard {expected} of {} is missing or given twice; give each once", manifest.count);
            return Err(refuse(folder, &found));
        }
    }
    match shards.len() == first.count as usize {
        true => Ok(()),
        false => Err(refuse(
            shards[shards.len() - 1].1,
            &format!("{} of {} shards are given; give the folders of all", shards.len(), first.count),
        )),
    }
}

fn refuse(folder: &Path, why: &str) -> Error {
    Error::coded(ErrorCode::OtherRun, format!("{}: {why}", folder.display()))
}

fn check_same_plan(plan: &Plan, manifest: &Manifest) -> Result<(), Error> {
    if plan.hash_text() == manifest.plan_hash && shard::tile_sides(plan) == manifest.tile_px {
        return Ok(());
    }
    let job = manifest.request.job.display();
    Err(Error::coded(
        ErrorCode::OtherRun,
        format!("{job} or a file that it names has changed since the shards were rendered; render them again"),
    ))
}

/// Shards that are read side by side: each takes the memory of the whole film.
const AT_ONCE: usize = 4;

/// The film of all shards' tiles.
fn joined(plan: &Plan, camera: &CameraPlan, shot: Shot, shards: &[(Manifest, &PathBuf)]) -> Result<Film, Error> {
    let (width, height) = camera.film_size();
    let settings = &camera.settings;
    let mut film = Film::new(width as usize, height as usize, &camera.film_layout(), settings.replicates);
    let read = |(manifest, folder): &(Manifest, &PathBuf)| {
        let shard = Shard::new(manifest.index, manifest.count)
            .ok_or_else(|| refuse(folder, "its manifest is damaged; render the shard again"))?;
        shard::read(folder, &FilmOrigin { plan, camera, shot, shard }).map(|film| (shard, film))
    };
    for some in shards.chunks(AT_ONCE) {
        let parts: Vec<Result<(Shard, Film), Error>> = some.par_iter().map(read).collect();
        for part in parts {
            let (shard, part) = part?;
            tiles(width, height, settings.tile_px, shard).into_iter().for_each(|tile| film.copy_tile(tile, &part));
        }
    }
    Ok(film)
}
