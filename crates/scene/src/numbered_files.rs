//! Names of numbered files: a pattern with `%d` or `%03d` for the number.

use std::path::{Path, PathBuf};

/// Splits the name of numbered files: text before the number, its digits (0 for as many as needed), text behind it. `None` unless there is exactly
/// one number.
pub(crate) fn parts(name: &str) -> Option<(&str, usize, &str)> {
    let (before, rest) = name.split_once('%')?;
    let (digits, behind) = rest.split_once('d')?;
    let is_width = digits.is_empty() || (digits.len() == 2 && digits.starts_with('0') && !digits.ends_with('0'));
    let width = digits.parse().unwrap_or(0);
    (is_width && digits.bytes().all(|b| b.is_ascii_digit()) && !behind.contains('%')).then_some((before, width, behind))
}

/// The file of a number.
pub(crate) fn numbered(files: &Path, number: u64) -> PathBuf {
    let name = files.file_name().unwrap_or_default().to_string_lossy();
    match parts(&name) {
        Some((before, width, behind)) => files.with_file_name(format!("{before}{number:0width$}{behind}")),
        None => files.to_owned(),
    }
}

/// Returns true if a file is one of numbered files.
pub(crate) fn is_numbered(files: &Path, file: &Path) -> bool {
    let [name, own] = [files, file].map(|path| path.file_name().unwrap_or_default().to_string_lossy());
    let Some((before, _, behind)) = parts(&name).filter(|_| files.parent() == file.parent()) else { return false };
    let number = own.strip_prefix(before).and_then(|rest| rest.strip_suffix(behind));
    number.and_then(|number| number.parse().ok()).is_some_and(|number| numbered(files, number) == file)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_number_stands_once_in_a_name() {
        assert_eq!(parts("walk_%03d.obj"), Some(("walk_", 3, ".obj")));
        assert_eq!(parts("%d.obj"), Some(("", 0, ".obj")));
        for name in ["walk.obj", "%x.obj", "%3d.obj", "%00d.obj", "%0d.obj", "%d-%d.obj", "%+3d.obj", "%012d.obj"] {
            assert_eq!(parts(name), None, "{name}");
        }
    }

    #[test]
    fn files_are_numbered_and_known_again() {
        let files = Path::new("a/walk_%03d.obj");
        assert_eq!(numbered(files, 7), Path::new("a/walk_007.obj"));
        assert_eq!(numbered(files, 12_345), Path::new("a/walk_12345.obj"));
        assert_eq!(numbered(Path::new("%d.obj"), 7), Path::new("7.obj"));
        let is = |file: &str| is_numbered(files, Path::new(file));
        assert!(is("a/walk_007.obj") && is("a/walk_12345.obj"));
        assert!(!is("a/walk_7.obj") && !is("b/walk_007.obj") && !is("a/walk_00x.obj") && !is("a/walk_%03d.obj"));
        assert!(!is_numbered(Path::new("a/walk.obj"), Path::new("a/walk.obj")));
    }
}
