//! The text of an OBJ file as polygons.

use std::collections::BTreeMap;
use std::path::Path;

use super::statement::{Statement, statements};
use crate::Error;

/// What an OBJ file says, in 64 bits, polygons whole.
#[derive(Clone, Debug, Default)]
pub(super) struct Obj {
    pub(super) positions: Vec<[f64; 3]>,
    pub(super) normals: Vec<[f64; 3]>,
    /// v grows upwards.
    pub(super) uvs: Vec<[f64; 2]>,
    pub(super) corners: Vec<Corner>,
    pub(super) faces: Vec<Face>,
    /// Names of materials in order of first use.
    pub(super) materials: Vec<MaterialUse>,
    /// Material libraries with their lines, as written.
    pub(super) libraries: Vec<(String, usize)>,
    /// What is not read, by keyword: how often, and on which line first.
    pub(super) unread: BTreeMap<String, (usize, usize)>,
    /// First line that switches smoothing on.
    pub(super) smoothing_line: Option<usize>,
}

/// A corner of a face: indices from 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) struct Corner {
    pub(super) position: usize,
    pub(super) uv: Option<usize>,
    pub(super) normal: Option<usize>,
}

/// A polygon.
#[derive(Clone, Copy, Debug)]
pub(super) struct Face {
    pub(super) first_corner: usize,
    pub(super) corner_count: usize,
    pub(super) material: u16,
    pub(super) line: usize,
}

/// A material by name, with the line of its first `usemtl`; faces before any have the empty name and no line.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct MaterialUse {
    pub(super) name: String,
    pub(super) line: Option<usize>,
}

/// Reads the text of `file`.
pub(super) fn parse(file: &Path, text: &str) -> Result<Obj, Error> {
    let mut reader = Reader::default();
    for statement in statements(text) {
        reader.take(&statement).map_err(|told| Error::at(file, statement.line, told))?;
    }
    reader.obj.check_indices().map_err(|(line, told)| Error::at(file, line, told))?;
    if reader.obj.faces.is_empty() {
        return Err(Error::new(
            file,
            "this mesh has no faces; the file may be truncated, or hold only lines or points",
        ));
    }
    Ok(reader.obj)
}

#[derive(Default)]
struct Reader {
    obj: Obj,
    material: Option<u16>,
}

impl Reader {
    fn take(&mut self, statement: &Statement<'_>) -> Result<(), String> {
        match statement.keyword() {
            "v" => self.vertex(statement)?,
            "vn" => self.obj.normals.push(components(statement, 3, 3)?),
            "vt" => self.obj.uvs.push(components(statement, 1, 3)?),
            "f" => self.face(statement)?,
            "usemtl" => self.material = Some(self.material_slot(statement.rest(), Some(statement.line))?),
            "mtllib" => self.obj.libraries.push((statement.rest().to_owned(), statement.line)),
            "s" => self.smoothing(statement),
            "o" | "g" => {}
            other => self.pass_over(other, statement.line),
        }
        Ok(())
    }

    fn vertex(&mut self, statement: &Statement<'_>) -> Result<(), String> {
        let numbers = statement.numbers()?;
        if let Some(far) = numbers.iter().find(|v| v.abs() > f64::from(f32::MAX)) {
            return Err(format!("coordinate {far:e} is beyond the range of 32-bit floats"));
        }
        match numbers[..] {
            [x, y, z] | [x, y, z, 1.0] => self.obj.positions.push([x, y, z]),
            [_, _, _, w] => {
                return Err(format!(
                    "vertex with the weight {w}; expected three coordinates, weights belong to curves"
                ));
            }
            [x, y, z, _, _, _] => {
                self.obj.positions.push([x, y, z]);
                self.pass_over("v with a colour", statement.line);
            }
            _ => return Err(wrong_count("v", "3 coordinates", numbers.len())),
        }
        Ok(())
    }

