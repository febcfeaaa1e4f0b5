//! Files in memory.

use std::collections::BTreeMap;
use std::path::Path;

use etendue_scene::{Description, Faults, Overrides};

/// The page of the format.
pub(crate) const DOC: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/scene-format.md");

pub(crate) fn doc() -> String {
    page("scene-format.md")
}

/// A page of the documentation.
pub(crate) fn page(name: &str) -> String {
    let path = Path::new(DOC).with_file_name(name);
    std::fs::read_to_string(path).expect("the page is in the repository")
}

/// A job's head: its format and a camera that is right.
const CAMERA: &str = r#"format = 1

[[cameras]]
name = "front"
position_m = [0, 0, 1]
look_at_m = [10, 0, 1]

[cameras.lens]
type = "thin"
focal_length_mm = 6
f_number = 2.0
focus_distance_m = 5.0

[cameras.sensor]
width_px = 64
height_px = 48
pixel_pitch_um = 6.0
"#;

/// Files by name.
pub(crate) struct Files(BTreeMap<String, String>);

impl Files {
    /// The three files of the page's example: each follows a line that ends with its name.
    pub(crate) fn of_example(page: &str) -> Self {
        let mut files = BTreeMap::new();
        for part in page.split("\nThe ").skip(1) {
            let Some(name) = part.split('`').nth(1).filter(|n| n.ends_with(".toml")) else { continue };
            let text = part.split("```toml\n").nth(1).and_then(|t| t.split("```").next()).expect("a block");
            files.insert(name.to_owned(), text.to_owned());
        }
        Self(files)
    }

    /// One job.
    pub(crate) fn of_job(text: &str) -> Self {
        Self([("job.toml".to_owned(), text.to_owned())].into())
    }

    /// A job of one camera that is right, and `text`.
    pub(crate) fn with_camera(text: &str) -> Self {
        Self::of_job(&format!("{CAMERA}{text}"))
    }

    pub(crate) fn put(&mut self, name: &str, text: &str) {
        self.0.insert(name.to_owned(), text.to_owned());
    }

    pub(crate) fn rename(&mut self, name: &str, new: &str) {
        let text = self.0.remove(name).expect("the file");
        self.put(new, &text);
    }

    /// Changes a text that must be there.
    pub(crate) fn edit(&mut self, name: &str, old: &str, new: &str) {
        let text = self.text(name);
        assert!(text.contains(old), "{name} has no {old}");
        self.put(name, &text.replacen(old, new, 1));
    }

    pub(crate) fn text(&self, name: &str) -> String {
        self.0.get(name).expect("the file").clone()
    }

    pub(crate) fn read(&self, path: &Path) -> Result<String, String> {
        self.0.get(path.to_str().expect("a name")).cloned().ok_or_else(|| "no such file".to_owned())
    }
}

pub(crate) fn load(files: &Files, sets: &[&str]) -> Result<Description, Faults> {
    Description::load(Path::new("job.toml"), &|p| files.read(p), &Overrides::new(sets))
}
