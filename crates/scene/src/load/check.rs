//! Checks across several records: names that must exist.

use std::collections::BTreeSet;

use super::names;
use super::usage::NameUse;
use crate::document::Node;
use crate::fault::{DescriptionErrors, ErrorCode, NameKind};
use crate::place::Placed;
use crate::suggest::nearest;

/// Checks that every name used while reading is defined. Returns the uses.
pub(super) fn references(document: &Node, errors: &mut DescriptionErrors) -> Vec<NameUse> {
    let uses = errors.take_uses();
    let known = |named| match named {
        NameKind::Mesh => names::names_in_list(document, "meshes"),
        NameKind::Texture => names::names_in_list(document, "textures"),
        NameKind::Material => names::names_in_list(document, "materials"),
        NameKind::Class => names::class_names(document),
        NameKind::Frame => names::names_in_list(document, "frames"),
    };
    for named in [NameKind::Mesh, NameKind::Texture, NameKind::Material, NameKind::Class, NameKind::Frame] {
        let known = known(named);
        let defined: BTreeSet<_> = known.iter().copied().collect();
        let unknown = uses.iter().filter(|(n, name)| *n == named && !defined.contains(name.as_str()));
        for (number, (_, name)) in unknown.enumerate() {
            match number < MAX_EXPLAINED {
                true => note_unknown_name(named.word(), name, &known, errors),
                false => {
                    let what = named.word();
                    errors.add(
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
const MAX_LISTED_NAMES: usize = 50;

fn note_unknown_name(what: &str, name: &Placed<String>, known: &[&str], errors: &mut DescriptionErrors) {
    let remedy = match (known, nearest(name, known)) {
        ([], _) => format!("define the {what}; the scene has none"),
        (_, Some(near)) => format!("did you mean \"{near}\"? Known: {}", listed(known)),
        (_, None) => format!("define the {what}, or use a known one: {}", listed(known)),
    };
    errors.add(ErrorCode::UnknownName, &name.place, format!("there is no {what} \"{}\"", name.value), remedy);
}

/// The first names.
fn listed(names: &[&str]) -> String {
    let first = names[..names.len().min(MAX_LISTED_NAMES)].join(", ");
    match names.len().checked_sub(MAX_LISTED_NAMES) {
        None | Some(0) => first,
        Some(more) => format!("{first} and {more} more"),
    }
}
