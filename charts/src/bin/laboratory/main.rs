//! How often the intervals of `etendue characterise` hold the truth: laboratory folders of the reference cameras, each with noise and a specimen of its own,
//! are photographed and characterised. Writes coverage.md in the folder of renders, from which docs/characterise.md has its table; exit status 1 where an interval holds too seldom.
//!
//! `just laboratory` runs all cameras with 50 seeds, `just laboratory 20 web` some seeds of some; with `--resume` the seeds that an earlier run has done are
//! taken from its folder.
//! Environment: BENCH names the folder of renders (default: target/laboratory).

#![allow(clippy::print_stdout, clippy::print_stderr, reason = "a program that reports to its user")]

mod coverage;
mod declared;
mod seed;

use coverage::{Rows, introduction, table};
use etendue::{Error, ErrorCode, ExistingFiles, write_file};
use seed::SeededLaboratory;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

const SEEDS: u64 = 50;
const RESUME: &str = "--resume";
/// A camera of charts/, and how it is made small: the same field, noise and charge in fewer pixels.
const CAMERAS: [(&str, [&str; 3]); 3] = [
    ("ccd-mono", ["sensor.width_px=388", "sensor.height_px=291", "sensor.pixel_pitch_um=16.6"]),
    ("ccd-bayer", ["sensor.width_px=388", "sensor.height_px=292", "sensor.pixel_pitch_um=16.6"]),
    ("web", ["sensor.width_px=320", "sensor.height_px=256", "sensor.pixel_pitch_um=14.4"]),
];

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    match run(&arguments) {
        Ok(broken) if broken.is_empty() => ExitCode::SUCCESS,
        Ok(broken) => {
            broken.iter().for_each(|line| eprintln!("below 90 %: {line}"));
            ExitCode::FAILURE
        }
        Err(error) => {
            eprintln!("{error}");
            ExitCode::from(2)
        }
    }
}

fn run(arguments: &[String]) -> Result<Vec<String>, Error> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("charts/ lies in the repository");
    std::env::set_current_dir(root).map_err(Error::run)?;
    let (resume, arguments): (Vec<&String>, Vec<&String>) = arguments.iter().partition(|a| *a == RESUME);
    let seeds = match arguments.first() {
        Some(count) => count
            .parse()
            .map_err(|_| Error::coded(ErrorCode::InvalidArgument, format!("{count}: expected a number of seeds")))?,
        None => SEEDS,
    };
    let named = arguments.get(1..).unwrap_or_default();
    if let Some(unknown) = named.iter().find(|name| CAMERAS.iter().all(|(own, _)| own != *name)) {
        return Err(Error::coded(
            ErrorCode::InvalidArgument,
            format!("{unknown}: expected a reference camera: ccd-mono, ccd-bayer or web"),
        ));
    }
    let is_selected = |name: &str| named.is_empty() || named.iter().any(|own| *own == name);
    let folder = PathBuf::from(std::env::var_os("BENCH").unwrap_or_else(|| "target/laboratory".into()));
    let mut page = introduction(seeds);
    let mut broken = Vec::new();
    for (name, set) in CAMERAS.iter().filter(|(name, _)| is_selected(name)) {
        let mut rows = Rows::new();
        for seed in 1..=seeds {
            let seed = SeededLaboratory { camera: name, set, seed };
            let seed_report = seed.seed_report(&folder, !resume.is_empty())?;
            coverage::gather(&seed_report, &mut rows);
            eprintln!("{name}: seed {} of {seeds}", seed.seed);
        }
        page += &table(name, &rows);
        broken.extend(
            rows.iter().filter_map(|(key, row)| row.broken(seeds).map(|reason| format!("{name}: {key}: {reason}"))),
        );
    }
    let file = folder.join("coverage.md");
    write_file(&file, page.as_bytes(), ExistingFiles::Replace)?;
    println!("{}", file.display());
    Ok(broken)
}
