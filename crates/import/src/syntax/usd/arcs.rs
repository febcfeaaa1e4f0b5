//! Who inherits from whom: `openusd` follows classes that inherit from one another in a circle without end, and long chains on the stack.
//!
//! Looked at of all layers together, as a class of one layer may be one of another; prims of the same path count as one, whatever layer they are of.

use openusd::sdf::{AbstractData, SpecType, Value};
use std::collections::{BTreeMap, BTreeSet, HashMap};

/// Classes that inherit from one another in a row.
const MAX_CHAIN: usize = 64;

/// Inheritance, and specialisation, of the layers so far.
#[derive(Default)]
pub(super) struct Arcs(BTreeMap<String, BTreeSet<String>>);

impl Arcs {
    /// Adds those of a layer; refuses circles, and chains that are too long.
    pub(super) fn add(&mut self, layer: &dyn AbstractData) -> Result<(), String> {
        let mut is_new = false;
        for path in layer.spec_paths().iter().filter(|path| layer.spec_type(path) == Some(SpecType::Prim)) {
            for field in ["inheritPaths", "specializes"] {
                let found = layer.try_field(path, field).map_err(|cause| cause.to_string())?;
                let Some(Value::PathListOp(list)) = found.as_deref() else { continue };
                let all = [&list.explicit_items, &list.added_items, &list.prepended_items, &list.appended_items];
                for target in all.into_iter().flatten() {
                    let own = path.strip_all_variant_selections();
                    is_new |= self.link(own.as_str(), target.strip_all_variant_selections().as_str());
                }
            }
        }
        if is_new { self.check() } else { Ok(()) }
    }

    fn link(&mut self, heir: &str, parent: &str) -> bool {
        self.0.entry(heir.to_owned()).or_default().insert(parent.to_owned())
    }

    /// The prims whose inheritance counts for a prim: itself, and those that it stands in.
    fn about<'a>(&'a self, path: &'a str) -> impl Iterator<Item = &'a str> {
        let ends = path.match_indices('/').map(|(at, _)| at).filter(|at| *at > 0).chain([path.len()]);
        ends.map(move |end| &path[..end]).filter_map(|path| self.0.get_key_value(path).map(|(own, _)| own.as_str()))
    }

    fn check(&self) -> Result<(), String> {
        // How long the chain from a prim is; 0 while it is being walked.
        let mut known: HashMap<&str, usize> = HashMap::new();
        for start in self.0.keys() {
            self.chain(start, 0, &mut known)?;
        }
        Ok(())
    }

    fn chain<'a>(&'a self, own: &'a str, depth: usize, known: &mut HashMap<&'a str, usize>) -> Result<usize, String> {
        match known.get(own) {
            Some(0) => return Err(format!("<{own}> inherits from itself in a circle")),
            Some(length) if depth + length <= MAX_CHAIN => return Ok(*length),
            None if depth < MAX_CHAIN => {}
            _ => return Err(format!("more than {MAX_CHAIN} classes in a row inherit from one another at <{own}>")),
        }
        known.insert(own, 0);
        let mut longest = 0;
        for parent in self.0.get(own).into_iter().flatten() {
            for next in self.about(parent) {
                longest = longest.max(self.chain(next, depth + 1, known)?);
            }
        }
        known.insert(own, longest + 1);
        Ok(longest + 1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn checked(links: &[(&str, &str)]) -> Result<(), String> {
        let mut arcs = Arcs::default();
        links.iter().for_each(|(heir, parent)| {
            arcs.link(heir, parent);
        });
        arcs.check()
    }

    #[test]
    fn circles_are_found_through_what_prims_stand_in() {
        assert_eq!(checked(&[("/a", "/b"), ("/b", "/c"), ("/World/x", "/World/c")]), Ok(()));
        assert!(checked(&[("/a", "/b"), ("/b", "/a")]).is_err());
        assert!(checked(&[("/a", "/b/c"), ("/b", "/a")]).is_err());
        assert!(checked(&[("/a", "/a/b")]).is_err());
        let chain: Vec<(String, String)> = (0..80).map(|i| (format!("/c{i:02}"), format!("/c{:02}", i + 1))).collect();
        let links: Vec<(&str, &str)> = chain.iter().map(|(a, b)| (a.as_str(), b.as_str())).collect();
        assert!(checked(&links[..60]).is_ok());
        assert!(checked(&links).is_err());
        let backwards: Vec<(&str, &str)> = links.iter().rev().copied().collect();
        assert!(checked(&backwards).is_err());
    }
}
