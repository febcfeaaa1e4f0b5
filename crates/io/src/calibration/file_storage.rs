//! Cameras of a FileStorage: OpenCV has no fixed keys, so its samples and the programs that use it differ in their spelling.
//!
//! Keys are compared without case and punctuation. `label` is what stands beside them in files of several cameras, before or after: `M1`, `cameraMatrix2`,
//! `LEFT.K`, `K_right`, `Camera1.fx`. Cameras may also be maps of their own, with their names as keys, or items of a list with a `name`.
//!
//! | is | keys |
//! | --- | --- |
//! | 3 × 3 camera matrix | `camera_matrix`, `K`, `M`, `intrinsic_matrix`, `intrinsics`, `mtx`, … |
//! | coefficients | `distortion_coefficients`, `dist_coeffs`, `D`, `dist`, … |
//! | both as single numbers | `fx`, `fy`, `cx`, `cy`, `k1`, …, `p1`, `p2`, …, as in ORB-SLAM's `Camera.fx` |
//! | image size | `image_width` and `image_height`, `width` and `height`, …, or `image_size`, `resolution`, … with both |

use std::cell::RefCell;

use super::TreeResult;
use super::yaml::TreeNode;

const MATRIX: [&str; 12] = [
    "cameramatrix",
    "cameramat",
    "cammatrix",
    "cameraintrinsics",
    "cameraintrinsic",
    "intrinsicmatrix",
    "intrinsicsmatrix",
    "intrinsics",
    "intrinsic",
    "mtx",
    "k",
    "m",
];
const DISTORTION: [&str; 15] = [
    "distortioncoefficients",
    "distortioncoeffs",
    "distortioncoeff",
    "distortioncoefs",
    "distortionparameters",
    "distortionvector",
    "distortionmatrix",
    "cameradistortion",
    "distortion",
    "distcoeffs",
    "distcoeff",
    "distcoefs",
    "distcoef",
    "dist",
    "d",
];
const WIDTH: [&str; 6] = ["imagewidth", "imgwidth", "framewidth", "camerawidth", "width", "imagecols"];
const HEIGHT: [&str; 6] = ["imageheight", "imgheight", "frameheight", "cameraheight", "height", "imagerows"];
const SIZE: [&str; 8] =
    ["imagesize", "imgsize", "framesize", "camerasize", "imageresolution", "cameraresolution", "resolution", "size"];
/// Depth of maps in which cameras are sought.
const MAX_MAPS: usize = 4;

/// A key without case and punctuation.
pub(super) fn folded(key: &str) -> String {
    key.chars().filter(|c| c.is_alphanumeric()).flat_map(char::to_lowercase).collect()
}

/// The label of a folded key beside one of the names; empty if there is none.
fn label<'k>(folded: &'k str, names: &[&str]) -> Option<&'k str> {
    if names.contains(&folded) {
        return Some("");
    }
    let beside = |name: &&str| {
        let after = folded.strip_prefix(name).filter(|label| is_label(label));
        after.or_else(|| folded.strip_suffix(name).filter(|label| is_label(label)))
    };
    names.iter().find_map(beside)
}

/// A side, a number, or both after `cam` or `camera`.
fn is_label(text: &str) -> bool {
    let rest = text.strip_prefix("camera").or_else(|| text.strip_prefix("cam")).unwrap_or(text);
    let is_number = (1..=2).contains(&rest.len()) && rest.bytes().all(|byte| byte.is_ascii_digit());
    is_number || ["left", "right", "l", "r", "rgb", "color", "colour", "ir", "depth"].contains(&rest)
}

/// Place of the numbers of a camera.
#[derive(Clone, Copy, Debug)]
pub(super) enum Numbers<'a> {
    /// A camera matrix.
    Matrix(&'a TreeNode),
    /// Single numbers.
    Single,
}

/// A camera of a file.
#[derive(Debug)]
pub(super) struct StoredCamera<'a> {
    root: &'a TreeNode,
    map: &'a TreeNode,
    /// Key of the map in the root, if it is not the root itself.
    map_key: Option<&'a str>,
    label: String,
    /// Names by which it can be requested; the first is stated.
    pub(super) names: Vec<String>,
    pub(super) numbers: Numbers<'a>,
    /// Keys that have been read.
    used: RefCell<Vec<&'a str>>,
}

/// Cameras of a file, in its order.
pub(super) fn cameras(root: &TreeNode) -> Vec<StoredCamera<'_>> {
    let mut cameras = Vec::new();
    let start = Folder { map: root, top_key: None, path: Vec::new() };
    collect(root, &start, &mut cameras);
    // K1 is the left camera beside K2, but not beside K0.
    if cameras.iter().any(|camera| camera.label == "0") {
        cameras.iter_mut().for_each(|camera| camera.names.retain(|name| name != "left" && name != "right"));
    }
    if let [only] = &mut cameras[..] {
        // A single camera of the root has no name, whatever its keys are called.
        if only.map_key.is_none() && only.label.is_empty() {
            only.names.clear();
        }
    }
    cameras
}

/// A map of a file and the keys that lead to it.
struct Folder<'a> {
    map: &'a TreeNode,
    top_key: Option<&'a str>,
    path: Vec<&'a str>,
}

