//! Checks the lines of an OBJ file and selects those that tobj reads. Odd statements that no face needs are passed over and counted.
//!
//! tobj accepts coordinates that are not finite, reads the index 0 as none, lines as faces and colours as part of a vertex, and loses the information which
//! corners have no normal if some have: its vertex data are consistent only if all faces of a model have the same form. So each line is checked here, and a new
//! group begins wherever the form changes.

use std::collections::BTreeMap;
use std::path::Path;

use etendue_scene::limits::CORNERS;

use super::statement::{ObjStatement, TobjInput, number, statements, without_mark};
use super::vertex::check_range;
use crate::{Error, ErrorCode, Problem};

/// Parts of a corner, in order.
const KINDS: [[&str; 2]; 3] =
    [["vertex", "vertices"], ["texture coordinate", "texture coordinates"], ["normal", "normals"]];

/// Result of the check of an OBJ file, before tobj reads it.
#[derive(Clone, Debug, Default)]
pub(super) struct Obj {
    pub(super) input: TobjInput,
    /// Names of materials in order of first use; faces before any have the empty name.
    pub(super) materials: Vec<String>,
    /// Index of each material in `materials`.
    known: BTreeMap<String, usize>,
    /// Material libraries with their lines, as written.
    pub(super) libraries: Vec<(String, usize)>,
    /// Unread content by keyword: count, and first line.
    pub(super) unread: BTreeMap<String, (usize, usize)>,
    /// First line that switches smoothing on.
    pub(super) smoothing_line: Option<usize>,
    /// Number of each of [`KINDS`] read so far.
    pub(super) counts: [usize; 3],
    /// Vertices that no face may use, by index from 1: line, and the reason.
    invalid: BTreeMap<usize, InvalidVertex>,
    /// First of them that a face uses.
    used_invalid: Option<usize>,
    /// Forward references, with their kind and line.
    ahead: Vec<(usize, isize, usize)>,
    corners: u32,
    form: [bool; 3],
}

/// Vertex whose coordinates are not finite or too large.
#[derive(Clone, Debug)]
struct InvalidVertex {
    line: usize,
    problem: Problem,
}

/// Checks the content of `file`.
pub(super) fn scan(file: &Path, bytes: &[u8]) -> Result<Obj, Error> {
    let bytes = without_mark(bytes);
    let mut obj = Obj::default();
    obj.input.push(0, "mtllib materials");
    let mut last = None;
    for statement in statements(&bytes) {
        obj.take(&statement).map_err(|problem| Error::at(file, statement.line, problem))?;
        last = Some(statement);
    }
    if let Some(statement) = last.filter(|_| !bytes.ends_with(b"\n")) {
        check_last(&statement).map_err(|problem| Error::at(file, statement.line, problem))?;
    }
    obj.check_vertices(file)?;
    if let Some((kind, index, line)) = obj.ahead.iter().find(|(kind, index, _)| *index > obj.counts[*kind] as isize) {
        return Err(Error::at(file, *line, out_of_range(KINDS[*kind], *index, obj.counts[*kind])));
    }
    if obj.corners == 0 {
        return Err(Error::coded(
            ErrorCode::Empty,
            file,
            "the mesh has no faces; the file may be truncated, or contain only lines or points",
        ));
    }
    Ok(obj)
}

/// Refuses a face that the end of the file cuts.
fn check_last(statement: &ObjStatement<'_>) -> Result<(), Problem> {
    match (statement.keyword(), statement.words().count()) {
        ("f", corners @ 0..3) => Err(wrong_count("f", "3 or more corners", corners)),
        _ => Ok(()),
    }
}

