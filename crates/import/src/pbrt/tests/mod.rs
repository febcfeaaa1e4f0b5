//! Tests of the conversion of pbrt scenes, rule by rule.

mod images;
mod lights;
mod materials;
mod shapes;

use std::path::Path;

use etendue_io::picture::decode_image;
use etendue_scene::asset::ImagePixels;

use super::convert;
use crate::written::ImportFiles;

/// File of a scene, by name and bytes.
struct SceneFile<'a> {
    name: &'a str,
    bytes: &'a [u8],
}

/// Result of an import.
struct ConvertedScene(ImportFiles);

/// Imports a scene with a camera and `body` behind `WorldBegin`; `files` are next to it.
fn read(body: &str, files: &[SceneFile<'_>]) -> Result<ConvertedScene, String> {
    let text = format!("LookAt 0 0 -5  0 0 0  0 1 0\nCamera \"perspective\"\nWorldBegin\n{body}\n");
    read_text(&text, files)
}

fn read_text(text: &str, files: &[SceneFile<'_>]) -> Result<ConvertedScene, String> {
    let place = tempfile::tempdir().expect("a temporary folder");
    let file = place.path().join("a.pbrt");
    std::fs::write(&file, text).expect("written");
    for SceneFile { name, bytes } in files {
        std::fs::write(place.path().join(name), bytes).expect("written");
    }
    let converted = convert(&file, &place.path().join("out")).map(ConvertedScene);
    converted.map_err(|e| {
        e.to_string().replace(&format!("{}/", place.path().display()), "").replace("error[malformed-file]: ", "")
    })
}

impl ConvertedScene {
    fn new(body: &str) -> Self {
        read(body, &[]).expect("a scene")
    }

    fn file(&self, name: &str) -> &[u8] {
        let file = self.0.files.iter().find(|(path, _)| path == name);
        &file.unwrap_or_else(|| panic!("no {name}: {:?}", self.names())).1
    }

    fn names(&self) -> Vec<&str> {
        self.0.files.iter().map(|(name, _)| name.as_str()).collect()
    }

    fn scene(&self) -> &str {
        std::str::from_utf8(self.file("scene.toml")).expect("a text")
    }

    /// Rows of numbers of a table that is written beside the scene.
    fn table(&self, name: &str) -> Vec<Vec<f64>> {
        let text = std::str::from_utf8(self.file(name)).expect("a text");
        let row = |line: &str| line.split(',').map(|word| word.parse().expect("a number")).collect();
        text.lines().skip(1).map(row).collect()
    }

    /// Columns, and pixels of an image that is written beside the scene.
    fn image(&self, name: &str) -> (usize, Vec<[f32; 3]>) {
        let image = decode_image(Path::new(name), self.file(name)).expect("an image");
        match image.pixels {
            ImagePixels::Rgb32F(pixels) => (image.width as usize, pixels),
            other => panic!("{other:?}"),
        }
    }

    fn assert_reports(&self, phrase: &str) {
        assert!(self.0.report.iter().any(|line| line.contains(phrase)), "{phrase}: {:#?}", self.0.report);
    }

    fn assert_silent_about(&self, phrase: &str) {
        assert!(!self.0.report.iter().any(|line| line.contains(phrase)), "{phrase}: {:#?}", self.0.report);
    }
}