fn collect<'a>(root: &'a TreeNode, folder: &Folder<'a>, cameras: &mut Vec<StoredCamera<'a>>) {
    let mut labels: Vec<String> = Vec::new();
    for (key, node) in folder.map.entries() {
        let folded = folded(key);
        let has_numbers = node.items().is_some() || node.find("data").is_some();
        let (label, numbers) = match label(&folded, &MATRIX) {
            Some(label) if has_numbers => (label, Numbers::Matrix(node)),
            _ => match folded.strip_suffix("fx") {
                Some(prefix) if has_focal_lengths(folder.map, prefix) => (prefix, Numbers::Single),
                _ => continue,
            },
        };
        // The same camera in two spellings is read once.
        if labels.iter().any(|known| known == label) {
            continue;
        }
        labels.push(label.to_owned());
        cameras.push(StoredCamera {
            root,
            map: folder.map,
            map_key: folder.top_key,
            label: label.to_owned(),
            names: names(folder, label, key),
            numbers,
            used: RefCell::new(if matches!(numbers, Numbers::Matrix(_)) { vec![key] } else { Vec::new() }),
        });
    }
    if folder.path.len() == MAX_MAPS {
        return;
    }
    for (key, node) in folder.map.entries().iter().filter(|(_, node)| node.find("data").is_none()) {
        let mut enter = |map: &'a TreeNode, name: &'a str| {
            let path = [&folder.path[..], &[name]].concat();
            collect(root, &Folder { map, top_key: folder.top_key.or(Some(key)), path }, cameras);
        };
        enter(node, key);
        for item in node.items().unwrap_or_default().iter().filter(|item| !item.entries().is_empty()) {
            let name = ["name", "camera_name", "id"].iter().find_map(|name| item.find(name)?.text().ok());
            enter(item, name.unwrap_or(key));
        }
    }
}

/// Returns true if a map has all four numbers of a camera matrix with this prefix.
fn has_focal_lengths(map: &TreeNode, prefix: &str) -> bool {
    let has = |name: &str| {
        map.entries().iter().any(|(key, node)| folded(key) == format!("{prefix}{name}") && node.text().is_ok())
    };
    ["fx", "fy", "cx", "cy"].into_iter().all(has)
}

/// Names of a camera: label or map, side, and key.
fn names(folder: &Folder<'_>, label: &str, key: &str) -> Vec<String> {
    let side = match label {
        "l" | "1" | "left" => Some("left"),
        "r" | "2" | "right" => Some("right"),
        _ => None,
    };
    let own = match (label, folder.path.last()) {
        ("", Some(map)) => (*map).to_owned(),
        ("", None) => key.to_owned(),
        (number, _) if number.parse::<u32>().is_ok() => key.to_owned(),
        (label, _) => side.unwrap_or(label).to_owned(),
    };
    // OpenCV's stereo sample calls the left camera's matrix M1.
    let others = [side, Some(key), Some(label)].into_iter().flatten().filter(|name| !name.is_empty());
    let mut names = vec![own];
    for other in others {
        if !names.iter().any(|name| name == other) {
            names.push(other.to_owned());
        }
    }
    names
}

impl<'a> StoredCamera<'a> {
    /// Line of the camera, for errors.
    pub(super) fn line(&self) -> usize {
        match self.numbers {
            Numbers::Matrix(node) => node.line,
            Numbers::Single => self.map.line,
        }
    }

    /// Coefficients.
    pub(super) fn distortion(&self) -> Option<&'a TreeNode> {
        self.find_in(self.map, |key, node| {
            let has_numbers =
                node.items().is_some() || node.find("data").is_some() || node.text().is_ok_and(str::is_empty);
            label(key, &DISTORTION) == Some(self.label.as_str()) && has_numbers
        })
    }

    /// One of the camera's single numbers.
    pub(super) fn single(&self, name: &str) -> Option<&'a TreeNode> {
        self.find_in(self.map, |key, _| key == format!("{}{name}", self.label))
    }

    /// Value of the camera, or else of the file, by the folded names of its key.
    pub(super) fn value(&self, names: &[&str]) -> Option<&'a TreeNode> {
        let with_label = |key: &str, _: &TreeNode| {
            label(key, names) == Some(self.label.as_str())
                || names.iter().any(|name| key.strip_prefix(self.label.as_str()) == Some(name))
        };
        let own = self.find_in(self.map, with_label).or_else(|| self.find_in(self.map, |key, _| names.contains(&key)));
        // ORB-SLAM states what its cameras share as "Camera.width".
        let is_shared = |key: &str, _: &TreeNode| names.contains(&key.strip_prefix("camera").unwrap_or(key));
        own.or_else(|| self.find_in(self.root, is_shared))
    }

    /// Width and height, px; `None` if the file states neither.
    pub(super) fn size_px(&self) -> TreeResult<Option<[usize; 2]>> {
        if let Some(size) = self.value(&SIZE) {
            let items = size.find("data").unwrap_or(size).items();
            if let Some([width, height]) = items {
                return Ok(Some([width.count()?, height.count()?]));
            }
            if items.is_none() && !size.entries().is_empty() {
                return Ok(Some([size.key("width")?.count()?, size.key("height")?.count()?]));
            }
        }
        match (self.value(&WIDTH), self.value(&HEIGHT)) {
            (Some(width), Some(height)) => Ok(Some([width.count()?, height.count()?])),
            (None, None) => Ok(None),
            (Some(_), None) => self.root.key("image_height").map(|_| None),
            (None, Some(_)) => self.root.key("image_width").map(|_| None),
        }
    }

    fn find_in(&self, map: &'a TreeNode, is_it: impl Fn(&str, &TreeNode) -> bool) -> Option<&'a TreeNode> {
        let (key, node) = map.entries().iter().find(|(key, node)| is_it(&folded(key), node))?;
        self.used.borrow_mut().push(key);
        Some(node)
    }

    /// Keys of the file that have not been read, those of the camera's own map last.
    pub(super) fn other_keys(&self) -> Vec<&'a str> {
        let used = self.used.borrow();
        let mut others: Vec<&str> = self.root.others(&[&used[..], self.map_key.as_slice()].concat());
        if self.map_key.is_some() {
            others.extend(self.map.others(&used));
        }
        others
    }
}
