//! Scenes of Mitsuba's format, and of pbrt's, against Mitsuba's own renders of them.
//!
//! tests/oracles/mitsuba_scenes.py rendered scenes/import/*.xml; figures/mitsuba_scenes.json stores the means of linear sRGB over boxes of 12 by 12
//! pixels with their standard errors. A unit of Mitsuba is 1 cd/m² here.

use crate::support::{etendue, root, text};
use etendue_io::mesh::read_mesh;
use etendue_io::picture::read_image;
use etendue_scene::asset::ImagePixels;
use serde_json::Value;
use std::fs;
use std::path::Path;

/// Student's bound of 144 tests together at 1 in 1 000: Mitsuba's standard errors are from 16 images.
const CRITICAL: f64 = 6.71;
/// Number of our independent images.
const SEEDS: usize = 3;

/// Means of linear sRGB over boxes, cd/m², and their standard errors.
struct BoxMeans {
    mean: Vec<[f64; 3]>,
    error: Vec<[f64; 3]>,
}

fn stored(name: &str) -> BoxMeans {
    let figures = include_str!("../../../../tests/oracles/figures/mitsuba_scenes.json");
    let figures: Value = serde_json::from_str(figures).expect("JSON");
    let list = |key: &str| -> Vec<[f64; 3]> {
        serde_json::from_value(figures["scenes"][name][key].clone()).expect("rows of three numbers")
    };
    BoxMeans { mean: list("mean"), error: list("standard_error") }
}

/// Pixels of a radiance file by its preview, linear sRGB in cd/m².
pub(crate) fn pixels(file: &Path) -> (usize, Vec<[f64; 3]>) {
    let image = read_image(file).expect("a picture");
    let ImagePixels::Rgb32F(pixels) = image.pixels else { panic!("linear colours are expected") };
    (image.width as usize, pixels.iter().map(|p| p.map(f64::from)).collect())
}

/// Means over boxes of `side` pixels. Pixels are independent of each other: the variance of a box is the sum of those of its pixels, each known from
/// `SEEDS` images.
fn boxes(images: &[(usize, Vec<[f64; 3]>)], side: usize) -> BoxMeans {
    let (width, first) = &images[0];
    let (columns, rows) = (width / side, first.len() / width / side);
    let (seeds, count) = (images.len() as f64, (side * side) as f64);
    let mut means = BoxMeans { mean: Vec::new(), error: Vec::new() };
    for place in 0..columns * rows {
        let (mut mean, mut variance) = ([0.0; 3], [0.0; 3]);
        for pixel in 0..side * side {
            let (x, y) = (place % columns * side + pixel % side, place / columns * side + pixel / side);
            for channel in 0..3 {
                let values = images.iter().map(|(_, pixels)| pixels[y * width + x][channel]);
                let own = values.clone().sum::<f64>() / seeds;
                mean[channel] += own / count;
                let squares = values.map(|v| (v - own) * (v - own)).sum::<f64>();
                variance[channel] += squares / (seeds - 1.0) / seeds / (count * count);
            }
        }
        means.mean.push(mean);
        means.error.push(variance.map(f64::sqrt));
    }
    means
}

/// Imports a scene and renders it.
fn rendered(folder: &Path, file: &Path) -> BoxMeans {
    let imported = folder.join("made");
    etendue(["import", &text(file), "-o", &text(&imported)]).ok();
    let job = fs::read_to_string(imported.join("job.toml")).expect("a job");
    let name = job.split("name = \"").nth(1).and_then(|rest| rest.split('"').next()).expect("a camera").to_owned();
    let images: Vec<(usize, Vec<[f64; 3]>)> = (1..=SEEDS)
        .map(|seed| {
            let out = folder.join(format!("out-{seed}"));
            let job = text(&imported.join("job.toml"));
            etendue(["render", &job, "-o", &text(&out), "--spp", "48", "--seed", &seed.to_string()]).ok();
            pixels(&out.join(&name).join("radiance.exr"))
        })
        .collect();
    boxes(&images, 12)
}