impl Obj {
    /// Refuses invalid vertices of faces, and in a file without faces any of them. Notes the others.
    fn check_vertices(&mut self, file: &Path) -> Result<(), Error> {
        let used = self.ahead.iter().filter(|(kind, ..)| *kind == 0).map(|(_, index, _)| *index as usize);
        let ahead = used.filter(|index| self.invalid.contains_key(index)).min();
        let first =
            self.used_invalid.or(ahead).or_else(|| self.invalid.keys().next().copied().filter(|_| self.corners == 0));
        if let Some(InvalidVertex { line, problem }) = first.and_then(|index| self.invalid.get(&index)) {
            return Err(Error::at(file, *line, problem.clone()));
        }
        let lines: Vec<usize> = self.invalid.values().map(|vertex| vertex.line).collect();
        lines.into_iter().for_each(|line| self.pass_over("v that is not finite, of no face", line));
        Ok(())
    }

    /// Polygons by material and form, each part with its own vertices. A part's material is an index into `materials`.
    pub(super) fn parts(&self, file: &Path) -> Result<Vec<tobj::Mesh>, Error> {
        self.parts_with(file, true)
    }

    /// The same, with separate indices for texture coordinates and normals.
    pub(super) fn parts_by_corners(&self, file: &Path) -> Result<Vec<tobj::Mesh>, Error> {
        self.parts_with(file, false)
    }

    fn parts_with(&self, file: &Path, single_index: bool) -> Result<Vec<tobj::Mesh>, Error> {
        // The materials are numbered: a name may be empty or contain any bytes.
        let slots = |_: &Path| Ok((Vec::new(), (0..self.materials.len()).map(|i| (i.to_string(), i)).collect()));
        let options = tobj::LoadOptions { single_index, ..tobj::LoadOptions::default() };
        let (models, _no_materials) = self.input.read(file, |text| tobj::load_obj_buf(text, &options, slots))?;
        Ok(models.into_iter().map(|model| model.mesh).collect())
    }

    fn take(&mut self, statement: &ObjStatement<'_>) -> Result<(), Problem> {
        let (line, rest) = (statement.line, statement.rest());
        match statement.keyword() {
            "v" => self.vertex(statement)?,
            "vt" => self.coordinates(statement)?,
            "vn" => self.normal(statement)?,
            "f" => self.face(statement)?,
            "usemtl" if rest.is_empty() => self.pass_over("usemtl without a name", line),
            "usemtl" => self.use_material(rest, Some(line))?,
            "mtllib" if rest.is_empty() => self.pass_over("mtllib without a name", line),
            "mtllib" => self.libraries.push((rest.to_owned(), line)),
            "s" if matches!(rest, "off" | "0" | "") => {}
            "s" => drop(self.smoothing_line.get_or_insert(line)),
            "o" | "g" => {}
            other => self.pass_over(other, line),
        }
        Ok(())
    }

    fn vertex(&mut self, statement: &ObjStatement<'_>) -> Result<(), Problem> {
        let line = statement.line;
        let numbers = numbers_of_any_size(statement)?;
        let [x, y, z, further @ ..] = &numbers[..] else {
            return Err(wrong_count("v", "3 coordinates", numbers.len()));
        };
        match further {
            [] | [1.0] => {}
            [_] => self.pass_over("v with a weight", line),
            [_, _, _] => self.pass_over("v with a colour", line),
            _ => self.pass_over("v with further numbers", line),
        }
        let position = [*x, *y, *z];
        if let Err(problem) = check_vertex(statement, &position) {
            self.feed(0, line, &["v 0 0 0"]);
            self.invalid.insert(self.counts[0], InvalidVertex { line, problem });
        } else if further.is_empty() {
            self.feed(0, line, &["v", statement.rest()]);
        } else {
            self.feed(0, line, &[&format!("v {x} {y} {z}")]);
        }
        Ok(())
    }

    /// Texture coordinates; those that are not finite count as 0. Too few numbers are left to tobj.
    fn coordinates(&mut self, statement: &ObjStatement<'_>) -> Result<(), Problem> {
        let numbers = numbers_of_any_size(statement)?;
        if numbers.len() > 3 {
            self.pass_over("vt with further numbers", statement.line);
        }
        match &numbers[..] {
            numbers if numbers.iter().any(|v| !v.is_finite()) => {
                self.pass_over("vt that is not finite (0 is used)", statement.line);
                self.feed(1, statement.line, &["vt 0 0 0"]);
            }
            [u, v, _, _, ..] => self.feed(1, statement.line, &[&format!("vt {u} {v} 0")]),
            _ => self.feed(1, statement.line, &["vt", statement.rest(), "0"]),
        }
        Ok(())
    }

