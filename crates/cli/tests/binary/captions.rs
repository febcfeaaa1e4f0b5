//! Numbers in docs/pictures.md and README.md: each is checked against the job of the image with the settings of docs/pictures/gallery, or against another file.
//!
//! Below a paragraph, `<!-- check: VALUE = EXPRESSION; … -->` states the source of each of its numbers, in their order. An expression of awk may contain
//! keys of the job (`scene.environment.turbidity`, `camera.sensor.exposure_s`; `length` counts a list) and keys of a file (`FILE.toml:KEY`), with spaces round
//! operators. `VALUE = FILE: TEXT` quotes a file. "N samples (job: M)" needs no check, nor do titles "N commands".

use crate::cookbook::{check, cut, numbers, numbers_in_order};
use crate::support::root;
use etendue_scene::written::File;
use etendue_scene::{Description, Overrides};
use std::collections::BTreeMap;
use std::path::Path;

/// The list of images, jobs and settings.
const GALLERY: &str = "docs/pictures/gallery";

/// Numbers as words; "one" is seldom a number.
const WORDS: [&str; 11] = ["two", "three", "four", "five", "six", "seven", "eight", "nine", "ten", "eleven", "twelve"];

/// An image: its job with the gallery's settings.
struct Image {
    job: String,
    /// Keys of the whole job; `camera` is the camera of the image, `frames` the range of frames.
    keys: toml::Value,
    /// Samples per pixel in the job as shipped.
    job_spp: String,
}

fn text_of(path: &str) -> Result<String, String> {
    std::fs::read_to_string(root().join(path)).map_err(|cause| format!("{path}: {cause}"))
}

/// Keys of a job with its scene and cameras.
fn keys_of(job: &str, settings: &[String]) -> toml::Table {
    let read = |path: &Path| std::fs::read_to_string(path).map_err(|cause| cause.to_string().into());
    let description = Description::load(&root().join(job), &read, &Overrides::new(settings));
    let description = description.unwrap_or_else(|errors| panic!("{job}: {errors}"));
    File::new(description.to_table()).to_string().parse().expect("TOML")
}

/// Value of a dotted key. Entries of lists have a name or an index.
fn value_of(keys: &toml::Value, key: &str) -> Option<String> {
    let (part, rest) = key.split_once('.').map_or((key, None), |(part, rest)| (part, Some(rest)));
    let value = match keys {
        toml::Value::Table(table) => table.get(part)?,
        toml::Value::Array(list) if part == "length" && rest.is_none() => return Some(list.len().to_string()),
        toml::Value::Array(list) => {
            let is_named = |entry: &&toml::Value| entry.get("name").and_then(toml::Value::as_str) == Some(part);
            list.iter().find(is_named).or_else(|| list.get(part.parse::<usize>().ok()?))?
        }
        _ => return None,
    };
    match (rest, value) {
        (Some(rest), _) => value_of(value, rest),
        (None, toml::Value::Integer(number)) => Some(number.to_string()),
        (None, toml::Value::Float(number)) => Some(number.to_string()),
        // A version, with a comparison before it.
        (None, toml::Value::String(version)) => Some(version.trim_start_matches(['>', '=']).to_owned()),
        _ => None,
    }
}

impl Image {
    fn new(job: &str, camera: &str, settings: &[&str]) -> Self {
        let (mut sets, mut frames) = (Vec::new(), toml::Value::Array(vec![]));
        for pair in settings.chunks(2) {
            match pair {
                ["--spp", value] => sets.push(format!("render.spp={value}")),
                ["--set", set] => sets.push((*set).to_owned()),
                ["--frames", range] => {
                    let ends = range.split("..").map(|end| toml::Value::Integer(end.parse().expect("a frame")));
                    frames = toml::Value::Array(ends.collect());
                }
                other => panic!("{GALLERY}: unknown setting {other:?}"),
            }
        }
        let mut keys = keys_of(job, &sets);
        let cameras = keys["cameras"].as_array().expect("cameras");
        let is_this = |entry: &&toml::Value| entry["name"].as_str() == Some(camera);
        let own = cameras.iter().find(is_this).unwrap_or_else(|| panic!("{job}: no camera {camera}")).clone();
        keys.insert("camera".to_owned(), own);
        keys.insert("frames".to_owned(), frames);
        let keys = toml::Value::Table(keys);
        let is_changed = sets.iter().any(|set| set.starts_with("render.spp="));
        let shipped = if is_changed { toml::Value::Table(keys_of(job, &[])) } else { keys.clone() };
        let spp = format!("cameras.{camera}.render.spp");
        let job_spp = value_of(&shipped, &spp).unwrap_or_else(|| panic!("{job} states no {spp}"));
        Self { job: job.to_owned(), keys, job_spp }
    }

