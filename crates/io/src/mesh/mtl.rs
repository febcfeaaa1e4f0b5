//! Material libraries (MTL).
//!
//! `Kd` is linear sRGB, the image of `map_Kd` sRGB-encoded. `etendue_scene::asset` describes the conversion of each field. An invalid value is refused with its
//! line; an unused field is reported with its line.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use etendue_scene::asset::{MtlFields, SlotMaterial};

use super::statement::{ObjStatement, TobjInput, statements};
use super::texture_option::{UvLayout, parse as parse_texture};
use crate::Error;

/// Materials of one library, by name, and notes on unused content.
#[derive(Clone, Debug, Default)]
pub(super) struct Library {
    pub(super) materials: BTreeMap<String, LibraryMaterial>,
    pub(super) report: Vec<String>,
}

/// Material with its place.
#[derive(Clone, Debug)]
pub(super) struct LibraryMaterial {
    pub(super) fields: MtlFields,
    /// Texture layout, if the library states one.
    pub(super) layout: UvLayout,
    /// `file:line` of `newmtl`.
    pub(super) place: String,
}

/// Parses the text of `file`.
pub(super) fn parse(file: &Path, text: &str) -> Result<Library, Error> {
    let mut scan =
        MtlScan { file, input: TobjInput::default(), places: Vec::new(), first: BTreeMap::new(), report: Vec::new() };
    for statement in statements(text) {
        scan.take(&statement).map_err(|problem| Error::at(file, statement.line, problem))?;
    }
    let (materials, _) = scan.input.read(file, |text| tobj::load_mtl_buf(text))?;
    let materials = materials.into_iter().zip(scan.places);
    let materials = materials.map(|(material, (name, place))| (name, LibraryMaterial::new(file, &material, place)));
    Ok(Library { materials: materials.collect(), report: scan.report })
}

/// Lines of a library: those given to tobj, and notes on unused ones.
struct MtlScan<'a> {
    file: &'a Path,
    input: TobjInput,
    /// Materials in order, with `file:line` of their `newmtl`.
    places: Vec<(String, String)>,
    /// First place of each, by name.
    first: BTreeMap<String, String>,
    report: Vec<String>,
}

impl MtlScan<'_> {
    fn take(&mut self, statement: &ObjStatement<'_>) -> Result<(), String> {
        let place = format!("{}:{}", self.file.file_name().unwrap_or_default().to_string_lossy(), statement.line);
        if statement.keyword() == "newmtl" {
            return self.begin(statement, place);
        }
        let Some((name, _)) = self.places.last() else {
            return Err(format!("`{}` precedes the first `newmtl`", statement.keyword()));
        };
        let (value, notes) = field(statement)?;
        self.report.extend(notes.into_iter().map(|note| format!("{place}: material \"{name}\": {note}")));
        if let Some(value) = value {
            self.input.push(statement.line, &format!("{} {value}", statement.keyword()));
        }
        Ok(())
    }

    fn begin(&mut self, statement: &ObjStatement<'_>, place: String) -> Result<(), String> {
        let name = statement.rest().to_owned();
        if let Some(first) = self.first.insert(name.clone(), place.clone()) {
            return Err(format!("material \"{name}\" is defined twice, first at {first}; rename one of them"));
        }
        self.input.push(statement.line, &format!("newmtl {name}"));
        self.places.push((name, place));
        Ok(())
    }
}

/// Checks a field. Returns the value for tobj, which panics at colours of fewer than three numbers, and notes on unused parts.
fn field(statement: &ObjStatement<'_>) -> Result<(Option<String>, Vec<String>), String> {
    let (keyword, rest) = (statement.keyword(), statement.rest());
    let value = match keyword {
        "Kd" | "Ks" | "Ke" | "Ka" | "Tf" => numbers(statement, 3, f64::MAX)?,
        "Ns" | "Ni" => numbers(statement, 1, f64::MAX)?,
        "Pr" | "Pm" | "d" | "Tr" => numbers(statement, 1, 1.0)?,
        "illum" => numbers(statement, 1, 10.0)?,
        "map_Kd" => return Ok((Some(rest.to_owned()), parse_texture(rest)?.notes)),
        _ => return Ok((None, vec![format!("`{keyword}` is not used")])),
    };
    let note = match (keyword, value.as_str()) {
        ("Ka", "0 0 0") | ("Tf", "1 1 1") => None,
        ("Ka", _) => Some("`Ka` is not used: ambient light is not a property of a surface".to_owned()),
        ("Tf", _) => Some("`Tf` is not used".to_owned()),
        _ => None,
    };
    Ok((Some(value), note.into_iter().collect()))
}

