//! The TOML blocks on the pages of materials and lights are valid.

use std::collections::HashSet;

use etendue_scene::{Description, DescriptionErrors};

use crate::files::{DescriptionFiles, load, page};

const CAMERA: &str = "format = 1\nlens = { type = \"pinhole\", focal_length_mm = 6, f_number = 4 }\n\
                      sensor = { width_px = 8, height_px = 6, pixel_pitch_um = 6 }\n";
const VIEW: &str = "[[cameras]]\nname = \"c\"\nfile = \"camera.toml\"\nposition_m = [0, 0, 1]\nlook_at_m = [9, 0, 1]\n";

/// The blocks of TOML of a page.
fn blocks(page: &str) -> Vec<&str> {
    page.split("```toml\n").skip(1).map(|rest| rest.split("```").next().expect("a block")).collect()
}

/// A page as jobs: its blocks together, and each environment by itself, of which a scene has one. A block with cameras belongs to the job.
fn jobs(page: &str) -> Vec<DescriptionFiles> {
    let (views, scenes): (Vec<_>, Vec<_>) = blocks(page).into_iter().partition(|block| block.contains("[[cameras]]"));
    let (environments, parts): (Vec<_>, Vec<_>) = scenes.into_iter().partition(|block| block.contains("[environment]"));
    let view = views.first().copied().unwrap_or(VIEW);
    let job = |scene: &str| {
        let mut files = DescriptionFiles::from_job(&format!("format = 1\nscene = \"scene.toml\"\n{view}"));
        files.put("scene.toml", &format!("format = 1\n{scene}"));
        files.put("camera.toml", CAMERA);
        files
    };
    core::iter::once(job(&parts.concat())).chain(environments.into_iter().map(job)).collect()
}

/// The blocks of a page together, after all of it has been read.
fn read(page: &str) -> Description {
    let all: Result<Vec<_>, DescriptionErrors> = jobs(page).iter().map(|files| load(files, &[])).collect();
    all.unwrap_or_else(|errors| panic!("{errors}")).swap_remove(0)
}

/// Number of tables of this kind on a page.
fn count(page: &str, head: &str) -> usize {
    blocks(page).iter().flat_map(|block| block.lines()).filter(|line| *line == head).count()
}

#[test]
fn the_page_of_materials_is_a_scene_with_every_type() {
    let text = page("materials.md");
    let scene = read(&text).scene;
    assert_eq!(scene.materials.len(), count(&text, "[[materials]]"));
    assert_eq!(scene.textures.len(), count(&text, "[[textures]]"));
    let headings = text.lines().filter_map(|line| line.strip_prefix("## "));
    let type_names: Vec<_> = headings.filter(|head| head.starts_with(char::is_lowercase)).collect();
    assert!(type_names.iter().all(|name| text.contains(&format!("\ntype = \"{name}\"\n"))), "{type_names:?}");
    let types: HashSet<_> = scene.materials.iter().map(|m| std::mem::discriminant(&m.surface.0)).collect();
    assert_eq!(type_names.len(), types.len(), "a section and an example for every type that occurs: {type_names:?}");
}

#[test]
fn the_page_of_lights_is_a_scene() {
    let text = page("lights.md");
    let description = read(&text);
    assert_eq!(description.scene.lights.len(), count(&text, "[[lights]]"));
    assert_eq!(description.cameras.len(), 2);
    assert_eq!(jobs(&text).len(), 1 + count(&text, "[environment]"));
}

#[test]
fn a_fault_of_a_page_would_be_found() {
    let broken = page("materials.md").replacen("flake_coverage = 0.7", "flake_coverage = 7", 1);
    let errors = load(&jobs(&broken)[0], &[]).expect_err("a fault").to_string();
    assert!(errors.contains("flake_coverage: found 7"), "{errors}");
}
