//! Meshes and material libraries as other programs write them, with statements, names and paths that the formats' descriptions lack.

use std::fs;
use std::path::{Path, PathBuf};

use etendue_io::assets::load_assets;
use etendue_io::mesh::read_mesh;
use etendue_scene::Place;
use etendue_scene::asset::{
    AssetKind, AssetRequest, Assets, ImagePixels, MeshAsset, ReplacedMaterials, SlotColour, SlotLayers, SlotNumber,
    SlotReflectance, SlotSurface,
};
use etendue_testkit::skip::all_here;

const SQUARE: &str =
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nusemtl a\nf 1/1 2/2 3/3 4/4\n";

/// Folder with files.
fn folder(files: &[(&str, &[u8])]) -> tempfile::TempDir {
    let place = tempfile::tempdir().expect("temporary folder");
    for (name, bytes) in files {
        let path = place.path().join(name);
        fs::create_dir_all(path.parent().expect("a parent")).expect("created");
        fs::write(path, bytes).expect("written");
    }
    place
}

/// Assets of the mesh `a.obj` of a folder, and of the images that it names.
fn assets(place: &Path) -> Result<Assets, String> {
    let path = place.join("a.obj");
    let covered = ReplacedMaterials::Slots([].into());
    let request =
        AssetRequest { path: path.clone(), kind: AssetKind::Mesh, place: Place::file_head(path.as_path()), covered };
    load_assets(&[request]).map_err(|errors| errors.iter().map(ToString::to_string).collect())
}

/// The square with a library, and images of one texel each.
fn square(library: &str, images: &[&str]) -> (MeshAsset, Assets) {
    let png = png([200, 100, 50, 255]);
    let text = format!("mtllib a.mtl\n{SQUARE}");
    let mut files: Vec<(&str, &[u8])> = vec![("a.obj", text.as_bytes()), ("a.mtl", library.as_bytes())];
    files.extend(images.iter().map(|image| (*image, &png[..])));
    let place = folder(&files);
    let mesh = read_mesh(&place.path().join("a.obj")).expect("readable");
    (mesh, assets(place.path()).expect("all images"))
}

/// A PNG of one texel.
fn png(rgba: [u8; 4]) -> Vec<u8> {
    png_of(1, 1, &rgba)
}

fn png_of(width: u32, height: u32, rgba: &[u8]) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(png::ColorType::Rgba);
    encoder.write_header().and_then(|mut writer| writer.write_image_data(rgba)).expect("encoded");
    bytes
}

fn layers(mesh: &MeshAsset) -> SlotLayers {
    match &mesh.slot_materials[0].surface {
        Some(SlotSurface::Layers(layers)) => (**layers).clone(),
        other => panic!("{other:?}"),
    }
}

fn notes(mesh: &MeshAsset) -> String {
    mesh.report.join("\n")
}

#[test]
fn names_of_any_encoding_match_byte_by_byte() {
    for name in [&b"Geh\xe4use"[..], b"\xb2\xe2\xca\xd4", b"\x95\x5c", "Gehäuse".as_bytes()] {
        let obj = [b"# Ma\xdfe\nmtllib a.mtl\n", SQUARE.replace("usemtl a\n", "usemtl ").as_bytes()].concat();
        let at = obj.windows(7).position(|word| word == b"usemtl ").expect("usemtl") + 7;
        let obj = [&obj[..at], name, b"\n", &obj[at..]].concat();
        let library = [b"# \xb2\xe2\nnewmtl ", name, b"\nKd 0.5 0.4 0.3\nnewmtl other\nKd 1 1 1\n"].concat();
        let place = folder(&[("a.obj", &obj), ("a.mtl", &library)]);
        let mesh = read_mesh(&place.path().join("a.obj")).expect("readable");
        let reflectance = SlotReflectance::LinearSrgb([0.5, 0.4, 0.3]);
        assert_eq!(mesh.slot_materials[0].surface, Some(SlotSurface::Diffuse { reflectance }), "{name:?}");
    }
}

