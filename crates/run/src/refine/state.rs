//! The state of a progressive run: its films so far, in a folder beside the results.
//!
//! A file a film, named as a shard's and replaced as a whole after each pass, whose header says of which plan it is and which passes it
//! holds. A run that is killed at any moment finds the last whole pass; at the end of a run there is no state.

use crate::film_file::{self, FilmOrigin};
use crate::film_names::{FILM, STATE_FOLDER, film_name, holds_state};
use crate::results::writer::write_exr;
use etendue_io::failure::{Error, ErrorCode};
use etendue_io::{Existing, OutputFolder};
use etendue_pipeline::Plan;
use etendue_pipeline::film::Film;
use etendue_pipeline::plan::{CameraPlan, Passes};
use etendue_pipeline::render::Shot;
use etendue_pipeline::tile::Shard;
use std::path::Path;

/// Facts of a film of a state.
const PASSES: &str = "passes_done";
const REPLICATES: &str = "passes_replicates";
const SECONDS: &str = "passes_s";

/// A film after some of its passes.
#[derive(Clone, Debug)]
pub(crate) struct KeptFilm {
    /// The film.
    pub(crate) film: Film,
    /// What it holds.
    pub(crate) passes: Passes,
    /// Replicates of each of them.
    pub(crate) replicates: u32,
    /// Time that the run had taken, s, where a time decides the passes.
    pub(crate) elapsed_s: f64,
}

/// The name, within an output folder, of the state of a film.
pub(crate) fn name(camera: &CameraPlan, shot: Shot) -> String {
    format!("{STATE_FOLDER}/{}", film_name(camera, shot))
}

/// Removes the state in an output folder: the films, and their folder where nothing else is in it.
///
/// # Errors
/// Where a link is in the place of the folder, or a film cannot be removed.
pub(crate) fn remove(folder: &OutputFolder) -> Result<(), etendue_io::Error> {
    let films = folder.files_in(STATE_FOLDER)?;
    folder.remove(films.iter().map(String::as_str).filter(|name| name.ends_with(FILM)))
}

/// Refuses a folder that holds the state of another run, where the run may neither go on with it nor replace it, and a link in the place of the state.
pub(crate) fn check(folder: &OutputFolder, existing: Existing) -> Result<(), Error> {
    folder.files_in(STATE_FOLDER).map_err(Error::input)?;
    if existing != Existing::Refuse || !holds_state(folder.path()) {
        return Ok(());
    }
    Err(Error::coded(
        ErrorCode::OtherRun,
        format!(
            "{}: a run that was interrupted left its state here; go on with `resume`, or begin anew with `overwrite`",
            folder.path().join(STATE_FOLDER).display()
        ),
    ))
}

/// The film that an interrupted run of the plan left in an output folder; `None` where there is none.
///
/// # Errors
/// Where it is of another plan, or cannot be read.
pub(crate) fn read(folder: &Path, plan: &Plan, camera: &CameraPlan, shot: Shot) -> Result<Option<KeptFilm>, Error> {
    let path = folder.join(name(camera, shot));
    if !path.exists() {
        return Ok(None);
    }
    let origin = FilmOrigin { plan, camera, shot, shard: Shard::WHOLE };
    let remedy = "resume with the same options, choose another output folder, or `overwrite` it";
    let (film, facts) = film_file::read(&path, &origin, remedy)?;
    let fact = |name: &str| facts.further.get(name);
    let replicates = fact(REPLICATES).and_then(|text| text.parse().ok());
    let passes = fact(PASSES).zip(replicates).and_then(|(text, replicates)| Passes::of_text(text, replicates));
    let elapsed_s = fact(SECONDS).and_then(|text| text.parse().ok()).filter(|s: &f64| s.is_finite() && *s >= 0.0);
    match (passes, replicates, elapsed_s) {
        (Some(passes), Some(replicates), Some(elapsed_s)) if !passes.list().is_empty() => {
            Ok(Some(KeptFilm { film, passes, replicates, elapsed_s }))
        }
        _ => Err(Error::coded(
            ErrorCode::OtherRun,
            format!("{}: its header states no passes that were done; {remedy}", path.display()),
        )),
    }
}

/// Writes a film to the state in an output folder, where it has its final name when that publishes.
pub(crate) fn write(
    folder: &mut OutputFolder,
    plan: &Plan,
    (camera, shot): (&CameraPlan, Shot),
    film: &Film,
    (passes, replicates, elapsed_s): (&Passes, u32, f64),
) -> Result<(), Error> {
    let mut facts = FilmOrigin { plan, camera, shot, shard: Shard::WHOLE }.facts();
    facts.further.insert(PASSES.to_owned(), passes.text());
    facts.further.insert(REPLICATES.to_owned(), replicates.to_string());
    facts.further.insert(SECONDS.to_owned(), elapsed_s.to_string());
    write_exr(folder, &name(camera, shot), film_file::image(film, &facts))
}
