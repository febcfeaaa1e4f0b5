//! Scenes of Universal Scene Description: the converted scene, against values computed by usd-core.
//!
//! tests/oracles/usd_scenes.py wrote kinds.usdc and kinds.usdz of scenes/import/kinds.usda, and stores in figures/usd_scenes.json the values of
//! usd-core for all three. Lengths there are metres, axes the stage's: its z is our x, its x our y, its y our z.

use crate::support::{CommandOutput, etendue, root, text};
use etendue_core::maths::f64 as maths;
use etendue_io::mesh::read_mesh;
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};

/// Positions are written in 32 bits, values with seven digits.
const NEAR_M: f64 = 2e-6;

fn figures() -> Value {
    serde_json::from_str(include_str!("../../../../tests/oracles/figures/usd_scenes.json")).expect("JSON")
}

/// An imported scene.
struct ImportedScene {
    _place: tempfile::TempDir,
    folder: PathBuf,
    scene: toml::Table,
    job: toml::Table,
    messages: String,
}

impl ImportedScene {
    fn from_file(file: &Path) -> Self {
        let place = tempfile::tempdir().expect("a temporary folder");
        let folder = place.path().join("made");
        let messages = etendue(["import", &text(file), "-o", &text(&folder)]).ok().err;
        let read = |name: &str| fs::read_to_string(folder.join(name)).expect("written").parse().expect("TOML");
        let (scene, job) = (read("scene.toml"), read("job.toml"));
        Self { _place: place, folder, scene, job, messages }
    }

    /// An entry of a list, by its name.
    fn entry(&self, list: &str, name: &str) -> &toml::Value {
        let of = if list == "cameras" { &self.job } else { &self.scene };
        let all = of[list].as_array().expect("a list");
        all.iter().find(|entry| entry["name"].as_str() == Some(name)).unwrap_or_else(|| panic!("{list}: no {name}"))
    }

    /// Material of an object.
    fn material(&self, object: &str) -> &toml::Value {
        self.entry("materials", self.entry("objects", object)["material"].as_str().expect("a name"))
    }

    /// Corners of the triangles of all meshes with this name, or this name with a number: positions in the stage's axes, and texture coordinates.
    fn triangles(&self, name: &str) -> Vec<[MeshCorner; 3]> {
        let is_own = |own: &str| own.strip_prefix(name).is_some_and(|rest| rest.is_empty() || rest.starts_with('-'));
        let mut triangles = Vec::new();
        for mesh in self.scene["meshes"].as_array().expect("meshes") {
            if !is_own(mesh["name"].as_str().expect("a name")) {
                continue;
            }
            let asset = read_mesh(&self.folder.join(mesh["file"].as_str().expect("a file"))).expect("a mesh");
            let corner = |i: u32| {
                let p = asset.positions[i as usize];
                let [x, y, z] = std::array::from_fn(|k| asset.origin[k] + f64::from(p[k]));
                MeshCorner { place: [y, z, x], uv: asset.uvs.get(i as usize).map(|uv| uv.map(f64::from)) }
            };
            triangles.extend(asset.triangles.iter().map(|triangle| triangle.map(corner)));
        }
        assert!(!triangles.is_empty(), "{name}: no mesh");
        triangles
    }
}

#[derive(Clone, Copy)]
struct MeshCorner {
    place: [f64; 3],
    uv: Option<[f64; 2]>,
}

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().expect("a list").iter().map(|v| v.as_f64().expect("a number")).collect()
}

fn number(value: &toml::Value) -> f64 {
    value.as_float().or_else(|| value.as_integer().map(|v| v as f64)).expect("a number")
}

fn list(value: &toml::Value) -> Vec<f64> {
    value.as_array().expect("a list").iter().map(number).collect()
}

fn are_near(actual: &[f64], expected: &[f64], by: f64) -> bool {
    actual.len() == expected.len() && actual.iter().zip(expected).all(|(a, b)| (a - b).abs() <= by)
}

