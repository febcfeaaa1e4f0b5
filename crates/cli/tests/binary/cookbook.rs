//! The tasks of docs/cookbook and docs/tutorials, as written: the blocks of a page one after the other in a folder with only the shipped scenes, and
//! the output stated on the page.

use crate::support::root;
use std::path::Path;
use std::process::Command;

/// Pages of the cookbook and the number of their tasks.
const PAGES: [(&str, usize); 6] =
    [("rendering", 7), ("cameras", 8), ("lenses", 5), ("driving", 6), ("robots", 4), ("light", 5)];

/// One tutorial for each kind of user.
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
    let ran = shell.args(["-euo", "pipefail", "-c", &task.commands]).current_dir(folder).env("PATH", paths).output();
    let ran = ran.expect("bash runs");
    let (out, err) = (String::from_utf8_lossy(&ran.stdout), String::from_utf8_lossy(&ran.stderr));
    assert!(ran.status.success(), "{}: {}\n{err}", task.title, ran.status);
    let mut lines = out.lines();
    for wanted in &task.printed {
        let found = lines.any(|line| line.trim_end() == wanted);
        assert!(found, "{}: it does not print, or not in this place:\n{wanted}\nbut\n{out}", task.title);
    }
}

fn run_page(folder: &str, name: &str) {
    let place = tempfile::tempdir().expect("a temporary folder");
    std::os::unix::fs::symlink(root().join("scenes"), place.path().join("scenes")).expect("a link");
    for task in tasks(&page(folder, name)) {
        run(&task, place.path());
    }
}

#[test]
fn tutorials() {
    TUTORIALS.iter().for_each(|name| run_page("tutorials", name));
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
    assert!(TUTORIALS.iter().all(|name| tutorials.contains(&format!("]({name}.md)"))), "{tutorials}");
    assert_eq!(PAGES.iter().map(|(_, count)| count).sum::<usize>(), 35);
    assert!(overview.contains("Thirty-five tasks"), "{overview}");
}
