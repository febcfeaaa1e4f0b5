//! Run of a data set: sample after sample, each complete or absent; then the files over all samples.

use std::path::{Path, PathBuf};
use std::{collections::BTreeMap, ops::Range};

use etendue::{
    Error, ErrorCode, ExistingFiles, Job, JobRequest, Message, Observer, OutputFolder, RenderOptions, open_variations,
};
use etendue_io::{hash, read_regular, sidecar};
use etendue_scene::limits::DESCRIPTION;
use serde_json::Value;

use crate::format::{FormatWriter, writers};
use crate::records::{Records, record_name};
use crate::request::{self, DatasetRequest};
use crate::{
    done_samples::CompleteSamples, draw::SampleVariation, observer::SampleObserver, picture, record::SampleRecord,
    set::Set,
};

/// File of the set's facts.
const SET_FILE: &str = "dataset.json";

/// Renders the samples of a data set and writes them in the requested formats; returns the paths of the written files. Samples are committed one by one: an
/// interrupted run keeps the complete ones, and a resumed one ([`ExistingFiles::Resume`]) skips them. Files over all samples, such as COCO's, include all samples in
/// the folder. Runs on the caller's thread pool.
///
/// # Errors
/// All errors of the job and of the variations, before anything is rendered; a sample whose plan cannot be made; a folder that holds another data set; if the
/// observer cancels, light is not finite, or the folder cannot be written.
pub fn dataset(
    request: &DatasetRequest,
    root: &Path,
    existing: ExistingFiles,
    observer: &dyn Observer,
) -> Result<Vec<PathBuf>, Error> {
    let variations = request.variations.as_deref().map(open_variations).transpose()?;
    let base = request.job.clone().open()?;
    let set = Set::new(request, &base, variations, text_hash(request)?)?;
    set.unused_keys().iter().for_each(|note| observer.message(Message::Note(note)));
    if let Some(variations) = &set.variations {
        let first = SampleVariation::new(Some(variations), set.seed, request.samples.start);
        request::check(variations, &first.groups, &request.job)?;
    }
    let writers = writers(&set)?;
    let mut folder = OutputFolder::open(root, existing).map_err(Error::input)?;
    check_folder(&set, root, existing)?;
    let remaining = samples_left(&set, &writers, &folder, existing, &request.samples, observer)?;
    let mut run =
        DatasetRun { request, remaining, set: &set, writers: &writers, folder: &mut folder, observer, completed: 0 };
    let written = run.samples();
    let completed = run.completed;
    if written.is_err() {
        observer.message(Message::Note(&kept_message(root, completed)));
    }
    let mut written = written?;
    let mut final_folder = folder.reopened(ExistingFiles::Replace).map_err(Error::run)?;
    let records = Records::new(root)?;
    writers.iter().try_for_each(|writer| writer.finish(&set, &records, &mut final_folder)).inspect_err(|_| {
        observer.message(Message::Note(&kept_message(root, completed)));
    })?;
    written.extend(final_folder.publish().map_err(Error::run)?);
    writers.iter().try_for_each(|writer| writer.remove_obsolete(&records, &mut final_folder))?;
    written.retain(|path| path.exists());
    Ok(written)
}

/// Samples that are to be rendered.
fn samples_left(
    set: &Set,
    writers: &[Box<dyn FormatWriter>],
    folder: &OutputFolder,
    existing: ExistingFiles,
    samples: &Range<u32>,
    observer: &dyn Observer,
) -> Result<Vec<u32>, Error> {
    if existing == ExistingFiles::Refuse {
        return Ok(samples.clone().collect());
    }
    let root = folder.path();
    let records = &Records::in_folder(root)?;
    let done = CompleteSamples { set, writers, root, records };
    done.check_others(samples)?;
    let check_replaced =
        |samples: &Range<u32>| writers.iter().try_for_each(|writer| writer.check_replaced(records, samples, folder));
    if existing == ExistingFiles::Replace {
        check_replaced(samples)?;
        return Ok(samples.clone().collect());
    }
    let remaining = done.remaining(samples, observer);
    let is_there = |sample: &&u32| records.numbers().binary_search(sample).is_ok();
    remaining.iter().filter(is_there).try_for_each(|sample| check_replaced(&(*sample..*sample + 1)))?;
    Ok(remaining)
}

fn kept_message(root: &Path, completed: usize) -> String {
    let folder = root.display();
    let samples = if completed == 1 { "1 complete sample" } else { &format!("{completed} complete samples") };
    match completed {
        0 => format!("{folder}: nothing of this run was saved"),
        _ => format!("{folder}: saved {samples}; to continue, use `resume`"),
    }
}

fn text_hash(request: &DatasetRequest) -> Result<Option<String>, Error> {
    let Some(file) = &request.variations else { return Ok(None) };
    let bytes = read_regular(file, &DESCRIPTION)
        .map_err(|cause| Error::coded(ErrorCode::UnreadableFile, format!("{}: {cause}", file.display())))?;
    Ok(Some(hash::hex(&hash::hash_bytes(&bytes))))
}

