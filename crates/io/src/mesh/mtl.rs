//! Material libraries (MTL).
//!
//! `Kd` is linear sRGB, the image of `map_Kd` sRGB-encoded. `etendue_scene::asset` describes the conversion of each field. An invalid value of a used field is
//! refused with its line; an unused field and an odd statement are reported with their line. Keywords count in any capitals.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use etendue_scene::asset::MtlFields;

use super::statement::{ObjStatement, statements, without_mark};
use super::texture_option::{TextureReference, TextureUsage, UvLayout, parse as parse_texture};
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
    pub(super) maps: MtlMaps,
    /// Folder of the library.
    pub(super) folder: PathBuf,
    /// `file:line` of `newmtl`.
    pub(super) place: String,
    /// 1 − `Tr`; `d` takes precedence.
    transparency: Option<f64>,
}

/// Textures of a material.
#[derive(Clone, Debug, Default)]
pub(super) struct MtlMaps {
    pub(super) diffuse: Option<TextureReference>,
    pub(super) opacity: Option<TextureReference>,
    pub(super) roughness: Option<TextureReference>,
    pub(super) metalness: Option<TextureReference>,
    pub(super) normals: Option<TextureReference>,
    pub(super) bump: Option<TextureReference>,
}

impl MtlMaps {
    fn all(&self) -> impl Iterator<Item = &TextureReference> {
        let Self { diffuse, opacity, roughness, metalness, normals, bump } = self;
        [diffuse, opacity, roughness, metalness, normals, bump].into_iter().flatten()
    }
}

/// Parses the content of `file`.
pub(super) fn parse(file: &Path, bytes: &[u8]) -> Result<Library, Error> {
    let bytes = without_mark(bytes);
    let mut scan = MtlScan { file, library: Library::default(), current: CurrentMaterial::None };
    for statement in statements(&bytes) {
        scan.take(&statement).map_err(|problem| Error::at(file, statement.line, problem))?;
    }
    let mut library = scan.library;
    for material in library.materials.values_mut() {
        material.fields.opacity = material.fields.opacity.or(material.transparency);
    }
    Ok(library)
}

/// Material to which statements belong.
enum CurrentMaterial {
    /// None yet.
    None,
    Named(String),
    /// One whose statements are passed over.
    PassedOver,
}

struct MtlScan<'a> {
    file: &'a Path,
    library: Library,
    current: CurrentMaterial,
}

impl MtlScan<'_> {
    fn take(&mut self, statement: &ObjStatement<'_>) -> Result<(), String> {
        let place = format!("{}:{}", self.file.file_name().unwrap_or_default().to_string_lossy(), statement.line);
        if statement.keyword().eq_ignore_ascii_case("newmtl") {
            self.begin(statement, place);
            return Ok(());
        }
        let Library { materials, report } = &mut self.library;
        match &self.current {
            CurrentMaterial::PassedOver => {}
            CurrentMaterial::None => {
                report.push(format!("{place}: `{}` precedes the first `newmtl` and is not used", statement.keyword()));
            }
            CurrentMaterial::Named(name) => {
                let Some(material) = materials.get_mut(name) else { return Ok(()) };
                let notes = material.take(statement)?;
                report.extend(notes.into_iter().map(|note| format!("{place}: material \"{name}\": {note}")));
            }
        }
        Ok(())
    }

    fn begin(&mut self, statement: &ObjStatement<'_>, place: String) {
        let name = statement.rest().to_owned();
        let Library { materials, report } = &mut self.library;
        self.current = CurrentMaterial::PassedOver;
        if name.is_empty() {
            report.push(format!("{place}: `newmtl` without a name: the material is not used"));
        } else if let Some(first) = materials.get(&name) {
            let first = &first.place;
            report.push(format!("{place}: material \"{name}\" is defined twice; the first, at {first}, is used"));
        } else {
            let folder = self.file.parent().unwrap_or(Path::new("")).to_owned();
            let (fields, maps) = (MtlFields::default(), MtlMaps::default());
            materials.insert(name.clone(), LibraryMaterial { fields, maps, folder, place, transparency: None });
            self.current = CurrentMaterial::Named(name);
        }
    }
}

