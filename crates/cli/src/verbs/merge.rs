//! `etendue merge`: the shards of one job to the result of an unsharded run.

use super::render::{claim, commit, open};
use crate::args;
use crate::deliver::{deliver, names};
use crate::failure::Failure;
use crate::film_file::{self, Manifest};
use crate::machine;
use etendue_pipeline::Plan;
use etendue_pipeline::film::Film;
use etendue_pipeline::plan::CameraPlan;
use etendue_pipeline::render::layout;
use etendue_pipeline::tile::{Shard, tiles};
use std::path::{Path, PathBuf};

pub fn run(arguments: &args::Merge) -> Result<(), Failure> {
    let mut shards: Vec<(Manifest, &PathBuf)> =
        arguments.shards.iter().map(|folder| Ok((Manifest::read(folder)?, folder))).collect::<Result<_, Failure>>()?;
    shards.sort_by_key(|(manifest, _)| manifest.index);
    check_complete(&shards)?;
    let manifest = shards[0].0.clone();
    let simd = machine::simd()?;
    let pool = machine::pool(None)?;
    let plan = manifest.request.plan(&pool)?;
    check_same_plan(&plan, &manifest)?;
    let mut folder = open(&arguments.output)?;
    claim(&folder, names(&plan, &manifest.frames))?;
    for group in plan.by_light() {
        let film = joined(group[0], &shards)?;
        pool.install(|| deliver(&plan, &group, film, &manifest.frames, simd, &mut folder))?;
    }
    commit(folder)
}

/// Every shard of one run, each once.
fn check_complete(shards: &[(Manifest, &PathBuf)]) -> Result<(), Failure> {
    let first = &shards[0].0;
    for (manifest, folder) in shards {
        if !of_one_run(manifest, first) {
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

/// Whether two shards were cut from one run: the same plan, cameras, frames and tiles.
fn of_one_run(a: &Manifest, b: &Manifest) -> bool {
    let cut = |m: &Manifest| (m.plan_hash.clone(), m.count, m.frames.clone(), m.tile_px.clone());
    cut(a) == cut(b) && a.request.camera == b.request.camera
}

fn refuse(folder: &Path, why: &str) -> Failure {
    Failure::input(format!("{}: {why}", folder.display()))
}

fn check_same_plan(plan: &Plan, manifest: &Manifest) -> Result<(), Failure> {
    if plan.hash_text() == manifest.plan_hash && film_file::tile_sides(plan) == manifest.tile_px {
        return Ok(());
    }
    let job = manifest.request.job.display();
    Err(Failure::input(format!(
        "{job} or a file that it names has changed since the shards were rendered; render them again"
    )))
}

/// The film of all shards' tiles.
fn joined(camera: &CameraPlan, shards: &[(Manifest, &PathBuf)]) -> Result<Film, Failure> {
    let (width, height) = camera.film_size();
    let settings = &camera.settings;
    let mut film = Film::new(width as usize, height as usize, &layout(camera), settings.spp, settings.replicates);
    for (manifest, folder) in shards {
        let part = film_file::read(folder, camera)?;
        let shard = Shard::new(manifest.index, manifest.count)
            .ok_or_else(|| refuse(folder, "its manifest is damaged; render the shard again"))?;
        tiles(width, height, settings.tile_px, shard).into_iter().for_each(|tile| film.copy_tile(tile, &part));
    }
    Ok(film)
}
