//! Films on disk: the output of a shard for `merge`, and the state of a progressive run.
//!
//! Every number of a film is stored as in memory (32 bits), so that a film read back is equal to the bit. Its header states its origin: plan, seed, camera,
//! frame, capture and shard. A film is used only if all of these are as expected, exactly the pixels of the shard's tiles have samples, and its numbers are
//! finite.
//!
//! The state of a progressive run is its films so far, in a folder next to the results. Each film has one file, which is replaced as a whole after each pass
//! and whose header states its passes. A run that is killed at any moment finds the last whole pass. A complete run leaves no state.

use crate::results::metadata;
use crate::results::writer::write_exr;
use etendue_core::Plane;
use etendue_core::quantity::{Identity, Quantity};
use etendue_io::Provenance;
use etendue_io::exr::{ExrFile, ExrImage, ExrLayer, ExrSamples, layers_image, read_exr_within};
use etendue_io::failure::{Error, ErrorCode};
use etendue_io::{ExistingFiles, OutputFolder};
use etendue_pipeline::Plan;
use etendue_pipeline::film::Film;
use etendue_pipeline::plan::{CameraPlan, Passes, TimeDependence};
use etendue_pipeline::render::FrameCapture;
use etendue_pipeline::tile::{Shard, tiles};
use std::fs::DirEntry;
use std::path::Path;

/// Suffix of a film's file name.
const FILM: &str = ".film.exr";

/// File name of a camera's film; includes frame and capture where each has its own film.
pub(crate) fn film_name(camera: &CameraPlan, frame_capture: FrameCapture) -> String {
    let FrameCapture { frame, capture } = frame_capture;
    match camera.time {
        TimeDependence::None => format!("{}{FILM}", camera.name),
        TimeDependence::Lights | TimeDependence::Motion => format!("{}.{frame:04}.{capture}{FILM}", camera.name),
    }
}

/// Folder of the state of a progressive run; not a legal camera name.
const STATE_FOLDER: &str = ".progress";

/// Returns true if an output folder holds a state. A link in place of that folder is not followed.
pub(crate) fn holds_state(folder: &Path) -> bool {
    let state = folder.join(STATE_FOLDER);
    let is_film = |file: DirEntry| file.file_name().to_string_lossy().ends_with(FILM);
    !state.is_symlink() && state.read_dir().into_iter().flatten().flatten().any(is_film)
}

/// The image of a film, ready to write.
pub(crate) fn image<'a>(film: &'a Film, facts: &Provenance) -> ExrImage<'a> {
    let mut layers = vec![
        ("weight".to_owned(), ExrLayer::Float(film.weight.samples())),
        ("samples".to_owned(), ExrLayer::Uint(film.samples.samples())),
        ("not_finite".to_owned(), ExrLayer::Uint(film.not_finite.samples())),
    ];
    if let Some((bands, [mean, variance])) = film.bands() {
        for i in 0..bands.count() {
            layers.push((format!("band.{i:04}.mean"), ExrLayer::Band(mean, i)));
            layers.push((format!("band.{i:04}.variance"), ExrLayer::Band(variance, i)));
        }
    }
    if let Some(rate) = &film.electron_rate {
        layers.push(("electron_rate.mean".to_owned(), ExrLayer::Float(rate.mean.samples())));
        layers.push(("electron_rate.variance".to_owned(), ExrLayer::Float(rate.variance.samples())));
    }
    if let Some(watched) = &film.watched {
        layers.push(("watched.mean".to_owned(), ExrLayer::Float(watched.mean.samples())));
        layers.push(("watched.variance".to_owned(), ExrLayer::Float(watched.variance.samples())));
    }
    layers_image(film.weight.width(), film.weight.height(), &layers, facts)
}

/// Facts of a film's header in addition to those of every result.
const CAPTURE: &str = "capture";
const SHARD: &str = "shard";

/// Origin of a stored film.
#[derive(Clone, Copy)]
pub(crate) struct FilmOrigin<'a> {
    pub(crate) plan: &'a Plan,
    /// The first of the cameras that share the light.
    pub(crate) camera: &'a CameraPlan,
    /// Frame and capture.
    pub(crate) frame_capture: FrameCapture,
    /// The tiles that the film holds.
    pub(crate) shard: Shard,
}

