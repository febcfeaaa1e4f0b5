//! What a material is called here.

use std::rc::Rc;

/// A material of the stage.
#[derive(Clone, Default)]
pub(super) struct Bound {
    /// Its name in ours; empty of one that is not understood.
    pub(super) name: Rc<str>,
    /// The primvar by which its pictures lie; empty of one without pictures.
    pub(super) primvar: Rc<str>,
}

impl Bound {
    /// The primvar by which pictures lie.
    pub(super) fn primvar(&self) -> &str {
        if self.primvar.is_empty() { "st" } else { &self.primvar }
    }

    /// Whether it has pictures.
    pub(super) fn has_pictures(&self) -> bool {
        !self.primvar.is_empty()
    }
}