/// Refuses a folder that holds another data set, or one that the caller did not request to resume.
fn check_folder(set: &Set, root: &Path, existing: ExistingFiles) -> Result<(), Error> {
    let path = root.join(SET_FILE);
    if !path.exists() {
        return Ok(());
    }
    let refuse = |problem: &str| Err(Error::coded(ErrorCode::OtherRun, format!("{}: {problem}", path.display())));
    if existing == ExistingFiles::Refuse {
        return refuse("a data set already exists here; continue it with `resume`, or give another folder");
    }
    let stored = read_regular(&path, &DESCRIPTION).ok().and_then(|bytes| serde_json::from_slice::<Value>(&bytes).ok());
    let Some(Value::Object(stored)) = stored else { return refuse("this is not the file of a data set") };
    let Value::Object(ours) = &set.facts else { return Ok(()) };
    let differs = ours.iter().filter(|(key, value)| stored.get(*key) != Some(*value));
    let differs: Vec<String> = differs.map(|(key, _)| format!("\"{key}\"")).collect();
    match differs.is_empty() {
        true => Ok(()),
        false => refuse(&format!("the data set here has a different {}; give another folder", differs.join(", "))),
    }
}

struct DatasetRun<'a> {
    request: &'a DatasetRequest,
    /// Samples to render.
    remaining: Vec<u32>,
    set: &'a Set,
    writers: &'a [Box<dyn FormatWriter>],
    folder: &'a mut OutputFolder,
    observer: &'a dyn Observer,
    /// Samples rendered by this run.
    completed: usize,
}

impl DatasetRun<'_> {
    fn samples(&mut self) -> Result<Vec<PathBuf>, Error> {
        let remaining = std::mem::take(&mut self.remaining);
        let mut written = Vec::new();
        for (done, sample) in remaining.iter().enumerate() {
            if !self.folder.path().join(SET_FILE).exists() {
                self.json(SET_FILE, &self.set.facts)?;
            }
            let all = self.observer;
            let observer = SampleObserver { all, done, total: remaining.len(), sample: *sample, tells: done == 0 };
            self.sample(*sample, &observer)?;
            // The record is the last of its files, so a sample with a record is complete.
            written.extend(self.folder.publish().map_err(Error::run)?);
            self.completed += 1;
        }
        Ok(written)
    }

    fn sample(&mut self, sample: u32, observer: &SampleObserver<'_>) -> Result<(), Error> {
        let drawn = SampleVariation::new(self.set.variations.as_ref(), self.set.seed, sample);
        let set = drawn.set();
        let job = self.job(&drawn, &set).map_err(|error| in_sample(error, sample, &set))?;
        self.set.check_classes(&job, sample)?;
        self.set.check_cameras(&job).map_err(|error| in_sample(error, sample, &set))?;
        let plan = job.plan().hash_text();
        let (split, seed) = (drawn.split, drawn.seed);
        let (images, files) = (Vec::new(), BTreeMap::new());
        let mut record = SampleRecord { sample, split, seed, set, plan, pictures: images, files, sha256: None };
        let options = RenderOptions { frames: self.request.frames.clone(), simd: self.request.simd };
        job.render_each(&options, observer, |camera| {
            let warn = |warning: &str| self.observer.message(Message::Warning(&format!("sample {sample}, {warning}")));
            picture::each(&camera, sample, drawn.split, &warn, |image| {
                for writer in self.writers {
                    writer.write_image(self.set, image, self.folder)?;
                }
                record.pictures.push(image.record.clone());
                Ok(())
            })
        })?;
        self.writers.iter().try_for_each(|writer| writer.sample(self.set, &record, self.folder))?;
        record.files = self.folder.pending_digests(|name| name != SET_FILE).map_err(Error::run)?;
        self.json(&record_name(sample), &record.sealed())
    }

    fn job(&self, drawn: &SampleVariation, set: &[String]) -> Result<Job, Error> {
        let mut request = JobRequest { seed: Some(drawn.seed), ..self.request.job.clone() };
        request.set.extend(set.iter().cloned());
        request.open()
    }

    fn json(&mut self, name: &str, facts: &impl serde::Serialize) -> Result<(), Error> {
        let bytes = sidecar::encode(facts).map_err(|error| Error::Run(format!("{name}: {error}")))?;
        self.folder.write(name, &bytes).map_err(Error::run)
    }
}

/// Adds the sample, and its changes, to the errors.
fn in_sample(error: Error, sample: u32, set: &[String]) -> Error {
    let Error::Input(mut errors) = error else { return error };
    for entry in &mut errors {
        entry.message = format!("sample {sample} ({}): {}", set.join("; "), entry.message);
    }
    Error::Input(errors)
}
