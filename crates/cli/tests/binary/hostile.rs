//! Files and arguments that could hang the program or fill the memory.

use crate::bad_input::ModifiedJob;
use crate::support::{etendue, text};
use std::path::Path;
use std::process::Command;

fn pipe(path: &Path) -> String {
    let _ = std::fs::remove_file(path);
    assert!(Command::new("mkfifo").arg(path).status().expect("mkfifo").success());
    text(path)
}

/// Reading any of them would block indefinitely.
#[test]
fn pipes_in_the_place_of_files_are_refused() {
    const PIPE: &str = "this is a pipe, not a regular file; save its content as a file and give that";
    for name in ["tower.obj", "tower.mtl", "checker.png", "sky.hdr"] {
        let job = ModifiedJob::new();
        pipe(&job.folder().join(name));
        job.render(&[]).refused(&[name, PIPE]);
    }
    let place = tempfile::tempdir().expect("a temporary folder");
    let pipe = |name: &str| pipe(&place.path().join(name));
    let out = text(&place.path().join("out"));
    etendue(["plan", &pipe("job.toml")]).refused(&["job.toml", PIPE]);
    for name in ["a.exr", "a.png", "a.obj", "a.ies", "a.csv", "a.json"] {
        etendue(["inspect", &pipe(name)]).refused(&[name, PIPE]);
    }
    let camera = pipe("camera.toml");
    let light = ["--wavelength-nm", "525", "--irradiance-w-m2", "0.002"];
    etendue(["flat", &camera, "-o", &out].into_iter().chain(light)).refused(&["camera.toml", PIPE]);
    etendue(["measure", "lens", &camera]).refused(&["camera.toml", PIPE]);
    etendue(["measure", "lens", &pipe("lens.zmx")]).refused(&["lens.zmx", PIPE]);
    etendue(["measure", "sfr", &pipe("edge.png")]).refused(&["edge.png", PIPE]);
    etendue(["compare", &pipe("b.exr"), &pipe("c.exr")]).refused(&["b.exr", PIPE]);
    etendue(["datasheet", &pipe("sheet.toml"), "-o", &out]).refused(&["sheet.toml", PIPE]);
    etendue(["inspect", "/dev/zero"]).refused(&["/dev/zero", "this is a device"]);
}

/// Unused files are not read, and need not exist.
#[test]
fn unused_files_need_not_exist() {
    let job = ModifiedJob::new();
    let mesh = "meshes = [{ name = \"spare\", file = \"no.obj\", up_axis = \"z\" }, ";
    job.replace_first("small.toml", "meshes = [", mesh);
    job.replace_first(
        "small.toml",
        "textures = [",
        "textures = [{ name = \"big\", file = \"no.png\", encoding = \"srgb\" }, ",
    );
    let material =
        "[[scene.materials]]\nname = \"rest\"\ntype = \"diffuse\"\nreflectance = { spectrum = \"no.csv\" }\n\n";
    job.replace_first("small.toml", "[[scene.materials]]\n", &format!("{material}[[scene.materials]]\n"));
    let plan = etendue(["plan", &job.job()]).ok().out;
    for phrase in
        ["mesh used by no object: spare", "material used by no object: rest", "texture used by no material in use: big"]
    {
        assert!(plan.contains(phrase), "{plan}");
    }
    job.replace_first("small.toml", "texture = \"checker\"", "texture = \"big\"");
    etendue(["plan", &job.job()]).refused(&["no.png", "no such image file"]);
}

#[test]
fn numbers_that_keys_refuse_are_refused_as_arguments() {
    let job = ModifiedJob::new();
    let refused = |options: &[&str], phrases: &[&str]| drop(job.render(options).refused(phrases));
    refused(&["--spp", "2147483648"], &["--spp 2147483648: found 2147483648; give a whole number from 1 to 1048576"]);
    refused(&["--spp", "0"], &["--spp 0: found 0; give a whole number from 1 to 1048576"]);
    refused(&["--seed", "18446744073709551615"], &["--seed 18446744073709551615", "from 0 to 9223372036854775807"]);
    refused(&["--threads", "100000"], &["'100000'", "a whole number from 1 to 1024"]);
    refused(&["--frames", "0..4294967295"], &["4294967295 frames; one run can have at most 100000"]);
}

#[test]
fn a_key_of_twenty_thousand_parts_is_refused_in_a_line() {
    let set = format!("{}=1", vec!["a"; 20_000].join("."));
    let output = ModifiedJob::new().render(&["--set", &set]).refused(&["--set a.a.a", "20000 parts"]);
    assert!(output.err.len() < 500, "{}", output.err.len());
}