    fn face(&mut self, statement: &Statement<'_>) -> Result<(), String> {
        let first_corner = self.obj.corners.len();
        for word in statement.words() {
            let corner = self.corner(word)?;
            self.obj.corners.push(corner);
        }
        let corner_count = self.obj.corners.len() - first_corner;
        if corner_count < 3 {
            return Err(wrong_count("f", "3 or more corners", corner_count));
        }
        let material = match self.material {
            Some(slot) => slot,
            None => self.material_slot("", None)?,
        };
        self.obj.faces.push(Face { first_corner, corner_count, material, line: statement.line });
        Ok(())
    }

    fn corner(&self, word: &str) -> Result<Corner, String> {
        let mut parts = word.split('/');
        let mut part = |name: &str, count: usize| match parts.next() {
            None | Some("") => Ok(None),
            Some(text) => index(text, name, count).map(Some),
        };
        let position = part("vertex", self.obj.positions.len())?;
        let uv = part("texture coordinate", self.obj.uvs.len())?;
        let normal = part("normal", self.obj.normals.len())?;
        match (position, parts.next()) {
            (Some(position), None) => Ok(Corner { position, uv, normal }),
            _ => Err(format!("`{word}` is not a corner of a face; expected v, v/vt, v//vn or v/vt/vn")),
        }
    }

    fn material_slot(&mut self, name: &str, line: Option<usize>) -> Result<u16, String> {
        let known = self.obj.materials.iter().position(|m| m.name == name);
        let slot = known.unwrap_or(self.obj.materials.len());
        if known.is_none() {
            self.obj.materials.push(MaterialUse { name: name.to_owned(), line });
        }
        u16::try_from(slot).map_err(|_| "more than 65 536 materials in one mesh; split the mesh".to_owned())
    }

    fn smoothing(&mut self, statement: &Statement<'_>) {
        if !matches!(statement.rest(), "off" | "0" | "") {
            self.obj.smoothing_line.get_or_insert(statement.line);
        }
    }

    fn pass_over(&mut self, keyword: &str, line: usize) {
        self.obj.unread.entry(keyword.to_owned()).or_insert((0, line)).0 += 1;
    }
}

impl Obj {
    /// Absolute indices may point ahead, so they are checked when everything is read.
    fn check_indices(&self) -> Result<(), (usize, String)> {
        for face in &self.faces {
            for corner in self.corners_of(face) {
                let within = |index: Option<usize>, name: &str, count: usize| match index {
                    Some(i) if i >= count => Err((face.line, out_of_range(name, &(i + 1).to_string(), count))),
                    _ => Ok(()),
                };
                within(Some(corner.position), "vertex", self.positions.len())?;
                within(corner.uv, "texture coordinate", self.uvs.len())?;
                within(corner.normal, "normal", self.normals.len())?;
            }
        }
        Ok(())
    }

    /// The corners of `face`.
    pub(super) fn corners_of(&self, face: &Face) -> &[Corner] {
        &self.corners[face.first_corner..face.first_corner + face.corner_count]
    }
}

/// Between `least` and `most` numbers, of which the first `N` count; what is missing is 0.
fn components<const N: usize>(statement: &Statement<'_>, least: usize, most: usize) -> Result<[f64; N], String> {
    let numbers = statement.numbers()?;
    if !(least..=most).contains(&numbers.len()) {
        return Err(wrong_count(statement.keyword(), &format!("{least} to {most} numbers"), numbers.len()));
    }
    Ok(std::array::from_fn(|i| numbers.get(i).copied().unwrap_or(0.0)))
}

/// An index from 0: `text` counts from 1, or backwards from the last of the `count` read so far.
fn index(text: &str, name: &str, count: usize) -> Result<usize, String> {
    let stated: i64 = text.parse().map_err(|_| format!("`{text}` is not an index of a {name}"))?;
    let from_0 = if stated < 0 { i64::try_from(count).unwrap_or(i64::MAX) + stated } else { stated - 1 };
    usize::try_from(from_0).map_err(|_| out_of_range(name, text, count))
}

fn out_of_range(name: &str, stated: &str, count: usize) -> String {
    format!("face names {name} {stated}, but there are {count}; the file is damaged or truncated")
}

