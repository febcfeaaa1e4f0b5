//! Shards on other machines: their input files, film by film, and merging.

use crate::support::{BALL, assert_same, contents, etendue, rendered, text};
use std::fs;
use std::path::{Path, PathBuf};

/// The ball in front of two cameras with lights of their own, one of which sees it move over three frames; the second is in a file.
fn job(folder: &Path) -> PathBuf {
    fs::create_dir_all(folder.join("jobs")).expect("made");
    fs::create_dir_all(folder.join("cameras")).expect("made");
    let camera = "format = 1\n[lens]\ntype = \"pinhole\"\nfocal_length_mm = 3\nf_number = 4\n[sensor]\nwidth_px = 24\nheight_px = 20\npixel_pitch_um = 150\n";
    fs::write(folder.join("cameras/side.toml"), camera).expect("written");
    let moving = BALL.replace(
        "position_m = [6, 0, 1]",
        "keys = [{ time_s = 0, position_m = [6, 0, 1] }, { time_s = 1, position_m = [6, 2, 1] }]",
    );
    let side = "[[cameras]]\nname = \"side\"\nfile = \"../cameras/side.toml\"\nposition_m = [6, -5, 1]\nlook_at_m = [6, 0, 1]\n";
    let more =
        "[sequence]\nframe_rate_hz = 5\n[render]\nspp = 4\nreplicates = 2\ntile_px = 16\n[output]\nradiance = true\n";
    fs::write(folder.join("jobs/job.toml"), format!("{moving}{side}{more}")).expect("written");
    folder.join("jobs/job.toml")
}

#[test]
fn films_of_shards_that_were_rendered_elsewhere_are_merged_to_the_same_bytes() {
    let place = tempfile::tempdir().expect("a temporary folder");
    let job = job(&place.path().join("here"));
    let files = etendue(["plan", &text(&job), "--files"]).ok().out;
    let files: Vec<PathBuf> = files.lines().map(PathBuf::from).collect();
    assert_eq!(files, [job.parent().expect("its folder").join("../cameras/side.toml"), job.clone()]);
    let there = place.path().join("there");
    ["jobs", "cameras"].iter().for_each(|folder| fs::create_dir_all(there.join(folder)).expect("made"));
    for name in ["jobs/job.toml", "cameras/side.toml"] {
        fs::copy(place.path().join("here").join(name), there.join(name)).expect("copied");
    }
    let away = text(&there.join("jobs/job.toml"));
    let folder = |name: &str| text(&place.path().join(name));
    for shard in ["0/2", "1/2"] {
        let films =
            ["front.0000.0", "front.0001.0", "side.0000.0", "side.0001.0"].map(|film| format!("{film}.film.exr"));
        let part = folder(&shard[..1]);
        let run = |films: &[&str]| {
            let films = films.iter().flat_map(|film| ["--film", film]);
            let run = ["render", &away, "-o", &part, "--shard", shard, "--frames", "0..2"];
            etendue(run.into_iter().chain(films)).ok();
        };
        run(&[&films[2]]);
        assert_eq!(
            contents(Path::new(&part)).keys().map(String::as_str).collect::<Vec<_>>(),
            ["shard.json", &films[2]]
        );
        run(&[&films[0], &films[3]]);
        run(&[&films[1]]);
        let other =
            ["--shard", shard, "--frames", "0..2", "--film", &films[0], "--overwrite", "--set", "render.tile_px=8"];
        etendue(["render", &away, "-o", &part].iter().chain(&other)).refused(&["shard.json", "another run"]);
    }
    fs::remove_dir_all(&there).expect("removed");
    let merge = ["merge", &folder("0"), &folder("1"), "-o", &folder("out")].map(str::to_owned);
    etendue(&merge).refused(&["there"]);
    etendue(merge.iter().map(String::as_str).chain(["--job", &text(&job)])).ok();
    assert_same(&rendered(&text(&job), &["--frames", "0..2"]), &contents(Path::new(&folder("out"))), "film by film");
}

#[test]
fn films_that_there_are_not_are_refused() {
    let place = tempfile::tempdir().expect("a temporary folder");
    let (job, out) = (text(&job(place.path())), text(&place.path().join("out")));
    let run = |more: &[&str]| etendue(["render", &job, "-o", &out].iter().chain(more));
    run(&["--shard", "0/2", "--film", "rear.film.exr"]).refused(&["--film rear.film.exr", "front.0000.0.film.exr"]);
    run(&["--film", "front.0000.0.film.exr"]).refused(&["--shard"]);
    assert!(!Path::new(&out).exists());
}