/// `count` numbers from 0 to `high`, as text; a single number is repeated.
fn numbers(statement: &ObjStatement<'_>, count: usize, high: f64) -> Result<String, String> {
    let expected = match (count, high) {
        (3, _) => "three numbers of 0 or more".to_owned(),
        (_, f64::MAX) => "a number of 0 or more".to_owned(),
        _ => format!("a number from 0 to {high}"),
    };
    let message = |what: &str| format!("`{} {}`: {what}; expected {expected}", statement.keyword(), statement.rest());
    let values = statement.numbers().map_err(|what| message(&what.words))?;
    if values.len() != count && values.len() != 1 {
        return Err(message(&format!("{} numbers", values.len())));
    }
    if values.iter().any(|v| !(0.0..=high).contains(v)) {
        return Err(message("out of range"));
    }
    Ok(values.iter().cycle().take(count).map(f64::to_string).collect::<Vec<_>>().join(" "))
}

impl LibraryMaterial {
    /// Converts the result of tobj, whose texture and physically based fields are still text. All is checked.
    fn new(file: &Path, material: &tobj::Material, place: String) -> Self {
        let number = |key: &str| material.unknown_param.get(key).and_then(|text| text.parse::<f64>().ok());
        let texture = material.diffuse_texture.as_deref().and_then(|text| parse_texture(text).ok());
        let fields = MtlFields {
            diffuse: material.diffuse,
            diffuse_map: texture.as_ref().map(|t| sibling_path(file, &t.file)),
            specular: material.specular,
            exponent: material.shininess,
            index: material.optical_density,
            emission: material.emissive,
            roughness: number("Pr"),
            metalness: number("Pm"),
            opacity: material.dissolve.or(number("Tr").map(|t| 1.0 - t)),
            illumination_model: material.illumination_model,
        };
        Self { fields, layout: texture.map_or(UvLayout::PLAIN, |t| t.layout), place }
    }

    /// The material in terms of a scene, and notes on what it cannot represent.
    pub(super) fn slot(&self, name: &str) -> (SlotMaterial, Vec<String>) {
        let (material, mut notes) = self.fields.to_slot(name);
        if self.fields.diffuse_map.is_some() && self.fields.diffuse.is_some_and(|kd| kd != [1.0; 3]) {
            notes.push(format!("material \"{name}\": Kd is not used with map_Kd"));
        }
        (material, notes.into_iter().map(|note| format!("{}: {note}", self.place)).collect())
    }
}

/// `name` as meant in `file`: relative to its folder.
pub(super) fn sibling_path(file: &Path, name: &str) -> PathBuf {
    file.parent().unwrap_or(Path::new("")).join(name)
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
                "a.mtl:3: material \"red paint\": `Ka` is not used: ambient light is not a property of a surface",
                "a.mtl:6: material \"red paint\": `Pc` is not used",
                "a.mtl:7: material \"red paint\": `norm` is not used",
                "a.mtl:9: material \"red paint\": the texture option `-bm 1` is not used",
            ]
        );
    }

    #[test]
    fn a_broken_value_is_refused_with_its_line() {
        let message = |text: &str| read(text).expect_err(text);
        assert_eq!(
            message("newmtl a\nKd 0.5 x 1"),
            "lib/a.mtl:2: `Kd 0.5 x 1`: `x` is not a number; expected three numbers of 0 or more"
        );
        assert_eq!(
            message("newmtl a\nKd 0.5 1"),
            "lib/a.mtl:2: `Kd 0.5 1`: 2 numbers; expected three numbers of 0 or more"
        );
        assert_eq!(message("newmtl a\n\nPr 1.5"), "lib/a.mtl:3: `Pr 1.5`: out of range; expected a number from 0 to 1");
        assert_eq!(message("newmtl a\nNs"), "lib/a.mtl:2: `Ns `: 0 numbers; expected a number of 0 or more");
        assert_eq!(message("Kd 1 1 1"), "lib/a.mtl:1: `Kd` precedes the first `newmtl`");
        assert_eq!(
            message("newmtl a\nnewmtl a"),
            "lib/a.mtl:2: material \"a\" is defined twice, first at a.mtl:1; rename one of them"
        );
    }
}
