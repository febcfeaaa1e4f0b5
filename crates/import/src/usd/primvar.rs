//! Values that lie on a mesh: one for all of it, for each face, each point, each corner.

use super::access::{indices, tuple, tuples};
use crate::syntax::usd::{UsdPrim, UsdValue};
use std::borrow::Cow;

/// Tuples of `N` numbers over a mesh.
pub(super) struct Primvar<'a, const N: usize> {
    values: Cow<'a, [[f64; N]]>,
    /// Which value each element has; `None`: the one of its own number.
    indices: Option<Vec<usize>>,
    interpolation: Interpolation,
}

/// What has a value each: the whole mesh, each face, point or corner.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Interpolation {
    Whole,
    Faces,
    Points,
    Corners,
}

/// How many of each a mesh has.
#[derive(Clone, Copy)]
pub(super) struct Counts {
    pub(super) faces: usize,
    pub(super) points: usize,
    pub(super) corners: usize,
}

impl<'a, const N: usize> Primvar<'a, N> {
    /// `None` where there is none; an error, in words, where it does not fit the mesh.
    pub(super) fn read(prim: &'a UsdPrim, name: &str, usual: &str, counts: Counts) -> Result<Option<Self>, String> {
        let values = match prim.value(name) {
            None => return Ok(None),
            Some(UsdValue::Tuple(_)) => Cow::Owned(tuple::<N>(prim, name).into_iter().collect()),
            Some(_) => Cow::Borrowed(tuples::<N>(prim, name)),
        };
        if values.is_empty() {
            return Ok(None);
        }
        if values.iter().flatten().any(|v| !v.is_finite()) {
            return Err(format!("\"{name}\" that is no finite number"));
        }
        let stated = prim.attributes.get(name).map_or("", |attribute| attribute.interpolation.as_str());
        let (interpolation, count) = match if stated.is_empty() { usual } else { stated } {
            "constant" => (Interpolation::Whole, 1),
            "uniform" => (Interpolation::Faces, counts.faces),
            "vertex" | "varying" => (Interpolation::Points, counts.points),
            "faceVarying" => (Interpolation::Corners, counts.corners),
            other => return Err(format!("\"{name}\" of an interpolation \"{other}\", which there is not")),
        };
        let by = format!("{name}:indices");
        let has_indices = matches!(prim.value(&by), Some(UsdValue::Numbers(list)) if !list.is_empty());
        let indices = match has_indices {
            true => Some(indices(prim, &by).ok_or_else(|| format!("\"{by}\" below 0"))?),
            false => None,
        };
        let found = indices.as_ref().map_or(values.len(), Vec::len);
        if found < count {
            return Err(format!("\"{name}\" has {found} values where the mesh has {count}"));
        }
        if indices.iter().flatten().take(count).any(|index| *index >= values.len()) {
            return Err(format!("\"{by}\" goes beyond the {} values", values.len()));
        }
        Ok(Some(Self { values, indices, interpolation }))
    }

    /// Which value a corner has: by the numbers of its face, its point and itself.
    pub(super) fn index(&self, [face, point, corner]: [usize; 3]) -> usize {
        let element = match self.interpolation {
            Interpolation::Whole => 0,
            Interpolation::Faces => face,
            Interpolation::Points => point,
            Interpolation::Corners => corner,
        };
        self.indices.as_ref().map_or(element, |indices| indices[element])
    }

    /// A value.
    pub(super) fn value(&self, index: usize) -> [f64; N] {
        self.values[index]
    }

    /// The mean of all values.
    pub(super) fn mean(&self) -> [f64; N] {
        let sum = self.values.iter().fold([0.0; N], |sum, v| std::array::from_fn(|i| sum[i] + v[i]));
        sum.map(|v| v / self.values.len() as f64)
    }

    /// Whether it is the same everywhere.
    pub(super) fn is_even(&self) -> bool {
        self.values.iter().all(|v| *v == self.values[0])
    }
}