    /// A normal; for one that is not finite the normal of the face is used. Too few numbers are left to tobj.
    fn normal(&mut self, statement: &ObjStatement<'_>) -> Result<(), Problem> {
        let numbers = numbers_of_any_size(statement)?;
        if numbers.iter().any(|v| !v.is_finite()) {
            self.feed(2, statement.line, &["vn 0 0 0"]);
        } else if let [x, y, z, _, ..] = &numbers[..] {
            self.pass_over("vn with further numbers", statement.line);
            self.feed(2, statement.line, &[&format!("vn {x} {y} {z}")]);
        } else {
            self.feed(2, statement.line, &["vn", statement.rest()]);
        }
        Ok(())
    }

    /// Gives tobj one item of `kind`.
    fn feed(&mut self, kind: usize, line: usize, parts: &[&str]) {
        self.counts[kind] += 1;
        self.input.push_parts(line, parts);
    }

    fn face(&mut self, statement: &ObjStatement<'_>) -> Result<(), Problem> {
        if statement.words().nth(2).is_none() {
            self.pass_over("f with fewer than 3 corners", statement.line);
            return Ok(());
        }
        let (mut corners, mut form, mut is_even) = (0_usize, [false; 3], true);
        for word in statement.words() {
            let own = self.corner(word, statement.line)?;
            is_even &= corners == 0 || own == form;
            (corners, form) = (corners + 1, own);
        }
        if !form[0] || !is_even {
            return Err(format!(
                "the corners in `f {}` have no valid form, or several; expected all as v, v/vt, v//vn or v/vt/vn",
                statement.rest()
            )
            .into());
        }
        let sum = u32::try_from(corners).ok().and_then(|n| self.corners.checked_add(n));
        let max = CORNERS.current();
        self.corners = sum.filter(|sum| u64::from(*sum) <= max).ok_or_else(|| {
            let remedy = CORNERS.remedy(CORNERS.suggested(max));
            let words = format!("the mesh has more than {max} corners of faces; split it, {remedy}");
            Problem::new(ErrorCode::TooLarge, words)
        })?;
        if self.materials.is_empty() {
            self.use_material("", None)?;
        }
        if self.form != form {
            self.form = form;
            self.input.push(statement.line, "g");
        }
        self.input.push_parts(statement.line, &["f", statement.rest()]);
        Ok(())
    }

    /// The parts ([`KINDS`]) of a corner, each in range. A word that is no index is left to tobj.
    fn corner(&mut self, word: &str, line: usize) -> Result<[bool; 3], String> {
        let mut form = [false; 3];
        for (kind, text) in word.split('/').enumerate().take(3) {
            form[kind] = !text.is_empty();
            let Ok(stated) = text.parse::<isize>() else { continue };
            let count = self.counts[kind];
            if stated == 0 || (stated < 0 && count.checked_add_signed(stated).is_none()) {
                return Err(out_of_range(KINDS[kind], stated, count));
            }
            if stated > count as isize {
                self.ahead.push((kind, stated, line));
            }
            if kind == 0 && !self.invalid.is_empty() {
                let index = if stated > 0 { stated as usize } else { count.saturating_add_signed(stated) + 1 };
                self.used_invalid = self.used_invalid.or(Some(index).filter(|index| self.invalid.contains_key(index)));
            }
        }
        Ok(form)
    }

