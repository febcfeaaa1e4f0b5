//! What is outside of a picture: UsdUVTexture's wrapS and wrapT.
//!
//! Source: "UsdPreviewSurface Specification" 2.6: `useMetadata`, which holds where nothing is said, is `black` where the file says nothing, as PNG and JPEG files do. Our
//! textures are black nowhere: they go on with their edge.

use super::importer::Importer;
use crate::syntax::usd::UsdPrim;
use etendue_scene::record::texture::Wrap;

/// How a picture goes on.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Outside {
    Black,
    Again(Wrap),
}

impl Outside {
    fn of(word: &str) -> Self {
        match word {
            "repeat" => Self::Again(Wrap::Repeat),
            "clamp" => Self::Again(Wrap::Clamp),
            "mirror" => Self::Again(Wrap::Mirror),
            _ => Self::Black,
        }
    }
}

impl<'a> Importer<'a> {
    /// How a picture goes on, and whether it is black there.
    pub(super) fn wrap(&mut self, node: &'a UsdPrim) -> (Wrap, bool) {
        let [s, t] =
            ["inputs:wrapS", "inputs:wrapT"].map(|name| Outside::of(self.plain_text(node, name).unwrap_or("")));
        if s != t {
            self.scenery.report.note("of two ways in which a picture goes on, that along s holds for both");
        }
        match s {
            Outside::Black => (Wrap::Clamp, true),
            Outside::Again(wrap) => (wrap, false),
        }
    }

    /// Says that a shape shows what is outside of a picture that is black there.
    pub(super) fn note_outside(&mut self) {
        let told = "a picture that is black outside of u, v = 0 … 1 (so where wrapS and wrapT say nothing, or useMetadata), of which the shape shows some, has its edge there";
        self.scenery.report.note(told);
    }
}