/// Difference between the models of two programs: a fraction of every box's luminance, and more in some boxes.
#[derive(Clone, Copy)]
struct ModelDifference {
    overall: f64,
    /// Boxes by their numbers, row by row, and their fractions.
    boxes: &'static [(usize, f64)],
}

/// Equal models.
const NONE: ModelDifference = ModelDifference { overall: 0.0, boxes: &[] };

/// Colours are converted to spectra by two rules, which agree under D65 and to 0.2 % after two bounces here. Spheres of rough plastic are brighter
/// than Mitsuba's, whose rough interfaces lose light: at α = 0.3 the base retains 0.310 of 0.366 (blue, of which most comes from the base, by 14 % of
/// the luminance). Gold is from two tables.
const SHAPES: ModelDifference = ModelDifference {
    overall: 0.002,
    boxes: &[
        (18, 0.02),
        (20, 0.15),
        (21, 0.15),
        (26, 0.03),
        (27, 0.05),
        (28, 0.06),
        (29, 0.06),
        (35, 0.06),
        (36, 0.06),
    ],
};

/// Largest deviation of a mean from Mitsuba's beyond the allowed difference, in standard errors, and the relative difference of the whole images'
/// luminances.
fn max_deviation(ours: &BoxMeans, theirs: &BoxMeans, model_difference: ModelDifference) -> (f64, f64) {
    let luminance = |rgb: &[f64; 3]| 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
    let mut largest = 0.0_f64;
    assert_eq!(ours.mean.len(), theirs.mean.len());
    for i in 0..ours.mean.len() {
        for channel in 0..3 {
            let difference = (ours.mean[i][channel] - theirs.mean[i][channel]).abs();
            let own = model_difference
                .boxes
                .iter()
                .find(|(place, _)| *place == i)
                .map_or(model_difference.overall, |(_, own)| *own);
            let allowed = own * luminance(&theirs.mean[i]);
            let (own, other) = (ours.error[i][channel], theirs.error[i][channel]);
            let error = (own * own + other * other).sqrt();
            // Both are zero where nothing is seen; values are stored to 1e-6.
            let beyond = (difference - allowed).max(0.0) / error.max(1e-6);
            largest = largest.max(beyond);
        }
    }
    let sum = |boxes: &BoxMeans| boxes.mean.iter().map(luminance).sum::<f64>();
    (largest, sum(ours) / sum(theirs) - 1.0)
}

/// Compares a scene of scenes/import with Mitsuba's image, the whole image within `whole` of its luminance.
fn assert_agrees(file: &str, name: &str, model_difference: ModelDifference, overall: f64) {
    assert_agrees_as(&root().join("scenes/import").join(file), name, model_difference, overall);
}

fn assert_agrees_as(source: &Path, name: &str, model_difference: ModelDifference, overall: f64) {
    let file = source.display();
    let place = tempfile::tempdir().expect("a temporary folder");
    let (ours, theirs) = (rendered(place.path(), source), stored(name));
    let (largest, mean) = max_deviation(&ours, &theirs, model_difference);
    let critical = CRITICAL;
    assert!(largest < critical, "{file}: {largest} standard errors, where {critical} are allowed");
    assert!(mean.abs() < overall, "{file}: the whole picture is {mean} brighter");
    // The test must be able to fail: light changed by a twentieth, and the image mirrored.
    let brighter =
        BoxMeans { mean: ours.mean.iter().map(|m| m.map(|v| 1.05 * v)).collect(), error: ours.error.clone() };
    let mirrored = |list: &[[f64; 3]]| list.chunks(8).flat_map(|row| row.iter().rev().copied()).collect();
    let mirrored = BoxMeans { mean: mirrored(&ours.mean), error: mirrored(&ours.error) };
    assert!(max_deviation(&brighter, &theirs, model_difference).1.abs() > overall, "{file}: more light is found");
    assert!(max_deviation(&mirrored, &theirs, model_difference).0 > critical, "{file}: a mirrored picture is found");
}

