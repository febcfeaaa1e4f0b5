//! `etendue tradeoff`: time against error for a user's job, with settings for drafts, standard images and references.

use crate::args::folder::Output;
use crate::args::job::JobArgs;
use crate::console::{Console, print_paths};
use crate::machine;
use clap::Args;
use etendue::{Error, ErrorCode, ExistingFiles, Observer, OutputFolder};
use etendue_arguments::integer;
use etendue_study::{
    Clock, DroppedEffect, StudyRequest, VariationResult, ablation, ablation_table, job_file, pictures, plot, study,
    table, variation_table, variations,
};
use std::path::Path;
use std::time::Instant;

/// `etendue tradeoff`
#[derive(Debug, Args)]
pub struct Tradeoff {
    #[command(flatten)]
    pub job: JobArgs,
    #[command(flatten)]
    pub output: Output,
    #[command(flatten)]
    pub request: StudyRequest,
    /// Worker threads [default: one per processor]. Times refer to this number
    #[arg(long, value_name = "N", value_parser = integer(1..=1024))]
    pub threads: Option<u32>,
    /// Instead omit the effects of the plan one by one, and report the change and the saving of each
    #[arg(long)]
    pub ablate: bool,
    /// Instead compare the frame with this change of a key (as for --set; several keys separated by ';'), and report the change and the saving; once
    /// for each change: --vary render.wavelengths_per_path=1 --vary "a.b=1; a.c=2"
    #[arg(long, value_name = "KEY=VALUE", conflicts_with = "ablate", value_parser = changes)]
    pub vary: Vec<KeyChanges>,
    /// With --ablate or --vary: also capture a chart of slanted edges with the unchanged camera and with each change, and report the spatial
    /// frequencies (cycles per pixel) at half contrast
    #[arg(long)]
    pub mtf50: bool,
    /// Print the study as JSON instead of as tables
    #[arg(long)]
    pub json: bool,
}

/// Written files, except images.
const STUDY_FILES: [&str; 6] =
    ["tradeoff.json", "tradeoff.txt", "tradeoff.svg", "draft.toml", "standard.toml", "reference.toml"];
const ABLATION_FILES: [&str; 2] = ["ablation.json", "ablation.txt"];
const VARIATION_FILES: [&str; 2] = ["variations.json", "variations.txt"];

/// Changes of keys that apply together.
#[derive(Clone, Debug)]
pub struct KeyChanges(Vec<String>);

/// Parses changes separated by ';'.
fn changes(text: &str) -> Result<KeyChanges, String> {
    let changes: Vec<_> = text.split(';').map(|change| change.trim().to_owned()).collect();
    match changes.iter().find(|change| !change.contains('=')) {
        Some(_) => Err(format!("expected KEY=VALUE, or several with ';' between them, not '{text}'")),
        None => Ok(KeyChanges(changes)),
    }
}

/// Seconds since the first query, with the number of threads.
struct Stopwatch(Instant, usize);

impl Stopwatch {
    /// Starts with the current pool's number of threads.
    fn begin() -> Self {
        Self(Instant::now(), rayon::current_num_threads())
    }
}

impl Clock for Stopwatch {
    fn seconds(&self) -> f64 {
        self.0.elapsed().as_secs_f64()
    }

    fn processor_seconds(&self) -> Option<f64> {
        machine::processor_seconds()
    }

    fn threads(&self) -> usize {
        self.1
    }
}

/// Output of a study: text, and names of files below its folder with their bytes.
struct StudyOutput {
    text: String,
    json: String,
    files: Vec<(String, Vec<u8>)>,
}

impl Tradeoff {
    pub fn run(&self, console: &dyn Console) -> Result<(), Error> {
        let simd = machine::simd()?;
        let pool = machine::pool(self.threads)?;
        // Reports errors and overridden keys before anything is written.
        self.job.open(console, &pool)?;
        let (folder, existing) = (self.output.path(), self.output.existing());
        if self.mtf50 && !self.ablate && self.vary.is_empty() {
            return Err(Error::argument(
                "mtf50",
                "`mtf50` reports the effect of changes on contrast transfer: give it with `ablate` or `vary`",
            )
            .with_code(ErrorCode::NoEffect));
        }
        self.refuse_to_replace()?;
        let mut output = OutputFolder::open(folder, existing).map_err(Error::input)?;
        let job = self.job.request().into_output(folder);
        let edges = self.mtf50.then(|| folder.join("edges"));
        let camera = self.job.request.camera.clone();
        let request = StudyRequest { job, camera, simd, edges, ..self.request.clone() };
        let observer = console.observer();
        let findings = pool.install(|| match (self.ablate, self.vary.as_slice()) {
            (true, _) => run_ablation(&request, observer),
            (false, []) => run_study(&request, folder, observer),
            (false, changes) => run_variations(&request, changes, observer),
        })?;
        for (name, bytes) in &findings.files {
            output.write(name, &spelled(console, name, bytes)).map_err(Error::run)?;
        }
        let written = output.commit().map_err(Error::run)?;
        if self.json {
            console.print_json(&console.spelled(&findings.json));
        } else {
            console.print(&console.spelled(&format!("{}\n", findings.text)));
            print_paths(console, &written);
        }
        Ok(())
    }

