//! Unused parts of a scene are not required.

use crate::files::{DescriptionFiles, load};
use etendue_scene::Description;
use std::path::Path;

const JOB: &str = r#"
[scene]
meshes = [
    { name = "shown", file = "shown.obj", up_axis = "z" },
    { name = "spare", file = "spare.obj", up_axis = "z" },
]
textures = [
    { name = "a", file = "a.png", encoding = "srgb" },
    { name = "b", file = "b.png", encoding = "srgb" },
    { name = "c", file = "c.png", encoding = "srgb" },
]
materials = [
    { name = "wall", type = "diffuse", reflectance = { texture = "a" } },
    { name = "mixed", type = "mix", a = "wall", b = "tin", weight = 0.5 },
    { name = "tin", type = "diffuse", reflectance = { spectrum = "tin.csv" } },
    { name = "rest", type = "diffuse", reflectance = { texture = "b" } },
    { name = "more", type = "diffuse", reflectance = { spectrum = "more.csv" } },
]
objects = [{ name = "o", mesh = "shown", material = "MATERIAL", position_m = [5, 0, 1] }]
"#;

fn described(material: &str) -> Description {
    load(&DescriptionFiles::with_camera(&JOB.replace("MATERIAL", material)), &[]).expect("a right job")
}

fn files(description: &Description) -> Vec<String> {
    let mut names: Vec<_> = description.assets().iter().map(|a| a.path.display().to_string()).collect();
    names.sort();
    names
}

#[test]
fn files_of_what_is_shown_are_asked_for_and_no_others() {
    assert_eq!(files(&described("wall")), ["a.png", "shown.obj"]);
    assert_eq!(files(&described("mixed")), ["a.png", "shown.obj", "tin.csv"], "parts of a mix are used");
    assert_eq!(files(&described("rest")), ["b.png", "shown.obj"]);
}

#[test]
fn unused_names_are_reported() {
    assert_eq!(
        described("mixed").unused.notes(),
        [
            "not read: mesh used by no object: spare",
            "not read: 2 materials used by no object: more, rest",
            "not read: 2 textures used by no material in use: b, c"
        ]
    );
}

#[test]
fn a_material_of_the_scene_covers_those_of_the_mesh() {
    let covered = |job: &str| {
        let description = load(&DescriptionFiles::with_camera(job), &[]).expect("a right job");
        let request = description.assets().into_iter().find(|a| a.path == Path::new("shown.obj")).expect("the mesh");
        ["red", "blue"].map(|slot| request.covered.has(slot))
    };
    let own = JOB.replace("material = \"MATERIAL\"", "materials = { red = \"wall\" }");
    assert_eq!(covered(&JOB.replace("MATERIAL", "wall")), [true, true]);
    assert_eq!(covered(&own), [true, false]);
    let second = ", { name = \"p\", mesh = \"shown\", position_m = [9, 0, 1] }]\n";
    assert_eq!(
        covered(&format!("{}{second}", own.trim_end().trim_end_matches(']'))),
        [false, false],
        "another shows them"
    );
}