/// Spectra of surfaces and of the lamp, rotated and scaled cubes, parameters, an included file: without differences between the programs.
#[test]
fn a_box_of_measured_colours_is_mitsubas() {
    assert_agrees("cornell.xml", "cornell", NONE, 0.01);
}

/// A lens, a rotated image of light, a point, a parallel light, a mirrored rectangle with an image, coats, metal, glass, a mask.
#[test]
fn glossy_clear_and_pierced_objects_agree_with_mitsuba() {
    assert_agrees("studio.xml", "studio", NONE, 0.01);
}

#[test]
fn shapes_of_pbrt_and_mitsuba_are_mitsubas() {
    assert_agrees("shapes.xml", "shapes", SHAPES, 0.01);
    assert_agrees("shapes.pbrt", "shapes", SHAPES, 0.01);
}

/// An orthographic camera, smoke, instances of a mesh; of pbrt's file without its spot, whose edge differs in Mitsuba.
#[test]
fn smoke_of_pbrt_and_mitsuba_is_mitsubas() {
    assert_agrees("smoke.xml", "smoke", NONE, 0.01);
    let place = tempfile::tempdir().expect("a temporary folder");
    let folder = root().join("scenes/import");
    fs::copy(folder.join("post.ply"), place.path().join("post.ply")).expect("copied");
    let scene = fs::read_to_string(folder.join("smoke.pbrt")).expect("a scene");
    let (before, after) = scene.split_once("LightSource \"spot\"").expect("a spot");
    let (_, after) = after.split_once("LightSource \"point\"").expect("a point light behind it");
    let file = place.path().join("smoke.pbrt");
    fs::write(&file, format!("{before}LightSource \"point\"{after}")).expect("written");
    assert_agrees_as(&file, "smoke", NONE, 0.01);
}

/// Writes a Mitsuba scene and imports it.
fn imported(body: &str) -> (tempfile::TempDir, crate::support::CommandOutput) {
    let place = tempfile::tempdir().expect("a temporary folder");
    let file = place.path().join("a.xml");
    fs::write(&file, format!("<scene version=\"3.0.0\">\n{body}</scene>")).expect("written");
    let output = etendue(["import", &text(&file), "-o", &text(&place.path().join("made"))]);
    (place, output)
}

#[test]
fn unsupported_content_is_reported_and_the_rest_is_a_scene() {
    let (place, output) = imported(
        "<shape type=\"serialized\"><string name=\"filename\" value=\"a.serialized\"/></shape>\n\
         <shape type=\"sphere\"><bsdf type=\"hair\"/><float name=\"wobble\" value=\"2\"/></shape>\n\
         <emitter type=\"sunsky\"/><emitter type=\"constant\"/>\n\
         <bsdf type=\"roughplastic\" id=\"p\"><float name=\"alpha\" value=\"0.1\"/></bsdf>\n\
         <shape type=\"cylinder\"><ref id=\"p\"/></shape>\n\
         <shape type=\"disk\"><bsdf type=\"principled\"><float name=\"metallic\" value=\"0.5\"/></bsdf></shape>\n\
         <shape type=\"cube\"><bsdf type=\"diffuse\"><texture type=\"checkerboard\" name=\"reflectance\"/></bsdf></shape>\n\
         <shape type=\"rectangle\"><bsdf type=\"conductor\"/></shape>\n",
    );
    let messages = output.ok().err;
    for phrase in [
        "the shape \"serialized\" is left out: export its mesh as OBJ or PLY (a.xml:2)",
        "the surface \"hair\" is not supported: a diffuse grey of 0.5 is used instead (a.xml:3)",
        "shape \"sphere\": \"wobble\" is not used (a.xml:3)",
        "the emitter \"sunsky\" is not supported and left out (a.xml:4)",
        "the Beckmann distribution of a \"roughplastic\" becomes GGX with the same α",
        "it has no supported camera",
    ] {
        assert!(messages.contains(phrase), "{phrase}: {messages}");
    }
    assert!(!messages.contains("<ref>"), "{messages}");
    etendue(["plan", &text(&place.path().join("made/job.toml"))]).ok();
}

