//! Material libraries (MTL).
//!
//! `Kd` is linear sRGB, the picture of `map_Kd` sRGB-encoded. What each field becomes is told in
//! `etendue_scene::asset`; a value that is no number of its field is refused with its line, a field that is not used is
//! reported with its line.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use etendue_scene::asset::MtlFields;

use super::statement::{Statement, statements};
use super::texture_option::{TextureReference, parse as parse_texture};
use crate::Error;

/// The materials of one library, by name, and what of it is not used.
#[derive(Clone, Debug, Default)]
pub(super) struct Library {
    pub(super) materials: BTreeMap<String, LibraryMaterial>,
    pub(super) report: Vec<String>,
}

/// A material and where it begins.
#[derive(Clone, Debug)]
pub(super) struct LibraryMaterial {
    pub(super) fields: MtlFields,
    /// How the texture lies on the surface, where the library says so.
    pub(super) layout: UvLayout,
    /// `file:line` of `newmtl`.
    pub(super) place: String,
}

/// Texture coordinates become `uv · scale + offset` (MTL `-s`, `-o`).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct UvLayout {
    pub(super) scale: [f64; 2],
    pub(super) offset: [f64; 2],
}

impl UvLayout {
    /// Texture coordinates as they are.
    pub(super) const PLAIN: Self = Self { scale: [1.0; 2], offset: [0.0; 2] };

    /// The coordinates by which the picture is read.
    pub(super) fn apply(&self, uv: [f64; 2]) -> [f64; 2] {
        std::array::from_fn(|i| uv[i] * self.scale[i] + self.offset[i])
    }
}

/// Reads the text of `file`.
pub(super) fn parse(file: &Path, text: &str) -> Result<Library, Error> {
    let mut reader = Reader { file, library: Library::default(), current: None };
    for statement in statements(text) {
        reader.take(&statement).map_err(|told| Error::at(file, statement.line, told))?;
    }
    Ok(reader.library)
}

struct Reader<'a> {
    file: &'a Path,
    library: Library,
    current: Option<String>,
}

impl Reader<'_> {
    fn take(&mut self, statement: &Statement<'_>) -> Result<(), String> {
        if statement.keyword() == "newmtl" {
            return self.begin(statement);
        }
        let name =
            self.current.clone().ok_or_else(|| format!("`{}` stands before any `newmtl`", statement.keyword()))?;
        let notes = match self.library.materials.get_mut(&name) {
            Some(material) => material.take(self.file, statement)?,
            None => Vec::new(),
        };
        let place = self.place(statement.line);
        self.library.report.extend(notes.into_iter().map(|note| format!("{place}: material \"{name}\": {note}")));
        Ok(())
    }

    fn begin(&mut self, statement: &Statement<'_>) -> Result<(), String> {
        let name = statement.rest().to_owned();
        if let Some(first) = self.library.materials.get(&name) {
            return Err(format!(
                "material \"{name}\" is defined a second time, first at {}; rename one of them",
                first.place
            ));
        }
        let place = self.place(statement.line);
        let material = LibraryMaterial { fields: MtlFields::default(), layout: UvLayout::PLAIN, place };
        self.library.materials.insert(name.clone(), material);
        self.current = Some(name);
        Ok(())
    }

    fn place(&self, line: usize) -> String {
        format!("{}:{line}", self.file.file_name().unwrap_or_default().to_string_lossy())
    }
}

impl LibraryMaterial {
    /// Reads one field; returns what of it is not used.
    fn take(&mut self, file: &Path, statement: &Statement<'_>) -> Result<Vec<String>, String> {
        let fields = &mut self.fields;
        match statement.keyword() {
            "Kd" => fields.diffuse = Some(colour(statement)?),
            "Ks" => fields.specular = Some(colour(statement)?),
            "Ke" => fields.emission = Some(colour(statement)?),
            "Ns" => fields.exponent = Some(scalar(statement, 0.0, f64::MAX)?),
            "Ni" => fields.index = Some(scalar(statement, 0.0, f64::MAX)?),
            "Pr" => fields.roughness = Some(scalar(statement, 0.0, 1.0)?),
            "Pm" => fields.metalness = Some(scalar(statement, 0.0, 1.0)?),
            "d" => fields.opacity = Some(scalar(statement, 0.0, 1.0)?),
            "Tr" => fields.opacity = Some(1.0 - scalar(statement, 0.0, 1.0)?),
            "illum" => fields.illumination_model = Some(scalar(statement, 0.0, 10.0)? as u8),
            "map_Kd" => return self.texture(file, parse_texture(statement.rest())?),
            "Ka" | "Tf" => drop(colour(statement)?),
            _ => {}
        }
        Ok(not_used(statement).into_iter().collect())
    }

    fn texture(&mut self, file: &Path, texture: TextureReference) -> Result<Vec<String>, String> {
        let mut notes: Vec<String> =
            texture.unread.iter().map(|option| format!("the texture option `{option}` is not used")).collect();
        if texture.clamp {
            notes.push("the texture option `-clamp on` is not used: the picture repeats".to_owned());
        }
        let forward = texture.file.replace('\\', "/");
        if forward != texture.file {
            notes.push(format!("`{}` is read as `{forward}`", texture.file));
        }
        self.fields.diffuse_map = Some(beside(file, &forward));
        self.layout = UvLayout { scale: texture.scale, offset: texture.offset };
        Ok(notes)
    }
}

