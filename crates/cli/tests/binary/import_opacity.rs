//! `alpha` of pbrt's shapes and masks of Mitsuba, numbers and images, pixel by pixel: against the fraction of transmitted light, and against opacity
//! in our format.

use crate::mitsuba::pixels;
use crate::support::{etendue, text};
use etendue_io::Provenance;
use etendue_io::exr::{ExrLayer, encode_layers};
use etendue_io::png::encode_grey8;
use std::fs;
use std::path::Path;

const WIDTH: usize = 24;
const HEIGHT: usize = 16;
/// Uniform light behind the card, cd/m².
const SKY: f64 = 100.0;

/// A black card, seen alone, between a camera and uniform light: z upwards, its image upright.
fn pbrt(alpha: &str, image: &str) -> String {
    format!(
        "LookAt 3 0 0  0 0 0  0 0 1\nCamera \"perspective\" \"float fov\" 30\n\
         Film \"rgb\" \"integer xresolution\" {WIDTH} \"integer yresolution\" {HEIGHT}\nWorldBegin\n\
         LightSource \"infinite\" \"rgb L\" [ 1 1 1 ] \"float scale\" {SKY}\n\
         Texture \"holes\" \"float\" \"imagemap\" \"string filename\" \"{image}\" \"string wrap\" \"clamp\"\n\
         Texture \"fewer\" \"float\" \"scale\" \"texture tex\" \"holes\" \"float scale\" 0.5\n\
         Material \"diffuse\" \"rgb reflectance\" [ 0 0 0 ]\n\
         Shape \"trianglemesh\" \"integer indices\" [ 0 1 2 0 2 3 ] {alpha}\n\
         \"point3 P\" [ 0 2 -2  0 -2 -2  0 -2 2  0 2 2 ] \"point2 uv\" [ 0 0  1 0  1 1  0 1 ]\n"
    )
}

/// The same in our format, whose y points the other way.
fn own_scene(opacity: &str) -> String {
    let pitch = 50_000.0 / HEIGHT as f64;
    // The shorter side covers 30°.
    let focal = 25.0 / 0.267_949_192_431_122_7;
    format!(
        "format = 1\n[scene]\nenvironment = {{ type = \"uniform\", luminance_cd_m2 = {SKY:.1}, illuminant = \"D65\" }}\n\
         [[scene.meshes]]\nname = \"card\"\nfile = \"card.obj\"\nup_axis = \"z\"\n\
         [[scene.textures]]\nname = \"holes\"\nfile = \"whole.exr\"\nencoding = \"data\"\nwrap = \"clamp\"\n\
         [[scene.materials]]\nname = \"black\"\ntype = \"diffuse\"\nreflectance = 0\nopacity = {opacity}\n\
         [[scene.objects]]\nname = \"card\"\nmesh = \"card\"\nmaterial = \"black\"\n\
         [[cameras]]\nname = \"camera\"\nposition_m = [3, 0, 0]\nlook_at_m = [0, 0, 0]\n\
         lens = {{ type = \"pinhole\", focal_length_mm = {focal:.9}, f_number = 8 }}\n\
         sensor = {{ width_px = {WIDTH}, height_px = {HEIGHT}, pixel_pitch_um = {pitch:.1} }}\n[output]\nradiance = true\n"
    )
}

/// Greys of the quarters of the image: top left, top right, bottom left, bottom right.
const GREYS: [u8; 4] = [255, 188, 0, 137];

/// Opacities of the quarters: greys of 8-bit images are sRGB in pbrt and Mitsuba (IEC 61966-2-1).
fn quarter_opacities() -> [f64; 4] {
    // ((188/255 + 0.055)/1.055)^2.4 and the same of 137.
    [1.0, 0.502_886, 0.0, 0.250_158]
}

fn files_in(folder: &Path) {
    let grey = |i: usize| GREYS[2 * usize::from(i / 16 >= 8) + usize::from(i % 16 >= 8)];
    let texels: Vec<u8> = (0..256).map(grey).collect();
    fs::write(folder.join("holes.png"), encode_grey8(16, 16, &texels).expect("a PNG")).expect("written");
    // The same as the opacity of a white image, and as the greys of a fully opaque one.
    let opacity = |i: usize| quarter_opacities()[2 * usize::from(i / 16 >= 8) + usize::from(i % 16 >= 8)] as f32;
    let (opacities, ones): (Vec<f32>, Vec<f32>) = ((0..256).map(opacity).collect(), vec![1.0; 256]);
    for (name, alpha, grey) in [("leaf.exr", &opacities, &ones), ("whole.exr", &ones, &opacities)] {
        let channels = [("A", alpha), ("B", grey), ("G", grey), ("R", grey)];
        let layers = channels.map(|(name, c)| (name.to_owned(), ExrLayer::Float(c)));
        let bytes = encode_layers(16, 16, &layers, &Provenance::default()).expect("an EXR");
        fs::write(folder.join(name), bytes).expect("written");
    }
    let card = "v 0 -2 -2\nv 0 2 -2\nv 0 2 2\nv 0 -2 2\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n";
    fs::write(folder.join("card.obj"), card).expect("written");
}

