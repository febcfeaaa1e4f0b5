//! Errors of jobs and runs: their place, and a panic on a worker thread, here of the caller's observer: no file is incomplete, complete ones are reported and
//! kept, and a resumed run ends as an uninterrupted one.

use etendue::{
    Error, ExistingFiles, Job, JobRequest, MemoryFiles, Message, NullObserver, Observer, OutputFolder, Progress,
    RenderOptions,
};
use std::collections::BTreeMap;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::sync::Mutex;

/// Moving ball, in frames of four tiles.
const JOB: &str = "format = 1\n[sequence]\nframe_rate_hz = 10\n\
    [[cameras]]\nname = \"front\"\nposition_m = [0, 0, 0]\nlook_at_m = [1, 0, 0]\n\
    lens = { type = \"pinhole\", focal_length_mm = 6, f_number = 4 }\nsensor = { width_px = 32, height_px = 32, pixel_pitch_um = 100 }\n\
    [render]\nspp = 8\nreplicates = 1\nintegrator = \"flat\"\ntile_px = 16\n\
    [scene.environment]\ntype = \"uniform\"\nluminance_cd_m2 = 100\nilluminant = \"D65\"\n\
    [[scene.materials]]\nname = \"grey\"\ntype = \"diffuse\"\nreflectance = 0.5\n\
    [[scene.objects]]\nname = \"ball\"\nmaterial = \"grey\"\nshape = { type = \"sphere\", radius_m = 0.5 }\n\
    keys = [{ time_s = 0, position_m = [3, 0, 0] }, { time_s = 1, position_m = [3, 1, 0] }]\n";

/// Panics when this many tiles are done, and records its messages.
struct PanickingObserver {
    tiles: usize,
    messages: Mutex<Vec<String>>,
}

impl Observer for PanickingObserver {
    fn progress(&self, progress: Progress<'_>) {
        assert_ne!(progress.done, self.tiles, "a test's panic");
    }

    fn message(&self, message: Message<'_>) {
        let (Message::Note(text) | Message::Warning(text)) = message;
        self.messages.lock().expect("no panic holds it").push(text.to_owned());
    }
}

fn job(is_progressive: bool) -> Job {
    let mut files = MemoryFiles::new();
    files.add_text("job.toml", JOB);
    let request = JobRequest { progressive: is_progressive, ..JobRequest::new("job.toml") };
    request.open_in(&files).unwrap_or_else(|error| panic!("{error}"))
}

fn options() -> RenderOptions {
    RenderOptions { frames: 0..3, ..RenderOptions::default() }
}

/// Files of a folder and its subfolders.
fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut contents = BTreeMap::new();
    let mut folders = vec![folder.to_path_buf()];
    while let Some(path) = folders.pop() {
        for entry in std::fs::read_dir(&path).expect("a folder").map(|entry| entry.expect("an entry").path()) {
            match entry.is_dir() {
                true => folders.push(entry),
                false => {
                    let name = entry.strip_prefix(folder).expect("below").to_string_lossy().into_owned();
                    contents.insert(name, std::fs::read(&entry).expect("a file"));
                }
            }
        }
    }
    contents
}

/// Renders until the observer panics at a tile; returns its messages.
fn panicked(job: &Job, folder: &Path, tiles: usize) -> String {
    let observer = PanickingObserver { tiles, messages: Mutex::default() };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(2).build().expect("threads");
    let run = || pool.install(|| job.save(&options(), folder, ExistingFiles::Refuse, &observer));
    catch_unwind(AssertUnwindSafe(run)).expect_err("the observer's panic");
    let messages = observer.messages.into_inner().expect("no panic holds it");
    messages.last().expect("what was kept").clone()
}

