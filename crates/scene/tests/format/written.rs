//! Descriptions are equal after writing and reading back.

use std::path::{Path, PathBuf};

use crate::files::{DescriptionFiles, load};
use etendue_scene::written::File;
use etendue_scene::{Description, Overrides};

fn check(description: &Description) {
    let table = description.to_table();
    let text = File::new(table.clone()).to_string();
    let repeated = Description::load(Path::new("job.toml"), &|_| Ok(text.clone()), &Overrides::default());
    let repeated = repeated.unwrap_or_else(|errors| panic!("{}: {errors}\n{text}", description.file.display()));
    assert!(repeated.to_table() == table, "{} is another after it was written:\n{text}", description.file.display());
}

#[test]
fn the_examples_of_the_pages() {
    // The job's keys apply to each camera: none may be without effect.
    let sets = ["cameras.left.render.integrator=path"];
    check(&load(&DescriptionFiles::from_example(), &sets).unwrap_or_else(|errors| panic!("{errors}")));
    check(&load(&DescriptionFiles::from_small_example(), &[]).unwrap_or_else(|errors| panic!("{errors}")));
}

/// Jobs in all folders of the scenes.
fn shipped_jobs() -> Vec<(PathBuf, Description)> {
    let scenes = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
    let folders = std::fs::read_dir(scenes).expect("the scenes").map(|folder| folder.expect("a folder").path());
    let files =
        folders.filter(|folder| folder.is_dir()).flat_map(|folder| std::fs::read_dir(folder).expect("a folder"));
    let files =
        files.map(|file| file.expect("a file").path()).filter(|file| file.extension().is_some_and(|e| e == "toml"));
    let read = |path: &Path| std::fs::read_to_string(path).map_err(|error| error.to_string().into());
    files
        .filter_map(|file| Some((file.clone(), Description::load(&file, &read, &Overrides::default()).ok()?)))
        .collect()
}

#[test]
fn the_jobs_that_ship() {
    let jobs = shipped_jobs();
    assert!(jobs.len() >= 15, "{} jobs", jobs.len());
    jobs.iter().for_each(|(_, description)| check(description));
}
