//! Mixes.

use super::factor::{Factor, any_factor};
use crate::asset::file_list::{FileList, NamesFiles};
use crate::fault::NameKind;
use crate::place::Placed;
use crate::reader::{name_of, record};

record! {
    /// Two materials side by side. Neither may have emission or opacity; each may be a mix itself.
    pub struct Mix {
        /// Name of the first material.
        required a: Placed<String> = name_of(NameKind::Material);
        /// Name of the second material.
        required b: Placed<String> = name_of(NameKind::Material);
        /// Fraction of the second material.
        required weight: Factor = any_factor();
    }
}

impl NamesFiles for Mix {
    fn name_files(&self, _files: &mut FileList) {
        let Self { place: _, a: _, b: _, weight: _ } = self;
    }
}