    fn use_material(&mut self, name: &str, line: Option<usize>) -> Result<(), Problem> {
        let number = match self.known.get(name) {
            Some(number) => *number,
            None => {
                self.known.insert(name.to_owned(), self.materials.len());
                self.materials.push(name.to_owned());
                self.materials.len() - 1
            }
        };
        if self.materials.len() > 1 << 16 {
            return Err("the mesh has more than 65 536 materials; split it".into());
        }
        if let Some(line) = line {
            self.input.push_parts(line, &["usemtl", &number.to_string()]);
        }
        Ok(())
    }

    fn pass_over(&mut self, keyword: &str, line: usize) {
        self.unread.entry(keyword.to_owned()).or_insert((0, line)).0 += 1;
    }
}

/// Numbers of a statement, which may be infinite or no numbers (`nan`).
fn numbers_of_any_size(statement: &ObjStatement<'_>) -> Result<Vec<f64>, Problem> {
    statement.words().map(|word| word.parse().map_err(|_| format!("`{word}` is not a number").into())).collect()
}

/// Refuses coordinates that are not finite or too large.
fn check_vertex(statement: &ObjStatement<'_>, position: &[f64; 3]) -> Result<(), Problem> {
    statement.words().take(3).try_for_each(|word| number(word).map(drop))?;
    Ok(check_range(position)?)
}

fn out_of_range([name, names]: [&str; 2], stated: isize, count: usize) -> String {
    format!(
        "{name} index {stated} of the face is out of range (number of {names}: {count}, counted from 1); the file is damaged or truncated"
    )
}

