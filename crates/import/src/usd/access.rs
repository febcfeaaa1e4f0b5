//! Access to prims and properties by path, and to attributes by type.

use std::collections::HashMap;

use glam::DVec3;

use crate::syntax::usd::{UsdAsset, UsdPrim, UsdValue};

/// Number; `None` if there is none.
pub(super) fn stated(prim: &UsdPrim, name: &str) -> Option<f64> {
    match prim.value(name)? {
        UsdValue::Number(v) if v.is_finite() => Some(*v),
        _ => None,
    }
}

/// Number, or the default.
pub(super) fn number(prim: &UsdPrim, name: &str, default: f64) -> f64 {
    stated(prim, name).unwrap_or(default)
}

/// Boolean, or the default.
pub(super) fn flag(prim: &UsdPrim, name: &str, default: bool) -> bool {
    match prim.value(name) {
        Some(UsdValue::Flag(v)) => *v,
        Some(UsdValue::Number(v)) => *v != 0.0,
        _ => default,
    }
}

/// Tuple of finite numbers.
pub(super) fn tuple<const N: usize>(prim: &UsdPrim, name: &str) -> Option<[f64; N]> {
    match prim.value(name)? {
        UsdValue::Tuple(list) if list.iter().all(|v| v.is_finite()) => list.as_slice().try_into().ok(),
        _ => None,
    }
}

/// Token or text; empty if there is none.
pub(super) fn text<'a>(prim: &'a UsdPrim, name: &str) -> &'a str {
    match prim.value(name) {
        Some(UsdValue::Text(text)) => text,
        _ => "",
    }
}

/// File, unless its name is empty.
pub(super) fn asset<'a>(prim: &'a UsdPrim, name: &str) -> Option<&'a UsdAsset> {
    match prim.value(name) {
        Some(UsdValue::Asset(asset)) if !asset.stated.is_empty() => Some(asset),
        _ => None,
    }
}

/// Array of numbers; empty if there is none.
pub(super) fn numbers<'a>(prim: &'a UsdPrim, name: &str) -> &'a [f64] {
    match prim.value(name) {
        Some(UsdValue::Numbers(list)) => list,
        _ => &[],
    }
}

/// Array of indices, each 0 or more; `None` if one is not.
pub(super) fn indices(prim: &UsdPrim, name: &str) -> Option<Vec<usize>> {
    let index = |v: &f64| (*v >= 0.0 && *v < 1e15).then_some(*v as usize);
    numbers(prim, name).iter().map(index).collect()
}

/// Array of tuples, concatenated; empty if there is none of `N` numbers each.
pub(super) fn tuples<'a, const N: usize>(prim: &'a UsdPrim, name: &str) -> &'a [[f64; N]] {
    match prim.value(name) {
        Some(UsdValue::Tuples(count, list)) if *count == N => list.as_chunks::<N>().0,
        _ => &[],
    }
}

/// Direction or position.
pub(super) fn vector(prim: &UsdPrim, name: &str) -> Option<DVec3> {
    tuple::<3>(prim, name).map(DVec3::from_array)
}

/// Marks all properties of a prim as used: omitted content is reported once.
pub(super) fn mark_used(prim: &UsdPrim) {
    prim.attributes.values().for_each(|attribute| attribute.used.set(true));
    prim.relations.values().for_each(|relation| relation.used.set(true));
}

/// All prims of a stage.
pub(super) struct Paths<'a>(HashMap<&'a str, &'a UsdPrim>);

impl<'a> Paths<'a> {
    pub(super) fn new(roots: &'a [UsdPrim]) -> Self {
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

    /// Prim of a path.
    pub(super) fn prim(&self, path: &str) -> Option<&'a UsdPrim> {
        self.0.get(path).copied()
    }

    /// Prim and name of a property, `/a/b.outputs:rgb`.
    pub(super) fn property<'p>(&self, path: &'p str) -> Option<(&'a UsdPrim, &'p str)> {
        let (prim, name) = path.split_once('.')?;
        Some((self.prim(prim)?, name))
    }
}
