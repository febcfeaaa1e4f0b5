//! Flicker of frames with a side-car: timing need not be stated again.

use etendue::measure::{FlickerRequest, flicker};
use etendue::{ExistingFiles, JobRequest, MemoryFiles, NullObserver, RenderOptions};
use std::path::{Path, PathBuf};

/// A lamp on mains of 50 Hz fills the image; rows of 250 µs, 25 frames per second.
const JOB: &str = "format = 1\n[sequence]\nframe_rate_hz = 25\n\
    [[cameras]]\nname = \"eye\"\nposition_m = [0, 0, 0]\nlook_at_m = [1, 0, 0]\n\
    lens = { type = \"pinhole\", focal_length_mm = 6, f_number = 4 }\n\
    sensor = { width_px = 24, height_px = 120, pixel_pitch_um = 10, exposure_s = 0.002, cfa = \"mono\", quantum_efficiency = 0.5, \
    full_well_e = 60000, read_noise_e = 2, dark_current_e_s = 0, gain_dn_per_e = 0.05, black_level_dn = 16, bits = 12, \
    shutter = { type = \"rolling\", row_time_us = 250 } }\n\
    [render]\nspp = 2\nintegrator = \"flat\"\n[output]\nground_truth = false\n\
    [[scene.materials]]\nname = \"glow\"\ntype = \"emitter\"\nemission = { luminance_cd_m2 = 400, illuminant = \"D65\", \
    modulation = { type = \"mains\", frequency_hz = 50, modulation_depth = 0.6 } }\n\
    [[scene.objects]]\nname = \"panel\"\nmaterial = \"glow\"\nshape = { type = \"quad\", size_m = [20, 20] }\nposition_m = [2, 0, 0]\n\
    rotation_deg = [0, -90, 0]\n";

fn frames(folder: &Path, numbers: &[u32]) -> Vec<PathBuf> {
    let mut files = MemoryFiles::new();
    files.add_text("job.toml", JOB);
    let job = JobRequest::new("job.toml").open_in(&files).unwrap_or_else(|error| panic!("{error}"));
    let options = RenderOptions { frames: 0..5, ..RenderOptions::default() };
    job.save(&options, folder, ExistingFiles::Refuse, &NullObserver).expect("rendered");
    numbers.iter().map(|number| folder.join(format!("eye/raw.{number:04}.png"))).collect()
}

fn measured_flicker(request: &FlickerRequest) -> (f64, f64, Vec<String>) {
    let report = flicker(request).unwrap_or_else(|error| panic!("{error}"));
    let value = |key: &str| report.value(key).unwrap_or_else(|| panic!("{key}: {:?}", report.notes())).value;
    (value("frequency_hz"), value("amplitude_light"), report.notes().to_vec())
}

#[test]
fn times_are_those_of_the_side_car() {
    let folder = tempfile::tempdir().expect("a folder");
    let frames = frames(folder.path(), &[0, 1, 2, 3]);
    let (frequency_hz, depth, notes) = measured_flicker(&FlickerRequest::new(frames.clone()));
    // Shot noise of ten thousand electrons per pixel, 24 pixels per row, 480 rows: far below.
    assert!((frequency_hz - 100.0).abs() < 0.1 && (depth - 0.6).abs() < 0.01, "{frequency_hz} Hz, {depth}");
    let expected = "row time 250 µs, frame rate 25 Hz, exposure 2000 µs";
    assert!(notes.iter().any(|note| note.contains("camera.json") && note.contains(expected)), "{notes:?}");
    let stated = FlickerRequest {
        row_time_us: Some(250.0),
        frame_rate_hz: Some(25.0),
        exposure_us: Some(2000.0),
        ..FlickerRequest::new(frames)
    };
    let (again_hz, repeated, notes) = measured_flicker(&stated);
    assert_eq!((again_hz, repeated), (frequency_hz, depth));
    assert!(!notes.iter().any(|note| note.contains("camera.json")), "{notes:?}");
}

#[test]
fn an_option_overrides_the_side_car_and_says_so() {
    let folder = tempfile::tempdir().expect("a folder");
    let frames = frames(folder.path(), &[0, 2, 4]);
    let request = FlickerRequest { row_time_us: Some(125.0), frame_rate_hz: Some(25.0), ..FlickerRequest::new(frames) };
    let (frequency_hz, _, notes) = measured_flicker(&request);
    assert!((frequency_hz - 200.0).abs() < 1.0, "rows in half the time: {frequency_hz} Hz");
    let is_noted = |words: &str| notes.iter().any(|note| note.contains(words));
    assert!(is_noted("`row_time_us` 125 is used") && is_noted("states 250 µs"), "{notes:?}");
    // Every second frame.
    assert!(is_noted("`frame_rate_hz` 25 is used") && is_noted("states 12.5 Hz"), "{notes:?}");
}
