//! How often the intervals of `etendue characterise` hold the truth: laboratory folders of the reference cameras, each with noise and a specimen of its own,
//! are photographed and characterised. Writes coverage.md in the folder of renders, from which docs/characterise.md has its table; exit status 1 where an interval holds too seldom.
//!
//! `just laboratory` runs all cameras with 50 seeds, `just laboratory 20 web` some seeds of some.
//! Environment: BENCH names the folder of renders (default: target/laboratory).

#![allow(clippy::print_stdout, clippy::print_stderr, reason = "a program that reports to its user")]

use etendue::characterise::{CharacteriseRequest, characterise};
use etendue::measure::{CompareRequest, compare};
use etendue::{Error, Existing, LaboratoryRequest, Unobserved, laboratory, write_file};
use serde_json::Value;
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

const SEEDS: u64 = 50;
/// A camera of charts/, and how it is made small: the same field, noise and charge in fewer pixels.
const CAMERAS: [(&str, [&str; 3]); 3] = [
    ("ccd-mono", ["sensor.width_px=388", "sensor.height_px=291", "sensor.pixel_pitch_um=16.6"]),
    ("ccd-bayer", ["sensor.width_px=388", "sensor.height_px=292", "sensor.pixel_pitch_um=16.6"]),
    ("web", ["sensor.width_px=320", "sensor.height_px=256", "sensor.pixel_pitch_um=14.4"]),
];
const WAVELENGTH_NM: f64 = 550.0;
/// What a camera file declares of a measurement, the parameter that it is of, and the factor between them.
const DECLARED: [(&str, &str, &str, f64); 17] = [
    ("ptc", "gain_dn_per_e", "sensor.gain_dn_per_e", 1.0),
    ("ptc", "dark_noise_e", "sensor.read_noise_e", 1.0),
    ("ptc", "dark_current_mean_e_per_s", "sensor.dark_current_e_s", 1.0),
    ("ptc", "quantum_efficiency", "sensor.quantum_efficiency.mono", 1.0),
    ("ptc", "quantum_efficiency", "sensor.quantum_efficiency.green", 1.0),
    ("ptc", "dsnu_e_pixel", "sensor.non_uniformity.dsnu_e", 1.0),
    ("ptc", "dsnu_e_row", "sensor.non_uniformity.dsnu_row_e", 1.0),
    ("ptc", "dsnu_e_column", "sensor.non_uniformity.dsnu_column_e", 1.0),
    ("ptc", "prnu_percent_pixel", "sensor.non_uniformity.prnu", 0.01),
    ("ptc", "prnu_percent_row", "sensor.non_uniformity.prnu_row", 0.01),
    ("ptc", "prnu_percent_column", "sensor.non_uniformity.prnu_column", 0.01),
    ("calibrate", "fx_px", "lens.projection.fx_px", 1.0),
    ("calibrate", "fy_px", "lens.projection.fy_px", 1.0),
    ("calibrate", "cx_px", "lens.projection.cx_px", 1.0),
    ("calibrate", "cy_px", "lens.projection.cy_px", 1.0),
    ("calibrate", "k1", "lens.projection.k1", 1.0),
    ("calibrate", "k2", "lens.projection.k2", 1.0),
];
const CORNER: &str = "lens.relative_illumination.corner_percent";

/// A parameter over the seeds.
#[derive(Default)]
struct Row {
    /// Value and standard uncertainty.
    found: Vec<[f64; 2]>,
    declared: Option<f64>,
}

type Rows = BTreeMap<String, Row>;

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
    let seeds = arguments.first().and_then(|n| n.parse().ok()).unwrap_or(SEEDS);
    let named = |name: &str| arguments.len() < 2 || arguments[1..].iter().any(|wanted| wanted == name);
    let folder = PathBuf::from(std::env::var_os("BENCH").unwrap_or_else(|| "target/laboratory".into()));
    let mut page = INTRODUCTION.replace("SEEDS", &seeds.to_string());
    let mut broken = Vec::new();
    for (name, set) in CAMERAS.iter().filter(|(name, _)| named(name)) {
        let rows = camera(name, set, seeds, &folder)?;
        page += &table(name, &rows);
        broken.extend(rows.iter().filter_map(|(key, row)| row.broken().map(|why| format!("{name}: {key}: {why}"))));
    }
    let file = folder.join("coverage.md");
    write_file(&file, page.as_bytes(), Existing::Replace)?;
    println!("{}", file.display());
    Ok(broken)
}

/// All parameters of a camera over the seeds.
fn camera(name: &str, set: &[&str], seeds: u64, folder: &Path) -> Result<Rows, Error> {
    let mut rows = Rows::new();
    for seed in 1..=seeds {
        let place = folder.join(name);
        if place.exists() {
            std::fs::remove_dir_all(&place).map_err(Error::run)?;
        }
        let specimen = format!("sensor.non_uniformity.seed={seed}");
        let set = set.iter().map(|change| (*change).to_owned()).chain([specimen]).collect();
        let request = LaboratoryRequest {
            set,
            seed,
            levels: 12,
            stack: 16,
            views: 9,
            spp: 32,
            ..LaboratoryRequest::new(format!("charts/{name}/camera.toml"))
        };
        laboratory(&request, (&place, Existing::Refuse), &Unobserved)?;
        let found = characterise(&CharacteriseRequest::new(&place), &Unobserved)?;
        found.save(&place.join("found.toml"), Existing::Refuse)?;
        gather(&place, &mut rows)?;
        eprintln!("{name}: seed {seed} of {seeds}");
    }
    Ok(rows)
}