fn wrong_count(keyword: &str, expected: &str, found: usize) -> String {
    format!("`{keyword}` has {found}, expected {expected}; the line may be cut off")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Obj, String> {
        parse(Path::new("a.obj"), text).map_err(|e| e.to_string())
    }

    const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

    fn refused(tail: &str) -> String {
        read(&format!("{TRIANGLE}{tail}")).expect_err(tail)
    }

    #[test]
    fn relative_indices_and_every_form_of_corner_are_read() {
        let obj = read(&format!(
            "{TRIANGLE}vt 0.5\nvn 0 0 1\nf -3 -2 -1\nf 1/1 2/1 3/-1\nf 1//1 2//1 3//-1\nf 1/1/1 2/1/1 3/1/1"
        ));
        let obj = obj.expect("readable");
        assert_eq!(obj.faces.len(), 4);
        assert!(obj.faces.iter().all(|f| obj.corners_of(f).iter().map(|c| c.position).eq([0, 1, 2])));
        assert_eq!(obj.corners_of(&obj.faces[2])[2], Corner { position: 2, uv: None, normal: Some(0) });
        assert_eq!(obj.uvs, [[0.5, 0.0]]);
    }

    #[test]
    fn faults_name_their_line() {
        assert_eq!(
            refused("f 1 2 4"),
            "a.obj:4: face names vertex 4, but there are 3; the file is damaged or truncated"
        );
        assert_eq!(
            refused("f 1 2 -4"),
            "a.obj:4: face names vertex -4, but there are 3; the file is damaged or truncated"
        );
        assert_eq!(
            refused("f 0 1 2"),
            "a.obj:4: face names vertex 0, but there are 3; the file is damaged or truncated"
        );
        assert_eq!(
            refused("\nf 1/1 2 3"),
            "a.obj:5: face names texture coordinate 1, but there are 0; the file is damaged or truncated"
        );
        assert_eq!(refused("v 0 nan 0"), "a.obj:4: `nan` is not finite; expected a finite number");
        assert_eq!(refused("v 0 -inf 0"), "a.obj:4: `-inf` is not finite; expected a finite number");
        assert_eq!(
            refused("f 1 2 3\nv 0.25 0."),
            "a.obj:5: `v` has 2, expected 3 coordinates; the line may be cut off"
        );
        assert_eq!(
            refused("f 1 2 3\nf 1 2"),
            "a.obj:5: `f` has 2, expected 3 or more corners; the line may be cut off"
        );
        assert_eq!(refused("f 1 2 x"), "a.obj:4: `x` is not an index of a vertex");
        assert_eq!(
            refused("f 1 2 3/1/1/1"),
            "a.obj:4: `3/1/1/1` is not a corner of a face; expected v, v/vt, v//vn or v/vt/vn"
        );
        assert!(refused("").contains("no faces"));
    }

    #[test]
    fn materials_are_slots_in_order_of_use() {
        let obj = read(&format!(
            "{TRIANGLE}f 1 2 3\no part\nusemtl red paint\nf 1 2 3\nusemtl b\nf 1 2 3\nusemtl red paint\nf 1 2 3"
        ));
        let obj = obj.expect("readable");
        let names: Vec<&str> = obj.materials.iter().map(|m| m.name.as_str()).collect();
        assert_eq!(names, ["", "red paint", "b"]);
        assert!(obj.faces.iter().map(|f| f.material).eq([0, 1, 2, 1]));
        assert_eq!(obj.materials[1].line, Some(6));
    }

    #[test]
    fn what_is_not_read_is_counted() {
        let obj = read(&format!("{TRIANGLE}v 0 0 1 0.5 0.5 0.5\nl 1 2\nl 2 3\ns 1\nf 1 2 3")).expect("readable");
        assert_eq!(obj.unread["l"], (2, 5));
        assert_eq!(obj.unread["v with a colour"], (1, 4));
        assert_eq!(obj.smoothing_line, Some(7));
    }
}
