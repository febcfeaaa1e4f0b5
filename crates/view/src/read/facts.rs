//! Facts about layers from side-cars and headers: names, units.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use etendue::Error;
use etendue_io::{exr::VISIBILITY, inspect::identity_colour, sidecar};
use serde_json::Value;

use crate::layer::{Layer, NamedIdentifier};

/// A side-car `camera.json`, or nothing.
#[derive(Clone, Debug, Default)]
pub(crate) struct SideCar {
    json: Value,
}

impl SideCar {
    /// The side-car of a folder, or of its parent folder, as for the undistorted twin of a camera.
    ///
    /// # Errors
    /// If it exists but is not JSON.
    pub(crate) fn read(folder: &Path) -> Result<Self, Error> {
        let parent = folder.parent().filter(|_| folder.ends_with("undistorted"));
        let files = [Some(folder), parent].into_iter().flatten().map(|folder| folder.join("camera.json"));
        let Some(file) = files.into_iter().find(|file| file.is_file()) else { return Ok(Self::default()) };
        let json = sidecar::read(&file).map_err(Error::input)?;
        Ok(Self { json })
    }

    /// Returns the value at a path, `null` if there is none.
    pub(super) fn at(&self, path: &[&str]) -> &Value {
        path.iter().fold(&self.json, |value, key| &value[*key])
    }

    /// Returns quantity and unit of a file; empty if there are none.
    pub(super) fn entry(&self, name: &str) -> [&str; 2] {
        let entry = self.at(&["files", name]);
        ["quantity", "unit"].map(|key| entry[key].as_str().unwrap_or(""))
    }
}

/// The identifiers of a plane of this name, each with its name, if known, and its colour.
pub(super) fn names(layer: &str, ids: &[u32], side_car: &SideCar) -> Vec<NamedIdentifier> {
    let known = known(layer, side_car);
    let present: BTreeSet<u32> = ids.iter().copied().collect();
    let name =
        |id| NamedIdentifier { id, name: known.get(&id).cloned().unwrap_or_default(), colour: identity_colour(id) };
    present.into_iter().map(name).collect()
}

fn known(layer: &str, side_car: &SideCar) -> BTreeMap<u32, String> {
    let truth = |key: &str| side_car.at(&["ground_truth", key]);
    match layer.split('.').next().unwrap_or(layer) {
        "instance" => listed(truth("instances"), |entry| entry["name"].as_str()),
        "material" => listed(truth("materials"), Value::as_str),
        "semantic" => classes(truth("classes")),
        "visibility" => numbered(VISIBILITY, ", ", " "),
        "ray" => numbered(truth("ray.ID").as_str().unwrap_or(""), "; ", ": "),
        _ => BTreeMap::new(),
    }
}

/// Names in the order of their identifiers, from 1.
fn listed(list: &Value, name: impl Fn(&Value) -> Option<&str>) -> BTreeMap<u32, String> {
    let entries = list.as_array().map_or(&[][..], Vec::as_slice);
    let named = entries.iter().zip(1..).filter_map(|(entry, id)| Some((id, name(entry)?.to_owned())));
    std::iter::once((0, "background".to_owned())).chain(named).collect()
}

fn classes(table: &Value) -> BTreeMap<u32, String> {
    let entries = table.as_object().into_iter().flatten();
    let named = entries.filter_map(|(name, id)| Some((u32::try_from(id.as_u64()?).ok()?, name.clone())));
    std::iter::once((0, "none".to_owned())).chain(named).collect()
}

/// "0 not known, 1 seen": numbers and their meanings.
fn numbered(text: &str, between: &str, after: &str) -> BTreeMap<u32, String> {
    let entry = |entry: &str| {
        let (number, meaning) = entry.split_once(after)?;
        Some((number.parse().ok()?, meaning.to_owned()))
    };
    text.split(between).filter_map(entry).collect()
}

/// The unit of a layer, and further statements about it, from a header's `units`: `depth, P: m; flow: px; velocity: m/s, world`,
/// or one unit for all.
pub(super) fn layer_words(stated: &str, layer: &str) -> (String, String) {
    let is_named = |names: &str| {
        let mut names = names.split(',').map(str::trim);
        names.any(|name| layer.strip_prefix(name).is_some_and(|rest| rest.is_empty() || rest.starts_with('.')))
    };
    let mut default_words = None;
    for clause in stated.split(';').map(str::trim) {
        match clause.split_once(':') {
            Some((names, unit_text)) if is_named(names) => {
                let (unit, more) = unit_text.split_once(',').unwrap_or((unit_text, ""));
                return (written(unit.trim()), more.trim().to_owned());
            }
            Some(_) => {}
            // A list refers to several layers, and does not state which.
            None => default_words = default_words.or(Some(clause).filter(|unit| !unit.contains(", "))),
        }
    }
    (written(default_words.unwrap_or("")), String::new())
}

/// Formats a unit for display: `W.m^-2.sr^-1.nm^-1` is W·m⁻²·sr⁻¹·nm⁻¹, `e` is e⁻, `1` is empty.
pub(super) fn written(unit: &str) -> String {
    match unit {
        "1" => String::new(),
        "e" => "e⁻".to_owned(),
        _ => unit.replace("^-1", "⁻¹").replace("^-2", "⁻²").replace("^2", "²").replace('.', "·"),
    }
}

/// The layers of a file.
pub(crate) struct FileLayers {
    pub(crate) layers: Vec<Layer>,
    /// Header entries of the file: name and text.
    pub(crate) facts: BTreeMap<String, String>,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn identities_have_the_names_that_files_state() {
        let side_car = SideCar::read(std::path::Path::new("")).expect("none");
        let actual =
            |layer| names(layer, &[3, 1, 1, 0], &side_car).into_iter().map(|n| (n.id, n.name)).collect::<Vec<_>>();
        let expected =
            [(0, "not known"), (1, "seen"), (3, "outside the picture")].map(|(id, name)| (id, name.to_owned()));
        assert_eq!(actual("visibility.forward"), expected);
        assert_eq!(actual("instance")[1], (1, String::new()));
        assert_eq!(numbered("0: no ray; 1: the principal ray", "; ", ": ")[&1], "the principal ray");
    }

    #[test]
    fn each_layer_has_its_unit() {
        let truth = "depth, distance, P: m; N: 1; ID: identity, 0 is the background";
        assert_eq!(["depth", "P", "N", "instance"].map(|layer| layer_words(truth, layer).0), ["m", "m", "", ""]);
        let motion = "flow: px; motion_vector: px/s; scene_flow: m, camera frames; velocity: m/s, world; time: s";
        assert_eq!(layer_words(motion, "flow.forward").0, "px");
        assert_eq!(layer_words(motion, "scene_flow.forward"), ("m".to_owned(), "camera frames".to_owned()));
        assert_eq!(layer_words("px; the column here minus that", "disparity").0, "px");
        assert_eq!(layer_words("W.m^-2.sr^-1.nm^-1", "S0").0, "W·m⁻²·sr⁻¹·nm⁻¹");
        assert_eq!(layer_words("1, e^2, e^2", "samples").0, "");
        assert_eq!([written("e"), written("1"), written("DN")], ["e⁻", "", "DN"]);
    }
}
