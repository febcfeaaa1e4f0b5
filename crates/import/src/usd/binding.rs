//! Material of a prim.
//!
//! Source: openusd.org, UsdShadeMaterialBindingAPI, "Material Resolve" and "Binding strength": the nearest binding for full rendering from a prim upwards
//! applies, or else the nearest for all purposes; one that is stronger than its descendants applies to all of them.

use std::rc::Rc;

use crate::syntax::usd::UsdPrim;

const FULL: &str = "material:binding:full";
const ALL_PURPOSES: &str = "material:binding";
const COLLECTION: &str = "material:binding:collection";

/// Material bindings of a prim, its own or inherited.
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
    /// Bindings of a child prim; only those that lead to a material apply.
    pub(super) fn within(self, prim: &'a UsdPrim, is_material: impl Fn(&str) -> bool) -> Self {
        let full = holding(self.full, prim, FULL, &is_material);
        Self { full, all_purposes: holding(self.all_purposes, prim, ALL_PURPOSES, &is_material) }
    }

    /// Path of the material.
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

/// Paths of a prim's own bindings.
pub(super) fn bound(prim: &UsdPrim) -> impl Iterator<Item = &str> {
    let relations = [FULL, ALL_PURPOSES].into_iter().filter_map(|name| prim.relation(name));
    relations.filter_map(|relation| relation.targets.first()).map(String::as_str)
}

/// Returns true if a prim has its own binding to a material.
pub(super) fn is_bound(prim: &UsdPrim) -> bool {
    [FULL, ALL_PURPOSES].iter().any(|name| prim.relation(name).is_some())
}

/// Returns true if it binds collections, as opposed to other relationships.
pub(super) fn binds_collections(prim: &UsdPrim) -> bool {
    let names = prim.relations.keys().filter(|name| name.starts_with(COLLECTION));
    names.filter(|name| prim.relation(name).is_some()).count() > 0
}

/// Material of the stage.
#[derive(Clone, Default)]
pub(super) struct BoundMaterial {
    /// Our name; empty if it is not supported.
    pub(super) name: Rc<str>,
    /// Primvar of the texture coordinates of its images; empty without images.
    primvar: Rc<str>,
    /// Factors and offsets of u, v for its images that are black outside 0 … 1.
    black_outside: Rc<[[[f64; 2]; 2]]>,
}

impl BoundMaterial {
    pub(super) fn new(name: &str, primvar: Rc<str>, black_outside: Vec<[[f64; 2]; 2]>) -> Self {
        Self { name: name.into(), primvar, black_outside: black_outside.into() }
    }

    /// Primvar of the texture coordinates of its images.
    pub(super) fn primvar(&self) -> &str {
        if self.primvar.is_empty() { "st" } else { &self.primvar }
    }

    /// Returns true if it has images.
    pub(super) fn has_images(&self) -> bool {
        !self.primvar.is_empty()
    }

    /// Returns true if one of these texture coordinates shows the outside of an image that is black there.
    pub(super) fn shows_outside(&self, uvs: &[[f64; 2]]) -> bool {
        // Tolerance for coordinates of 32 bits after scaling.
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
        // Full rendering takes precedence over all purposes, however far above it is bound.
        assert_eq!(material(&[prim(&[(FULL, "/full", false)]), inner()]), Some("/full"));
        // A binding that leads to no material hides no other.
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
