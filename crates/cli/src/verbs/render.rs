//! `etendue render`: radiance, image, raw and ground truth of a job's cameras.

use crate::args;
use crate::deliver::{check_finite, deliver, names};
use crate::facts;
use crate::failure::Failure;
use crate::film_file::{self, MANIFEST, Manifest};
use crate::job::JobRequest;
use crate::machine;
use crate::progress::TileBar;
use crate::{say, tell};
use etendue_io::{Existing, OutputFolder};
use etendue_pipeline::Plan;
use etendue_pipeline::film::Film;
use etendue_pipeline::plan::CameraPlan;
use etendue_pipeline::render::{Request, light};
use etendue_pipeline::tile::Shard;

pub fn run(arguments: &args::Render) -> Result<(), Failure> {
    let request = JobRequest::from(&arguments.job);
    let simd = machine::simd()?;
    let pool = machine::pool(arguments.threads)?;
    let plan = request.plan(&pool)?;
    let mut folder = open(&arguments.output)?;
    plan.warnings().iter().for_each(|warning| tell(&format!("warning: {warning}\n")));
    match arguments.shard {
        None => {
            claim(&folder, names(&plan, &arguments.frames))?;
            for group in plan.by_light() {
                let film = pool.install(|| expose(&plan, &group, Request { simd, shard: Shard::WHOLE }))?;
                pool.install(|| deliver(&plan, &group, film, &arguments.frames, simd, &mut folder))?;
            }
        }
        Some((index, count)) => {
            let shard = Shard::new(index, count).expect("checked when the arguments were read");
            let groups = plan.by_light();
            claim(&folder, groups.iter().map(|group| film_file::film_name(group[0])).chain([MANIFEST.to_owned()]))?;
            for group in groups {
                let film = pool.install(|| expose(&plan, &group, Request { simd, shard }))?;
                check_finite(group[0], &film)?;
                let bytes = film_file::encode(&film, &facts::provenance(&plan, group[0]))?;
                folder.write(&film_file::film_name(group[0]), &bytes).map_err(Failure::run)?;
            }
            let frames = arguments.frames.clone();
            let (plan_hash, tile_px) = (plan.hash_text(), film_file::tile_sides(&plan));
            Manifest { request, frames, index, count, plan_hash, tile_px }.write(&mut folder)?;
        }
    }
    commit(folder)
}

/// The light of cameras that have the same.
fn expose(plan: &Plan, group: &[&CameraPlan], request: Request) -> Result<Film, Failure> {
    let bar = TileBar::new(&heading(group));
    let film = light(plan, group[0], request, &bar);
    bar.finish();
    film.map_err(|cancelled| Failure::Run(cancelled.to_string()))
}

fn heading(group: &[&CameraPlan]) -> String {
    match group.len() {
        1 => group[0].name.clone(),
        n => format!("{} and {} more", group[0].name, n - 1),
    }
}

/// Opens the output folder.
pub fn open(output: &args::Output) -> Result<OutputFolder, Failure> {
    let existing = if output.overwrite { Existing::Replace } else { Existing::Refuse };
    OutputFolder::open(&output.output, existing).map_err(Failure::input)
}

/// Refuses early where a result is already there.
pub fn claim(folder: &OutputFolder, names: impl IntoIterator<Item = String>) -> Result<(), Failure> {
    names.into_iter().try_for_each(|name| folder.claim([name.as_str()]).map_err(Failure::input))
}

/// Gives all results their names, and prints them.
pub fn commit(folder: OutputFolder) -> Result<(), Failure> {
    let written = folder.commit().map_err(Failure::run)?;
    say(&written.iter().map(|path| format!("{}\n", path.display())).collect::<String>());
    Ok(())
}