#[test]
fn textures_of_other_machines_are_those_beside_the_library() {
    for (statement, file) in [
        ("C:\\Users\\someone\\Desktop\\maps\\wall.png", "maps/wall.png"),
        ("C:\\Users\\someone\\Desktop\\maps\\wall.png", "wall.png"),
        ("Tex\\wall.png", "tex/Wall.PNG"),
        ("\"D:/my files/wall.png\"", "wall.png"),
        ("-s 2 2 1 -bm 0.5 /data/someone/WALL.png", "wall.png"),
    ] {
        let (mesh, assets) = square(&format!("newmtl a\nmap_Kd {statement}\n"), &[file]);
        let (image, _) = assets.images.first_key_value().expect("an image");
        assert!(image.ends_with(file), "{statement}: {image:?}");
        assert!(notes(&mesh).contains(&format!("is read from `{file}`")), "{mesh:?}");
    }
}

/// A mesh in one folder, its library in another: textures lie beside either.
#[test]
fn libraries_of_other_machines_are_found_too() {
    let text = format!("mtllib C:\\project\\Lib\\A.MTL\n{SQUARE}");
    let png = png([1, 2, 3, 255]);
    let library = b"newmtl a\nmap_Kd \\\\server\\x\\wall.png\n";
    let place = folder(&[("a.obj", text.as_bytes()), ("lib/a.mtl", library), ("wall.png", &png)]);
    let assets = assets(place.path()).expect("readable");
    assert_eq!(assets.images.len(), 1);
    assert!(assets.images.contains_key(&place.path().join("wall.png")));
}

#[test]
fn a_texture_that_is_nowhere_is_named_as_stated() {
    let text = format!("mtllib a.mtl\n{SQUARE}");
    for statement in ["map_Kd lost.png", "map_Kd a.png\nmap_d lost.png", "map_Kd a.png\nnorm lost.png"] {
        let (library, png) = (format!("newmtl a\n{statement}\n"), png([1, 2, 3, 4]));
        let place = folder(&[("a.obj", text.as_bytes()), ("a.mtl", library.as_bytes()), ("a.png", &png)]);
        let message = assets(place.path()).expect_err("a missing image");
        assert!(message.contains("lost.png: no such image file"), "{message}");
    }
}

#[test]
fn pointers_of_git_lfs_are_named() {
    const POINTER: &[u8] = b"version https://git-lfs.github.com/spec/v1\noid sha256:4d7a\nsize 12345\n";
    for name in ["a.obj", "a.ply", "a.stl", "a.glb"] {
        let place = folder(&[(name, POINTER)]);
        let message = read_mesh(&place.path().join(name)).expect_err("a pointer").to_string();
        assert!(message.contains("a pointer of Git LFS") && message.contains("`git lfs pull`"), "{message}");
    }
    for name in ["a.png", "a.exr", "a.hdr"] {
        let place = folder(&[(name, POINTER)]);
        let message = etendue_io::picture::read_image(&place.path().join(name)).expect_err("a pointer").to_string();
        assert!(message.contains("a pointer of Git LFS"), "{message}");
    }
}

#[test]
fn odd_statements_do_not_refuse_a_mesh() {
    let odd = "v 9 9 nan\nv 9 9 9 0.5 0.5 0.5 1\nvt nan nan\nusemtl\nf 1 2\nl 1 2\np 1\n";
    let text = format!("mtllib a.mtl\n{odd}{}", SQUARE.replace("f 1/1 2/2 3/3 4/4", "f 3/1 4/2 5/3 6/4"));
    let library = b"Kd 1 1 1\nnewmtl a\nKd 0.5\nnewmtl\nKd 0.1\nnewmtl a\nKd 0.9\n";
    let place = folder(&[("a.obj", text.as_bytes()), ("a.mtl", library)]);
    let mesh = read_mesh(&place.path().join("a.obj")).expect("readable");
    assert_eq!((mesh.triangles.len(), mesh.positions.len(), mesh.uvs[0]), (2, 4, [0.0; 2]));
    let reflectance = SlotReflectance::LinearSrgb([0.5; 3]);
    assert_eq!(mesh.slot_materials[0].surface, Some(SlotSurface::Diffuse { reflectance }), "the first");
    let notes = notes(&mesh);
    for note in
        ["usemtl without a name", "f with fewer than 3 corners", "`l`", "`p`", "v that is not finite", "defined twice"]
    {
        assert!(notes.contains(note), "{note}: {notes}");
    }
}