/// Takes in what one laboratory told.
fn gather(place: &Path, rows: &mut Rows) -> Result<(), Error> {
    let text = std::fs::read_to_string(place.join("found.json")).map_err(Error::run)?;
    let report: Value = serde_json::from_str(&text).map_err(Error::run)?;
    for (key, value) in report["parameters"].as_object().into_iter().flatten() {
        if let (Some(v), Some(u)) = (value["value"].as_f64(), value["standard_uncertainty"].as_f64()) {
            rows.entry(key.clone()).or_default().found.push([v, u]);
        }
    }
    for kind in ["ptc", "calibrate", "vignetting"] {
        let file = place.join(format!("{kind}.json"));
        write_file(&file, report["measurements"][kind].to_string().as_bytes(), Existing::Replace)?;
        let wavelength_nm = (kind == "ptc").then_some(WAVELENGTH_NM);
        // Hot pixels are told by themselves, and are no part of the dark current.
        let set = if kind == "ptc" { vec!["sensor.dark.hot=null".to_owned()] } else { Vec::new() };
        let request = CompareRequest { wavelength_nm, set, ..CompareRequest::new(file, place.join("declared.toml")) };
        let compared = compare(&request)?.report.json();
        for row in compared["tables"]["quantities"].as_array().into_iter().flatten() {
            let declared = row["b"]["value"].as_f64();
            let known = DECLARED.iter().filter(|(of, quantity, ..)| *of == kind && row["quantity"] == *quantity);
            for (_, _, key, factor) in known {
                if let Some(row) = rows.get_mut(*key) {
                    row.declared = declared.map(|d| factor * d);
                }
            }
            if let Some(corner) = rows.get_mut(CORNER).filter(|_| row["quantity"] == "corner_percent") {
                corner.declared = declared;
            }
        }
    }
    // Of the reference cameras' files themselves: thin lenses without diffraction, and monochrome pixels that exchange nothing.
    for direction in ["horizontal", "vertical"] {
        if let Some(row) = rows.get_mut(&format!("effects.psf.variance_{direction}_px2")) {
            row.declared = Some(0.0);
        }
    }
    Ok(())
}

impl Row {
    fn mean(&self) -> f64 {
        self.found.iter().map(|[v, _]| v).sum::<f64>() / self.found.len() as f64
    }

    /// What the intervals should hold: what is declared, or the mean over the seeds.
    fn truth(&self) -> f64 {
        self.declared.unwrap_or_else(|| self.mean())
    }

    fn held(&self) -> usize {
        let truth = self.truth();
        self.found.iter().filter(|[v, u]| (v - truth).abs() <= 2.0 * u).count()
    }

    /// Whether the intervals hold the truth in less than 90 % of the seeds, as far as so many seeds tell (binomial, 2 σ).
    fn broken(&self) -> Option<String> {
        let (count, held) = (self.found.len() as f64, self.held() as f64);
        let margin = 2.0 * (0.9 * 0.1 / count).sqrt();
        (held / count < 0.9 - margin).then(|| format!("{held} of {count}"))
    }
}

const INTRODUCTION: &str = "# How often the intervals of characterise hold the truth

Written by `just laboratory`: laboratory folders of the three reference cameras (`charts/*/camera.toml`, made small: the same field in fewer, larger pixels) are
photographed with SEEDS seeds, each with noise and a specimen of its own, and characterised. Held: in how many the stated 95 % interval (value ± 2 standard
uncertainties) holds what the camera file declares; where it declares no number of this kind, the mean over the seeds (\"mean\"), which tells the
scatter and no bias. Numbers that cannot be below 0 and whose truth is 0 are held more often than 95 %, as their intervals are one-sided there.
";

fn table(name: &str, rows: &Rows) -> String {
    let mut text = format!(
        "\n## {name}\n\n| parameter | declared | mean found | mean standard uncertainty | scatter | held | of |\n| --- | --- | --- | --- | --- | --- | --- |\n"
    );
    for (key, row) in rows {
        let count = row.found.len() as f64;
        let u = row.found.iter().map(|[_, u]| u).sum::<f64>() / count;
        let mean = row.mean();
        let scatter =
            (row.found.iter().map(|[v, _]| (v - mean) * (v - mean)).sum::<f64>() / (count - 1.0).max(1.0)).sqrt();
        let declared = row.declared.map_or_else(|| "mean".to_owned(), number);
        let share = 100.0 * row.held() as f64 / count;
        let _ = writeln!(
            text,
            "| `{key}` | {declared} | {} | {u:.2e} | {scatter:.2e} | {share:.0} % | {count} |",
            number(mean)
        );
    }
    text
}

/// To five digits.
fn number(x: f64) -> String {
    if x == 0.0 {
        return "0".to_owned();
    }
    let exponent = format!("{x:e}").split_once('e').and_then(|(_, exponent)| exponent.parse::<i32>().ok()).unwrap_or(0);
    match exponent {
        -3..=5 => format!("{x:.*}", (4 - exponent).max(0) as usize),
        _ => format!("{x:.4e}"),
    }
}