impl LibraryMaterial {
    /// Reads a field; returns notes on what is not used.
    fn take(&mut self, statement: &ObjStatement<'_>) -> Result<Vec<String>, String> {
        let fields = &mut self.fields;
        let keyword = statement.keyword();
        let mut notes = Vec::new();
        match keyword.to_ascii_lowercase().as_str() {
            "kd" => fields.diffuse = Some(numbers(statement, f64::MAX)?),
            "ks" => fields.specular = Some(numbers(statement, f64::MAX)?),
            "ke" => fields.emission = Some(numbers(statement, f64::MAX)?),
            "tf" => match numbers(statement, f64::MAX) {
                Ok(filter) => fields.filter = Some(filter),
                Err(problem) => notes.push(format!("not used: {problem}")),
            },
            "ka" if numbers(statement, f64::MAX) == Ok([0.0; 3]) => {}
            "ka" => notes.push("`Ka` is not used: ambient light is not a property of a surface".to_owned()),
            "ns" => fields.exponent = Some(number(statement, f64::MAX)?),
            "ni" => fields.index = Some(number(statement, f64::MAX)?),
            "pr" => fields.roughness = Some(number(statement, 1.0)?),
            "pm" => fields.metalness = Some(number(statement, 1.0)?),
            "d" => {
                fields.opacity = Some(number(statement, 1.0)?);
                if statement.words().any(|word| word == "-halo") {
                    notes.push("the option `-halo` is not used".to_owned());
                }
            }
            "tr" => self.transparency = Some(1.0 - number(statement, 1.0)?),
            "illum" => fields.illumination_model = Some(number(statement, 10.0)? as u8),
            "map_kd" => notes = texture(statement, TextureUsage::Colour, &mut self.maps.diffuse),
            "map_d" => notes = texture(statement, TextureUsage::Number, &mut self.maps.opacity),
            "map_pr" => notes = texture(statement, TextureUsage::Number, &mut self.maps.roughness),
            "map_pm" => notes = texture(statement, TextureUsage::Number, &mut self.maps.metalness),
            "norm" | "map_kn" => notes = texture(statement, TextureUsage::Normals, &mut self.maps.normals),
            "bump" | "map_bump" => notes = texture(statement, TextureUsage::Normals, &mut self.maps.bump),
            _ => notes.push(format!("`{keyword}` is not used")),
        }
        Ok(notes)
    }

    /// Texture layout: that of the first texture.
    pub(super) fn layout(&self) -> UvLayout {
        self.maps.all().next().map_or(UvLayout::PLAIN, |texture| texture.layout)
    }

    /// True if the textures have several layouts.
    pub(super) fn has_other_layouts(&self) -> bool {
        self.maps.all().any(|texture| texture.layout != self.layout())
    }
}

/// Reads a texture into `map`; a statement without a file name is not used.
fn texture(statement: &ObjStatement<'_>, usage: TextureUsage, map: &mut Option<TextureReference>) -> Vec<String> {
    match parse_texture(statement.rest()) {
        Ok(texture) => map.insert(texture).notes_for(usage),
        Err(problem) => vec![format!("`{}` is not used: {problem}", statement.keyword())],
    }
}

/// Three numbers from 0 to `high`; a single number is repeated.
fn numbers(statement: &ObjStatement<'_>, high: f64) -> Result<[f64; 3], String> {
    let values = checked(statement, "three numbers of 0 or more", high)?;
    match values[..] {
        [r, g, b] => Ok([r, g, b]),
        [grey] => Ok([grey; 3]),
        _ => Err(message(statement, &format!("{} numbers", values.len()), "three numbers of 0 or more")),
    }
}