#[test]
fn odd_content_does_not_refuse_a_ply() {
    let text = "ply\nformat ascii 1.0\ncomment Ma\u{df}e\nCreated by x\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\n\
        element face 2\nproperty list uchar int vertex_indices\nend_header\nnan nan nan\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 1 2 3 4\n2 1 2\nextra\n";
    let bytes: Vec<u8> = text.chars().map(|c| u32::from(c) as u8).collect();
    let place = folder(&[("a.ply", &bytes)]);
    let mesh = read_mesh(&place.path().join("a.ply")).expect("readable");
    assert_eq!(mesh.triangles.len(), 2);
    assert!(mesh.positions.iter().flatten().all(|v| (0.0..=1.0).contains(v)), "{:?}", mesh.positions);
    let notes = notes(&mesh);
    for note in [
        "1 vertices that are not finite belong to no face",
        "1 faces with fewer than 3 corners",
        "bytes follow",
        "begins with `Created`",
    ] {
        assert!(notes.contains(note), "{note}: {notes}");
    }
    let used = text.replace("4 1 2 3 4", "4 1 2 3 0").replace('\u{df}', "ss");
    let place = folder(&[("a.ply", used.as_bytes())]);
    let message = read_mesh(&place.path().join("a.ply")).expect_err("NaN of a face").to_string();
    assert!(message.contains("a.ply:12: vertex 0: a number is not finite"), "{message}");
}

#[test]
fn opacity_roughness_metal_and_normals_are_used() {
    let png = |rgba: &[u8]| png_of(2, 1, rgba);
    let (grey, cut) = (png(&[255, 255, 255, 255, 51, 51, 51, 255]), png(&[9, 9, 9, 255, 9, 9, 9, 0]));
    let bump = png(&[128, 128, 255, 255, 130, 126, 250, 255]);
    let library = "newmtl a\nKd 0.5 0.4 0.3\nmap_d cut.png\nmap_Pr grey.png\nmap_Pm -imfchan r grey.png\nmap_Bump bump.png -bm 2\nmap_Ks grey.png\nKe 1 1 1\n";
    let text = format!("mtllib a.mtl\n{SQUARE}");
    let files: [(&str, &[u8]); 5] = [
        ("a.obj", text.as_bytes()),
        ("a.mtl", library.as_bytes()),
        ("grey.png", &grey),
        ("cut.png", &cut),
        ("bump.png", &bump),
    ];
    let place = folder(&files);
    let mesh = read_mesh(&place.path().join("a.obj")).expect("readable");
    let layers = layers(&mesh);
    let numbers = |number: &SlotNumber| -> Vec<u16> {
        let SlotNumber::Picture(picture) = number else { panic!("{number:?}") };
        let (_, image) = mesh.embedded_images.iter().find(|(name, _)| *name == picture.file).expect("an image");
        let ImagePixels::Gray16(pixels) = &image.pixels else { panic!("16 bits") };
        pixels.clone()
    };
    // Of 65 535: opacity 1 and 0; roughness 1 and 0.2, squared; metal 1 and 0.2.
    assert_eq!(numbers(layers.opacity.as_ref().expect("opacity")), [65_535, 0]);
    assert_eq!(numbers(&layers.alpha), [65_535, 2621]);
    assert_eq!(numbers(&layers.metal), [65_535, 13_107]);
    assert_eq!(layers.base, SlotColour::LinearSrgb([0.5, 0.4, 0.3]));
    let (normals, strength) = layers.normals.expect("a normal map");
    assert_eq!((normals.file, strength), (place.path().join("bump.png"), 2.0));
    let notes = notes(&mesh);
    for note in ["`map_Ks` is not used", "Ke has no unit", "used as a normal map"] {
        assert!(notes.contains(note), "{note}: {notes}");
    }
    let before = mesh.hash;
    fs::write(place.path().join("cut.png"), &grey).expect("written");
    assert_ne!(read_mesh(&place.path().join("a.obj")).expect("readable").hash, before, "images count");
}

