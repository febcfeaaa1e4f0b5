//! Text on a terminal: control characters of files are escaped, and unprintable results are an error.

use crate::support::{BALL, etendue, root, small, text};
use serde_json::Value;
use std::fs;
use std::path::Path;
use std::process::{Command, Output, Stdio};

/// Control characters, and the override that reverses text.
const CONTROL_CHARACTERS: &str = "\u{1b}[31m\u{1b}]0;owned\u{7}\u{9b}2J\u{202e}\u{7f}";

#[track_caller]
fn assert_plain(what: &str, printed: &str) {
    let unusual = |c: &char| c.is_control() && *c != '\n' && *c != '\t' || ('\u{202a}'..='\u{202e}').contains(c);
    let special: Vec<char> = printed.chars().filter(unusual).collect();
    assert!(special.is_empty(), "{what}: {special:?} in {printed:?}");
}

/// An EXR file of one pixel with an unusual channel and comment.
fn strange_exr() -> Vec<u8> {
    let attribute = |name: &str, kind: &str, value: &[u8]| {
        let length = (value.len() as u32).to_le_bytes();
        [name.as_bytes(), b"\0", kind.as_bytes(), b"\0", &length, value].concat()
    };
    let channel =
        [CONTROL_CHARACTERS.as_bytes(), b"Y\0", &[2, 0, 0, 0, 0, 0, 0, 0], &[1, 0, 0, 0, 1, 0, 0, 0], b"\0"].concat();
    let mut head = [20_000_630_u32.to_le_bytes(), 2_u32.to_le_bytes()].concat();
    head.extend(attribute("channels", "chlist", &channel));
    head.extend(attribute("compression", "compression", &[0]));
    head.extend(attribute("dataWindow", "box2i", &[0; 16]));
    head.extend(attribute("displayWindow", "box2i", &[0; 16]));
    head.extend(attribute("lineOrder", "lineOrder", &[0]));
    head.extend(attribute("pixelAspectRatio", "float", &1_f32.to_le_bytes()));
    head.extend(attribute("screenWindowCenter", "v2f", &[0; 8]));
    head.extend(attribute("screenWindowWidth", "float", &1_f32.to_le_bytes()));
    head.extend(attribute("comments", "string", CONTROL_CHARACTERS.as_bytes()));
    head.push(0);
    let start = (head.len() as u64 + 8).to_le_bytes();
    [&head[..], &start, &0_i32.to_le_bytes(), &4_i32.to_le_bytes(), &1_f32.to_le_bytes()].concat()
}

