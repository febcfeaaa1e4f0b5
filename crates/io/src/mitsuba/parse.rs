//! XML to elements.

use std::cell::Cell;
use std::collections::{BTreeSet, HashMap};
use std::path::{Path, PathBuf};
use std::rc::Rc;

use etendue_scene::limits;
use roxmltree::{Document, Node};

use super::element::{MitsubaElement, MitsubaPlace};
use super::lines::Lines;
use super::names::{TAGS, modern, shortened};
use crate::source::{decode_text, read_description_bytes};
use crate::{Error, Sandbox};

/// Files that include one another.
const MAX_INCLUDES: usize = 16;
/// Elements within one another.
const MAX_DEPTH: usize = 64;
/// Folders that `<path>` leads to: every file is sought in all of them.
const MAX_FOLDERS: usize = 64;
/// Bytes of a parameter's name.
const MAX_NAME: usize = 64;

/// What is known while files are read.
pub(super) struct Reading<'a> {
    /// Where included files are sought behind the folder of the file that includes them: that of the first file, then those of `<path>`.
    folders: Vec<PathBuf>,
    sandbox: &'a Sandbox,
    /// Of all files so far.
    bytes: u64,
    /// Parameters and their values.
    defaults: HashMap<String, String>,
    /// How long their names are.
    lengths: BTreeSet<usize>,
    count: usize,
}

/// A file that is being read.
struct OpenFile {
    path: Rc<Path>,
    lines: Lines,
    /// Whether names are of a version before 2.
    is_old: bool,
    /// How many files include it.
    includes: usize,
}

impl OpenFile {
    fn fault(&self, node: &Node<'_, '_>, what: String) -> Error {
        Error::at(&self.path, self.lines.line(node.range().start), what)
    }
}

impl<'a> Reading<'a> {
    pub(super) fn new(file: &Path, sandbox: &'a Sandbox) -> Self {
        let folder = file.parent().unwrap_or(Path::new("")).to_owned();
        let (defaults, lengths) = (HashMap::new(), BTreeSet::new());
        Self { folders: vec![folder], sandbox, bytes: 0, defaults, lengths, count: 0 }
    }

    /// The root of the first file.
    pub(super) fn root(&mut self, file: &Path) -> Result<MitsubaElement, Error> {
        let root = self.file(file, 0)?;
        match root.tag {
            "scene" => Ok(root),
            tag => Err(root.fault(format!("<{tag}> where a whole scene is expected: a file whose root is <scene>"))),
        }
    }

    fn file(&mut self, file: &Path, includes: usize) -> Result<MitsubaElement, Error> {
        let bytes = read_description_bytes(file, "scene")?;
        self.bytes += bytes.len() as u64;
        limits::DESCRIPTION.check_unpacked(self.bytes).map_err(|told| Error::new(file, told))?;
        let text = decode_text(file, &bytes)?;
        let document = Document::parse(text).map_err(|e| {
            let told = format!("no well-formed XML: {}", shortened(&e.to_string()));
            Error::at(file, e.pos().row as usize, told)
        })?;
        let root = document.root_element();
        let mut open = OpenFile { path: file.into(), lines: Lines::of(text), is_old: false, includes };
        let version = root.attribute("version").ok_or_else(|| {
            open.fault(&root, "no \"version\" of the root element: no scene of Mitsuba 3, which has it".to_owned())
        })?;
        let major = version.split('.').next().and_then(|major| major.trim().parse::<u32>().ok());
        open.is_old = match major {
            Some(major @ 0..=3) => major < 2,
            _ => {
                let told = format!("version \"{}\"; expected one up to 3, as \"3.0.0\"", shortened(version));
                return Err(open.fault(&root, told));
            }
        };
        self.element(&root, &open, 0)
    }

