//! Mitsuba's scene files as elements: parameters, included files, errors with their place.

use etendue_import::syntax::mitsuba::{MitsubaElement, MitsubaScene, read_mitsuba};
use etendue_io::Sandbox;
use std::fs;

/// Root of the first file; the others are next to it.
fn read(files: &[(&str, &str)]) -> Result<MitsubaElement, String> {
    read_with(files, &[]).map(|scene| scene.root)
}

/// The same with values of parameters.
fn read_with(files: &[(&str, &str)], parameters: &[(&str, &str)]) -> Result<MitsubaScene, String> {
    let folder = tempfile::tempdir().expect("a temporary folder");
    files.iter().for_each(|(name, text)| fs::write(folder.path().join(name), text).expect("written"));
    let relative_text = |e: etendue_io::Error| e.to_string().replace(&format!("{}/", folder.path().display()), "");
    let parameters: Vec<_> = parameters.iter().map(|(name, value)| ((*name).to_owned(), (*value).to_owned())).collect();
    read_mitsuba(&folder.path().join(files[0].0), &parameters, &Sandbox::NONE).map_err(relative_text)
}

#[test]
fn elements_have_parameters_and_included_files_in_their_places() {
    let text = "<?xml version='1.0'?>\n<scene version=\"3.0.0\">\n<!-- a remark -->\n<default name=\"r\" value=\"2\"/>\n\
        <default name=\"radius\" value=\"$r.5\"/><default name=\"r\" value=\"9\"/>\n\
        <shape type=\"sphere\" id=\"ball\">\n<float name=\"radius\" value=\"$radius\"/></shape>\n\
        <include filename=\"more.xml\"/>\n<include filename=\"one.xml\"/></scene>";
    let more = "<scene version=\"0.6.0\">\n<bsdf type=\"plastic\"><rgb name=\"diffuseReflectance\" value=\"$r\"/></bsdf></scene>";
    let one = "<bsdf version=\"3.0.0\" type=\"diffuse\"/>";
    let root = read(&[("a.xml", text), ("more.xml", more), ("one.xml", one)]).expect("read");
    let [ball, plastic, diffuse] = &root.children[..] else { panic!("{root:?}") };
    assert_eq!((ball.tag, ball.kind(), ball.attribute("id"), ball.place.line), ("shape", "sphere", Some("ball"), 6));
    assert_eq!((ball.children[0].attribute("value"), ball.children[0].place.line), (Some("2.5"), 7));
    assert_eq!(plastic.children[0].name(), "diffuse_reflectance", "names before version 2 are spelt as today");
    assert_eq!(plastic.children[0].attribute("value"), Some("2"), "the first value of a parameter holds");
    assert_eq!((diffuse.kind(), diffuse.place.line), ("diffuse", 1));
    assert!(plastic.place.file.ends_with("more.xml"));
    let numbers = [ball, &ball.children[0], plastic, &plastic.children[0], diffuse].map(|e| e.number);
    assert!(numbers.windows(2).all(|pair| pair[0] != pair[1]), "{numbers:?}");
}

#[track_caller]
fn refused(text: &str, expected: &str) {
    assert_eq!(read(&[("a.xml", text)]).expect_err("damaged"), expected);
}

#[test]
fn faults_have_their_line() {
    refused(
        "<scene version=\"3.0.0\">\n<shape type=\"sphere\">",
        "a.xml:1: not well-formed XML: the root node was opened but never close …",
    );
    refused("<scene/>", "a.xml:1: the root element has no \"version\": not a Mitsuba 3 scene");
    refused("<scene version=\"4.0\"/>", "a.xml:1: unsupported version \"4.0\"; expected at most 3, such as \"3.0.0\"");
    refused("<bsdf version=\"3.0.0\" type=\"diffuse\"/>", "a.xml:1: the root element is <bsdf>; expected <scene>");
    refused(
        "<scene version=\"3.0.0\">\n<mesh/></scene>",
        "a.xml:2: unknown element <mesh>: Mitsuba scenes do not have it",
    );
    refused("<scene version=\"3.0.0\">\nred</scene>", "a.xml:1: text in <scene>; expected only elements");
    refused(
        "<scene version=\"3.0.0\">\n<float name=\"a\" value=\"$spp\"/></scene>",
        "a.xml:2: \"$spp\" has no <default name=\"spp\" …> before it; add one, or give a value by -D spp=…",
    );
    refused("<scene version=\"3.0.0\">\n<default name=\"a\"/></scene>", "a.xml:2: <default> has no \"value\"");
    refused(
        "<scene version=\"3.0.0\"><include filename=\"a.xml\"/></scene>",
        "a.xml:1: includes are nested more than 16 levels deep; check for files that include each other",
    );
    let deep = format!("<scene version=\"3.0.0\">\n{}{}</scene>", "<bsdf>".repeat(64), "</bsdf>".repeat(64));
    refused(&deep, "a.xml:2: elements are nested more than 64 levels deep");
}

