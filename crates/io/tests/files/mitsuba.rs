//! Mitsuba's scene files as elements: parameters, included files, faults with their place.

use etendue_io::Sandbox;
use etendue_io::mitsuba::{MitsubaElement, read_mitsuba};
use std::fs;

/// The root of the first file; the others lie beside it.
fn read(files: &[(&str, &str)]) -> Result<MitsubaElement, String> {
    let folder = tempfile::tempdir().expect("a temporary folder");
    files.iter().for_each(|(name, text)| fs::write(folder.path().join(name), text).expect("written"));
    let told = |e: etendue_io::Error| e.to_string().replace(&format!("{}/", folder.path().display()), "");
    read_mitsuba(&folder.path().join(files[0].0), &Sandbox::NONE).map_err(told)
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
fn refused(text: &str, told: &str) {
    assert_eq!(read(&[("a.xml", text)]).expect_err("damaged"), told);
}

#[test]
fn faults_have_their_line() {
    refused(
        "<scene version=\"3.0.0\">\n<shape type=\"sphere\">",
        "a.xml:1: no well-formed XML: the root node was opened but never close …",
    );
    refused("<scene/>", "a.xml:1: no \"version\" of the root element: no scene of Mitsuba 3, which has it");
    refused("<scene version=\"4.0\"/>", "a.xml:1: version \"4.0\"; expected one up to 3, as \"3.0.0\"");
    refused(
        "<bsdf version=\"3.0.0\" type=\"diffuse\"/>",
        "a.xml:1: <bsdf> where a whole scene is expected: a file whose root is <scene>",
    );
    refused("<scene version=\"3.0.0\">\n<mesh/></scene>", "a.xml:2: <mesh> is no element of Mitsuba's scenes");
    refused("<scene version=\"3.0.0\">\nred</scene>", "a.xml:1: text within <scene>; expected elements alone");
    refused(
        "<scene version=\"3.0.0\">\n<float name=\"a\" value=\"$spp\"/></scene>",
        "a.xml:2: no <default name=\"spp\" …> stands before \"$spp\": add it, with a value",
    );
    refused("<scene version=\"3.0.0\">\n<default name=\"a\"/></scene>", "a.xml:2: <default> without \"value\"");
    refused(
        "<scene version=\"3.0.0\"><include filename=\"a.xml\"/></scene>",
        "a.xml:1: files include one another more than 16 deep; include less, or each once",
    );
    let deep = format!("<scene version=\"3.0.0\">\n{}{}</scene>", "<bsdf>".repeat(64), "</bsdf>".repeat(64));
    refused(&deep, "a.xml:2: elements stand more than 64 deep in one another");
}

/// Parameters that double thirty times are no gigabyte.
#[test]
fn parameters_of_parameters_do_not_fill_the_memory() {
    let doubling: String =
        (1..60).map(|i| format!("<default name=\"p{i:02}\" value=\"$p{0:02}$p{0:02}\"/>", i - 1)).collect();
    let text = format!("<scene version=\"3.0.0\"><default name=\"p00\" value=\"0123456789\"/>{doubling}</scene>");
    let told = read(&[("a.xml", &text)]).expect_err("too large");
    assert!(told.contains("16 MiB are allowed"), "{told}");
}

#[test]
fn included_files_lie_in_the_sandbox() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let inner = folder.path().join("inner");
    fs::create_dir(&inner).expect("made");
    fs::write(folder.path().join("secret.xml"), "<scene version=\"3.0.0\"/>").expect("written");
    let file = inner.join("a.xml");
    fs::write(&file, "<scene version=\"3.0.0\"><include filename=\"../secret.xml\"/></scene>").expect("written");
    let sandbox = Sandbox::about(&file, &[]).expect("a sandbox");
    let told = read_mitsuba(&file, &sandbox).expect_err("outside").to_string();
    assert!(told.contains("a.xml:1: ") && told.contains("leads out of"), "{told}");
}

/// Names of parameters stay as they are, and `$name` names them so.
#[test]
fn parameters_of_old_files_keep_their_names() {
    let text = "<scene version=\"0.5.0\"><default name=\"camDist\" value=\"3\"/><default name=\"cam\" value=\"9\"/>\
        <bsdf type=\"diffuse\"><rgb name=\"diffuseReflectance\" value=\"1\"/><float name=\"intIOR\" value=\"$camDist\"/></bsdf></scene>";
    let root = read(&[("a.xml", text)]).expect("read");
    let [colour, index] = &root.children[0].children[..] else { panic!("{root:?}") };
    assert_eq!((colour.name(), index.name(), index.attribute("value")), ("reflectance", "int_ior", Some("3")));
}

/// First beside the file that includes, then beside the first file, then where `<path>` leads.
#[test]
fn included_files_are_sought_beside_the_file_that_includes_them() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let write = |name: &str, body: &str| {
        let path = folder.path().join(name);
        fs::create_dir_all(path.parent().expect("a folder")).expect("made");
        fs::write(path, format!("<scene version=\"3.0.0\">{body}</scene>")).expect("written");
    };
    let ball = |id: &str| format!("<shape type=\"sphere\" id=\"{id}\"/>");
    write("a.xml", "<path value=\"store\"/><include filename=\"parts/b.xml\"/>");
    write("parts/b.xml", "<include filename=\"c.xml\"/><include filename=\"d.xml\"/><include filename=\"e.xml\"/>");
    for (name, id) in [("parts/c.xml", "inner"), ("c.xml", "outer"), ("d.xml", "first"), ("store/e.xml", "stored")] {
        write(name, &ball(id));
    }
    let root = read_mitsuba(&folder.path().join("a.xml"), &Sandbox::NONE).expect("read");
    let ids: Vec<_> = root.children.iter().filter_map(|child| child.attribute("id")).collect();
    assert_eq!(ids, ["inner", "first", "stored"]);
}
