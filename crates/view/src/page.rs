//! Where the page goes: a folder of `index.html` and `data`, or one file.

use crate::html::in_script;
use etendue::page::{PAGE_GENERATOR, html_page};
use etendue::{Error, ErrorCode, Existing, OutputFolder, write_file};
use serde_json::Value;
use std::fmt::Write as _;
use std::fs;
use std::io::Read as _;
use std::path::{Path, PathBuf};

const STYLE: &str = include_str!("../page/view.css");
const BODY: &str = include_str!("../page/view.html");
const SCRIPTS: [&str; 7] = [
    include_str!("../page/chunks.js"),
    include_str!("../page/maps.js"),
    include_str!("../page/panes.js"),
    include_str!("../page/plots.js"),
    include_str!("../page/view.js"),
    include_str!("../page/tools.js"),
    include_str!("../page/probe.js"),
];
const START: &str = include_str!("../page/start.js");
const INDEX: &str = "index.html";
const DATA: &str = "data";

/// A page that is being written.
pub(crate) enum Page {
    /// Chunks are scripts beside the page, which loads them when they are shown.
    Folder(OutputFolder, Vec<String>),
    /// Chunks are within the page.
    File(PathBuf, Existing, String),
}

impl Page {
    /// Opens a folder, or a file where the name ends in `.html`; refuses at once what is there and may not be replaced.
    pub(crate) fn open(path: &Path, existing: Existing) -> Result<Self, Error> {
        if path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("html")) {
            if existing == Existing::Refuse && path.symlink_metadata().is_ok() {
                return Err(Error::coded(
                    ErrorCode::OutputExists,
                    format!("{}: already there; choose another name, or allow it with `overwrite`", path.display()),
                ));
            }
            return Ok(Self::File(path.to_path_buf(), existing, String::new()));
        }
        let folder = OutputFolder::open(path, existing).map_err(Error::input)?;
        folder.claim([INDEX]).map_err(Error::input)?;
        Ok(Self::Folder(folder, Vec::new()))
    }

    /// Adds the numbers of a layer, in base64.
    pub(crate) fn add(&mut self, id: &str, text: &str) -> Result<(), Error> {
        match self {
            Self::Folder(folder, names) => {
                let name = format!("{DATA}/{id}.js");
                folder.write(&name, format!("etendueData(\"{id}\",\"{text}\");\n").as_bytes()).map_err(Error::run)?;
                names.push(format!("{id}.js"));
            }
            Self::File(_, _, chunks) => {
                let written = writeln!(chunks, "<script type=\"text/plain\" id=\"data-{id}\">{text}</script>");
                written.map_err(Error::run)?;
            }
        }
        Ok(())
    }

    /// Writes the page, and answers with its name.
    pub(crate) fn finish(self, title: &str, facts: &Value) -> Result<PathBuf, Error> {
        match self {
            Self::Folder(mut folder, names) => {
                folder.write(INDEX, html(title, facts, "").as_bytes()).map_err(Error::run)?;
                let index = folder.path().join(INDEX);
                let idle = idle(&folder.path().join(DATA), &names);
                // A page that was here before may have had more layers.
                folder.remove(idle.iter().map(String::as_str)).map_err(Error::run)?;
                folder.commit().map_err(Error::run)?;
                Ok(index)
            }
            Self::File(path, existing, chunks) => {
                write_file(&path, html(title, facts, &chunks).as_bytes(), existing)?;
                Ok(path)
            }
        }
    }
}

/// Whether the page in a folder is one that this program made.
pub(crate) fn is_ours(folder: &Path) -> bool {
    let mut head = Vec::new();
    let read = fs::File::open(folder.join(INDEX)).and_then(|file| file.take(1024).read_to_end(&mut head));
    read.is_ok() && String::from_utf8_lossy(&head).contains(PAGE_GENERATOR)
}

/// Chunks of an earlier page of the folder that this one has not.
fn idle(data: &Path, names: &[String]) -> Vec<String> {
    let entries = fs::read_dir(data).into_iter().flatten().flatten();
    let there = entries.filter_map(|entry| entry.file_name().into_string().ok());
    let is_chunk = |name: &String| {
        let number = name.strip_suffix(".js").unwrap_or("");
        number.len() >= 4 && number.bytes().all(|digit| digit.is_ascii_digit())
    };
    there.filter(|name| is_chunk(name) && !names.contains(name)).map(|name| format!("{DATA}/{name}")).collect()
}

fn html(title: &str, facts: &Value, chunks: &str) -> String {
    let script = SCRIPTS.concat();
    let facts = in_script(facts);
    let body = format!(
        "{BODY}{chunks}<script>\n\"use strict\";\n(() => {{\nconst PAGE = {facts};\n{script}{START}}})();\n</script>\n"
    );
    html_page(title, STYLE, &body)
}
