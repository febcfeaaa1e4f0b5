//! Names of the files of films, and of the folder in which a progressive run stores its state.

use etendue_pipeline::plan::{CameraPlan, TimeDependence};
use etendue_pipeline::render::Shot;
use std::fs::DirEntry;
use std::path::Path;

/// Ending of the name of a film.
pub(crate) const FILM: &str = ".film.exr";

/// The name of a camera's film; with frame and capture where each has its own.
pub(crate) fn film_name(camera: &CameraPlan, shot: Shot) -> String {
    let Shot { frame, capture } = shot;
    match camera.time {
        TimeDependence::None => format!("{}{FILM}", camera.name),
        TimeDependence::Lights | TimeDependence::Motion => format!("{}.{frame:04}.{capture}{FILM}", camera.name),
    }
}

/// The folder of the state of a progressive run, no name of a camera.
pub(crate) const STATE_FOLDER: &str = ".progress";

/// Returns true if an output folder holds a state. A link in the place of its folder holds none.
pub(crate) fn holds_state(folder: &Path) -> bool {
    let state = folder.join(STATE_FOLDER);
    let is_film = |file: DirEntry| file.file_name().to_string_lossy().ends_with(FILM);
    !state.is_symlink() && state.read_dir().into_iter().flatten().flatten().any(is_film)
}
