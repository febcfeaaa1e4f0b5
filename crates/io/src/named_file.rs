//! Files that other files name: textures of materials, material libraries, buffers, tilt tables.
//!
//! Such names were written on other machines: absolute paths, backslashes, quotes, other capitals, folders that were not copied. The stated path counts if it
//! exists. Otherwise its last components are searched for in the folder of the naming file, from the longest path to the single name, first as spelt and then
//! without regard to capitals. A name that is not UTF-8 also matches a file of the same bytes.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};

use crate::{Problem, Sandbox};

/// Result of a search.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NamedFile {
    /// The file; the stated path if there is none.
    pub path: PathBuf,
    /// True if it exists.
    pub exists: bool,
    /// Difference between the name and the file; `None` if the file has the stated path.
    pub note: Option<String>,
}

/// Finds the file that a file in one of `folders` names. The first folder is that of the naming file.
///
/// # Errors
/// The stated path leads out of `sandbox`.
pub fn find_named_file(folders: &[&Path], name: &str, sandbox: &Sandbox) -> Result<NamedFile, Problem> {
    let own = folders.first().copied().unwrap_or(Path::new(""));
    let verbatim = own.join(name);
    let plain = plain_name(name);
    let stated = own.join(&plain);
    sandbox.check(&stated)?;
    if stated.exists() {
        return Ok(NamedFile { note: note(name, &plain), path: stated, exists: true });
    }
    if verbatim != stated && sandbox.check(&verbatim).is_ok() && verbatim.exists() {
        return Ok(NamedFile { path: verbatim, exists: true, note: None });
    }
    let components = components(&plain);
    for begin in 0..components.len() {
        for folder in folders {
            let Some(path) = search(folder, &components[begin..], sandbox) else { continue };
            let shown = path.strip_prefix(folder).unwrap_or(&path).to_string_lossy().into_owned();
            return Ok(NamedFile { note: note(name, &shown), path, exists: true });
        }
    }
    Ok(NamedFile { path: stated, exists: false, note: None })
}

fn note(name: &str, actual: &str) -> Option<String> {
    (name != actual).then(|| format!("`{name}` is read from `{actual}`"))
}

/// The name without quotes and the scheme of a local file, with forward slashes.
fn plain_name(name: &str) -> String {
    let name = name.trim();
    let unquoted = ['"', '\''].into_iter().find_map(|quote| name.strip_prefix(quote)?.strip_suffix(quote));
    let path = unquoted.unwrap_or(name).trim().replace('\\', "/");
    path.strip_prefix("file://").map(str::to_owned).unwrap_or(path)
}

/// Components of a path of any system, without its drive and the folders above.
fn components(path: &str) -> Vec<&str> {
    let path = path.split_once(':').filter(|(drive, _)| drive.len() == 1).map_or(path, |(_, path)| path);
    let parts: Vec<&str> = path.split('/').filter(|part| !part.is_empty() && *part != ".").collect();
    let begin = parts.iter().rposition(|part| *part == "..").map_or(0, |last| last + 1);
    parts[begin..].to_vec()
}

/// A file below `folder`: as spelt, else without regard to capitals.
fn search(folder: &Path, components: &[&str], sandbox: &Sandbox) -> Option<PathBuf> {
    let exact = components.iter().fold(folder.to_owned(), |path, part| path.join(part));
    if sandbox.check(&exact).is_ok() && exact.is_file() {
        return Some(exact);
    }
    let mut path = folder.to_owned();
    for part in components {
        path = entry(&path, part, sandbox)?;
    }
    (sandbox.check(&path).is_ok() && path.is_file()).then_some(path)
}

