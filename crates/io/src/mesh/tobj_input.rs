//! The text that tobj is given: a statement a line, with the line of the file that each comes from.
//!
//! tobj's errors name no line. It reads a line at a time and stops at the first that it refuses, so what it has taken
//! of the text tells which one that is.

use std::path::Path;

use crate::Error;

/// Statements for tobj.
#[derive(Clone, Debug, Default)]
pub(super) struct TobjInput {
    text: String,
    lines: Vec<usize>,
}

impl TobjInput {
    /// Adds a statement of line `line`.
    pub(super) fn push(&mut self, line: usize, statement: &str) {
        self.push_parts(line, &[statement]);
    }

    /// Adds a statement of line `line`, given in parts with a blank between them.
    pub(super) fn push_parts(&mut self, line: usize, parts: &[&str]) {
        for part in parts {
            self.text.push_str(part);
            self.text.push(' ');
        }
        self.text.pop();
        self.text.push('\n');
        self.lines.push(line);
    }

    /// What `read`, a function of tobj, makes of the text; its error with the line of `file`.
    pub(super) fn read<T>(
        &self,
        file: &Path,
        read: impl FnOnce(&mut &[u8]) -> Result<T, tobj::LoadError>,
    ) -> Result<T, Error> {
        let mut rest = self.text.as_bytes();
        read(&mut rest).map_err(|cause| {
            let taken = &self.text[..self.text.len() - rest.len()];
            let (statement, line) = taken.lines().zip(&self.lines).last().unwrap_or(("", &0));
            Error::at(file, *line, format!("`{statement}` is refused ({cause}); correct or remove this line"))
        })
    }

    /// The line of the `index`-th face.
    pub(super) fn line_of_face(&self, index: usize) -> usize {
        let faces = self.text.lines().zip(&self.lines).filter(|(statement, _)| statement.starts_with("f "));
        faces.map(|(_, line)| *line).nth(index).unwrap_or_default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_refused_is_named_with_its_line() {
        let mut input = TobjInput::default();
        for (line, statement) in [(2, "newmtl a"), (5, "illum two"), (7, "Kd 1 1 1")] {
            input.push(line, statement);
        }
        let error = input.read(Path::new("a.mtl"), |text| tobj::load_mtl_buf(text)).expect_err("no number");
        assert_eq!(
            error.to_string(),
            "a.mtl:5: `illum two` is refused (material parse error); correct or remove this line"
        );
    }

    #[test]
    fn faces_are_found_by_their_order() {
        let mut input = TobjInput::default();
        for (line, statement) in [(1, "v 0 0 0"), (4, "f 1 1 1"), (5, "g"), (9, "f 1 1 1")] {
            input.push(line, statement);
        }
        assert_eq!([0, 1].map(|i| input.line_of_face(i)), [4, 9]);
    }
}
