//! Prims and properties by their paths.

use crate::syntax::usd::UsdPrim;
use std::collections::HashMap;

/// All prims of a stage.
pub(super) struct Paths<'a>(HashMap<&'a str, &'a UsdPrim>);

impl<'a> Paths<'a> {
    pub(super) fn of(roots: &'a [UsdPrim]) -> Self {
        fn add<'a>(prims: &'a [UsdPrim], all: &mut HashMap<&'a str, &'a UsdPrim>) {
            for prim in prims {
                all.insert(&prim.path, prim);
                add(&prim.children, all);
            }
        }
        let mut all = HashMap::new();
        add(roots, &mut all);
        Self(all)
    }

    /// The prim of a path.
    pub(super) fn prim(&self, path: &str) -> Option<&'a UsdPrim> {
        self.0.get(path).copied()
    }

    /// The prim and the name of a property, `/a/b.outputs:rgb`.
    pub(super) fn property<'p>(&self, path: &'p str) -> Option<(&'a UsdPrim, &'p str)> {
        let (prim, name) = path.split_once('.')?;
        Some((self.prim(prim)?, name))
    }
}
