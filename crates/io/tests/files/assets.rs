//! All assets of a description at once, and all their errors.

use std::fs;
use std::path::Path;

use etendue_io::picture::read_image;
use etendue_io::{load_assets, mesh};
use etendue_scene::asset::{AssetKind, AssetRequest, ImagePixels, ReplacedMaterials};
use etendue_scene::{Description, Overrides};

const JOB: &str = r#"format = 1
[scene]
[[scene.meshes]]
name = "m"
file = "m.obj"
up_axis = "z"
[[scene.textures]]
name = "t"
file = "t.png"
encoding = "srgb"
[[scene.materials]]
name = "a"
type = "diffuse"
reflectance = { texture = "t" }
[[scene.materials]]
name = "b"
type = "diffuse"
reflectance = { spectrum = "b.csv" }
[[scene.objects]]
name = "o"
mesh = "m"
material = "a"
class = "thing"
[scene.classes]
thing = 1
[[cameras]]
name = "c"
position_m = [0, 0, 1]
look_at_m = [1, 0, 1]
lens = { type = "pinhole", focal_length_mm = 4, f_number = 8 }
sensor = { width_px = 8, height_px = 8, pixel_pitch_um = 5 }
[[scene.objects]]
name = "painted"
shape = { type = "sphere", radius_m = 1 }
material = "b"
[[scene.objects]]
name = "as its file says"
mesh = "m"
"#;

const PLAIN_OBJ: &str = "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl x\nf 1 2 3\n";

fn description(folder: &Path) -> Description {
    let job = folder.join("job.toml");
    fs::write(&job, JOB).expect("write");
    let read = |path: &Path| fs::read_to_string(path).map_err(|e| e.to_string().into());
    Description::load(&job, &read, &Overrides::default()).unwrap_or_else(|e| panic!("{e}"))
}

fn write(folder: &Path, files: &[(&str, &[u8])]) {
    for (name, content) in files {
        fs::write(folder.join(name), content).expect("write");
    }
}

fn png(grey: u8) -> Vec<u8> {
    let mut bytes = std::io::Cursor::new(Vec::new());
    let picture = image::DynamicImage::ImageLuma8(image::ImageBuffer::from_pixel(2, 2, image::Luma([grey])));
    picture.write_to(&mut bytes, image::ImageFormat::Png).expect("encodable");
    bytes.into_inner()
}

#[test]
fn everything_named_is_read_and_what_it_names_in_turn() {
    let place = tempfile::tempdir().expect("temporary folder");
    let folder = place.path();
    let spectrum = b"wavelength_nm,value\n# measured\n400,0.5\n\n700, 0.25 # end\n";
    let library = b"newmtl x\nmap_Kd inner.png\n";
    write(folder, &[("m.obj", PLAIN_OBJ.as_bytes()), ("m.mtl", library), ("b.csv", spectrum)]);
    write(folder, &[("t.png", &png(10)), ("inner.png", &png(20))]);
    let assets = load_assets(&description(folder).assets()).unwrap_or_else(|e| panic!("{e:?}"));
    assert_eq!(assets.meshes.len(), 1);
    assert_eq!(assets.meshes[&folder.join("m.obj")], mesh::read_mesh(&folder.join("m.obj")).expect("mesh"));
    assert_eq!(assets.spectra[&folder.join("b.csv")].points, [(400.0, 0.5), (700.0, 0.25)]);
    assert_eq!(assets.images[&folder.join("t.png")].pixels, ImagePixels::Gray8(vec![10; 4]));
    assert_eq!(assets.images[&folder.join("inner.png")].pixels, ImagePixels::Gray8(vec![20; 4]));
}

#[test]
fn lamps_and_tables_are_read_by_their_kind() {
    let place = tempfile::tempdir().expect("temporary folder");
    let folder = place.path();
    let lamp = b"IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 2 1 1 2 0 0 0 1 1 5\n0 90\n0\n9 8\n";
    write(folder, &[("l.ies", lamp), ("nk.csv", b"400,1,2\n500,1,3\n"), ("ra.csv", b"a,5,30\n0.2,70,30\n")]);
    let kinds =
        [("l.ies", AssetKind::Photometry), ("nk.csv", AssetKind::ComplexIndex), ("ra.csv", AssetKind::RetroTable)];
    let requests = kinds.map(|(name, kind)| AssetRequest {
        path: folder.join(name),
        kind,
        place: description(folder).assets()[0].place.clone(),
        covered: ReplacedMaterials::All,
    });
    let assets = load_assets(&requests).unwrap_or_else(|e| panic!("{e:?}"));
    assert_eq!(assets.photometry[&folder.join("l.ies")].candela, [9.0, 8.0, 9.0, 8.0]);
    assert_eq!(assets.indices[&folder.join("nk.csv")].points[1], (500.0, 1.0, 3.0));
    assert_eq!(assets.retro_tables[&folder.join("ra.csv")].row(0), [70.0, 30.0]);
    write(folder, &[("l.ies", &lamp[..lamp.len() - 3])]);
    let message = load_assets(&requests).expect_err("a truncated lamp")[0].to_string();
    assert!(
        message.contains("l.ies:6: the file ends here; expected intensity 2 of 2")
            && message.contains("(referenced at "),
        "{message}"
    );
}