#[test]
fn damaged_scenes_are_refused_with_their_line_and_nothing_is_written() {
    for (body, phrase) in [
        ("<shape type=\"sphere\"><ref id=\"none\"/></shape>", "a.xml:2: no element has the id \"none\""),
        ("<shape type=\"sphere\"><float name=\"radius\" value=\"-1\"/></shape>", "\"radius\" is -1"),
        ("<shape type=\"sphere\"><float name=\"radius\" value=\"wide\"/></shape>", "expected a number, found \"wide\""),
        (
            "<bsdf type=\"mask\" id=\"m\"><ref id=\"m\"/></bsdf><shape type=\"disk\"><ref id=\"m\"/></shape>",
            "or form a cycle",
        ),
        (
            "<shape type=\"shapegroup\" id=\"g\"><shape type=\"instance\"><ref id=\"g\"/></shape></shape><shape type=\"instance\"><ref id=\"g\"/></shape>",
            "is in an instance, which Mitsuba does not allow",
        ),
        ("<shape type=\"obj\"><string name=\"filename\" value=\"none.obj\"/></shape>", "none.obj"),
        ("<bsdf type=\"diffuse\" id=\"a\"/><bsdf type=\"diffuse\" id=\"a\"/>", "duplicate id \"a\""),
        (
            "<shape type=\"cube\"><transform name=\"to_world\"><scale x=\"0\"/></transform></shape>",
            "the transform is singular",
        ),
        ("<sensor type=\"perspective\"><float name=\"fov\" value=\"180\"/></sensor>", "the field of view is 180°"),
        (
            "<emitter type=\"point\"><rgb name=\"intensity\" value=\"1 -1 0\"/></emitter>",
            "\"intensity\": emission is below 0",
        ),
        (
            "<shape type=\"cube\"><transform name=\"to_world\"><rotate x=\"1\"/></transform></shape>",
            "<rotate> has no \"angle\"",
        ),
        (
            "<shape type=\"cube\"><transform name=\"to_world\"><scale w=\"1\"/></transform></shape>",
            "\"w\" of <scale>; expected value, x, y, z",
        ),
        (
            "<spectrum type=\"srgb\" id=\"s\"><ref name=\"color\" id=\"s\"/></spectrum>\
             <emitter type=\"constant\"><ref name=\"radiance\" id=\"s\"/></emitter>",
            "cannot have another wrapper",
        ),
    ] {
        let (place, output) = imported(body);
        output.refused(&["a.xml:2: ", phrase]);
        assert!(!place.path().join("made").exists(), "{phrase}: nothing is written");
    }
}

/// Emitters without a surface model reflect nothing; many blends of blends are read once each; a homogeneous volume is its value.
#[test]
fn lights_without_a_surface_are_black_and_blends_of_blends_are_quick() {
    let blend = |i: usize| {
        let below = if i == 0 { "w".to_owned() } else { format!("b{}", i - 1) };
        format!(
            "<bsdf type=\"blendbsdf\" id=\"b{i}\"><float name=\"weight\" value=\"0.5\"/><ref id=\"{below}\"/><ref id=\"{below}\"/></bsdf>\n"
        )
    };
    let blends: String = (0..40).map(blend).collect();
    let deep = format!("<bsdf type=\"diffuse\" id=\"w\"/>{blends}<shape type=\"disk\"><ref id=\"b39\"/></shape>");
    imported(&deep).1.refused(&["surfaces are nested more than"]);
    let (place, output) = imported(
        "<shape type=\"sphere\"><emitter type=\"area\"/></shape>\n<shape type=\"disk\"><emitter type=\"area\"/></shape>\n\
         <shape type=\"sphere\"><bsdf type=\"dielectric\"><string name=\"int_ior\" value=\"BK7\"/></bsdf></shape>\
         <shape type=\"sphere\"><bsdf type=\"null\"/>\
         <medium name=\"interior\" type=\"homogeneous\"><volume name=\"albedo\" type=\"constvolume\"><float name=\"value\" value=\"0.25\"/></volume>\
         <float name=\"sigma_t\" value=\"2\"/></medium></shape>\n",
    );
    output.ok();
    let scene = fs::read_to_string(place.path().join("made/scene.toml")).expect("a scene");
    assert_eq!(scene.matches("name = \"black\"").count(), 1, "{scene}");
    assert!(scene.contains("reflectance = 0\n") || scene.contains("reflectance = 0.0"), "{scene}");
    assert!(scene.contains("0.25"), "{scene}");
    etendue(["plan", &text(&place.path().join("made/job.toml"))]).ok();
}

