//! Checks that need more than one record: names that must exist.

use std::collections::BTreeSet;

use super::names;
use super::usage::Use;
use crate::document::Node;
use crate::fault::{Faults, Named};
use crate::place::Placed;
use crate::suggest::nearest;

/// Every name that was used while reading is defined. Gives the uses.
pub(super) fn references(document: &Node, faults: &mut Faults) -> Vec<Use> {
    let uses = faults.take_uses();
    let known = |named| match named {
        Named::Mesh => names::of(document, "meshes"),
        Named::Texture => names::of(document, "textures"),
        Named::Material => names::of(document, "materials"),
        Named::Class => names::of_classes(document),
        Named::Frame => names::of(document, "frames"),
    };
    for named in [Named::Mesh, Named::Texture, Named::Material, Named::Class, Named::Frame] {
        let known = known(named);
        let defined: BTreeSet<_> = known.iter().copied().collect();
        for (_, name) in uses.iter().filter(|(n, name)| *n == named && !defined.contains(name.as_str())) {
            note_unknown(named.word(), name, &known, faults);
        }
    }
    uses
}

fn note_unknown(what: &str, name: &Placed<String>, known: &[&str], faults: &mut Faults) {
    let remedy = match (known, nearest(name, known)) {
        ([], _) => format!("define the {what}, the scene has none"),
        (_, Some(near)) => format!("did you mean \"{near}\"? Known: {}", known.join(", ")),
        (_, None) => format!("define the {what}, or use one that is known: {}", known.join(", ")),
    };
    faults.add(&name.place, format!("there is no {what} \"{}\"", name.value), remedy);
}
