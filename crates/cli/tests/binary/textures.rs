//! Textures beyond their memory limit: stored in tiles on disk, with equal bytes of every result.

use crate::support::{assert_same, etendue, etendue_with, rendered, text};
use etendue_core::Plane;
use etendue_core::quantity::Display;
use etendue_io::photograph::Encoding;
use etendue_io::png::encode_display;
use std::fs;
use std::path::{Path, PathBuf};

/// Three images on three quads, near and far: as colours by coordinates, as colours from three sides, as a roughness.
const JOB: &str = r#"format = 1
[render]
spp = 4
[scene]
environment = { type = "uniform", luminance_cd_m2 = 100, illuminant = "D65" }
textures = [
  { name = "a", file = "a.png", encoding = "srgb" },
  { name = "b", file = "b.png", encoding = "linear", mapping = "triplanar", size_m = 3 },
  { name = "c", file = "c.png", encoding = "data", wrap = "mirror", uv_scale = [3, 2] },
]
materials = [
  { name = "a", type = "diffuse", reflectance = { texture = "a" } },
  { name = "b", type = "diffuse", reflectance = { texture = "b" } },
  { name = "c", type = "conductor", metal = "Au", alpha = { texture = "c", channel = "g", scale = 0.6 } },
]
[[scene.objects]]
name = "near"
shape = { type = "quad", size_m = [4, 8] }
position_m = [1, 0, 0]
material = "a"
[[scene.objects]]
name = "middle"
shape = { type = "quad", size_m = [4, 8] }
position_m = [5, 0, 0]
material = "b"
[[scene.objects]]
name = "far"
shape = { type = "quad", size_m = [40, 80] }
position_m = [27, 0, 0]
material = "c"
[[cameras]]
name = "front"
position_m = [-1, 0, 1.5]
look_at_m = [6, 0, 0]
lens = { type = "pinhole", focal_length_mm = 6, f_number = 8 }
sensor = { width_px = 48, height_px = 32, pixel_pitch_um = 150 }
"#;

/// A folder with the job, and images of 23 MB at all resolutions: 5.3 MB each of bytes, and 12.2 MB of the scaled numbers.
struct TextureJob {
    folder: tempfile::TempDir,
}