/// As Mitsuba's own -D; a mesh is searched in the folders of `<path>` before the folder of the scene, as in Mitsuba 3.9.1.
#[test]
fn parameters_take_values_of_the_command_line_and_paths_lead_to_meshes() {
    let place = tempfile::tempdir().expect("a temporary folder");
    let (file, imported) = (place.path().join("a.xml"), text(&place.path().join("made")));
    fs::create_dir(place.path().join("store")).expect("made");
    let mesh = |size: f64| format!("v 0 0 0\nv {size} 0 0\nv 0 {size} 0\nf 1 2 3\n");
    fs::write(place.path().join("m.obj"), mesh(1.0)).expect("written");
    fs::write(place.path().join("store/m.obj"), mesh(9.0)).expect("written");
    let body = "<path value=\"store\"/><default name=\"r\" value=\"2\"/>\
        <shape type=\"sphere\"><float name=\"radius\" value=\"$r\"/></shape>\
        <shape type=\"obj\"><string name=\"filename\" value=\"m.obj\"/></shape>";
    fs::write(&file, format!("<scene version=\"3.0.0\">\n{body}</scene>")).expect("written");
    for (definitions, radius) in
        [(&[][..], "2"), (&["-Dr=5"][..], "5"), (&["-D", "r=7"], "7"), (&["--define", "r=3"], "3")]
    {
        etendue(["import", &text(&file), "-o", &imported, "--overwrite"].iter().chain(definitions)).ok();
        let scene = fs::read_to_string(place.path().join("made/scene.toml")).expect("a scene");
        assert!(scene.contains(&format!("radius_m = {radius}")), "{definitions:?}: {scene}");
        let mesh = read_mesh(&place.path().join("made/meshes/mesh.ply")).expect("a mesh");
        let size = mesh.positions.iter().flatten().fold(0.0_f32, |size, c| size.max(c.abs()));
        assert_eq!(size, 9.0, "a <path> goes before what lies beside the scene");
    }
    fs::remove_dir_all(&imported).expect("removed");
    let assert_refused = |file: &Path, definitions: &[&str], phrases: &[&str]| {
        etendue(["import", &text(file), "-o", &imported].iter().chain(definitions)).refused(phrases);
        assert!(!place.path().join("made").exists(), "{definitions:?}: nothing is written");
    };
    assert_refused(
        &file,
        &["-Dq=1"],
        &["a.xml: ", "\"q\", and \"$q\" does not occur in the scene: its parameters are $r"],
    );
    assert_refused(&file, &["-Dr=1", "-Dr=2"], &["a.xml: ", "two values"]);
    assert_refused(&file, &["-Dr=wide"], &["a.xml:2: ", "expected a number, found \"wide\""]);
    assert_refused(&file, &["-Dr"], &["NAME=VALUE"]);
    assert_refused(&root().join("scenes/import/box.pbrt"), &["-Dr=1"], &["box.pbrt: ", "only Mitsuba scenes"]);
}