fn rendered(job: &Path, seed: &str) -> Vec<f64> {
    let out = job.with_file_name("out");
    etendue(["render", &text(job), "-o", &text(&out), "--overwrite", "--spp", "1024", "--seed", seed]).ok();
    let (width, pixels) = pixels(&out.join("camera/radiance.exr"));
    assert_eq!((width, pixels.len()), (WIDTH, WIDTH * HEIGHT));
    pixels.iter().map(|[r, g, b]| 0.2126 * r + 0.7152 * g + 0.0722 * b).collect()
}

/// Allowed standard errors for a pixel of 1 024 rays, each transmitted or not: of 768 tests together 1 in 1 000 fails.
const CRITICAL: f64 = 5.5;

#[track_caller]
fn assert_agrees(actual: &[f64], other: &[f64], opacity: impl Fn(usize, usize) -> Option<f64>, what: &str) {
    for (i, (actual, other)) in actual.iter().zip(other).enumerate() {
        // Between quarters texels are blended.
        let Some(opacity) = opacity(i % WIDTH, i / WIDTH) else { continue };
        let error = SKY * (opacity * (1.0 - opacity) / 1024.0).sqrt();
        // Noise of wavelengths is 0.3 % of the light.
        let (through, tolerance) = (SKY * (1.0 - opacity), 0.003 * SKY);
        assert!((actual - through).abs() <= CRITICAL * error + tolerance, "{what}, pixel {i}: {actual} for {through}");
        let apart = CRITICAL * error * std::f64::consts::SQRT_2 + tolerance;
        assert!((actual - other).abs() <= apart, "{what}, pixel {i}: {actual} beside {other} of our own opacity");
    }
}

/// Opacity of a pixel within a quarter, `scale` times that of the image: its middle is the card's.
fn quarter(scale: f64) -> impl Fn(usize, usize) -> Option<f64> {
    move |x: usize, y: usize| {
        let is_outside = |at: usize, middle: usize| at + 2 < middle || at > middle + 1;
        (is_outside(x, WIDTH / 2) && is_outside(y, HEIGHT / 2))
            .then(|| scale * quarter_opacities()[2 * usize::from(y >= HEIGHT / 2) + usize::from(x >= WIDTH / 2)])
    }
}

/// Results of a scene file, and of our own opacity.
fn results_of_both(file: &str, scene: &str, opacity: &str) -> [Vec<f64>; 2] {
    let place = tempfile::tempdir().expect("a temporary folder");
    files_in(place.path());
    fs::write(place.path().join(file), scene).expect("written");
    etendue(["import", &text(&place.path().join(file)), "-o", &text(&place.path().join("made"))]).ok();
    fs::write(place.path().join("own.toml"), own_scene(opacity)).expect("written");
    [("made/job.toml", "1"), ("own.toml", "2")].map(|(job, seed)| rendered(&place.path().join(job), seed))
}

const OWN_OPACITY: &str = "{ texture = \"holes\" }";

#[test]
fn alpha_of_pbrt_lets_through_what_our_own_opacity_does() {
    let holes = "\"texture alpha\" \"holes\"";
    let [theirs, ours] = results_of_both("a.pbrt", &pbrt("\"float alpha\" 0.3", "holes.png"), "0.3");
    assert_agrees(&theirs, &ours, |_, _| Some(0.3), "a number");
    for image in ["holes.png", "leaf.exr", "whole.exr"] {
        let [theirs, ours] = results_of_both("a.pbrt", &pbrt(holes, image), OWN_OPACITY);
        assert_agrees(&theirs, &ours, quarter(1.0), image);
    }
    let half = "{ texture = \"holes\", scale = 0.5 }";
    let [theirs, ours] = results_of_both("a.pbrt", &pbrt("\"texture alpha\" \"fewer\"", "holes.png"), half);
    assert_agrees(&theirs, &ours, quarter(0.5), "half a picture");
}

/// The same card for Mitsuba.
fn mitsuba(opacity: &str) -> String {
    format!(
        "<scene version=\"3.0.0\"><sensor type=\"perspective\" id=\"camera\"><float name=\"fov\" value=\"30\"/>\
         <string name=\"fov_axis\" value=\"smaller\"/>\
         <transform name=\"to_world\"><lookat origin=\"3, 0, 0\" target=\"0, 0, 0\" up=\"0, 0, 1\"/></transform>\
         <film type=\"hdrfilm\"><integer name=\"width\" value=\"{WIDTH}\"/><integer name=\"height\" value=\"{HEIGHT}\"/></film></sensor>\
         <emitter type=\"constant\"><rgb name=\"radiance\" value=\"{SKY}\"/></emitter>\
         <shape type=\"obj\"><string name=\"filename\" value=\"card.obj\"/><bsdf type=\"mask\">{opacity}\
         <bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"0\"/></bsdf></bsdf></shape></scene>"
    )
}

#[test]
fn masks_of_mitsuba_let_through_what_our_own_opacity_does() {
    let [theirs, ours] = results_of_both("a.xml", &mitsuba("<float name=\"opacity\" value=\"0.3\"/>"), "0.3");
    assert_agrees(&theirs, &ours, |_, _| Some(0.3), "a number");
    let image = "<texture name=\"opacity\" type=\"bitmap\"><string name=\"filename\" value=\"FILE\"/>\
                   <string name=\"wrap_mode\" value=\"clamp\"/></texture>";
    for file in ["holes.png", "whole.exr"] {
        let [theirs, ours] = results_of_both("a.xml", &mitsuba(&image.replace("FILE", file)), OWN_OPACITY);
        assert_agrees(&theirs, &ours, quarter(1.0), file);
    }
}
