//! From films to the results of cameras, frame after frame.
//!
//! Light that does not depend on time is gathered once and serves all frames. Light that does is gathered for each frame and
//! for each capture whose exposure differs; the state of a sensor goes from frame to frame in their order.

use crate::render_options::RenderOptions;
use crate::results::{CameraResults, DoneFrames};
use etendue_io::failure::{Error, ErrorCode};
use etendue_pipeline::Plan;
use etendue_pipeline::film::Film;
use etendue_pipeline::plan::{CameraPlan, TimeDependence};
use etendue_pipeline::render::Shot;
use etendue_sensor::SensorState;
use std::ops::Range;
use std::sync::Arc;

/// The first camera of each group, for each of its films that are not done.
pub(crate) fn films_of<'a>(
    plan: &'a Plan,
    frames: &'a Range<u32>,
    done: &'a DoneFrames,
) -> impl Iterator<Item = &'a CameraPlan> {
    plan.by_light().into_iter().flat_map(|group| {
        let is_kept = |frame| group[0].time != TimeDependence::None && done.states(&group, frame).is_some();
        let films = shots_of(group[0], frames).into_iter().filter(|shot| !is_kept(shot.frame)).count();
        std::iter::repeat_n(group[0], films)
    })
}

/// The pictures of a frame that have a film of their own.
fn shots(camera: &CameraPlan, frame: u32) -> Vec<Shot> {
    match camera.time {
        TimeDependence::None => vec![Shot::default()],
        TimeDependence::Lights | TimeDependence::Motion => {
            let captures = camera.body.exposure.distinct_captures();
            captures.into_iter().map(|capture| Shot { frame, capture: capture as u32 }).collect()
        }
    }
}

/// All of some frames.
pub(crate) fn shots_of(camera: &CameraPlan, frames: &Range<u32>) -> Vec<Shot> {
    match camera.time {
        TimeDependence::None => shots(camera, 0),
        TimeDependence::Lights | TimeDependence::Motion => frames.clone().flat_map(|k| shots(camera, k)).collect(),
    }
}

/// What is known of a frame before one of its films is gathered.
#[derive(Clone, Copy)]
pub(crate) struct SoFar<'a> {
    /// The films of its captures before that one.
    pub(crate) films: &'a [Film],
    /// How many films it has.
    pub(crate) count: usize,
    /// The states of the sensors before the frame, and the first frame that they remember.
    pub(crate) states: (&'a [SensorState], u32),
}

/// Hands over the results of all cameras: of each group of cameras of equal light in turn, where light depends on time frame after
/// frame, but for frames that are `done`. `film_of` gathers the light of a group.
pub(crate) fn deliver(
    plan: &Arc<Plan>,
    options: &RenderOptions,
    done: &DoneFrames,
    mut film_of: impl FnMut(&[&CameraPlan], Shot, SoFar<'_>) -> Result<Film, Error>,
    mut take: impl FnMut(CameraResults) -> Result<(), Error>,
) -> Result<(), Error> {
    check_frames(plan, &options.frames)?;
    let steady = |group: &Vec<&CameraPlan>| group[0].time == TimeDependence::None;
    // What is written of steady groups gets its name at the end of the run, not with the frames of others.
    let (last, first): (Vec<_>, Vec<_>) = plan.by_light().into_iter().partition(steady);
    for group in first.into_iter().chain(last) {
        if group[0].time == TimeDependence::None {
            let states = vec![SensorState::default(); group.len()];
            let so_far = SoFar { films: &[], count: 1, states: (&states, options.frames.start) };
            let film = film_of(&group, Shot::default(), so_far)?;
            deliver_films(plan, &group, vec![film], (&states, options.frames.start), options, &mut take)?;
            continue;
        }
        let mut states = vec![SensorState::default(); group.len()];
        for frame in options.frames.clone() {
            if let Some(kept) = done.states(&group, frame) {
                states = kept;
                continue;
            }
            let (shots, since) = (shots(group[0], frame), options.frames.start);
            let mut films = Vec::with_capacity(shots.len());
            for shot in &shots {
                let so_far = SoFar { films: &films, count: shots.len(), states: (&states, since) };
                let film = film_of(&group, *shot, so_far)?;
                films.push(film);
            }
            let options = RenderOptions { frames: frame..frame + 1, ..options.clone() };
            states = deliver_films(plan, &group, films, (&states, since), &options, &mut take)?;
        }
    }
    Ok(())
}

/// Frames after the first need a rate where light depends on time.
pub(crate) fn check_frames(plan: &Plan, frames: &Range<u32>) -> Result<(), Error> {
    let needs = |camera: &&CameraPlan| camera.time != TimeDependence::None && camera.timing.period_s.is_none();
    match plan.cameras.iter().find(needs) {
        Some(camera) if frames.end > 1 => Err(Error::coded(
            ErrorCode::MissingKey,
            format!(
                "camera {}: its light depends on time, and nothing says when its frames after frame 0 are taken; add [sequence] with \
             \"frame_rate_hz\" to the job, or render `frames` 0..1",
                camera.name
            ),
        )),
        _ => Ok(()),
    }
}

/// Hands over the results of cameras of equal light; answers with the states of their sensors afterwards.
fn deliver_films(
    plan: &Arc<Plan>,
    group: &[&CameraPlan],
    films: Vec<Film>,
    (states, since): (&[SensorState], u32),
    options: &RenderOptions,
    take: &mut impl FnMut(CameraResults) -> Result<(), Error>,
) -> Result<Vec<SensorState>, Error> {
    films.iter().try_for_each(|film| check_finite(group[0], film))?;
    let mut after = Vec::with_capacity(group.len());
    let mut films = Some(films);
    for (i, (camera, state)) in group.iter().zip(states).enumerate() {
        let films = if i + 1 == group.len() { films.take() } else { films.clone() };
        let results =
            CameraResults::of_films(plan, camera, films.unwrap_or_default(), (state.clone(), since), options)?;
        check_textures(plan)?;
        after.push(results.state_after().map_or_else(SensorState::default, |(after, _)| after.clone()));
        take(results)?;
    }
    Ok(after)
}

/// Refuses light, once gathered, for which a tile of a texture could not be read.
pub(crate) fn check_textures(plan: &Plan) -> Result<(), Error> {
    plan.material_table.texture_failure().map_or(Ok(()), |failure| Err(Error::run(failure)))
}

/// Refuses a film that holds what is no finite number.
pub(crate) fn check_finite(camera: &CameraPlan, film: &Film) -> Result<(), Error> {
    match film.not_finite_samples() {
        0 => Ok(()),
        count => Err(Error::Run(format!(
            "camera {}: {count} samples of its light were not finite numbers, so nothing is delivered; a light is too bright \
             or too near for 32-bit floats: lower it or move it",
            camera.name
        ))),
    }
}
