//! Sections as text, and the links to them.

use serde_json::Value as Json;

use super::keys::{groups, keys_of, mark, must};
use super::section::{File, Section, TableLocation, plain, sections};
use super::value::value;

/// Names of records that may occur in several places, by the first of them.
const NAMES: [(&str, &str); 19] = [
    ("environment-radiance_w_m2_sr_nm", "Spectrum"),
    ("frames-rolls", "Wheel"),
    ("frames-trajectory", "Trajectory"),
    ("lights-modulation", "Modulation"),
    ("lights-modulation-steps", "Step of a programme"),
    ("materials-alpha", "Texture of a number"),
    ("materials-colour", "Colour"),
    ("materials-print", "Colour or texture"),
    ("media-shape", "Part of the world"),
    ("media-unevenness", "Unevenness"),
    ("media-visibility", "Visibility"),
    ("lens-coating", "Coating"),
    ("lens-front_aperture", "Rim"),
    ("sensor-crosstalk", "Coupling of neighbours"),
    ("isp-tone_curve", "Tone curve"),
    ("output", "Output"),
    ("render", "Rendering"),
    ("render-depth_of_field", "Depth of field"),
    ("render-depth_of_field-fast", "Fast depth of field"),
];

/// With more places than this, a heading has only the name, and the places follow.
const MAX_PLACES_IN_HEADING: usize = 3;

/// All sections, on the pages of their files; those of several kinds of file on the overview.
pub(super) struct Pages {
    sections: Vec<Section>,
}

impl Pages {
    pub(super) fn new() -> Self {
        Self { sections: sections() }
    }

    /// The sections of a file's page, or of the overview.
    pub(super) fn write(&self, page: Option<File>) -> String {
        self.sections.iter().filter(|section| section.file() == page).map(|section| self.section(section)).collect()
    }

    /// Returns a link from a page to a table's section.
    pub(super) fn link(&self, schema: &Json, from: Option<File>) -> String {
        let schema = plain(schema);
        let section =
            self.sections.iter().find(|section| section.schema == schema).expect("every table has its section");
        let place = &section.places[0];
        let page = match (from, section.file()) {
            (from, to) if from == to => String::new(),
            (_, None) => "../scene-format.md".to_owned(),
            (None, Some(file)) => format!("format/{}.md", file.word()),
            (Some(_), Some(file)) => format!("{}.md", file.word()),
        };
        if place.depth() == 0 {
            return format!("[{}]({page})", place.file.word());
        }
        let elsewhere = section.file().filter(|file| Some(*file) != from);
        let whose = elsewhere.map_or(String::new(), |file| format!(" of the {}", file.word()));
        format!("[{}{whose}]({page}#{})", label(section), anchor(section))
    }

    /// One table: its heading, its keys, then those of each form.
    fn section(&self, section: &Section) -> String {
        let mut text = heading(section);
        let forms = groups(&section.schema);
        let (plain, marked): (Vec<_>, Vec<_>) = forms.iter().partition(|form| mark(&form[0]).is_none());
        for form in plain {
            text += &self.keys(form, section, &anchor(section));
        }
        let words: Vec<_> = marked.iter().filter_map(|form| mark(&form[0])).collect();
        if let Some((key, ..)) = words.first() {
            let links = words.iter().map(|(_, word, _)| format!("[`\"{word}\"`](#{}-{word})", anchor(section)));
            text += &format!("Keys by `{key}`: {}.\n\n", links.collect::<Vec<_>>().join(", "));
        }
        for (form, (key, word, description)) in marked.into_iter().zip(&words) {
            let anchor = format!("{}-{word}", anchor(section));
            let marks = "#".repeat(level(section) + 1);
            text += &format!(
                "{marks} <a id=\"{anchor}\"></a>{}, `{key} = \"{word}\"`\n\n{description}\n\n",
                label(section)
            );
            text += &self.keys(form, section, &anchor);
        }
        text
    }

    /// The table of keys of all forms with the same mark.
    fn keys(&self, forms: &[Json], section: &Section, anchor: &str) -> String {
        let keys = keys_of(forms);
        if keys.is_empty() {
            return "No keys of its own.\n\n".to_owned();
        }
        let mut text = "| key | must | value | meaning |\n|---|---|---|---|\n".to_owned();
        for (key, schema) in keys {
            let value = value(&schema, self, section.file());
            let description = schema["description"].as_str().unwrap_or("");
            let is_required = must(&key, forms);
            text += &format!("| <a id=\"{anchor}.{key}\"></a>`{key}` | {is_required} | {value} | {description} |\n");
        }
        text + "\n"
    }
}

/// Name of a record that may occur in several places.
fn name(section: &Section) -> Option<&'static str> {
    let first = section.places[0].anchor();
    let name = NAMES.iter().find(|(place, _)| *place == first).map(|(_, name)| *name);
    let places = || section.places.iter().map(TableLocation::header).collect::<Vec<_>>();
    assert_eq!(name.is_some(), section.places.len() > 1, "{first} has a name where it may stand at {:?}", places());
    name
}

/// Title of the section: its record's name, or the header of the only place.
fn label(section: &Section) -> String {
    name(section).map_or_else(|| section.places[0].header(), str::to_owned)
}

/// The anchor of a section: its first place, or on the overview its name.
fn anchor(section: &Section) -> String {
    match (section.file(), name(section)) {
        (None, Some(name)) => slug(name),
        _ => section.places[0].anchor(),
    }
}

fn slug(name: &str) -> String {
    name.to_lowercase().replace(' ', "-")
}

fn level(section: &Section) -> usize {
    match section.places[0].depth() {
        1 if section.file().is_some() => 2,
        _ => 3,
    }
}

/// The heading with an anchor for every place; empty for a whole file, whose page has one.
fn heading(section: &Section) -> String {
    if section.places[0].depth() == 0 {
        return String::new();
    }
    let marks = "#".repeat(level(section));
    let mut anchors: Vec<_> = match section.file() {
        None => Vec::new(),
        Some(_) => section.places.iter().map(TableLocation::anchor).collect(),
    };
    let named = name(section).map(slug).filter(|slug| !anchors.contains(slug));
    anchors.extend(named);
    let anchors: String = anchors.iter().map(|id| format!("<a id=\"{id}\"></a>")).collect();
    match name(section) {
        None => format!("{marks} {anchors}{}\n\n", label(section)),
        Some(name) if section.places.len() > MAX_PLACES_IN_HEADING => {
            format!("{marks} {anchors}{name}\n\nIts places: {}.\n\n", places(section))
        }
        Some(name) => format!("{marks} {anchors}{name}: {}\n\n", places(section)),
    }
}

/// The headers of all places; with the file's word if several kinds of file contain them.
fn places(section: &Section) -> String {
    let files = File::ALL.into_iter().map(|file| {
        let headers: Vec<_> = section.places.iter().filter(|p| p.file == file).map(TableLocation::header).collect();
        (file, headers.join(", "))
    });
    let sources = files.filter(|(_, headers)| !headers.is_empty());
    match section.file() {
        Some(_) => sources.map(|(_, headers)| headers).collect(),
        None => sources.map(|(file, headers)| format!("{} {headers}", file.word())).collect::<Vec<_>>().join("; "),
    }
}
