//! The validation bench: renders charts with the reference cameras, measures the pictures and lays what was found beside what the camera
//! files declare. Writes docs/evidence/validation.md with its plots; exit status 1 where a bound is broken, 2 where something fails.
//!
//! `just validate` runs all; `just validate web ccd-mono` runs those that are named and leaves the page in the folder of renders.
//! Everything is rendered again each time. Environment: BENCH names the folder of renders (default: target/validation).

#![allow(clippy::print_stdout, clippy::print_stderr, reason = "a program that reports to its user")]

mod bounds;
mod cameras;
mod comparison;
mod electronics;
mod geometry;
mod light;
mod page;
mod response;
mod run;

use cameras::{Bench, CAMERAS, ReferenceCamera};
use etendue::Error;
use page::{RecoveryReport, Section};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

/// A part of the bench, and what it finds.
type BenchPart = (&'static str, fn(&Bench) -> Result<Vec<Section>, Error>);

const PARTS: [BenchPart; 4] = [
    ("distortion and focal length", geometry::sections),
    // Before the light: what dark current adds to a picture is taken off there.
    ("photon transfer and dark current", electronics::sections),
    ("vignetting and tone curve", light::sections),
    ("response", response::sections),
];

fn main() -> ExitCode {
    let names: Vec<String> = std::env::args().skip(1).collect();
    match validated(&names) {
        Ok(broken) if broken.is_empty() => ExitCode::SUCCESS,
        Ok(broken) => {
            broken.iter().for_each(|line| eprintln!("broken: {line}"));
            ExitCode::FAILURE
        }
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::from(2)
        }
    }
}

/// Runs the bench: the bounds that are broken.
fn validated(names: &[String]) -> Result<Vec<String>, String> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().ok_or("charts/ lies in the repository")?;
    std::env::set_current_dir(root).map_err(|error| error.to_string())?;
    let cameras = chosen(names)?;
    let all_cameras = cameras.len() == CAMERAS.len();
    let folder = PathBuf::from(std::env::var_os("BENCH").unwrap_or_else(|| "target/validation".into()));
    let image_folder = if all_cameras { PathBuf::from("docs/evidence/pictures") } else { folder.join("pictures") };
    std::fs::create_dir_all(&image_folder).map_err(|error| format!("{}: {error}", image_folder.display()))?;
    let report = |camera: &ReferenceCamera| {
        let folder = emptied(&folder.join(camera.name))?;
        let bench = Bench { camera: *camera, folder, pictures: image_folder.clone() };
        reported(&bench)
    };
    let reports = cameras.iter().map(report).collect::<Result<Vec<_>, String>>()?;
    let page = if all_cameras { PathBuf::from("docs/evidence/validation.md") } else { folder.join("validation.md") };
    std::fs::write(&page, page::page(&reports)).map_err(|error| format!("{}: {error}", page.display()))?;
    println!("{}", page.display());
    Ok(reports.iter().flat_map(broken).collect())
}

fn chosen(names: &[String]) -> Result<Vec<ReferenceCamera>, String> {
    let find = |name: &String| {
        let known = || CAMERAS.map(|c| c.name).join(", ");
        CAMERAS.into_iter().find(|c| c.name == name).ok_or_else(|| format!("no camera '{name}'; there are {}", known()))
    };
    if names.is_empty() { Ok(CAMERAS.to_vec()) } else { names.iter().map(find).collect() }
}

/// A folder with nothing of earlier runs in it.
fn emptied(folder: &Path) -> Result<PathBuf, String> {
    let message = |error: std::io::Error| format!("{}: {error}", folder.display());
    if folder.exists() {
        std::fs::remove_dir_all(folder).map_err(message)?;
    }
    std::fs::create_dir_all(folder).map_err(message)?;
    Ok(folder.to_path_buf())
}

fn reported(bench: &Bench) -> Result<RecoveryReport, String> {
    let mut sections = Vec::new();
    for (title, part) in PARTS {
        let start = Instant::now();
        eprint!("{}: {title} … ", bench.camera.name);
        sections.extend(part(bench).map_err(|error| error.to_string())?);
        eprintln!("{:.0} s", start.elapsed().as_secs_f64());
    }
    Ok(RecoveryReport { camera: bench.camera.name, sections })
}

fn broken(report: &RecoveryReport) -> Vec<String> {
    let message = |r: &comparison::BoundResult| {
        format!("{}: {}: {:?}, E_n {:?}; expected {}", report.camera, r.quantity, r.error, r.e_n, r.bound.text())
    };
    report.reached().filter(|r| !r.holds()).map(message).collect()
}
