//! Textures that need more memory than they may take: peak memory and time, each run in a process of its own.

use crate::child;
use crate::memory::peak_mb;
use crate::scenes::{camera, plan_within};
use etendue_bench_rays::clock::process_cpu_s;
use etendue_bench_rays::table::Table;
use etendue_bench_rays::threads::pool;
use etendue_core::Plane;
use etendue_core::quantity::Display;
use etendue_io::TextureMemory;
use etendue_io::photograph::Encoding;
use etendue_io::png::encode_display;
use etendue_pipeline::NullObserver;
use etendue_pipeline::render::{LightRequest, light};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

/// The argument that asks a child process for memory and time of the job of a folder, within so many megabytes.
pub const CHILD: &str = "--textures-within";

const NOTE: &str = "Twelve PNGs of 8192 × 8192 px (2.4 GB of bytes, 5.6 GB at all resolutions) on twelve quads of 4 m, 640 × 400 px, 4 samples a \
    pixel; two threads. Processor time of loading, compiling and rendering, and most memory resident at any time. Takes 6 GB of the folder for \
    temporary files. More than a gibibyte at the limit of 512 MB ends the benchmark.";

/// Pictures, and columns and rows of each.
const PICTURES: usize = 12;
const SIDE: usize = 8192;

/// Limits of the memory of textures, MB; the first run makes the tiles.
const RUNS: [(&str, &str); 4] = [
    ("tiles that are made, 512 MB", "512"),
    ("tiles that are there, 512 MB", "512"),
    ("tiles that are there, 64 MB", "64"),
    ("tiles that are there, 8 MB", "8"),
];

/// Memory and time by the limit.
pub fn table() -> Table {
    let folder = JobFolder::new();
    let path = folder.0.to_str().expect("a folder of temporary files whose name is text");
    let mut table = Table::new("Textures larger than memory", NOTE, &["textures", "processor, s", "memory, MB"]);
    for (name, limit_mb) in RUNS {
        let row = child::row(name, &[CHILD, path, limit_mb]);
        let memory_mb = row.last().and_then(|mb| mb.parse::<f64>().ok());
        assert!(memory_mb.is_none_or(|mb| mb * 1e6 < f64::from(1 << 30)), "{name}: {row:?}");
        table.row(row);
    }
    table
}

/// Renders the job of a folder; processor time, s, and megabytes at most.
pub fn child(folder: &str, limit_mb: &str) -> String {
    let limit_mb: u64 = limit_mb.parse().expect("a whole number of megabytes");
    let folder = Path::new(folder);
    let memory = TextureMemory {
        limit_bytes: limit_mb * 1_000_000,
        cache: Some(folder.join("cache")),
        ..TextureMemory::default()
    };
    let film = pool(2).install(|| {
        let plan = plan_within(&folder.join("job.toml"), &memory);
        light(&plan, camera(&plan), LightRequest::default(), &NullObserver)
    });
    std::hint::black_box(film.expect("nobody cancels"));
    format!("{:.1} {}", process_cpu_s(), peak_mb())
}

/// A folder with the job and its pictures, removed at the end.
struct JobFolder(PathBuf);

impl JobFolder {
    fn new() -> Self {
        let folder = Self(std::env::temp_dir().join(format!("etendue-textures-{}", std::process::id())));
        let write = |name: String, bytes: &[u8]| std::fs::write(folder.0.join(name), bytes);
        let written = std::fs::create_dir_all(&folder.0).and_then(|()| write("job.toml".to_owned(), job().as_bytes()));
        let image = texture_image();
        // What follows the end of a PNG is not a part of it, and makes another file.
        let images = (0..PICTURES).try_for_each(|i| write(format!("{i}.png"), &[&image[..], &[i as u8]].concat()));
        written.and(images).expect("the folder of temporary files can be written to");
        folder
    }
}

impl Drop for JobFolder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

fn job() -> String {
    let mut job = "format = 1\n[render]\nspp = 4\n[scene]\nenvironment = { type = \"uniform\", luminance_cd_m2 = 100, illuminant = \"D65\" }\n\
                   [[cameras]]\nname = \"front\"\nposition_m = [-1, 0, 1.6]\nlook_at_m = [8, 0, 0]\nsensor = { width_px = 640, height_px = 400, \
                   pixel_pitch_um = 12 }\nlens = { type = \"pinhole\", focal_length_mm = 6, f_number = 2 }\n"
        .to_owned();
    for i in 0..PICTURES {
        let (x, y) = (3 + 4 * (i / 3), 4 * (i % 3) as i32 - 4);
        write!(
            job,
            "[[scene.textures]]\nname = \"t{i}\"\nfile = \"{i}.png\"\nencoding = \"srgb\"\n[[scene.materials]]\nname = \"m{i}\"\n\
             type = \"diffuse\"\nreflectance = {{ texture = \"t{i}\" }}\n[[scene.objects]]\nname = \"o{i}\"\nmaterial = \"m{i}\"\n\
             shape = {{ type = \"quad\", size_m = [4, 4] }}\nposition_m = [{x}, {y}, 0]\n"
        )
        .expect("memory");
    }
    job
}

/// A PNG of stripes that are small as a file.
fn texture_image() -> Vec<u8> {
    let byte = |x: usize, y: usize, c: usize| (16 + (x * (3 + c) + y * 6 + (x * y) / 64) % 200) as f32;
    let places = (0..SIDE).flat_map(|y| (0..SIDE).map(move |x| (x, y)));
    let samples = places.map(|(x, y)| [0, 1, 2].map(|c| byte(x, y, c) / 255.0)).collect();
    let image = Plane::<Display>::from_samples(SIDE, SIDE, samples).expect("as many as it takes");
    encode_display(&image, &Encoding::Srgb).expect("encodable")
}