#[test]
fn a_panic_of_a_worker_leaves_whole_frames_and_says_so() {
    let place = tempfile::tempdir().expect("a folder");
    let undisturbed = place.path().join("whole");
    job(false).save(&options(), &undisturbed, ExistingFiles::Refuse, &NullObserver).expect("rendered");
    let expected = files(&undisturbed);
    // In the first frame: nothing remains, not even the folder.
    let out = place.path().join("out");
    let message = panicked(&job(false), &out, 2);
    assert!(message.ends_with("nothing of this run was saved") && !out.exists(), "{message}");
    // In the third: two frames.
    let message = panicked(&job(false), &out, 10);
    assert!(message.contains("saved 2 complete frames; to continue, use `resume`"), "{message}");
    let stored = files(&out);
    assert!(
        stored.len() > 2 && stored.iter().all(|(name, bytes)| expected.get(name) == Some(bytes)),
        "{:?}",
        stored.keys()
    );
    job(false).save(&options(), &out, ExistingFiles::Resume, &NullObserver).expect("rendered");
    assert!(files(&out) == expected);
}

#[test]
fn a_panic_between_passes_leaves_the_light_of_the_last() {
    let place = tempfile::tempdir().expect("a folder");
    let (undisturbed, out) = (place.path().join("whole"), place.path().join("out"));
    job(true).save(&options(), &undisturbed, ExistingFiles::Refuse, &NullObserver).expect("rendered");
    // The second pass of the first frame.
    let message = panicked(&job(true), &out, 6);
    assert!(message.contains("saved the light of the last complete pass; to continue, use `resume`"), "{message}");
    job(true).save(&options(), &out, ExistingFiles::Resume, &NullObserver).expect("rendered");
    assert!(files(&out) == files(&undisturbed));
}

/// The folder is unlocked again, also within the process.
#[test]
fn jobs_of_one_process_take_turns_in_a_folder() {
    let place = tempfile::tempdir().expect("a folder");
    panicked(&job(false), place.path(), 2);
    let folder = OutputFolder::open(place.path(), ExistingFiles::Refuse).expect("free");
    let error = job(false).save(&options(), place.path(), ExistingFiles::Replace, &NullObserver).expect_err("held");
    assert!(error.to_string().contains("another run of this process is writing into this folder"), "{error}");
    drop(folder);
    job(false).save(&options(), place.path(), ExistingFiles::Refuse, &NullObserver).expect("free");
}

#[test]
fn a_missing_file_is_a_fault_of_the_key_that_names_it() {
    let folder = tempfile::tempdir().expect("a folder");
    let job = folder.path().join("job.toml");
    let text = "format = 1\n[[scene.meshes]]\nname = \"m\"\nfile = \"lost.obj\"\nup_axis = \"z\"\n[[scene.objects]]\nname = \"o\"\nmesh = \"m\"\n\
        [[cameras]]\nname = \"c\"\nposition_m = [0, 0, 1]\nlook_at_m = [0, 0, 0]\nup = [0, 1, 0]\n[cameras.lens]\ntype = \"pinhole\"\n\
        focal_length_mm = 4\nf_number = 8\n[cameras.sensor]\nwidth_px = 8\nheight_px = 8\npixel_pitch_um = 4\n";
    std::fs::write(&job, text).expect("written");
    let opened = Job::open(&job).map(|_| ());
    let Err(Error::Input(errors)) = opened else { panic!("{opened:?}") };
    let Some(error) = errors.iter().find(|error| error.message.contains("lost.obj")) else { panic!("{errors:?}") };
    assert_eq!((error.file.as_ref(), error.line, error.column), (Some(&job), Some(4), Some(8)), "{error:?}");
    assert_eq!(error.key.as_deref(), Some("scene.meshes.m.file"));
}

/// The program names it `--time` (`crates/cli/tests/binary/progressive.rs`), Python `time_s`.
#[test]
fn a_time_that_is_too_short_is_reported_by_its_field() {
    let Err(Error::Input(errors)) = JobRequest { time_s: Some(3.0), ..JobRequest::new("job.toml") }.open() else {
        panic!("a time of 3 s is refused")
    };
    assert_eq!(errors[0].field.as_deref(), Some("time_s"));
    assert!(
        errors[0].message.starts_with("`time_s` 3: ") && !errors[0].message.contains("--"),
        "{}",
        errors[0].message
    );
}