/// A number from 0 to `high`, after options.
fn number(statement: &ObjStatement<'_>, high: f64) -> Result<f64, String> {
    let expected = match high {
        f64::MAX => "a number of 0 or more".to_owned(),
        _ => format!("a number from 0 to {high}"),
    };
    let values = checked(statement, &expected, high)?;
    match values[..] {
        [value] => Ok(value),
        _ => Err(message(statement, &format!("{} numbers", values.len()), &expected)),
    }
}

fn checked(statement: &ObjStatement<'_>, expected: &str, high: f64) -> Result<Vec<f64>, String> {
    let words = statement.words().filter(|word| *word != "-halo");
    let values: Result<Vec<f64>, _> = words.map(super::statement::number).collect();
    let values = values.map_err(|problem| message(statement, &problem.words, expected))?;
    if values.len() <= 3 && values.iter().any(|v| !(0.0..=high).contains(v)) {
        return Err(message(statement, "out of range", expected));
    }
    Ok(values)
}

fn message(statement: &ObjStatement<'_>, problem: &str, expected: &str) -> String {
    format!("`{} {}`: {problem}; expected {expected}", statement.keyword(), statement.rest())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Library, String> {
        parse(Path::new("lib/a.mtl"), text.as_bytes()).map_err(|e| e.to_string())
    }

    #[test]
    fn fields_are_read_and_the_others_reported_with_their_line() {
        let library = read(
            "newmtl red paint\nKd 0.8 0.1 0.1\nKa 1 1 1\nPr 0.5\nPm 0\nPc 1\nnorm n.png\nTr 0\nmap_Kd -s 2 3 1 -bm 1 my wall.png\n\
             newmtl dull\nKd 0.5\nKa 0 0 0\nd -halo 0.5\nTr 0.2",
        )
        .expect("readable");
        let red = &library.materials["red paint"];
        assert_eq!(red.fields.diffuse, Some([0.8, 0.1, 0.1]));
        assert_eq!((red.fields.roughness, red.fields.metalness, red.fields.opacity), (Some(0.5), Some(0.0), Some(1.0)));
        assert_eq!(red.maps.diffuse.as_ref().map(|texture| &texture.file[..]), Some("my wall.png"));
        assert_eq!(red.maps.normals.as_ref().map(|texture| &texture.file[..]), Some("n.png"));
        assert_eq!(red.layout().apply([0.5, 0.5]), [1.0, 1.5]);
        assert!(red.has_other_layouts());
        let dull = &library.materials["dull"].fields;
        assert_eq!((dull.diffuse, dull.opacity), (Some([0.5; 3]), Some(0.5)), "`d` counts");
        assert_eq!(
            library.report,
            [
                "a.mtl:3: material \"red paint\": `Ka` is not used: ambient light is not a property of a surface",
                "a.mtl:6: material \"red paint\": `Pc` is not used",
                "a.mtl:9: material \"red paint\": the texture option `-bm 1` is not used",
                "a.mtl:13: material \"dull\": the option `-halo` is not used",
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
    }

    #[test]
    fn odd_statements_are_passed_over() {
        let library =
            read("Kd 1 1 1\nnewmtl a\nKd 0.5\nmap_Kd\nnewmtl\nKd x\nnewmtl a\nKd 0.9\nnewmtl b\nKa spectral a.rfl")
                .expect("readable");
        assert_eq!(library.materials["a"].fields.diffuse, Some([0.5; 3]), "the first");
        assert_eq!(library.materials.len(), 2);
        assert_eq!(
            library.report,
            [
                "a.mtl:1: `Kd` precedes the first `newmtl` and is not used",
                "a.mtl:4: material \"a\": `map_Kd` is not used: texture without a file name",
                "a.mtl:5: `newmtl` without a name: the material is not used",
                "a.mtl:7: material \"a\" is defined twice; the first, at a.mtl:2, is used",
                "a.mtl:10: material \"b\": `Ka` is not used: ambient light is not a property of a surface",
            ]
        );
    }
}
