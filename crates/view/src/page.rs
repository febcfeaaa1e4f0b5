//! The page: a folder of `index.html` and `data`, or one file with the data in its scripts.
//!
//! Base64 encoding (RFC 4648, section 4).

use std::path::{Path, PathBuf};
use std::{fmt::Write as _, fs, io::Read as _};

use etendue::page::{PAGE_GENERATOR, html_page};
use etendue::{Error, ErrorCode, ExistingFiles, OutputFolder, write_file};
use serde_json::Value;

const STYLE: &str = include_str!("../page/view.css");
const BODY_HTML: &str = include_str!("../page/view.html");
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

/// A page during writing.
pub(crate) enum Page {
    /// Chunks are scripts next to the page, which loads them when they are shown.
    Folder(OutputFolder, Vec<String>),
    /// Chunks are within the page.
    File(PathBuf, ExistingFiles, String),
}

impl Page {
    /// Opens a folder, or a file if the name ends in `.html`; refuses immediately a path that exists and may not be replaced.
    pub(crate) fn open(path: &Path, existing: ExistingFiles) -> Result<Self, Error> {
        if path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("html")) {
            if existing == ExistingFiles::Refuse && path.symlink_metadata().is_ok() {
                return Err(Error::coded(
                    ErrorCode::OutputExists,
                    format!(
                        "{}: already exists; choose another name, or allow overwriting with `overwrite`",
                        path.display()
                    ),
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

    /// Writes the page and returns its path.
    pub(crate) fn finish(self, title: &str, facts: &Value) -> Result<PathBuf, Error> {
        match self {
            Self::Folder(mut folder, names) => {
                folder.write(INDEX, html(title, facts, "").as_bytes()).map_err(Error::run)?;
                let index = folder.path().join(INDEX);
                let idle = idle(&folder.path().join(DATA), &names);
                // An earlier page here may have had more layers.
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

/// True if the page in a folder was made by this program.
pub(crate) fn is_ours(folder: &Path) -> bool {
    let mut head = Vec::new();
    let read = fs::File::open(folder.join(INDEX)).and_then(|file| file.take(1024).read_to_end(&mut head));
    read.is_ok() && String::from_utf8_lossy(&head).contains(PAGE_GENERATOR)
}

/// Chunks of an earlier page in the folder that this one does not have.
fn idle(data: &Path, names: &[String]) -> Vec<String> {
    let entries = fs::read_dir(data).into_iter().flatten().flatten();
    let existing_names = entries.filter_map(|entry| entry.file_name().into_string().ok());
    let is_chunk = |name: &String| {
        let number = name.strip_suffix(".js").unwrap_or("");
        number.len() >= 4 && number.bytes().all(|digit| digit.is_ascii_digit())
    };
    existing_names.filter(|name| is_chunk(name) && !names.contains(name)).map(|name| format!("{DATA}/{name}")).collect()
}

fn html(title: &str, facts: &Value, chunks: &str) -> String {
    let script = SCRIPTS.concat();
    let facts = in_script(facts);
    let body = format!(
        "{BODY_HTML}{chunks}<script>\n\"use strict\";\n(() => {{\nconst PAGE = {facts};\n{script}{START}}})();\n</script>\n"
    );
    html_page(title, STYLE, &body)
}

/// Escapes JSON for a script, whatever names it contains.
fn in_script(value: &Value) -> String {
    value.to_string().replace('<', "\\u003c").replace('\u{2028}', "\\u2028").replace('\u{2029}', "\\u2029")
}

const ALPHABET: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

/// Encodes bytes in base64, with padding.
pub(crate) fn encoded(bytes: &[u8]) -> String {
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for group in bytes.chunks(3) {
        let bits = group.iter().enumerate().fold(0_u32, |bits, (i, byte)| bits | u32::from(*byte) << (16 - 8 * i));
        for place in 0..4 {
            let character = ALPHABET[(bits >> (18 - 6 * place)) as usize & 63];
            text.push(if place <= group.len() { char::from(character) } else { '=' });
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn no_name_ends_a_script_or_begins_an_element() {
        let script_like = json!({ "name": "</script><b>\u{2028}" });
        let script = in_script(&script_like);
        assert_eq!(script, "{\"name\":\"\\u003c/script>\\u003cb>\\u2028\"}");
        assert_eq!(serde_json::from_str::<Value>(&script).expect("JSON"), script_like);
    }

    #[test]
    fn the_examples_of_the_standard() {
        let examples =
            [("", ""), ("f", "Zg=="), ("fo", "Zm8="), ("foo", "Zm9v"), ("foob", "Zm9vYg=="), ("foobar", "Zm9vYmFy")];
        for (bytes, text) in examples {
            assert_eq!(encoded(bytes.as_bytes()), text);
        }
        assert_eq!(encoded(&[0xff, 0xfb, 0xf0]), "//vw");
    }
}