impl FilmOrigin<'_> {
    /// The facts of the header.
    pub(crate) fn facts(&self) -> Provenance {
        let mut facts = metadata::provenance(self.plan, self.camera, self.frame_capture.frame);
        facts.further.insert(CAPTURE.to_owned(), self.frame_capture.capture.to_string());
        facts.further.insert(SHARD.to_owned(), format!("{}/{}", self.shard.index(), self.shard.count()));
        facts
    }

    /// Describes the first fact of a header that differs.
    fn difference(&self, actual: &Provenance) -> Option<String> {
        let expected = self.facts();
        let further = |facts: &Provenance, name: &str| facts.further.get(name).cloned().unwrap_or_default();
        let pairs = [
            ("plan", expected.plan_hash.clone(), actual.plan_hash.clone()),
            ("seed", expected.seed.to_string(), actual.seed.to_string()),
            ("camera", expected.camera.clone(), actual.camera.clone()),
            ("frame", expected.frame.to_string(), actual.frame.to_string()),
            (CAPTURE, further(&expected, CAPTURE), further(actual, CAPTURE)),
            (SHARD, further(&expected, SHARD), further(actual, SHARD)),
        ];
        let (name, expected, actual) = pairs.into_iter().find(|(_, expected, actual)| expected != actual)?;
        if name == "plan" {
            return Some("it belongs to a run of another plan".to_owned());
        }
        let raw_text = if actual.is_empty() { format!("no {name}") } else { format!("the {name} {actual}") };
        Some(format!("its header states {raw_text}; expected {expected}"))
    }

    /// Describes an error in the numbers of a film.
    fn film_error(&self, film: &Film) -> Option<String> {
        let (width, height) = self.camera.film_size();
        let own = tiles(width, height, self.camera.settings.tile_px, self.shard);
        let sampled = |x: u32, y: u32| film.samples.at(x as usize, y as usize) > 0;
        // Passes over a subset of the pixels leave some pixels without samples.
        let is_whole = self.camera.passes.as_ref().is_none_or(|passes| passes.list().is_empty() || passes.spp() > 0);
        if is_whole && !own.iter().flat_map(|tile| tile.pixels()).all(|pixel| sampled(pixel.x, pixel.y)) {
            return Some("pixels of its tiles have no samples: it is incomplete".to_owned());
        }
        let inside = own.iter().flat_map(|tile| tile.pixels()).filter(|pixel| sampled(pixel.x, pixel.y)).count();
        if film.samples.samples().iter().filter(|samples| **samples > 0).count() != inside {
            return Some("pixels outside its tiles have samples: it belongs to another shard".to_owned());
        }
        let is_finite = |values: &[f32]| values.iter().all(|value| value.is_finite());
        // A single replicate gives no variance; a large variance may exceed the range of 32 bits.
        let is_variance = |values: &[f32]| values.iter().all(|value| value.is_nan() || *value >= 0.0);
        let bands = film.cube().is_none_or(|cube| {
            cube.mean.planes().iter().all(|plane| is_finite(plane.samples()))
                && cube.variance.planes().iter().all(|plane| is_variance(plane.samples()))
        });
        let electrons = film
            .electron_rate
            .as_ref()
            .is_none_or(|rate| is_finite(rate.mean.samples()) && is_variance(rate.variance.samples()));
        let watched = film
            .watched
            .as_ref()
            .is_none_or(|light| is_finite(light.mean.samples()) && is_variance(light.variance.samples()));
        let is_good = bands && electrons && watched && is_finite(film.weight.samples());
        (!is_good || film.not_finite_samples() > 0)
            .then(|| "it contains numbers that are not finite, or variances below 0: it is damaged".to_owned())
    }
}

/// Reads a film of the expected origin and its facts. `remedy` is the advice of the error message for a film of another origin.
///
/// # Errors
/// The file cannot be read, is of another origin, is incomplete, or has numbers that are not finite.
pub(crate) fn read(path: &Path, origin: &FilmOrigin<'_>, remedy: &str) -> Result<(Film, Provenance), Error> {
    let error = |why: &str| Error::coded(ErrorCode::OtherRun, format!("{}: {why}; {remedy}", path.display()));
    let camera = origin.camera;
    let (width, height) = camera.film_size();
    // Most of a shard's film is black and compresses well.
    let max_bytes = camera.film_layout().bytes(width as usize, height as usize) as u64;
    let file = read_exr_within(path, max_bytes).map_err(Error::input)?;
    let facts = file.provenance();
    if let Some(why) = origin.difference(&facts) {
        return Err(error(&why));
    }
    let film = decode(&file, camera);
    let film = film.ok_or_else(|| error(&format!("this is not the film of camera {}", camera.name)))?;
    match origin.film_error(&film) {
        Some(why) => Err(error(&why)),
        None => Ok((film, facts)),
    }
}

fn decode(file: &ExrFile, camera: &CameraPlan) -> Option<Film> {
    let (width, height) = camera.film_size();
    let (settings, (width, height)) = (&camera.settings, (width as usize, height as usize));
    let mut film = Film::new(width, height, &camera.film_layout(), settings.replicates);
    fill(&mut film.weight, file, "weight")?;
    fill_counts(&mut film.samples, file, "samples")?;
    fill_counts(&mut film.not_finite, file, "not_finite")?;
    if let Some(cube) = film.cube_mut() {
        for (i, plane) in cube.mean.planes_mut().iter_mut().enumerate() {
            fill(plane, file, &format!("band.{i:04}.mean"))?;
        }
        for (i, plane) in cube.variance.planes_mut().iter_mut().enumerate() {
            fill(plane, file, &format!("band.{i:04}.variance"))?;
        }
    }
    if let Some(rate) = &mut film.electron_rate {
        fill(&mut rate.mean, file, "electron_rate.mean")?;
        fill(&mut rate.variance, file, "electron_rate.variance")?;
    }
    if let Some(watched) = &mut film.watched {
        fill(&mut watched.mean, file, "watched.mean")?;
        fill(&mut watched.variance, file, "watched.variance")?;
    }
    Some(film)
}

