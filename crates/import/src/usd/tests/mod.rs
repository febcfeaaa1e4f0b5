//! Tests of the conversion of USD texts, rule by rule.

mod bindings;
mod instances;
mod lights;
mod materials;
mod meshes;
mod pictures;

use super::importer::Importer;
use crate::syntax::usd::read_usd;
use etendue_io::Sandbox;
use etendue_io::png::{encode_grey8, encode_grey16};
use etendue_scene::record::material::Material;
use etendue_scene::record::{Level, Scene};
use std::path::Path;

/// Two triangles of 1 by 2, in metres, with a material and a subdivision scheme.
const CARD: &str = "int[] faceVertexCounts = [3, 3] int[] faceVertexIndices = [0, 1, 2, 0, 2, 3] \
    point3f[] points = [(0,0,0), (1,0,0), (1,2,0), (0,2,0)] uniform token subdivisionScheme = \"none\"";

/// Scene, and its notes.
struct ConvertedScene {
    scene: Scene,
    report_text: String,
    files: Vec<(String, Vec<u8>)>,
}

impl ConvertedScene {
    /// Imports the text of a stage in metres, z upwards; next to it are `letter.png` (colours of 8 bits), `grey.png` and `grey16.png`.
    fn new(body: &str) -> Self {
        Self::in_units(body, 1.0)
    }

    fn in_units(body: &str, metres: f64) -> Self {
        let place = tempfile::tempdir().expect("a temporary folder");
        let file = place.path().join("a.usda");
        let head = format!("#usda 1.0\n(\n metersPerUnit = {metres}\n upAxis = \"Z\"\n)\n");
        std::fs::write(&file, format!("{head}{body}\n")).expect("written");
        let letter = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/import/letter.png");
        std::fs::copy(letter, place.path().join("letter.png")).expect("copied");
        let grey = encode_grey8(2, 2, &[0, 128, 255, 64]).expect("a picture");
        let fine = encode_grey16(2, 2, &[0, 128, 255, 64]).expect("a picture");
        [("grey.png", grey), ("grey16.png", fine)]
            .into_iter()
            .for_each(|(name, bytes)| std::fs::write(place.path().join(name), bytes).expect("written"));
        let stage = read_usd(&file, &Sandbox::NONE).expect("a stage");
        let mut importer = Importer::new(&file, place.path(), &stage);
        importer.read().expect("a scene");
        let report_text = importer.scenery.report.lines().join("\n");
        Self { scene: importer.scenery.scene, report_text, files: importer.scenery.files }
    }

    /// Name of the material of an object.
    fn material_name(&self, object: &str) -> &str {
        let object_record = self.scene.objects.iter().find(|entry| entry.name.value == object);
        let material = object_record.unwrap_or_else(|| panic!("no {object}")).material.as_ref();
        material.map_or("", |name| name.value.as_str())
    }

    fn material(&self, object: &str) -> &Material {
        let name = self.material_name(object);
        self.scene.materials.iter().find(|entry| entry.name.value == name).expect("a material")
    }

    /// Luminance of an object's light, cd/m².
    fn luminance(&self, object: &str) -> f64 {
        match &self.material(object).emission.as_ref().expect("a light").light.level {
            Level::Luminance(level) => level.value,
            other => panic!("{other:?}"),
        }
    }

    /// Returns true if a note contains the phrase.
    fn reports(&self, phrase: &str) -> bool {
        self.report_text.contains(phrase)
    }
}

fn near(actual: f64, expected: f64) {
    assert!((actual - expected).abs() <= 1e-9 * expected.abs(), "{actual}, expected {expected}");
}

/// Material of UsdPreviewSurface with these inputs.
fn surface(name: &str, inputs: &str) -> String {
    format!(
        "def Material \"{name}\" {{ token outputs:surface.connect = </{name}/S.outputs:surface>\n\
         def Shader \"S\" {{ uniform token info:id = \"UsdPreviewSurface\" {inputs} token outputs:surface }} }}\n"
    )
}