/// Parameters that double thirty times do not become a gigabyte.
#[test]
fn parameters_of_parameters_do_not_fill_the_memory() {
    let doubling: String =
        (1..60).map(|i| format!("<default name=\"p{i:02}\" value=\"$p{0:02}$p{0:02}\"/>", i - 1)).collect();
    let text = format!("<scene version=\"3.0.0\"><default name=\"p00\" value=\"0123456789\"/>{doubling}</scene>");
    let message = read(&[("a.xml", &text)]).expect_err("too large");
    assert!(message.contains("16 MiB are allowed"), "{message}");
}

#[test]
fn included_files_lie_in_the_sandbox() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let inner = folder.path().join("inner");
    fs::create_dir(&inner).expect("made");
    fs::write(folder.path().join("secret.xml"), "<scene version=\"3.0.0\"/>").expect("written");
    let file = inner.join("a.xml");
    fs::write(&file, "<scene version=\"3.0.0\"><include filename=\"../secret.xml\"/></scene>").expect("written");
    let sandbox = Sandbox::for_job(&file, &[]).expect("a sandbox");
    let message = read_mitsuba(&file, &[], &sandbox).expect_err("outside").to_string();
    assert!(message.contains("a.xml:1: ") && message.contains("is outside"), "{message}");
}

/// Names of parameters are unchanged, and `$name` uses them so.
#[test]
fn parameters_of_old_files_keep_their_names() {
    let text = "<scene version=\"0.5.0\"><default name=\"camDist\" value=\"3\"/><default name=\"cam\" value=\"9\"/>\
        <bsdf type=\"diffuse\"><rgb name=\"diffuseReflectance\" value=\"1\"/><float name=\"intIOR\" value=\"$camDist\"/></bsdf></scene>";
    let root = read(&[("a.xml", text)]).expect("read");
    let [colour, index] = &root.children[0].children[..] else { panic!("{root:?}") };
    assert_eq!((colour.name(), index.name(), index.attribute("value")), ("reflectance", "int_ior", Some("3")));
}

/// As in Mitsuba 3.9.1 (`mi.load_file` with `r="7"` and so on; 2, 5 and 7.5 are its radii).
#[test]
fn values_that_are_given_hold_in_place_of_defaults() {
    let scene = |body: &str| format!("<scene version=\"3.0.0\">{body}</scene>");
    let ball = |value: &str| format!("<shape type=\"sphere\"><float name=\"radius\" value=\"{value}\"/></shape>");
    let two = "<default name=\"r\" value=\"2\"/>";
    for (body, inputs, radius) in [
        (format!("{two}{}", ball("$r")), &[][..], "2"),
        (format!("{two}{}", ball("$r")), &[("r", "5")], "5"),
        (ball("$r"), &[("r", "7")], "7"),
        (format!("{two}<default name=\"rr\" value=\"$r.5\"/>{}", ball("$rr")), &[("r", "7")], "7.5"),
        (format!("{two}{}", ball("$r$s")), &[("s", "=4"), ("r", "")], "=4"),
    ] {
        let read = read_with(&[("a.xml", &scene(&body))], inputs).expect("read");
        assert_eq!(read.root.children[0].children[0].attribute("value"), Some(radius), "{body}, {inputs:?}");
    }
    for (body, inputs, expected) in [
        (
            format!("{two}<default name=\"q\" value=\"0\"/>{}", ball("$r")),
            &[("r", "5"), ("q", "5")][..],
            "a.xml: a value is given to the parameter \"q\", and \"$q\" does not occur in the scene: its parameters are $r",
        ),
        (
            ball("1"),
            &[("r", "5")],
            "a.xml: a value is given to the parameter \"r\", and \"$r\" does not occur in the scene: the scene has no parameters",
        ),
        (ball("$r"), &[("r", "5"), ("r", "6")], "a.xml: the parameter \"r\" has two values; give one"),
    ] {
        assert_eq!(read_with(&[("a.xml", &scene(&body))], inputs).expect_err("refused"), expected, "{body}");
    }
}

