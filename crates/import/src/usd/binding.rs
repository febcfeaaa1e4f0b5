//! Which material a prim has.
//!
//! Source: openusd.org, UsdShadeMaterialBindingAPI, "Material Resolve" and "Binding strength": of the bindings for full rendering the nearest one from a prim upwards
//! holds, or else of those for all purposes; one that is stronger than its descendants holds for all of them.

use std::rc::Rc;

use crate::syntax::usd::UsdPrim;

const FULL: &str = "material:binding:full";
const ALL_PURPOSES: &str = "material:binding";
const COLLECTION: &str = "material:binding:collection";

/// What a prim is bound to, by itself or by those above it.
#[derive(Clone, Copy, Default)]
pub(super) struct Bindings<'a> {
    full: Option<Binding<'a>>,
    all_purposes: Option<Binding<'a>>,
}

#[derive(Clone, Copy)]
struct Binding<'a> {
    path: &'a str,
    is_stronger: bool,
}

impl<'a> Bindings<'a> {
    /// Those of a prim in one that has these; only what leads to a material holds.
    pub(super) fn within(self, prim: &'a UsdPrim, is_material: impl Fn(&str) -> bool) -> Self {
        let full = holding(self.full, prim, FULL, &is_material);
        Self { full, all_purposes: holding(self.all_purposes, prim, ALL_PURPOSES, &is_material) }
    }

    /// The path of the material.
    pub(super) fn material(&self) -> Option<&'a str> {
        self.full.or(self.all_purposes).map(|binding| binding.path)
    }
}

fn holding<'a>(
    above: Option<Binding<'a>>,
    prim: &'a UsdPrim,
    name: &str,
    is_material: impl Fn(&str) -> bool,
) -> Option<Binding<'a>> {
    let own = prim.relation(name).and_then(|relation| {
        let path = relation.targets.first().filter(|path| is_material(path))?;
        Some(Binding { path, is_stronger: relation.is_stronger })
    });
    above.filter(|binding| binding.is_stronger).or(own).or(above)
}

/// The paths that a prim is bound to by itself.
pub(super) fn bound(prim: &UsdPrim) -> impl Iterator<Item = &str> {
    let relations = [FULL, ALL_PURPOSES].into_iter().filter_map(|name| prim.relation(name));
    relations.filter_map(|relation| relation.targets.first()).map(String::as_str)
}

/// Whether a prim is bound to a material by itself.
pub(super) fn is_bound(prim: &UsdPrim) -> bool {
    [FULL, ALL_PURPOSES].iter().any(|name| prim.relation(name).is_some())
}

/// Whether it binds collections, which are told apart from other relationships.
pub(super) fn binds_collections(prim: &UsdPrim) -> bool {
    let names = prim.relations.keys().filter(|name| name.starts_with(COLLECTION));
    names.filter(|name| prim.relation(name).is_some()).count() > 0
}

/// A material of the stage.
#[derive(Clone, Default)]
pub(super) struct BoundMaterial {
    /// Its name in ours; empty of one that is not understood.
    pub(super) name: Rc<str>,
    /// The primvar by which its pictures lie; empty of one without pictures.
    primvar: Rc<str>,
    /// Factors of u, v, and what is added, of those of its pictures that are black outside of 0 … 1.
    black_outside: Rc<[[[f64; 2]; 2]]>,
}

impl BoundMaterial {
    pub(super) fn new(name: &str, primvar: Rc<str>, black_outside: Vec<[[f64; 2]; 2]>) -> Self {
        Self { name: name.into(), primvar, black_outside: black_outside.into() }
    }

    /// The primvar by which pictures lie.
    pub(super) fn primvar(&self) -> &str {
        if self.primvar.is_empty() { "st" } else { &self.primvar }
    }

    /// Whether it has pictures.
    pub(super) fn has_pictures(&self) -> bool {
        !self.primvar.is_empty()
    }

    /// Whether a picture that is black outside is seen from outside at one of these texture coordinates.
    pub(super) fn shows_outside(&self, uvs: &[[f64; 2]]) -> bool {
        // Coordinates of 32 bits, and what scales make of them.
        const NEAR: f64 = 1e-5;
        let is_outside = |v: f64| !(-NEAR..=1.0 + NEAR).contains(&v);
        let leaves =
            |[scale, offset]: &[[f64; 2]; 2], uv: &[f64; 2]| (0..2).any(|i| is_outside(uv[i] * scale[i] + offset[i]));
        self.black_outside.iter().any(|transform| uvs.iter().any(|uv| leaves(transform, uv)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::syntax::usd::UsdRelation;

    fn prim(bound: &[(&str, &str, bool)]) -> UsdPrim {
        let relation = |path: &str, is_stronger| UsdRelation {
            targets: vec![path.to_owned()],
            is_stronger,
            ..UsdRelation::default()
        };
        UsdPrim {
            relations: bound.iter().map(|(name, path, strong)| ((*name).to_owned(), relation(path, *strong))).collect(),
            ..UsdPrim::default()
        }
    }

    /// From the outermost prim inwards.
    fn material(prims: &[UsdPrim]) -> Option<&str> {
        prims.iter().fold(Bindings::default(), |about, prim| about.within(prim, |path| path != "/none")).material()
    }

    #[test]
    fn the_nearest_binding_holds_for_each_purpose() {
        let outer = || prim(&[(ALL_PURPOSES, "/outer", false)]);
        let inner = || prim(&[(ALL_PURPOSES, "/inner", false)]);
        assert_eq!(material(&[outer(), prim(&[]), inner()]), Some("/inner"));
        assert_eq!(material(&[outer(), prim(&[])]), Some("/outer"));
        // Full rendering goes before all purposes, however far above it is bound.
        assert_eq!(material(&[prim(&[(FULL, "/full", false)]), inner()]), Some("/full"));
        // What leads to no material hides none.
        assert_eq!(material(&[outer(), prim(&[(ALL_PURPOSES, "/none", true)])]), Some("/outer"));
        assert_eq!(material(&[prim(&[(FULL, "/none", false), (ALL_PURPOSES, "/inner", false)])]), Some("/inner"));
        assert_eq!(material(&[prim(&[("material:binding:preview", "/preview", true)])]), None);
    }

    #[test]
    fn the_outermost_of_the_strong_bindings_holds() {
        let strong = |path| prim(&[(ALL_PURPOSES, path, true)]);
        assert_eq!(material(&[strong("/a"), strong("/b"), prim(&[(ALL_PURPOSES, "/c", false)])]), Some("/a"));
        assert_eq!(material(&[strong("/a"), prim(&[(FULL, "/full", false)])]), Some("/full"));
        assert_eq!(material(&[prim(&[(ALL_PURPOSES, "/a", false)]), strong("/b"), prim(&[])]), Some("/b"));
    }
}
