//! Mixes.

use super::factor::{Factor, any_factor};
use crate::asset::file_list::{FileList, NamesFiles};
use crate::fault::Named;
use crate::place::Placed;
use crate::reader::{name_of, record};

record! {
    /// Two materials side by side. The parts give no light and have no opacity of their own; they may be mixes themselves.
    pub struct Mix {
        /// The name of the one material.
        required a: Placed<String> = name_of(Named::Material);
        /// The name of the other.
        required b: Placed<String> = name_of(Named::Material);
        /// Share of the other, 0 … 1: a number, or `{ texture = name, channel = "r" }`.
        required weight: Factor = any_factor();
    }
}

impl NamesFiles for Mix {
    fn name_files(&self, _files: &mut FileList) {
        let Self { place: _, a: _, b: _, weight: _ } = self;
    }
}