/// Tree of files in a temporary folder: scenes with a body.
fn tree(files: &[(&str, &str)]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a temporary folder");
    for (name, body) in files {
        let path = folder.path().join(name);
        fs::create_dir_all(path.parent().expect("a folder")).expect("made");
        fs::write(path, format!("<scene version=\"3.0.0\">{body}</scene>")).expect("written");
    }
    folder
}

/// Search order: next to the including file, then the folders of its `<path>`, last first, then the folders of the file that includes it. These are the files
/// that Mitsuba 3.9.1 finds.
#[test]
fn included_files_are_searched_next_to_the_file_that_includes_them() {
    let folder = tree(&[
        ("a.xml", "<path value=\"store\"/><path value=\"deep\"/><include filename=\"parts/b.xml\"/>"),
        (
            "parts/b.xml",
            "<path value=\"own\"/><include filename=\"c.xml\"/><include filename=\"d.xml\"/><include filename=\"e.xml\"/><include filename=\"f.xml\"/><include filename=\"g.xml\"/>",
        ),
        ("parts/c.xml", "<shape type=\"sphere\" id=\"inner\"/>"),
        ("c.xml", "<shape type=\"sphere\" id=\"outer\"/>"),
        ("d.xml", "<shape type=\"sphere\" id=\"first\"/>"),
        ("e.xml", "<shape type=\"sphere\" id=\"beside the first\"/>"),
        ("store/e.xml", "<shape type=\"sphere\" id=\"stored\"/>"),
        ("store/deep/e.xml", "<shape type=\"sphere\" id=\"stored deep\"/>"),
        ("store/deep/f.xml", "<shape type=\"sphere\" id=\"deep\"/>"),
        ("parts/own/f.xml", "<shape type=\"sphere\" id=\"own\"/>"),
        ("store/g.xml", "<shape type=\"sphere\" id=\"stored g\"/>"),
        ("store/deep/g.xml", "<shape type=\"sphere\" id=\"deep g\"/>"),
    ]);
    let scene = read_mitsuba(&folder.path().join("a.xml"), &[], &Sandbox::NONE).expect("read");
    let ids: Vec<_> = scene.root.children.iter().filter_map(|child| child.attribute("id")).collect();
    assert_eq!(ids, ["inner", "first", "beside the first", "own", "deep g"]);
    let folders: Vec<_> =
        scene.folders.iter().map(|f| f.strip_prefix(folder.path()).expect("below").to_string_lossy()).collect();
    assert_eq!(folders, ["store/deep", "store", "", "parts/own"], "meshes: a <path> leads from one before");
}

#[test]
fn folders_that_are_not_there_are_refused() {
    for (body, message) in [
        (
            "<path value=\"none\"/>",
            "a.xml:1: <path value=\"none\">: no such folder next to the file or in an earlier <path>; correct it, or remove it",
        ),
        (
            "<shape type=\"sphere\"><path value=\".\"/></shape>",
            "a.xml:1: <path> is in another element; expected it at the top level of the scene",
        ),
        ("<path/>", "a.xml:1: <path> has no \"value\""),
    ] {
        refused(&format!("<scene version=\"3.0.0\">{body}</scene>"), message);
    }
    let many = "<path value=\".\"/>".repeat(65);
    refused(
        &format!("<scene version=\"3.0.0\">{many}</scene>"),
        "a.xml:1: more than 64 <path> elements; use fewer folders",
    );
}
