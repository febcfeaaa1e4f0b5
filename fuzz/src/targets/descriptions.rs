//! Jobs, scenes, cameras, weather, variations, data sheets, changes of keys, and whole plans.

use super::seeds::{repository, stored, write};
use super::target::{TREE, Target, result_text};
use etendue::{ExistingFiles, JobRequest, NullObserver, TextureMemory};
use etendue_scene::limits::DESCRIPTION;
use etendue_scene::{Description, Overrides, Problem, load_camera, load_datasheet, load_variations, load_weather};
use std::path::Path;

/// What TOML is made of, and words of our format that lead to other files or forms.
const WORDS: &[&str] = &[
    "base = \"job.toml\"",
    "base = \"scene.toml\"",
    "base = \"camera.toml\"",
    "remove = [\"lights\"]",
    "type = \"box\"",
    "[[",
    "]]",
    "{ }",
    "[]",
    "true",
    "null",
    "\"\"",
    "'''",
    "\"\"\"",
    "1979-05-27T07:32:00Z",
    "\"../../../../etc/passwd\"",
    "\"%d.obj\"",
    "file = \"a.csv\"",
    "[scene]",
    "[[cameras]]",
    "\"\\u0000\"",
    "\"\\n\"",
    "0b1",
    "0o7",
    "+inf",
    "type = \"mesh\"",
    "name = \"a\"",
];

const CONSTANT: u64 = 16 << 20;

fn text(file: &Path) -> Result<String, Problem> {
    String::from_utf8(etendue_io::read_regular(file, &DESCRIPTION).map_err(|error| error.to_string())?)
        .map_err(|error| error.to_string().into())
}

fn job(file: &Path) -> String {
    let read = Description::load(file, &text, &Overrides::default());
    if let Ok(description) = &read {
        let _ = (description.assets(), description.to_table());
    }
    result_text(read)
}

fn neighbours(folder: &Path) {
    let [scene, camera] = stored("description").try_into().expect("a camera and a scene");
    let (scene, camera) = if scene.starts_with(b"# camera") { (camera, scene) } else { (scene, camera) };
    write(folder, "scene.toml", scene);
    write(folder, "camera.toml", camera);
    write(folder, "job.toml", JOB_TEXT);
}

/// A job of files.
const JOB_TEXT: &str = "format = 1\nscene = \"scene.toml\"\n[[cameras]]\nname = \"front\"\nfile = \"camera.toml\"\nposition_m = [0, 0, 1.3]\n\
    look_at_m = [20, 0, 1]\n[render]\nspp = 4\n[output]\nradiance = true\n";

pub(super) const JOB: Target = Target {
    name: "job",
    file: "job.toml",
    prepare: |folder| {
        neighbours(folder);
        let mut seeds = repository([
            "crates/cli/tests/jobs/small/small.toml",
            "scenes/sensors/sensors.toml",
            "scenes/drive/drive.toml",
            "scenes/front/front.toml",
            "scenes/processing/detail.toml",
        ]);
        seeds.push(JOB_TEXT.as_bytes().to_vec());
        seeds
    },
    read: job,
    words: WORDS,
    is_text: true,
    times: TREE,
    constant_bytes: CONSTANT,
};

pub(super) const SCENE: Target = Target {
    name: "scene",
    file: "scene.toml",
    prepare: |folder| {
        neighbours(folder);
        let mut seeds =
            repository(["scenes/drive/scene.toml", "scenes/weather/scene-fog.toml", "scenes/weather/scene-spray.toml"]);
        seeds.extend(stored("description"));
        seeds
    },
    read: |file| job(&file.with_file_name("job.toml")),
    words: WORDS,
    is_text: true,
    times: TREE,
    constant_bytes: CONSTANT,
};

pub(super) const CAMERA: Target = Target {
    name: "camera",
    file: "camera.toml",
    prepare: |folder| {
        neighbours(folder);
        repository([
            "scenes/cameras/automotive-hdr.toml",
            "scenes/cameras/catadioptric.toml",
            "scenes/cameras/ccd-bayer.toml",
            "scenes/cameras/double-gauss.toml",
            "scenes/cameras/fast-thick.toml",
            "scenes/cameras/fisheye.toml",
            "scenes/cameras/web.toml",
            "scenes/cameras/windscreen-drops.toml",
            "scenes/cameras/calibrated.toml",
        ])
    },
    read: |file| result_text(load_camera(file, &text, &Overrides::default())),
    words: WORDS,
    is_text: true,
    times: TREE,
    constant_bytes: CONSTANT,
};

