//! The tasks of docs/cookbook and docs/tutorials, as written: the blocks of a page one after the other in a folder with only the shipped scenes, and
//! the output stated on the page. Tutorials share one folder.

use crate::support::root;
use std::collections::HashSet;
use std::path::Path;
use std::process::Command;
use tempfile::TempDir;

/// Pages of the cookbook and the number of their tasks.
const PAGES: [(&str, usize); 6] =
    [("rendering", 7), ("cameras", 8), ("lenses", 5), ("driving", 6), ("robots", 4), ("light", 5)];

/// One tutorial for each kind of user, in the order of their overview.
const TUTORIALS: [&str; 5] = ["driver-assistance", "cameras", "lighting", "robotics", "rendering"];

/// A task of a page: its commands, and lines that they print, in this order.
struct Task {
    title: String,
    commands: String,
    printed: Vec<String>,
}

fn page(folder: &str, name: &str) -> String {
    let path = root().join("docs").join(folder).join(name).with_extension("md");
    std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
}

/// Text between a line of three backticks with `kind` and the next.
fn block<'a>(text: &'a str, kind: &str) -> Option<&'a str> {
    let (_, from) = text.split_once(&format!("```{kind}\n"))?;
    Some(from.split_once("```").expect("the block ends").0)
}

fn tasks(page: &str) -> Vec<Task> {
    let task = |text: &str| {
        let title = text.lines().next().expect("a title").to_owned();
        assert!(
            ["sh", "text"].iter().all(|kind| text.matches(&format!("```{kind}\n")).count() <= 1),
            "{title}: one block of a kind"
        );
        Task {
            title,
            commands: block(text, "sh").expect("commands").to_owned(),
            printed: block(text, "text").map_or(vec![], |lines| lines.lines().map(str::to_owned).collect()),
        }
    };
    page.split("\n## ").skip(1).map(task).collect()
}

/// Runs a task in a folder in which the program is called `etendue`.
fn run(task: &Task, folder: &Path) {
    let program = Path::new(env!("CARGO_BIN_EXE_etendue")).parent().expect("a folder");
    let paths = format!("{}:{}", program.display(), std::env::var("PATH").expect("a search path"));
    let mut shell = Command::new("bash");
    let output = shell.args(["-euo", "pipefail", "-c", &task.commands]).current_dir(folder).env("PATH", paths).output();
    let output = output.expect("bash runs");
    let (out, err) = (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    assert!(output.status.success(), "{}: {}\n{err}", task.title, output.status);
    let mut lines = out.lines();
    for expected_line in &task.printed {
        let is_printed = lines.any(|line| line.trim_end() == expected_line);
        assert!(is_printed, "{}: it does not print, or not in this place:\n{expected_line}\nbut\n{out}", task.title);
    }
}

fn folder_with_scenes() -> TempDir {
    let place = tempfile::tempdir().expect("a temporary folder");
    std::os::unix::fs::symlink(root().join("scenes"), place.path().join("scenes")).expect("a link");
    place
}

fn run_page(folder: &str, name: &str) {
    run_page_in(&folder_with_scenes(), folder, name);
}

fn run_page_in(place: &TempDir, folder: &str, name: &str) {
    for task in tasks(&page(folder, name)) {
        run(&task, place.path());
    }
}

/// Numbers of a text in their order: digits with an optional fraction, without those that belong to a word.
pub(crate) fn numbers_in_order(text: &str) -> impl Iterator<Item = &str> {
    let words = text.split(|c: char| !(c.is_alphanumeric() || "._-".contains(c)));
    let numbers = words.flat_map(|word| word.split("..")).map(|word| word.trim_matches(|c| ".-_".contains(c)));
    numbers.filter(|word| word.starts_with(|c: char| c.is_ascii_digit()) && word.parse::<f64>().is_ok())
}

pub(crate) fn numbers(text: &str) -> HashSet<&str> {
    numbers_in_order(text).collect()
}

/// Text between two marks, wherever they occur, and the rest of the text.
pub(crate) fn cut<'a>(text: &'a str, from: &str, to: &str) -> (Vec<&'a str>, String) {
    let (mut inside, mut outside) = (Vec::new(), String::new());
    let mut rest = text;
    while let Some((before, after)) = rest.split_once(from) {
        let (within, after) = after.split_once(to).expect("the mark ends");
        inside.push(within);
        outside.extend([before, " "]);
        rest = after;
    }
    (inside, outside + rest)
}

/// Evaluates a check of a page, `VALUE = EXPRESSION`, with awk, and compares it at the value's digits.
pub(crate) fn check(text: &str) -> Result<&str, String> {
    let (value, expression) =
        text.trim().split_once(" = ").ok_or_else(|| format!("{text}: expected VALUE = EXPRESSION"))?;
    let digits = value.split_once('.').map_or(0, |(_, fraction)| fraction.len());
    let program = format!("BEGIN {{ printf \"%.{digits}f\", {expression} }}");
    let awk = Command::new("awk").arg(program).output().map_err(|cause| format!("awk: {cause}"))?;
    let actual = String::from_utf8_lossy(&awk.stdout).into_owned();
    if actual == value { Ok(value) } else { Err(format!("{text}: the expression is {actual}")) }
}

