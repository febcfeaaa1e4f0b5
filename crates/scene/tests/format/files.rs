//! Files in memory.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use etendue_scene::{Description, DescriptionErrors, Overrides};

/// Path of a page of the documentation.
pub(crate) fn page_path(name: &str) -> PathBuf {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs")).join(name)
}

/// A page of the documentation.
pub(crate) fn page(name: &str) -> String {
    std::fs::read_to_string(page_path(name)).expect("the page is in the repository")
}

/// Head of a job: its format and a valid camera.
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
pub(crate) struct DescriptionFiles(BTreeMap<String, String>);

impl DescriptionFiles {
    /// The example of the pages of jobs, scenes and cameras.
    pub(crate) fn from_example() -> Self {
        Self::on_pages(["job", "scene", "camera"].map(|kind| (kind, page(&format!("format/{kind}.md")))))
    }

    /// The small example of the overview.
    pub(crate) fn from_small_example() -> Self {
        let overview = page("scene-format.md");
        Self::on_pages(["job", "scene", "camera"].map(|kind| (kind, overview.clone())))
    }

    /// Files by their kind: each is the block after a line that ends with its name.
    fn on_pages(pages: [(&str, String); 3]) -> Self {
        let file = |(kind, page): (&str, String)| {
            let name = format!("{kind}.toml");
            let text = page.split(&format!("`{name}`:\n\n```toml\n")).nth(1).and_then(|t| t.split("```").next());
            (name, text.expect("a block").to_owned())
        };
        Self(pages.into_iter().map(file).collect())
    }

    /// A job without other files.
    pub(crate) fn from_job(text: &str) -> Self {
        Self([("job.toml".to_owned(), text.to_owned())].into())
    }

    /// A job with a valid camera, and `text`.
    pub(crate) fn with_camera(text: &str) -> Self {
        Self::from_job(&format!("{CAMERA}{text}"))
    }

    pub(crate) fn put(&mut self, name: &str, text: &str) {
        self.0.insert(name.to_owned(), text.to_owned());
    }

    pub(crate) fn rename(&mut self, name: &str, new: &str) {
        let text = self.0.remove(name).expect("the file");
        self.put(new, &text);
    }

    /// Replaces a text that must be present.
    pub(crate) fn edit(&mut self, name: &str, old: &str, new: &str) {
        let text = self.text(name);
        assert!(text.contains(old), "{name} has no {old}");
        self.put(name, &text.replacen(old, new, 1));
    }

    pub(crate) fn text(&self, name: &str) -> String {
        self.0.get(name).expect("the file").clone()
    }

    pub(crate) fn read(&self, path: &Path) -> Result<String, etendue_scene::Problem> {
        self.0.get(path.to_str().expect("a name")).cloned().ok_or_else(|| "no such file".into())
    }
}

pub(crate) fn load(files: &DescriptionFiles, sets: &[&str]) -> Result<Description, DescriptionErrors> {
    Description::load(Path::new("job.toml"), &|p| files.read(p), &Overrides::new(sets))
}