pub(super) const WEATHER: Target = Target {
    name: "weather",
    file: "weather.toml",
    prepare: |_| repository(["scenes/weather/koschmieder.toml", "scenes/weather/streaks.toml"]),
    read: |file| result_text(load_weather(file, &text)),
    words: WORDS,
    is_text: true,
    times: TREE,
    constant_bytes: CONSTANT,
};

pub(super) const VARIATIONS: Target = Target {
    name: "variations",
    file: "variations.toml",
    prepare: |_| repository(["scenes/datasets/boxes.toml", "scenes/datasets/drive.toml"]),
    read: |file| result_text(load_variations(file, &text)),
    words: WORDS,
    is_text: true,
    times: TREE,
    constant_bytes: CONSTANT,
};

pub(super) const DATASHEET: Target = Target {
    name: "datasheet",
    file: "sheet.toml",
    prepare: |_| repository(["scenes/datasheets/made-up-cmos.toml"]),
    read: |file| match load_datasheet(file, &text) {
        Ok(_) => {
            let out = file.with_file_name("camera");
            result_text(etendue::datasheet(file, &out, ExistingFiles::Replace, &NullObserver))
        }
        refused => result_text(refused),
    },
    words: WORDS,
    is_text: true,
    times: TREE,
    constant_bytes: CONSTANT,
};

pub(super) const SET: Target = Target {
    name: "set",
    file: "changes.txt",
    prepare: |folder| {
        neighbours(folder);
        [
            "render.spp=16\ncameras.front.lens.focal_length_mm=2.8\nscene=scene.toml",
            "scene.objects.globe.material=red\ncameras.0.file=camera.toml\nscene.objects.globe=null",
            "cameras.front.sensor.principal_point_px=[1,2]\ncameras={name=\"a\"}\noutput.x.y.z=1",
        ]
        .map(|text| text.as_bytes().to_vec())
        .to_vec()
    },
    read: |file| {
        let Ok(changes) = text(file) else { return "no text".to_owned() };
        result_text(Description::load(&file.with_file_name("job.toml"), &text, &Overrides::new(changes.lines())))
    },
    words: &[
        "scene.",
        "cameras.",
        "=",
        "null",
        "front",
        "0",
        "objects",
        "[[",
        "{a=1}",
        "''",
        "lens.type=thick",
        "render",
    ],
    is_text: true,
    times: TREE,
    constant_bytes: CONSTANT,
};

/// All of a job on the way to a plan that is told: what no reader refuses must not hurt later.
pub(super) const PLAN: Target = Target {
    name: "plan",
    file: "job.toml",
    prepare: |folder| {
        neighbours(folder);
        for (name, file) in [
            ("tower.obj", "crates/cli/tests/jobs/small/tower.obj"),
            ("tower.mtl", "crates/cli/tests/jobs/small/tower.mtl"),
            ("checker.png", "crates/cli/tests/jobs/small/checker.png"),
            ("sky.hdr", "crates/cli/tests/jobs/small/sky.hdr"),
        ] {
            let [bytes] = repository([file]).try_into().expect("one file");
            write(folder, name, bytes);
        }
        let mut seeds = repository(["crates/cli/tests/jobs/small/small.toml"]);
        seeds.push(JOB_TEXT.as_bytes().to_vec());
        seeds.extend(repository(["scenes/furnace/furnace.toml", "scenes/sphere-on-plane/sphere-on-plane.toml"]));
        seeds
    },
    read: |file| {
        let mut request = JobRequest::new(file);
        request.textures = TextureMemory { limit_bytes: u64::MAX, ..TextureMemory::default() };
        match request.open() {
            Ok(job) => {
                let _ = (job.summary(), job.report());
                "planned".to_owned()
            }
            Err(error) => error.to_string(),
        }
    },
    words: WORDS,
    is_text: true,
    // Trees, tables of skies and spectra, and the layouts of cameras.
    times: TREE,
    constant_bytes: 512 << 20,
};
