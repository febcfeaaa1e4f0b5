//! Meshes whose vertices move, from one file for each of several times.

use std::path::{Path, PathBuf};

use crate::fault::Faults;
use crate::place::Placed;
use crate::reader::{choice, keyed, list, number, path, record, whole};

record! {
    /// Vertices that move within their mesh: the same mesh in several files, one for each time. From one to the next every vertex goes
    /// straight at an even speed.
    pub struct VertexAnimation check(check) {
        /// The files (Wavefront OBJ), numbered: `%d` in the name stands for the number, `%03d` for the number in three digits with zeros
        /// before it. All have the same faces; texture coordinates and materials are those of the first.
        required files: Placed<PathBuf> = path(&["obj"]);
        /// The number of the first file. Default: 0.
        optional first: Placed<u64> = whole(0, 999_999_999);
        /// How many files, 2 or more.
        required count: Placed<u64> = whole(2, 100_000);
        /// When the vertices are those of each file.
        inside times: FrameTimes;
        /// Added to all times, s. Default: 0.
        optional time_offset_s: Placed<f64> = number("s");
        /// What follows the last file and precedes the first. Default: "hold".
        optional repeat: Placed<FrameRepeat> = choice();
    }
}

keyed! {
    /// When the vertices are those of each file.
    pub enum FrameTimes {
        /// Files a second, above 0: the first at 0 s of simulated time, the next 1 / "rate_hz" later. In a loop the first comes again as much
        /// after the last.
        rate_hz => Rate(Placed<f64>) = number("Hz").above(0.0).at_most(1e6);
        /// A time for each file, s, rising; in a loop one more, at which the first comes again.
        times_s => Times(Vec<Placed<f64>>) = list(number("s"), 2);
    }
}

choice! {
    /// What follows the last file of moving vertices and precedes the first.
    pub enum FrameRepeat {
        /// The last holds, and the first before its time.
        "hold" => Hold,
        /// The first again, and so on, also before its time.
        "loop" => Loop,
    }
}

impl VertexAnimation {
    /// The files in the order of their times.
    #[must_use]
    pub fn frame_files(&self) -> Vec<Placed<PathBuf>> {
        let first = self.first.as_ref().map_or(0, |first| first.value);
        let file = |number: u64| Placed::new(numbered(&self.files.value, number), self.files.place.clone());
        (first..first + self.count.value).map(file).collect()
    }

    /// What follows the last file.
    #[must_use]
    pub fn repeats(&self) -> FrameRepeat {
        self.repeat.as_ref().map_or(FrameRepeat::Hold, |repeat| repeat.value)
    }

    /// The time of each file, s, and of a loop that at which the first comes again.
    #[must_use]
    pub fn frame_times_s(&self) -> Vec<f64> {
        let offset_s = self.time_offset_s.as_ref().map_or(0.0, |offset| offset.value);
        match &self.times {
            FrameTimes::Rate(rate) => (0..self.times_needed()).map(|i| offset_s + i as f64 / rate.value).collect(),
            FrameTimes::Times(times_s) => times_s.iter().map(|time_s| offset_s + time_s.value).collect(),
        }
    }

    fn times_needed(&self) -> u64 {
        self.count.value + u64::from(self.repeats() == FrameRepeat::Loop)
    }
}

/// Where the number stands in the name of numbered files: what is before it, its digits (0 for as many as it has), what is behind it.
/// `None` unless there is one such place.
fn parts(name: &str) -> Option<(&str, usize, &str)> {
    let (before, rest) = name.split_once('%')?;
    let (digits, behind) = rest.split_once('d')?;
    let is_width = digits.is_empty() || (digits.len() == 2 && digits.starts_with('0') && !digits.ends_with('0'));
    let width = digits.parse().unwrap_or(0);
    (is_width && digits.bytes().all(|b| b.is_ascii_digit()) && !behind.contains('%')).then_some((before, width, behind))
}

/// The file of a number.
fn numbered(files: &Path, number: u64) -> PathBuf {
    let name = files.file_name().unwrap_or_default().to_string_lossy();
    match parts(&name) {
        Some((before, width, behind)) => files.with_file_name(format!("{before}{number:0width$}{behind}")),
        None => files.to_owned(),
    }
}

/// Whether a file is one of numbered files.
pub(crate) fn is_numbered(files: &Path, file: &Path) -> bool {
    let [name, own] = [files, file].map(|path| path.file_name().unwrap_or_default().to_string_lossy());
    let Some((before, _, behind)) = parts(&name).filter(|_| files.parent() == file.parent()) else { return false };
    let number = own.strip_prefix(before).and_then(|rest| rest.strip_suffix(behind));
    number.and_then(|number| number.parse().ok()).is_some_and(|number| numbered(files, number) == file)
}

fn check(animation: &VertexAnimation, faults: &mut Faults) {
    let name = animation.files.value.file_name().unwrap_or_default().to_string_lossy();
    if parts(&name).is_none() {
        let problem = format!("\"{name}\" does not say once where the number of a file stands in its name");
        faults.add(&animation.files.place, problem, "write %d for the number, or %03d for one of three digits");
    }
    let FrameTimes::Times(times_s) = &animation.times else { return };
    check_times(animation, times_s, faults);
}

fn check_times(animation: &VertexAnimation, times_s: &[Placed<f64>], faults: &mut Faults) {
    let (found, needed, files) = (times_s.len(), animation.times_needed(), animation.count.value);
    if found as u64 != needed {
        let problem = match animation.repeats() {
            FrameRepeat::Hold => format!("{found} times for {files} files, and each file has one"),
            FrameRepeat::Loop => {
                format!(
                    "{found} times for a loop of {files} files, which has one for each, and one when the first comes again"
                )
            }
        };
        faults.add(&times_s[0].place, problem, format!("give {needed} times"));
    }
    let unsorted = times_s.windows(2).filter(|pair| pair[1].value <= pair[0].value);
    for pair in unsorted {
        let problem = format!("the time {} s stands behind {} s", pair[1].value, pair[0].value);
        faults.add(&pair[1].place, problem, "give the files rising times");
    }
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
