//! Films of a hundred megapixels, whose bands are on the disk: peak memory and time, each job in a process of its own.

use crate::child;
use crate::memory::peak_mb;
use etendue::{ExistingFiles, FilmMemory, JobRequest, NullObserver, RenderOptions};
use etendue_bench_rays::clock::process_cpu_s;
use etendue_bench_rays::table::Table;
use etendue_bench_rays::threads::pool;
use std::path::{Path, PathBuf};

/// The argument that asks a child process for memory and time of a job of a folder.
pub const CHILD: &str = "--films-within";

const NOTE: &str = "A ball on a floor under an even sky, 12 000 × 8 400 px, 22 bands of 18 nm, 1 sample a pixel, with everything that is written; two threads. Processor \
    time of all, and most memory resident at any time; page cache is not in it. Takes up to 25 GB of the folder for temporary files. More than \
    4 GiB end the benchmark.";

/// Memory that a job may take, MB.
const MAX_MEMORY_MB: f64 = 4294.0;

/// Jobs: how a camera reaches its sensor, what the sensor is, and what is delivered.
const JOBS: [(&str, &str, &str, &str); 3] = [
    ("radiance at the pupil, distances", "pupil", "", "radiance = true\nground_truth = false"),
    ("radiance through the lens, ground truth", "lens", "", "radiance = true\nground_truth = true"),
    (
        "radiance, electrons of its bands, raw, picture",
        "lens",
        ELECTRONICS,
        "radiance = true\nelectrons = true\nraw = true\npicture = true\nground_truth = false",
    ),
];

const ELECTRONICS: &str = "exposure_s = 0.01, cfa = \"rggb\", quantum_efficiency = { camera = \"nikon-d5100\", peak = 0.5 }, full_well_e = 20000, read_noise_e = 5, \
     bits = 12, gain_dn_per_e = 0.2, dark_current_e_s = 5, black_level_dn = 60";

/// Memory and time by the job.
pub fn table() -> Table {
    let folder = JobFolder::new();
    let path = folder.0.to_str().expect("a folder of temporary files whose name is text");
    let mut table = Table::new("Films larger than memory", NOTE, &["job", "processor, s", "memory, MB"]);
    for (i, (name, ..)) in JOBS.iter().enumerate() {
        let row = child::row(name, &[CHILD, path, &i.to_string()]);
        let memory_mb = row.last().and_then(|mb| mb.parse::<f64>().ok());
        assert!(memory_mb.is_none_or(|mb| mb < MAX_MEMORY_MB), "{name}: {row:?}");
        table.row(row);
    }
    table
}

/// Renders a job of a folder and writes what it delivers; processor time, s, and megabytes at most.
pub fn child(folder: &str, job: &str) -> String {
    let folder = Path::new(folder);
    let films = FilmMemory { scratch: Some(folder.join("scratch")), ..FilmMemory::default() };
    let output = folder.join("out");
    pool(2).install(|| {
        let request = JobRequest { films, ..JobRequest::new(folder.join(format!("{job}.toml"))) };
        let job = request.open().unwrap_or_else(|errors| panic!("{errors}"));
        let result = job.save(&RenderOptions::default(), &output, ExistingFiles::Replace, &NullObserver);
        result.unwrap_or_else(|error| panic!("{error}"))
    });
    std::fs::remove_dir_all(&output).expect("the folder of temporary files can be written to");
    format!("{:.0} {}", process_cpu_s(), peak_mb())
}

/// A folder with the jobs, removed at the end.
struct JobFolder(PathBuf);

impl JobFolder {
    fn new() -> Self {
        let folder = Self(std::env::temp_dir().join(format!("etendue-films-{}", std::process::id())));
        std::fs::create_dir_all(&folder.0).expect("the folder of temporary files can be written to");
        for (i, (_, route, sensor, output)) in JOBS.iter().enumerate() {
            let written = std::fs::write(folder.0.join(format!("{i}.toml")), job(route, sensor, output));
            written.expect("the folder of temporary files can be written to");
        }
        folder
    }
}

impl Drop for JobFolder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

fn job(route: &str, sensor: &str, output: &str) -> String {
    let (comma, isp) = if sensor.is_empty() { ("", "") } else { (", ", "isp = { white_balance = \"D65\" }\n") };
    format!(
        "format = 1\n[render]\nspp = 1\nband_width_nm = 18\nwavelength_range_nm = [384, 780]\n\
         [scene]\nenvironment = {{ type = \"uniform\", luminance_cd_m2 = 100, illuminant = \"D65\" }}\n\
         materials = [{{ name = \"grey\", type = \"diffuse\", reflectance = 0.5 }}]\n\
         [[scene.objects]]\nname = \"ball\"\nshape = {{ type = \"sphere\", radius_m = 1 }}\nposition_m = [5, 0, 0]\nmaterial = \"grey\"\n\
         [[scene.objects]]\nname = \"floor\"\nshape = {{ type = \"quad\", size_m = [40, 40] }}\nposition_m = [5, 0, -1]\nmaterial = \"grey\"\n\
         [[cameras]]\nname = \"front\"\nposition_m = [0, 0, 0]\nlook_at_m = [6, 0, 0]\n\
         lens = {{ type = \"thin\", focal_length_mm = 50, f_number = 8, focus_distance_m = 5 }}\n{isp}\
         sensor = {{ width_px = 12000, height_px = 8400, pixel_pitch_um = 4{comma}{sensor} }}\nrender = {{ route = \"{route}\" }}\n\
         [output]\n{output}\n"
    )
}