/// `name` as meant in `file`: relative to its folder.
pub(super) fn beside(file: &Path, name: &str) -> PathBuf {
    file.parent().unwrap_or(Path::new("")).join(name)
}

/// The note for a field that is read and has no effect. Fields of the mapping note themselves.
fn not_used(statement: &Statement<'_>) -> Option<String> {
    let keyword = statement.keyword();
    match keyword {
        "Kd" | "Ks" | "Ke" | "Ns" | "Ni" | "Pr" | "Pm" | "d" | "Tr" | "illum" => None,
        "Ka" if statement.numbers().is_ok_and(|n| n.iter().all(|v| *v == 0.0)) => None,
        "Tf" if statement.numbers().is_ok_and(|n| n.iter().all(|v| *v == 1.0)) => None,
        "Ka" => Some("`Ka` is not used: ambient light is no property of a surface".to_owned()),
        _ => Some(format!("`{keyword}` is not used")),
    }
}

/// Three numbers of 0 or more; one number stands for all three.
fn colour(statement: &Statement<'_>) -> Result<[f64; 3], String> {
    let told = |what: &str| {
        format!("`{} {}`: {what}; expected three numbers of 0 or more", statement.keyword(), statement.rest())
    };
    let values = match statement.numbers().map_err(|what| told(&what))?[..] {
        [r, g, b] => [r, g, b],
        [grey] => [grey; 3],
        ref other => return Err(told(&format!("{} numbers", other.len()))),
    };
    if values.iter().any(|v| *v < 0.0) { Err(told("a negative number")) } else { Ok(values) }
}

fn scalar(statement: &Statement<'_>, low: f64, high: f64) -> Result<f64, String> {
    let expected =
        if high == f64::MAX { format!("a number of {low} or more") } else { format!("a number from {low} to {high}") };
    let told = |what: &str| format!("`{} {}`: {what}; expected {expected}", statement.keyword(), statement.rest());
    match statement.numbers().map_err(|what| told(&what))?[..] {
        [value] if (low..=high).contains(&value) => Ok(value),
        [_] => Err(told("out of range")),
        ref other => Err(told(&format!("{} numbers", other.len()))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Library, String> {
        parse(Path::new("lib/a.mtl"), text).map_err(|e| e.to_string())
    }

    #[test]
    fn fields_are_read_and_the_others_reported_with_their_line() {
        let library = read(
            "newmtl red paint\nKd 0.8 0.1 0.1\nKa 1 1 1\nPr 0.5\nPm 0\nPc 1\nnorm n.png\nTr 0\nmap_Kd -s 2 3 1 -bm 1 my wall.png\n\
             newmtl dull\nKd 0.5\nKa 0 0 0",
        )
        .expect("readable");
        let red = &library.materials["red paint"];
        assert_eq!(red.fields.diffuse, Some([0.8, 0.1, 0.1]));
        assert_eq!((red.fields.roughness, red.fields.metalness, red.fields.opacity), (Some(0.5), Some(0.0), Some(1.0)));
        assert_eq!(red.fields.diffuse_map, Some(PathBuf::from("lib/my wall.png")));
        assert_eq!(red.layout.apply([0.5, 0.5]), [1.0, 1.5]);
        assert_eq!(library.materials["dull"].fields.diffuse, Some([0.5; 3]));
        assert_eq!(
            library.report,
            [
                "a.mtl:3: material \"red paint\": `Ka` is not used: ambient light is no property of a surface",
                "a.mtl:6: material \"red paint\": `Pc` is not used",
                "a.mtl:7: material \"red paint\": `norm` is not used",
                "a.mtl:9: material \"red paint\": the texture option `-bm 1` is not used",
            ]
        );
    }

    #[test]
    fn a_broken_value_is_refused_with_its_line() {
        let told = |text: &str| read(text).expect_err(text);
        assert_eq!(
            told("newmtl a\nKd 0.5 x 1"),
            "lib/a.mtl:2: `Kd 0.5 x 1`: `x` is not a number; expected three numbers of 0 or more"
        );
        assert_eq!(
            told("newmtl a\nKd 0.5 1"),
            "lib/a.mtl:2: `Kd 0.5 1`: 2 numbers; expected three numbers of 0 or more"
        );
        assert_eq!(told("newmtl a\n\nPr 1.5"), "lib/a.mtl:3: `Pr 1.5`: out of range; expected a number from 0 to 1");
        assert_eq!(told("newmtl a\nNs"), "lib/a.mtl:2: `Ns `: 0 numbers; expected a number of 0 or more");
        assert_eq!(told("Kd 1 1 1"), "lib/a.mtl:1: `Kd` stands before any `newmtl`");
        assert_eq!(
            told("newmtl a\nnewmtl a"),
            "lib/a.mtl:2: material \"a\" is defined a second time, first at a.mtl:1; rename one of them"
        );
    }
}
