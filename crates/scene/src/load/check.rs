//! Checks across several records: names that must exist.

use std::collections::BTreeSet;

use super::names;
use super::usage::Use;
use crate::document::Node;
use crate::fault::{ErrorCode, Faults, Named};
use crate::place::Placed;
use crate::suggest::nearest;

/// Checks that every name used while reading is defined. Returns the uses.
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
        let unknown = uses.iter().filter(|(n, name)| *n == named && !defined.contains(name.as_str()));
        for (number, (_, name)) in unknown.enumerate() {
            match number < MAX_EXPLAINED {
                true => note_unknown(named.word(), name, &known, faults),
                false => {
                    let what = named.word();
                    faults.add(
                        ErrorCode::UnknownName,
                        &name.place,
                        format!("there is no {what} \"{}\"", name.value),
                        format!("define the {what}"),
                    );
                }
            }
        }
    }
    uses
}

/// Maximum number of unknown names of a kind that are compared with the known ones: the work grows with the product of both numbers.
const MAX_EXPLAINED: usize = 50;
/// Maximum number of known names in a message.
const MAX_KNOWN: usize = 50;

fn note_unknown(what: &str, name: &Placed<String>, known: &[&str], faults: &mut Faults) {
    let remedy = match (known, nearest(name, known)) {
        ([], _) => format!("define the {what}; the scene has none"),
        (_, Some(near)) => format!("did you mean \"{near}\"? Known: {}", listed(known)),
        (_, None) => format!("define the {what}, or use a known one: {}", listed(known)),
    };
    faults.add(ErrorCode::UnknownName, &name.place, format!("there is no {what} \"{}\"", name.value), remedy);
}

/// The first names.
fn listed(names: &[&str]) -> String {
    let first = names[..names.len().min(MAX_KNOWN)].join(", ");
    match names.len().checked_sub(MAX_KNOWN) {
        None | Some(0) => first,
        Some(more) => format!("{first} and {more} more"),
    }
}
