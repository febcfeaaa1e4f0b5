//! The scenes in the repository are what the generator makes, and every job and camera among them can be read.

use std::path::{Path, PathBuf};

use etendue_scene::{Description, Overrides, load_camera};

fn scenes() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("the generator lies in scenes/").to_owned()
}

fn read(file: &Path) -> Result<String, etendue_scene::Problem> {
    std::fs::read_to_string(file).map_err(|error| error.to_string().into())
}

#[test]
fn committed_files_are_those_of_the_generator() {
    for file in etendue_scenes::files() {
        let path = scenes().join(&file.path);
        let committed =
            std::fs::read(&path).unwrap_or_else(|error| panic!("{}: {error}; run `just scenes`", file.path));
        assert!(committed == file.bytes, "{} is not what the generator makes; run `just scenes`", file.path);
    }
}

#[test]
fn nothing_else_lies_in_generated_folders() {
    let generated: Vec<PathBuf> = etendue_scenes::files().iter().map(|file| scenes().join(&file.path)).collect();
    for folder in ["street", "street/meshes", "street/textures", "drive"] {
        for entry in std::fs::read_dir(scenes().join(folder)).expect("the street is committed") {
            let path = entry.expect("a folder can be listed").path();
            assert!(path.is_dir() || generated.contains(&path), "{} is left over", path.display());
        }
    }
}

/// The scenes are cloned by everybody: two and a quarter megabytes at most, a fifth of a megabyte of them for a car whose wheels turn.
#[test]
fn the_scenes_are_small() {
    let bytes: usize = etendue_scenes::files().iter().map(|file| file.bytes.len()).sum();
    assert!(bytes < 2_250_000, "{bytes} bytes");
}

/// The street is the project's large scene: a hundred thousand triangles at least, by instances.
#[test]
fn the_street_is_large() {
    let [unique, placed] = etendue_scenes::street::triangle_counts();
    assert!(placed >= 100_000 && placed > 5 * unique, "{unique} in files, {placed} placed");
}

#[test]
fn jobs_can_be_read() {
    let jobs = [
        "street/street.toml",
        "street/sunset.toml",
        "street/night.toml",
        "street/wet-night.toml",
        "drive/drive.toml",
        "cornell/cornell.toml",
        "furnace/furnace.toml",
        "sphere-on-plane/sphere-on-plane.toml",
        "lenses/lenses.toml",
        "lenses/ghosts.toml",
        "lenses/night-flare.toml",
        "lenses/pupil.toml",
    ];
    for job in jobs {
        let description = Description::load(&scenes().join(job), &read, &Overrides::default());
        let description = description.unwrap_or_else(|errors| panic!("{job}: {errors}"));
        for asset in description.assets() {
            assert!(asset.path.is_file(), "{job} names {}, which is not there", asset.path.display());
        }
    }
}

#[test]
fn cameras_can_be_read() {
    for camera in ["automotive", "laboratory", "double-gauss", "fisheye", "calibrated"] {
        let file = scenes().join(format!("cameras/{camera}.toml"));
        load_camera(&file, &read, &Overrides::default()).unwrap_or_else(|errors| panic!("{camera}: {errors}"));
    }
}