impl TextureJob {
    fn new() -> Self {
        let folder = tempfile::tempdir().expect("a temporary folder");
        fs::write(folder.path().join("job.toml"), JOB).expect("written");
        for (i, name) in (1..).zip(["a.png", "b.png", "c.png"]) {
            fs::write(folder.path().join(name), picture(1000, 760, i)).expect("written");
        }
        Self { folder }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn job(&self) -> String {
        text(&self.path("job.toml"))
    }

    /// The files of tiles, ordered by name.
    fn tiles(&self) -> Vec<PathBuf> {
        let entries = fs::read_dir(self.path("cache")).expect("a folder of tiles");
        let mut files: Vec<_> = entries.map(|entry| entry.expect("readable").path()).collect();
        files.sort();
        files
    }
}

/// A PNG.
fn picture(width: usize, height: usize, i: usize) -> Vec<u8> {
    let byte = |x: usize, y: usize, c: usize| (16 + (x * (3 + c) + y * (5 + i) + (x * y) / 64) % 200) as f32;
    let places = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    let samples = places.map(|(x, y)| [0, 1, 2].map(|c| byte(x, y, c) / 255.0)).collect();
    let image = Plane::<Display>::from_samples(width, height, samples).expect("as many as it takes");
    encode_display(&image, &Encoding::Srgb).expect("encodable")
}

#[test]
fn the_result_does_not_depend_on_the_memory_of_textures() {
    let place = TextureJob::new();
    let (job, cache) = (place.job(), text(&place.path("cache")));
    let in_memory = rendered(&job, &["--cache", &cache]);
    assert!(!place.path("cache").exists(), "what fits needs no folder");
    let small = ["--texture-memory", "1", "--cache", &cache];
    assert_same(&in_memory, &rendered(&job, &small), "tiles that are made");
    assert_eq!(place.tiles().len(), 3);
    assert_same(&in_memory, &rendered(&job, &[&small[..], &["--threads", "1"]].concat()), "tiles that are there");
    // Of three of 5.3 MB, as stated by their headers, one fits into half of it.
    let some = rendered(&job, &["--texture-memory", "11", "--cache", &cache]);
    assert_same(&in_memory, &some, "one picture in memory");
    let plan = etendue(["plan", &job, "--texture-memory", "1", "--cache", &cache]).ok().out;
    let expected = "textures 3 in tiles on disk, 23 MB; at most 1 MB of them in memory";
    assert!(plan.split_whitespace().collect::<Vec<_>>().join(" ").contains(expected), "{plan}");
}

/// Describing a job leaves nothing on disk, and a sandboxed job stores its tiles with its results.
#[test]
fn plans_write_no_tiles_and_those_of_sandboxed_jobs_are_in_their_output_folder() {
    let place = TextureJob::new();
    let (job, cache, out) = (place.job(), text(&place.path("cache")), place.path("out"));
    let user = [("XDG_CACHE_HOME", cache.as_str())];
    let small = ["--texture-memory", "1"];
    let plan = |options: &[&str]| etendue_with(["plan", &job].iter().chain(&small).chain(options), &user).ok();
    plan(&[]);
    plan(&["--sandboxed"]);
    etendue_with(["rig", &job, "-o", &text(&place.path("rig"))].iter().chain(&small), &user).ok();
    assert!(!place.path("cache").exists());
    etendue_with(["render", &job, "-o", &text(&out), "--sandboxed"].iter().chain(&small), &user).ok();
    assert!(!place.path("cache").exists());
    let tiles = fs::read_dir(out.join(".texture-cache")).expect("tiles").count();
    assert_eq!(tiles, 3);
    let in_memory = rendered(&job, &[]);
    in_memory
        .iter()
        .for_each(|(name, bytes)| assert!(fs::read(out.join(name)).is_ok_and(|stored| stored == *bytes), "{name}"));
    // The job itself needs more than the limit: refused before an image is unpacked.
    let limited = ["--limit", "texture-cache-mib=10"];
    let phrases = ["scene.textures", "the texture cache is limited to 10 MiB", "--limit texture-cache-mib="];
    etendue(["plan", &job].iter().chain(&small).chain(&limited)).refused(&phrases);
    etendue(
        ["render", &job, "-o", &text(&place.path("other")), "--cache", &cache].iter().chain(&small).chain(&limited),
    )
    .refused(&phrases);
}

/// Python and programs open a job before they name an output folder: a sandboxed job then writes no tiles into the user's cache.
#[test]
fn a_sandboxed_job_without_an_output_folder_has_its_textures_in_memory() {
    let place = TextureJob::new();
    let textures = etendue::TextureMemory { limit_bytes: 1_000_000, ..etendue::TextureMemory::default() };
    let request = etendue::JobRequest { textures, sandbox: Some(Vec::new()), ..etendue::JobRequest::new(place.job()) };
    let summary = request.clone().open().unwrap_or_else(|error| panic!("{error}")).summary();
    assert!(!summary.contains("in tiles"), "{summary}");
    let out = place.path("out");
    let summary = request.into_output(&out).open().unwrap_or_else(|error| panic!("{error}")).summary();
    assert!(summary.split_whitespace().collect::<Vec<_>>().join(" ").contains("3 in tiles on disk"), "{summary}");
    assert!(out.join(".texture-cache").is_dir());
}

#[test]
fn damaged_tiles_are_computed_again() {
    let place = TextureJob::new();
    let (job, cache) = (place.job(), text(&place.path("cache")));
    let small = ["--texture-memory", "1", "--cache", &cache];
    let in_memory = rendered(&job, &[]);
    rendered(&job, &small);
    let files = place.tiles();
    let [short, unusual, damaged] = &files[..] else { panic!("{files:?}") };
    let shorten = |file: &Path| fs::File::options().write(true).open(file).and_then(|file| file.set_len(70_000));
    shorten(short).expect("shortened");
    fs::write(unusual, b"no tiles").expect("written");
    assert_same(&in_memory, &rendered(&job, &small), "files that are not whole");
    // Changes the first byte of each tile, so that the first tile read differs from the written one.
    let mut bytes = fs::read(damaged).expect("tiles");
    let middle = bytes.len() / 3;
    bytes[middle..].iter_mut().for_each(|byte| *byte ^= 1);
    fs::write(damaged, bytes).expect("written");
    let output = text(&place.path("out"));
    let run = etendue(["render", &job, "-o", &output].into_iter().chain(small));
    assert_eq!(run.status, 1, "{run:?}");
    run.says(&["error: ", "is damaged; the file was removed: run again to create it again"]);
    assert!(!damaged.exists());
    assert_same(&in_memory, &rendered(&job, &small), "the next run");
}

#[test]
fn without_a_folder_for_tiles_pictures_are_held_with_a_warning() {
    let place = TextureJob::new();
    let job = place.job();
    fs::write(place.path("file"), b"").expect("written");
    let cache = text(&place.path("file/cache"));
    let output = text(&place.path("out"));
    let run = etendue(["render", &job, "-o", &output, "--texture-memory", "1", "--cache", &cache]).ok();
    run.says(&[
        "a.png",
        "6 MB are stored in memory, above its limit, because the cache folder ",
        "file/cache cannot be written: ",
    ]);
    assert_same(&rendered(&job, &[]), &crate::support::contents(Path::new(&output)), "held after all");
}

#[test]
fn a_broken_picture_is_refused_as_one_in_memory() {
    let place = TextureJob::new();
    let (job, cache) = (place.job(), text(&place.path("cache")));
    let bytes = fs::read(place.path("b.png")).expect("a picture");
    fs::write(place.path("b.png"), &bytes[..bytes.len() / 2]).expect("written");
    let plan = |options: &[&str]| etendue(["plan", &job].iter().chain(options));
    let words = [
        "b.png: not a readable image (",
        "it may be truncated or damaged: create or download it again",
        "scene.textures",
    ];
    plan(&[]).refused(&words);
    plan(&["--texture-memory", "1", "--cache", &cache]).refused(&words);
    let output = text(&place.path("out"));
    etendue(["render", &job, "-o", &output, "--texture-memory", "1", "--cache", &cache]).refused(&words);
    assert!(
        place.tiles().iter().all(|file| file.extension().is_some_and(|end| end == "tiles")),
        "nothing half-written"
    );
    fs::remove_file(place.path("b.png")).expect("removed");
    plan(&["--texture-memory", "1", "--cache", &cache]).refused(&["b.png: no such image file; check the path"]);
    plan(&["--texture-memory", "0"]).refused(&["--texture-memory", "from 1 to"]);
}

#[test]
fn pictures_and_meshes_that_nothing_shows_are_not_read() {
    let place = tempfile::tempdir().expect("a temporary folder");
    let job = r#"format = 1
[scene]
environment = { type = "uniform", luminance_cd_m2 = 100, illuminant = "D65" }
textures = [{ name = "t", file = "lost.png", encoding = "srgb" }]
materials = [{ name = "t", type = "diffuse", reflectance = { texture = "t" } }]
meshes = [{ name = "m", file = "m.obj", up_axis = "z" }, { name = "n", file = "lost.obj", up_axis = "z" }]
objects = [{ name = "o", mesh = "m" }]
[[cameras]]
name = "front"
position_m = [-1, 0, 1]
look_at_m = [1, 0, 0]
lens = { type = "pinhole", focal_length_mm = 6, f_number = 8 }
sensor = { width_px = 8, height_px = 8, pixel_pitch_um = 150 }
"#;
    let write = |name: &str, text: &str| fs::write(place.path().join(name), text).expect("written");
    write("job.toml", job);
    write("m.mtl", "newmtl seen\nKd 0.5 0.5 0.5\nnewmtl unseen\nmap_Kd lost.png\n");
    let mesh = "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl unseen\nusemtl seen\nf 1 2 3\n";
    write("m.obj", mesh);
    let job = text(&place.path().join("job.toml"));
    rendered(&job, &["--spp", "1"]);
    write("m.obj", &format!("{mesh}usemtl unseen\nf 3 2 1\n"));
    etendue(["plan", &job]).refused(&["lost.png: no such image file", "referenced at", "m.obj"]);
}