fn wrong_count(keyword: &str, expected: &str, actual: usize) -> Problem {
    format!("`{keyword}`: expected {expected}, found {actual}; the line may be truncated").into()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<(Obj, Vec<tobj::Mesh>), String> {
        let file = Path::new("a.obj");
        let obj = scan(file, text.as_bytes()).map_err(|e| e.to_string())?;
        let parts = obj.parts(file).map_err(|e| e.to_string())?;
        Ok((obj, parts))
    }

    const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

    fn refused(tail: &str) -> String {
        read(&format!("{TRIANGLE}{tail}")).expect_err(tail)
    }

    #[test]
    fn relative_indices_and_every_form_of_corner_are_read() {
        let forms = "f -3 -2 -1\no a\nf 1 2 3\nf 1/1 2/1 3/-1\nf 1//1 2//1 3//-1\nf 1/1/1 2/1/1 3/1/1";
        let (_, parts) = read(&format!("{TRIANGLE}vt 0.5\nvn 0 0 1\n{forms}")).expect("readable");
        let sizes: Vec<_> = parts.iter().map(|p| (p.indices.len(), p.texcoords.len(), p.normals.len())).collect();
        assert_eq!(sizes, [(6, 0, 0), (3, 6, 0), (3, 0, 9), (3, 6, 9)], "a part for each form");
        assert!(parts.iter().all(|p| p.positions == [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0]));
        assert_eq!(parts[1].texcoords[..2], [0.5, 0.0]);
    }

    #[test]
    fn faults_name_their_line() {
        assert_eq!(
            refused("f 1 2 4"),
            "a.obj:4: vertex index 4 of the face is out of range (number of vertices: 3, counted from 1); the file is damaged or truncated"
        );
        assert_eq!(
            refused("f 1 2 -4"),
            "a.obj:4: vertex index -4 of the face is out of range (number of vertices: 3, counted from 1); the file is damaged or truncated"
        );
        assert_eq!(
            refused("f 0 1 2"),
            "a.obj:4: vertex index 0 of the face is out of range (number of vertices: 3, counted from 1); the file is damaged or truncated"
        );
        assert_eq!(
            refused("\nf 1/1 2/1 3/1"),
            "a.obj:5: texture coordinate index 1 of the face is out of range (number of texture coordinates: 0, counted from 1); the file is damaged or truncated"
        );
        assert_eq!(refused("v 0 nan 0"), "a.obj:4: `nan` is not finite; expected a finite number");
        assert_eq!(refused("v 0 -inf 0"), "a.obj:4: `-inf` is not finite; expected a finite number");
        assert_eq!(
            refused("f 1 2 3\nv 0.25 0."),
            "a.obj:5: `v`: expected 3 coordinates, found 2; the line may be truncated"
        );
        assert_eq!(
            refused("f 1 2 3\nf 1 2"),
            "a.obj:5: `f`: expected 3 or more corners, found 2; the line may be truncated"
        );
        assert_eq!(refused("f 1 2 x"), "a.obj:4: `f 1 2 x` is invalid (face parse error); correct or remove this line");
        assert_eq!(
            refused("vt 0 0\nvn 0 0 1\nf 1 2 3/1/1/1"),
            "a.obj:6: the corners in `f 1 2 3/1/1/1` have no valid form, or several; expected all as v, v/vt, v//vn or v/vt/vn"
        );
        assert_eq!(
            refused("vn 0 0 1\nf 1//1 2//0 3//1"),
            "a.obj:5: normal index 0 of the face is out of range (number of normals: 1, counted from 1); the file is damaged or truncated"
        );
        assert!(refused("vt 0 0\nf /1 /1 /1").starts_with("a.obj:5: the corners in `f "));
        assert_eq!(refused("v 0 nan 0\nf 1 2 4"), "a.obj:4: `nan` is not finite; expected a finite number");
        assert_eq!(refused("v 0 nan 0\nf 1 2 -1"), "a.obj:4: `nan` is not finite; expected a finite number");
        assert_eq!(refused("f 1 2 4\nv 0 nan 0"), "a.obj:5: `nan` is not finite; expected a finite number");
        assert!(refused("").contains("no faces"));
    }

    #[test]
    fn materials_are_slots_in_order_of_use() {
        let (obj, parts) = read(&format!(
            "{TRIANGLE}f 1 2 3\no part\nusemtl red paint\nf 1 2 3\nusemtl b\nf 1 2 3\nusemtl red paint\nf 1 2 3"
        ))
        .expect("readable");
        assert_eq!(obj.materials, ["", "red paint", "b"]);
        assert!(parts.iter().map(|p| p.material_id).eq([None, Some(1), Some(2), Some(1)]));
    }

    #[test]
    fn odd_statements_are_passed_over() {
        let odd = "v nan 0 0\nv 0 0 1 0.5 0.5 0.5 1\nv 0 0 1 2\nvt nan 0\nvt 0 0 0 0\nvn 0 0 1 0\nusemtl\nmtllib\nf 1 2\nf 3\np 1\n";
        let (obj, parts) = read(&format!("{TRIANGLE}{odd}f 1/1 2/2 3/2\nf -6 -5 -4\n")).expect("readable");
        assert_eq!(parts.iter().map(|part| part.indices.len()).sum::<usize>(), 6);
        assert_eq!((obj.counts, obj.materials), ([6, 2, 1], vec![String::new()]));
        let unread = [
            ("f with fewer than 3 corners", 2, 12),
            ("mtllib without a name", 1, 11),
            ("p", 1, 14),
            ("usemtl without a name", 1, 10),
            ("v that is not finite, of no face", 1, 4),
            ("v with a weight", 1, 6),
            ("v with further numbers", 1, 5),
            ("vn with further numbers", 1, 9),
            ("vt that is not finite (0 is used)", 1, 7),
            ("vt with further numbers", 1, 8),
        ];
        assert_eq!(obj.unread, unread.map(|(what, count, line)| (what.to_owned(), (count, line))).into());
    }

    #[test]
    fn what_is_not_read_is_counted() {
        let (obj, parts) =
            read(&format!("{TRIANGLE}v 0 0 1 0.5 0.5 0.5\nl 1 2 3\nl 2 3\ns 1\nf 1 2 3")).expect("readable");
        assert_eq!(parts[0].indices, [0, 1, 2]);
        assert_eq!(obj.unread["l"], (2, 5));
        assert_eq!(obj.unread["v with a colour"], (1, 4));
        assert_eq!(obj.smoothing_line, Some(7));
    }
}