/// Numbers of a page's prose that neither its commands, nor the output stated on it, nor a check (`<!-- check: VALUE = EXPRESSION -->`) contain.
fn unsupported_numbers(page: &str) -> Result<Vec<String>, String> {
    let (blocks, prose) = cut(page, "```", "```");
    let (checks, prose) = cut(&prose, "<!-- check:", "-->");
    let (_, prose) = cut(&prose, "`", "`");
    let (_, prose) = cut(&prose, "](", ")");
    // The number of a standard follows its publisher's name.
    let standards = ["ISO ", "IEEE ", "EMVA ", "CIE "];
    let prose = standards.iter().fold(prose, |prose, name| prose.replace(name, "standard-"));
    let blocks = blocks.join("\n").replace(['x', '×'], " ");
    let mut supported = numbers(&blocks);
    for text in &checks {
        supported.insert(check(text)?);
    }
    Ok(numbers(&prose).into_iter().filter(|number| !supported.contains(number)).map(str::to_owned).collect())
}

#[test]
fn numbers_of_the_prose_are_printed_or_checked() {
    let pages =
        PAGES.iter().map(|(name, _)| ("cookbook", *name)).chain(TUTORIALS.iter().map(|name| ("tutorials", *name)));
    for (folder, name) in pages {
        let unsupported =
            unsupported_numbers(&page(folder, name)).unwrap_or_else(|error| panic!("{folder}/{name}: {error}"));
        assert!(unsupported.is_empty(), "docs/{folder}/{name}.md states {unsupported:?}, which no command prints");
    }
    let sample = "It is 12.5 lx by CIE 1931 at 0.35.\n```sh\nrun --level=12.5\n```\n";
    assert_eq!(unsupported_numbers(sample), Ok(vec!["0.35".to_owned()]));
    assert_eq!(unsupported_numbers(&format!("{sample}<!-- check: 0.35 = 0.7 / 2 -->")), Ok(vec![]));
    assert!(unsupported_numbers(&format!("{sample}<!-- check: 0.35 = 0.8 / 2 -->")).is_err());
}

/// Tutorials can be followed in one folder, as no two pages write a file of the same name, and each alone: results of earlier pages are moved away.
#[test]
fn tutorials() {
    let (place, earlier) = (folder_with_scenes(), tempfile::tempdir().expect("a temporary folder"));
    for name in TUTORIALS {
        run_page_in(&place, "tutorials", name);
        for entry in std::fs::read_dir(place.path()).expect("a folder") {
            let file = entry.expect("an entry").file_name();
            let stored = earlier.path().join(&file);
            assert!(!stored.exists(), "{name}: {} is also a result of an earlier page", file.display());
            if file != "scenes" {
                std::fs::rename(place.path().join(&file), stored).expect("moved");
            }
        }
    }
}

#[test]
fn rendering() {
    run_page("cookbook", "rendering");
}

#[test]
fn cameras() {
    run_page("cookbook", "cameras");
}

#[test]
fn lenses() {
    run_page("cookbook", "lenses");
}

#[test]
fn driving() {
    run_page("cookbook", "driving");
}

#[test]
fn robots() {
    run_page("cookbook", "robots");
}

#[test]
fn light() {
    run_page("cookbook", "light");
}

/// Pages of a folder except its first, by name.
fn names(folder: &str) -> Vec<String> {
    let entries = std::fs::read_dir(root().join("docs").join(folder)).expect("a folder");
    let files = entries.map(|entry| entry.expect("an entry").file_name().into_string().expect("UTF-8"));
    let mut names: Vec<String> = files.filter(|name| name != "README.md").collect();
    names.sort();
    names
}

fn files<'a>(pages: impl Iterator<Item = &'a str>) -> Vec<String> {
    let mut files: Vec<String> = pages.map(|name| format!("{name}.md")).collect();
    files.sort();
    files
}

/// All pages of the folders are listed above, and their first pages list them all.
#[test]
fn the_book_has_all_its_tasks() {
    assert_eq!(names("cookbook"), files(PAGES.iter().map(|(name, _)| *name)));
    assert_eq!(names("tutorials"), files(TUTORIALS.into_iter()));
    let (overview, tutorials) = (page("cookbook", "README"), page("tutorials", "README"));
    for (name, count) in PAGES {
        assert!(overview.contains(&format!("]({name}.md)")), "{name}");
        assert_eq!(tasks(&page("cookbook", name)).len(), count, "{name}");
    }
    let places = TUTORIALS.map(|name| tutorials.find(&format!("]({name}.md)")).expect(name));
    assert!(places.is_sorted(), "{tutorials}");
    let contents = std::fs::read_to_string(root().join("docs/SUMMARY.md")).expect("the table of contents");
    for name in TUTORIALS {
        let text = page("tutorials", name);
        let title = text.lines().next().and_then(|line| line.strip_prefix("# ")).expect("a title");
        assert!(contents.contains(&format!("[{title}](tutorials/{name}.md)")), "{title}");
    }
    assert_eq!(PAGES.iter().map(|(_, count)| count).sum::<usize>(), 35);
    assert!(overview.contains("Thirty-five tasks"), "{overview}");
}
