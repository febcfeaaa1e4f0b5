//! Jobs.

use crate::error::{exception, refused};
use crate::results::{Results, existing};
use crate::watch::run;
use crate::{meshes, toml};
use etendue::{
    ExistingFiles, FilmMemory, Integrator, JobRequest, Message, Observer as _, Quality, RenderOptions, ShardRequest,
    ShardSpec, TextureMemory, Word as _,
};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyString;
use std::ops::Range;
use std::path::{Path, PathBuf};

/// Job that was read, checked and compiled.
#[pyclass(frozen, module = "etendue")]
pub(crate) struct Job {
    job: etendue::Job,
}

/// File name of a job made in Python.
const GENERATED_FILE: &str = "job.toml";

#[pymethods]
impl Job {
    /// Opens a job.
    ///
    /// description: the path of a job file (TOML), or its keys as a dict.
    /// set: changes of keys, as --set: a dict of dotted keys to values (None removes a key), or texts key=value.
    /// spp, noise, time_s (s), progressive, scale ("1/4" or 0.25), seed, integrator, quality, camera: as the options of `etendue render`.
    /// files: files that the job names, made here: names to dicts or texts (TOML).
    /// meshes: meshes that the job names: names to dicts of positions (n, 3), triangles (m, 3), and optionally normals (n, 3) and uvs (n, 2),
    /// in the unit and axes that the job states for the mesh.
    /// folder: the folder of a job that is a dict; its paths are relative to it. Default: the working folder.
    /// sandbox: folders, in addition to the job's own, that its files may lie in. None: they may lie anywhere.
    /// texture_memory_mb, cache, film_memory_mb, scratch: memory of textures and films, and the folders of larger ones.
    /// memory_mb: memory limit of the run, 0 for no limit; None: the free memory when the job is opened. No bit of the results depends on them.
    ///
    /// Raises InputError with every error of all files.
    #[staticmethod]
    #[pyo3(signature = (
        description, *, set = None, spp = None, noise = None, time_s = None, progressive = false, scale = None, seed = None, integrator = None, quality = None,
        camera = None, files = None, meshes = None, folder = None, sandbox = None, texture_memory_mb = 512, cache = None, film_memory_mb = 2048,
        memory_mb = None, scratch = None,
    ))]
    #[allow(clippy::too_many_arguments, reason = "keywords of Python")]
    fn open(
        py: Python<'_>,
        description: &Bound<'_, PyAny>,
        set: Option<&Bound<'_, PyAny>>,
        spp: Option<u64>,
        noise: Option<f64>,
        time_s: Option<f64>,
        progressive: bool,
        scale: Option<&Bound<'_, PyAny>>,
        seed: Option<u64>,
        integrator: Option<&str>,
        quality: Option<&str>,
        camera: Option<String>,
        files: Option<&Bound<'_, PyAny>>,
        meshes: Option<&Bound<'_, PyAny>>,
        folder: Option<PathBuf>,
        sandbox: Option<Vec<PathBuf>>,
        texture_memory_mb: u32,
        cache: Option<PathBuf>,
        film_memory_mb: u32,
        memory_mb: Option<u32>,
        scratch: Option<PathBuf>,
    ) -> PyResult<Self> {
        let (path, text) = source(description, folder)?;
        let request = JobRequest {
            set: toml::changes(set)?,
            spp,
            noise,
            time_s,
            progressive,
            scale: scale.map(|scale| Ok::<_, PyErr>(scale.str()?.to_cow()?.into_owned())).transpose()?,
            seed,
            integrator: integrator.map(|word| parse_word(word, "integrator", Integrator::WORDS)).transpose()?,
            quality: quality.map(|word| parse_word(word, "quality", Quality::WORDS)).transpose()?,
            camera,
            sandbox,
            textures: TextureMemory {
                limit_bytes: u64::from(texture_memory_mb) * 1_000_000,
                cache,
                ..TextureMemory::default()
            },
            films: FilmMemory { limit_bytes: u64::from(film_memory_mb) * 1_000_000, scratch },
            memory: etendue_cli::memory_limits(memory_mb),
            ..JobRequest::new(&path)
        };
        let mut files = meshes::files(path.parent().unwrap_or(Path::new("")), files, meshes)?;
        if let Some(text) = text {
            files.add_text(&path, text);
        }
        let job = run(py, None, None, |watch| {
            let job = request.open_in(&files)?;
            job.overridden_settings().iter().for_each(|notice| watch.message(Message::Note(notice)));
            Ok(job)
        })?;
        Ok(Self { job })
    }

    /// Modelled effects, omitted effects with reasons, and cost: as `etendue plan --json`.
    fn plan<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let text = py.detach(|| serde_json::to_string(&self.job.report()));
        let text = text.map_err(|error| PyValueError::new_err(error.to_string()))?;
        py.import("json")?.call_method1("loads", (text,))
    }

    /// The same in words, as `etendue plan`.
    fn summary(&self, py: Python<'_>) -> String {
        py.detach(|| self.job.summary())
    }

    /// Paths of the files that were read: the job and all files that it names, as they were named.
    #[getter]
    fn files(&self) -> Vec<PathBuf> {
        self.job.files().to_vec()
    }

    /// Names of the films of a shard, relative to its folder: one per camera (one for all cameras of equal light); if light depends on time, one per frame and
    /// capture.
    #[pyo3(signature = (frames = None))]
    fn film_names(&self, frames: Option<&Bound<'_, PyAny>>) -> PyResult<Vec<String>> {
        Ok(self.job.film_names(&range(frames)?))
    }

    /// Names of all files of a complete run, relative to its folder.
    #[pyo3(signature = (frames = None))]
    fn file_names(&self, frames: Option<&Bound<'_, PyAny>>) -> PyResult<Vec<String>> {
        Ok(self.job.file_names(&range(frames)?))
    }

    /// Renders all cameras and keeps their light in memory.
    ///
    /// frames: a frame's number, or a range of consecutive ones. Default: frame 0.
    /// threads: worker threads. Default: one per processor. No bit of the results depends on it.
    /// progress: called in this thread after each tile with the current step, the number of finished tiles, and the total; an exception from it cancels
    /// the run, like Ctrl-C.
    ///
    /// Warnings go to `warnings`, notes to the logger "etendue". Other Python threads run meanwhile.
    #[pyo3(signature = (*, frames = None, threads = None, progress = None))]
    fn render(
        &self,
        py: Python<'_>,
        frames: Option<&Bound<'_, PyAny>>,
        threads: Option<u32>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Results> {
        let options = options(py, frames)?;
        let threads = counted(py, threads)?;
        let results = run(py, threads, progress.as_ref(), |watch| self.job.render(&options, watch))?;
        Results::new(py, results, threads)
    }

    /// Renders camera after camera into a folder, with one at a time in memory: the files of `etendue render`, byte for byte. Returns their paths.
    ///
    /// overwrite: replaces files of an earlier run. resume: continues an interrupted run of the same plan.
    /// shard: (i, n) renders the tiles whose number is i modulo n; `etendue.merge` joins the folders of all.
    /// films: the only films of the shard to render, of `film_names()`; `merge` requires all of them in the folder. None: all.
    #[pyo3(signature = (folder, *, frames = None, overwrite = false, resume = false, shard = None, films = None, threads = None, progress = None))]
    #[allow(clippy::too_many_arguments, reason = "keywords of Python")]
    fn save(
        &self,
        py: Python<'_>,
        folder: PathBuf,
        frames: Option<&Bound<'_, PyAny>>,
        overwrite: bool,
        resume: bool,
        shard: Option<(u32, u32)>,
        films: Option<Vec<String>>,
        threads: Option<u32>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Vec<PathBuf>> {
        let existing = match (overwrite, resume) {
            (true, true) => {
                return Err(PyValueError::new_err("overwrite and resume exclude each other; give one of them"));
            }
            (false, true) => ExistingFiles::Resume,
            (overwrite, false) => existing(overwrite),
        };
        if resume && shard.is_some() {
            return Err(PyValueError::new_err("a shard cannot be resumed; render it again with overwrite=True"));
        }
        if films.is_some() && shard.is_none() {
            return Err(PyValueError::new_err("films: has no effect without a shard; give shard=(i, n), or omit it"));
        }
        if films.as_ref().is_some_and(Vec::is_empty) {
            return Err(PyValueError::new_err("films: expected one name or more; None selects all of them"));
        }
        let options = options(py, frames)?;
        let threads = counted(py, threads)?;
        run(py, threads, progress.as_ref(), |watch| match shard {
            None => self.job.save(&options, &folder, existing, watch),
            Some((index, count)) => {
                let (spec, frames) = (ShardSpec { index, count }, options.frames.clone());
                let shard_request = ShardRequest { spec, frames, films: films.clone().unwrap_or_default() };
                self.job.save_shard(&shard_request, options.simd, &folder, existing, watch)
            }
        })
    }

    fn __repr__(&self) -> String {
        let cameras = self.job.plan().cameras.iter().map(|camera| camera.name.as_str()).collect::<Vec<_>>();
        format!("<etendue.Job {}: {}>", self.job.request().job.display(), cameras.join(", "))
    }
}

/// Path of a job, and its text if it is made in Python.
fn source(description: &Bound<'_, PyAny>, folder: Option<PathBuf>) -> PyResult<(PathBuf, Option<String>)> {
    if let Some(keys) = toml::mapping(description)? {
        return Ok((folder.unwrap_or_default().join(GENERATED_FILE), Some(toml::file(&keys)?)));
    }
    if folder.is_some() {
        return Err(PyValueError::new_err("folder: has no effect on a job file, which has its own; omit it"));
    }
    let is_path = description.is_instance_of::<PyString>() || description.hasattr("__fspath__")?;
    match is_path {
        true => Ok((description.extract()?, None)),
        false => Err(PyTypeError::new_err(format!(
            "description: expected the path of a job file or a dict, not {}",
            description.get_type().name()?
        ))),
    }
}

fn options(py: Python<'_>, frames: Option<&Bound<'_, PyAny>>) -> PyResult<RenderOptions> {
    let simd = etendue_cli::simd().map_err(|error| exception(py, error))?;
    Ok(RenderOptions { frames: range(frames)?, simd })
}

/// Checks that a number of threads is valid.
fn counted(py: Python<'_>, threads: Option<u32>) -> PyResult<Option<u32>> {
    match threads {
        Some(threads) if !(1..=1024).contains(&threads) => {
            Err(refused(py, format!("threads: expected a whole number from 1 to 1024, not {threads}")))
        }
        threads => Ok(threads),
    }
}

/// A frame, or a range of consecutive ones; frame 0 if none is named.
fn range(frames: Option<&Bound<'_, PyAny>>) -> PyResult<Range<u32>> {
    let type_error =
        || PyTypeError::new_err("frames: expected a frame number, or a non-empty range of consecutive frames");
    let Some(frames) = frames else { return Ok(0..1) };
    if let Ok(frame) = frames.extract::<u32>() {
        return Ok(frame..frame.checked_add(1).ok_or_else(type_error)?);
    }
    let part = |name: &str| frames.getattr(name).and_then(|part| part.extract::<u32>());
    match (part("start"), part("stop"), part("step")) {
        (Ok(start), Ok(stop), Ok(1)) if start < stop => Ok(start..stop),
        _ => Err(type_error()),
    }
}

fn parse_word<T: Copy>(word: &str, option_name: &str, words: &[(&str, T)]) -> PyResult<T> {
    let matching = words.iter().find(|(name, _)| *name == word).map(|(_, value)| *value);
    let known: Vec<&str> = words.iter().map(|(name, _)| *name).collect();
    matching
        .ok_or_else(|| PyValueError::new_err(format!("{option_name}={word:?}: expected one of {}", known.join(", "))))
}
