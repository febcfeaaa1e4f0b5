//! The tables of keys on the pages are the schema, in words.

mod keys;
mod page;
mod section;
mod value;

use std::collections::HashSet;
use std::sync::LazyLock;

use crate::files::{page, page_path};
use page::Pages;
use section::File;

const HEAD: &str =
    "<!-- reference: made of the schema by the tests of crates/scene; ETENDUE_BLESS=1 writes it anew -->\n";
const END: &str = "<!-- end of reference -->\n";

/// Page of a kind of file; the overview for records in several kinds.
fn name(file: Option<File>) -> String {
    file.map_or_else(|| "scene-format.md".to_owned(), |file| format!("format/{}.md", file.word()))
}

fn all() -> impl Iterator<Item = Option<File>> {
    File::ALL.into_iter().map(Some).chain([None])
}

/// The list of built-in materials.
fn presets() -> String {
    let mut text = "## Presets of `[[materials]]`\n\n| preset | is | says | source |\n|---|---|---|---|\n".to_owned();
    for preset in etendue_scene::preset::all() {
        let says: Vec<_> = preset.keys_and_values().map(|preset_keys| format!("`{preset_keys}`")).collect();
        text += &format!("| `{}` | {} | {} | {} |\n", preset.name, preset.description, says.join(", "), preset.source);
    }
    text + "\n"
}

/// All sections, shared by all tests.
static PAGES: LazyLock<Pages> = LazyLock::new(Pages::new);

/// The reference of a page, generated from the schema.
fn generated_reference(file: Option<File>) -> String {
    let presets = if file == Some(File::Scene) { presets() } else { String::new() };
    format!("{HEAD}\n{}{presets}{END}", PAGES.write(file))
}

#[test]
fn the_reference_is_in_step_with_the_schema() {
    for file in all() {
        let generated = generated_reference(file);
        let mut page_text = page(&name(file));
        let start = page_text.find(HEAD).expect("the reference begins");
        let end = page_text.find(END).expect("the reference ends") + END.len();
        if std::env::var_os("ETENDUE_BLESS").is_some() {
            page_text.replace_range(start..end, &generated);
            std::fs::write(page_path(&name(file)), page_text).expect("the page is writable");
            continue;
        }
        let current = &page_text[start..end];
        let differs = current.lines().zip(generated.lines()).find(|(old, new)| old != new);
        let message = "run the tests with ETENDUE_BLESS=1; the first line that differs";
        assert!(current == generated, "{}: {message}: {differs:?}", name(file));
    }
}

/// The anchors of a text, in its order.
fn anchors(text: &str) -> Vec<&str> {
    text.split("<a id=\"").skip(1).filter_map(|rest| rest.split('"').next()).collect()
}

#[test]
fn every_key_has_an_anchor_of_its_own() {
    for file in all() {
        let text = generated_reference(file);
        let anchors = anchors(&text);
        let mut unique = HashSet::new();
        let twice: Vec<_> = anchors.iter().filter(|anchor| !unique.insert(**anchor)).collect();
        assert!(twice.is_empty(), "{}: {twice:?}", name(file));
        assert!(text.lines().any(|line| line.starts_with("| <a id=")), "{} has no key", name(file));
    }
    let camera = generated_reference(Some(File::Camera));
    for known in ["lens-thin.f_number", "lens-rear_aperture", "sensor-dark", "sensor.bits", "isp-image_filters-glow"] {
        assert!(anchors(&camera).contains(&known), "{known}: others may link to it");
    }
}

#[test]
fn a_record_of_several_places_names_them_all() {
    let camera = generated_reference(Some(File::Camera));
    assert!(camera.contains("Rim: `[lens.front_aperture]`, `[lens.rear_aperture]`\n"));
    assert!(camera.contains("Coupling of neighbours: `[sensor.crosstalk]`, `[sensor.inter_pixel_capacitance]`\n"));
    let overview = generated_reference(None);
    let spectrum = overview.split("</a>Spectrum\n\n").nth(1).and_then(|rest| rest.lines().next()).expect("its places");
    for place in ["scene `[environment.radiance_w_m2_sr_nm]`", "camera `", "`sensor.quantum_efficiency = [{ … }]`"] {
        assert!(spectrum.contains(place), "{spectrum}");
    }
}