    fn spp(&self) -> String {
        value_of(&self.keys, "camera.render.spp").expect("samples per pixel")
    }
}

/// Images by name.
type Gallery = BTreeMap<String, Image>;

/// The images that a page shows.
fn gallery(page: &str) -> Gallery {
    let script = text_of(GALLERY).expect("the gallery");
    let lists: Vec<&str> =
        script.split("<<'END'\n").skip(1).map(|list| list.split("\nEND").next().expect("a list")).collect();
    let [rendered, inspected] = lists[..] else { panic!("{GALLERY}: {} lists", lists.len()) };
    let words = |list: &str, name: &str| -> Option<Vec<String>> {
        let mut lines = list.lines().map(|line| line.split_whitespace().map(str::to_owned).collect::<Vec<_>>());
        lines.find(|words| words[0] == name)
    };
    let image = |name: String| {
        let source = words(inspected, &name).map_or_else(|| name.clone(), |words| words[1].clone());
        let words = words(rendered, &source).unwrap_or_else(|| panic!("{name} is not in {GALLERY}"));
        let words: Vec<&str> = words.iter().map(String::as_str).collect();
        (name, Image::new(words[1], words[2], &words[3..]))
    };
    image_names(page).into_iter().map(image).collect()
}

/// Names of the images that a text shows.
fn image_names(text: &str) -> Vec<String> {
    let files = text.split("pictures/").skip(1).filter_map(|rest| rest.split_once(')'));
    let images = files.filter_map(|(file, _)| file.strip_suffix(".jpg").or_else(|| file.strip_suffix(".png")));
    images.map(str::to_owned).collect()
}

/// A text whose numbers are digits.
fn digits(text: &str) -> String {
    let pieces = text.split_inclusive(|c: char| !c.is_alphanumeric()).map(|piece| {
        let word = piece.trim_end_matches(|c: char| !c.is_alphanumeric());
        match WORDS.iter().position(|number| number.eq_ignore_ascii_case(word)) {
            Some(at) => format!("{}{}", at + 2, &piece[word.len()..]),
            None => piece.to_owned(),
        }
    });
    pieces.collect()
}

/// A page in which the comments of a block of commands, without numbers that their commands contain, stand in place of the block.
fn without_commands(page: &str) -> String {
    let mut is_block = false;
    let mut remaining = String::new();
    for line in page.lines() {
        let is_fence = line.starts_with("```");
        is_block ^= is_fence;
        if !is_block && !is_fence {
            remaining.extend([line, "\n"]);
        } else if let Some((command, comment)) = line.split_once("# ") {
            let (known, comment) = (numbers(command), digits(comment));
            numbers_in_order(&comment)
                .filter(|number| !known.contains(number))
                .for_each(|number| remaining.extend([number, " "]));
        }
    }
    remaining
}

