//! What a material of the stage is here, for the shapes that are bound to it.

use std::rc::Rc;

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
