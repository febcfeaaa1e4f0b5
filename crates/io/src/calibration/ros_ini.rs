//! ROS's INI form of a camera (`ost.txt`, `ost.ini` of camera_calibration).
//!
//! `[image]` with `width` and `height`, then `[NAME]` with `camera matrix`, `distortion`, `rectification` and `projection`, each followed by its numbers. The
//! text of a stereo pair holds both cameras one after the other.

use super::{TreeError, TreeResult};
use crate::tree::{NodeValue, TreeNode};

/// Most lines of a file, beyond that of any real one.
const MAX_LINES: usize = 10_000;

/// A camera with its name and the keys of the YAML form.
pub(super) struct IniCamera {
    pub(super) name: String,
    pub(super) root: TreeNode,
}

/// Section of a file.
struct Section {
    line: usize,
    name: String,
    values: Vec<Value>,
}

/// Name and the words on the lines after it.
struct Value {
    line: usize,
    name: String,
    words: Vec<String>,
}

/// Returns true if a text is of this form.
pub(super) fn is_ini(text: &str) -> bool {
    text.lines().map(str::trim).find(|line| is_content(line)) == Some("[image]")
}

fn is_content(line: &str) -> bool {
    !line.is_empty() && !line.starts_with('#')
}

/// Cameras of a file.
pub(super) fn parse(text: &str) -> TreeResult<Vec<IniCamera>> {
    let mut cameras = Vec::new();
    let mut image = Vec::new();
    for section in sections(text)? {
        let Section { line, name, values } = section;
        let entries = values.iter().map(|value| (key(&name, &value.name), value.node()));
        if name == "image" {
            image = entries.collect();
        } else if values.iter().any(|value| value.name == "camera matrix") {
            let all = std::mem::take(&mut image).into_iter().chain(entries).collect();
            cameras.push(IniCamera { root: TreeNode::new(line, NodeValue::Map(all)), name });
        }
    }
    if cameras.is_empty() {
        return Err(TreeError::at(0, "contains no camera; expected [image], and [NAME] with its camera matrix"));
    }
    Ok(cameras)
}

fn sections(text: &str) -> TreeResult<Vec<Section>> {
    let mut sections: Vec<Section> = Vec::new();
    let lines = text.lines().enumerate().map(|(i, line)| (i + 1, line.trim())).filter(|(_, line)| is_content(line));
    for (number, line) in lines {
        if number > MAX_LINES {
            return Err(TreeError::at(number, format!("more than {MAX_LINES} lines, which is not supported")));
        }
        if let Some(name) = line.strip_prefix('[').and_then(|line| line.strip_suffix(']')) {
            sections.push(Section { line: number, name: name.to_owned(), values: Vec::new() });
            continue;
        }
        let values = sections.last_mut().map(|section| &mut section.values);
        match values {
            Some(values) if line.starts_with(|c: char| c.is_alphabetic()) => {
                values.push(Value { line: number, name: line.to_owned(), words: Vec::new() });
            }
            Some(values) if !values.is_empty() => {
                let last = values.len() - 1;
                values[last].words.extend(line.split_whitespace().map(str::to_owned));
            }
            _ => return Err(TreeError::at(number, "found numbers; expected a name, such as \"camera matrix\"")),
        }
    }
    Ok(sections)
}

/// Key of the YAML form.
fn key(section: &str, name: &str) -> String {
    match (section, name) {
        ("image", _) => format!("image_{name}"),
        (_, "distortion") => "distortion_coefficients".to_owned(),
        (_, "camera matrix") => "camera_matrix".to_owned(),
        _ => name.to_owned(),
    }
}

impl Value {
    /// One word as a value, others as a list.
    fn node(&self) -> TreeNode {
        let scalar = |word: &String| NodeValue::Scalar(word.clone());
        let value = match &self.words[..] {
            [word] => scalar(word),
            words => NodeValue::List(words.iter().map(|word| TreeNode::new(self.line, scalar(word))).collect()),
        };
        TreeNode::new(self.line, value)
    }
}
