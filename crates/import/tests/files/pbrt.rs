//! pbrt's scene files as directives: forms, included files, errors with their place.

use etendue_import::syntax::pbrt::{PbrtDirective, PbrtValues, read_pbrt};
use etendue_io::Sandbox;
use std::fs;
use std::path::Path;

/// Directives of the first file with their lines; the other files are next to it.
fn read(files: &[(&str, &str)]) -> Result<Vec<(String, usize, PbrtDirective)>, String> {
    let folder = tempfile::tempdir().expect("a temporary folder");
    files.iter().for_each(|(name, text)| fs::write(folder.path().join(name), text).expect("written"));
    let mut directives = Vec::new();
    let mut take = |directive: PbrtDirective, place: etendue_import::syntax::pbrt::PbrtPlace<'_>| {
        let name = place.file.file_name().expect("a name").to_string_lossy().into_owned();
        directives.push((name, place.line, directive));
        Ok(())
    };
    let relative_text = |e: etendue_io::Error| e.to_string().replace(&format!("{}/", folder.path().display()), "");
    read_pbrt(&folder.path().join(files[0].0), &Sandbox::NONE, &mut take).map_err(relative_text)?;
    Ok(directives)
}

#[test]
fn directives_have_their_arguments() {
    let text = "# a scene\nLookAt 0 0 -5\n  0 0 0  0 1 0\nTransform[1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1]Identity\n\
        Texture \"wood\" \"spectrum\" \"imagemap\" \"string filename\" \"a b.png\" \"bool invert\" false\n\
        MediumInterface \"fog\" \"\"\nMediumInterface \"fog\"\nInclude \"more.pbrt\"\nActiveTransform All\nOption \"bool disablepixeljitter\" true\n\
        Shape \"sphere\" # the end has no line";
    let directives = read(&[
        ("a.pbrt", text),
        ("more.pbrt", "WorldBegin\n\nMaterial \"diffuse\" \"rgb reflectance\" [ .5 1e-1\n+0.25 ]"),
    ]);
    let directives = directives.expect("read");
    let lines: Vec<(&str, usize)> = directives.iter().map(|(name, line, _)| (name.as_str(), *line)).collect();
    let expected = [2, 4, 4, 5, 6, 7].map(|line| ("a.pbrt", line));
    assert_eq!(lines[..6], expected);
    assert_eq!(lines[6..], [("more.pbrt", 1), ("more.pbrt", 3), ("a.pbrt", 9), ("a.pbrt", 10), ("a.pbrt", 11)]);
    let directive = |i: usize| &directives[i].2;
    assert_eq!(*directive(0), PbrtDirective::Numbers("LookAt", vec![0., 0., -5., 0., 0., 0., 0., 1., 0.]));
    assert_eq!(*directive(2), PbrtDirective::Plain("Identity"));
    let PbrtDirective::Texture(words, parameters) = directive(3) else { panic!("{:?}", directive(3)) };
    assert_eq!(*words, ["wood", "spectrum", "imagemap"]);
    assert_eq!(parameters[0].values, PbrtValues::Texts(vec!["a b.png".to_owned()]));
    assert_eq!((parameters[1].kind.as_str(), &parameters[1].values), ("bool", &PbrtValues::Flags(vec![false])));
    assert_eq!(*directive(4), PbrtDirective::MediumInterface(["fog".to_owned(), String::new()]));
    assert_eq!(*directive(5), PbrtDirective::MediumInterface(["fog".to_owned(), "fog".to_owned()]));
    let PbrtDirective::Typed("Material", kind, parameters) = directive(7) else { panic!("{:?}", directive(7)) };
    assert_eq!((kind.as_str(), &parameters[0].values), ("diffuse", &PbrtValues::Numbers(vec![0.5, 0.1, 0.25])));
    assert_eq!(*directive(10), PbrtDirective::Typed("Shape", "sphere".to_owned(), Vec::new()));
}

#[track_caller]
fn refused(text: &str, expected: &str) {
    assert_eq!(read(&[("a.pbrt", text)]).expect_err("damaged"), expected);
}

#[test]
fn faults_have_their_line() {
    refused(
        "\nSurfaceIntegrator \"path\"",
        "a.pbrt:2: unknown directive `SurfaceIntegrator`: pbrt-v4 does not have it",
    );
    refused("Translate 1 2", "a.pbrt:1: `Translate`: expected 3 numbers, found 2");
    refused("Translate 1 2 x", "a.pbrt:1: expected a number, found `x`");
    refused("Scale 1 2 inf", "a.pbrt:1: `inf` is not finite");
    refused("Transform [ 1 2 3", "a.pbrt:1: `Transform`: expected 16 numbers, found 3");
    refused("Shape sphere", "a.pbrt:1: `Shape` expects a quoted string here");
    refused("Shape", "a.pbrt:1: the file ends within `Shape`: it may be truncated");
    refused("Shape \"sphere", "a.pbrt:1: a quoted string is not closed on its line");
    refused("Shape \"sphere\" \"radius\" 1", "a.pbrt:1: \"radius\": expected a parameter of the form \"type name\"");
    refused("Shape \"sphere\" \"float radius\"", "a.pbrt:1: \"radius\" has no values: the file may be truncated");
    refused("Shape \"sphere\" \"float radius\" [ 1", "a.pbrt:1: \"radius\" has no values: the file may be truncated");
    refused(
        "Shape \"sphere\"\n\"float radius\" [ 1 \"a\" ]",
        "a.pbrt:2: numbers, strings and booleans are mixed in one list",
    );
    refused("[ 1 ]", "a.pbrt:1: expected a directive such as `Shape`, found a value");
    refused("Include \"none.pbrt\"", "none.pbrt: no such scene file; check the path");
    let own = read(&[("a.pbrt", "Include \"a.pbrt\"")]).expect_err("endless");
    assert_eq!(own, "a.pbrt:1: includes are nested more than 16 levels deep; check for files that include each other");
    refused(
        "Include \"a.pbrt.gz\"",
        "a.pbrt:1: `Include \"a.pbrt.gz\"`: compressed files are not supported; decompress it and change the name",
    );
}

#[test]
fn included_files_lie_in_the_sandbox() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let inner = folder.path().join("inner");
    fs::create_dir(&inner).expect("made");
    fs::write(folder.path().join("secret.pbrt"), "WorldBegin").expect("written");
    let file = inner.join("a.pbrt");
    fs::write(&file, "Include \"../secret.pbrt\"").expect("written");
    let sandbox = Sandbox::for_job(Path::new(&file), &[]).expect("a sandbox");
    let message = read_pbrt(&file, &sandbox, &mut |_, _| Ok(())).expect_err("outside").to_string();
    assert!(message.contains("a.pbrt:1: ") && message.contains("is outside"), "{message}");
}