/// Entry of a folder that has the name, if letters of both cases count as equal; the first in alphabetical order if there are several.
fn entry(folder: &Path, name: &str, sandbox: &Sandbox) -> Option<PathBuf> {
    let exact = folder.join(name);
    if sandbox.check(&exact).is_ok() && exact.exists() {
        return Some(exact);
    }
    let listed = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    if !sandbox.allows(listed) {
        return None;
    }
    let lower = name.to_lowercase();
    let is_match = |entry: &OsStr| {
        entry.to_string_lossy().to_lowercase() == lower
            || latin_1(name).is_some_and(|bytes| bytes == entry.as_encoded_bytes())
    };
    let names = std::fs::read_dir(listed).ok()?.filter_map(|entry| Some(entry.ok()?.file_name()));
    names.filter(|entry| is_match(entry)).min().map(|entry| folder.join(entry))
}

/// Bytes of a name that was read byte by byte; `None` for ASCII and for other characters.
fn latin_1(name: &str) -> Option<Vec<u8>> {
    if name.is_ascii() {
        return None;
    }
    name.chars().map(|c| u8::try_from(u32::from(c)).ok()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A folder with empty files.
    fn folder(files: &[&str]) -> tempfile::TempDir {
        let place = tempfile::tempdir().expect("temporary folder");
        for file in files {
            let path = place.path().join(file);
            std::fs::create_dir_all(path.parent().expect("a parent")).expect("created");
            std::fs::write(path, b"x").expect("written");
        }
        place
    }

    fn find(place: &tempfile::TempDir, name: &str) -> Option<String> {
        let file = find_named_file(&[place.path()], name, &Sandbox::NONE).expect("no sandbox");
        let path = file.path.strip_prefix(place.path()).ok()?.to_str()?.to_owned();
        file.exists.then_some(path)
    }

    #[test]
    fn names_of_other_machines_lead_to_the_file_beside() {
        let place = folder(&["wall.png", "maps/Floor.PNG", "maps/wall.png"]);
        for (name, expected) in [
            ("wall.png", "wall.png"),
            ("\"wall.png\"", "wall.png"),
            ("'wall.png'", "wall.png"),
            (".\\wall.png", "wall.png"),
            ("C:\\Users\\someone\\Desktop\\wall.png", "wall.png"),
            ("C:\\Users\\someone\\maps\\wall.png", "maps/wall.png"),
            ("\\\\server\\share\\WALL.png", "wall.png"),
            ("/data/someone/Maps/floor.png", "maps/Floor.PNG"),
            ("../../maps/wall.png", "maps/wall.png"),
            ("textures/wall.png", "wall.png"),
            ("file:///C:/x/wall.png", "wall.png"),
            ("Maps/FLOOR.png", "maps/Floor.PNG"),
        ] {
            assert_eq!(find(&place, name).as_deref(), Some(expected), "{name}");
        }
        assert_eq!(find(&place, "roof.png"), None);
        assert_eq!(find(&place, "C:\\maps"), None, "a folder is no file");
        let moved = find_named_file(&[place.path()], "C:\\a\\wall.png", &Sandbox::NONE).expect("no sandbox");
        assert_eq!(moved.note.as_deref(), Some("`C:\\a\\wall.png` is read from `wall.png`"));
        let plain = find_named_file(&[place.path()], "wall.png", &Sandbox::NONE).expect("no sandbox");
        assert_eq!(plain.note, None);
    }

    #[test]
    fn further_folders_are_searched_after_the_first() {
        let (library, mesh) = (folder(&["a.png"]), folder(&["a.png", "b.png"]));
        let find =
            |name| find_named_file(&[library.path(), mesh.path()], name, &Sandbox::NONE).expect("no sandbox").path;
        assert_eq!(find("x/a.png"), library.path().join("a.png"));
        assert_eq!(find("x/b.png"), mesh.path().join("b.png"));
    }

    #[cfg(unix)]
    #[test]
    fn names_of_equal_bytes_match() {
        use std::os::unix::ffi::OsStrExt as _;
        let place = folder(&[]);
        std::fs::write(place.path().join(OsStr::from_bytes(b"m\xe4sh.png")), b"x").expect("written");
        let file = find_named_file(&[place.path()], "m\u{e4}sh.png", &Sandbox::NONE).expect("no sandbox");
        assert!(file.exists, "{file:?}");
    }
}
