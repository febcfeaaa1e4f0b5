//! Scenes of other programs.

use super::assets::{GLTF, text_target};
use super::seeds::{repository, stored, write};
use super::target::{TREE, Target, result_text};
use std::path::Path;

pub(super) fn imported(file: &Path) -> String {
    let out_folder = file.with_file_name("made");
    let request = etendue::ImportRequest { file: file.to_path_buf(), ..Default::default() };
    result_text(etendue::import(&request, &out_folder, etendue::ExistingFiles::Replace, &etendue::NullObserver))
}

const PBRT_WORDS: &[&str] = &[
    "WorldBegin",
    "AttributeBegin",
    "AttributeEnd",
    "ObjectBegin \"o\"",
    "ObjectEnd",
    "ObjectInstance \"o\"",
    "ReverseOrientation",
    "Scale -1 1 0",
    "Rotate 90 0 0 0",
    "LookAt 0 0 0 0 0 0 0 0 1",
    "CoordSysTransform \"camera\"",
    "Shape \"bilinearmesh\"",
    "Shape \"loopsubdiv\"",
    "Shape \"plymesh\" \"string filename\" \"a.pbrt\"",
    "Include \"a.pbrt\"",
    "\"float lensradius\" 1e-3 \"float focaldistance\" 1e-9",
    "\"texture reflectance\" \"t\"",
    "Texture \"t\" \"spectrum\" \"scale\" \"texture tex\" \"t\"",
    "\"spectrum eta\" [ 400 1 700 2 ]",
    "LightSource \"infinite\" \"string filename\" \"a.pbrt\"",
    "MediumInterface \"smoke\" \"\"",
    "1e308",
    "-0",
];

/// A placed shape may take as much as its own lines and its mesh; an instance of one, a line alone.
pub(super) const PBRT: Target = Target {
    times: TREE,
    ..text_target(
        "pbrt",
        "a.pbrt",
        |folder| {
            let scenes =
                repository(["scenes/import/shapes.pbrt", "scenes/import/smoke.pbrt", "scenes/import/box.pbrt"]);
            write(folder, "box.pbrt", scenes[2].clone());
            scenes
        },
        imported,
        PBRT_WORDS,
    )
};

const MITSUBA_WORDS: &[&str] = &[
    "<scene version=\"3.0.0\">",
    "</scene>",
    "<default name=\"a\" value=\"$a$a\"/>",
    "<include filename=\"a.xml\"/>",
    "<ref id=\"floor\"/>",
    "<alias id=\"floor\" as=\"ground\"/>",
    "<bsdf type=\"mask\" id=\"m\"><ref id=\"m\"/></bsdf>",
    "<shape type=\"instance\">",
    "<shape type=\"shapegroup\" id=\"g\">",
    "<shape type=\"instance\"><ref id=\"g\"/></shape>",
    "<shape type=\"shapegroup\" id=\"h\"><shape type=\"instance\"><ref id=\"g\"/></shape></shape>",
    "<bsdf type=\"blendbsdf\" id=\"b\"><ref id=\"a\"/><ref id=\"a\"/></bsdf>",
    "<bsdf type=\"blendbsdf\" id=\"a\"><ref id=\"b\"/><ref id=\"b\"/></bsdf>",
    "<path value=\".\"/>",
    "<volume name=\"albedo\" type=\"constvolume\"><ref name=\"value\" id=\"a\"/></volume>",
    "<shape type=\"cylinder\"/>",
    "<shape type=\"ply\"><string name=\"filename\" value=\"a.xml\"/></shape>",
    "<emitter type=\"area\"/>",
    "<spectrum name=\"radiance\" value=\"400:1 300:2\"/>",
    "<rgb name=\"reflectance\" value=\"2 -1 0\"/>",
    "<texture type=\"checkerboard\"/>",
    "<scale value=\"0\"/>",
    "<rotate x=\"0\" angle=\"90\"/>",
    "<matrix value=\"1 0 0 0 1 0 0 0 1\"/>",
    "<float name=\"alpha\" value=\"1e308\"/>",
    "<!ENTITY a \"b\">",
];

pub(super) const MITSUBA: Target = Target {
    times: TREE,
    ..text_target(
        "mitsuba",
        "a.xml",
        |folder| {
            let neighbours = ["cornell-surfaces.xml", "studio.exr", "letter.png", "post.obj"];
            let contents = repository([
                "scenes/import/cornell-surfaces.xml",
                "scenes/import/studio.exr",
                "scenes/import/letter.png",
                "scenes/import/post.obj",
            ]);
            neighbours.iter().zip(contents).for_each(|(name, bytes)| write(folder, name, bytes));
            repository([
                "scenes/import/cornell.xml",
                "scenes/import/studio.xml",
                "scenes/import/shapes.xml",
                "scenes/import/smoke.xml",
            ])
        },
        imported,
        MITSUBA_WORDS,
    )
};

/// Lights, cameras and what moves: each part that moves has the text of the whole, which is limited.
pub(super) const GLTF_SCENE: Target = Target {
    name: "gltf-scene",
    prepare: |_| {
        let mut seeds = stored("gltf");
        seeds.extend(stored("gltf-scene"));
        seeds
    },
    read: imported,
    ..GLTF
};
