//! What a progressive run does after each pass: the state of its film is kept, and the pictures on disk are refined.
//!
//! The pictures are the files of light and photographs that the run writes at its end, made of the film so far: complete, and each replaced as a whole. Of
//! light that serves many frames the first is refined. What comes of other captures of a frame, or of frames before it, is known by
//! then: of a frame of several films the picture is refined with the last of them.

use super::state::{self, KeptFilm};
use crate::delivery::{SoFar, check_finite};
use crate::render_options::RenderOptions;
use crate::results::CameraResults;
use etendue_core::observer::Unobserved;
use etendue_io::failure::Error;
use etendue_io::{Existing, OutputFolder};
use etendue_pipeline::Plan;
use etendue_pipeline::film::Film;
use etendue_pipeline::plan::{CameraPlan, Passes, TimeDependence};
use etendue_pipeline::render::Shot;
use std::path::PathBuf;
use std::sync::Arc;

/// Where a run keeps its state and refines its pictures.
#[derive(Debug, Default)]
pub(crate) struct Progress {
    /// The output folder, of a progressive run.
    refined: Option<OutputFolder>,
    /// The same, where a run resumes.
    resumed: Option<PathBuf>,
}

impl Progress {
    /// Of a run into a folder. One that replaces what is there begins anew.
    ///
    /// # Errors
    /// Where the folder cannot be written.
    pub(crate) fn of(is_progressive: bool, folder: &OutputFolder, existing: Existing) -> Result<Self, Error> {
        let open = || folder.again(Existing::Replace).map_err(Error::input);
        let refined = is_progressive.then(open).transpose()?;
        if existing == Existing::Replace {
            state::remove(folder).map_err(Error::run)?;
        }
        let resumed = (existing == Existing::Resume).then(|| folder.path().to_path_buf());
        Ok(Self { refined, resumed })
    }

    /// A film that an interrupted run left.
    pub(crate) fn kept(&self, plan: &Plan, camera: &CameraPlan, shot: Shot) -> Result<Option<KeptFilm>, Error> {
        self.resumed.as_ref().map_or(Ok(None), |folder| state::read(folder, plan, camera, shot))
    }

    /// Whether anything is done after a pass.
    pub(crate) fn is_kept(&self) -> bool {
        self.refined.is_some()
    }

    /// Keeps a film after these of its passes, of these replicates, and this time, s.
    pub(crate) fn keep(
        &mut self,
        plan: &Plan,
        (camera, shot): (&CameraPlan, Shot),
        film: &Film,
        done: (&Passes, u32, f64),
    ) -> Result<(), Error> {
        let Some(folder) = &mut self.refined else { return Ok(()) };
        check_finite(camera, film)?;
        state::write(folder, plan, (camera, shot), film, done)?;
        folder.publish().map_err(Error::run)?;
        Ok(())
    }

    /// Refines the pictures of cameras of equal light.
    pub(crate) fn refine(
        &mut self,
        plan: &Arc<Plan>,
        (group, shot): (&[&CameraPlan], Shot),
        film: &Film,
        so_far: SoFar<'_>,
        options: &RenderOptions,
    ) -> Result<(), Error> {
        let Some(folder) = self.refined.as_mut().filter(|_| so_far.films.len() + 1 == so_far.count) else {
            return Ok(());
        };
        let frame = if group[0].time == TimeDependence::None { options.frames.start } else { shot.frame };
        let options = RenderOptions { frames: frame..frame + 1, ..options.clone() };
        let films: Vec<Film> = so_far.films.iter().chain([film]).cloned().collect();
        for (camera, state) in group.iter().zip(so_far.states.0) {
            let state = (state.clone(), so_far.states.1);
            CameraResults::of_films(plan, camera, films.clone(), state, &options)?.write_light(folder, &Unobserved)?;
        }
        folder.publish().map_err(Error::run)?;
        Ok(())
    }

    /// Removes what was kept of frames that have their files.
    pub(crate) fn forget(&self, camera: &CameraPlan, frame: u32) -> Result<(), Error> {
        let Some(folder) = &self.refined else { return Ok(()) };
        let captures = camera.body.exposure.distinct_captures();
        let names: Vec<String> =
            captures.into_iter().map(|capture| state::name(camera, Shot { frame, capture: capture as u32 })).collect();
        folder.remove(names.iter().map(String::as_str)).map_err(Error::run)
    }

    /// Removes the state of a run that is complete.
    pub(crate) fn finish(self, folder: &OutputFolder) -> Result<(), Error> {
        state::remove(folder).map_err(Error::run)
    }
}
