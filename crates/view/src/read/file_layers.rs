//! What is in a file.

use crate::layer::Layer;
use std::collections::BTreeMap;

/// The layers of a file.
pub(crate) struct FileLayers {
    pub(crate) layers: Vec<Layer>,
    /// What the file's header says: name and text.
    pub(crate) facts: BTreeMap<String, String>,
}