#[test]
fn heights_are_noted_and_opacity_alone_is_used() {
    let (mesh, _) = square("newmtl a\nKd 0.5\nbump h.png\nd 0.25\n", &["h.png"]);
    assert_eq!(layers(&mesh).opacity, Some(SlotNumber::Number(0.25)));
    assert!(notes(&mesh).contains("the unit of its heights is unknown"), "{}", notes(&mesh));
    let (mesh, _) = square("newmtl a\nmap_Kd w.png\nmap_d w.png\n", &["w.png"]);
    // An image without opacity: the mean of 200, 100 and 50 of 255, in 16 bits.
    let SlotNumber::Number(opacity) = layers(&mesh).opacity.expect("opacity") else { panic!("constant") };
    assert!((opacity - 350.0 / 3.0 / 255.0).abs() < 1.0 / 65_535.0, "{opacity}");
}

#[test]
fn glass_of_an_illumination_model_is_glass() {
    let (mesh, _) = square("newmtl a\nKd 0.1\nNs 1000\nKs 1 1 1\nNi 1.33\nillum 7\n", &[]);
    let transmission = layers(&mesh).transmission.expect("glass");
    assert_eq!((transmission.index, transmission.fraction), (1.33, SlotNumber::Number(1.0)));
    assert!(transmission.solid.is_some() && notes(&mesh).contains("illum is glass"), "{}", notes(&mesh));
    let (mesh, _) = square("newmtl a\nKd 0.1\nNi 1.5\nd 0.2\nTf 0.9 1 0.9\nillum 4\n", &[]);
    let transmission = layers(&mesh).transmission.expect("glass");
    assert_eq!((transmission.solid, transmission.tint), (None, Some([0.9, 1.0, 0.9])));
    assert_eq!(layers(&mesh).opacity, None);
}

/// Files of the case table (`../shared/cases`), each of which was refused.
#[test]
fn cases_from_the_field_are_read() {
    let cases = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/cases/scenes-and-lenses");
    if !all_here("cases_from_the_field_are_read", &[&cases]) {
        return;
    }
    let files = fs::read_dir(&cases).expect("a folder").map(|entry| entry.expect("an entry").path());
    let is_case = |path: &PathBuf| {
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        (name.starts_with('o') && name.ends_with(".obj")) || name.ends_with(".ply")
    };
    let mut meshes: Vec<PathBuf> = files.filter(is_case).collect();
    meshes.sort();
    assert!(meshes.len() >= 15, "{meshes:?}");
    for path in meshes {
        let mesh = read_mesh(&path).unwrap_or_else(|error| panic!("{error}"));
        let triangles = if path.extension().is_some_and(|extension| extension == "ply") { 2 } else { 12 };
        assert_eq!(mesh.triangles.len(), triangles, "{}", path.display());
        let covered = ReplacedMaterials::Slots([].into());
        let request = AssetRequest {
            path: path.clone(),
            kind: AssetKind::Mesh,
            place: Place::file_head(path.as_path()),
            covered,
        };
        let assets = load_assets(&[request]).unwrap_or_else(|errors| panic!("{errors:?}"));
        for (name, image) in assets.images.iter().filter(|(name, _)| !name.to_string_lossy().contains('#')) {
            let ImagePixels::Rgb8(pixels) = &image.pixels else { panic!("{}", name.display()) };
            assert!(pixels.len() == 16 && pixels[1] == [200, 100, 50], "{}: {pixels:?}", name.display());
        }
    }
}
