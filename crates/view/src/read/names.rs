//! The names of identities.

use super::facts::SideCar;
use crate::layer::Name;
use etendue_io::exr::VISIBILITY;
use etendue_io::inspect::identity_colour;
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};

/// The identities of a plane of this name, each with its name, where one is known, and its colour.
pub(super) fn names(layer: &str, ids: &[u32], side_car: &SideCar) -> Vec<Name> {
    let known = known(layer, side_car);
    let there: BTreeSet<u32> = ids.iter().copied().collect();
    let name = |id| Name { id, name: known.get(&id).cloned().unwrap_or_default(), colour: identity_colour(id) };
    there.into_iter().map(name).collect()
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

/// Names in the order of their identities, from 1.
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn identities_have_the_names_that_files_state() {
        let side_car = SideCar::of(std::path::Path::new("")).expect("none");
        let told =
            |layer| names(layer, &[3, 1, 1, 0], &side_car).into_iter().map(|n| (n.id, n.name)).collect::<Vec<_>>();
        let seen = [(0, "not known"), (1, "seen"), (3, "outside the picture")].map(|(id, name)| (id, name.to_owned()));
        assert_eq!(told("visibility.forward"), seen);
        assert_eq!(told("instance")[1], (1, String::new()));
        assert_eq!(numbered("0: no ray; 1: the principal ray", "; ", ": ")[&1], "the principal ray");
    }
}