#[test]
fn text_of_files_and_paths_is_shown_and_not_obeyed() {
    let place = tempfile::tempdir().expect("a temporary folder");
    let file = |name: &str, bytes: &[u8]| {
        fs::write(place.path().join(name), bytes).expect("written");
        text(&place.path().join(name))
    };
    let exr = file("x.exr", &strange_exr());
    let obj = format!("mtllib x.mtl\nusemtl {CONTROL_CHARACTERS}m\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    let obj = file("x.obj", obj.as_bytes());
    file("x.mtl", format!("newmtl {CONTROL_CHARACTERS}m\nKd 1 0 0\n{CONTROL_CHARACTERS} 1\n").as_bytes());
    let names = format!(
        "[[scene.objects]]\nname = {}\nshape = {{ type = \"sphere\", radius_m = 1 }}\nmaterial = {}\n",
        serde_json::to_string(CONTROL_CHARACTERS).expect("text").replace('\u{7f}', "\\u007f"),
        serde_json::to_string(CONTROL_CHARACTERS).expect("text").replace('\u{7f}', "\\u007f")
    );
    let job = file("job.toml", format!("{BALL}{names}").as_bytes());
    let mesh = "[[scene.meshes]]\nname = \"x\"\nfile = \"x.obj\"\nup_axis = \"z\"\n[[scene.objects]]\nname = \"x\"\nmesh = \"x\"\n";
    let mesh = file("mesh.toml", format!("{BALL}{mesh}").as_bytes());
    let sky = file(
        "sky.toml",
        BALL.replace(
            "type = \"uniform\"\nluminance_cd_m2 = 30\nilluminant = \"D65\"",
            "type = \"image\"\nfile = \"x.exr\"\nluminance_cd_m2_per_unit = 1",
        )
        .as_bytes(),
    );
    let lost = text(&place.path().join(format!("{CONTROL_CHARACTERS}.toml")));
    for arguments in [
        &["inspect", &exr][..],
        &["inspect", &obj],
        &["plan", &job],
        &["plan", &mesh],
        &["plan", &mesh, "--json"],
        &["plan", &mesh, "--files"],
        &["plan", &sky],
        &["plan", &lost],
        &["plan", &job, CONTROL_CHARACTERS],
        &["render", &job, "--set", CONTROL_CHARACTERS],
        &["compare", &exr, &exr, "--json"],
        &["compare", &exr, &exr],
    ] {
        let output = etendue(arguments);
        assert_plain(&format!("stdout of {arguments:?}"), &output.out);
        assert_plain(&format!("stderr of {arguments:?}"), &output.err);
        assert!(!(output.out + &output.err).is_empty());
    }
    let shown = etendue(["inspect", &exr]).ok().out;
    assert!(shown.contains("\\u{1b}[31m\\u{1b}]0;owned\\u{7}"), "{shown}");
    let shown = etendue(["plan", &lost]).err;
    assert!(shown.contains("\\u{202e}"), "{shown}");
    let json = etendue(["compare", &exr, &exr, "--json"]).ok().out;
    let json: Value = serde_json::from_str(&json).expect("JSON");
    assert!(json.to_string().contains("\\u001b[31m"), "the document says the name itself: {json}");
}

fn shell(line: &str, arguments: &[&str]) -> Output {
    let mut command = Command::new("sh");
    command.args(["-c", line, env!("CARGO_BIN_EXE_etendue")]).args(arguments);
    command.current_dir(root()).stdin(Stdio::null()).output().expect("a shell")
}

/// Every verb prints something: without a standard output none starts its work.
#[cfg(target_os = "linux")]
#[test]
fn a_standard_output_that_is_closed_is_an_error_of_every_verb() {
    let place = tempfile::tempdir().expect("a temporary folder");
    let out = text(&place.path().join("out"));
    let job = small();
    for arguments in [
        &["render", &job, "-o", &out, "--spp", "2"][..],
        &["plan", &job],
        &["schema", "job"],
        &["inspect", &job],
        &["view", "none"],
        &["--help"],
        &["--version"],
    ] {
        let output = shell("exec \"$0\" \"$@\" >&-", arguments);
        let stderr = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {stderr}");
        assert_eq!(stderr.lines().count(), 1, "{stderr}");
        assert!(stderr.contains("standard output, which receives the results, is closed"), "{stderr}");
    }
    assert!(!Path::new(&out).exists());
    assert!(shell("exec \"$0\" \"$@\" >/dev/null", &["schema", "job"]).status.success());
    // As with Python's subprocess.DEVNULL, for reading and writing.
    assert!(shell("exec \"$0\" \"$@\" 1<>/dev/null", &["schema", "job"]).status.success());
}

#[test]
fn a_reader_that_goes_away_is_an_error() {
    let place = tempfile::tempdir().expect("a temporary folder");
    let out = text(&place.path().join("out"));
    let job = small();
    for arguments in
        [&["render", &job, "-o", &out, "--spp", "2"][..], &["schema", "job"], &["plan", &job, "--json"], &["--help"]]
    {
        let stderr_file = place.path().join("said");
        let line = format!("{{ sleep 0.3; \"$0\" \"$@\" 2>'{}'; echo $? >&2; }} | true", stderr_file.display());
        let output = shell(&line, arguments);
        let stderr = fs::read_to_string(&stderr_file).expect("its stderr");
        assert_eq!(String::from_utf8_lossy(&output.stderr).trim(), "1", "{arguments:?}: {stderr}");
        assert_eq!(stderr.lines().filter(|line| line.starts_with("error: ")).count(), 1, "{stderr}");
        assert!(stderr.contains("cannot be written to standard output"), "{stderr}");
    }
    assert!(Path::new(&out).join("front/radiance.exr").exists(), "results that have their names are whole");
}