/// Replaces the keys of an expression by their values.
fn with_values(expression: &str, keys: Option<&toml::Value>) -> Result<String, String> {
    let is_part = |c: char| c.is_ascii_alphanumeric() || "_-./:".contains(c);
    let words = expression.split(' ').map(|word| {
        let key = word.trim_matches(['(', ')']);
        if !(key.starts_with(|c: char| c.is_ascii_alphabetic()) && key.contains('.') && key.chars().all(is_part)) {
            return Ok(word.to_owned());
        }
        let value = match key.split_once(':') {
            Some((file, key)) => {
                let table: toml::Table = text_of(file)?.parse().map_err(|cause| format!("{file}: {cause}"))?;
                value_of(&toml::Value::Table(table), key)
            }
            None => value_of(keys.ok_or_else(|| format!("{key}: the paragraph shows no image"))?, key),
        };
        Ok(word.replace(key, &value.ok_or_else(|| format!("{key} is not stated or is no number"))?))
    });
    Ok(words.collect::<Result<Vec<_>, String>>()?.join(" "))
}

/// Evaluates a check for each of the images, or without any, and returns its value.
fn checked<'a>(text: &'a str, images: &[&Image]) -> Result<&'a str, String> {
    let (value, expression) =
        text.trim().split_once(" = ").ok_or_else(|| format!("{text}: expected VALUE = EXPRESSION"))?;
    if let Some((file, quote)) = expression.split_once(": ") {
        let is_in_quote = numbers_in_order(&digits(quote)).any(|number| number == value);
        return match text_of(file)?.contains(quote) {
            true if is_in_quote => Ok(value),
            true => Err(format!("{text}: the text does not state {value}")),
            false => Err(format!("{text}: {file} does not contain this text")),
        };
    }
    let keys: Vec<_> =
        if images.is_empty() { vec![None] } else { images.iter().map(|image| Some(&image.keys)).collect() };
    for keys in keys {
        check(&format!("{value} = {}", with_values(expression, keys)?)).map_err(|cause| format!("{text}: {cause}"))?;
    }
    Ok(value)
}

/// Checks "N samples" or "N samples (job: M)" against the images, and returns the text without it.
fn without_samples(prose: &str, images: &[&Image]) -> Result<String, String> {
    let Some((before, after)) = prose.split_once(" samples").filter(|_| !images.is_empty()) else {
        return Ok(prose.to_owned());
    };
    let start = before.trim_end_matches(|c: char| !c.is_whitespace()).len();
    let (job, after) = match after.strip_prefix(" (job: ").and_then(|rest| rest.split_once(')')) {
        Some((job, after)) => (Some(job), after),
        None => (None, after),
    };
    let samples = &before[start..];
    for image in images {
        let (spp, shipped) = (image.spp(), &image.job_spp);
        let is_true = samples == spp && job.map_or(spp == *shipped, |job| job == shipped && spp != *shipped);
        if !is_true {
            return Err(format!("{samples} samples, job: {job:?}; the image has {spp}, {} has {shipped}", image.job));
        }
    }
    Ok(format!("{}{after}", &before[..start]))
}

/// Checks the numbers of a paragraph.
fn check_paragraph(paragraph: &str, images: &[&Image]) -> Result<(), String> {
    let (checks, prose) = cut(paragraph, "<!-- check:", "-->");
    let (_, prose) = cut(&prose, "`", "`");
    let (_, prose) = cut(&prose, "](", ")");
    let own: &[&Image] = if image_names(paragraph).is_empty() { &[] } else { images };
    let prose = without_samples(&digits(&prose), own)?;
    let stated: Vec<&str> = numbers_in_order(&prose).collect();
    let held = checks.iter().flat_map(|text| text.split(';')).map(|text| checked(text, images));
    let held = held.collect::<Result<Vec<_>, String>>()?;
    if stated == held { Ok(()) } else { Err(format!("it states the numbers {stated:?}, and its checks {held:?}")) }
}

/// Errors in the numbers of a page. A paragraph without an image is checked against all images of its section.
fn errors(page: &str, gallery: &Gallery) -> Vec<String> {
    let images = |text: &str| image_names(text).iter().map(|name| &gallery[name]).collect::<Vec<_>>();
    let mut errors = Vec::new();
    for section in without_commands(page).split("\n## ") {
        for paragraph in section.split("\n\n") {
            let own = images(paragraph);
            let images = if own.is_empty() { images(section) } else { own };
            errors.extend(check_paragraph(paragraph, &images).err().map(|error| format!("{error}:\n{paragraph}")));
        }
    }
    errors
}