fn assert_same(actual: f64, expected: f64, what: &str) {
    assert!((actual - expected).abs() <= 1e-5 * expected.abs().max(1e-3), "{what}: {actual}, expected {expected}");
}

/// Asserts that every element of each list has an equal one in the other.
fn assert_same_elements(actual: &[Vec<f64>], expected: &[Vec<f64>], what: &str) {
    let has = |all: &[Vec<f64>], one: &Vec<f64>| all.iter().any(|other| are_near(other, one, NEAR_M));
    actual.iter().for_each(|one| assert!(has(expected, one), "{what}: {one:?} is not usd-core's"));
    expected.iter().for_each(|one| assert!(has(actual, one), "{what}: {one:?} is missing"));
}

fn cross([a, b, c]: [[f64; 3]; 3]) -> [f64; 3] {
    let [u, v]: [[f64; 3]; 2] = [b, c].map(|p| std::array::from_fn(|i| p[i] - a[i]));
    [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
}

fn check_meshes(scene: &ImportedScene, figures: &Value) {
    for (name, expected) in figures["meshes"].as_object().expect("meshes") {
        let triangles = scene.triangles(name);
        let corners = || triangles.iter().flatten();
        let places: Vec<Vec<f64>> = corners().map(|corner| corner.place.to_vec()).collect();
        let rows =
            |key: &str| -> Vec<Vec<f64>> { expected[key].as_array().expect("rows").iter().map(numbers).collect() };
        assert_same_elements(&places, &rows("points"), name);
        let areas: Vec<[f64; 3]> = triangles.iter().map(|t| cross(t.map(|c| c.place)).map(|v| 0.5 * v)).collect();
        let area: f64 = areas.iter().map(|a| a.iter().map(|v| v * v).sum::<f64>().sqrt()).sum();
        let area_vector: Vec<f64> = (0..3).map(|i| areas.iter().map(|a| a[i]).sum()).collect();
        assert!((area - expected["area"].as_f64().expect("an area")).abs() < 1e-6, "{name}: {area} m²");
        assert!(
            are_near(&area_vector, &numbers(&expected["along"]), 1e-6),
            "{name}: {area_vector:?} is the other side"
        );
        if expected.get("uvs").is_some() {
            let lying: Vec<Vec<f64>> =
                corners().map(|c| [&c.place[..], &c.uv.expect("texture coordinates")[..]].concat()).collect();
            assert_same_elements(&lying, &rows("uvs"), name);
        }
        if let Some(bound) = figures["bound"].get(name) {
            assert_eq!(scene.entry("objects", name)["material"].as_str(), bound.as_str(), "{name}");
        }
    }
    assert!(!scene.folder.join("meshes/Hidden.ply").exists() && !scene.folder.join("meshes/Helper.ply").exists());
    let expected: Vec<Vec<f64>> = figures["instances"].as_array().expect("places").iter().map(numbers).collect();
    let vertices = ["Post", "Post-2"].map(|name| {
        let only = scene.folder.join("meshes").join(format!("{name}.ply"));
        let asset = read_mesh(&only).expect("a mesh");
        let mean = |k: usize| {
            let sum: f64 = asset.positions.iter().map(|p| f64::from(p[k])).sum();
            asset.origin[k] + sum / asset.positions.len() as f64
        };
        vec![mean(1), mean(2), mean(0)]
    });
    assert_same_elements(&vertices, &expected, "instances");
}

/// Forward and up directions of a camera rotated about z, y and x, in the stage's axes.
fn axes(rotation_deg: &[f64]) -> [Vec<f64>; 2] {
    let [(sa, ca), (sb, cb), (sc, cc)] = [0, 1, 2].map(|i| maths::sin_cos(rotation_deg[i].to_radians()));
    let ahead = [ca * cb, sa * cb, -sb];
    let up = [ca * sb * cc + sa * sc, sa * sb * cc - ca * sc, cb * cc];
    [ahead, up].map(|[x, y, z]| vec![y, z, x])
}

fn check_cameras(scene: &ImportedScene, figures: &Value) {
    for (name, expected) in figures["cameras"].as_object().expect("cameras") {
        let camera = scene.entry("cameras", name);
        let (place, lens) = (list(&camera["position_m"]), &camera["lens"]);
        assert!(are_near(&[place[1], place[2], place[0]], &numbers(&expected["place"]), NEAR_M), "{name}: {place:?}");
        let [ahead, up] = axes(&list(&camera["rotation_deg"]));
        assert!(are_near(&ahead, &numbers(&expected["ahead"]), 1e-6), "{name}: {ahead:?}");
        assert!(are_near(&up, &numbers(&expected["up"]), 1e-6), "{name}: {up:?}");
        let stated = |key: &str| expected[key].as_f64().expect("a number");
        if lens["type"].as_str() == Some("telecentric") {
            assert_same(number(&lens["field_width_m"]), stated("width_m"), name);
            continue;
        }
        let [focal_m, stop, focus_m] =
            [1e-3 * number(&lens["focal_length_mm"]), number(&lens["f_number"]), number(&lens["focus_distance_m"])];
        let sensor = &camera["sensor"];
        let height_m = 1e-6 * number(&sensor["pixel_pitch_um"]) * number(&sensor["height_px"]);
        let image_m = 1.0 / (1.0 / focal_m - 1.0 / focus_m);
        assert_same(2.0 * maths::atan2(0.5 * height_m, image_m).to_degrees(), stated("yfov_deg"), name);
        assert_same(focal_m / stop, stated("focal_m") / stated("f_number"), name);
        assert_same(focus_m, stated("focus_m"), name);
    }
}

/// True if two colours are equal except for their strength.
fn same_hue(actual: &[f64], expected: &[f64], by: f64) -> bool {
    let [a, b] = [actual, expected].map(|rgb| rgb.iter().map(|v| v / rgb.iter().sum::<f64>()).collect::<Vec<f64>>());
    are_near(&a, &b, by)
}

fn check_lights(scene: &ImportedScene, figures: &Value) {
    let expected = |name: &str, key: &str| figures["lights"][name][key].as_f64().expect("a number");
    for name in ["Window", "Shared", "Bulb", "Tube"] {
        assert_same(number(&scene.material(name)["emission"]["luminance_cd_m2"]), expected(name, "luminance"), name);
    }
    assert!(same_hue(
        &list(&scene.material("Shared")["emission"]["rgb"]),
        &numbers(&figures["lights"]["Shared"]["color"]),
        1e-6
    ));
    assert_eq!(number(&scene.material("Bulb")["emission"]["temperature_k"]), 3000.0);
    // usd-core has black-body colours from a curve through a table.
    let moon = &scene.material("Moon")["emission"];
    let relative = number(&moon["luminance_cd_m2"]) / expected("Moon", "luminance");
    assert!((relative - 1.0).abs() < 0.02, "{relative}");
    assert!(same_hue(&list(&moon["rgb"]), &numbers(&figures["lights"]["Moon"]["color"]), 0.02), "{moon}");
    assert_same(number(&scene.entry("lights", "Sun")["illuminance_lx"]), expected("Sun", "lux"), "Sun");
    assert_same(number(&scene.entry("lights", "Sun")["elevation_deg"]), 40.0, "Sun");
    // From a distance a sphere of radius r gives L · π r².
    let beam = scene.entry("lights", "Beam");
    assert_same(number(&beam["intensity_cd"]), expected("Beam", "luminance") * std::f64::consts::PI * 9e-4, "Beam");
    assert_eq!([number(&beam["field_angle_deg"]), number(&beam["inner_angle_deg"])], [80.0, 60.0]);
    let spark = expected("Spark", "luminance") * std::f64::consts::PI * 25e-6;
    assert_same(number(&scene.entry("lights", "Spark")["intensity_cd"]), spark, "Spark");
    assert_same(number(&scene.scene["environment"]["luminance_cd_m2"]), expected("Sky", "luminance"), "Sky");
}

fn check_materials(scene: &ImportedScene, figures: &Value) {
    let figures = &figures["materials"];
    let stated = |name: &str, key: &str| figures[name][key].as_f64().expect("a number");
    let squared = |name: &str| stated(name, "roughness") * stated(name, "roughness");
    let plain = scene.entry("materials", "Plain");
    assert!(are_near(&list(&plain["reflectance"]), &numbers(&figures["Plain"]["diffuseColor"]), 1e-6));
    assert_same(number(&plain["index"]), stated("Plain", "ior"), "Plain");
    assert_same(number(&plain["alpha"]), squared("Plain"), "Plain");
    let tin = scene.entry("materials", "Tin");
    assert_eq!(tin["type"].as_str(), Some("conductor"));
    assert_same(number(&tin["alpha"]), squared("Tin"), "Tin");
    let light: f64 =
        numbers(&figures["Tin"]["emissiveColor"]).iter().zip([0.2126, 0.7152, 0.0722]).map(|(v, w)| v * w).sum();
    assert_same(number(&tin["emission"]["luminance_cd_m2"]), light, "Tin");
    let paper = scene.entry("materials", "Paper");
    let texture = scene.entry("textures", paper["reflectance"]["texture"].as_str().expect("a texture"));
    let file = texture["file"].as_str().expect("a file");
    assert!(file.ends_with(figures["Paper"]["diffuseColor"]["file"].as_str().expect("a name")), "{file}");
    assert!(scene.folder.join(file).exists(), "{file}");
    assert_eq!(number(&paper["reflectance"]["scale"]), 0.5);
    assert_eq!(list(&texture["uv_scale"]), [2.0, 3.0]);
    assert_eq!(list(&texture["uv_offset"]), [0.25, 0.5]);
    assert_eq!(texture["wrap"].as_str(), Some("mirror"));
    // Values of an image are rewritten.
    let opacity = scene.entry("textures", paper["opacity"]["texture"].as_str().expect("a texture"));
    assert_eq!(opacity["encoding"].as_str(), Some("data"));
}

/// Text, crate and package give equal results.
#[test]
fn kinds_of_usd_are_what_usd_core_computes() {
    let figures = figures();
    for ending in ["usda", "usdc", "usdz"] {
        let scene = ImportedScene::from_file(&root().join(format!("scenes/import/kinds.{ending}")));
        check_meshes(&scene, &figures);
        check_cameras(&scene, &figures);
        check_lights(&scene, &figures);
        check_materials(&scene, &figures);
        for phrase in [
            "one unit is 0.01 m (as stated); y is up",
            "is animated: its value at time code 1 is used",
            "prims that are invisible, or have a purpose other than rendering (guide, proxy), are left out",
            "camera \"Shot\": 35 mm at f/2.8",
        ] {
            assert!(scene.messages.contains(phrase), "{ending}: {phrase} is not said: {}", scene.messages);
        }
    }
}

/// A scene against the same in our format, by the Z test of `compare`; a brighter sky is detected.
#[test]
fn a_scene_of_usd_is_that_of_our_own_words() {
    let place = tempfile::tempdir().expect("a temporary folder");
    let folder = root().join("scenes/import");
    let imported = place.path().join("made");
    etendue(["import", &text(&folder.join("table.usda")), "-o", &text(&imported)]).ok();
    let job = fs::read_to_string(imported.join("job.toml")).expect("a job");
    let small = job
        .replace("width_px = 640", "width_px = 64")
        .replace("height_px = 480", "height_px = 48")
        .replace("pixel_pitch_um = 50", "pixel_pitch_um = 500");
    fs::write(imported.join("job.toml"), small).expect("written");
    let render = |job: &Path, out: &str, seed: &str, more: &[&str]| {
        let out = text(&place.path().join(out));
        let sampling =
            ["--set", "output.variance=true", "--set", "render.replicates=32", "--spp", "128", "--seed", seed];
        let job = text(job);
        etendue(["render", job.as_str(), "-o", out.as_str()].iter().chain(&sampling).chain(more)).ok();
        format!("{out}/Camera/radiance.exr")
    };
    let own = folder.join("table.toml");
    let theirs = render(&imported.join("job.toml"), "theirs", "2", &[]);
    let output = etendue(["compare", &render(&own, "own", "1", &[]), &theirs]);
    assert_eq!(output.status, 0, "{}{}", output.out, output.err);
    let brighter = render(&own, "brighter", "3", &["--set", "scene.environment.luminance_cd_m2=43"]);
    let output = etendue(["compare", &brighter, &theirs]);
    assert_eq!(output.status, 1, "more light is found: {}", output.out);
}

/// Writes a text of USD and imports it.
fn imported(body: &str) -> (tempfile::TempDir, CommandOutput) {
    let place = tempfile::tempdir().expect("a temporary folder");
    let file = place.path().join("a.usda");
    fs::write(&file, format!("#usda 1.0\n{body}")).expect("written");
    fs::copy(root().join("scenes/import/letter.png"), place.path().join("letter.png")).expect("copied");
    let output = etendue(["import", &text(&file), "-o", &text(&place.path().join("made"))]);
    (place, output)
}

#[test]
fn unsupported_content_of_usd_is_reported() {
    let (place, output) = imported(
        "def Sphere \"Ball\" (prepend references = @none.usda@) { double radius = 100 }\n\
         def BasisCurves \"Hair\" {}\n\
         def Mesh \"Cage\" { int[] faceVertexCounts = [3] int[] faceVertexIndices = [0, 1, 2] point3f[] points = [(0,0,0), (1,0,0), (0,1,0)] }\n\
         def RectLight \"Dark\" { float inputs:intensity = 0 }\n\
         def Sphere \"Glass\" { double radius = 1 rel material:binding = </Clear> }\n\
         def Mesh \"Bare\" { int[] faceVertexCounts = [3] int[] faceVertexIndices = [0, 1, 2] point3f[] points = [(0,0,0), (1,0,0), (0,1,0)]\n\
           uniform token subdivisionScheme = \"none\" rel material:binding = </Pictured> }\n\
         def Material \"Pictured\" { token outputs:surface.connect = </Pictured/S.outputs:surface>\n\
           def Shader \"S\" { uniform token info:id = \"UsdPreviewSurface\" color3f inputs:diffuseColor.connect = </Pictured/T.outputs:rgb> token outputs:surface }\n\
           def Shader \"T\" { uniform token info:id = \"UsdUVTexture\" asset inputs:file = @letter.png@ float3 outputs:rgb } }\n\
         def Material \"Clear\" { token outputs:surface.connect = </Clear/S.outputs:surface>\n\
           def Shader \"S\" { uniform token info:id = \"UsdPreviewSurface\" float inputs:opacity = 0.1 float inputs:clearcoat = 1 token outputs:surface } }\n",
    );
    let messages = output.ok().err;
    for phrase in [
        "one unit is 0.01 m (the default, as it is not stated); y is up",
        "none.usda",
        "a \"BasisCurves\" is not supported and left out",
        "a subdivision surface becomes its control mesh with smooth normals",
        "a RectLight emits no light and is left out",
        "it has no light: a uniform sky of 2000 cd/m² is added",
        "it has no cameras: \"view\" is added",
        "clearcoat is not used",
        "becomes a thin sheet",
        "a mesh lacks the texture coordinates \"st\": its textures have the value of their corner everywhere",
    ] {
        assert!(messages.contains(phrase), "{phrase} is not said: {messages}");
    }
    let scene = fs::read_to_string(place.path().join("made/scene.toml")).expect("a scene");
    assert!(scene.contains("radius_m = 1\n") || scene.contains("radius_m = 1 }"), "{scene}");
    etendue(["plan", &text(&place.path().join("made/job.toml"))]).ok();
}

#[test]
fn damaged_scenes_of_usd_are_refused_and_nothing_is_written() {
    let deep = format!("{}{}", "def \"a\" { ".repeat(80), "}".repeat(80));
    for (body, phrase) in [
        ("def Sphere \"a\" {\n double radius = = 2\n}\n", "a.usda:3: "),
        ("def Sphere \"a\" { double radius = -1 }\n", "/a: \"radius\" is -1"),
        ("(\n metersPerUnit = 0\n)\n", "\"metersPerUnit\" is 0; expected a finite number above 0"),
        ("(\n metersPerUnit = -1\n)\n", "\"metersPerUnit\" is -1"),
        ("(\n metersPerUnit = inf\n)\n", "\"metersPerUnit\" is inf"),
        ("def Camera \"a\" { float focalLength = 0 }\n", "\"focalLength\" is 0"),
        (
            "def Mesh \"a\" { int[] faceVertexCounts = [3] int[] faceVertexIndices = [0, 1, 9] point3f[] points = [(0,0,0), (1,0,0)] }\n",
            "a face refers to point 9, and there are 2 points",
        ),
        (
            "def Mesh \"a\" { int[] faceVertexCounts = [4] int[] faceVertexIndices = [0, 0, 0] point3f[] points = [(0,0,0)] }\n",
            "its faces have 4 corners, and \"faceVertexIndices\" has 3",
        ),
        (
            "def PointInstancer \"a\" { rel prototypes = </a/b> int[] protoIndices = [3] point3f[] positions = [(0,0,0)] }\n",
            "an instance refers to prototype 3, and there are 1",
        ),
        (
            "def PointInstancer \"a\" { rel prototypes = </a> int[] protoIndices = [0] point3f[] positions = [(0,0,0)] }\n",
            "or form a cycle",
        ),
        (&deep, "more than 64 levels deep"),
        ("def Sphere \"B}lb\" {}\n", "line 2: the name of a prim contains unbalanced braces"),
        (
            "class \"a\" (inherits = </b>) {}\nclass \"b\" (specializes = </a>) {}\ndef \"c\" (inherits = </a>) {}\n",
            "inherits from itself",
        ),
    ] {
        let (place, output) = imported(body);
        output.refused(&["a.usda", phrase]);
        assert!(!place.path().join("made").exists(), "{phrase}: nothing is written");
    }
}

/// Crates and packages with wrong sizes, and truncated ones.
#[test]
fn crates_and_packages_that_lie_are_refused() {
    let place = tempfile::tempdir().expect("a temporary folder");
    let folder = root().join("scenes/import");
    let assert_refused = |name: &str, bytes: &[u8], phrase: &str| {
        let file = place.path().join(name);
        fs::write(&file, bytes).expect("written");
        etendue(["import", &text(&file), "-o", &text(&place.path().join("made"))]).refused(&[name, phrase]);
    };
    let crate_bytes = fs::read(folder.join("kinds.usdc")).expect("a crate");
    assert_refused("cut.usdc", &crate_bytes[..crate_bytes.len() / 2], "an offset is beyond the end of the file");
    // The table of sections is at the offset in bytes 16 to 24; sections have a name of 16 bytes and their offset.
    let table = u64::from_le_bytes(crate_bytes[16..24].try_into().expect("eight")) as usize;
    for section in ["TOKENS", "STRINGS", "FIELDS", "FIELDSETS", "PATHS", "SPECS"] {
        let entry =
            crate_bytes[table..].windows(section.len() + 1).position(|w| w == format!("{section}\0").as_bytes());
        let at = table + entry.expect("a section") + 16;
        let start = u64::from_le_bytes(crate_bytes[at..at + 8].try_into().expect("eight")) as usize;
        let mut lying = crate_bytes.clone();
        lying[start..start + 8].copy_from_slice(&(1_u64 << 40).to_le_bytes());
        assert_refused("lying.usdc", &lying, "damaged, or not a supported scene");
    }
    let package = fs::read(folder.join("kinds.usdz")).expect("a package");
    assert_refused("cut.usdz", &package[..package.len() - 30], "the package cannot be read");
    // The method of the first file of the directory.
    let at = package.windows(4).position(|w| w == b"PK\x01\x02").expect("a directory") + 10;
    let mut packed = package.clone();
    packed[at] = 8;
    assert_refused("packed.usdz", &packed, "is compressed or encrypted, which is not allowed in a package");
    assert_refused("none.usdz", b"PK\x05\x06\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0", "the package has no layer");
}