    fn element(&mut self, node: &Node<'_, '_>, file: &OpenFile, depth: usize) -> Result<MitsubaElement, Error> {
        if depth >= MAX_DEPTH {
            return Err(file.fault(node, format!("elements stand more than {MAX_DEPTH} deep in one another")));
        }
        let word = match node.tag_name().name() {
            "lookAt" => "lookat",
            word => word,
        };
        let Some(&tag) = TAGS.iter().find(|tag| **tag == word) else {
            return Err(file.fault(node, format!("<{}> is no element of Mitsuba's scenes", shortened(word))));
        };
        let attributes = node
            .attributes()
            .map(|attribute| {
                let value = self.with_parameters(attribute.value()).map_err(|told| file.fault(node, told))?;
                let is_parameter = attribute.name() == "name" && !matches!(tag, "default" | "alias" | "include");
                let value = if file.is_old && is_parameter { modern(&value) } else { value };
                Ok((attribute.name().into(), value.into()))
            })
            .collect::<Result<Vec<_>, Error>>()?;
        let place = MitsubaPlace { file: file.path.clone(), line: file.lines.line(node.range().start) };
        let number = self.count;
        self.count += 1;
        let mut element =
            MitsubaElement { tag, attributes, children: Vec::new(), place, number, used: Cell::new(false) };
        for child in node.children() {
            if child.is_element() {
                self.child(&child, file, depth, &mut element.children)?;
            } else if child.is_text() && child.text().is_some_and(|text| !text.trim().is_empty()) {
                return Err(file.fault(&child, format!("text within <{tag}>; expected elements alone")));
            }
        }
        if file.is_old && tag == "bsdf" && element.kind() == "diffuse" {
            element.children.iter_mut().for_each(rename_reflectance);
        }
        Ok(element)
    }

    /// Puts what an element within another becomes behind its `siblings`.
    fn child(
        &mut self,
        node: &Node<'_, '_>,
        file: &OpenFile,
        depth: usize,
        siblings: &mut Vec<MitsubaElement>,
    ) -> Result<(), Error> {
        let element = self.element(node, file, depth + 1)?;
        let needed = |name: &str| {
            let told = || element.fault(format!("<{}> without \"{name}\"", element.tag));
            element.attribute(name).map(str::to_owned).ok_or_else(told)
        };
        match element.tag {
            "default" => {
                let (name, value) = (needed("name")?, needed("value")?);
                if name.is_empty() {
                    return Err(element.fault("<default> without a name"));
                }
                if name.len() > MAX_NAME {
                    let told = format!("<default> with a name of {} bytes; expected {MAX_NAME} at most", name.len());
                    return Err(element.fault(told));
                }
                self.lengths.insert(name.len());
                self.defaults.entry(name).or_insert(value);
            }
            "include" => {
                let included = self.included(&needed("filename")?, &element, file)?;
                match included.tag {
                    "scene" => siblings.extend(included.children),
                    _ => siblings.push(included),
                }
            }
            tag => {
                if tag == "path" {
                    if self.folders.len() > MAX_FOLDERS {
                        return Err(element.fault(format!("more than {MAX_FOLDERS} <path>; expected fewer folders")));
                    }
                    self.folders.push(beside(&file.path).join(needed("value")?));
                }
                siblings.push(element);
            }
        }
        Ok(())
    }

    fn included(&mut self, name: &str, at: &MitsubaElement, file: &OpenFile) -> Result<MitsubaElement, Error> {
        let sought = || std::iter::once(beside(&file.path)).chain(self.folders.iter().map(PathBuf::as_path));
        let path = sought().map(|folder| folder.join(name)).find(|path| path.is_file());
        let path = path.unwrap_or_else(|| self.folders[0].join(name));
        self.sandbox.check(&path).map_err(|why| at.fault(format!("<include filename=\"{name}\">: {why}")))?;
        if file.includes + 1 >= MAX_INCLUDES {
            let told = format!("files include one another more than {MAX_INCLUDES} deep; include less, or each once");
            return Err(at.fault(told));
        }
        self.file(&path, file.includes + 1)
    }

    /// A value with the parameters that it names (`$spp`) in their places, the longest names first.
    fn with_parameters(&mut self, value: &str) -> Result<String, String> {
        let mut made = String::new();
        let mut rest = value;
        while let Some((before, after)) = rest.split_once('$') {
            made.push_str(before);
            let mut names = self.lengths.iter().rev().filter_map(|length| after.get(..*length));
            let Some((name, value)) = names.find_map(|name| self.defaults.get_key_value(name)) else {
                let word: String = after.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect();
                let word = shortened(&word);
                return Err(format!("no <default name=\"{word}\" …> stands before \"${word}\": add it, with a value"));
            };
            made.push_str(value);
            rest = &after[name.len()..];
            // What parameters of parameters make counts as text that is read.
            self.bytes += value.len().max(1) as u64;
            limits::DESCRIPTION.check_unpacked(self.bytes)?;
        }
        made.push_str(rest);
        Ok(made)
    }
}

/// The folder of a file.
fn beside(file: &Path) -> &Path {
    file.parent().unwrap_or(Path::new(""))
}

/// What colours a `diffuse` of a version before 2, by its name of today.
fn rename_reflectance(parameter: &mut MitsubaElement) {
    let names =
        parameter.attributes.iter_mut().filter(|(name, value)| &**name == "name" && &**value == "diffuse_reflectance");
    names.for_each(|(_, value)| *value = "reflectance".into());
}
