//! Pairing of the files of two results by camera, frame and name.

use std::collections::{BTreeSet, HashMap};

use crate::result_files::ResultFile;

/// A file of the first result, of the second, or of both.
pub(crate) struct FilePair {
    /// Camera name on the page.
    pub(crate) place: String,
    pub(crate) files: [Option<ResultFile>; 2],
}

/// Pairs files, in the order of the first result's; those only in the second follow. If each result has one camera, these are
/// paired whatever their names.
pub(crate) fn paired(first: Vec<ResultFile>, second: Vec<ResultFile>) -> Vec<FilePair> {
    let places = |files: &[ResultFile]| files.iter().map(|file| file.place.clone()).collect::<BTreeSet<_>>();
    let (first_places, second_places) = (places(&first), places(&second));
    let only = (first_places.len() == 1 && second_places.len() == 1).then(|| first_places.first().cloned()).flatten();
    let shown_at = |file: &ResultFile| only.clone().unwrap_or_else(|| file.place.clone());
    let key = |file: &ResultFile| (shown_at(file), file.name.clone());
    let mut left: HashMap<_, _> = second.iter().map(|file| (key(file), file.clone())).collect();
    let mut pairs: Vec<FilePair> = Vec::new();
    for file in first {
        let other = left.remove(&key(&file));
        pairs.push(FilePair { place: file.place.clone(), files: [Some(file), other] });
    }
    for file in second {
        if left.remove(&key(&file)).is_some() {
            pairs.push(FilePair { place: shown_at(&file), files: [None, Some(file)] });
        }
    }
    pairs
}

#[cfg(test)]
mod tests {
    use super::*;

    fn files(names: &[&str]) -> Vec<ResultFile> {
        let file = |name: &&str| {
            let (place, name) = name.rsplit_once('/').unwrap_or(("", name));
            let (place, name) = (place.to_owned(), name.to_owned());
            ResultFile { place, stem: name.clone(), name, frame: None, path: "".into() }
        };
        names.iter().map(file).collect()
    }

    fn pair_names(first: &[&str], second: &[&str]) -> Vec<(String, [bool; 2])> {
        let pairs = paired(files(first), files(second));
        let name = |pair: &FilePair| pair.files.iter().flatten().next().expect("a file").name.clone();
        pairs.iter().map(|p| (format!("{}/{}", p.place, name(p)), [0, 1].map(|i| p.files[i].is_some()))).collect()
    }

    #[test]
    fn files_of_one_camera_and_name_stand_together() {
        let two = pair_names(&["left/a", "left/b", "right/a"], &["left/a", "right/c"]);
        let expected = [
            ("left/a", [true, true]),
            ("left/b", [true, false]),
            ("right/a", [true, false]),
            ("right/c", [false, true]),
        ];
        assert_eq!(two, expected.map(|(name, present)| (name.to_owned(), present)));
        assert_eq!(
            pair_names(&["front/a"], &["a", "b"]),
            [("front/a".to_owned(), [true, true]), ("front/b".to_owned(), [false, true])]
        );
    }
}
