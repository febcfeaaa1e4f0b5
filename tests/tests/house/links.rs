//! Every link from a page to another, or to a place on one, leads there.

use crate::{files, root};
use std::collections::HashSet;
use std::path::{Component, Path, PathBuf};

/// The lines of a page outside of its blocks of code.
fn lines(page: &str) -> impl Iterator<Item = &str> {
    let mut code = false;
    page.lines().filter(move |line| {
        let fence = line.trim_start().starts_with("```");
        code ^= fence;
        !code && !fence
    })
}

/// A line without its spans of code.
fn without_code(line: &str) -> String {
    line.split('`').step_by(2).collect()
}

/// Where the links of a page lead, but those out of the project.
fn links(page: &str) -> Vec<String> {
    let text = lines(page).map(without_code).collect::<Vec<_>>().join("\n");
    let targets = text.split("](").skip(1).filter_map(|rest| rest.split(')').next());
    targets.filter(|link| !link.contains("://") && !link.starts_with("mailto:")).map(str::to_owned).collect()
}

/// The anchor that a heading has by itself.
fn slug(heading: &str) -> String {
    let mut text = String::new();
    let mut tag = false;
    for c in heading.chars() {
        match c {
            '<' => tag = true,
            '>' => tag = false,
            _ if tag => {}
            ' ' => text.push('-'),
            c if c.is_alphanumeric() || c == '-' || c == '_' => text.extend(c.to_lowercase()),
            _ => {}
        }
    }
    text
}

/// The places on a page that have an anchor.
fn anchors(page: &str) -> HashSet<String> {
    let headings = lines(page).filter(|line| line.starts_with('#'));
    let own = headings.map(|line| slug(line.trim_start_matches('#').trim()));
    let explicit = page.split("<a id=\"").skip(1).filter_map(|rest| rest.split('"').next()).map(str::to_owned);
    own.chain(explicit).collect()
}

/// The path without `..`.
fn plain(path: &Path) -> PathBuf {
    let mut plain = PathBuf::new();
    for part in path.components() {
        match part {
            Component::ParentDir => drop(plain.pop()),
            Component::CurDir => {}
            part => plain.push(part),
        }
    }
    plain
}

/// Why a page's link leads nowhere, if so.
fn link_error(page: &str, link: &str) -> Option<String> {
    let (path, anchor) = link.split_once('#').unwrap_or((link, ""));
    let target = match path {
        "" => root().join(page),
        path => plain(&root().join(page).parent()?.join(path)),
    };
    if !target.exists() {
        return Some(format!("{page}: {link}: no such file"));
    }
    let known = anchor.is_empty() || std::fs::read_to_string(&target).is_ok_and(|text| anchors(&text).contains(anchor));
    (!known).then(|| format!("{page}: {link}: no such place on the page"))
}

#[test]
fn every_link_leads_somewhere() {
    let mut violations = Vec::new();
    let mut count = 0;
    for page in files(&[".md"]) {
        let Ok(text) = std::fs::read_to_string(root().join(&page)) else { continue };
        let links = links(&text);
        count += links.len();
        violations.extend(links.iter().filter_map(|link| link_error(&page, link)));
    }
    assert!(count > 200, "{count} links");
    assert!(violations.is_empty(), "{violations:#?}");
}

/// The book (`just book`) lists every page of docs once. The pages of docs/evidence are outside the book.
#[test]
fn the_book_lists_every_page() {
    let summary = std::fs::read_to_string(root().join("docs/SUMMARY.md")).expect("the book's summary");
    let mut listed: Vec<String> = links(&summary).iter().map(|link| format!("docs/{link}")).collect();
    let mut pages = files(&[".md"]);
    let is_of_book =
        |page: &String| page.starts_with("docs/") && !page.starts_with("docs/evidence/") && page != "docs/SUMMARY.md";
    pages.retain(|page| is_of_book(page) && root().join(page).exists());
    listed.sort();
    pages.sort();
    assert_eq!(listed, pages);
}

#[test]
fn pages_that_code_names_are_there() {
    let is_part = |c: char| c.is_ascii_alphanumeric() || "/_-.".contains(c);
    let mut violations = Vec::new();
    for file in files(&[".rs", ".toml", ".py", ".md"]) {
        let Ok(text) = std::fs::read_to_string(root().join(&file)) else { continue };
        let words = text.split(|c| !is_part(c)).map(|word| word.trim_end_matches('.'));
        let pages = words.filter(|word| word.starts_with("docs/") && word.ends_with(".md"));
        violations.extend(pages.filter(|page| !root().join(page).exists()).map(|page| format!("{file}: {page}")));
    }
    assert!(violations.is_empty(), "{violations:#?}");
}

#[test]
fn a_link_to_nowhere_is_found() {
    assert_eq!(slug("<a id=\"x\"></a>Presets of `[[materials]]`"), "presets-of-materials");
    assert_eq!(links("[a](b.md#c), `[[x]](y)`, [`[d]`](#e)\n```\n[f](g)\n```\n"), ["b.md#c", "#e"]);
    assert!(link_error("README.md", "docs/scene-format.md#units").is_none());
    assert!(link_error("README.md", "docs/scene-format.md#nowhere").is_some());
    assert!(link_error("docs/format/job.md", "../nothing.md").is_some());
}
