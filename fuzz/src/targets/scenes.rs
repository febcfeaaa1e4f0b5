//! Scenes of other programs.

use super::assets::{GLTF, text_target};
use super::seeds::{repository, stored, write};
use super::target::{TREE, Target, told};
use std::path::Path;

fn imported(file: &Path) -> String {
    let made = file.with_file_name("made");
    told(etendue::import(file, (&made, etendue::Existing::Replace), &etendue::Unobserved))
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
            let beside = ["cornell-surfaces.xml", "studio.exr", "letter.png", "post.obj"];
            let contents = repository([
                "scenes/import/cornell-surfaces.xml",
                "scenes/import/studio.exr",
                "scenes/import/letter.png",
                "scenes/import/post.obj",
            ]);
            beside.iter().zip(contents).for_each(|(name, bytes)| write(folder, name, bytes));
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

const USD_WORDS: &[&str] = &[
    "#usda 1.0",
    "PXR-USDC",
    "def Mesh \"Card\" {",
    "def PointInstancer \"p\" { rel prototypes = </World/Fence> }",
    "(prepend references = @./kinds-prop.usda@)",
    "(prepend references = </World>)",
    "(prepend payload = @a.usd@)",
    "(inherits = </World/Turned>)",
    "subLayers = [@a.usd@]",
    "instanceable = true",
    "active = false",
    "over \"World\" {",
    "class \"World\" {",
    "variantSet \"size\" = { \"large\" { } }",
    "int[] faceVertexCounts = [4, -1, 2147483647]",
    "token visibility = \"invisible\"",
    "uniform token[] xformOpOrder = [\"!invert!xformOp:scale\"]",
    "double3 xformOp:translate = (1e308, nan, inf)",
    ".timeSamples = { 1: (1, 2, 3), 0: None }",
    "token outputs:surface.connect = </World/Materials/Plain.outputs:surface>",
    "string inputs:varname = \"`${A}`\"",
    "upAxis = \"Z\"",
    "metersPerUnit = 0",
];

fn usd_seeds(folder: &Path) -> Vec<Vec<u8>> {
    let beside = ["kinds-prop.usda", "letter.png"];
    let contents = repository(["scenes/import/kinds-prop.usda", "scenes/import/letter.png"]);
    beside.iter().zip(contents).for_each(|(name, bytes)| write(folder, name, bytes));
    repository(["scenes/import/kinds.usda", "scenes/import/kinds.usdc", "scenes/import/table.usda"])
}

/// What is composed of it, and what is written, with all instances; a layer beside it counts with it.
pub(super) const USD: Target =
    Target { times: TREE, is_text: false, ..text_target("usd", "a.usd", usd_seeds, imported, USD_WORDS) };

/// The same of packages.
pub(super) const USDZ: Target = Target {
    times: TREE,
    is_text: false,
    ..text_target(
        "usdz",
        "a.usdz",
        |_| repository(["scenes/import/kinds.usdz"]),
        imported,
        &["PK\x05\x06", "PK\x01\x02"],
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
