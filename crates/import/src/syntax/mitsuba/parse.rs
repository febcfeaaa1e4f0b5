//! Parser of XML into elements.

use std::{cell::Cell, path::Path, rc::Rc};

use etendue_io::source::{decode_text, read_description_bytes};
use etendue_io::{Error, Sandbox};
use etendue_scene::limits;
use roxmltree::{Document, Node};

use super::element::{Lines, MitsubaElement, MitsubaPlace, MitsubaScene};
use super::folders::Folders;
use super::parameters::{Parameters, TAGS, modern, shortened};

/// Maximum depth of included files.
const MAX_INCLUDES: usize = 16;
/// Maximum depth of elements.
const MAX_DEPTH: usize = 64;

/// State while files are read.
pub(super) struct MitsubaReader<'a> {
    folders: Folders,
    sandbox: &'a Sandbox,
    /// Bytes of all files so far.
    bytes: u64,
    parameters: Parameters,
    count: usize,
}

/// File being read.
struct OpenFile {
    path: Rc<Path>,
    lines: Lines,
    /// True if names are of a version before 2.
    is_old: bool,
    /// Depth of inclusion.
    includes: usize,
}

impl OpenFile {
    fn error(&self, node: &Node<'_, '_>, what: String) -> Error {
        Error::at(&self.path, self.lines.line(node.range().start), what)
    }
}

impl<'a> MitsubaReader<'a> {
    pub(super) fn new(file: &Path, values: &[(String, String)], sandbox: &'a Sandbox) -> Result<Self, String> {
        let parameters = Parameters::from_values(values)?;
        Ok(Self { folders: Folders::new(file), sandbox, bytes: 0, parameters, count: 0 })
    }

    /// Parses the scene of the first file.
    pub(super) fn scene(mut self, file: &Path) -> Result<MitsubaScene, Error> {
        let root = self.file(file, 0)?;
        if root.tag != "scene" {
            let tag = root.tag;
            return Err(root.error(format!("the root element is <{tag}>; expected <scene>")));
        }
        self.parameters.check_used().map_err(|problem| Error::new(file, problem))?;
        Ok(MitsubaScene { root, folders: self.folders.all() })
    }

    fn file(&mut self, file: &Path, includes: usize) -> Result<MitsubaElement, Error> {
        let bytes = read_description_bytes(file, "scene")?;
        self.bytes += bytes.len() as u64;
        limits::DESCRIPTION.check_unpacked(self.bytes).map_err(|message| Error::new(file, message))?;
        let text = decode_text(file, &bytes)?;
        let document = Document::parse(text).map_err(|e| {
            let message = format!("not well-formed XML: {}", shortened(&e.to_string()));
            Error::at(file, e.pos().row as usize, message)
        })?;
        let root = document.root_element();
        let mut open = OpenFile { path: file.into(), lines: Lines::new(text), is_old: false, includes };
        let version = root.attribute("version").ok_or_else(|| {
            open.error(&root, "the root element has no \"version\": not a Mitsuba 3 scene".to_owned())
        })?;
        let major = version.split('.').next().and_then(|major| major.trim().parse::<u32>().ok());
        open.is_old = match major {
            Some(major @ 0..=3) => major < 2,
            _ => {
                let message =
                    format!("unsupported version \"{}\"; expected at most 3, such as \"3.0.0\"", shortened(version));
                return Err(open.error(&root, message));
            }
        };
        self.element(&root, &open, 0)
    }

    fn element(&mut self, node: &Node<'_, '_>, file: &OpenFile, depth: usize) -> Result<MitsubaElement, Error> {
        if depth >= MAX_DEPTH {
            return Err(file.error(node, format!("elements are nested more than {MAX_DEPTH} levels deep")));
        }
        let word = match node.tag_name().name() {
            "lookAt" => "lookat",
            word => word,
        };
        let Some(&tag) = TAGS.iter().find(|tag| **tag == word) else {
            return Err(
                file.error(node, format!("unknown element <{}>: Mitsuba scenes do not have it", shortened(word)))
            );
        };
        let attributes = node
            .attributes()
            .map(|attribute| {
                let value = self.parameters.substitute(attribute.value(), &mut self.bytes);
                let value = value.map_err(|problem| file.error(node, problem))?;
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
                return Err(file.error(&child, format!("text in <{tag}>; expected only elements")));
            }
        }
        if file.is_old && tag == "bsdf" && element.kind() == "diffuse" {
            element.children.iter_mut().for_each(rename_reflectance);
        }
        Ok(element)
    }

    /// Appends the result of a nested element to its `siblings`.
    fn child(
        &mut self,
        node: &Node<'_, '_>,
        file: &OpenFile,
        depth: usize,
        siblings: &mut Vec<MitsubaElement>,
    ) -> Result<(), Error> {
        let element = self.element(node, file, depth + 1)?;
        let needed = |name: &str| {
            let missing = || element.error(format!("<{}> has no \"{name}\"", element.tag));
            element.attribute(name).map(str::to_owned).ok_or_else(missing)
        };
        match element.tag {
            "default" => {
                let (name, value) = (needed("name")?, needed("value")?);
                self.parameters.default(name, value).map_err(|reason| element.error(reason))?;
            }
            "path" if depth > 0 => {
                return Err(element.error("<path> is in another element; expected it at the top level of the scene"));
            }
            "path" => {
                let is_folder =
                    |path: &Path| self.sandbox.check(path).map(|()| path.is_dir()).map_err(|problem| problem.words);
                let added = self.folders.add(&needed("value")?, &file.path, is_folder);
                added.map_err(|reason| element.error(reason))?;
            }
            "include" => {
                let included = self.included(&needed("filename")?, &element, file)?;
                match included.tag {
                    "scene" => siblings.extend(included.children),
                    _ => siblings.push(included),
                }
            }
            _ => siblings.push(element),
        }
        Ok(())
    }

    fn included(&mut self, name: &str, at: &MitsubaElement, file: &OpenFile) -> Result<MitsubaElement, Error> {
        let mark = self.folders.begin(&file.path);
        let path = self.folders.find(name);
        self.sandbox.check(&path).map_err(|why| at.error(format!("<include filename=\"{name}\">: {why}")))?;
        if file.includes + 1 >= MAX_INCLUDES {
            let message = format!(
                "includes are nested more than {MAX_INCLUDES} levels deep; check for files that include each other"
            );
            return Err(at.error(message));
        }
        let included = self.file(&path, file.includes + 1);
        self.folders.end(&mark);
        included
    }
}

/// Renames the colour of a `diffuse` of a version before 2 to its current name.
fn rename_reflectance(parameter: &mut MitsubaElement) {
    let names =
        parameter.attributes.iter_mut().filter(|(name, value)| &**name == "name" && &**value == "diffuse_reflectance");
    names.for_each(|(_, value)| *value = "reflectance".into());
}