    /// Refuses to replace existing files without a request, or the studied job; checked before the study starts.
    fn refuse_to_replace(&self) -> Result<(), Error> {
        let (folder, existing) = (self.output.path(), self.output.existing());
        let names: &[&str] = match (self.ablate, self.vary.is_empty()) {
            (true, _) => &ABLATION_FILES,
            (false, true) => &STUDY_FILES,
            (false, false) => &VARIATION_FILES,
        };
        let images = (1..=self.vary.len()).map(variation_picture);
        let names = names.iter().map(|name| (*name).to_owned()).chain(images);
        for path in names.map(|name| folder.join(name)).filter(|path| path.exists()) {
            if existing == ExistingFiles::Refuse {
                let problem = "already exists; choose another folder, or allow overwriting with `overwrite`";
                return Err(Error::coded(ErrorCode::OutputExists, format!("{}: {problem}", path.display())));
            }
            if path.canonicalize().ok() == self.job.request.job.canonicalize().ok() {
                let problem = "is the studied job and would be replaced; give another folder";
                return Err(Error::coded(ErrorCode::OutputExists, format!("{}: {problem}", path.display())));
            }
        }
        Ok(())
    }
}

/// Study of time against error, with three jobs.
fn run_study(request: &StudyRequest, folder: &Path, observer: &dyn Observer) -> Result<StudyOutput, Error> {
    let output = study(request, &folder.join("pilot"), &Stopwatch::begin(), observer)?;
    let compared = pictures(&output, request, observer)?;
    let (text, json) = (table(&output), to_json(&output)?);
    let mut files = vec![
        ("tradeoff.json".to_owned(), json.clone().into_bytes()),
        ("tradeoff.txt".to_owned(), text.clone().into_bytes()),
        ("tradeoff.svg".to_owned(), plot(&output).into_bytes()),
    ];
    for recommendation in &output.recommendations {
        let job = job_file(recommendation, &request.job, &output.camera, folder)?;
        files.push((format!("{}.toml", recommendation.target.name), job.into_bytes()));
    }
    files.extend(compared.into_iter().map(|compared| (format!("pictures/{}", compared.file), compared.jpeg)));
    Ok(StudyOutput { text, json, files })
}

/// Study of one effect after the other.
fn run_ablation(request: &StudyRequest, observer: &dyn Observer) -> Result<StudyOutput, Error> {
    let output = ablation(request, &Stopwatch::begin(), observer)?;
    let (text, json) = (ablation_table(&output), to_json(&output)?);
    let mut files = vec![
        ("ablation.json".to_owned(), json.clone().into_bytes()),
        ("ablation.txt".to_owned(), text.clone().into_bytes()),
    ];
    let image = |dropped: DroppedEffect| Some((format!("pictures/without-{}.jpg", dropped.id), dropped.change.jpeg?));
    files.extend(output.dropped.into_iter().filter_map(image));
    Ok(StudyOutput { text, json, files })
}

/// Name of the image of the nth change, from 1.
fn variation_picture(n: usize) -> String {
    format!("pictures/with-{n}.jpg")
}

/// Study of one change after the other.
fn run_variations(
    request: &StudyRequest,
    changes: &[KeyChanges],
    observer: &dyn Observer,
) -> Result<StudyOutput, Error> {
    let changes: Vec<_> = changes.iter().map(|KeyChanges(set)| set.clone()).collect();
    let output = variations(request, &changes, &Stopwatch::begin(), observer)?;
    let (text, json) = (variation_table(&output), to_json(&output)?);
    let mut files = vec![
        ("variations.json".to_owned(), json.clone().into_bytes()),
        ("variations.txt".to_owned(), text.clone().into_bytes()),
    ];
    let images = output.varied.into_iter().enumerate();
    let image = |(i, varied): (usize, VariationResult)| Some((variation_picture(i + 1), varied.change.jpeg?));
    files.extend(images.filter_map(image));
    Ok(StudyOutput { text, json, files })
}

fn to_json(value: &impl serde::Serialize) -> Result<String, Error> {
    let text = serde_json::to_string_pretty(value).map_err(|error| Error::Run(error.to_string()))?;
    Ok(text + "\n")
}

/// Bytes of a file, with the names of arguments in texts as the console spells them.
fn spelled(console: &dyn Console, name: &str, bytes: &[u8]) -> Vec<u8> {
    let text = name.ends_with(".json") || name.ends_with(".txt");
    match std::str::from_utf8(bytes) {
        Ok(words) if text => console.spelled(words).into_bytes(),
        _ => bytes.to_vec(),
    }
}
