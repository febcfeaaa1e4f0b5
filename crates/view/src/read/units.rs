//! Units of the layers of a file, from what its header says of all of them.

/// The unit of a layer, and what else is said of it, in a header's `units`: `depth, P: m; flow: px; velocity: m/s, world`, or one unit for all.
pub(super) fn of_layer(stated: &str, layer: &str) -> (String, String) {
    let is_named = |names: &str| {
        let mut names = names.split(',').map(str::trim);
        names.any(|name| layer.strip_prefix(name).is_some_and(|rest| rest.is_empty() || rest.starts_with('.')))
    };
    let mut of_all = None;
    for clause in stated.split(';').map(str::trim) {
        match clause.split_once(':') {
            Some((names, said)) if is_named(names) => {
                let (unit, more) = said.split_once(',').unwrap_or((said, ""));
                return (written(unit.trim()), more.trim().to_owned());
            }
            Some(_) => {}
            // A list is of several layers, and does not say which.
            None => of_all = of_all.or(Some(clause).filter(|unit| !unit.contains(", "))),
        }
    }
    (written(of_all.unwrap_or("")), String::new())
}

/// A unit as it is printed: `W.m^-2.sr^-1.nm^-1` is W·m⁻²·sr⁻¹·nm⁻¹, `e` is e⁻, `1` is nothing.
pub(super) fn written(unit: &str) -> String {
    match unit {
        "1" => String::new(),
        "e" => "e⁻".to_owned(),
        _ => unit.replace("^-1", "⁻¹").replace("^-2", "⁻²").replace("^2", "²").replace('.', "·"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_layer_has_its_unit() {
        let truth = "depth, distance, P: m; N: 1; ID: identity, 0 is the background";
        assert_eq!(["depth", "P", "N", "instance"].map(|layer| of_layer(truth, layer).0), ["m", "m", "", ""]);
        let motion = "flow: px; motion_vector: px/s; scene_flow: m, camera frames; velocity: m/s, world; time: s";
        assert_eq!(of_layer(motion, "flow.forward").0, "px");
        assert_eq!(of_layer(motion, "scene_flow.forward"), ("m".to_owned(), "camera frames".to_owned()));
        assert_eq!(of_layer("px; the column here minus that", "disparity").0, "px");
        assert_eq!(of_layer("W.m^-2.sr^-1.nm^-1", "S0").0, "W·m⁻²·sr⁻¹·nm⁻¹");
        assert_eq!(of_layer("1, e^2, e^2", "samples").0, "");
        assert_eq!([written("e"), written("1"), written("DN")], ["e⁻", "", "DN"]);
    }
}