fn fill<Q: Quantity<Sample = f32>>(plane: &mut Plane<Q>, file: &ExrFile, name: &str) -> Option<()> {
    match file.channel(name)? {
        ExrSamples::Float(values) if values.len() == plane.samples().len() => {
            plane.samples_mut().copy_from_slice(values);
            Some(())
        }
        _ => None,
    }
}

fn fill_counts(plane: &mut Plane<Identity>, file: &ExrFile, name: &str) -> Option<()> {
    match file.channel(name)? {
        ExrSamples::Uint(values) if values.len() == plane.samples().len() => {
            plane.samples_mut().copy_from_slice(values);
            Some(())
        }
        _ => None,
    }
}

/// Facts of a film in a stored state.
const PASSES: &str = "passes_done";
const REPLICATES: &str = "passes_replicates";
const SECONDS: &str = "passes_s";

/// The passes in a stored film.
#[derive(Clone, Debug)]
pub(crate) struct StoredPasses {
    /// Passes, at least one.
    pub(crate) passes: Passes,
    /// Replicates of each pass.
    pub(crate) replicates: u32,
    /// Time that the run has taken, s, in a run of a given time.
    pub(crate) elapsed_s: f64,
}

/// Path, within an output folder, of the stored state of a film.
pub(crate) fn state_name(camera: &CameraPlan, frame_capture: FrameCapture) -> String {
    format!("{STATE_FOLDER}/{}", film_name(camera, frame_capture))
}

/// Removes the state in an output folder: the films, and their folder if it is then empty.
///
/// # Errors
/// A link is in place of the folder, or a film cannot be removed.
pub(crate) fn remove_state(folder: &OutputFolder) -> Result<(), etendue_io::Error> {
    let films = folder.files_in(STATE_FOLDER)?;
    folder.remove(films.iter().map(String::as_str).filter(|name| name.ends_with(FILM)))
}

/// Refuses a folder with the state of another run that the run may neither resume nor replace, and a link in place of the state.
pub(crate) fn check_state(folder: &OutputFolder, existing: ExistingFiles) -> Result<(), Error> {
    folder.files_in(STATE_FOLDER).map_err(Error::input)?;
    if existing != ExistingFiles::Refuse || !holds_state(folder.path()) {
        return Ok(());
    }
    Err(Error::coded(
        ErrorCode::OtherRun,
        format!(
            "{}: an interrupted run left its state here; continue with `resume`, or start again with `overwrite`",
            folder.path().join(STATE_FOLDER).display()
        ),
    ))
}

/// Returns the film of an interrupted run in an output folder, and its passes; `None` if there is none.
///
/// # Errors
/// It is of another origin, or cannot be read.
pub(crate) fn read_state(folder: &Path, origin: &FilmOrigin<'_>) -> Result<Option<(Film, StoredPasses)>, Error> {
    let path = folder.join(state_name(origin.camera, origin.frame_capture));
    if !path.exists() {
        return Ok(None);
    }
    let remedy = "resume with the same options, choose another output folder, or `overwrite` it";
    let (film, facts) = read(&path, origin, remedy)?;
    let fact = |name: &str| facts.further.get(name);
    let replicates = fact(REPLICATES).and_then(|text| text.parse().ok());
    let passes = fact(PASSES).zip(replicates).and_then(|(text, replicates)| Passes::from_text(text, replicates));
    let elapsed_s = fact(SECONDS).and_then(|text| text.parse().ok()).filter(|s: &f64| s.is_finite() && *s >= 0.0);
    match (passes, replicates, elapsed_s) {
        (Some(passes), Some(replicates), Some(elapsed_s)) if !passes.list().is_empty() => {
            Ok(Some((film, StoredPasses { passes, replicates, elapsed_s })))
        }
        _ => Err(Error::coded(
            ErrorCode::OtherRun,
            format!("{}: its header states no completed passes; {remedy}", path.display()),
        )),
    }
}

/// Writes a film to the state in an output folder; it receives its final name when the folder publishes.
pub(crate) fn write_state(
    folder: &mut OutputFolder,
    origin: &FilmOrigin<'_>,
    film: &Film,
    stored: &StoredPasses,
) -> Result<(), Error> {
    let mut facts = origin.facts();
    facts.further.insert(PASSES.to_owned(), stored.passes.text());
    facts.further.insert(REPLICATES.to_owned(), stored.replicates.to_string());
    facts.further.insert(SECONDS.to_owned(), stored.elapsed_s.to_string());
    write_exr(folder, &state_name(origin.camera, origin.frame_capture), image(film, &facts))
}