#[test]
fn all_errors_come_at_once_with_the_place_that_names_the_file() {
    let place = tempfile::tempdir().expect("temporary folder");
    let folder = place.path();
    write(folder, &[("m.obj", b"v 0 0 0\nf 1 2 3\n"), ("t.png", &png(10)[..40]), ("b.csv", b"400,0.5\n390,0.5\n")]);
    let errors = load_assets(&description(folder).assets()).expect_err("three faults");
    let messages: Vec<String> =
        errors.iter().map(|e| e.to_string().replace(&format!("{}/", folder.display()), "")).collect();
    assert_eq!(messages.len(), 3, "{messages:#?}");
    assert_eq!(
        messages[0],
        "b.csv:2: wavelength 390 nm follows 400 nm: sort the table by increasing wavelength, each once (referenced at job.toml:18:28: scene.materials.b.reflectance.spectrum)"
    );
    assert_eq!(
        messages[1],
        "m.obj:2: vertex index 2 of the face is out of range (number of vertices: 1, counted from 1); the file is damaged or truncated (referenced at job.toml:5:8: scene.meshes.m.file)"
    );
    assert!(
        messages[2].starts_with("t.png: not a readable image (") && messages[2].contains("truncated"),
        "{}",
        messages[2]
    );
    assert!(messages[2].ends_with("(referenced at job.toml:9:8: scene.textures.t.file)"), "{}", messages[2]);
}

#[test]
fn a_value_that_its_use_forbids_is_reported_with_its_line() {
    let place = tempfile::tempdir().expect("temporary folder");
    let folder = place.path();
    write(folder, &[("m.obj", PLAIN_OBJ.as_bytes()), ("m.mtl", b"newmtl x\n"), ("t.png", &png(10))]);
    let messages = |table: &[u8]| {
        write(folder, &[("b.csv", table)]);
        let errors = load_assets(&description(folder).assets()).err().unwrap_or_default();
        errors.iter().map(|e| e.to_string().replace(&format!("{}/", folder.display()), "")).collect::<Vec<_>>()
    };
    assert_eq!(
        messages(b"# paint\nwavelength_nm,value\n400,0.5\n500,1.5\n"),
        ["b.csv:4: found 1.5 at 500 nm; expected a fraction from 0 to 1 \
          (referenced at job.toml:18:28: scene.materials.b.reflectance.spectrum)"]
    );
    assert_eq!(messages(b"400,-0.5\n500,0.5\n")[0].split(';').next(), Some("b.csv:1: found -0.5 at 400 nm"));
    assert_eq!(messages(b"400,0\n500,1\n"), [""; 0]);
}

#[test]
fn a_missing_texture_of_a_mesh_is_reported_with_the_mesh() {
    let place = tempfile::tempdir().expect("temporary folder");
    let folder = place.path();
    write(folder, &[("m.obj", PLAIN_OBJ.as_bytes()), ("m.mtl", b"newmtl x\nmap_Kd lost.png\n")]);
    write(folder, &[("t.png", &png(10)), ("b.csv", b"400,0.5\n700,0.5\n")]);
    let errors = load_assets(&description(folder).assets()).expect_err("a lost texture");
    let message = errors[0].to_string().replace(&format!("{}/", folder.display()), "");
    assert!(errors.len() == 1 && message.starts_with("lost.png: no such image file; check the path"), "{message}");
    assert!(message.contains("referenced at m.obj"), "{message}");
    assert!(message.ends_with("; a path is relative to the file that names it)"), "{message}");
    let message = read_image(&folder.join("lost.png")).expect_err("nobody names it").to_string();
    assert!(message.ends_with("lost.png: no such image file; check the path"), "{message}");
    let message = read_image(folder).expect_err("a folder").to_string();
    assert!(message.ends_with(": this is a folder; give a file in it"), "{message}");
}