#[test]
fn numbers_of_captions_have_a_source() {
    let page = text_of("docs/pictures.md").expect("the page");
    let gallery = gallery(&page);
    let errors = errors(&page, &gallery);
    assert!(errors.is_empty(), "docs/pictures.md:\n{}", errors.join("\n\n"));
    assert!(gallery.len() >= 25, "{} images", gallery.len());
    for paragraph in page.split("\n\n") {
        for name in image_names(paragraph) {
            let job = &gallery[&name].job;
            assert!(paragraph.contains(&format!("`{job}`")), "the caption of {name} does not name {job}");
        }
    }
}

/// Titles "N commands" count the commands of the block below; other numbers have a source.
#[test]
fn numbers_of_the_readme_have_a_source() {
    let page = text_of("README.md").expect("the page");
    let mut counted = 0;
    let mut rest = page.clone();
    for section in page.split("\n## ").skip(1) {
        let title = section.lines().next().expect("a title");
        let Some(count) = title.strip_suffix(" commands") else { continue };
        let (blocks, _) = cut(section, "```", "```");
        let commands = blocks[0].lines().skip(1).filter(|line| !line.starts_with("etendue=")).count();
        assert_eq!(digits(count), commands.to_string(), "README.md: {title}");
        rest = rest.replace(&format!("\n## {title}\n"), "\n## Commands\n");
        counted += 1;
    }
    assert_eq!(counted, 2, "README.md: titles with a number of commands");
    let errors = errors(&rest, &gallery(&page));
    assert!(errors.is_empty(), "README.md:\n{}", errors.join("\n\n"));
}

#[test]
fn wrong_captions_are_found() {
    let gallery = gallery("(pictures/night.jpg) (pictures/street.jpg) (pictures/beams.jpg)");
    let errors = |page: &str| errors(page, &gallery);
    let right = "![Night](pictures/night.jpg)\n**Night** (`scenes/street/night.toml`): 33 ms; eight times the gain of 1954; 192 samples (job: 64).\n\
        <!-- check: 33 = 1e3 * camera.sensor.exposure_s; 8 = camera.sensor.gain_dn_per_e / scenes/cameras/automotive.toml:sensor.gain_dn_per_e; \
        1954 = scenes/cameras/double-gauss.toml: a double Gauss of 1954 -->\n";
    assert_eq!(errors(right), Vec::<String>::new());
    let wrong = [
        // Captions.
        ("33 ms", "30 ms"),
        ("33 ms", "33 ms, 2 m"),
        ("eight times", "nine times"),
        ("192 samples", "200 samples"),
        ("(job: 64)", "(job: 32)"),
        (" (job: 64)", ""),
        // Captions with checks: the job has another value, states no such key, or the file has no such text.
        ("33", "30"),
        ("exposure_s", "exposure"),
        ("/ scenes", "+ scenes"),
        ("a double Gauss of", "a triplet of"),
        ("1954", "1955"),
        ("1954 = ", "1955 = "),
    ];
    for (from, to) in wrong {
        let errors = errors(&right.replace(from, to));
        assert_eq!(errors.len(), 1, "{from} as {to}: {errors:?}");
    }
    // A paragraph of a section holds for all of its images: the second has other pixels.
    let section = |image: &str| {
        format!(
            "## Size\n\n960 px.\n<!-- check: 960 = camera.sensor.width_px -->\n\n![](pictures/night.jpg) ![](pictures/{image}.jpg)\n"
        )
    };
    assert_eq!(errors(&section("street")).len(), 0, "{:?}", errors(&section("street")));
    assert_eq!(errors(&section("beams")).len(), 1, "{:?}", errors(&section("beams")));
    let comment = "```sh\nrun --level 5  # at most five, or 7\n```\n";
    assert_eq!(errors(comment).len(), 1, "{:?}", errors(comment));
    assert_eq!(errors(&format!("{comment}<!-- check: 7 = 3 + 4 -->\n")), Vec::<String>::new());
}
