//! Tests that progress covers the whole run.

use etendue::{ExistingFiles, JobRequest, MemoryFiles, Observer, Progress, RenderOptions};
use std::sync::Mutex;

/// Two cameras of different sizes in front of a moving ball: one has four tiles, the other one.
const JOB: &str = "format = 1\n[sequence]\nframe_rate_hz = 10\n\
    [[cameras]]\nname = \"wide\"\nposition_m = [0, 0, 0]\nlook_at_m = [1, 0, 0]\n\
    lens = { type = \"pinhole\", focal_length_mm = 6, f_number = 4 }\nsensor = { width_px = 32, height_px = 32, pixel_pitch_um = 100 }\n\
    [[cameras]]\nname = \"small\"\nposition_m = [0, 1, 0]\nlook_at_m = [1, 0, 0]\n\
    lens = { type = \"pinhole\", focal_length_mm = 6, f_number = 4 }\nsensor = { width_px = 16, height_px = 16, pixel_pitch_um = 100 }\n\
    [render]\nspp = 1\nreplicates = 1\nintegrator = \"flat\"\ntile_px = 16\n[output]\nground_truth = false\n\
    [scene.environment]\ntype = \"uniform\"\nluminance_cd_m2 = 100\nilluminant = \"D65\"\n\
    [[scene.materials]]\nname = \"grey\"\ntype = \"diffuse\"\nreflectance = 0.5\n\
    [[scene.objects]]\nname = \"ball\"\nmaterial = \"grey\"\nshape = { type = \"sphere\", radius_m = 0.5 }\n\
    keys = [{ time_s = 0, position_m = [3, 0, 0] }, { time_s = 1, position_m = [3, 1, 0] }]\n";

/// Heading, the frame's number, place and count, number done and total.
type ProgressCall = (String, Option<(u32, u32, u32)>, usize, usize);

#[derive(Default)]
struct ProgressRecorder(Mutex<Vec<ProgressCall>>);

impl Observer for ProgressRecorder {
    fn progress(&self, progress: Progress<'_>) {
        let frame = progress.frame.map(|frame| (frame.number, frame.place, frame.count));
        self.0.lock().expect("no panic").push((progress.heading.to_owned(), frame, progress.done, progress.total));
    }
}

fn watched_calls(existing: ExistingFiles, folder: &std::path::Path) -> Vec<ProgressCall> {
    let mut files = MemoryFiles::new();
    files.add_text("job.toml", JOB);
    let job = JobRequest::new("job.toml").open_in(&files).unwrap_or_else(|error| panic!("{error}"));
    let options = RenderOptions { frames: 5..8, ..RenderOptions::default() };
    let watch = ProgressRecorder::default();
    job.save(&options, folder, existing, &watch).expect("rendered");
    watch.0.into_inner().expect("no panic")
}

#[test]
fn tiles_of_all_cameras_and_frames_are_counted_together() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut calls = watched_calls(ExistingFiles::Refuse, folder.path());
    // Threads may report in another order than they count.
    calls.sort_by_key(|(_, _, done, _)| *done);
    let done: Vec<usize> = calls.iter().map(|(_, _, done, _)| *done).collect();
    assert_eq!(done, (1..=15).collect::<Vec<_>>(), "3 frames of 4 and of 1 tiles");
    assert!(calls.iter().all(|(_, _, _, total)| *total == 15));
    let of = |done: usize| (calls[done - 1].0.as_str(), calls[done - 1].1);
    assert_eq!((of(1), of(12)), (("wide", Some((5, 1, 3))), ("wide", Some((7, 3, 3)))));
    assert_eq!((of(13), of(15)), (("small", Some((5, 1, 3))), ("small", Some((7, 3, 3)))));
}

#[test]
fn frames_that_are_kept_are_not_counted_again() {
    let folder = tempfile::tempdir().expect("a folder");
    watched_calls(ExistingFiles::Refuse, folder.path());
    std::fs::remove_file(folder.path().join("wide/frame.0006.json")).expect("a frame");
    let calls = watched_calls(ExistingFiles::Resume, folder.path());
    assert_eq!(calls.len(), 4);
    assert!(calls.iter().all(|(name, frame, _, total)| name == "wide" && *frame == Some((6, 2, 3)) && *total == 4));
}
